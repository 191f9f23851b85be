//! A deserialiser that hands out dummies and notes what was asked for: the shape of a type as the
//! program itself reads it, so that a schema cannot fall behind the code.

use crate::schema::node::{Field, Node};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer, MapAccess,
    SeqAccess, VariantAccess, Visitor, value::Error,
};

/// Rounds after which a type with ever new variants is given up.
const MOST_ROUNDS: usize = 200;

/// The shape of a type.
///
/// # Errors
/// When the type refuses dummies.
pub fn shape_of<T: DeserializeOwned>() -> Result<Node, Error> {
    let mut node = Node::Unseen;
    for _ in 0..MOST_ROUNDS {
        T::deserialize(Tracer { node: &mut node, omitted: None })?;
        if !node.is_incomplete() {
            break;
        }
    }
    let paths = field_paths(&node);
    for path in paths {
        let mut scratch = node.clone();
        let omitted = Omission { path: &path, at: 0 };
        let read = T::deserialize(Tracer { node: &mut scratch, omitted: Some(omitted) });
        if let Some(field) = field_at(&mut node, &path) {
            field.required = read.is_err_and(|error| error.to_string().starts_with("missing field"));
        }
    }
    Ok(node)
}

/// One field that is left out, by the places of fields from the root.
#[derive(Clone, Copy)]
struct Omission<'a> {
    path: &'a [usize],
    at: usize,
}

impl<'a> Omission<'a> {
    /// Whether this field is the one.
    fn is(self, field: usize) -> bool {
        self.at + 1 == self.path.len() && self.path[self.at] == field
    }

    /// The omission below a field, where it leads there.
    fn below(self, field: usize) -> Option<Omission<'a>> {
        (self.at + 1 < self.path.len() && self.path[self.at] == field)
            .then_some(Omission { at: self.at + 1, ..self })
    }
}

/// Paths of all fields that every round reaches: variants that hold something are left out.
fn field_paths(node: &Node) -> Vec<Vec<usize>> {
    match node {
        Node::Optional(inner) | Node::List(inner) | Node::Map(inner) => field_paths(inner),
        Node::Object(fields) => fields
            .iter()
            .enumerate()
            .flat_map(|(place, field)| {
                let below =
                    field_paths(&field.node).into_iter().map(move |rest| [vec![place], rest].concat());
                std::iter::once(vec![place]).chain(below)
            })
            .collect(),
        _ => Vec::new(),
    }
}

fn field_at<'a>(node: &'a mut Node, path: &[usize]) -> Option<&'a mut Field> {
    match node {
        Node::Optional(inner) | Node::List(inner) | Node::Map(inner) => field_at(inner, path),
        Node::Object(fields) => match path {
            [place] => fields.get_mut(*place),
            [place, rest @ ..] => field_at(&mut fields.get_mut(*place)?.node, rest),
            [] => None,
        },
        _ => None,
    }
}

struct Tracer<'a> {
    node: &'a mut Node,
    omitted: Option<Omission<'a>>,
}

/// Notes a shape and hands out a dummy.
macro_rules! scalars {
    ($($method:ident => $node:ident, $visit:ident($dummy:expr);)+) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            *self.node = Node::$node;
            visitor.$visit($dummy)
        })+
    };
}

impl<'de> Deserializer<'de> for Tracer<'_> {
    type Error = Error;

    scalars! {
        deserialize_bool => Boolean, visit_bool(false);
        deserialize_i8 => Integer, visit_i8(1);
        deserialize_i16 => Integer, visit_i16(1);
        deserialize_i32 => Integer, visit_i32(1);
        deserialize_i64 => Integer, visit_i64(1);
        deserialize_u8 => Integer, visit_u8(1);
        deserialize_u16 => Integer, visit_u16(1);
        deserialize_u32 => Integer, visit_u32(1);
        deserialize_u64 => Integer, visit_u64(1);
        deserialize_f32 => Number, visit_f32(1.0);
        deserialize_f64 => Number, visit_f64(1.0);
        deserialize_char => Text, visit_char(',');
        deserialize_str => Text, visit_str("");
        deserialize_string => Text, visit_str("");
        deserialize_identifier => Text, visit_str("");
        deserialize_any => Any, visit_str("");
        deserialize_ignored_any => Any, visit_str("");
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_bytes(&[])
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_bytes(&[])
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let inner = inside(self.node, Node::Optional);
        visitor.visit_some(Tracer { node: inner, omitted: self.omitted })
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_unit()
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_unit()
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let inner = inside(self.node, Node::List);
        visitor.visit_seq(Elements { node: inner, omitted: self.omitted, left: 1 })
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Error> {
        let inner = inside(self.node, Node::List);
        visitor.visit_seq(Elements { node: inner, omitted: self.omitted, left: length })
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_tuple(length, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let inner = inside(self.node, Node::Map);
        visitor.visit_map(Entry { node: inner, done: false })
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        // A value with its place in the text has the shape of the value.
        if toml_spanned::is(name, names) {
            return visitor.visit_map(toml_spanned::Parts { tracer: Some(self), names, next: 0 });
        }
        if *self.node == Node::Unseen {
            let field = |name: &&str| Field { name: (*name).to_owned(), required: false, node: Node::Unseen };
            *self.node = Node::Object(names.iter().map(field).collect());
        }
        let Node::Object(fields) = self.node else {
            return Err(Error::custom("one type has two shapes"));
        };
        visitor.visit_map(Fields { known: fields, names, next: 0, omitted: self.omitted })
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if *self.node == Node::Unseen {
            let variants = names.iter().map(|name| ((*name).to_owned(), Some(Node::Unseen)));
            *self.node = Node::OneOf(variants.collect());
        }
        let Node::OneOf(variants) = self.node else {
            return Err(Error::custom("one type has two shapes"));
        };
        let unseen = |held: &Option<Node>| {
            held.as_ref().is_some_and(|held| *held == Node::Unseen || held.is_incomplete())
        };
        let place = variants.iter().position(|(_, held)| unseen(held)).unwrap_or(0);
        visitor.visit_enum(Variant { name: names[place], held: &mut variants[place].1 })
    }
}

/// The shape inside a wrapper, made where it is not there yet.
fn inside(node: &mut Node, wrap: fn(Box<Node>) -> Node) -> &mut Node {
    if *node == Node::Unseen {
        *node = wrap(Box::default());
    }
    match node {
        Node::Optional(inner) | Node::List(inner) | Node::Map(inner) => inner,
        other => other,
    }
}

struct Elements<'a> {
    node: &'a mut Node,
    omitted: Option<Omission<'a>>,
    left: usize,
}

impl<'de> SeqAccess<'de> for Elements<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        seed.deserialize(Tracer { node: self.node, omitted: self.omitted }).map(Some)
    }
}

struct Entry<'a> {
    node: &'a mut Node,
    done: bool,
}

impl<'de> MapAccess<'de> for Entry<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        if std::mem::replace(&mut self.done, true) {
            return Ok(None);
        }
        seed.deserialize("key".into_deserializer()).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        seed.deserialize(Tracer { node: self.node, omitted: None })
    }
}

struct Fields<'a> {
    known: &'a mut Vec<Field>,
    names: &'static [&'static str],
    next: usize,
    omitted: Option<Omission<'a>>,
}

impl<'de> MapAccess<'de> for Fields<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        if self.omitted.is_some_and(|omitted| omitted.is(self.next)) {
            self.next += 1;
        }
        let Some(name) = self.names.get(self.next) else { return Ok(None) };
        seed.deserialize((*name).into_deserializer()).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let place = self.next;
        self.next += 1;
        let omitted = self.omitted.and_then(|omitted| omitted.below(place));
        seed.deserialize(Tracer { node: &mut self.known[place].node, omitted })
    }
}

struct Variant<'a> {
    name: &'static str,
    held: &'a mut Option<Node>,
}

impl<'de> EnumAccess<'de> for Variant<'_> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Error> {
        let name: serde::de::value::StrDeserializer<'_, Error> = self.name.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        *self.held = None;
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        let node = self.held.get_or_insert_default();
        seed.deserialize(Tracer { node, omitted: None })
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Error> {
        let node = self.held.get_or_insert_default();
        Tracer { node, omitted: None }.deserialize_tuple(length, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let node = self.held.get_or_insert_default();
        Tracer { node, omitted: None }.deserialize_struct("", names, visitor)
    }
}

/// `toml::Spanned`, which asks for start, end and value under private names.
mod toml_spanned {
    use crate::schema::tracer::{Error, Tracer};
    use serde::de::value::BorrowedStrDeserializer;
    use serde::de::{DeserializeSeed, IntoDeserializer, MapAccess};

    /// Whether a struct is one.
    pub fn is(name: &str, names: &[&str]) -> bool {
        name.starts_with("$__") && names.len() == 3
    }

    pub struct Parts<'a> {
        pub tracer: Option<Tracer<'a>>,
        pub names: &'static [&'static str],
        pub next: usize,
    }

    impl<'de> MapAccess<'de> for Parts<'_> {
        type Error = Error;

        fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
            let Some(name) = self.names.get(self.next) else { return Ok(None) };
            seed.deserialize(BorrowedStrDeserializer::new(name)).map(Some)
        }

        fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
            let is_place = self.names[self.next].ends_with("start") || self.names[self.next].ends_with("end");
            self.next += 1;
            match self.tracer.take() {
                Some(tracer) if !is_place => seed.deserialize(tracer),
                tracer => {
                    self.tracer = tracer;
                    seed.deserialize(0_usize.into_deserializer())
                }
            }
        }
    }
}
