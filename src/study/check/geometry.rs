//! Checks of where the soil is and what loads it: the tables `[column]` and `[layer]`.

use crate::elementary;
use crate::exact::cosine_layer::Base;
use crate::exact::error::ExactError;
use crate::exact::xie_leo::XieLeo;
use crate::scene::SceneKind;
use crate::scene::arrangement::Arrangement;
use crate::scene::column::{Column, column_parameters};
use crate::soil::material::Material;
use crate::study::check::Checker;
use crate::study::diagnostic::Diagnostic;
use crate::study::file::{ColumnTable, LayerTable, StudyFile};
use toml::Spanned;

/// Final strain `m_vl q` up to which small-strain theory is taken without a word.
const LARGEST_SMALL_STRAIN: f64 = 1e-2;

impl Checker<'_> {
    /// The column's or the layer's table, whichever the scene is about; the other is refused.
    pub(crate) fn geometry(&mut self, file: &StudyFile, scene: SceneKind) -> Column {
        if scene.needs_two_dimensions() {
            if let Some(span) = file.column.typed() {
                let name = scene.name();
                self.complain(
                    span,
                    format!("the scene `{name}` has no [column]"),
                    "its geometry and load stand in the table [layer]: length, height, base, load",
                );
            }
            return self.layer(file.layer.as_ref().map(Spanned::get_ref));
        }
        if let Some(layer) = &file.layer {
            self.complain(
                layer.span(),
                format!("the scene `{}` has no [layer]", scene.name()),
                "its geometry and load stand in the table [column]: height, width, load, dimensions",
            );
        }
        self.column(&file.column, scene)
    }

    fn layer(&mut self, table: Option<&LayerTable>) -> Column {
        let seed = Column::layer();
        let Some(table) = table else { return seed };
        let base = table.base.as_ref().and_then(|word| self.word(word, "base", &Base::ALL.map(Base::name)));
        Column {
            height: self.positive(table.height.as_ref(), "layer.height", "m", seed.height),
            horizontal_extent: self.positive(
                table.length.as_ref(),
                "layer.length",
                "m",
                seed.horizontal_extent,
            ),
            load: self.positive(table.load.as_ref(), "layer.load", "Pa", seed.load),
            base: base.map_or(seed.base, |index| Some(Base::ALL[index])),
            ..seed
        }
    }

    pub(crate) fn column(&mut self, table: &ColumnTable, scene: SceneKind) -> Column {
        let seed = Column::default();
        if let Some(typed) = table.loading_time.as_ref().filter(|_| !scene.takes_loading_time()) {
            self.complain(
                typed.span(),
                format!("the load of `{}` acts at once", scene.name()),
                "a load that grows belongs to the scenes \"xie-leo\" and \"dynamic-column\"",
            );
        }
        Column {
            dimensions: self
                .count(table.dimensions.as_ref(), "column.dimensions", 1..=2)
                .unwrap_or(seed.dimensions),
            base: None,
            height: self.positive(table.height.as_ref(), "column.height", "m", seed.height),
            horizontal_extent: self.positive(
                table.width.as_ref(),
                "column.width",
                "m",
                seed.horizontal_extent,
            ),
            load: self.positive(table.load.as_ref(), "column.load", "Pa", seed.load),
            loading_time: self.not_negative(table.loading_time.as_ref(), "column.loading_time", "s"),
            points: Arrangement::default(),
        }
    }

    /// A load that would press out more water than the pores hold has no end state: the exact
    /// solutions say so before anything runs.
    pub(crate) fn porosity_at_the_end(
        &mut self,
        file: &StudyFile,
        scene: SceneKind,
        column: &Column,
        soil: &Material,
    ) {
        if !scene.is_large_strain() || !self.diagnostics.is_empty() {
            return;
        }
        let parameters = column_parameters(column, soil);
        if let Err(error @ ExactError::LoadClosesPores { limit, .. }) = XieLeo::new(&parameters) {
            let typed = file.column.load.as_ref().or(file.material.porosity.as_ref());
            let typed = typed.or(file.material.youngs_modulus.as_ref()).map(Spanned::span);
            let most = limit * soil.oedometric_modulus();
            let least = -elementary::exp_m1(-column.load / soil.oedometric_modulus());
            self.complain(
                typed.unwrap_or_else(|| file.scene.span()),
                error.to_string(),
                format!("load less than {most:.4e} Pa, or give a porosity above {least:.4}"),
            );
        }
    }

    /// A load under which a theory of small strain is off by more than a percent.
    pub(crate) fn large_for_small_strain(
        &self,
        file: &StudyFile,
        scene: SceneKind,
        column: &Column,
        soil: &Material,
    ) -> Option<String> {
        let strain = column.load / soil.oedometric_modulus();
        if scene.is_large_strain() || strain <= LARGEST_SMALL_STRAIN {
            return None;
        }
        let typed = file.column.load.as_ref().or(file.material.youngs_modulus.as_ref()).map(Spanned::span);
        let diagnostic = Diagnostic::at(
            typed.unwrap_or_else(|| file.scene.span()),
            format!(
                "the load strains the column by m_vl q = {strain:.2e}: real soil is off this scene's small-strain \
                 theory by a share of that size"
            ),
            "the errors printed are against small-strain theory all the same; the scene `xie-leo` is of large strain",
        );
        Some(diagnostic.warning(&self.source.name, &self.source.text))
    }
}
