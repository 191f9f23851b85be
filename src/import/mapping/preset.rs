//! Built-in mappings for known programs and the default; a mapping of the user overrides them.

use crate::import::mapping::{DeclaredBy, Mapping};
use crate::study::diagnostic::StudyError;
use crate::study::file::StudySource;
use crate::study::solver::{PRESETS, Preset};
use include_dir::{Dir, File, include_dir};
use oedometer_formats::{Array, Frame};

/// The mapping of a column's result for which nothing is declared.
pub const CONVENTION: &str = include_str!("../presets/column.toml");
/// The mapping of a layer's result for which nothing is declared.
pub const PLANE_CONVENTION: &str = include_str!("../presets/layer.toml");

/// The mappings of the presets, each a file of its name.
static TEXTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/src/import/presets");

impl Preset {
    /// Its mapping file.
    pub fn text(self) -> &'static str {
        let file = TEXTS.get_file(format!("{}.toml", self.name));
        file.and_then(File::contents_utf8).unwrap_or_default()
    }

    /// The preset of the program that writes the arrays of a state, if one of them shows it.
    pub fn of_frame(frame: &Frame) -> Option<&'static Self> {
        let is_sign = |preset: &Self, array: &Array| preset.signs.iter().any(|sign| array.is_named(sign));
        PRESETS.iter().find(|preset| frame.arrays.iter().any(|array| is_sign(preset, array)))
    }

    /// Its mapping, overridden key by key by the user's own. Columns that only the preset names may be missing in a
    /// file.
    fn mapping(self, own: Option<&StudySource>, is_plane: bool) -> Result<Mapping, StudyError> {
        let base = StudySource { name: format!("the preset {}", self.name), text: self.text().to_owned() };
        let mut merged = base.table()?;
        let mut optional = keys_of_columns(&merged);
        if let Some(own) = own {
            // Read as a mapping first: unknown keys and words are reported at their place in the user's text.
            let _typed: Mapping = own.read()?;
            let own = own.table()?;
            let named = keys_of_columns(&own);
            optional.retain(|key| !named.contains(key));
            override_by(&mut merged, own);
        }
        if let Some(columns) = merged.get_mut("columns").and_then(toml::Value::as_table_mut) {
            columns.retain(|_, name| name.as_str() != Some(""));
            if !is_plane {
                // The fields of a column do not depend on `x`.
                let is_along = |key: &str| ["x", "u_x"].contains(&key);
                optional.retain(|key| !is_along(key));
                columns.retain(|key, _| !is_along(key));
            }
        }
        let is_sample_open = !merged.contains_key("sample");
        let source = own.unwrap_or(&base);
        let mapping: Mapping = StudySource { name: source.name.clone(), text: merged.to_string() }.read()?;
        Mapping { optional, is_sample_open, declared_by: DeclaredBy::Preset(self.name), ..mapping }
            .checked(source)
    }
}

fn keys_of_columns(mapping: &toml::Table) -> Vec<String> {
    let columns = mapping.get("columns").and_then(toml::Value::as_table);
    columns.map_or(Vec::new(), |columns| columns.keys().cloned().collect())
}

/// Replaces the values of a table by those of another, key by key.
fn override_by(base: &mut toml::Table, own: toml::Table) {
    for (key, value) in own {
        match (base.get_mut(&key), value) {
            (Some(toml::Value::Table(base)), toml::Value::Table(own)) => override_by(base, own),
            (_, value) => {
                base.insert(key, value);
            }
        }
    }
}

impl Mapping {
    /// The mapping of files: a preset with the user's own over it, the user's own, or else the convention.
    ///
    /// # Errors
    /// All mistakes in the user's mapping, and a column `x` that is missing for a layer.
    pub fn resolve(
        preset: Option<Preset>,
        own: Option<&StudySource>,
        is_plane: bool,
    ) -> Result<Self, StudyError> {
        match (preset, own) {
            (Some(preset), own) => preset.mapping(own, is_plane),
            (None, Some(own)) => {
                let mapping = Self::read(own)?;
                if is_plane {
                    mapping.check_plane(own)?;
                }
                Ok(mapping)
            }
            (None, None) => Self::convention(is_plane),
        }
    }

    /// The mapping of a result for which nothing is declared, of a column or of a layer.
    ///
    /// # Errors
    /// Never: the text is a constant.
    pub fn convention(is_plane: bool) -> Result<Self, StudyError> {
        let text = if is_plane { PLANE_CONVENTION } else { CONVENTION }.to_owned();
        let mapping = Self::read(&StudySource { name: "the convention".to_owned(), text })?;
        // A layer's result may lack the horizontal displacement.
        Ok(Self { declared_by: DeclaredBy::Convention, optional: vec!["u_x".to_owned()], ..mapping })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ValueEnum;

    fn named(name: &str) -> Preset {
        Preset::from_str(name, false).expect("a preset")
    }

    #[test]
    fn every_preset_is_a_mapping_and_ones_own_goes_over_it() {
        for preset in PRESETS {
            for is_plane in [false, true] {
                let mapping =
                    preset.mapping(None, is_plane).unwrap_or_else(|error| panic!("{}: {error}", preset.name));
                assert_eq!(mapping.columns.x.is_some(), is_plane);
            }
        }
        let text =
            "[columns]\np = \"pressure_interpolated\"\nu_y = \"\"\n[rows]\ncorners = false\n".to_owned();
        let own = StudySource { name: "map.toml".to_owned(), text };
        let mapping = named("ogs").mapping(Some(&own), false).expect("a mapping");
        assert_eq!(
            mapping.columns.get(crate::import::mapping::Column::Pressure).map(String::as_str),
            Some("pressure_interpolated")
        );
        assert_eq!((mapping.columns.u_y, mapping.rows.corners), (None, false));
        assert_eq!(mapping.columns.y, "coordinates[1]");
        assert!(!mapping.optional.contains(&"p".to_owned()) && mapping.optional.contains(&"y".to_owned()));
        let wrong = StudySource { name: "map.toml".to_owned(), text: "[columns]\npp = \"a\"\n".to_owned() };
        assert!(
            named("ogs")
                .mapping(Some(&wrong), false)
                .is_err_and(|error| error.to_string().contains("map.toml:2"))
        );
    }
}
