//! Units that a file states itself, in an attribute, a row below the names or brackets behind a name: they are those of its
//! numbers, whatever a mapping takes for them.

use crate::import::mapping::units::{StressUnit, TimeUnit};
use crate::import::mapping::{Column, Mapping};
use oedometer_input::units::size_of;

/// What a unit makes of the numbers of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum SaidUnit {
    /// They are in the unit of the mapping, or have none.
    AsMapped,
    /// They become those of the mapping's unit by this factor; a note says so.
    Factor(f64, String),
    /// It is no unit of what the column holds, in a sentence.
    Unfit(String),
}

/// Marks of a number without a unit.
const NONE: [&str; 5] = ["", "-", "–", "1", "none"];

impl SaidUnit {
    /// The meaning of a unit that the file states for a column of a name.
    pub fn of(column: Column, name: &str, unit: &str, mapping: &Mapping) -> Self {
        let units = &mapping.units;
        let (si, own, word) = match column {
            Column::Time if units.time == TimeUnit::TimeFactor => return Self::AsMapped,
            Column::Time => ("s", units.time.seconds(1.0, 1.0), units.time.name()),
            Column::X | Column::Y => ("m", units.length.metres(), units.length.name()),
            Column::Along | Column::Up => {
                let length = units.displacement.unwrap_or(units.length);
                ("m", length.metres(), length.name())
            }
            Column::Pressure | Column::EffectiveStress => {
                let stress = units.stress.unwrap_or(StressUnit::Pascal);
                ("Pa", stress.pascals(), stress.name())
            }
            Column::Volume => return Self::AsMapped,
        };
        if NONE.contains(&unit.trim()) {
            return Self::AsMapped;
        }
        match size_of(unit, si) {
            Some(size) if (size / own - 1.0).abs() < 1e-12 => Self::AsMapped,
            Some(size) => {
                Self::Factor(size / own, format!("`{name}` is in {unit}, as the file states, not in {word}"))
            }
            None => Self::Unfit(format!(
                "`{name}` is in `{unit}`, as the file states, but `{}` cannot be read in that unit: it is \
                 taken as {word}",
                mapping.shown(column).name()
            )),
        }
    }

    /// The unit in brackets at the end of a name, as in `p [kPa]` and `u_y(mm)`; of words that are units of something.
    pub fn in_name(name: &str) -> Option<&str> {
        let name = name.trim();
        let inside = name.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
        let inside = inside.or_else(|| name.strip_suffix(')').and_then(|rest| rest.rsplit_once('(')));
        inside.map(|(_, unit)| unit.trim()).filter(|unit| oedometer_input::units::is_unit(unit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::mapping::Axes;

    #[test]
    fn a_unit_of_the_file_goes_over_that_of_the_mapping_where_it_fits() {
        let mapping = Mapping::convention(Axes::Column).expect("a constant");
        for (column, unit, factor) in [
            (Column::Pressure, "kPa", Some(1e3)),
            (Column::Time, "nanoseconds", Some(1e-9)),
            (Column::Up, "mm", Some(1e-3)),
            (Column::Y, "cm", Some(1e-2)),
            (Column::Pressure, "Pa", None),
            (Column::Time, "-", None),
        ] {
            match (SaidUnit::of(column, "a", unit, &mapping), factor) {
                (SaidUnit::AsMapped, None) => {}
                (SaidUnit::Factor(found, _), Some(factor)) => {
                    assert!((found / factor - 1.0).abs() < 1e-12, "{unit}");
                }
                (other, _) => panic!("{unit}: {other:?}"),
            }
        }
        let head = SaidUnit::of(Column::Pressure, "h", "m", &mapping);
        assert!(
            matches!(head, SaidUnit::Unfit(told) if told.starts_with("`h` is in `m`, as the file states"))
        );
        let names = ["p [kPa]", "u_y(mm)", "p", "sigma[1]", "p (clay)"].map(SaidUnit::in_name);
        assert_eq!(names, [Some("kPa"), Some("mm"), None, None, None]);
    }
}
