//! Reads TOML into a type, and explains every mistake at its place by the type's JSON Schema.

use crate::diagnostic::{Diagnostic, StudyError, near_word, one_of};
use crate::mending::{Block, LeftOut, Mend, Mends, Rest, Unread};
use crate::source::StudySource;
use crate::synonyms::{FIELD_TERMS, UnknownKey, derived, read_as};
use crate::units::{has_unit, in_si, is_thousands, leading_number};
use oedometer_case::keys::Key;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::ops::{Deref, Range};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer, Error};

/// A value with its place in the text.
#[derive(Clone, Debug, Deserialize)]
#[serde(transparent)]
pub struct Placed<T>(Spanned<T>);

/// A typed value with its place.
pub type Typed<T> = Option<Placed<T>>;

impl<T> Placed<T> {
    /// A value at a place, in bytes of the text.
    pub fn new(place: Range<usize>, value: T) -> Self {
        Self(Spanned::new(place, value))
    }

    /// Its place, in bytes of the text.
    pub fn span(&self) -> Range<usize> {
        self.0.span()
    }

    /// The value, to be changed.
    pub fn get_mut(&mut self) -> &mut T {
        self.0.as_mut()
    }
}

impl<T> Deref for Placed<T> {
    type Target = T;
    fn deref(&self) -> &T {
        self.0.get_ref()
    }
}

impl<T: JsonSchema> JsonSchema for Placed<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::schema_name()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        T::json_schema(generator)
    }
}

/// What is said where no better help is known.
const A_LINE: &str =
    "a line is `key = value`: words and numbers with units in quotes, lists in [ ], comments after #";
/// Longest excerpt of the text in a message, letters.
const LONGEST_EXCERPT: usize = 40;

impl StudySource {
    /// Reads TOML into a type.
    ///
    /// # Errors
    /// Every key that is not known, with the nearest one, and every value of a wrong kind; or where the text is not
    /// TOML.
    pub fn read<T: DeserializeOwned + JsonSchema>(&self) -> Result<T, StudyError> {
        let read = self.read_by(|root| T::deserialize(Deserializer::from(root)));
        read.map_err(|unread| unread.error)
    }

    /// Reads TOML by a function, whose refusal the schema of its type explains. Numbers with units, like `"50 kPa"`,
    /// reach it as numbers in SI units, where the schema names the unit of their key.
    ///
    /// # Errors
    /// As [`read`](Self::read), with what the text says but for its mistakes.
    pub fn read_by<T: JsonSchema>(
        &self,
        read: impl Fn(Spanned<DeTable<'_>>) -> Result<T, Error>,
    ) -> Result<T, Box<Unread<T>>> {
        let unread = |found, rest| Box::new(Unread { error: self.error(found), rest });
        let (mut root, broken) = DeTable::parse_recoverable(&self.text);
        if FIELD_TERMS.iter().any(|(term, _)| self.text.contains(term)) {
            read_terms(&schema_of::<T>(), root.as_mut());
        }
        let mut mistakes = Mistakes { text: &self.text, ..Mistakes::default() };
        match broken.as_slice() {
            [] => {}
            // The other lines are whole.
            [only] if mistakes.breaks_one_line(only) => mistakes.found.push(self.syntax(only)),
            [first, ..] => return Err(unread(vec![self.syntax(first)], None)),
        }
        let whole = if broken.is_empty() { Some(read(root.clone())) } else { None };
        whole.unwrap_or_else(|| Err(refusal())).or_else(|error| {
            mistakes.of_table(&schema_of::<T>(), root.get_ref(), 0..0, "");
            let Mistakes { found, mends, places, unknown, is_unreadable, .. } = mistakes;
            let in_block = |(place, key, home): (usize, String, Option<&'static str>)| {
                let block = Block::at(root.get_ref(), place)?;
                Some(match home {
                    Some(table) => LeftOut { key, table: table.to_owned(), block: None },
                    None => LeftOut { key, table: block.table.clone(), block: Some(block) },
                })
            };
            let left_out = unknown.into_iter().filter_map(in_block).collect();
            let place = root.span();
            let mended = || read(Spanned::new(place, mends.of_table(root.into_inner())));
            match (found.is_empty(), is_unreadable) {
                (true, _) if mends.0.is_empty() => Err(unread(vec![self.syntax(&error)], None)),
                (true, _) => mended().map_err(|error| unread(vec![self.syntax(&error)], None)),
                (false, true) => Err(unread(found, None)),
                (false, false) => {
                    let rest = mended().ok().map(|read| Rest { read, places, left_out });
                    Err(unread(found, rest))
                }
            }
        })
    }

    /// Reads TOML as it is.
    ///
    /// # Errors
    /// Where the text is not TOML.
    pub fn table(&self) -> Result<toml::Table, StudyError> {
        toml::from_str(&self.text).map_err(|error| self.error(vec![self.syntax(&error)]))
    }

    /// A complaint of the parser, with what to write where the line shows it.
    fn syntax(&self, error: &Error) -> Diagnostic {
        let start = error.span().map_or(0, |span| span.start.min(self.text.len()));
        let from = self.text.get(..start).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
        let line = self.text.get(from..).and_then(|rest| rest.lines().next()).unwrap_or_default();
        if error.message().starts_with("duplicate key")
            && let Some(span) = error.span()
        {
            let (message, help) = given_twice(&self.text, span.clone(), line);
            return Diagnostic { message, span: Some(span), help: Some(help) };
        }
        let (message, help) = line_mistake(line);
        let said = || error.message().lines().next().unwrap_or_default().to_owned();
        Diagnostic { message: message.unwrap_or_else(said), span: error.span(), help: Some(help) }
    }
}

/// What is said of a key or a table that stands at a place for the second time, in a line, with the line of the first.
fn given_twice(text: &str, place: Range<usize>, line: &str) -> (String, String) {
    let name = text.get(place.clone()).unwrap_or_default();
    let lines: Vec<&str> = text.get(..place.start).unwrap_or_default().lines().map(str::trim).collect();
    let is_table = line.trim_start().starts_with('[');
    // A key is given twice in one table; the second beginning of a table may follow a key, `column.load = …`.
    let is_header = |line: &&str| line.starts_with('[');
    let from = if is_table { 0 } else { lines.iter().rposition(is_header).map_or(0, |header| header + 1) };
    let gives = |line: &&str| {
        let key = line.trim_start_matches('[').trim_start();
        let rest = key.strip_prefix(name).map(str::trim_start);
        rest.is_some_and(|rest| rest.starts_with(['=', '.', ']'])) && (is_table || !is_header(line))
    };
    let first = lines.iter().skip(from).position(gives).map(|place| from + place + 1);
    let first = first.map_or(String::new(), |line| format!("line {line} has it too: "));
    if is_table {
        (
            format!("the table `{name}` begins a second time"),
            format!("{first}put all its keys below one `[{name}]`"),
        )
    } else {
        (format!("`{name}` is given twice"), format!("{first}leave one of them out"))
    }
}

/// What is wrong with a line that is not TOML, where the line shows it, and what to write instead.
fn line_mistake(line: &str) -> (Option<String>, String) {
    let line = line.trim_start();
    if line.starts_with('{') && !line.contains('=') {
        let help = "a study file is TOML: `oedometer new NAME` writes one";
        return (Some("this looks like JSON".to_owned()), help.to_owned());
    }
    let Some((key, value)) = line.split_once('=') else { return (None, A_LINE.to_owned()) };
    let (key, value) = (key.trim(), value.split('#').next().unwrap_or_default().trim());
    let number = leading_number(value);
    let rest = value[number.len()..].trim_start();
    let write = |right: &str| format!("write `{key} = {}`", cut(right));
    let shown = cut(value);
    if has_unit(value) {
        (Some(format!("`{shown}` needs quotes")), write(&format!("\"{value}\"")))
    } else if !number.is_empty() && rest.starts_with(|c: char| c.is_alphabetic() || c == '%') {
        let help = "write a number in SI units (m, s, Pa), or with a unit in quotes, like \"50 kPa\"; a \
                    fraction like 0.3";
        (Some(format!("`{shown}` is not a plain number")), help.to_owned())
    } else if value.starts_with(char::is_alphabetic) {
        let quoted = write(&format!("\"{}\"", value.trim_end_matches(['"', '\''])));
        (Some(format!("`{shown}` needs quotes")), quoted)
    } else if let Some((whole, decimals)) = value.split_once(',').filter(|_| is_decimal_comma(value)) {
        let shown = format!("`{shown}` has a comma in its number, or is a list without brackets");
        let thousands =
            if is_thousands(decimals) { format!(", `{key} = {whole}{decimals}`") } else { String::new() };
        (
            Some(shown),
            format!("write `{key} = {whole}.{decimals}`{thousands}, or `{key} = [{whole}, {decimals}]`"),
        )
    } else if value.contains(',') && !value.contains(['[', '{']) {
        (Some(format!("`{shown}` is neither a number nor a list")), write(&format!("[{value}]")))
    } else {
        (None, A_LINE.to_owned())
    }
}

/// Whether a text is two groups of digits with a comma and no blank between them.
fn is_decimal_comma(value: &str) -> bool {
    let is_digits = |part: &str| !part.is_empty() && part.chars().all(|letter| letter.is_ascii_digit());
    value.split_once(',').is_some_and(|(whole, decimals)| is_digits(whole) && is_digits(decimals))
}

/// Puts keys and words of the schema in place of terms of the field that are read as them.
fn read_terms(schema: &Value, table: &mut DeTable<'_>) {
    let Some(properties) = schema["properties"].as_object() else { return };
    for (term, key) in FIELD_TERMS {
        let is_meant = properties.contains_key(key) && !properties.contains_key(term);
        if is_meant
            && !table.contains_key(key)
            && let Some((name, value)) = table.remove_entry(term)
        {
            table.insert(Spanned::new(name.span(), key.into()), value);
        }
    }
    for (name, value) in table.iter_mut() {
        if let Some(schema) = properties.get(name.get_ref().as_ref()) {
            read_terms_of(schema, value);
        }
    }
}

/// The same in a value.
fn read_terms_of(schema: &Value, value: &mut Spanned<DeValue<'_>>) {
    let choices = schema["anyOf"].as_array();
    let schema =
        choices.and_then(|all| all.iter().rfind(|choice| fits(choice, value.get_ref()))).unwrap_or(schema);
    match value.as_mut() {
        DeValue::Table(table) => read_terms(schema, table),
        DeValue::Array(list) => list.iter_mut().for_each(|item| read_terms_of(&schema["items"], item)),
        DeValue::String(word) if names_of(schema).contains(&read_as(word)) => {
            let known = read_as(word).to_owned();
            *word = known.into();
        }
        _ => {}
    }
}

/// Mistakes in a text, as they are found.
#[derive(Default)]
struct Mistakes<'a> {
    text: &'a str,
    found: Vec<Diagnostic>,
    /// What becomes of wrong keys and values, and of words that are numbers with units: these in SI units.
    mends: Mends,
    /// Places of the mistakes; of a key with its value.
    places: Vec<Range<usize>>,
    /// Keys whose values are unknown: a place in their block, the name, and the table that they belong to if that is another.
    unknown: Vec<(usize, String, Option<&'static str>)>,
    /// A line that is not TOML.
    broken: Range<usize>,
    /// Whether a whole block is wrong, without which nothing can be read.
    is_unreadable: bool,
}

fn refusal() -> Error {
    serde::de::Error::custom("no TOML")
}

/// Tables of the body and its soil, on which all others rest.
const BODY: [&str; 3] = ["column", "layer", "material"];

impl Mistakes<'_> {
    /// Whether a text is broken in the line of one key alone, whose value is not known then.
    fn breaks_one_line(&mut self, error: &Error) -> bool {
        let place = error.span().map_or(0, |span| span.start.min(self.text.len()));
        let from = self.text.get(..place).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
        let line = self.text.get(from..).and_then(|rest| rest.lines().next()).unwrap_or_default();
        let is_known = line_mistake(line).0.is_some() && !line.trim_start().starts_with(['[', '{']);
        let Some((key, _)) = line.split_once('=').filter(|_| is_known) else { return false };
        self.broken = from..from + line.len();
        self.places.push(self.broken.clone());
        self.unknown.push((from, key.trim().to_owned(), None));
        true
    }

    /// Notes a mistake, and what becomes of the key or value at its place; nothing in a line that is broken.
    fn note(&mut self, place: Range<usize>, message: String, help: impl Into<String>, mend: Mend) {
        if self.broken.contains(&place.start) {
            self.mends.0.push((place, mend));
            return;
        }
        self.found.push(Diagnostic::at(place.clone(), message, help));
        self.places.push(place.clone());
        self.mends.0.push((place, mend));
    }

    /// Notes that the value of a key is not known.
    fn doubt(&mut self, place: &Range<usize>, key: &str, home: Option<&'static str>) {
        self.unknown.push((place.start, key.to_owned(), home));
    }

    /// The mistakes of a table under a key; the whole text has none.
    fn of_table(&mut self, schema: &Value, table: &DeTable<'_>, place: Range<usize>, key: &str) {
        let Some(properties) = schema["properties"].as_object() else { return };
        for (name, value) in table {
            if let Some(schema) = properties.get(name.get_ref().as_ref()) {
                self.of_value(schema, value, name.get_ref());
                continue;
            }
            let known: Vec<&str> = properties.keys().map(String::as_str).collect();
            let message = format!("unknown key `{}`", cut(name.get_ref()));
            let unknown = UnknownKey::among(name.get_ref(), &known);
            let meant = unknown.meant.filter(|meant| !table.contains_key(*meant));
            if meant.is_none() && (unknown.home.is_some() || BODY.contains(&key)) {
                self.doubt(&name.span(), name.get_ref(), unknown.home);
            }
            let mend = meant.map_or(Mend::LeftOut, |meant| Mend::Renamed(meant.to_owned()));
            self.note(name.span(), message, unknown.help, mend);
            self.places.push(value.span());
        }
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !table.contains_key(name) {
                let whole = if key.is_empty() { "the study" } else { key };
                let message = format!("`{name}` is missing in {whole}");
                let example = example_of(&properties[name]);
                self.is_unreadable |= !self.text.get(place.clone()).unwrap_or_default().starts_with('{');
                self.doubt(&place, key, None);
                self.note(place.clone(), message, format!("add `{name} = {example}`"), Mend::LeftOut);
            }
        }
    }

    fn of_value(&mut self, schema: &Value, value: &Spanned<DeValue<'_>>, key: &str) {
        let choices = schema["anyOf"].as_array();
        let fits = |choice: &&Value| fits(choice, value.get_ref());
        let schema = choices.and_then(|all| all.iter().rfind(fits)).unwrap_or(schema);
        match value.get_ref() {
            DeValue::Table(table) if kind_of(schema) == "object" => {
                self.of_table(schema, table, value.span(), key);
            }
            DeValue::Array(list) if kind_of(schema) == "array" => {
                for item in list {
                    self.of_value(&schema["items"], item, key);
                }
            }
            DeValue::String(word) if !names_of(schema).is_empty() => {
                let names = names_of(schema);
                if !names.contains(&word.as_ref()) {
                    let message = format!("no {key} is called `{}`", cut(word));
                    let mend = match near_word(word, &names) {
                        Some(near) => Mend::Written(format!("{near:?}")),
                        None => Mend::LeftOut,
                    };
                    if matches!(mend, Mend::LeftOut) {
                        self.doubt(&value.span(), key, None);
                    }
                    self.note(value.span(), message, one_of(word, &names), mend);
                }
            }
            DeValue::String(text) if schema["unit"].is_string() => {
                match in_si(text, schema["unit"].as_str().unwrap_or_default()) {
                    Ok(number) => self.mends.0.push((value.span(), Mend::Written(format!("{number:?}")))),
                    Err((message, help)) => {
                        self.doubt(&value.span(), key, None);
                        self.note(value.span(), format!("`{key}`: {message}"), help, Mend::LeftOut);
                    }
                }
            }
            other if self::fits(schema, other) => {}
            _ => self.wrong_kind(schema, value, key),
        }
    }

    fn wrong_kind(&mut self, schema: &Value, value: &Spanned<DeValue<'_>>, key: &str) {
        let written = self.text.get(value.span()).unwrap_or_default().lines().next().unwrap_or_default();
        let written = cut(written.trim());
        let kind = kind_of(schema);
        let is_block = schema["items"]["properties"].is_object();
        let is_number = ["number", "integer"].contains(&kind);
        // A value inside a list is shown inside a list.
        let before = self.text.get(..value.span().start).unwrap_or_default().trim_end();
        let in_list = |right: String| if before.ends_with(['[', ',']) { format!("[{right}]") } else { right };
        let mut mend = match kind {
            "array" | "object" => Mend::LeftOut,
            _ => Mend::Written(example_of(schema)),
        };
        let mut is_known = false;
        let help = match value.get_ref() {
            DeValue::Table(_) if is_block => {
                format!("a block that may be repeated has double brackets: [[{key}]]")
            }
            DeValue::Array(_) if kind == "object" => {
                let other = derived(key).map_or_else(String::new, |how| format!("; {how}"));
                format!("a table that appears once has single brackets: [{key}]{other}")
            }
            DeValue::Array(_) if Key::named(key, "sweep").is_some() => {
                format!("several values belong in a [[sweep]]: `{key} = {written}`")
            }
            DeValue::String(word) if is_number => match word.trim().parse::<f64>() {
                Ok(_) => {
                    (mend, is_known) = (Mend::Written(word.trim().to_owned()), true);
                    format!("write it without quotes: `{key} = {}`", in_list(word.to_string()))
                }
                Err(_) => format!(
                    "it has no unit: write it as a plain number without quotes, like `{key} = {}`",
                    example_of(schema)
                ),
            },
            typed if kind == "array" && fits(&schema["items"], typed) => {
                (mend, is_known) = (Mend::Listed, true);
                format!("write `{key} = [{written}]`")
            }
            _ => format!("write it like `{key} = {}`", in_list(example_of(schema))),
        };
        let wanted = match kind {
            "integer" => "a whole number",
            "number" => "a number",
            "boolean" => "true or false",
            "array" => "a list",
            "object" => "a table",
            _ => "a word in quotes",
        };
        self.is_unreadable |= self.text.get(value.span()).unwrap_or_default().starts_with('[')
            && matches!(value.get_ref(), DeValue::Table(_));
        self.is_unreadable |= is_block && matches!(value.get_ref(), DeValue::Table(_));
        if !is_known {
            self.doubt(&value.span(), key, None);
        }
        self.note(value.span(), format!("`{key}` takes {wanted}, not `{written}`"), help, mend);
    }
}

/// The words that a schema allows, where it names them.
fn names_of(schema: &Value) -> Vec<&str> {
    let listed = schema["enum"].as_array().into_iter().flatten();
    let described = schema["oneOf"].as_array().into_iter().flatten().map(|choice| &choice["const"]);
    listed.chain(described).filter_map(Value::as_str).collect()
}

/// The kind of value that a schema describes.
fn kind_of(schema: &Value) -> &str {
    match schema["anyOf"].as_array().and_then(|choices| choices.first()) {
        Some(first) => kind_of(first),
        // Of a number with a unit the first kind is the number.
        None => schema["type"].as_str().or(schema["type"][0].as_str()).unwrap_or("string"),
    }
}

fn fits(schema: &Value, value: &DeValue<'_>) -> bool {
    match value {
        DeValue::String(_) => kind_of(schema) == "string",
        DeValue::Integer(_) => ["integer", "number"].contains(&kind_of(schema)),
        DeValue::Float(_) => kind_of(schema) == "number",
        DeValue::Boolean(_) => kind_of(schema) == "boolean",
        DeValue::Datetime(_) => false,
        DeValue::Array(_) => kind_of(schema) == "array",
        DeValue::Table(_) => kind_of(schema) == "object",
    }
}

/// A value that a schema takes, as one writes it.
fn example_of(schema: &Value) -> String {
    if let Some(first) = schema["anyOf"].as_array().and_then(|choices| choices.first()) {
        return example_of(first);
    }
    if let Some(word) = schema["enum"].as_array().and_then(|words| words.first()) {
        return word.to_string();
    }
    match kind_of(schema) {
        "integer" => "10".to_owned(),
        "number" => "0.1".to_owned(),
        "boolean" => "true".to_owned(),
        "array" => format!("[{}]", example_of(&schema["items"])),
        "object" => {
            let required: Vec<&str> =
                schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
            let of_properties = schema["properties"].as_object().into_iter().flatten();
            let shown =
                of_properties.filter(|(name, _)| required.is_empty() || required.contains(&name.as_str()));
            let shown: Vec<String> = shown
                .take(required.len().max(1))
                .map(|(name, inner)| format!("{name} = {}", example_of(inner)))
                .collect();
            format!("{{ {} }}", shown.join(", "))
        }
        _ => "\"...\"".to_owned(),
    }
}

/// The beginning of a text.
fn cut(text: &str) -> &str {
    text.char_indices().nth(LONGEST_EXCERPT).map_or(text, |(end, _)| &text[..end])
}

/// The JSON Schema of a type that is read from TOML, which has no null: a key is left out instead.
pub fn schema_of<T: JsonSchema>() -> Value {
    without_null(plain_schema_of::<T>())
}

/// The JSON Schema of a type in one piece.
pub fn plain_schema_of<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().for_deserialize();
    let settings = settings.with(|settings| settings.inline_subschemas = true);
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

fn without_null(mut schema: Value) -> Value {
    if let Some(list) = schema.as_array_mut() {
        list.retain(|value| ![json!(null), json!("null"), json!({ "type": "null" })].contains(value));
    }
    let mut schema = each_part(schema, without_null);
    if let Some(object) = schema.as_object_mut() {
        for word in ["type", "anyOf"] {
            let Some([only]) = object.get(word).and_then(Value::as_array).map(Vec::as_slice) else {
                continue;
            };
            match only.clone() {
                Value::Object(choice) => {
                    object.remove(word);
                    // The description of the key takes precedence over that of its type.
                    let own = std::mem::replace(object, choice);
                    object.extend(own);
                }
                other => drop(object.insert(word.to_owned(), other)),
            }
        }
    }
    schema
}

/// A value with every part of it changed.
pub fn each_part(value: Value, change: fn(Value) -> Value) -> Value {
    match value {
        Value::Array(list) => list.into_iter().map(change).collect(),
        Value::Object(object) => object.into_iter().map(|(word, value)| (word, change(value))).collect(),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_is_no_toml_is_told_by_what_it_shows() {
        let plain = "write a number in SI units (m, s, Pa), or with a unit in quotes, like \"50 kPa\"; a fraction like 0.3";
        for (line, message, help) in [
            (
                "{\"title\": 1}",
                Some("this looks like JSON"),
                "a study file is TOML: `oedometer new NAME` writes one",
            ),
            ("  {", Some("this looks like JSON"), "a study file is TOML: `oedometer new NAME` writes one"),
            ("{ a = 1", None, A_LINE),
            ("porosity 0.3", None, A_LINE),
            ("cells = [4, 8", None, A_LINE),
            ("a = { b = 1, c = 2", None, A_LINE),
            ("a = 0.3 0.4", None, A_LINE),
            ("load=5 kPa # soft", Some("`5 kPa` needs quotes"), "write `load = \"5 kPa\"`"),
            ("load = 5kpa", Some("`5kpa` needs quotes"), "write `load = \"5kpa\"`"),
            ("load = 5 clay", Some("`5 clay` is not a plain number"), plain),
            ("n = 30%", Some("`30%` is not a plain number"), plain),
            ("law = linear\"", Some("`linear\"` needs quotes"), "write `law = \"linear\"`"),
            (
                "porosity = 0,3",
                Some("`0,3` has a comma in its number, or is a list without brackets"),
                "write `porosity = 0.3`, or `porosity = [0, 3]`",
            ),
            (
                "load = 1,500",
                Some("`1,500` has a comma in its number, or is a list without brackets"),
                "write `load = 1.500`, `load = 1500`, or `load = [1, 500]`",
            ),
            ("cells = 4, 8 # two", Some("`4, 8` is neither a number nor a list"), "write `cells = [4, 8]`"),
        ] {
            assert_eq!(line_mistake(line), (message.map(str::to_owned), help.to_owned()), "{line}");
        }
        let word = "x".repeat(45);
        assert_eq!(line_mistake(&format!("a = {word}")).0, Some(format!("`{}` needs quotes", &word[..40])));
    }

    #[test]
    fn a_key_or_a_table_that_is_given_twice_is_told_with_the_line_of_the_first() {
        let again = |line: usize| format!("line {line} has it too: ");
        let (out, one) = ("leave one of them out", "put all its keys below one");
        for (text, message, help) in [
            ("a = 1\nb = 2\na = 3\n", "`a` is given twice", again(1) + out),
            ("a = 1\n[t]\na = 2\nab = 4\na= 3\n", "`a` is given twice", again(3) + out),
            ("[[s]]\nm = 1\n[[s]]\nm = 1\nm = 2\n", "`m` is given twice", again(4) + out),
            (
                "[t]\na = 1\n[u]\n[t]\nb = 2\n",
                "the table `t` begins a second time",
                again(1) + one + " `[t]`",
            ),
            ("t.a = 1\n[t]\nb = 2\n", "the table `t` begins a second time", again(1) + one + " `[t]`"),
            ("t = { a = 1 }\n[t]\n", "the table `t` begins a second time", again(1) + one + " `[t]`"),
        ] {
            let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
            let error = source.table().expect_err(text);
            let told: Vec<_> =
                error.diagnostics.iter().map(|one| (one.message.as_str(), one.help.as_deref())).collect();
            assert_eq!(told, [(message, Some(help.as_str()))], "{text}");
        }
    }
}
