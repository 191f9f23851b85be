//! Checks of what the soil is made of: the table `[material]`.

use crate::study::check::checker::Checker;
use crate::study::file::MaterialKeys;
use crate::study::inputs::{InputTable, One, TypedInput};

impl Checker<'_> {
    /// Values that are legal numbers and no soil's: a unit of thought.
    pub(crate) fn units_of_thought(&mut self, table: &InputTable<One, MaterialKeys>) {
        let rows = [
            (
                "hydraulic_conductivity",
                10.0..f64::INFINITY,
                "a hydraulic conductivity of {} m/s is no soil's",
                "give metres a second: gravel has 1e-2, clay 1e-10",
            ),
            (
                "youngs_modulus",
                f64::MIN_POSITIVE..1e2,
                "a Young's modulus of {} Pa is no soil's",
                "give pascals, not kPa or MPa: 1000 kPa is 1.0e6",
            ),
            (
                "water_bulk_modulus",
                f64::MIN_POSITIVE..1e3,
                "a bulk modulus of {} Pa is no liquid's",
                "give pascals: water has 2.2e9",
            ),
        ];
        for (name, strange, message, help) in rows {
            let Some(typed) = table.typed(name) else { continue };
            if let TypedInput::Number(number) = typed.get_ref()
                && strange.contains(number)
            {
                self.complain(typed.span(), message.replace("{}", &number.to_string()), help);
            }
        }
    }
}
