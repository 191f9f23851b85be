//! The text of a table: its separator, its decimal sign and the line that names its columns, declared or found where one
//! choice is left.

use crate::import::mapping::TableLayout;
use oedometer_formats::{ImportError, bare_number, excerpt, input_file, with_exponent};
use oedometer_input::units::is_unit;
use std::path::Path;

/// Separators in the order in which they are tried; a blank stands for any.
const SEPARATORS: [char; 4] = [';', '\t', ',', ' '];

/// Marks of comments; without a declared one, that with which the text begins counts.
const COMMENTS: [char; 3] = ['#', '%', '!'];

/// A table as text with commas or another single separator, and what was found of it.
#[derive(Debug)]
pub struct CsvText {
    /// The text, line by line as in the file.
    pub text: Vec<u8>,
    /// The separator in it.
    pub delimiter: u8,
    /// Mark at the start of a comment line.
    pub comment: Option<char>,
    /// Whether a comma begins the fraction of a number.
    pub has_decimal_comma: bool,
    /// Names of the columns, where the text itself does not begin with them.
    pub names: Option<Vec<String>>,
    /// Units of the columns, where a row below the names has them.
    pub units: Vec<String>,
    /// Whether its last line ends.
    pub is_ended: bool,
}

/// How the lines of a table are split.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dialect {
    delimiter: char,
    has_decimal_comma: bool,
}

impl CsvText {
    /// Reads a table.
    ///
    /// # Errors
    /// When it cannot be read, or leaves more than one choice.
    pub fn read(path: &Path, layout: &TableLayout) -> Result<Self, ImportError> {
        let text = input_file::read(path).map_err(ImportError::io(path))?;
        Self::of(text, layout).map_err(|why| ImportError::content(path, why))
    }

    fn of(text: Vec<u8>, layout: &TableLayout) -> Result<Self, String> {
        let is_ended = text.last().is_none_or(|last| [b'\n', b'\r'].contains(last));
        // What is no UTF-8 is taken for Latin-1, whose bytes are characters.
        let text = String::from_utf8(text)
            .unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect());
        let begins = |mark: &char| text.trim_start().starts_with(*mark);
        let comment = match layout.comment {
            Some('#') => COMMENTS.into_iter().find(begins).or(layout.comment),
            declared => declared,
        };
        let is_comment = |line: &str| comment.is_some_and(|mark| line.trim_start().starts_with(mark));
        let (text, units) = regular(text, &is_comment);
        let mut lines = text.lines().filter(|line| !line.trim().is_empty());
        let comments: Vec<&str> = lines.clone().take_while(|line| is_comment(line)).collect();
        let mut rows = lines.by_ref().filter(|line| !is_comment(line));
        let (first, second) = (rows.next().unwrap_or_default(), rows.next());
        // Numbers alone are no names, and below them there is nothing else to learn.
        let is_first_data = layout.header == Some(false)
            || (layout.header.is_none()
                && dialects(first, layout).iter().any(|dialect| dialect.are_numbers(first)));
        let sample = if is_first_data { Some(first) } else { second };
        let header = if is_first_data { None } else { Some(first) };
        let dialect = dialect_of(sample, header, layout)?;
        let columns = dialect.split(sample.unwrap_or(first)).len();
        let names = match header {
            // The names may be separated otherwise than the numbers.
            Some(header) if dialect.split(header).len() != columns => names_of(header, columns),
            Some(_) => None,
            None => {
                let mark = comment.unwrap_or('#');
                let mut above = comments.iter().rev().map(|line| line.trim_start().trim_start_matches(mark));
                let named = above.find_map(|line| names_of(line, columns));
                Some(named.unwrap_or_else(|| (1..=columns).map(|number| number.to_string()).collect()))
            }
        };
        let drops_header = header.is_some() && names.is_some();
        let has_decimal_comma = dialect.has_decimal_comma;
        if dialect.delimiter != ' ' && !drops_header {
            let delimiter = u8::try_from(dialect.delimiter).unwrap_or(b',');
            return Ok(Self {
                text: text.into_bytes(),
                delimiter,
                comment,
                has_decimal_comma,
                names,
                units,
                is_ended,
            });
        }
        // One line for each, so that messages name the lines of the file.
        let mut rewritten = String::with_capacity(text.len());
        let mut is_header = drops_header;
        for line in text.lines() {
            if is_comment(line) || line.trim().is_empty() {
            } else if is_header {
                is_header = false;
            } else if dialect.delimiter == ' ' {
                rewritten.push_str(&dialect.split(line).join(";"));
            } else {
                rewritten.push_str(line);
            }
            rewritten.push('\n');
        }
        let delimiter =
            if dialect.delimiter == ' ' { b';' } else { u8::try_from(dialect.delimiter).unwrap_or(b',') };
        Ok(Self {
            delimiter,
            comment,
            has_decimal_comma,
            names,
            units,
            is_ended,
            text: rewritten.into_bytes(),
        })
    }
}

/// A text without what stands between its names and numbers, line by line as in the file: a row of units, which is returned,
/// names that are repeated, and a separator at the end of each row.
fn regular(text: String, is_comment: &dyn Fn(&str) -> bool) -> (String, Vec<String>) {
    let lines = || text.lines().filter(|line| !line.trim().is_empty() && !is_comment(line));
    let (Some(first), Some(second)) = (lines().next(), lines().nth(1)) else { return (text, Vec::new()) };
    let separator = SEPARATORS.into_iter().find(|separator| first.trim().contains(*separator));
    let Some(separator) = separator else { return (text, Vec::new()) };
    let fields = |line: &str| -> Vec<String> {
        let dialect = Dialect { delimiter: separator, has_decimal_comma: false };
        dialect.split(line.trim()).iter().map(|field| field.trim_matches('"').trim().to_owned()).collect()
    };
    let names = fields(first);
    let are_names =
        names.iter().all(|name| number_of(name, false).is_none() && number_of(name, true).is_none());
    let bare = |unit: &String| unit.trim_matches(['[', ']', '(', ')', '<', '>']).trim().to_owned();
    let units: Vec<String> = fields(second).iter().map(bare).collect();
    let is_unit_or_none = |unit: &String| ["", "-", "–", "1"].contains(&unit.as_str()) || is_unit(unit);
    let are_units = are_names
        && units.len() == names.len()
        && units.iter().any(|unit| is_unit(unit))
        && units.iter().all(is_unit_or_none);
    let ends = |line: &str| separator != ' ' && line.trim_end_matches([' ', '\r']).ends_with(separator);
    let are_ended = lines().skip(1).all(ends)
        && (ends(first) != are_names)
        && fields(second).len() == names.len() + usize::from(are_names);
    let is_repeated = are_names && lines().skip(1).any(|line| line.trim() == first.trim());
    if !(are_units || are_ended || is_repeated) {
        return (text, Vec::new());
    }
    let mut rewritten = String::with_capacity(text.len());
    let mut is_first = true;
    for line in text.lines() {
        let is_row = !line.trim().is_empty() && !is_comment(line);
        let is_left_out = is_row
            && !is_first
            && (is_repeated && line.trim() == first.trim() || are_units && line == second);
        if !is_left_out {
            let is_cut = are_ended && is_row && ends(line);
            rewritten.push_str(if is_cut {
                line.trim_end_matches([' ', '\r']).strip_suffix(separator).unwrap_or(line)
            } else {
                line
            });
        }
        is_first &= !is_row;
        rewritten.push('\n');
    }
    let units = if are_units { units } else { Vec::new() };
    (rewritten, units)
}

/// The first byte of a record that begins at a byte of a text or below the comments and blank lines there, and its line from 1;
/// `known` is a byte above it with its line.
pub fn line_of_record(text: &[u8], byte: u64, comment: Option<char>, known: (usize, u64)) -> (usize, u64) {
    let (known, line) = known;
    let mut at = usize::try_from(byte).map_or(text.len(), |byte| byte.clamp(known, text.len()));
    let mut line = line + text[known..at].split(|letter| *letter == b'\n').skip(1).count() as u64;
    let is_skipped = |record: &[u8]| {
        let record = record.trim_ascii();
        record.is_empty()
            || comment.and_then(|mark| u8::try_from(mark).ok()).is_some_and(|mark| record[0] == mark)
    };
    while let Some(end) = text[at..].iter().position(|letter| *letter == b'\n')
        && is_skipped(&text[at..at + end])
    {
        at += end + 1;
        line += 1;
    }
    (at, line)
}

/// Names in a line, if there are as many as columns, whatever separates them.
fn names_of(line: &str, columns: usize) -> Option<Vec<String>> {
    let split = |separator: char| {
        let dialect = Dialect { delimiter: separator, has_decimal_comma: false };
        let names: Vec<String> =
            dialect.split(line).iter().map(|name| name.trim().trim_matches('"').to_owned()).collect();
        // A line with separators is not the name of a single column.
        let is_split = columns > 1 || !line.contains(&SEPARATORS[..3]);
        let is_whole = names.len() == columns && names.iter().all(|name| !name.is_empty());
        (is_split && is_whole).then_some(names)
    };
    SEPARATORS.into_iter().find_map(split)
}

/// The dialects that a layout leaves open for a line.
fn dialects(line: &str, layout: &TableLayout) -> Vec<Dialect> {
    let separators = SEPARATORS.into_iter().filter(|separator| match separator {
        ' ' => true,
        separator => line.contains(*separator),
    });
    let separators: Vec<char> = layout.delimiter.map_or_else(|| separators.collect(), |given| vec![given]);
    let commas: Vec<bool> = layout.decimal.map_or_else(|| vec![false, true], |sign| vec![sign == ',']);
    separators
        .iter()
        .flat_map(|delimiter| {
            commas.iter().map(|comma| Dialect { delimiter: *delimiter, has_decimal_comma: *comma })
        })
        .filter(|dialect| !(dialect.has_decimal_comma && dialect.delimiter == ','))
        .collect()
}

/// The dialect of a table by a line with numbers, and the line with the names.
fn dialect_of(sample: Option<&str>, header: Option<&str>, layout: &TableLayout) -> Result<Dialect, String> {
    let open = dialects(sample.or(header).unwrap_or_default(), layout);
    let delimiter = layout.delimiter.unwrap_or_else(|| {
        let has = |separator: &&char| header.is_some_and(|header| header.contains(**separator));
        SEPARATORS[..3].iter().find(has).copied().unwrap_or(',')
    });
    let has_commas =
        || delimiter != ',' && sample.is_some_and(|sample| sample.contains(',') && !sample.contains('.'));
    let has_decimal_comma = layout.decimal.map_or_else(has_commas, |sign| sign == ',');
    let fallback = Dialect { delimiter, has_decimal_comma };
    let Some(sample) = sample else { return Ok(fallback) };
    // As many names as columns, and as many numbers as can be.
    let count = |dialect: &Dialect| dialect.split(sample).len();
    let has_names = |dialect: &Dialect| {
        header.is_none_or(|header| {
            let own = Dialect { delimiter: dialect.delimiter, has_decimal_comma: false };
            own.split(header).len() == count(dialect) || names_of(header, count(dialect)).is_some()
        })
    };
    let mut fit: Vec<Dialect> = open
        .into_iter()
        .filter(|dialect| dialect.are_numbers(sample) && has_names(dialect) && count(dialect) > 1)
        .collect();
    // A sign of the fraction that no number has is none.
    let has_fraction =
        |dialect: &Dialect| dialect.has_decimal_comma && !dialect.split(sample).concat().contains(',');
    fit.retain(|dialect| !has_fraction(dialect));
    let names = header.map(|header| fallback.split(header).len());
    match fit[..] {
        [] if fallback.delimiter == ','
            && names.is_some_and(|names| names > 1 && 2 * names == count(&fallback)) =>
        {
            Err(format!(
                "`{}` has twice as many fields as there are names: if commas are decimal separators, use \
                 another column separator",
                excerpt(sample)
            ))
        }
        [] => Ok(fallback),
        [only] => Ok(only),
        [first, ..] => {
            let numbers = |dialect: &Dialect| -> Vec<Option<f64>> {
                let fields = dialect.split(sample);
                fields.iter().map(|field| number_of(field, dialect.has_decimal_comma)).collect()
            };
            if fit.iter().all(|dialect| numbers(dialect) == numbers(&first)) {
                return Ok(first);
            }
            Err(format!(
                "`{}` may have {} columns: set `delimiter` and `decimal` in [csv]",
                excerpt(sample),
                fit.iter().map(|dialect| count(dialect).to_string()).collect::<Vec<_>>().join(" or ")
            ))
        }
    }
}

impl Dialect {
    /// The fields of a line.
    fn split(self, line: &str) -> Vec<&str> {
        match self.delimiter {
            ' ' => line.split_whitespace().collect(),
            delimiter => line.split(delimiter).map(str::trim).collect(),
        }
    }

    /// Whether all fields of a line are numbers.
    fn are_numbers(self, line: &str) -> bool {
        let fields = self.split(line);
        !fields.is_empty() && fields.iter().all(|field| number_of(field, self.has_decimal_comma).is_some())
    }
}

/// A number as programs write it: with a comma, with Fortran's `D` before the exponent, or with no letter there.
pub fn number_of(typed: &str, has_decimal_comma: bool) -> Option<f64> {
    let typed = bare_number(typed);
    if let Ok(number) = typed.parse() {
        // What has a comma is none without.
        return Some(number);
    }
    let plain: String = typed
        .trim_matches('"')
        .chars()
        .map(|symbol| match symbol {
            'd' | 'D' => 'e',
            ',' if has_decimal_comma => '.',
            symbol => symbol,
        })
        .collect();
    let is_number = plain.chars().all(|symbol| symbol.is_ascii_digit() || "+-.eE".contains(symbol));
    plain.parse().ok().or_else(|| with_exponent(&plain)?.parse().ok()).filter(|_| is_number)
}

/// Signs that stand between thousands, beside the one that does not begin fractions.
const BETWEEN_THOUSANDS: [char; 5] = ['\'', '’', '\u{a0}', '\u{202f}', ' '];

/// A number with signs between its thousands, and whether nothing else can be meant: `19.937` under a decimal comma may be a
/// fraction.
pub fn number_of_thousands(typed: &str, has_decimal_comma: bool) -> Option<(f64, bool)> {
    let typed = typed.trim().trim_matches('"');
    let (decimal, other) = if has_decimal_comma { (',', '.') } else { ('.', ',') };
    let digits = typed.trim_start_matches(['+', '-']);
    let between = digits.chars().find(|letter| *letter == other || BETWEEN_THOUSANDS.contains(letter))?;
    let (whole, fraction) =
        digits.split_once(decimal).map_or((digits, None), |(whole, rest)| (whole, Some(rest)));
    let groups: Vec<&str> = whole.split(between).collect();
    let is_digits = |group: &str| group.bytes().all(|digit| digit.is_ascii_digit());
    let are_thousands = groups.iter().all(|group| is_digits(group))
        && (1..=3).contains(&groups[0].len())
        && !groups[0].starts_with('0')
        && groups[1..].iter().all(|group| group.len() == 3);
    let plain =
        format!("{}{}.{}", &typed[..typed.len() - digits.len()], groups.concat(), fraction.unwrap_or("0"));
    let is_certain = fraction.is_some() || groups.len() > 2 || between != other;
    let is_fraction = fraction.is_none_or(|fraction| !fraction.is_empty() && is_digits(fraction));
    (are_thousands && is_fraction).then(|| Some((plain.parse().ok()?, is_certain))).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names and fields of the first row with numbers, or what is asked.
    fn told(text: &str, layout: &TableLayout) -> Result<String, String> {
        let table = CsvText::of(text.as_bytes().to_vec(), layout)?;
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(table.delimiter)
            .comment(table.comment.and_then(|mark| u8::try_from(mark).ok()))
            .trim(csv::Trim::All)
            .has_headers(table.names.is_none())
            .from_reader(&table.text[..]);
        let names = match &table.names {
            Some(names) => names.clone(),
            None => reader.headers().expect("a header").iter().map(str::to_owned).collect(),
        };
        let row = reader.records().next().expect("a row").expect("fields");
        let numbers: Vec<String> = row
            .iter()
            .map(|field| {
                number_of(field, table.has_decimal_comma).map_or("?".to_owned(), |number| number.to_string())
            })
            .collect();
        let byte = row.position().map_or(0, csv::Position::byte);
        let line = line_of_record(&table.text, byte, table.comment, (0, 1)).1;
        Ok(format!("{} = {} in line {line}", names.join(" "), numbers.join(" ")))
    }

    #[test]
    fn tables_of_every_writer_are_read_where_one_choice_is_left() {
        let layout = TableLayout::default();
        for (text, found) in [
            ("t,y,p\n1,2.5,3\n", "t y p = 1 2.5 3 in line 2"),
            ("# t, y, p\n1.0,2.5,3\n", "t y p = 1 2.5 3 in line 2"),
            ("# column\n# t y p\n1.0 2.5 3\n", "t y p = 1 2.5 3 in line 3"),
            ("# t y p\n1.0,2.5,3\n", "t y p = 1 2.5 3 in line 2"),
            ("% t, y, p\n1.0,2.5,3\n", "t y p = 1 2.5 3 in line 2"),
            ("! column\n!t y p\n1.0 2.5 3\n", "t y p = 1 2.5 3 in line 3"),
            ("t y p\n  1.0   2.5\t3\n", "t y p = 1 2.5 3 in line 2"),
            ("t\ty\tp\n1\t2,5\t3\n", "t y p = 1 2.5 3 in line 2"),
            ("t;y;p\n1;2,5;3\n", "t y p = 1 2.5 3 in line 2"),
            ("t;y;p\n1;2.5;3\n", "t y p = 1 2.5 3 in line 2"),
            ("t y p\n1,0 2,5 3,0\n", "t y p = 1 2.5 3 in line 2"),
            ("t,y,p\n1.0D+00,2.5d0,0.3D1\n", "t y p = 1 2.5 3 in line 2"),
            ("1,2.5,3\n4,5,6\n", "1 2 3 = 1 2.5 3 in line 1"),
            ("1 2.5 3\n", "1 2 3 = 1 2.5 3 in line 1"),
            ("\n# made by a\n\nt,y,p\n# in Pa\n1,2.5,3\n", "t y p = 1 2.5 3 in line 6"),
            ("t,name,p\n1,clay,3\n", "t name p = 1 ? 3 in line 2"),
            ("t,y,p\n1,2.5,nan\n", "t y p = 1 2.5 NaN in line 2"),
            ("\"t\",\"y\",\"p\"\n1,2.5,3\n", "t y p = 1 2.5 3 in line 2"),
            // A row of units, a separator too many, names again, no letter before an exponent.
            ("t,y,p\ns,m,Pa\n1,2.5,3\n", "t y p = 1 2.5 3 in line 3"),
            ("t;n;p\n[s];[-];[kPa]\n1;2,5;3\n", "t n p = 1 2.5 3 in line 3"),
            ("t y p\n(s) (m) (Pa)\n1 2.5 3\n", "t y p = 1 2.5 3 in line 3"),
            ("t,y,p\n1,2.5,3,\n2,2.5,3,\n", "t y p = 1 2.5 3 in line 2"),
            ("1;2,5;3;\n2;2,5;3;\n", "1 2 3 = 1 2.5 3 in line 1"),
            ("t,y,p\nt,y,p\n1,2.5,3\n", "t y p = 1 2.5 3 in line 3"),
        ] {
            assert_eq!(told(text, &layout).as_deref(), Ok(found), "{text}");
        }
        let latin = CsvText::of(b"t,H\xf6he\n1,2\n".to_vec(), &layout).expect("a table");
        assert_eq!(latin.text, "t,Höhe\n1,2\n".as_bytes());
        // A comma may separate or begin a fraction.
        let asked = told("1,0 2,5\n", &layout);
        assert_eq!(asked.as_deref(), Ok("1 2 = 1 2.5 in line 1"));
        let given = TableLayout { delimiter: Some(';'), decimal: Some(','), ..TableLayout::default() };
        assert_eq!(told("t;y\n1,5;2\n", &given).as_deref(), Ok("t y = 1.5 2 in line 2"));
        let named = TableLayout { header: Some(true), ..TableLayout::default() };
        assert_eq!(told("1,2\n3,4\n", &named).as_deref(), Ok("1 2 = 3 4 in line 2"));
        let tabs = told("t\ty\tp\n4,0875\t0,0\t0,5\n", &layout);
        assert_eq!(tabs.as_deref(), Ok("t y p = 4.0875 0 0.5 in line 2"));
        let twice = told("t,y,p\n4,0875,0,05,1,0\n", &layout);
        assert!(twice.is_err_and(|why| why.contains("twice as many fields")));
        assert_eq!(number_of("1,234.5", true), None);
        assert_eq!(number_of("1.0D-3", false), Some(1e-3));
        assert_eq!(number_of("0.573-104", false), Some(0.573e-104));
        for (typed, has_comma, number) in [
            ("18,986.106", false, Some((18_986.106, true))),
            ("1,234,567", false, Some((1_234_567.0, true))),
            ("18,986", false, Some((18_986.0, false))),
            ("-19.937", true, Some((-19_937.0, false))),
            ("1.234.567,5", true, Some((1_234_567.5, true))),
            ("18'986.5", false, Some((18_986.5, true))),
            ("0.573", true, None),
            ("1.2345", true, None),
            ("1,23", false, None),
            ("clay", false, None),
        ] {
            assert_eq!(number_of_thousands(typed, has_comma), number, "{typed}");
        }
        assert_eq!(number_of("dead", false), None);
        assert_eq!(number_of("np.float64(0.5)", false), Some(0.5));
    }
}
