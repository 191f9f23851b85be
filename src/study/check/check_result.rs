//! Checks of results that are there already: names, files, meshes; and the digest that identifies them.

use crate::case::Case;
use crate::case::keys::MOST_CELLS;
use crate::case::tier::Tier;
use crate::study::check::check_solver::{digest_of_file, folder_of};
use crate::study::check::checker::Checker;
use crate::study::file::StudyFile;
use crate::study::result_table::ResultTable;
use crate::study::solver::{Solver, placeholders_of};
use oedometer_mpm::attached_method::{Attached, DIGEST_DIGITS};
use oedometer_mpm::method::Method;
use std::path::Path;

/// What stands for the mesh in the names of files.
const MESH: &str = "cells";

/// The meshes of a result that is there.
pub struct GivenMeshes {
    method: Method,
    cells: Vec<usize>,
    /// Smallest tier that has it.
    pub tier: Tier,
}

impl GivenMeshes {
    /// A case a mesh.
    pub fn cases(&self, base: &Case) -> Vec<Case> {
        let of_mesh =
            |cells: &usize| Case { method: self.method, cells: *cells, ..base.clone() }.for_attached();
        self.cells.iter().map(of_mesh).collect()
    }
}

impl Checker<'_> {
    /// The results of a study, whose names join those of its solvers.
    pub(crate) fn results(&mut self, file: &StudyFile) -> Vec<GivenMeshes> {
        let mut all = Vec::new();
        for entry in &file.result {
            let table = entry.get_ref();
            let (name, span) = (table.name.get_ref(), table.name.span());
            if Method::named(name).is_some() || self.solvers.iter().any(|solver| solver.name() == name) {
                let message = format!("`{name}` is a method, a solver or another result already");
                self.complain(span, message, "give the result a name of its own");
                continue;
            }
            all.extend(self.given_result(table));
        }
        all
    }

    fn given_result(&mut self, table: &ResultTable) -> Option<GivenMeshes> {
        let before = self.diagnostics.len();
        let cells: Vec<usize> = table
            .cells
            .get_ref()
            .iter()
            .filter_map(|typed| self.count(Some(typed), "cells", 1..=MOST_CELLS))
            .collect();
        if table.cells.get_ref().is_empty() {
            self.complain(
                table.cells.span(),
                "no mesh",
                "name the cells over the height of each, like [10, 20]",
            );
        }
        let files: Vec<String> = table.files.get_ref().iter().map(|file| file.get_ref().clone()).collect();
        if files.is_empty() {
            self.complain(
                table.files.span(),
                "no file",
                "name the files of one mesh, like [\"ogs-{cells}/col.pvd\"]",
            );
        }
        for typed in table.files.get_ref() {
            if let Some(other) = placeholders_of(typed.get_ref()).find(|name| *name != MESH) {
                let message = format!("`{{{other}}}` stands for nothing in the files of a result");
                self.complain(typed.span(), message, "`{cells}` stands for the cells over the height");
            }
        }
        let names_mesh = files.iter().any(|file| placeholders_of(file).any(|name| name == MESH));
        if cells.len() > 1 && !names_mesh {
            let message = format!("{} meshes have the same files", cells.len());
            self.complain(
                table.files.span(),
                message,
                "write `{cells}` where their names differ, or one [[result]] a mesh",
            );
        }
        let time_step =
            table.time_step.as_deref().map(|typed| self.positive(Some(typed), "time_step", "s", 1.0));
        let preset = self.preset_of(table.preset.as_ref());
        let folder = folder_of(&self.source.name);
        let mapping = self.file_of_study(table.mapping.as_ref(), &folder);
        let tier = self.choice(table.tier.as_deref(), "tier", Tier::default())?;
        let digest = digest_of(table, &files, &cells, &folder);
        let attached = match Attached::new(table.name.get_ref(), &digest) {
            Ok(attached) => attached,
            Err(why) => {
                let message = format!("a result cannot be called `{}`", table.name.get_ref());
                self.complain(table.name.span(), message, why.to_string());
                return None;
            }
        };
        if self.diagnostics.len() > before {
            return None;
        }
        self.solvers.push(Solver {
            attached,
            folder,
            command: Vec::new(),
            result: String::new(),
            files,
            time_step,
            mapping,
            preset,
            version: Vec::new(),
            timeout: 0.0,
            repeats: 1,
            warm_up: false,
            at_once: 1,
            environment: Vec::new(),
            solve_seconds: None,
        });
        Some(GivenMeshes { method: Method::of_attached(attached), cells, tier })
    }
}

/// Digest of what the result of a mesh is made of: how it is read, and what its files hold now. A file that changes
/// makes other cases, so that no record of it is taken up as theirs.
fn digest_of(table: &ResultTable, files: &[String], cells: &[usize], folder: &Path) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut take = |kind: &str, text: &str| {
        hasher.update(format!("{kind} {}\n{text}\n", text.len()).as_bytes());
    };
    for file in files {
        take("name", file);
        for cells in cells {
            // What a pattern or a collection names is in the digest of the record.
            let path = folder.join(file.replace("{cells}", &cells.to_string()));
            if path.is_file() {
                take("file", &digest_of_file(&path));
            }
        }
    }
    if let Some(typed) = &table.mapping {
        take("mapping", &digest_of_file(&folder.join(typed.get_ref())));
    }
    if let Some(typed) = &table.preset {
        take("preset", typed.get_ref());
    }
    if let Some(typed) = &table.time_step {
        take("time step", &format!("{:e}", typed.get_ref()));
    }
    hasher.finalize().to_hex()[..DIGEST_DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn checked(result: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\n[[result]]\n{result}\n"
        );
        Study::check(&StudySource { name: "t.toml".to_owned(), text }).map_err(|error| error.to_string())
    }

    #[test]
    fn a_result_is_a_case_a_mesh_without_a_sweep() {
        let sound = "name = \"ogs\"\nfiles = [\"ogs-{cells}/col.pvd\"]\ncells = [10, 20]\npreset = \"ogs\"\n";
        let study = checked(sound).expect("sound");
        let labels: Vec<String> = study.planned.iter().map(|planned| planned.case.label()).collect();
        assert_eq!(labels, ["ogs cells=10", "ogs cells=20"]);
        let expect = "\n[[expect_case]]\nmethod = \"ogs\"\ncells = 20\nstatus = \"ok\"";
        assert!(checked(&format!("{sound}{expect}")).is_ok());
        let other = expect.replace("20", "40");
        assert!(checked(&format!("{sound}{other}")).is_err_and(|told| told.contains("`cells = 40`")));
        assert_ne!(
            checked(&sound.replace("\"ogs\"\n", "\"meshio\"\n").replacen("meshio", "ogs", 1))
                .expect("sound")
                .planned,
            study.planned,
            "another meaning is another case"
        );
    }

    #[test]
    fn what_is_wrong_with_a_result_is_told_at_its_place() {
        let sound = "name = \"ogs\"\nfiles = [\"ogs-{cells}/col.pvd\"]\ncells = [10, 20]\n";
        for (from, to, told) in [
            ("\"ogs\"", "\"MPM\"", "`MPM` is a method"),
            ("\"ogs\"", "\"o g s\"", "cannot be called `o g s`"),
            ("-{cells}", "", "2 meshes have the same files"),
            ("{cells}", "{cell}", "`{cell}` stands for nothing"),
            ("[10, 20]", "[]", "no mesh"),
            ("[10, 20]", "[0]", "0"),
            ("cells = [10, 20]", "cells = [10, 20]\ntime_step = -1.0", "time_step"),
            ("cells = [10, 20]", "cells = [10, 20]\npreset = \"ogx\"", "ogs"),
            ("cells = [10, 20]", "cells = [10, 20]\nmapping = \"none.toml\"", "there is no file"),
        ] {
            let refused = checked(&sound.replacen(from, to, 1)).expect_err(to);
            assert!(refused.contains(told) && refused.contains("t.toml:"), "{to}: {refused}");
        }
    }
}
