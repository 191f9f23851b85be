//! Built-in mappings for known programs and the default; a mapping of the user overrides them.

use crate::import::mapping::{Axes, DeclaredBy, Mapping};
use crate::solver::{PRESETS, Preset};
use include_dir::{Dir, File, include_dir};
use oedometer_formats::{Array, Frame};
use oedometer_input::diagnostic::StudyError;
use oedometer_input::source::StudySource;

/// The mapping of a column's result without a declaration.
pub const CONVENTION: &str = include_str!("../presets/column.toml");
/// The mapping of a layer's result without a declaration.
pub const PLANE_CONVENTION: &str = include_str!("../presets/layer.toml");
/// The mapping of a slab's result without a declaration.
pub const SLAB_CONVENTION: &str = include_str!("../presets/slab.toml");

/// The text of the mapping without a declaration.
pub fn convention_of(axes: Axes) -> &'static str {
    match axes {
        Axes::Column => CONVENTION,
        Axes::Layer => PLANE_CONVENTION,
        Axes::Slab => SLAB_CONVENTION,
    }
}

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
    fn mapping(self, own: Option<&StudySource>, axes: Axes) -> Result<Mapping, StudyError> {
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
            if axes == Axes::Column {
                // The fields of a column do not depend on `x`.
                let is_along = |key: &str| ["x", "u_x"].contains(&key);
                optional.retain(|key| !is_along(key));
                columns.retain(|key, _| !is_along(key));
            }
        }
        let is_sample_open = !merged.contains_key("sample");
        let source = own.unwrap_or(&base);
        let mapping: Mapping = StudySource { name: source.name.clone(), text: merged.to_string() }.read()?;
        let turn = |key: String| match key.as_str() {
            "x" => "y".to_owned(),
            "y" => "x".to_owned(),
            "u_x" => "u_y".to_owned(),
            "u_y" => "u_x".to_owned(),
            _ => key,
        };
        let optional = if axes == Axes::Slab { optional.into_iter().map(turn).collect() } else { optional };
        Mapping { optional, is_sample_open, declared_by: DeclaredBy::Preset(self.name), ..mapping }
            .for_axes(axes, source)?
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
        axes: Axes,
    ) -> Result<Self, StudyError> {
        match (preset, own) {
            (Some(preset), own) => preset.mapping(own, axes),
            (None, Some(own)) => Self::read(own)?.for_axes(axes, own),
            (None, None) => Self::convention(axes),
        }
    }

    /// The mapping of a result without a declaration, of a column, of a layer or of a slab.
    ///
    /// # Errors
    /// Never: the text is a constant.
    pub fn convention(axes: Axes) -> Result<Self, StudyError> {
        let source = StudySource { name: "the convention".to_owned(), text: convention_of(axes).to_owned() };
        let mut mapping = Self::read(&source)?.for_axes(axes, &source)?;
        // A layer's result may lack the displacement along it.
        mapping.optional.push("u_x".to_owned());
        Ok(Self { declared_by: DeclaredBy::Convention, ..mapping })
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
            for axes in [Axes::Column, Axes::Layer] {
                let mapping =
                    preset.mapping(None, axes).unwrap_or_else(|error| panic!("{}: {error}", preset.name));
                assert_eq!(mapping.columns.x.is_some(), axes == Axes::Layer);
            }
        }
        let text =
            "[columns]\np = \"pressure_interpolated\"\nu_y = \"\"\n[rows]\ncorners = false\n".to_owned();
        let own = StudySource { name: "map.toml".to_owned(), text };
        let mapping = named("ogs").mapping(Some(&own), Axes::Column).expect("a mapping");
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
                .mapping(Some(&wrong), Axes::Column)
                .is_err_and(|error| error.to_string().contains("map.toml:2"))
        );
    }
}
