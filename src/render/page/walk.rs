//! The walk over a page: a format is a writer of the same pieces in the same order.

use crate::render::RenderError;
use crate::render::page::{Block, Figure, Page, Section, table_file};
use crate::render::table::Table;

/// Pieces that stand together.
pub(super) enum Group<'a> {
    /// A section.
    Section(&'a Section),
    /// Figures side by side.
    Row,
    /// Blocks with others beside them.
    Beside,
    /// The blocks that have others beside them.
    Main,
    /// Those others.
    Aside,
    /// Views of which one is shown at a time, by their words, and their number among those of a page.
    Switch(usize, Vec<&'a str>),
    /// One of the views, by its place and its word.
    View(usize, &'a str),
    /// What the reader opens by this line.
    Details(&'a str),
}

/// A format.
pub(super) trait Writer<'a> {
    fn paragraph(&mut self, _marked: &'a str) {}
    fn code(&mut self, _lines: &'a str) {}
    fn heading(&mut self, _words: &'a str) {}
    fn list(&mut self, _points: &'a [String]) {}

    /// A table with the name of its file, where the page has files.
    fn table(&mut self, table: &'a Table, file: Option<String>) -> Result<(), RenderError>;

    /// A figure with its number on the page; one of the paper has the paper's.
    fn figure(&mut self, figure: &'a Figure, number: Option<usize>) -> Result<(), RenderError>;

    /// Begins a group; `false` where the format leaves it out.
    fn open(&mut self, _group: &Group<'a>) -> bool {
        true
    }

    fn close(&mut self, _group: &Group<'a>) {}
}

/// What has been met on the way.
#[derive(Default)]
pub(super) struct Walk<'p> {
    files: Option<&'p str>,
    figures: usize,
    tables: usize,
    switches: usize,
}

impl Walk<'_> {
    /// The sections of a page.
    pub fn page<'a>(page: &'a Page, writer: &mut impl Writer<'a>) -> Result<(), RenderError> {
        let mut walk = Walk { files: page.files.as_deref(), ..Walk::default() };
        page.sections
            .iter()
            .try_for_each(|section| walk.group(&Group::Section(section), &section.blocks, writer))
    }

    pub fn blocks<'a>(
        &mut self,
        blocks: &'a [Block],
        writer: &mut impl Writer<'a>,
    ) -> Result<(), RenderError> {
        blocks.iter().try_for_each(|block| self.block(block, writer))
    }

    fn block<'a>(&mut self, block: &'a Block, writer: &mut impl Writer<'a>) -> Result<(), RenderError> {
        match block {
            Block::Paragraph(text) => writer.paragraph(text),
            Block::Code(text) => writer.code(text),
            Block::Heading(text) => writer.heading(text),
            Block::List(points) => writer.list(points),
            Block::Table(table) => {
                self.tables += usize::from(table.file.is_none());
                writer.table(table, self.files.map(|page| table_file(page, self.tables, table)))?;
            }
            Block::Figure(figure) => self.figure(figure, writer)?,
            Block::Figures(figures) => {
                if writer.open(&Group::Row) {
                    figures.iter().try_for_each(|figure| self.figure(figure, writer))?;
                    writer.close(&Group::Row);
                }
            }
            Block::Beside(main, aside) => {
                if writer.open(&Group::Beside) {
                    self.group(&Group::Main, main, writer)?;
                    self.group(&Group::Aside, aside, writer)?;
                    writer.close(&Group::Beside);
                }
            }
            Block::Switch(views) => self.views(views, writer)?,
            Block::Details { summary, blocks } => self.group(&Group::Details(summary), blocks, writer)?,
        }
        Ok(())
    }

    fn group<'a>(
        &mut self,
        group: &Group<'a>,
        blocks: &'a [Block],
        writer: &mut impl Writer<'a>,
    ) -> Result<(), RenderError> {
        if writer.open(group) {
            self.blocks(blocks, writer)?;
            writer.close(group);
        }
        Ok(())
    }

    /// Views stand in one place: a figure of each has the same number.
    fn views<'a>(
        &mut self,
        views: &'a [(String, Vec<Block>)],
        writer: &mut impl Writer<'a>,
    ) -> Result<(), RenderError> {
        self.switches += 1;
        let group = Group::Switch(self.switches, views.iter().map(|(word, _)| word.as_str()).collect());
        if !writer.open(&group) {
            return Ok(());
        }
        let (first, mut last) = (self.figures, self.figures);
        for (place, (word, blocks)) in views.iter().enumerate() {
            self.figures = first;
            self.group(&Group::View(place, word), blocks, writer)?;
            last = last.max(self.figures);
        }
        self.figures = last;
        writer.close(&group);
        Ok(())
    }

    fn figure<'a>(&mut self, figure: &'a Figure, writer: &mut impl Writer<'a>) -> Result<(), RenderError> {
        let is_papers = figure.chart.title.starts_with("Fig. ");
        self.figures += usize::from(!is_papers);
        writer.figure(figure, (!is_papers).then_some(self.figures))
    }
}
