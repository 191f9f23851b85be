//! Packs the golden values of the shipped studies for the program.
#![allow(clippy::print_stdout, reason = "Cargo reads it")]

use std::path::PathBuf;

/// Names, lengths and texts in one compressed stream, a tenth of what the files take.
fn main() {
    println!("cargo:rerun-if-changed=golden");
    let entries = std::fs::read_dir("golden").into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|kind| kind == "csv"));
    files.sort();
    let mut whole = Vec::new();
    for path in &files {
        let text = std::fs::read(path).unwrap_or_default();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        whole.extend(format!("{name} {}\n", text.len()).into_bytes());
        whole.extend(text);
    }
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&whole, 8);
    std::fs::write(folder.join("golden.z"), packed).expect("the folder of the build can be written to");
}
