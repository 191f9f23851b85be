//! Reads on after mistakes: in the parsed tree a misspelt key or word becomes the one that was probably meant, and whatever
//! else cannot be read is left out. Places stay those of the text.

use crate::diagnostic::StudyError;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// A text that cannot be read as it is.
#[derive(Debug)]
pub struct Unread<T> {
    /// What is wrong.
    pub error: StudyError,
    /// What it says but for its mistakes; none where these leave nothing to read.
    pub rest: Option<Rest<T>>,
}

/// What a text with mistakes says but for these.
#[derive(Debug)]
pub struct Rest<T> {
    /// It, read.
    pub read: T,
    /// Places of the mistakes.
    pub places: Vec<Range<usize>>,
    /// Keys whose values are unknown.
    pub left_out: Vec<LeftOut>,
}

/// A key that was left out: its value is unknown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its name.
    pub key: String,
    /// The table that it belongs to.
    pub table: String,
    /// The block in which it stands; none of one that stands in a table not its own.
    pub block: Option<Block>,
}

/// A table of a study, by its name and its number among those of the name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Name.
    pub table: String,
    /// Number, from 0.
    pub number: usize,
}

impl Block {
    /// The block in which a place of the text lies: that of the last key or value before it.
    pub fn at(root: &DeTable<'_>, place: usize) -> Option<Self> {
        let blocks = root.iter().flat_map(|(name, value)| {
            let of = |number, start| (start, Self { table: name.get_ref().to_string(), number });
            let list = value.get_ref().as_array().into_iter().flat_map(|list| list.iter().enumerate());
            let items = list.map(move |(number, item)| of(number, last_start(item, place)));
            let whole = name.span().start.max(last_start(value, place).unwrap_or_default());
            items.chain([of(0, (name.span().start <= place).then_some(whole))])
        });
        let before = blocks.filter_map(|(start, block)| Some((start?, block)));
        before.min_by_key(|(start, _)| place - start).map(|(_, block)| block)
    }
}

/// Where the last key or value of a value begins that lies before a place.
fn last_start(value: &Spanned<DeValue<'_>>, place: usize) -> Option<usize> {
    let own = Some(value.span().start).filter(|start| *start <= place);
    let inner = match value.get_ref() {
        DeValue::Table(table) => {
            let keys = table.keys().map(|key| key.span().start).filter(|start| *start <= place);
            keys.chain(table.values().filter_map(|value| last_start(value, place))).max()
        }
        DeValue::Array(list) => list.iter().filter_map(|item| last_start(item, place)).max(),
        _ => None,
    };
    own.max(inner)
}

/// What becomes of the key or the value at a place.
#[derive(Debug)]
pub(crate) enum Mend {
    /// The value as TOML.
    Written(String),
    /// The value, alone in a list.
    Listed,
    /// The key by its right name.
    Renamed(String),
    /// Nothing.
    LeftOut,
}

/// The mends of a text, by their places.
#[derive(Debug, Default)]
pub(crate) struct Mends(pub(crate) Vec<(Range<usize>, Mend)>);

impl Mends {
    fn at(&self, place: &Range<usize>) -> Option<&Mend> {
        self.0.iter().find(|(known, _)| known == place).map(|(_, mend)| mend)
    }

    /// A table with its keys and values mended.
    pub(crate) fn of_table<'a>(&'a self, table: DeTable<'a>) -> DeTable<'a> {
        let entries = table.into_iter().filter_map(|(key, value)| {
            let key = match self.at(&key.span()) {
                Some(Mend::LeftOut) => return None,
                Some(Mend::Renamed(name)) => Spanned::new(key.span(), name.into()),
                _ => key,
            };
            Some((key, self.of_value(value)?))
        });
        entries.collect()
    }

    fn of_value<'a>(&'a self, value: Spanned<DeValue<'a>>) -> Option<Spanned<DeValue<'a>>> {
        let place = value.span();
        let value = match (self.at(&place), value.into_inner()) {
            (Some(Mend::LeftOut), _) => return None,
            (Some(Mend::Written(text)), before) => DeValue::parse(text).map_or(before, Spanned::into_inner),
            (Some(Mend::Listed), value) => {
                let mut list = DeArray::new();
                list.push(Spanned::new(place.clone(), value));
                DeValue::Array(list)
            }
            (_, DeValue::Table(table)) => DeValue::Table(self.of_table(table)),
            (_, DeValue::Array(list)) => {
                let mut kept = DeArray::new();
                list.into_iter().filter_map(|item| self.of_value(item)).for_each(|item| kept.push(item));
                DeValue::Array(kept)
            }
            (_, other) => other,
        };
        Some(Spanned::new(place, value))
    }
}
