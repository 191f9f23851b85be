//! A golden file as text. See [`crate::golden`].

use crate::golden::measure::{GoldenKey, Measure, SpreadKey, Spreading, TimeFactor};
use crate::golden::older;
use crate::golden::text_error::{CellError, GoldenTextError};
use crate::golden::{GoldenFile, LAYOUT};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What stands before every line of the header.
pub(super) const HEADER_MARK: char = '#';
/// What the first line begins with, before the layout and the study.
const TITLE_MARK: &str = "# golden ";
/// What stands between layout and study.
const TITLE_GAP: &str = " · ";
/// What the second line begins with.
const REASON_MARK: &str = "# reason: ";
/// The columns that say which case and time factor a row is of, with what identifies the inputs of the case.
pub(super) const LABELS: [&str; 3] = ["case", "hash", "T_v"];
/// What stands before the quantity of a column of spreads.
pub(super) const SPREAD_MARK: &str = "spread of ";
/// Digits of a value behind its first one.
const DIGITS: usize = 6;

/// What a column holds.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Column {
    /// Values.
    Values(Measure),
    /// Spreads.
    Spreads(Spreading),
}

impl Column {
    fn title(&self) -> String {
        match self {
            Self::Values(measure) => measure.to_string(),
            Self::Spreads(of) => format!("{SPREAD_MARK}{of}"),
        }
    }

    /// The column of a title.
    fn of(title: &str) -> Result<Self, GoldenTextError> {
        let column = match title.strip_prefix(SPREAD_MARK) {
            Some(of) => of.parse().map(Self::Spreads),
            None => title.parse().map(Self::Values),
        };
        Ok(column?)
    }
}

/// A row of the table: its case and output.
type Row<'a> = (&'a Arc<str>, Option<TimeFactor>);

/// The shortest decimal that reads back as the same number.
fn decimal(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A value with the digits that a file keeps; steps are whole numbers and keep all. Without the sign of a zero.
pub(super) fn rounded(measure: &Measure, value: f64) -> f64 {
    let digits = || format!("{value:.DIGITS$e}").parse().unwrap_or(value);
    if *measure == Measure::Steps { value } else { digits() + 0.0 }
}

impl GoldenFile {
    /// The file as text: the header, then rows by case and time factor.
    ///
    /// # Errors
    /// When the values cannot be written as CSV.
    pub fn to_text(&self) -> Result<String, GoldenTextError> {
        let values = self.values.iter().map(|(key, value)| {
            let column = Column::Values(key.measure.clone());
            (&key.case, key.time, column, rounded(&key.measure, *value))
        });
        let spreads = self.spread.iter().map(|(key, spread)| {
            let spread = format!("{spread:.1e}").parse().unwrap_or(*spread);
            (&key.case, key.time, Column::Spreads(key.of), spread)
        });
        let mut columns = BTreeSet::new();
        let mut rows: BTreeMap<Row<'_>, BTreeMap<Column, f64>> =
            self.cases.keys().map(|case| ((case, None), BTreeMap::new())).collect();
        for (case, time, column, value) in values.chain(spreads) {
            columns.insert(column.clone());
            rows.entry((case, time)).or_default().insert(column, value);
        }
        let reason = self.reason.split_whitespace().collect::<Vec<_>>().join(" ");
        let text = format!("{TITLE_MARK}{LAYOUT}{TITLE_GAP}{}\n{REASON_MARK}{reason}\n", self.study);
        let mut writer = csv::Writer::from_writer(text.into_bytes());
        writer
            .write_record(LABELS.map(str::to_owned).into_iter().chain(columns.iter().map(Column::title)))?;
        for ((case, time), row) in &rows {
            let hash = self.cases.get(*case).filter(|_| time.is_none()).map_or("", String::as_str);
            let time = time.map_or(String::new(), |TimeFactor(time)| time.to_string());
            let cells = columns.iter().map(|column| row.get(column).copied().map_or(String::new(), decimal));
            writer.write_record([case.to_string(), hash.to_owned(), time].into_iter().chain(cells))?;
        }
        let text = writer.into_inner().map_err(|error| GoldenTextError::unwritten(error.into_error()))?;
        String::from_utf8(text).map_err(GoldenTextError::unwritten)
    }

    /// Reads what [`Self::to_text`] wrote, or an older layout.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn from_text(text: &str) -> Result<Self, GoldenTextError> {
        let text = text.trim_start_matches('\u{feff}');
        if !text.ends_with('\n') {
            return Err(GoldenTextError::CutOff { line: text.lines().count().max(1) });
        }
        let mut lines = text.lines();
        let Some(title) = lines.next().and_then(|line| line.strip_prefix(TITLE_MARK)) else {
            return older::from_text(text);
        };
        let (layout, study) = title.split_once(TITLE_GAP).ok_or(GoldenTextError::Title)?;
        if layout != LAYOUT.to_string() {
            return Err(GoldenTextError::Layout(layout.to_owned()));
        }
        let reason = lines.next().and_then(|line| line.strip_prefix(REASON_MARK.trim_end()));
        let reason = reason.ok_or(GoldenTextError::Reason)?.trim();
        let mut golden = Self::of(study, &[], reason);
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(HEADER_MARK as u8)).from_reader(text.as_bytes());
        let titles = reader.headers()?.clone();
        if !titles.iter().take(LABELS.len()).eq(LABELS) {
            return Err(GoldenTextError::Columns(&LABELS));
        }
        let columns: Result<Vec<Column>, _> = titles.iter().skip(LABELS.len()).map(Column::of).collect();
        let columns = columns?;
        for record in reader.records() {
            let record = record?;
            let line = record.position().map_or(0, csv::Position::line);
            golden.take_row(&columns, &record).map_err(|source| GoldenTextError::Row { line, source })?;
        }
        Ok(golden)
    }

    /// Takes the values and spreads of a row of the table.
    fn take_row(&mut self, columns: &[Column], record: &csv::StringRecord) -> Result<(), CellError> {
        let (case, hash, time): (Arc<str>, _, _) = (record[0].into(), &record[1], time_of(&record[2])?);
        let known = self.cases.entry(case.clone()).or_default();
        if !hash.is_empty() {
            hash.clone_into(known);
        }
        let cells = columns.iter().zip(record.iter().skip(LABELS.len()));
        for (column, cell) in cells.filter(|(_, cell)| !cell.is_empty()) {
            self.take(&case, time, column, cell)?;
        }
        Ok(())
    }

    /// Takes a cell.
    pub(super) fn take(
        &mut self,
        case: &Arc<str>,
        time: Option<TimeFactor>,
        column: &Column,
        cell: &str,
    ) -> Result<(), CellError> {
        let title = || column.title();
        let value =
            cell.parse().map_err(|_| CellError::NoNumber { cell: cell.to_owned(), title: title() })?;
        let known = match column.clone() {
            Column::Values(measure) => {
                self.values.insert(GoldenKey { case: case.clone(), time, measure }, value)
            }
            Column::Spreads(of) => self.spread.insert(SpreadKey { case: case.clone(), time, of }, value),
        };
        if known.is_some() { Err(CellError::Twice { title: title() }) } else { Ok(()) }
    }
}

/// The time factor of a row; none where it is empty.
pub(super) fn time_of(cell: &str) -> Result<Option<TimeFactor>, CellError> {
    let no_number = |_| CellError::NoNumber { cell: cell.to_owned(), title: "T_v".to_owned() };
    if cell.is_empty() {
        Ok(None)
    } else {
        cell.parse().map(|time| Some(TimeFactor(time))).map_err(no_number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::measure::key;

    const CASE: &str = "MPM cells=4 (u-p, implicit drag)";

    /// Every kind of key and number there is.
    fn golden() -> GoldenFile {
        let pressure = "pressure points terzaghi";
        let values = [
            (key(CASE, None, "steps"), 171_843_680.0),
            (key(CASE, None, "observed critical step"), -1.0),
            (key(CASE, 0.05, pressure), 0.123_456_7),
            (key(CASE, 0.000_000_1, pressure), 3.1e-8),
            (key(CASE, 10.0, pressure), 3.1e-8),
            (key(CASE, 0.05, "water balance"), 0.0),
            (key("MPM cells=8", 1.0, "settlement surface terzaghi"), 1.797e308),
        ];
        let spread = [(key(CASE, 0.05, "water balance"), 3.8e-11), (key(CASE, 0.05, pressure), 1e-12)];
        let spread = spread.map(|(key, spread)| (key.spread().expect("a spread"), spread)).into();
        let cases = [(CASE, "0123"), ("MPM cells=8", ""), ("without values", "4567")];
        let cases = cases.map(|(case, hash)| (Arc::from(case), hash.to_owned())).into();
        GoldenFile {
            cases,
            spread,
            values: values.into(),
            ..GoldenFile::of("s", &[], "one, \"quoted\" # so")
        }
    }

    #[test]
    fn a_golden_file_reads_back_to_the_bit_with_a_row_per_case_and_time() {
        let text = golden().to_text().expect("written");
        let read = GoldenFile::from_text(&text).expect("read");
        assert_eq!(read, golden());
        let bits = |file: &GoldenFile| file.values.values().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&golden()), "signs of zero too");
        let case = format!("\"{CASE}\"");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines,
            [
                "# golden 4 · s",
                "# reason: one, \"quoted\" # so",
                "case,hash,T_v,steps,observed critical step,water balance,pressure points terzaghi,\
                 settlement surface terzaghi,spread of water balance,spread of pressure",
                &format!("{case},0123,,171843680,-1,,,,3.8e-11,"),
                &format!("{case},,0.0000001,,,,3.1e-8,,,"),
                &format!("{case},,0.05,,,0,0.1234567,,,1e-12"),
                &format!("{case},,10,,,,3.1e-8,,,"),
                "MPM cells=8,,,,,,,,,",
                "MPM cells=8,,1,,,,,1.797e308,,",
                "without values,4567,,,,,,,,",
            ]
        );
        let broken = GoldenFile { reason: "two\n  lines".to_owned(), ..golden() };
        let read = GoldenFile::from_text(&broken.to_text().expect("written")).expect("read");
        assert_eq!(read.reason, "two lines");
    }

    #[test]
    fn a_value_keeps_seven_digits_and_steps_all() {
        let pressure = key("a", 0.1, "pressure points terzaghi").measure;
        for (value, wanted) in [
            (0.1 + 0.2, 0.3),
            (-1.234_567_49e-7, -1.234_567e-7),
            (12_345.678_9, 12_345.68),
            (-1e-17, -1e-17),
            (1e300, 1e300),
        ] {
            assert_eq!(rounded(&pressure, value), wanted);
        }
        assert_eq!(rounded(&pressure, -0.0).to_bits(), 0.0_f64.to_bits());
        assert_eq!(rounded(&Measure::Steps, 1_718_436_801.0), 1_718_436_801.0);
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
        assert_eq!(GoldenFile::from_text(&edited).expect("read"), golden());
        let steps = line_of("171843680");
        assert_eq!(
            refused("171843680", "many"),
            format!("line {steps}: `many` under `steps` is not a number")
        );
        let told = refused(",0.05,", ",0.0000001,");
        let twice = "`pressure points terzaghi` occurs twice for this case and time factor";
        assert_eq!(told, format!("line {}: {twice}", line_of(",0.05,")));
        let told = refused(",0.05,", ",soon,");
        assert_eq!(told, format!("line {}: `soon` under `T_v` is not a number", line_of(",0.05,")));
        let told = refused("1.797e308,", "1.797e308,,");
        assert!(told.contains(&format!("line: {}", line_of("1.797e308"))), "{told}");
        assert!(
            refused("settlement surface", "settlement inside")
                .starts_with("`settlement inside terzaghi` is no")
        );
        assert_eq!(refused("# golden 4", "# golden 9"), "it has layout 9; this program reads layouts 2 to 4");
        let told = "line 1: it does not begin with `# golden 4 · STUDY`";
        assert_eq!(refused("4 · s", "4: s"), told);
        assert_eq!(refused("# reason", "# season"), "line 2: it is not `# reason: WHY`");
        assert!(refused("case,hash", "case,hush").contains("`case`, `hash`, `T_v`"));
        let cut = GoldenFile::from_text(&text[..text.len() - 2]).expect_err("refused").to_string();
        assert_eq!(cut, format!("line {}: the file ends within this line", text.lines().count()));
    }
}
