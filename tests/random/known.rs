//! Violations that are known and not mended: each with where it is written down. Empty is right.

use crate::laws::Violation;
use crate::options::Options;

/// A known violation: where it is written down, and which cases are meant.
type Known = (&'static str, fn(&Options, &Violation) -> bool);

const KNOWN: [Known; 8] = [
    ("points that fill their cells in part have another volume on a line", |options, violation| {
        options.value("points.filling").is_some() && violation.said.starts_with("Dimensions: the volume")
    }),
    (
        "attack S12, the settlement curve of a layer between outputs, frozen and moving",
        |options, violation| {
            options.scene == "cosine-layer"
                && violation.said.starts_with("TotalAndFrozen: the settlement curve")
        },
    ),
    ("Newton's tolerance below round-off of stiff water in the plane", |options, violation| {
        options.integrator == "implicit"
            && violation.said.starts_with("Dimensions: the second ends Failed(\"not-converged")
    }),
    ("attack S2, own weight with points off their lattice", |options, _| {
        options.value("column.self_weight").is_some() && off_lattice(options)
    }),
    ("attack S9, points off their lattice", |options, _| {
        options.integrator != "implicit" && off_lattice(options)
    }),
    ("attack L1, heights whose points lie outside by round-off", |_, violation| {
        violation.rule == "false refusal"
    }),
    ("waves that semi-implicit steps damp", |options, violation| {
        violation.rule == "error" && options.integrator == "semi-implicit" && has_waves(options)
    }),
    ("a formulation that leaves out what its reference has", |options, violation| {
        violation.rule == "error"
            && options.value("integrator.formulation") == Some("u-p")
            && has_waves(options)
    }),
];

fn off_lattice(options: &Options) -> bool {
    ["points.jitter", "points.offset", "points.filling"].iter().any(|key| options.value(key).is_some())
}

fn has_waves(options: &Options) -> bool {
    matches!(options.scene, "dynamic-column" | "dynamic-single-mode" | "standing-wave")
}

/// Where a violation is written down, if it is known.
pub fn line_of(options: &Options, violation: &Violation) -> Option<&'static str> {
    KNOWN.iter().find(|(_, is_meant)| is_meant(options, violation)).map(|(line, _)| *line)
}
