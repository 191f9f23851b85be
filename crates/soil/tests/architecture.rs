//! Every source of the crate uses only those below it, so that no sources use each other in a circle.

use std::fs;
use std::path::Path;

/// Sources from the ground up.
const SOURCES: [&str; 10] = [
    "wording",
    "elementary",
    "tensor",
    "continuity",
    "plasticity",
    "stiffness",
    "von_mises",
    "law",
    "conductivity",
    "material",
];

/// Every source that `source` names and that does not stand below it; tests inside a source may use any.
fn upward(source: &str, text: &str) -> Vec<String> {
    let height = |name: &str| SOURCES.iter().position(|other| *other == name);
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|path| path.split(|end: char| !end.is_alphanumeric() && end != '_').next().unwrap_or(path))
        .filter(|used| height(used).is_none_or(|used| Some(used) > height(source)))
        .map(|used| format!("{source} → {used}"))
        .collect()
}

#[test]
fn sources_use_only_those_below_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let source = path.file_stem().and_then(std::ffi::OsStr::to_str).expect("UTF-8");
        if path.is_dir() || source == "lib" {
            continue;
        }
        assert!(SOURCES.contains(&source), "{source} is not in the list");
        wrong.extend(upward(source, &fs::read_to_string(&path).expect("a source")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_planted_arrow_is_named() {
    let planted = "use crate::law::Stiffness;\nuse crate::tensor::Tensor;\n";
    assert_eq!(upward("plasticity", planted), ["plasticity → law"]);
    assert!(upward("plasticity", "#[cfg(test)]\nmod tests {\n    use crate::law::Law;\n}\n").is_empty());
}
