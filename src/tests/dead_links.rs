//! Links of the Markdown in this repository lead to a file, and to a place in it.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders of the repository that hold Markdown for readers.
const FOLDERS: [&str; 9] =
    ["", "docs", "docs/dev", "report", "report/studies", "examples", "python", "benches", "paper"];

fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let of = |folder: &&str| {
        let files = fs::read_dir(root.join(folder)).into_iter().flatten().flatten().map(|file| file.path());
        files.filter(|file| file.extension().is_some_and(|end| end == "md")).collect::<Vec<_>>()
    };
    FOLDERS.iter().flat_map(of).collect()
}

/// The text without code: what stands there is no link.
fn without_code(text: &str) -> String {
    let blocks = text.split("\n```").step_by(2).collect::<Vec<_>>().join("\n");
    blocks.split('`').step_by(2).collect::<Vec<_>>().join("")
}

/// Targets of links, those of the repository alone.
fn targets(text: &str) -> Vec<String> {
    let parts = text.split("](").skip(1).filter_map(|part| part.split_once(')'));
    let targets = parts.map(|(target, _)| target.trim_matches(['<', '>']).to_owned());
    targets.filter(|target| !target.contains("://") && !target.starts_with("mailto:")).collect()
}

/// Anchors of a page: those of its headings, as a forge makes them, and its own.
fn anchors(text: &str) -> Vec<String> {
    let of_heading = |line: &str| {
        let words = line.trim_start_matches('#').trim().to_lowercase().replace('`', "");
        let kept = words.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>()
    };
    let headings = text.lines().filter(|line| line.starts_with('#')).map(of_heading);
    let own = text.split("id=\"").skip(1).filter_map(|part| part.split_once('"'));
    headings.chain(own.map(|(id, _)| id.to_owned())).collect()
}

/// What is wrong with the links of a page.
fn dead(page: &Path, text: &str) -> Vec<String> {
    let wrong = |target: &String| {
        let (file, anchor) =
            target.split_once('#').map_or((target.as_str(), None), |(file, id)| (file, Some(id)));
        let path = if file.is_empty() { page.to_owned() } else { page.parent().unwrap_or(page).join(file) };
        let is_there = path.exists();
        let place = anchor.filter(|_| is_there && path.extension().is_some_and(|end| end == "md"));
        let is_found = |id: &str| {
            let text =
                if file.is_empty() { text.to_owned() } else { fs::read_to_string(&path).unwrap_or_default() };
            anchors(&text).iter().any(|known| known == id)
        };
        !is_there || place.is_some_and(|id| !is_found(id))
    };
    targets(&without_code(text)).into_iter().filter(wrong).collect()
}

#[test]
fn every_link_of_the_markdown_leads_to_a_file_and_a_place_in_it() {
    let pages = pages();
    assert!(pages.len() > 30, "{pages:?}");
    let told = pages.iter().flat_map(|page| {
        let text = fs::read_to_string(page).expect("a page");
        dead(page, &text)
            .into_iter()
            .map(|target| format!("{}: {target}", page.display()))
            .collect::<Vec<_>>()
    });
    let told: Vec<String> = told.collect();
    assert!(told.is_empty(), "dead links:\n{}", told.join("\n"));
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let planted = "# A heading `x`, \n[a](nowhere.md) [b](#a-heading-x) [c](#nowhere) [d](docs/README.md) `[e](no)` <a id=\"own\"></a>[f](#own)";
    assert_eq!(dead(&page, planted), ["nowhere.md", "#nowhere"]);
}
