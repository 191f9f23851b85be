//! The name of a study: that of its file, and of every folder, file and anchor that is made of it.

/// Longest name, bytes: file systems take 255, and what is made of a name puts more around it.
const LONGEST: usize = 100;
/// Names by which the report, the golden values and the tables call parts of their own.
const TAKEN: [&str; 7] = ["findings", "survival", "how", "references", "profiles", "history", "columns"];

/// Name of a study by its file: without folders and extension.
pub fn name_of(file: &str) -> &str {
    let file = file.rsplit(['/', '\\']).next().unwrap_or_default();
    file.strip_suffix(".toml").unwrap_or(file)
}

/// Why a name cannot be that of a study that is kept; none where it can.
///
/// Plain names only: they become folders, files and anchors, on file systems that know upper from lower case and
/// on those that do not.
pub fn refused_name(name: &str) -> Option<String> {
    let is_inner = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    let is_plain = name.starts_with(|first: char| first.is_ascii_lowercase() || first.is_ascii_digit())
        && name.ends_with(is_inner)
        && name.chars().all(|letter| is_inner(letter) || ".-".contains(letter))
        && !name.contains("--");
    if !is_plain {
        return Some(
            "take lower-case letters and digits, with single `-`, `_` or `.` between them, like `mesh-2.toml`"
                .to_owned(),
        );
    }
    if name.len() > LONGEST {
        return Some(format!("it has {} letters: take {LONGEST} at most", name.len()));
    }
    TAKEN.contains(&name).then(|| {
        format!("`{name}` is what a part of the report, of the golden values or of the tables is called")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_the_file_without_folders_and_extension() {
        assert_eq!(name_of("studies/a.b.toml"), "a.b");
        assert_eq!(name_of("c:\\studies\\mesh.toml"), "mesh");
        assert_eq!(name_of("..toml"), ".");
        assert_eq!(name_of("...toml"), "..");
        assert_eq!(name_of("/dev/stdin"), "stdin");
    }

    #[test]
    fn plain_names_are_taken_and_others_refused() {
        for name in ["terzaghi-mesh", "a", "63", "v1.2_b"] {
            assert_eq!(refused_name(name), None, "{name}");
        }
        let long = "a".repeat(LONGEST + 1);
        let others = [
            "",
            ".",
            "..",
            ".hidden",
            "-a",
            "a-",
            "a.",
            "MyStudy",
            "ä",
            "a b",
            "a/b",
            "a\\b",
            "a\n",
            "a--b",
            "con:",
            "references",
            &long,
        ];
        for name in others {
            assert!(refused_name(name).is_some(), "{name}");
        }
    }
}
