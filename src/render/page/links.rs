//! Links of a page that is written twice, as HTML and as Markdown: made once, and led where each wants them.

use crate::render::page::{Block, Page};
use crate::render::table::{Cell, Table};

impl Page {
    /// The page with every target of a link replaced.
    #[must_use]
    pub fn with_links(mut self, lead_to: &dyn Fn(&str) -> String) -> Self {
        self.lead = in_text(&self.lead, lead_to);
        self.footer = in_text(&self.footer, lead_to);
        if let Some((_, text)) = &mut self.callout {
            *text = in_text(text, lead_to);
        }
        for block in self.sections.iter_mut().flat_map(|section| &mut section.blocks) {
            in_block(block, lead_to);
        }
        self
    }
}

fn in_block(block: &mut Block, lead_to: &dyn Fn(&str) -> String) {
    match block {
        Block::Paragraph(text) | Block::Callout(_, text) => *text = in_text(text, lead_to),
        Block::List(points) => {
            for point in points {
                *point = in_text(point, lead_to);
            }
        }
        Block::Table(table) => in_table(table, lead_to),
        Block::Figure(figure) => figure.caption = in_text(&figure.caption, lead_to),
        Block::Figures(figures) => {
            for figure in figures {
                figure.caption = in_text(&figure.caption, lead_to);
            }
        }
        Block::Details { blocks, .. } => {
            for block in blocks {
                in_block(block, lead_to);
            }
        }
        Block::Heading(_) => {}
    }
}

fn in_table(table: &mut Table, lead_to: &dyn Fn(&str) -> String) {
    for cell in table.rows.iter_mut().flatten() {
        if let Cell::Link { target, .. } | Cell::Evidence { target, .. } = cell {
            *target = lead_to(target);
        }
    }
}

/// Every `](target)` of a text replaced.
fn in_text(text: &str, lead_to: &dyn Fn(&str) -> String) -> String {
    let mut parts = text.split("](");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push_str("](");
        match part.split_once(')') {
            Some((target, rest)) => {
                out.push_str(&lead_to(target));
                out.push(')');
                out.push_str(rest);
            }
            None => out.push_str(part),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::page::Section;
    use crate::render::table::columns;

    #[test]
    fn every_link_of_a_page_is_led_elsewhere_and_nothing_else_changes() {
        let row = vec![Cell::Link { words: "w".into(), target: "a".into() }, "](a)".into()];
        let page = Page {
            lead: "one [x](a), (two) [y](b) and ](".into(),
            sections: vec![Section {
                blocks: vec![
                    Block::Table(Table::of("", columns("l | t"), [row])),
                    Block::Details {
                        summary: "[s](a)".into(),
                        blocks: vec![Block::List(vec!["[z](a)".into()])],
                    },
                ],
                ..Section::default()
            }],
            ..Page::default()
        };
        let led = page.with_links(&|target| format!("{target}.md"));
        assert_eq!(led.lead, "one [x](a.md), (two) [y](b.md) and ](");
        let Block::Table(table) = &led.sections[0].blocks[0] else { panic!("a table") };
        assert_eq!(table.rows[0], [Cell::Link { words: "w".into(), target: "a.md".into() }, "](a)".into()]);
        let Block::Details { summary, blocks } = &led.sections[0].blocks[1] else { panic!("details") };
        assert_eq!((summary.as_str(), &blocks[0]), ("[s](a)", &Block::List(vec!["[z](a.md)".into()])));
    }
}
