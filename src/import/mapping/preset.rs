//! What other programs' files mean, as mappings that a user's own goes over.

use crate::import::mapping::Mapping;
use crate::study::diagnostic::StudyError;
use crate::study::file::StudySource;

/// A program whose files are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Preset {
    /// `OpenGeoSys` 6.
    #[value(help = "OpenGeoSys 6")]
    Ogs,
    /// `KratosMultiphysics` with its `GeoMechanicsApplication`.
    #[value(help = "KratosMultiphysics with its GeoMechanicsApplication")]
    Kratos,
    /// `PorePy`.
    #[value(help = "PorePy")]
    Porepy,
    /// `GeoTaichi`'s material points.
    #[value(help = "GeoTaichi's material points")]
    Geotaichi,
    /// meshio, scikit-fem, `FEniCS` and others with a pressure and a displacement.
    #[value(help = "meshio, scikit-fem, FEniCS and others with a pressure and a displacement")]
    Meshio,
}

const OGS: &str = r#"sample = "nodes"
[columns]
x = "coordinates[0]"
y = "coordinates[1]"
p = "pressure"
u_x = "displacement[0]"
u_y = "displacement[1]"
effective_stress = "sigma[1]"
[sign]
effective_stress = "tension-positive"
[rows]
corners = true
"#;

const KRATOS: &str = r#"sample = "nodes"
[columns]
x = "coordinates[0]"
y = "coordinates[1]"
p = "WATER_PRESSURE"
u_x = "DISPLACEMENT[0]"
u_y = "DISPLACEMENT[1]"
[sign]
p = "tension-positive"
[rows]
corners = true
"#;

const POREPY: &str = r#"sample = "centres"
[columns]
x = "coordinates[0]"
y = "coordinates[1]"
p = "cells:pressure"
u_x = "cells:u[0]"
u_y = "cells:u[1]"
"#;

const GEOTAICHI: &str = r#"sample = "points"
[columns]
t = "t_current"
x = "position[0]|coordinates[0]"
y = "position[1]|coordinates[1]"
p = "pressure"
effective_stress = "stress[1]"
volume = "volume"
[sign]
effective_stress = "tension-positive"
[position]
y = "current"
[displacement]
from = "first-frame"
"#;

const MESHIO: &str = r#"[columns]
t = "time|t"
x = "coordinates[0]|x|position[0]"
y = "coordinates[1]|y|position[1]"
p = "pressure|p|pore_pressure|porepressure|water_pressure|pressure_interpolated"
u_x = "displacement[0]|u[0]|disp[0]|u_x"
u_y = "displacement[1]|u[1]|disp[1]|u_y"
"#;

impl Preset {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ogs => "ogs",
            Self::Kratos => "kratos",
            Self::Porepy => "porepy",
            Self::Geotaichi => "geotaichi",
            Self::Meshio => "meshio",
        }
    }

    /// Its mapping, as a file.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Ogs => OGS,
            Self::Kratos => KRATOS,
            Self::Porepy => POREPY,
            Self::Geotaichi => GEOTAICHI,
            Self::Meshio => MESHIO,
        }
    }

    /// Its mapping with what the user's own says instead; what only the preset names, a file may lack.
    ///
    /// # Errors
    /// What is wrong in the user's mapping, all at once.
    pub fn mapping(self, own: Option<&StudySource>, is_plane: bool) -> Result<Mapping, StudyError> {
        let base = StudySource { name: format!("the preset {}", self.name()), text: self.text().to_owned() };
        let mut merged = base.table()?;
        let source = own.unwrap_or(&base);
        let mut optional: Vec<String> = merged
            .get("columns")
            .and_then(toml::Value::as_table)
            .map_or(Vec::new(), |columns| columns.keys().cloned().collect());
        if let Some(own) = own {
            // Unknown keys and words are told at their place in the user's text.
            let _typed: Mapping = own.read()?;
            let own = own.table()?;
            if let Some(named) = own.get("columns").and_then(toml::Value::as_table) {
                optional.retain(|key| !named.contains_key(key));
            }
            lay_over(&mut merged, own);
        }
        if let Some(columns) = merged.get_mut("columns").and_then(toml::Value::as_table_mut) {
            columns.retain(|_, name| name.as_str() != Some(""));
            if !is_plane {
                // A column's fields do not depend on the place along it.
                optional.retain(|key| !["x", "u_x"].contains(&key.as_str()));
                columns.retain(|key, _| !["x", "u_x"].contains(&key));
            }
        }
        let is_sample_open = !merged.contains_key("sample");
        let text = merged.to_string();
        let mapping: Mapping = StudySource { name: source.name.clone(), text }.read()?;
        Mapping { optional, is_sample_open, is_of_preset: true, preset: self.name(), ..mapping }
            .checked(source)
    }
}

/// Puts a table over another, key by key.
fn lay_over(base: &mut toml::Table, own: toml::Table) {
    for (key, value) in own {
        match (base.get_mut(&key), value) {
            (Some(toml::Value::Table(base)), toml::Value::Table(own)) => lay_over(base, own),
            (_, value) => {
                base.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ValueEnum;

    #[test]
    fn every_preset_is_a_mapping_and_ones_own_goes_over_it() {
        for preset in Preset::value_variants() {
            for is_plane in [false, true] {
                let mapping =
                    preset.mapping(None, is_plane).unwrap_or_else(|error| panic!("{preset:?}: {error}"));
                assert_eq!(mapping.columns.x.is_some(), is_plane);
            }
        }
        let text =
            "[columns]\np = \"pressure_interpolated\"\nu_y = \"\"\n[rows]\ncorners = false\n".to_owned();
        let own = StudySource { name: "map.toml".to_owned(), text };
        let mapping = Preset::Ogs.mapping(Some(&own), false).expect("a mapping");
        assert_eq!(mapping.columns.p.as_deref(), Some("pressure_interpolated"));
        assert_eq!((mapping.columns.u_y, mapping.rows.corners), (None, false));
        assert_eq!(mapping.columns.y, "coordinates[1]");
        assert!(!mapping.optional.contains(&"p".to_owned()) && mapping.optional.contains(&"y".to_owned()));
        let wrong = StudySource { name: "map.toml".to_owned(), text: "[columns]\npp = \"a\"\n".to_owned() };
        assert!(
            Preset::Ogs
                .mapping(Some(&wrong), false)
                .is_err_and(|error| error.to_string().contains("map.toml:2"))
        );
    }
}
