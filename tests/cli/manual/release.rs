//! What a release holds: the archive has whatever its pages lead to, and the sums of files from several machines verify.

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What `.ci/release` packs beside the program.
fn packed() -> Vec<String> {
    let script = fs::read_to_string(root().join(".ci/release")).expect("a script");
    let list =
        script.lines().find_map(|line| line.strip_prefix("packed=(")?.strip_suffix(')')).expect("a list");
    list.split(' ').map(str::to_owned).collect()
}

/// Markdown pages in a file or folder.
fn pages(path: &Path) -> Vec<PathBuf> {
    if path.is_dir() {
        let inside = fs::read_dir(path).expect("a folder").map(|entry| entry.expect("an entry").path());
        return inside.flat_map(|path| pages(&path)).collect();
    }
    path.extension().is_some_and(|end| end == "md").then(|| path.to_owned()).into_iter().collect()
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut plain, part| {
        if part == Component::ParentDir {
            plain.pop();
        } else {
            plain.push(part);
        }
        plain
    })
}

#[test]
fn the_archive_has_what_its_pages_lead_to() {
    let packed = packed();
    let mut count = 0;
    for page in packed.iter().flat_map(|name| pages(&root().join(name))) {
        let text = fs::read_to_string(&page).expect("a page");
        for target in
            text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target)
        {
            let (file, _) = target.split_once('#').unwrap_or((target, ""));
            // Pages of studies are rendered beside the front page, which alone is kept.
            if file.is_empty() || file.contains("://") || target == "studies/README.md" {
                continue;
            }
            let path = plain(&page.parent().expect("a folder").join(file));
            let inside = path.strip_prefix(root()).unwrap_or(&path);
            let is_packed = packed.iter().any(|name| inside.starts_with(name));
            assert!(
                is_packed && path.exists(),
                "{} leads to {target}, which the archive lacks",
                page.display()
            );
            count += 1;
        }
    }
    assert!(count > 100, "{count} links");
}

#[cfg(unix)]
#[test]
fn sums_verify_where_five_machines_write_the_same_names() {
    let folder = TempDir::new().expect("a folder");
    let machines: Vec<String> = (1..=5).map(|number| format!("machine-{number}")).collect();
    let sums = |place: &Path, arguments: &[&str]| {
        Command::new("sha256sum").args(arguments).current_dir(place).output().expect("sha256sum")
    };
    for machine in &machines {
        let place = folder.path().join(machine);
        fs::create_dir(&place).expect("a folder");
        let own = format!("program-{machine}.tar.gz");
        for name in ["manual.tar.gz", &own] {
            fs::write(place.join(name), machine).expect("a file");
        }
        fs::write(place.join("SHA256SUMS"), sums(&place, &["manual.tar.gz", &own]).stdout).expect("a file");
    }
    let collect = |into: &str| {
        let mut command = Command::new("bash");
        command.arg(root().join(".ci/collect")).arg(into).args(&machines).current_dir(folder.path());
        command.output().expect("bash")
    };
    let done = collect("dist");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let dist = folder.path().join("dist");
    assert!(sums(&dist, &["--check", "--strict", "SHA256SUMS"]).status.success());
    assert_eq!(fs::read_to_string(dist.join("SHA256SUMS")).expect("sums").lines().count(), 6);
    // What was damaged on its way is not released.
    fs::write(folder.path().join("machine-4/manual.tar.gz"), "damaged").expect("a file");
    assert!(!collect("again").status.success());
}
