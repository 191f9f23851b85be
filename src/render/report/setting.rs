//! The setting of a study in everyday units: geometry and soil, settlement in millimetres, time in days.

use crate::judge::blocks::setting::SettingFinding;
use crate::render::{RenderError, templates};

/// The inputs of all cases in one sentence from its template; empty where nothing was run.
///
/// # Errors
/// If the template cannot be filled.
pub fn sentence(setting: Option<&SettingFinding>) -> Result<String, RenderError> {
    setting.map_or(Ok(String::new()), |setting| templates::sentence("setting", setting))
}

/// A value in the unit that suits it.
pub fn with_unit(value: f64, unit: &str) -> String {
    let scaled = |scale: f64| format!("{:.3e}", value / scale).parse::<f64>().unwrap_or(value);
    let prefixes: &[(f64, &str)] = match unit {
        "Pa" => &[(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")],
        _ => &[],
    };
    if let Some((scale, name)) = prefixes.iter().find(|(scale, _)| value.abs() >= *scale) {
        return format!("{} {name}", scaled(*scale));
    }
    let is_plain = (1e-3..1e4).contains(&value.abs());
    let number = if is_plain { format!("{}", scaled(1.0)) } else { format!("{:e}", scaled(1.0)) };
    format!("{number} {unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::Record;

    fn told(records: &[Record]) -> String {
        sentence(SettingFinding::new(records).as_ref()).expect("filled")
    }

    #[test]
    fn a_clay_is_told_in_kilopascals_millimetres_and_days() {
        let study = |soil: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n[column]\nheight = 5.0\nload = 50e3\n[output]\ntime_factors = [0.1]\n\
                 [[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [4]\nhydraulic_conductivity = [1e-9]\n{soil}\n"
            );
            told(&records_of(&text))
        };
        // m_v q H = 5e4/1.2e6 · 5 m; H² γ_w/(k E_oed) = 25 · 9810/(1e-9 · 1.2e6) s.
        assert_eq!(
            study(""),
            "*H* = 5 m, *q* = 50 kPa, *E* = 1 MPa, *ν* = 0.25, *n* = 0.3, *k* = 1e-9 m/s, *K_w* = 2.2 GPa: the surface settles \
             by 208.3 mm in the end; T_v = 1 is 6.5 years."
        );
        let several = study("youngs_modulus = [5e5, 1e6]");
        assert!(several.contains("*E* = 500 kPa … 1 MPa"), "{several}");
        assert!(
            several.contains("208.3 mm … 416.7 mm") && several.contains("6.5 years … 13 years"),
            "{several}"
        );
        assert_eq!(told(&[]), "");
    }

    #[test]
    fn layers_are_told_by_what_differs_among_them() {
        let records = records_of(
            "title = 't'\nscene = 'layered'\noutput.time_factors = [0.1]\ncolumn.height = 3.0\n[[column.soils]]\nthickness = 1.0\n\
             youngs_modulus = 2e6\n[[column.soils]]\nthickness = 2.0\nyoungs_modulus = 5e6\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [3]\n",
        );
        let told = told(&records);
        let layers =
            "*K_w* = 2.2 GPa; layers from the base up: 1 m with *E* = 2 MPa; 2 m with *E* = 5 MPa: T_v = 1";
        assert!(told.contains(layers) && told.matches("*E*").count() == 2, "{told}");
    }

    #[test]
    fn numbers_have_the_unit_that_suits_them() {
        for (value, unit, words) in [
            (1e9, "Pa", "1 GPa"),
            (9.99e8, "Pa", "999 MPa"),
            (1e6, "Pa", "1 MPa"),
            (-2500.0, "Pa", "-2.5 kPa"),
            (1.0, "Pa", "1 Pa"),
            (0.5, "Pa", "0.5 Pa"),
            (1e-3, "m/s", "0.001 m/s"),
            (9.9e-4, "m/s", "9.9e-4 m/s"),
            (9999.0, "m", "9999 m"),
            (1e4, "m", "1e4 m"),
            (0.123_456, "", "0.1235"),
        ] {
            assert_eq!(with_unit(value, unit), words);
        }
    }
}
