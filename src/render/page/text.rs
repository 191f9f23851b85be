//! Blocks for a terminal: wrapped, without marks and figures.

use crate::render::RenderError;
use crate::render::marked_text::{paragraphs, to_plain, wrapped};
use crate::render::page::Block;

/// Blocks in lines of a width, an empty line between them. What a reader of a page opens by a click is left out, unless the whole
/// is wanted; of several views the first is shown.
///
/// # Errors
/// If a table is ragged.
pub fn text_of(blocks: &[Block], width: usize, is_whole: bool) -> Result<String, RenderError> {
    let texts: Result<Vec<String>, _> =
        blocks.iter().map(|block| block_text(block, width, is_whole)).collect();
    let texts: Vec<String> = texts?.into_iter().filter(|text| !text.is_empty()).collect();
    Ok(texts.join("\n"))
}

fn block_text(block: &Block, width: usize, is_whole: bool) -> Result<String, RenderError> {
    Ok(match block {
        Block::Paragraph(text) => {
            let paragraphs = paragraphs(text);
            let lines = paragraphs.iter().map(|one| wrapped(&to_plain(one), "", "  ", width));
            lines.collect::<Vec<_>>().join("\n")
        }
        Block::Code(text) => text.trim_end().to_owned() + "\n",
        Block::Heading(text) => text.clone() + "\n",
        Block::List(points) => points.iter().map(|one| wrapped(&to_plain(one), "", "    ", width)).collect(),
        Block::Table(table) => table.to_text(width)?,
        Block::Beside(main, aside) => {
            [text_of(main, width, is_whole)?, text_of(aside, width, is_whole)?].join("\n")
        }
        Block::Switch(views) => match views.first() {
            Some((_, blocks)) => text_of(blocks, width, is_whole)?,
            None => String::new(),
        },
        Block::Details { summary, blocks } if is_whole => {
            format!("{summary}\n{}", text_of(blocks, width, is_whole)?)
        }
        Block::Details { .. } | Block::Figure(_) | Block::Figures(_) => String::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::table::{Table, columns};

    #[test]
    fn what_is_behind_a_click_and_all_but_the_first_view_are_left_out() {
        let table =
            Table::of("Errors", columns("method | > error"), [vec!["MPM".into(), 0.5.to_string().into()]]);
        let details =
            Block::Details { summary: "more".to_owned(), blocks: vec![Block::Code("a\n b".to_owned())] };
        let view = |word: &str| (word.to_owned(), vec![Block::Paragraph(format!("**{word}** `x y`"))]);
        let list = Block::List(vec!["one two three four".to_owned(), "five".to_owned()]);
        let blocks = [Block::Table(table), details, Block::Switch(vec![view("first"), view("second")]), list];
        let told = "Errors\nmethod  error\nMPM       0.5\n\nfirst x y\n\none two three\n    four\nfive\n";
        assert_eq!(text_of(&blocks, 13, false).expect("a table"), told);
        assert!(text_of(&blocks, 13, true).expect("a table").contains("\nmore\na\n b\n"));
    }
}
