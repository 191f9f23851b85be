//! Formats that are not read: each is named by its first bytes, with what to do instead.

use crate::steps::Kind;

/// First bytes of files, and what is said of them.
const NAMED: [(&[u8], &str); 30] = [
    (
        b"version https://git-lfs.github.com/",
        "it is a Git LFS pointer, not the file: fetch the file with `git lfs pull`",
    ),
    (b"/annex/objects/", "it is a git-annex pointer, not the file: fetch the file with `git annex get`"),
    (b"<!doctype html", "it is a web page and not a result: download the file itself"),
    (b"<html", "it is a web page and not a result: download the file itself"),
    (b"CDF\x01", CLASSIC),
    (b"CDF\x02", CLASSIC),
    (b"CDF\x05", CLASSIC),
    (b"PAR1", "it is a Parquet file, which is not read: write CSV (pandas: `read_parquet(…).to_csv(…)`)"),
    (b"ARROW1", "it is an Arrow file, which is not read: write CSV (pandas: `read_feather(…).to_csv(…)`)"),
    (b"FEA1", "it is a Feather file, which is not read: write CSV (pandas: `read_feather(…).to_csv(…)`)"),
    (b"#!TDV", TECPLOT),
    (b"#!SZPLT", TECPLOT),
    (b"ADIOS-BP", ADIOS2),
    (b"ITEM: TIMESTEP", "it is a LAMMPS dump, which is not read: write its columns as CSV"),
    (b"GiD Post", "it is a GiD result, which is not read: write VTU or legacy VTK"),
    (b"GiDPostEx", "it is a GiD result, which is not read: write VTU or legacy VTK"),
    (b"MATLAB 5.0", "it is a MATLAB 5 file, which is not read: save with `-v7.3`, as CSV, or as NPZ"),
    (b"BZh", "it is compressed with bzip2: decompress it first, or use gzip"),
    (b"\xfd7zXZ", "it is compressed with xz: decompress it first, or use gzip"),
    (b"\x28\xb5\x2f\xfd", "it is compressed with Zstandard: decompress it first, or use gzip"),
    (b"7z\xbc\xaf", "it is compressed with 7-Zip: decompress it first"),
    (b"SQLite format 3", "it is an SQLite database: export the table as CSV"),
    (b"%PDF", "it is a PDF and not a result"),
    (b"\x89PNG", "it is a picture and not a result"),
    (b"\xd0\xcf\x11\xe0", "it is an old Excel workbook: save the sheet as CSV"),
    (b"\x80\x02", PICKLE),
    (b"\x80\x03", PICKLE),
    (b"\x80\x04", PICKLE),
    (b"\x80\x05", PICKLE),
    (b"FORMAT\n", "it is an EnSight case, which is not read: write PVD with VTU (ParaView: File, Save Data)"),
];
/// What stands in an archive of tar, and where.
const TAR: (usize, &[u8]) = (257, b"ustar");
const CLASSIC: &str = "it is classic netCDF (of Exodus II, too), which is not read: export VTU or CSV, or \
                       convert it to netCDF-4 with `nccopy -k nc4 FILE NEW`";
const TECPLOT: &str = "it is a Tecplot file, which is not read: export VTU or CSV";
const ADIOS2: &str = "it is an ADIOS2 file, which is not read: write XDMF (dolfinx.io.XDMFFile) or VTU";
const PICKLE: &str = "it is a pickled object, which is a program and never opened: write NPZ or CSV";
const FRD: &str =
    "it is CalculiX's FRD, which is not read: write VTU (ccx2paraview), or tables by `*NODE PRINT` as CSV";

/// What is said of a file that begins with these bytes and is not read; `kind` is what it was taken for.
pub(crate) fn named(head: &[u8], kind: Kind) -> Option<String> {
    if kind != Kind::Table {
        return None;
    }
    let start = head.trim_ascii_start();
    if start.is_empty() {
        return Some("it is empty: the program wrote nothing into it".to_owned());
    }
    if head.get(TAR.0..).is_some_and(|rest| rest.starts_with(TAR.1)) {
        return Some("it is a tar archive: unpack it first".to_owned());
    }
    let begins = |begin: &[u8]| start.get(..begin.len()).is_some_and(|part| part.eq_ignore_ascii_case(begin));
    if let Some((_, sentence)) = NAMED.iter().find(|(begin, _)| begins(begin)) {
        return Some((*sentence).to_owned());
    }
    if head.starts_with(b"    1C") || head.starts_with(b"    1U") {
        return Some(FRD.to_owned());
    }
    let text = String::from_utf8_lossy(head);
    let words: Vec<&str> = text.split_ascii_whitespace().take(3).collect();
    let is_assigned =
        words.get(1).is_some_and(|word| word.starts_with('=')) || text.trim_start().contains('=');
    let first = words.first().map(|word| word.split('=').next().unwrap_or_default().to_ascii_uppercase());
    if is_assigned && first.is_some_and(|first| ["TITLE", "VARIABLES"].contains(&first.as_str())) {
        return Some(TECPLOT.to_owned());
    }
    if start.starts_with(b"<") {
        return Some("it is XML of a kind that is not read: expected a VTKFile or XDMF".to_owned());
    }
    if start.starts_with(b"{") {
        return Some("it is JSON, but not a `.series` with \"files\": write CSV or NPZ".to_owned());
    }
    head.contains(&0).then(|| {
        let bytes: Vec<String> = head.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        format!(
            "it begins with the bytes {}, which no readable format has: write VTU, NPZ or CSV",
            bytes.join(" ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_read_is_named_with_what_to_do() {
        for (head, told) in [
            (
                &b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"[..],
                "`git lfs pull`",
            ),
            (b"", "it is empty"),
            (b"\n \r\n", "it is empty"),
            (&[&[b'a'; 257][..], b"ustar\0"].concat(), "unpack it first"),
            (b"\n <!DOCTYPE HTML PUBLIC>", "a web page"),
            (b"<HTML><head>", "a web page"),
            (b"CDF\x01\0\0\0\0", "nccopy -k nc4"),
            (b"CDF\x02\0\0\0\0", "export VTU or CSV"),
            (b"    1C\n    1UDATE   26.11.2026", "CalculiX's FRD"),
            (b"TITLE = \"column\"\nVARIABLES = \"X\", \"P\"", "Tecplot"),
            (b"VARIABLES=\"X\" \"P\"\nZONE I=3", "Tecplot"),
            (b"#!TDV112\x01\0", "Tecplot"),
            (b"PAR1\x15\x04", "Parquet"),
            (b"ADIOS-BP v2.8.3\0", "ADIOS2"),
            (b"\x80\x04\x95\x10\0", "never opened"),
            (b"\xfd7zXZ\0", "decompress it first"),
            (b"{\"a\": 1}", "JSON"),
            (b"<mesh></mesh>", "expected a VTKFile or XDMF"),
            (b"abc\0\x01", "begins with the bytes 61 62 63 00 01"),
        ] {
            let found = named(head, Kind::of_head(head));
            assert!(found.as_ref().is_some_and(|found| found.contains(told)), "{told}: {found:?}");
        }
        for table in ["t,y,p\n1,0,1\n", "title,p\n", "# t y p\n0 1 2\n", "variables,x\n", "BZ,h\n"] {
            assert_eq!(named(table.as_bytes(), Kind::of_head(table.as_bytes())), None, "{table}");
        }
    }
}
