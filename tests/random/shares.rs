//! Explicit runs below and above the critical step: a share of 0.95 runs to its end, one of 1.1 does not, or says that it has
//! too few steps to show it. Where points deform they are shares of the step that `stability` observes, for methods with points
//! that cross cells fail below the predicted one.

use crate::laws::Violation;
use crate::numbers::Numbers;
use crate::options::Options;
use crate::solved::{End, Solved};
use oedometer::{Kernel, Method, Task, run_case};

/// Steps of a run, about.
const STEPS: f64 = 3000.0;
/// The same of points that deform: `stability` looks at no fewer.
const STEPS_DEFORMING: f64 = 5e4;

/// The case of an index.
pub fn drawn(seed: u64, index: u64) -> Options {
    let numbers = &mut Numbers::of(seed.wrapping_add(11), index);
    let methods = Method::names();
    let mut options = Options {
        scene: numbers.one_of(&[
            "terzaghi",
            "terzaghi",
            "single-mode",
            "dynamic-column",
            "standing-wave",
            "layered",
            "xie-leo",
            "xie-leo",
            "cosine-layer",
            "mandel",
        ]),
        method: methods[numbers.count(0, methods.len() - 1)].clone(),
        integrator: "explicit",
        cells: numbers.count(2, 12),
        points_per_cell: numbers.count(1, 4),
        ..Options::default()
    };
    let is_plane = matches!(options.scene, "cosine-layer" | "mandel");
    if is_plane {
        options.cells = numbers.count(2, 5);
    }
    if options.scene == "mandel" {
        options.set_number("column.width", 1.0 / options.cells as f64);
    }
    let conductivity = options.set_rounded("material.hydraulic_conductivity", numbers.decades(-5.0, -3.0));
    let water = options.set_rounded("material.water_bulk_modulus", numbers.decades(7.3, 9.3));
    options.set("integrator.drag", numbers.one_of(&["explicit", "implicit"]));
    if options.scene == "xie-leo" {
        let strain = options.set_rounded("column.strain", numbers.decades(-4.0, -0.35));
        options.set_rounded("material.porosity", strain + numbers.between(0.15, 0.4));
    }
    // Waves in the water of the seed column cross a metre in half a millisecond, and T_v = 1 is at 81.75 s.
    let step = 5e-4 * (2.2e9 / water).sqrt() / options.cells as f64;
    let steps = if options.scene == "xie-leo" { STEPS_DEFORMING } else { STEPS };
    let last = steps * step / 81.75 * conductivity / 1e-4;
    options.time_factors = vec![format!("{last:.3e}").parse().expect("a number")];
    options
}

/// The largest share of the predicted step under which `stability` sees a run end; none where it has no such case, or sees no
/// limit.
fn observed_share(options: &Options) -> Option<f64> {
    let study = options.study().ok()?;
    let mut case = study.planned[0].case.clone();
    case.task = Task::Stability;
    let record = run_case(&case, &study.references, Kernel::Fastest, false, &|_, _| true).ok()?;
    let found = record.stability?;
    found.known()?;
    Some(found.observed? / found.predicted)
}

/// What both shares come to.
pub fn held(options: &Options) -> (String, Vec<Violation>) {
    let at = |share: f64| Solved::of(&Options { time_step: Some(("stable", share)), ..options.clone() }).end;
    let share = if options.scene == "xie-leo" {
        if !matches!(at(0.5), End::Sound | End::Warned(_) | End::Failed(_)) {
            return ("not applicable".to_owned(), Vec::new());
        }
        match observed_share(options) {
            Some(share) => share,
            None => return ("nothing observed".to_owned(), Vec::new()),
        }
    } else {
        1.0
    };
    let (below, above) = (at(0.95 * share), at(1.1 * share));
    let mut violations = Vec::new();
    let kind = match (&below, &above) {
        (End::Refused(_) | End::TooLong | End::Impossible(_), _) => "not applicable",
        (End::Failed(why), _) if why.contains("no limit is known") => "no limit",
        (End::Failed(why), _) => {
            violations.push(Violation::of(
                "shares",
                format!("{:.3} of the critical step ends: {why}", 0.95 * share),
            ));
            "failed below"
        }
        (_, End::Failed(_)) if share < 0.95 => "fails above, before the predicted step",
        (_, End::Failed(_)) => "fails above",
        (_, End::Warned(_)) => "warned above",
        (_, end) => {
            let share = 1.1 * share;
            violations
                .push(Violation::of("shares", format!("{share:.3} of the critical step ends: {end:?}")));
            "runs above"
        }
    };
    (kind.to_owned(), violations)
}
