//! Tells the program its provenance: a hash of its sources, commit, compiler, target.
#![allow(clippy::print_stdout, reason = "Cargo reads it")]

use std::path::{Path, PathBuf};
use std::process::Command;

/// What the program is made of.
const SOURCES: [&str; 2] = ["src", "crates"];

fn main() {
    // The program includes the golden values: a new file belongs to it too.
    println!("cargo:rerun-if-changed=golden");
    let mut sources = vec![PathBuf::from("Cargo.lock")];
    // A published package has no `crates`.
    for folder in SOURCES.into_iter().filter(|folder| Path::new(folder).exists()) {
        collect(Path::new(folder), &mut sources);
        println!("cargo:rerun-if-changed={folder}");
    }
    sources.sort();
    let mut hasher = blake3::Hasher::new();
    for path in &sources {
        println!("cargo:rerun-if-changed={}", path.display());
        hasher.update(path.to_string_lossy().as_bytes());
        hasher.update(&std::fs::read(path).unwrap_or_default());
    }
    // A commit writes here; a path that is not there would make every build start anew.
    if Path::new(".git/logs/HEAD").exists() {
        println!("cargo:rerun-if-changed=.git/logs/HEAD");
    }
    let sources_hash = hasher.finalize().to_hex();
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    tell("SOURCES", &sources_hash[..16]);
    tell("COMMIT", &output("git", &["rev-parse", "--short=12", "HEAD"]));
    let code = [&["status", "--porcelain", "--"], &SOURCES[..], &["Cargo.toml", "Cargo.lock"]].concat();
    let changed = output("git", &code);
    tell("DIRTY", if changed.is_empty() { "false" } else { "true" });
    tell("COMPILER", &output(&rustc, &["--version"]));
    tell("TARGET", &std::env::var("TARGET").unwrap_or_default());
    tell("PROFILE", &profile());
}

/// Name of the build profile. `PROFILE` knows only `debug` and `release`, whichever profile inherits from them;
/// the folder of the build, `…/release/build/oedometer-…/out`, has the name itself.
fn profile() -> String {
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    let parts: Vec<String> = folder.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    let build = parts.iter().rposition(|part| part == "build").filter(|place| *place > 0);
    build.map_or_else(|| std::env::var("PROFILE").unwrap_or_default(), |place| parts[place - 1].clone())
}

fn tell(name: &str, value: &str) {
    println!("cargo:rustc-env=OEDOMETER_{name}={value}");
}

/// First line of what a command prints; empty where it cannot be asked.
fn output(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output().ok().filter(|output| output.status.success());
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().next().unwrap_or_default().trim().to_owned()
}

fn collect(folder: &Path, sources: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, sources);
        } else {
            sources.push(path);
        }
    }
}
