//! Reads and writes the text of a golden file, whose format is described in [`crate::golden`].

use crate::golden::text_error::{CellError, GoldenTextError};
use crate::golden::{GoldenFile, SCHEMA, WITHOUT_INPUTS, parts};
use std::collections::{BTreeMap, BTreeSet};

/// What stands before every line of the header.
const HEADER_MARK: char = '#';
/// The columns that say which case and time factor a row is of.
pub(super) const LABELS: [&str; 2] = ["case", "T_v"];
/// What stands before the quantity of a column of spreads.
const SPREAD_MARK: &str = "spread of ";
/// What stands before the key of a column of inputs.
const INPUT_MARK: &str = "input ";

/// Numbers of a row, by whether they are spreads, and by measure.
type TableRow<'a> = BTreeMap<(bool, &'a str), f64>;

/// Where a value stands: its row by case and time factor, its column by measure.
struct TablePlace<'a> {
    row: (&'a str, &'a str),
    measure: &'a str,
}

impl<'a> TablePlace<'a> {
    /// The place of a name `case | measure T_v=time`; counters have no time.
    fn of(name: &'a str) -> Self {
        let (case, measure) = parts(name);
        let (measure, time_factor) = measure.rsplit_once(" T_v=").unwrap_or((measure, ""));
        Self { row: (case, time_factor), measure }
    }

    fn name(&self) -> String {
        let (case, time_factor) = self.row;
        let measure = if self.measure.is_empty() { String::new() } else { format!(" | {}", self.measure) };
        let time = if time_factor.is_empty() { String::new() } else { format!(" T_v={time_factor}") };
        format!("{case}{measure}{time}")
    }
}

/// The shortest decimal that reads back as the same number.
fn decimal(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A tolerance over the largest change by which a value may be rounded when it is written.
const ROUNDING: f64 = 10.0;

/// The value rounded to a power of ten that is at most `step`, so that the digits of a file say what the tolerance
/// compares; as it is where the step is 10 or more.
fn rounded(value: f64, step: f64) -> f64 {
    let power = format!("{step:e}").rsplit('e').next().and_then(|power| power.parse::<i32>().ok());
    match power.and_then(|power| usize::try_from(-power).ok()) {
        // Without the sign of a zero.
        Some(digits) => format!("{value:.digits$}").parse().unwrap_or(value) + 0.0,
        None => value,
    }
}

/// A line of the header; tolerances as 1e-12, which TOML's writer spells with eleven zeros.
fn header_line(line: &str) -> String {
    let tolerance =
        line.split_once("_tolerance = ").and_then(|(kind, value)| Some((kind, value.parse().ok()?)));
    let line =
        tolerance.map_or(line.to_owned(), |(kind, value)| format!("{kind}_tolerance = {}", decimal(value)));
    format!("{HEADER_MARK} {line}").trim_end().to_owned() + "\n"
}

impl GoldenFile {
    /// The file as text: the header, then rows by case and time factor, columns by name.
    ///
    /// # Errors
    /// When the values cannot be written as TOML and CSV.
    pub fn to_text(&self) -> Result<String, GoldenTextError> {
        let values = self.values.iter().map(|(name, value)| {
            (name, false, rounded(*value, self.tolerance(name, value.abs()) / ROUNDING))
        });
        let spreads = self
            .spread
            .iter()
            .map(|(group, spread)| (group, true, format!("{spread:.1e}").parse().unwrap_or(*spread)));
        let mut columns = BTreeSet::new();
        let cases = self.inputs.own.iter().filter(|(_, own)| !own.is_empty());
        let mut rows: BTreeMap<(&str, &str), TableRow<'_>> =
            cases.map(|(label, _)| ((label.as_str(), ""), TableRow::new())).collect();
        for (name, is_spread, value) in values.chain(spreads) {
            let place = TablePlace::of(name);
            let column = (is_spread, place.measure);
            columns.insert(column);
            rows.entry(place.row).or_default().insert(column, value);
        }
        let header = toml::to_string(self).map_err(GoldenTextError::unwritten)?;
        let mut text: String = header.lines().map(header_line).collect();
        let mut writer = csv::Writer::from_writer(Vec::new());
        let titles = columns.iter().map(|(is_spread, measure)| {
            if *is_spread { format!("{SPREAD_MARK}{measure}") } else { (*measure).to_owned() }
        });
        let mut records = vec![LABELS.map(str::to_owned).into_iter().chain(titles).collect::<Vec<_>>()];
        for ((case, time_factor), row) in &rows {
            let cells = columns.iter().map(|column| row.get(column).copied().map_or(String::new(), decimal));
            records.push(
                [case, time_factor].map(|label| (*label).to_owned()).into_iter().chain(cells).collect(),
            );
        }
        self.add_own_inputs(&mut records);
        for record in &records {
            writer.write_record(record)?;
        }
        let table = writer.into_inner().map_err(|error| GoldenTextError::unwritten(error.into_error()))?;
        text.push_str(&String::from_utf8(table).map_err(GoldenTextError::unwritten)?);
        Ok(text)
    }

    /// Adds the columns of the inputs that differ between the cases, in the rows without a time.
    fn add_own_inputs(&self, records: &mut [Vec<String>]) {
        let keys: BTreeSet<&String> = self.inputs.own.values().flat_map(BTreeMap::keys).collect();
        let Some((titles, rows)) = records.split_first_mut() else { return };
        titles.extend(keys.iter().map(|key| format!("{INPUT_MARK}{key}")));
        for row in rows {
            let own = self.inputs.own.get(&row[0]).filter(|_| row[1].is_empty());
            let values: Vec<String> = keys
                .iter()
                .map(|key| own.and_then(|own| own.get(*key)).cloned().unwrap_or_default())
                .collect();
            row.extend(values);
        }
    }

    /// Reads what [`Self::to_text`] wrote.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn from_text(text: &str) -> Result<Self, GoldenTextError> {
        let text = text.trim_start_matches('\u{feff}');
        if !text.ends_with('\n') {
            return Err(GoldenTextError::CutOff { line: text.lines().count().max(1) });
        }
        let header = text.lines().take_while(|line| line.starts_with(HEADER_MARK));
        let header: Vec<&str> =
            header.map(|line| line[1..].strip_prefix(' ').unwrap_or(&line[1..])).collect();
        let header = header.join("\n");
        let mut golden: Self = toml::from_str(&header).map_err(|source| {
            let before = source.span().map_or("", |span| header.get(..span.start).unwrap_or_default());
            GoldenTextError::Header { line: before.matches('\n').count() + 1, source }
        })?;
        if ![SCHEMA, WITHOUT_INPUTS].contains(&golden.schema) {
            return Err(GoldenTextError::Layout(golden.schema));
        }
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(HEADER_MARK as u8)).from_reader(text.as_bytes());
        let titles = reader.headers()?.clone();
        if !titles.iter().take(LABELS.len()).eq(LABELS) {
            return Err(GoldenTextError::Columns);
        }
        for record in reader.records() {
            let record = record?;
            golden.take_row(&titles, &record).map_err(|source| GoldenTextError::Row {
                line: record.position().map_or(0, csv::Position::line),
                source,
            })?;
        }
        Ok(golden)
    }

    /// Takes the values and spreads of a row of the table.
    fn take_row(&mut self, titles: &csv::StringRecord, record: &csv::StringRecord) -> Result<(), CellError> {
        let row = (&record[0], &record[1]);
        if !self.inputs.is_unknown() {
            self.inputs.own.entry(record[0].to_owned()).or_default();
        }
        let cells = titles.iter().zip(record).skip(LABELS.len());
        for (title, cell) in cells.filter(|(_, cell)| !cell.is_empty()) {
            if let Some(key) = title.strip_prefix(INPUT_MARK) {
                self.inputs
                    .own
                    .entry(record[0].to_owned())
                    .or_default()
                    .insert(key.to_owned(), cell.to_owned());
                continue;
            }
            let value = cell
                .parse()
                .map_err(|_| CellError::NoNumber { cell: cell.to_owned(), title: title.to_owned() })?;
            let (kept, measure) = match title.strip_prefix(SPREAD_MARK) {
                Some(measure) => (&mut self.spread, measure),
                None => (&mut self.values, title),
            };
            let name = TablePlace { row, measure }.name();
            if kept.insert(name, value).is_some() {
                return Err(CellError::Twice { title: title.to_owned() });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::inputs::CaseInputs;

    /// Every kind of name and number there is.
    fn golden() -> GoldenFile {
        let values = [
            ("MPM cells=4 (u-p, implicit drag) | steps", 46824.0),
            ("MPM cells=4 (u-p, implicit drag) | observed critical step", -1.0),
            ("MPM cells=4 (u-p, implicit drag) | pressure points l2 terzaghi T_v=0.05", 0.123_456_789_01),
            ("MPM cells=4 (u-p, implicit drag) | pressure points l2 terzaghi T_v=0.0000001", 3.1e-8),
            ("MPM cells=4 (u-p, implicit drag) | water balance T_v=0.05", 0.0),
            ("MPM cells=8 | settlement surface relative terzaghi T_v=1", 1.797e308),
            ("cosine-layer rough | σ'_xx x=0.3 y=0.5 T_v=0", 1e-5),
            ("a name of its own", 3.0),
        ];
        let spread = [
            ("MPM cells=4 (u-p, implicit drag) | water balance", 3.8e-11),
            ("MPM cells=4 (u-p, implicit drag) | pressure T_v=0.05", 1e-12),
        ];
        let owned = |pairs: &[(&str, f64)]| {
            pairs.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect::<BTreeMap<_, _>>()
        };
        let reason = "two lines,\nand \"quoted\" # so".to_owned();
        let inputs = CaseInputs {
            shared: [("youngs_modulus".to_owned(), "1e6 Pa".to_owned())].into(),
            own: [
                ("MPM cells=4 (u-p, implicit drag)", &[("cells", "4")][..]),
                ("MPM cells=8", &[("cells", "8"), ("points.jitter", "0.1")]),
                ("a case without values", &[("cells", "16")]),
                ("cosine-layer rough", &[]),
                ("a name of its own", &[]),
            ]
            .map(|(case, own)| {
                let own = own.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
                (case.to_owned(), own.collect())
            })
            .into(),
        };
        let (values, spread) = (owned(&values), owned(&spread));
        GoldenFile { reason, inputs, spread, values, ..GoldenFile::of("s", &[], "-") }
    }

    #[test]
    fn numbers_are_written_with_the_digits_that_a_comparison_sees() {
        assert_eq!(rounded(0.1 + 0.2, 3e-10 / ROUNDING), 0.3);
        assert_eq!(rounded(-1.234_567_890_123_456e-7, 1e-12 / ROUNDING), -1.234_568e-7);
        assert_eq!(rounded(-1e-17, 1e-12 / ROUNDING).to_bits(), 0.0_f64.to_bits());
        assert_eq!(rounded(171_843_680.0, 0.5 / ROUNDING), 171_843_680.0);
        let name = "MPM cells=4 | pressure points l2 terzaghi T_v=0.1";
        for size in [0.0, 1e-17, 1e-9, 0.123_456_789_123_456_78, 1.0 / 3.0, 12_345.678_901_234_567, 1e300] {
            let values = BTreeMap::from([(name.to_owned(), size)]);
            let file = GoldenFile { values, ..golden() };
            let read = GoldenFile::from_text(&file.to_text().expect("written")).expect("read");
            let moved = (read.values[name] - size).abs();
            assert!(moved <= file.tolerance(name, size) / ROUNDING, "{size} moved by {moved}");
        }
    }

    #[test]
    fn a_golden_file_reads_back_to_the_bit_with_a_row_per_case_and_time() {
        let text = golden().to_text().expect("written");
        let read = GoldenFile::from_text(&text).expect("read");
        assert_eq!(read, golden());
        let bits = |file: &GoldenFile| file.values.values().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&golden()), "signs of zero too");
        let table: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
        assert_eq!(
            table[0],
            "case,T_v,,observed critical step,pressure points l2 terzaghi,\
             settlement surface relative terzaghi,steps,water balance,σ'_xx x=0.3 y=0.5,\
             spread of pressure,spread of water balance,input cells,input points.jitter"
        );
        let case = "\"MPM cells=4 (u-p, implicit drag)\"";
        assert_eq!(table[1], format!("{case},,,-1,,,46824,,,,3.8e-11,4,"));
        assert_eq!(table[3], format!("{case},0.05,,,0.12345678901,,,0,,1e-12,,,"));
        assert_eq!(table.len(), 9, "a row of their inputs for cases without counters");
    }

    #[test]
    fn what_is_broken_is_told_with_its_line() {
        let text = golden().to_text().expect("written");
        let line_of = |part: &str| 1 + text.lines().position(|line| line.contains(part)).expect("a line");
        let refused = |from: &str, to: &str| {
            assert!(text.contains(from), "{text}");
            GoldenFile::from_text(&text.replacen(from, to, 1)).expect_err("refused").to_string()
        };
        // Editors put a byte order mark in front, and carriage returns at the ends.
        let edited = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        assert_eq!(GoldenFile::from_text(&edited).expect("read").values, golden().values);
        let told = refused("46824", "many");
        assert_eq!(told, format!("line {}: `many` under `steps` is not a number", line_of("46824")));
        let told = refused(",0.05,", ",0.0000001,");
        let twice = "`pressure points l2 terzaghi` is given twice for this case and time factor";
        assert_eq!(told, format!("line {}: {twice}", line_of(",0.05,")));
        let told = refused("1.797e308,", "1.797e308,,");
        assert!(told.contains(&format!("line: {}", line_of("1.797e308"))), "{told}");
        let told = refused("absolute_tolerance = ", "absolute_tolerance = x");
        assert!(told.starts_with(&format!("line {}: ", line_of("absolute_tolerance"))), "{told}");
        let told = refused("# study = ", "# steady = ");
        assert!(told.starts_with("line ") && told.contains("steady"), "{told}");
        let told = refused("# schema = 3", "# schema = 9");
        assert_eq!(told, "it has layout 9; this program reads layouts 2 and 3");
        assert!(refused("case,T_v", "cases,T_v").contains("`case`, `T_v`"));
        let cut = GoldenFile::from_text(&text[..text.len() - 2]).expect_err("refused").to_string();
        assert_eq!(cut, format!("line {}: the file ends within it", text.lines().count()));
    }
}
