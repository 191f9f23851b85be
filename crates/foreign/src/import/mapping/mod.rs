//! The declared meaning of the columns of a file.

pub mod names;
pub mod preset;
pub mod units;

use crate::import::mapping::names::ColumnName;
use crate::import::mapping::units::{
    DisplacementSource, HorizontalSense, Hydrostatic, LengthUnit, RowFilter, SettlementSeries, StatedPlace,
    StressKind, StressMeaning, StressSign, StressUnit, Time, TimeUnit, VerticalSense,
};
use oedometer_case::quantity::{Quantity, Sample};
use oedometer_input::diagnostic::{Diagnostic, StudyError};
use oedometer_input::source::StudySource;
use oedometer_scenes::Scene;
use oedometer_scenes::scene::Body;
use oedometer_wording::words;
use serde::Deserialize;

/// What the columns of a file mean.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Kind of the places: a name for tables.
    #[serde(default = "points")]
    pub sample: Sample,
    /// Sum of the volumes of all samples, in the unit of their column. Without it, volumes whose sum is not a volume of
    /// the problem are used as weights.
    #[serde(default)]
    pub whole_volume: Option<f64>,
    /// Names of the columns, as the header spells them, or of arrays: `displacement[1]` is the second component,
    /// `cells:pressure` the array on cells, `coordinates[1]` the height of points or centres.
    #[serde(default)]
    pub columns: ColumnNames,
    /// Units of the columns; SI by default.
    #[serde(default)]
    pub units: Units,
    /// Positive directions, and for x and y the end from which they count.
    #[serde(default)]
    pub sign: Signs,
    /// Whether places are initial or current, for both x and y.
    #[serde(default)]
    pub position: Position,
    /// Coordinates in the file of the end from which x and y count, in its unit of length.
    #[serde(default)]
    pub origin: Origin,
    /// Names of the files that a program writes side by side for one state, like `*_MPScalar_*.vtk` and
    /// `*_MPVector_*.vtk`; what the `*` stand for must be the same in all.
    #[serde(default)]
    pub join: Vec<String>,
    /// Where the time comes from if it is not a column.
    #[serde(default)]
    pub time: Time,
    /// Which rows count; all by default.
    #[serde(default)]
    pub rows: RowFilter,
    /// Where the displacement comes from if it is not a column.
    #[serde(default)]
    pub displacement: Option<DisplacementSource>,
    /// A hydrostatic part of the pressure, which is subtracted.
    #[serde(default)]
    pub hydrostatic: Option<Hydrostatic>,
    /// What the column of the effective stress contains.
    #[serde(default)]
    pub stress: StressMeaning,
    /// A settlement curve in a separate file.
    #[serde(default)]
    pub settlement: Option<SettlementSeries>,
    /// Layout of the file.
    #[serde(default)]
    pub csv: TableLayout,
    /// Who declared it.
    #[serde(skip)]
    pub declared_by: DeclaredBy,
    /// Keys of the columns that a file may lack.
    #[serde(skip)]
    pub optional: Vec<String>,
    /// Whether the files show the kind of the places.
    #[serde(skip)]
    pub is_sample_open: bool,
    /// Whether `x` and `y` are those of a slab: what is written as `x` is then kept as `y`, the direction along which a
    /// body's fields vary, and the other way round.
    #[serde(skip)]
    pub is_turned: bool,
}

/// In which directions the fields of a body vary, and so what its `x` and `y` are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// `y` upward from the base; `x` does not matter.
    #[default]
    Column,
    /// `y` upward from the base, `x` from the crest of the load along the layer.
    Layer,
    /// `x` from the middle of a slab to its drained side, `y` from the middle between its plates across, as of Mandel.
    Slab,
}

impl Axes {
    /// Those of a scene.
    pub fn of(scene: &'static Scene) -> Self {
        match scene.body {
            Body::Slab => Self::Slab,
            Body::Layer | Body::Square => Self::Layer,
            Body::Column => Self::Column,
        }
    }
}

/// Who declared a mapping.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeclaredBy {
    /// The user, in a mapping file.
    #[default]
    User,
    /// Nobody: it is the convention.
    Convention,
    /// The preset of a name, with what the user declares over it.
    Preset(&'static str),
}

/// A column of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Time.
    Time,
    /// Distance along a layer.
    X,
    /// Height or depth.
    Y,
    /// Excess pore pressure.
    Pressure,
    /// Horizontal displacement.
    Along,
    /// Vertical displacement.
    Up,
    /// Vertical effective stress.
    EffectiveStress,
    /// Volume or weight.
    Volume,
}
words!(Column: Time "t", X "x", Y "y", Pressure "p", Along "u_x", Up "u_y", EffectiveStress "effective_stress", Volume "volume");

impl Column {
    /// The quantity that it gives, if any.
    pub fn quantity(self) -> Option<Quantity> {
        match self {
            Self::Pressure => Some(Quantity::Pressure),
            Self::EffectiveStress => Some(Quantity::EffectiveStress),
            Self::Along | Self::Up => Some(Quantity::Displacement),
            Self::Time | Self::X | Self::Y | Self::Volume => None,
        }
    }
}

fn points() -> Sample {
    Sample::Points
}

/// Names of columns as the header spells them, or of arrays.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnNames {
    /// Time.
    pub t: Option<String>,
    /// Distance along a layer, or from the middle of a slab to its drained side.
    pub x: Option<String>,
    /// Height or depth, or the place across a slab; `y` by default.
    #[serde(default = "height_column")]
    pub y: String,
    /// Excess pore pressure; in a table with one column per height, `{ "p0" = 0.0, "p1" = 0.1 }`.
    pub p: Option<ColumnName>,
    /// Horizontal displacement of the skeleton.
    pub u_x: Option<ColumnName>,
    /// Vertical displacement of the skeleton.
    pub u_y: Option<ColumnName>,
    /// Vertical effective stress.
    pub effective_stress: Option<ColumnName>,
    /// Volume or weight of each place; equal weights by default, for data on cells the volumes of the cells.
    pub volume: Option<String>,
}

impl ColumnNames {
    /// The name of a column, if it has one.
    pub fn get(&self, column: Column) -> Option<&String> {
        match column {
            Column::Time => self.t.as_ref(),
            Column::X => self.x.as_ref(),
            Column::Y => Some(&self.y),
            Column::Volume => self.volume.as_ref(),
            quantity => self.of_quantity(quantity).and_then(ColumnName::single),
        }
    }

    /// What the key of a quantity names.
    pub fn of_quantity(&self, column: Column) -> Option<&ColumnName> {
        match column {
            Column::Pressure => self.p.as_ref(),
            Column::Along => self.u_x.as_ref(),
            Column::Up => self.u_y.as_ref(),
            Column::EffectiveStress => self.effective_stress.as_ref(),
            Column::Time | Column::X | Column::Y | Column::Volume => None,
        }
    }

    /// The columns of a quantity that has one per height, with these.
    pub fn by_height(&self, column: Column) -> Option<&[(String, f64)]> {
        match self.of_quantity(column) {
            Some(ColumnName::ByHeight(columns)) => Some(columns),
            _ => None,
        }
    }

    /// Quantities that have one column per height.
    pub fn wide(&self) -> impl Iterator<Item = (Column, &[(String, f64)])> {
        Column::ALL.into_iter().filter_map(|column| Some((column, self.by_height(column)?)))
    }

    /// Removes the columns that an empty name takes out.
    fn leave_out_empty(&mut self) {
        for name in [&mut self.t, &mut self.x, &mut self.volume] {
            *name = name.take().filter(|name| !name.is_empty());
        }
        for name in [&mut self.p, &mut self.u_x, &mut self.u_y, &mut self.effective_stress] {
            *name = name.take().filter(|name| !name.is_empty());
        }
    }
}

fn height_column() -> String {
    "y".to_owned()
}

impl Default for ColumnNames {
    fn default() -> Self {
        let named = |name: &str| Some(ColumnName::Single(name.to_owned()));
        Self {
            t: Some("t".to_owned()),
            x: None,
            y: height_column(),
            p: named("p"),
            u_x: None,
            u_y: named("u_y"),
            effective_stress: None,
            volume: None,
        }
    }
}

/// Units of columns.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Units {
    /// Unit of the time; seconds by default.
    pub time: TimeUnit,
    /// Unit of the places; metres by default.
    pub length: LengthUnit,
    /// Unit of the displacement; that of the places by default.
    pub displacement: Option<LengthUnit>,
    /// Unit of pressure and stress; pascals by default.
    pub stress: Option<StressUnit>,
}

/// Positive directions.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Signs {
    /// `right` from the problem's `x = 0` (the crest of a layer's load, the middle of a slab), or `left` from its other
    /// end;
    /// `right` by default.
    pub x: Option<HorizontalSense>,
    /// `up` from the base, or `down` from the initial surface; `up` by default.
    pub y: VerticalSense,
    /// Sign of the pore pressure; positive in compression by default.
    pub p: Option<StressSign>,
    /// Sign of the horizontal displacement; `right` by default.
    pub u_x: Option<HorizontalSense>,
    /// Sign of the vertical displacement; `up` by default.
    pub u_y: Option<VerticalSense>,
    /// Sign of the effective stress; positive in compression by default.
    pub effective_stress: Option<StressSign>,
}

/// Whether the coordinates are initial or current places.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Position {
    /// Initial or current places, for both `x` and `y`; initial by default.
    pub y: StatedPlace,
}

/// Coordinates in the file at the end from which `sign` counts, in the file's unit of length, and the pressure in
/// it at zero excess pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Origin {
    /// At the crest of a layer's load, or at its other end.
    pub x: f64,
    /// At the base, or at the initial surface.
    pub y: f64,
    /// Atmospheric pressure, in the unit of stresses, if the file has absolute pressures: 101325.0 Pa.
    pub p: f64,
}

/// Layout of a table. What is not declared is inferred if the file is unambiguous.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TableLayout {
    /// Separator of the columns; `" "` stands for any blanks.
    pub delimiter: Option<char>,
    /// Sign between the whole part of a number and its fraction: `.` or `,`.
    pub decimal: Option<char>,
    /// Whether the first line names the columns; without names they are called `1`, `2`, ….
    pub header: Option<bool>,
    /// Mark at the start of a comment line. A comment above the numbers may name the columns.
    pub comment: Option<char>,
}

impl Default for TableLayout {
    fn default() -> Self {
        Self { delimiter: None, decimal: None, header: None, comment: Some('#') }
    }
}

impl Mapping {
    /// Reads and checks a mapping file.
    ///
    /// # Errors
    /// An unknown key or word at its place, or all values that no file can have.
    pub fn read(source: &StudySource) -> Result<Self, StudyError> {
        let mut mapping: Self = source.read()?;
        mapping.columns.leave_out_empty();
        mapping.checked(source)
    }

    /// The mapping, if all values are right.
    fn checked(self, source: &StudySource) -> Result<Self, StudyError> {
        let faults = self.faults();
        if faults.is_empty() { Ok(self) } else { Err(source.error(faults)) }
    }

    /// The mapping of a body's files: that of a slab with `x` along the direction of the columns of others.
    ///
    /// # Errors
    /// When no column holds the place on which the fields depend.
    fn for_axes(self, axes: Axes, source: &StudySource) -> Result<Self, StudyError> {
        match axes {
            Axes::Column => Ok(self),
            Axes::Layer => self.check_plane(source).map(|()| self),
            Axes::Slab => self.turned(source),
        }
    }

    /// The mapping of a slab, whose fields vary along `x`, kept as those of a column, which vary along `y`.
    fn turned(mut self, source: &StudySource) -> Result<Self, StudyError> {
        let Some(along) = self.columns.x.take() else {
            return Err(source.complaint(
                "the problem is a slab, whose fields vary along x, but no column `x` gives the place of a \
                 sample".to_owned(),
                "add `x = \"x\"` to [columns], from the middle of the slab to its drained side; in a file that calls this \
                 direction y the axes are exchanged: `x = \"y\"` and `u_x = \"u_y\"`"
                    .to_owned(),
            ));
        };
        if self.rows.x.is_some() {
            return Err(source.complaint(
                "the fields of a slab vary along `x`, but [rows] keeps only one place of it".to_owned(),
                "remove `x` from [rows]".to_owned(),
            ));
        }
        self.columns.x = Some(std::mem::replace(&mut self.columns.y, along)).filter(|name| !name.is_empty());
        std::mem::swap(&mut self.columns.u_x, &mut self.columns.u_y);
        std::mem::swap(&mut self.origin.x, &mut self.origin.y);
        let up = |sense: HorizontalSense| match sense {
            HorizontalSense::Right => VerticalSense::Up,
            HorizontalSense::Left => VerticalSense::Down,
        };
        let right = |sense: VerticalSense| match sense {
            VerticalSense::Up => HorizontalSense::Right,
            VerticalSense::Down => HorizontalSense::Left,
        };
        let sign = &mut self.sign;
        (sign.x, sign.y) = (Some(right(sign.y)), sign.x.map_or(VerticalSense::Up, up));
        (sign.u_x, sign.u_y) = (sign.u_y.map(right), sign.u_x.map(up));
        // What lies across matters to the displacement across alone.
        if self.columns.u_x.is_none() {
            self.optional.push(Column::X.name().to_owned());
        }
        self.is_turned = true;
        Ok(self)
    }

    /// A column by the name that the user gives it.
    pub fn shown(&self, column: Column) -> Column {
        match column {
            Column::X if self.is_turned => Column::Y,
            Column::Y if self.is_turned => Column::X,
            Column::Up if self.is_turned => Column::Along,
            Column::Along if self.is_turned => Column::Up,
            other => other,
        }
    }

    /// Checks that a column holds the place along a layer, on which the layer's fields depend.
    fn check_plane(&self, source: &StudySource) -> Result<(), StudyError> {
        if self.columns.x.is_some() {
            return Ok(());
        }
        Err(source.complaint(
            "the problem is a layer, but no column `x` gives the place of a sample along it".to_owned(),
            "add `x = \"x\"` to [columns] and `x = \"right\"` to [sign], for a distance from the crest of the load"
                .to_owned(),
        ))
    }

    /// What is assumed about the columns that the mapping names without declaring their unit or sign; a column's fields
    /// do not depend on `x`. Presets and the
    /// convention declare everything.
    pub fn taken_for_granted(&self, is_plane: bool) -> Option<String> {
        if self.declared_by != DeclaredBy::User {
            return None;
        }
        let (columns, units, sign) = (&self.columns, &self.units, &self.sign);
        let is_stress = columns.p.is_some() || columns.effective_stress.is_some();
        let taken: Vec<&str> = [
            (
                is_stress && units.stress.is_none(),
                "the unit of stresses, taken as Pa where the file states none",
            ),
            (columns.p.is_some() && sign.p.is_none(), "the sign of `p`, taken as compression-positive"),
            (
                columns.effective_stress.is_some() && sign.effective_stress.is_none(),
                "the sign of `effective_stress`, taken as compression-positive",
            ),
            (
                columns.u_y.is_some() && sign.u_y.is_none(),
                if self.is_turned {
                    "the sign of `u_x`, taken as right"
                } else {
                    "the sign of `u_y`, taken as up"
                },
            ),
            (self.is_turned && columns.u_x.is_some() && sign.u_x.is_none(), "the sign of `u_y`, taken as up"),
            (is_plane && columns.u_x.is_some() && sign.u_x.is_none(), "the sign of `u_x`, taken as right"),
            (
                is_plane && columns.x.is_some() && sign.x.is_none(),
                "the end from which `x` counts, taken as the crest",
            ),
        ]
        .into_iter()
        .filter_map(|(is_taken, words)| is_taken.then_some(words))
        .collect();
        (!taken.is_empty()).then(|| taken.join("; "))
    }

    /// Lets files lack quantities that are left out on purpose, except where another quantity is derived from them: an
    /// effective stress from the pressure, an initial place from the displacement.
    pub fn let_lack(&mut self, quantities: &[Quantity]) {
        let is_current = self.position.y == StatedPlace::Current;
        let is_needed = |quantity: Quantity| match quantity {
            Quantity::Pressure => self.stress.is == StressKind::Total,
            Quantity::Displacement => is_current,
            Quantity::EffectiveStress | Quantity::Settlement | Quantity::LoadFactor => false,
        };
        let may_lack = |quantity: &Quantity| quantities.contains(quantity) && !is_needed(*quantity);
        let columns =
            Column::ALL.into_iter().filter(|column| column.quantity().as_ref().is_some_and(may_lack));
        self.optional.extend(columns.map(|column| column.name().to_owned()));
        self.settlement.take_if(|_| quantities.contains(&Quantity::Settlement));
    }

    /// Whether it names quantities at places, and not a settlement curve alone.
    pub fn has_fields(&self) -> bool {
        let columns = &self.columns;
        let named = Column::ALL.into_iter().any(|column| columns.of_quantity(column).is_some());
        named || self.displacement.is_some()
    }

    /// Takes the times of a case, s, for those of the files in their order, where it says so.
    pub fn follow_case(&mut self, times: &[f64], seconds_per_time_factor: f64) {
        if self.time.case {
            let unit = self.units.time.seconds(1.0, seconds_per_time_factor);
            self.time.list = times.iter().map(|time| time / unit).collect();
        }
    }

    /// The values that no file can have, and what would be right.
    fn faults(&self) -> Vec<Diagnostic> {
        let mut faults = Faults::default();
        self.judge_columns(&mut faults);
        self.judge_numbers(&mut faults);
        self.judge_times(&mut faults);
        self.judge_water(&mut faults);
        faults.0
    }

    /// What the columns are of, and whether they fit together.
    fn judge_columns(&self, faults: &mut Faults) {
        let columns = &self.columns;
        let quantities = [&columns.p, &columns.u_y, &columns.u_x, &columns.effective_stress];
        faults.refuse(
            quantities.iter().all(|name| name.is_none())
                && self.displacement.is_none()
                && self.settlement.is_none(),
            "no column to score is named",
            "name `p`, `u_y`, `u_x` or `effective_stress` in [columns], or a curve in [settlement]",
        );
        let is_wide = columns.wide().next().is_some();
        let is_narrow =
            |column: Column| columns.of_quantity(column).is_some_and(|name| name.single().is_some());
        faults.refuse(
            is_wide && Column::ALL.into_iter().any(is_narrow),
            "some quantities have one column per height, but another has a single column",
            "give its height too, like u_y = { \"top\" = 1.0 }",
        );
        faults.refuse(
            is_wide && columns.x.is_some(),
            "columns with heights have no place along a layer",
            "remove `x` from [columns], or write one row per place",
        );
        let is_current = self.position.y == StatedPlace::Current && self.displacement.is_none();
        for (place, given, component, has_component) in [
            ("y", true, "u_y", columns.u_y.is_some()),
            ("x", columns.x.is_some(), "u_x", columns.u_x.is_some()),
        ] {
            faults.refuse(
                is_current && given && !has_component,
                &format!("current places need the displacement to find the initial `{place}`"),
                &format!("name `{component}` in [columns], or give initial places"),
            );
        }
    }

    /// Numbers, and the marks of a table.
    fn judge_numbers(&self, faults: &mut Faults) {
        faults.refuse(
            ![self.origin.x, self.origin.y, self.origin.p].iter().all(|number| number.is_finite()),
            "an origin is invalid: expected a finite number",
            "write it as in the file",
        );
        faults.refuse(
            self.whole_volume.is_some_and(|volume| !(volume.is_finite() && volume > 0.0)),
            "`whole_volume` is not positive",
            "give the sum of the volumes of all samples",
        );
        faults.refuse(
            ![self.csv.delimiter, self.csv.comment].iter().flatten().all(char::is_ascii),
            "the delimiter or the comment mark is not an ASCII character",
            "use \",\" or \";\"",
        );
        faults.refuse(
            self.csv.decimal.is_some_and(|sign| sign != '.' && sign != ','),
            "the `decimal` of [csv] is neither a point nor a comma",
            "write decimal = \".\" or decimal = \",\"",
        );
        faults.refuse(
            self.csv.decimal == Some(',') && self.csv.delimiter == Some(','),
            "a comma cannot be both the column and the decimal separator",
            "declare another `delimiter`",
        );
    }

    /// Times, and names of files.
    fn judge_times(&self, faults: &mut Faults) {
        faults.refuse(
            self.time.step.is_some_and(|step| !(step.is_finite() && step > 0.0)),
            "the `step` of [time] is not positive",
            "give the seconds from one numbered step to the next",
        );
        faults.refuse(
            self.time.list.iter().chain(self.time.files.values()).any(|time| !time.is_finite()),
            "a time in [time] is invalid: expected a finite number",
            "give times in the unit of [units]",
        );
        faults.refuse(
            self.time.case
                && !(self.time.list.is_empty() && self.time.files.is_empty() && self.time.step.is_none()),
            "the files are at the times of the case, but [time] gives others",
            "leave one of them",
        );
        faults.refuse(
            self.time.pattern.as_ref().is_some_and(|pattern| pattern.matches("{step}").count() != 1),
            "the `pattern` of [time] does not have `{step}` once",
            "write it like \"column_0_{step}.vtk\", with `*` for what differs",
        );
        let stars = |pattern: &String| pattern.matches('*').count();
        faults.refuse(
            self.join.iter().any(|pattern| stars(pattern) == 0 || stars(pattern) != stars(&self.join[0])),
            "the patterns of `join` do not have the same number of `*`, at least one",
            "write them like \"*_scalars_*.vtk\" and \"*_vectors_*.vtk\"",
        );
    }

    /// Water at rest, and what makes a stress effective.
    fn judge_water(&self, faults: &mut Faults) {
        faults.refuse(
            self.hydrostatic.is_some_and(|water| !(water.unit_weight.is_finite() && water.unit_weight > 0.0)),
            "the `unit_weight` of [hydrostatic] is not positive",
            "give it in Pa per m, like 9810.0",
        );
        faults.refuse(
            self.stress.is == StressKind::Total
                && (self.columns.p.is_none() || self.columns.effective_stress.is_none()),
            "a total stress needs the pore pressure to become effective",
            "name both `p` and `effective_stress` in [columns]",
        );
    }
}

/// What is wrong with a mapping.
#[derive(Default)]
struct Faults(Vec<Diagnostic>);

impl Faults {
    /// Adds what is wrong, with what would be right.
    fn refuse(&mut self, is_wrong: bool, message: &str, help: &str) {
        if is_wrong {
            let (message, help) = (message.to_owned(), Some(help.to_owned()));
            self.0.push(Diagnostic { message, span: None, help });
        }
    }
}

#[cfg(test)]
mod tests;
