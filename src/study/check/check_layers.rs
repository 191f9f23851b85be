//! Checks of the layers of points: what goes with two, how many points the water has, and what carries a weight.

use crate::case::Case;
use crate::study::check::checker::Checker;
use crate::study::file::{StudyFile, SweepTable};
use toml::Spanned;

impl Checker<'_> {
    /// Complains where a case of a sweep cannot carry its weight or have two layers, or where points of the water are named and no case
    /// has any.
    pub(crate) fn layers_fit<Cases: Iterator<Item = Case>>(
        &mut self,
        file: &StudyFile,
        table: &SweepTable,
        start: usize,
        cases: impl Fn() -> Cases,
    ) {
        let of_sweep = |key: &str| table.typed(key).map(Spanned::span);
        let named = |key: &str| of_sweep(key).or_else(|| file.points.typed(key).map(Spanned::span));
        let place = named("layers").unwrap_or(start..start + 1);
        if let Some((why, help)) = cases().find_map(|case| case.refuses_own_weight()) {
            self.complain(named("offset").unwrap_or(start..start + 1), why, help);
        }
        if let Some((why, help)) = cases().find_map(|case| case.refuses_two_layers()) {
            self.complain(place, why, help);
        } else if let Some(of_water) = named("water_per_cell")
            && !cases().any(|case| case.column.points.has_two_layers())
        {
            self.complain(
                of_water,
                "points of the water are named, and every case has one layer for both phases",
                "add `layers = 2`, or leave `water_per_cell` out",
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn checked(scene: &str, method: &str, more: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"{scene}\"\ncolumn.load = 1e3\n[[sweep]]\nmethod = [{method}]\ncells = [4]\n{more}\n"
        );
        Study::check(&StudySource { name: "t.toml".to_owned(), text }).map_err(|error| error.to_string())
    }

    #[test]
    fn what_does_not_go_with_two_layers_is_refused_with_a_sentence() {
        let two = "layers = [2]";
        for (method, more, why) in [
            ("\"GIMP\"", "layers = [2]\nintegrator = [\"implicit\"]", "integrated explicitly alone"),
            ("\"TL-GIMP\"", two, "stay with the skeleton"),
            ("\"GIMP-SRI-patch-cells\"", two, "cells remember what one layer carries"),
            ("\"MPM\"", two, "this basis has none that follow"),
            ("\"uGIMP\"", two, "this basis has none that follow"),
            (
                "\"GIMP\"",
                "layers = [2]\nconductivity_mean = [\"chord\"]",
                "the chord mean is taken over points",
            ),
            ("\"GIMP\"", "layers = [2]\noffset = [0.25]", "do not end where the soil does"),
            ("\"GIMP\"", "layers = [2]\njitter = [0.25]", "do not end where the soil does"),
            ("\"GIMP\"", "water_per_cell = [3]", "every case has one layer for both phases"),
            ("\"GIMP\"", "layers = [3]", "layers"),
        ] {
            let error = checked("xie-leo", method, more).expect_err(why);
            assert!(error.contains(why) && error.contains("--> t.toml:"), "{error}");
        }
        for (scene, why) in [
            ("xie-leo\"\ncolumn.self_weight = true #", "is carried by one layer"),
            ("mandel\"\n#", "tied to one layer"),
        ] {
            let error =
                checked(scene, "\"GIMP\"", "layers = [2]\nintegrator = [\"explicit\"]").expect_err(why);
            assert!(error.contains(why), "{error}");
        }
    }

    #[test]
    fn points_off_their_lattice_carry_no_weight() {
        let scene = "xie-leo\"\ncolumn.self_weight = true #";
        let error = checked(scene, "\"GIMP\"", "offset = [0.25]").expect_err("a shifted lattice");
        assert!(error.contains("integrate no weight exactly") && error.contains("--> t.toml:"), "{error}");
        assert!(checked(scene, "\"GIMP\"", "jitter = [0.1]").is_ok());
    }

    #[test]
    fn the_water_has_as_many_points_as_the_skeleton_where_nothing_is_said() {
        let study = checked("terzaghi", "\"MPM\"", "layers = [1, 2]\npoints_per_cell = [3]").expect("sound");
        let of_water: Vec<usize> =
            study.planned.iter().map(|planned| planned.case.column.points.water_per_cell).collect();
        assert_eq!(of_water, [0, 3]);
        let named =
            checked("terzaghi", "\"MPM\"", "layers = [2]\npoints_per_cell = [3]\nwater_per_cell = [3]");
        assert_eq!(named.expect("sound").planned[0].case.hash(), study.planned[1].case.hash());
        let plain = checked("terzaghi", "\"MPM\"", "points_per_cell = [3]").expect("sound");
        assert_eq!(plain.planned[0].case.hash(), study.planned[0].case.hash());
        assert_eq!(study.planned[1].case.label(), "MPM explicit cells=4 points=3 stable=0.8 (two layers)");
    }
}
