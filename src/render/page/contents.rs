//! What a page holds: its figures, and its tables with the names of their files.

use crate::render::RenderError;
use crate::render::page::walk::{Walk, Writer};
use crate::render::page::{Block, Figure, Page};
use crate::render::table::Table;

/// The figures of a page: file name (without a folder) and SVG.
///
/// # Errors
/// If a name is unusable or used twice, or a figure cannot be drawn.
pub fn figures(page: &Page) -> Result<Vec<(String, String)>, RenderError> {
    check(page)?;
    all_figures(page)
        .into_iter()
        .map(|figure| Ok((format!("{}.svg", figure.name), figure.svg()?.to_owned())))
        .collect()
}

/// Figures of a page, and its tables with the names of their files, in order.
#[derive(Default)]
struct Collected<'a> {
    figures: Vec<&'a Figure>,
    tables: Vec<(Option<String>, &'a Table)>,
}

impl<'a> Writer<'a> for Collected<'a> {
    fn table(&mut self, table: &'a Table, file: Option<String>) -> Result<(), RenderError> {
        self.tables.push((file, table));
        Ok(())
    }

    fn figure(&mut self, figure: &'a Figure, _: Option<usize>) -> Result<(), RenderError> {
        self.figures.push(figure);
        Ok(())
    }
}

fn collected(page: &Page) -> Collected<'_> {
    let mut all = Collected::default();
    Walk::page(page, &mut all).expect("nothing is written");
    all
}

/// The tables among some blocks, in order.
pub(crate) fn tables_in(blocks: &[Block]) -> Vec<&Table> {
    let mut all = Collected::default();
    Walk::default().blocks(blocks, &mut all).expect("nothing is written");
    all.tables.into_iter().map(|(_, table)| table).collect()
}

/// Every figure of a page, in order.
pub(crate) fn all_figures(page: &Page) -> Vec<&Figure> {
    collected(page).figures
}

/// The tables of a page that has files, with the names of theirs, without an ending, in order.
pub fn tables(page: &Page) -> Vec<(String, &Table)> {
    let named = collected(page).tables.into_iter();
    named.filter_map(|(file, table)| Some((file?, table))).collect()
}

/// Names become files and anchors: they must be safe and unique.
pub(crate) fn check(page: &Page) -> Result<(), RenderError> {
    let ids: Vec<&str> = page.sections.iter().map(|s| s.id.as_str()).collect();
    let names: Vec<&str> = all_figures(page).iter().map(|f| f.name.as_str()).collect();
    for list in [&ids, &names] {
        for (i, &name) in list.iter().enumerate() {
            let usable = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.".contains(c);
            if name.is_empty() || name.starts_with('.') || !name.chars().all(usable) {
                return Err(RenderError::Name { name: name.to_owned() });
            }
            if list[..i].contains(&name) {
                return Err(RenderError::Duplicate { title: page.title.clone(), name: name.to_owned() });
            }
        }
    }
    Ok(())
}
