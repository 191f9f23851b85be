//! A TOML text as a tree that serde reads, in which a type can ask for its place in the text.
//!
//! `toml` has a reader of its own. It hands every table to a type through three kinds of maps (a table, a date, a value
//! with its place), so that each of our many tables is compiled three times. Here there is one kind of map and one kind
//! of list, and a place is a list of three.

use serde::de::value::StringDeserializer;
use serde::de::{
    Deserialize, DeserializeOwned, DeserializeSeed, Deserializer, Error, Expected, IntoDeserializer,
    MapAccess, SeqAccess, Unexpected, Visitor,
};
use serde::forward_to_deserialize_any;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

/// Name by which a type asks for its place: start and end as bytes of the text, and itself.
const PLACE: &str = "oedometer::place";

/// Why a text is not what it should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// What is wrong, in the words of the parser or of serde.
    pub message: String,
    /// Bytes of the text that it is about.
    pub place: Option<Range<usize>>,
}

/// Reads a text as a type.
///
/// # Errors
/// The first thing that is no TOML, or that the type does not take.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, Refusal> {
    let root = DeTable::parse(text)
        .map_err(|error| Refusal { message: error.message().to_owned(), place: error.span() })?;
    T::deserialize(Tree { place: root.span(), node: Node::Table(root.into_inner()) })
}

/// Reads a value with its place.
///
/// # Errors
/// What the value's type does not take.
pub fn with_place<'de, T: Deserialize<'de>, D: Deserializer<'de>>(tree: D) -> Result<Spanned<T>, D::Error> {
    tree.deserialize_tuple_struct(PLACE, 3, PlaceVisitor(PhantomData))
}

/// A part of the tree.
struct Tree<'a> {
    place: Range<usize>,
    node: Node<'a>,
}

/// What stands at a part of the tree.
enum Node<'a> {
    Text(DeString<'a>),
    Integer(i64),
    LongInteger(i128),
    Number(f64),
    Flag(bool),
    List(DeArray<'a>),
    Table(DeTable<'a>),
    /// Parts of the tree that stand for one: a value with its place.
    Parts(Vec<Tree<'a>>),
    /// No value of a study, and why.
    Refused(&'static str),
}

impl<'a> Tree<'a> {
    fn of(value: Spanned<DeValue<'a>>) -> Self {
        Self { place: value.span(), node: Node::of(value.into_inner()) }
    }

    /// Start, end and the value itself, as parts of one.
    fn with_its_place(self) -> Self {
        let end =
            |byte: usize| Self { place: 0..0, node: Node::Integer(i64::try_from(byte).unwrap_or(i64::MAX)) };
        let place = self.place.clone();
        let parts = vec![end(place.start), end(place.end), self];
        Self { place, node: Node::Parts(parts) }
    }
}

impl<'a> Node<'a> {
    fn of(value: DeValue<'a>) -> Self {
        match value {
            DeValue::String(text) => Self::Text(text),
            DeValue::Integer(number) => match i128::from_str_radix(number.as_str(), number.radix()) {
                Ok(number) => i64::try_from(number).map_or(Self::LongInteger(number), Self::Integer),
                Err(_) => Self::Refused("integer number overflowed"),
            },
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(value) if value.is_infinite() && !number.as_str().contains("inf") => {
                    Self::Refused("floating-point number overflowed")
                }
                Ok(value) => Self::Number(value),
                Err(_) => Self::Refused("a number that cannot be read"),
            },
            DeValue::Boolean(flag) => Self::Flag(flag),
            DeValue::Datetime(_) => Self::Refused("a date stands where none belongs"),
            DeValue::Array(list) => Self::List(list),
            DeValue::Table(table) => Self::Table(table),
        }
    }
}

impl Refusal {
    /// The refusal at a place, where it has none yet: what lies inside knows better.
    fn at(self, place: &Range<usize>) -> Self {
        Self { place: self.place.or_else(|| Some(place.clone())), ..self }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.message)
    }
}

impl std::error::Error for Refusal {}

impl Error for Refusal {
    fn custom<M: fmt::Display>(message: M) -> Self {
        Self { message: message.to_string(), place: None }
    }
}

/// What serde says of an integer of more than 64 bits, which no type of a study takes. Here and not by the visitor's
/// own method, which would be compiled for each of more than a hundred.
fn refusal_of_long(number: i128, wanted: &dyn Expected) -> Refusal {
    Error::invalid_type(Unexpected::Other(&format!("integer `{number}` as i128")), wanted)
}

impl<'de> Deserializer<'de> for Tree<'de> {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        let Self { place, node } = self;
        match node {
            Node::Text(text) => visitor.visit_str(&text),
            Node::Integer(number) => visitor.visit_i64(number),
            Node::LongInteger(number) => Err(refusal_of_long(number, &visitor)),
            Node::Number(number) => visitor.visit_f64(number),
            Node::Flag(flag) => visitor.visit_bool(flag),
            Node::List(list) => visitor.visit_seq(Elements::of(list)),
            Node::Table(table) => visitor.visit_map(Entries { left: table.into_iter(), value: None }),
            Node::Parts(parts) => visitor.visit_seq(Elements(parts.into_iter())),
            Node::Refused(why) => Err(Refusal::custom(why)),
        }
        .map_err(|refusal| refusal.at(&place))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        if name != PLACE {
            return self.deserialize_any(visitor);
        }
        self.with_its_place().deserialize_any(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        let Node::Text(word) = self.node else {
            return Err(Refusal::custom("invalid type: no word, expected a string").at(&self.place));
        };
        let word: StringDeserializer<Refusal> = word.into_owned().into_deserializer();
        visitor.visit_enum(word).map_err(|refusal| refusal.at(&self.place))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple map struct
        identifier ignored_any
    }
}

/// The elements of a list, or a place.
struct Elements<'a>(std::vec::IntoIter<Tree<'a>>);

impl<'a> Elements<'a> {
    fn of(list: DeArray<'a>) -> Self {
        let parts: Vec<Tree<'a>> = list.into_iter().map(Tree::of).collect();
        Self(parts.into_iter())
    }
}

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = Refusal;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Refusal> {
        self.0.next().map(|part| seed.deserialize(part)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The entries of a table.
struct Entries<'a> {
    left: <DeTable<'a> as IntoIterator>::IntoIter,
    value: Option<Tree<'a>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Refusal;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Refusal> {
        let Some((key, value)) = self.left.next() else { return Ok(None) };
        self.value = Some(Tree::of(value));
        let place = key.span();
        let key = Tree { place: place.clone(), node: Node::Text(key.into_inner()) };
        seed.deserialize(key).map(Some).map_err(|refusal| refusal.at(&place))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Refusal> {
        let value =
            self.value.take().ok_or_else(|| Refusal::custom("a value was asked for before its key"))?;
        let place = value.place.clone();
        seed.deserialize(value).map_err(|refusal| refusal.at(&place))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left.len())
    }
}

/// Puts a value and its place together.
struct PlaceVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for PlaceVisitor<T> {
    type Value = Spanned<T>;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("a value with its place")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut place: A) -> Result<Spanned<T>, A::Error> {
        let missing = || A::Error::custom("a place has a start, an end and a value");
        let start = place.next_element()?.ok_or_else(missing)?;
        let end = place.next_element()?.ok_or_else(missing)?;
        let value = place.next_element()?.ok_or_else(missing)?;
        Ok(Spanned::new(start..end, value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// A value with its place, as the tables of a study have it.
    #[derive(Debug)]
    struct Placed<T>(Spanned<T>);

    impl<'de, T: Deserialize<'de>> Deserialize<'de> for Placed<T> {
        fn deserialize<D: Deserializer<'de>>(tree: D) -> Result<Self, D::Error> {
            with_place(tree).map(Self)
        }
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Inner {
        word: Placed<String>,
        list: Option<Placed<Vec<Placed<f64>>>>,
        count: Option<Placed<i64>>,
        flag: Option<bool>,
        unit: Option<Unit>,
    }

    #[derive(Debug, PartialEq, serde::Deserialize)]
    #[serde(rename_all = "lowercase")]
    enum Unit {
        Metre,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Outer {
        inner: Placed<Inner>,
        #[serde(default)]
        block: Vec<Placed<Inner>>,
        #[serde(default)]
        named: BTreeMap<String, Placed<i64>>,
    }

    const TEXT: &str = "inner = { word = \"wörd\", list = [1.5, -2.5e-3], unit = \"metre\" }\n\
                        [[block]]\nword = 'a'\nflag = true\ncount = 0x1F\n[named]\nb = 2\na = 1\n";

    #[test]
    fn every_value_knows_its_bytes() {
        let outer: Outer = read(TEXT).expect("a whole text");
        let inner = outer.inner.0.get_ref();
        assert_eq!(&TEXT[inner.word.0.span()], "\"wörd\"");
        assert_eq!(inner.word.0.get_ref(), "wörd");
        let list = &inner.list.as_ref().expect("a list").0;
        assert_eq!(&TEXT[list.span()], "[1.5, -2.5e-3]");
        let values: Vec<(&str, f64)> =
            list.get_ref().iter().map(|one| (&TEXT[one.0.span()], *one.0.get_ref())).collect();
        assert_eq!(values, [("1.5", 1.5), ("-2.5e-3", -2.5e-3)]);
        assert_eq!(inner.unit, Some(Unit::Metre));
        let block = outer.block[0].0.get_ref();
        assert_eq!(
            (block.flag, block.count.as_ref().map(|count| *count.0.get_ref())),
            (Some(true), Some(31))
        );
        let named: Vec<(&str, i64)> =
            outer.named.iter().map(|(name, value)| (name.as_str(), *value.0.get_ref())).collect();
        assert_eq!(named, [("a", 1), ("b", 2)]);
    }

    #[test]
    fn places_and_refusals_are_those_of_the_parsers_own_reader() {
        for (from, to) in [
            ("\"wörd\"", "3"),
            ("\"wörd\"", "[1]"),
            ("\"wörd\"", "{ a = 1 }"),
            ("word = \"wörd\", ", ""),
            ("list", "lost"),
            ("-2.5e-3", "\"b\""),
            ("-2.5e-3", "1e999"),
            ("[1.5, -2.5e-3]", "true"),
            ("0x1F", "99999999999999999999999"),
            ("flag = true", "flag = 1"),
            ("word = 'a'", "word = 'a'\nword = 'b'"),
            ("[[block]]", "[block]"),
            ("[named]", "[[named]]"),
            ("a = 1", "a ="),
            ("\"metre\"", "\"yard\""),
        ] {
            assert!(TEXT.contains(from), "{from}");
            let text = TEXT.replacen(from, to, 1);
            let refusal = read::<Outer>(&text).expect_err(to);
            let theirs = toml::from_str::<OfTheirs>(&text).expect_err(to);
            assert_eq!(refusal.message, theirs.message(), "{to}");
            assert_eq!(refusal.place, theirs.span(), "{to}: {}", refusal.message);
        }
    }

    /// The same tables by the places of `toml` itself.
    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields, rename = "Outer")]
    #[expect(dead_code, reason = "only refused texts are read")]
    struct OfTheirs {
        inner: Spanned<InnerOfTheirs>,
        #[serde(default)]
        block: Vec<Spanned<InnerOfTheirs>>,
        #[serde(default)]
        named: BTreeMap<String, Spanned<i64>>,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields, rename = "Inner")]
    #[expect(dead_code, reason = "only refused texts are read")]
    struct InnerOfTheirs {
        word: Spanned<String>,
        list: Option<Spanned<Vec<Spanned<f64>>>>,
        count: Option<Spanned<i64>>,
        flag: Option<bool>,
        unit: Option<Unit>,
    }
}
