//! Checks of what the soil is made of: the table `[material]`.

use crate::scene::SceneKind;
use crate::soil::continuity::Continuity;
use crate::soil::law::Law;
use crate::soil::material::Material;
use crate::study::check::Checker;
use crate::study::file::MaterialTable;
use toml::Spanned;

impl Checker<'_> {
    pub(crate) fn material(&mut self, table: &MaterialTable, scene: SceneKind) -> Material {
        let seed = Material::default();
        let law = table.law.as_ref().and_then(|word| self.law(word, scene));
        let continuity = table.continuity.as_ref().and_then(|word| self.continuity(word));
        let soil = Material {
            law: law.unwrap_or(scene.default_law()),
            youngs_modulus: self.positive(
                table.youngs_modulus.as_ref(),
                "material.youngs_modulus",
                "Pa",
                seed.youngs_modulus,
            ),
            poissons_ratio: self.between(
                table.poissons_ratio.as_ref(),
                "material.poissons_ratio",
                -1.0,
                0.5,
                seed.poissons_ratio,
            ),
            porosity: self.between(table.porosity.as_ref(), "material.porosity", 0.0, 1.0, seed.porosity),
            grain_density: self.positive(
                table.grain_density.as_ref(),
                "material.grain_density",
                "kg/m³",
                seed.grain_density,
            ),
            water_density: self.positive(
                table.water_density.as_ref(),
                "material.water_density",
                "kg/m³",
                seed.water_density,
            ),
            water_bulk_modulus: self.positive(
                table.water_bulk_modulus.as_ref(),
                "material.water_bulk_modulus",
                "Pa",
                seed.water_bulk_modulus,
            ),
            hydraulic_conductivity: self.positive(
                table.hydraulic_conductivity.as_ref(),
                "material.hydraulic_conductivity",
                "m/s",
                seed.hydraulic_conductivity,
            ),
            gravity: self.positive(table.gravity.as_ref(), "material.gravity", "m/s²", seed.gravity),
            continuity: continuity.unwrap_or(seed.continuity),
        };
        self.units_of_thought(table);
        soil
    }

    pub(crate) fn law(&mut self, word: &Spanned<String>, scene: SceneKind) -> Option<Law> {
        let law = Law::ALL[self.word(word, "law", &Law::ALL.map(Law::name))?];
        if let Some(why) = scene.refuses_law(law) {
            let fit = Law::ALL.into_iter().filter(|law| scene.refuses_law(*law).is_none());
            let names: Vec<&str> = fit.map(Law::name).collect();
            self.complain(
                word.span(),
                why,
                format!("the scene `{}` takes {}", scene.name(), names.join(", ")),
            );
            return None;
        }
        Some(law)
    }

    pub(crate) fn continuity(&mut self, word: &Spanned<String>) -> Option<Continuity> {
        let index = self.word(word, "continuity", &Continuity::ALL.map(Continuity::name))?;
        Some(Continuity::ALL[index])
    }

    /// Values that are legal numbers and no soil's: a unit of thought.
    fn units_of_thought(&mut self, table: &MaterialTable) {
        let rows = [
            (
                &table.hydraulic_conductivity,
                10.0..f64::INFINITY,
                "a hydraulic conductivity of {} m/s is no soil's",
                "give metres a second: gravel has 1e-2, clay 1e-10",
            ),
            (
                &table.youngs_modulus,
                f64::MIN_POSITIVE..1e2,
                "a Young's modulus of {} Pa is no soil's",
                "give pascals, not kPa or MPa: 1000 kPa is 1.0e6",
            ),
            (
                &table.water_bulk_modulus,
                f64::MIN_POSITIVE..1e3,
                "a bulk modulus of {} Pa is no liquid's",
                "give pascals: water has 2.2e9",
            ),
        ];
        for (typed, strange, message, help) in rows {
            if let Some(typed) = typed.as_ref().filter(|typed| strange.contains(typed.get_ref())) {
                self.complain(typed.span(), message.replace("{}", &typed.get_ref().to_string()), help);
            }
        }
    }
}
