//! The files that a result is read from beside those that are given: what each format names, and what these name.

use crate::collections::{Member, beside, of_blocks, of_pieces, of_pvd, of_series};
use crate::hdf5::linked_files;
use crate::steps::{Kind, MOST, read_text};
use crate::xml::{all, attribute, parse};
use roxmltree::Node;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// A file with all that it names, and that these name in turn, each once and in the order of their names; those that are
/// missing or cannot be read name nothing.
pub fn with_named(path: &Path) -> Vec<PathBuf> {
    let mut all = vec![path.to_owned()];
    let mut seen: HashSet<PathBuf> = all.iter().cloned().collect();
    let mut next = 0;
    while let Some(file) = all.get(next).filter(|_| all.len() < MOST) {
        let named = named_by(file).unwrap_or_default();
        all.extend(named.into_iter().filter(|file| seen.insert(file.clone())));
        next += 1;
    }
    all
}

/// The files that a file names.
fn named_by(path: &Path) -> Option<Vec<PathBuf>> {
    let kind = Kind::of(path).ok()?;
    let members = |members: Vec<Member>| members.into_iter().map(|member| member.file).collect();
    let text = || read_text(path).ok();
    match kind {
        Kind::Collection => of_pvd(path, &text()?).ok().map(members),
        Kind::Series => of_series(path, &text()?).ok().map(members),
        Kind::Blocks => of_blocks(path, &text()?).ok(),
        Kind::Pieces => of_pieces(path, &text()?).ok(),
        Kind::Xdmf => {
            let text = text()?;
            let document = parse(&text).ok()?;
            let of_item = |item| Some(beside(path, item_text(item)?.split_once(":/")?.0.trim()));
            let of_include = all(document.root(), "include").map(|include| attribute(include, "href"));
            let of_include = of_include.filter(|file| !file.is_empty()).map(|file| beside(path, file));
            Some(all(document.root(), "DataItem").filter_map(of_item).chain(of_include).collect())
        }
        Kind::Hdf5 => Some(linked_files(path)),
        Kind::Table | Kind::Vtu | Kind::LegacyVtk | Kind::Gmsh | Kind::GmshViews | Kind::Npz | Kind::Npy => {
            None
        }
    }
}

/// The text of an item whose data stand in another file.
fn item_text<'a>(item: Node<'a, '_>) -> Option<&'a str> {
    item.text().filter(|_| attribute(item, "Format").eq_ignore_ascii_case("HDF"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hdf5_pure::FileBuilder;

    #[test]
    fn every_format_that_names_other_files_is_read_from_them_too() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let write = |name: &str, text: &str| std::fs::write(at(name), text).expect("a file");
        let mut builder = FileBuilder::new();
        builder.create_dataset("t").with_f64_data(&[1.0, 2.0]).with_shape(&[2]);
        builder.write(at("b.h5")).expect("a file");
        // The link message as h5py writes it, of an array of another file.
        let link = [&[1, b'p', 8, 0][..], b"\0b.h5\0q\0"].concat();
        let plain = std::fs::read(at("b.h5")).expect("a file");
        std::fs::write(at("a.h5"), [plain, link].concat()).expect("a file");
        write("a.vtu", "<VTKFile type=\"UnstructuredGrid\"/>");
        write("a.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><Piece Source=\"a.vtu\"/></VTKFile>");
        write("a.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><DataSet file=\"a.pvtu\"/></VTKFile>");
        write("a.pvd", "<VTKFile type=\"Collection\"><DataSet timestep=\"1\" file=\"a.vtm\"/></VTKFile>");
        write(
            "a.series",
            "{\"files\":[{\"name\":\"a.vtm\",\"time\":1.0},{\"name\":\"none.vtm\",\"time\":2.0}]}",
        );
        write("a.xdmf", "<Xdmf><DataItem Format=\"HDF\">a.h5:/p</DataItem><include href=\"a.pvd\"/></Xdmf>");
        for (name, named) in [
            ("a.vtu", &["a.vtu"][..]),
            ("a.pvtu", &["a.pvtu", "a.vtu"]),
            ("a.vtm", &["a.vtm", "a.pvtu", "a.vtu"]),
            ("a.pvd", &["a.pvd", "a.vtm", "a.pvtu", "a.vtu"]),
            ("a.series", &["a.series", "a.vtm", "none.vtm", "a.pvtu", "a.vtu"]),
            ("a.h5", &["a.h5", "b.h5"]),
            ("a.xdmf", &["a.xdmf", "a.h5", "a.pvd", "b.h5", "a.vtm", "a.pvtu", "a.vtu"]),
        ] {
            assert_eq!(
                with_named(&at(name)),
                named.iter().map(|name| at(name)).collect::<Vec<_>>(),
                "{name}"
            );
        }
    }
}
