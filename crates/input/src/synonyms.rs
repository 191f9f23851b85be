//! Keys and words of other programs and textbooks, and what they are called here.

use crate::nearest::nearest;
use oedometer_case::keys::{KEYS, Key};

/// Keys of earlier versions, and what they are called now.
const RENAMED: [(&str, &str); 2] = [("layers", "sets"), ("one_layer_within", "one_set_within")];

/// Terms of the field, each with the key or word of a study file that it is read as.
pub const FIELD_TERMS: [(&str, &str); 12] = [
    ("benchmark_problem", "scene"),
    ("musl", "mapping_back"),
    ("unloading_reloading_modulus", "reload_modulus"),
    ("test_level", "tier"),
    ("zip", "path"),
    ("error_plateau", "floor"),
    ("safety_factor", "stable"),
    ("step_over_elapsed_time", "growth"),
    ("bearing_capacity_factor", "load_factor"),
    ("hydrostatic-equilibrium", "at-rest"),
    ("first-eigenmode", "single-mode"),
    ("dynamic-first-eigenmode", "dynamic-single-mode"),
];

/// The key or word of a study file that a term of the field is read as; any other word is itself.
pub fn read_as(term: &str) -> &str {
    FIELD_TERMS.iter().find(|(field, _)| *field == term).map_or(term, |(_, word)| word)
}

/// Keys of the tables that hold no input of a case.
const TABLE_KEYS: [(&str, &[&str]); 2] =
    [("output", &["time_factors", "times", "references"]), ("timing", &["repeats"])];

/// Other names of a key, and the key. Single letters are case-sensitive.
pub const KEY_NAMES: &[(&[&str], &str)] = &[
    // The study.
    (&["name", "caption"], "title"),
    (&["description", "question", "comment", "notes"], "summary"),
    (&["problem", "benchmark", "test_case"], "scene"),
    (&["max_seconds", "timeout_seconds", "walltime"], "case_seconds"),
    // Tables.
    (&["geometry", "domain", "body"], "column"),
    (&["soil", "materials", "soil_properties", "properties"], "material"),
    (&["outputs", "results_at"], "output"),
    (&["sweeps", "cases", "parameters"], "sweep"),
    (&["expectation", "expectations", "criteria"], "expect"),
    // The body.
    (&["H", "h0", "thickness", "depth", "length_of_column", "column_height"], "height"),
    (&["q", "q0", "p0", "surcharge", "traction", "external_load", "applied_load", "sigma0"], "load"),
    (&["b", "footing_width", "strip_width"], "plate_width"),
    (&["dim", "dims", "ndim", "dimension"], "dimensions"),
    (&["ramp", "ramp_time", "t_load", "load_duration"], "loading_time"),
    (&["layer", "layers", "strata", "soil_layers"], "soils"),
    (&["own_weight", "body_force", "use_gravity"], "self_weight"),
    (&["final_strain", "vertical_strain", "compression"], "strain"),
    // The soil.
    (&["constitutive_model", "constitutive_law", "material_model", "material_law", "model"], "law"),
    (
        &["E", "e_modulus", "young", "youngs", "young_modulus", "elastic_modulus", "modulus", "stiffness"],
        "youngs_modulus",
    ),
    (&["nu", "ν", "poisson", "poissons", "poisson_coefficient", "v"], "poissons_ratio"),
    (&["n", "n0", "n_0", "phi", "porosity_0", "initial_porosity"], "porosity"),
    (
        &[
            "k",
            "k0",
            "k_0",
            "kf",
            "k_f",
            "ks",
            "k_s",
            "ksat",
            "k_sat",
            "kv",
            "k_v",
            "kh",
            "perm",
            "permeability",
            "conductivity",
            "permeability_coefficient",
            "hydraulic_permeability",
            "saturated_conductivity",
        ],
        "hydraulic_conductivity",
    ),
    (
        &[
            "kw",
            "k_w",
            "k_fluid",
            "bulk_modulus_water",
            "bulk_modulus_fluid",
            "fluid_bulk_modulus",
            "water_modulus",
            "water_stiffness",
            "liquid_bulk_modulus",
        ],
        "water_bulk_modulus",
    ),
    (&["rho_s", "ρ_s", "rhos", "solid_density", "density_solid", "density_grains"], "grain_density"),
    (&["rho_w", "ρ_w", "rhow", "rho_f", "fluid_density", "density_water", "liquid_density"], "water_density"),
    (&["g", "gravitational_acceleration", "gravity_acceleration"], "gravity"),
    (&["e_oed", "eoed", "constrained_modulus", "stiffness_modulus"], "oedometric_modulus"),
    (&["c_v", "cv", "consolidation_coefficient"], "coefficient_of_consolidation"),
    (&["c_u", "cu", "s_u", "su", "cohesion", "shear_strength", "yield_strength"], "undrained_strength"),
    (
        &["p_c", "pc", "sigma_p", "preconsolidation_pressure", "preconsolidation_stress", "yield_stress"],
        "preconsolidation",
    ),
    // The numbers of a run.
    (&["methods", "algorithm", "formulation_of_space", "discretisation", "discretization"], "method"),
    (&["time_integrator", "time_integration", "time_scheme", "time_stepping"], "integrator"),
    (
        &[
            "mesh",
            "meshes",
            "elements",
            "n_elements",
            "nelements",
            "num_elements",
            "nel",
            "n_cells",
            "ncells",
            "num_cells",
            "grid",
            "ny",
            "nely",
            "resolution",
            "refinement",
        ],
        "cells",
    ),
    (
        &[
            "ppc",
            "mpc",
            "particles_per_cell",
            "mps_per_cell",
            "material_points_per_cell",
            "particles",
            "points",
            "material_points",
            "npart",
            "nppc",
        ],
        "points_per_cell",
    ),
    (
        &[
            "dt",
            "δt",
            "delta_t",
            "step",
            "steps",
            "step_size",
            "timestep",
            "time_steps",
            "time_increment",
            "increment",
        ],
        "time_step",
    ),
    // Outputs and expectations.
    (&["t", "output_times", "save_times", "write_times", "times_s"], "times"),
    (&["tv", "t_v", "output_time_factors"], "time_factors"),
    (&["analytical", "exact", "exact_solution", "analytical_solution"], "references"),
    (&["field", "variable", "result"], "quantity"),
    (&["location", "place", "where", "at_points"], "sample"),
    (&["rate", "convergence_rate", "convergence_order"], "order"),
    (&["runs", "repetitions", "n_repeats"], "repeats"),
];

/// Names of what other keys give, and how.
const DERIVED: &[(&[&str], &str)] = &[
    (
        &["layer", "layers", "soils", "strata", "soil_layers"],
        "the layers of a column are [[column.soils]], from the base up",
    ),
    (&["e", "void_ratio", "e0", "e_0"], "give the porosity instead, n = e/(1 + e): `porosity`"),
    (&["m_v", "mv"], "give the oedometric modulus instead, E_oed = 1/m_v: `oedometric_modulus`"),
    (
        &["intrinsic_permeability", "kappa", "viscosity", "dynamic_viscosity", "mu"],
        "give the hydraulic conductivity instead, k = κ ρ_w g/μ in m/s: `hydraulic_conductivity`",
    ),
    (
        &["G", "K", "shear_modulus", "bulk_modulus", "lame_lambda", "lame_mu", "lambda"],
        "give `youngs_modulus` and `poissons_ratio` instead: E = 9KG/(3K + G), ν = (3K − 2G)/(6K + 2G)",
    ),
    (
        &["gamma_w", "unit_weight_water", "unit_weight_of_water"],
        "it follows from `water_density` and `gravity`: γ_w = ρ_w g",
    ),
    (
        &[
            "density",
            "rho",
            "saturated_density",
            "dry_density",
            "rho_sat",
            "gamma_sat",
            "specific_gravity",
            "g_s",
        ],
        "give `grain_density`, of the grains alone, and `water_density`: ρ = (1 − n) ρ_s + n ρ_w",
    ),
    (
        &["compressibility", "water_compressibility", "fluid_compressibility", "beta", "beta_w"],
        "give its inverse: `water_bulk_modulus`",
    ),
    (
        &["cell_size", "element_size", "mesh_size", "h", "dx", "dy"],
        "give the number of cells over the height, `cells`, or the height of the column, `height`",
    ),
    (
        &["tolerance", "max_error", "error", "threshold"],
        "an [[expect]] bounds an error like `at = { cells = 10, below = \"1 %\" }`",
    ),
    (
        &["end_time", "t_end", "final_time", "duration"],
        "a run ends at its last output: set `times` or `time_factors`",
    ),
];

/// Other words for a value.
pub const WORDS: &[(&[&str], &str)] = &[
    (&["consolidation", "oedometer", "1d-consolidation", "terzaghi-1d", "column"], "terzaghi"),
    (&["large-strain", "finite-strain", "large-strain-consolidation"], "xie-leo"),
    (&["layers", "multilayer"], "layered"),
    (&["strip-footing", "foundation", "prandtl"], "footing"),
    (&["euler", "forward-euler", "central-difference", "symplectic-euler"], "explicit"),
    (&["backward-euler", "sdirk2", "newmark", "crank-nicolson"], "implicit"),
    (&["p", "pwp", "pore-pressure", "pore_pressure", "excess-pore-pressure"], "pressure"),
    (&["stress", "sigma", "effective-stress"], "effective_stress"),
    (&["disp", "u_y", "uy"], "displacement"),
    (&["s", "surface-displacement"], "settlement"),
    (&["cell-centres", "cell-centers", "centers", "gauss-points"], "centres"),
    (&["particles", "material-points", "mps"], "points"),
    (&["elastic", "linear-elastic", "hooke"], "linear"),
    (&["tresca"], "von-mises"),
];

/// What is known of a key that a table does not have.
pub(crate) struct UnknownKey<'a> {
    /// What to write instead.
    pub(crate) help: String,
    /// The key that was meant.
    pub(crate) meant: Option<&'a str>,
    /// The table that has it.
    pub(crate) home: Option<&'static str>,
}

impl<'a> UnknownKey<'a> {
    /// A name that is not among the known ones.
    pub(crate) fn among(name: &str, known: &[&'a str]) -> Self {
        let has = |wanted: &str| known.iter().copied().find(|key| *key == wanted);
        let (mut meant, mut home) = (None, None);
        let help = if let Some(new) = RENAMED.iter().find_map(|(old, new)| has(new).filter(|_| *old == name))
        {
            meant = Some(new);
            format!("it is now called `{new}`")
        } else if has(read_as(name)).is_some() {
            format!("it is another name of `{}`: leave one of them out", read_as(name))
        } else {
            let usual = self::meant(KEY_NAMES, name).filter(|key| *key != name);
            let near = || nearest(name, known.iter().copied());
            meant = usual.and_then(has).or_else(|| near().filter(|_| derived(name).is_none()));
            let of_key =
                |name: &str| KEYS.iter().find(|key| key.name == name).map(|key| (key.name, table_of(key)));
            let key = usual.unwrap_or(name);
            let of_table = || {
                TABLE_KEYS.iter().find_map(|(table, keys)| {
                    let key = keys.iter().find(|known| **known == key)?;
                    Some((*key, *table))
                })
            };
            let elsewhere = || of_table().or_else(|| of_key(name)).or_else(|| of_key(key));
            if let Some(meant) = meant {
                format!("did you mean `{meant}`?")
            } else if let Some(how) = derived(name) {
                how.to_owned()
            } else if let Some((key, table)) = elsewhere() {
                home = Some(table);
                let header = if table == "sweep" { "[[sweep]]".to_owned() } else { format!("[{table}]") };
                format!("`{key}` belongs to {header}: `{table}.{key}`")
            } else {
                format!("the keys here are {}", known.join(", "))
            }
        };
        Self { help, meant, home }
    }
}

/// How other keys give what a name stands for.
pub(crate) fn derived(name: &str) -> Option<&'static str> {
    meant(DERIVED, name)
}

/// The table that has a key: the study's own before a sweep.
fn table_of(key: &Key) -> &'static str {
    key.tables.iter().copied().find(|table| *table != "sweep").unwrap_or("sweep")
}

/// The word among the known ones that another program or textbook calls differently.
pub(crate) fn usual_word<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let usual = meant(WORDS, word)?;
    known.iter().copied().find(|known| *known == usual)
}

/// What a name stands for, whatever its case, hyphens and blanks.
fn meant(table: &[(&[&str], &'static str)], name: &str) -> Option<&'static str> {
    let plain = if name.chars().count() == 1 { name.to_owned() } else { name.to_lowercase() };
    let plain = plain.replace(['-', ' '], "_");
    let is_name = |other: &&str| other.replace('-', "_") == plain;
    table.iter().find(|(names, _)| names.iter().any(is_name)).map(|(_, meant)| *meant)
}
