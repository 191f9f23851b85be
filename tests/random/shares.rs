//! Explicit runs below and above the critical step: a share of 0.95 runs to its end, one of 1.1 does not, or says that it has
//! too few steps to show it. Where points deform, what `stability` says is held: the share that runs, and 1.1 of the step that it
//! observes where that agrees with the predicted one; where points cross cells it need not, and it says so.

use crate::laws::Violation;
use crate::numbers::Numbers;
use crate::options::Options;
use crate::solved::{End, Solved};
use oedometer::{Kernel, Method, Task, run_case};

/// Steps of a run, about.
const STEPS: f64 = 3000.0;
/// The same of points that deform: `stability` looks at no fewer.
const STEPS_DEFORMING: f64 = 5e4;
/// Points of a column for which so many steps are short enough, and estimated seconds of the longest.
const FEW_POINTS: usize = 12;
const LONGEST: f64 = 1.0;

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
        options.points_per_cell = options.points_per_cell.min(FEW_POINTS / options.cells);
        let strain = options.set_rounded("column.strain", numbers.decades(-4.0, -0.35));
        options.set_rounded("material.porosity", strain + numbers.between(0.15, 0.4));
    }
    // Waves in the water of the seed column cross a metre in half a millisecond, and T_v = 1 is at 81.75 s.
    let step = 5e-4 * (2.2e9 / water).sqrt() / options.cells as f64;
    let steps = if options.scene == "xie-leo" { STEPS_DEFORMING } else { STEPS };
    let last = steps * step / 81.75 * conductivity / 1e-4;
    options.time_factors = vec![format!("{last:.3e}").parse().expect("a number")];
    // Rigid plates hold no splines.
    if options.scene == "mandel" && options.study().is_err() {
        options.scene = "cosine-layer";
        options.settings.retain(|(key, _)| key != "column.width");
    }
    options
}

/// Shares of the predicted step: one that `stability` says runs, and one that it says fails, where it says so; none where it has
/// no such case, or sees no limit.
fn observed_shares(options: &Options) -> Option<[Option<f64>; 2]> {
    let study = options.study().ok()?;
    let mut case = study.planned[0].case.clone();
    case.task = Task::Stability;
    let record = run_case(&case, &study.references, Kernel::Fastest, false, &|_, _| true).ok()?;
    let found = record.stability?;
    found.known()?;
    let share = found.observed? / found.predicted;
    let is_sharp = (0.98..=1.02).contains(&share) && found.probes_agree();
    Some([found.reliable_share, is_sharp.then_some(1.1 * share)])
}

/// What both shares come to.
pub fn held(options: &Options) -> (String, Vec<Violation>) {
    let at = |share: f64| {
        let options = Options { time_step: Some(("stable", share)), ..options.clone() };
        Solved::within(&options, Kernel::Fastest, LONGEST).end
    };
    let kind = |end: &End| match end {
        End::Refused(why) | End::Impossible(why) => {
            format!("not applicable, {}: {}", end.kind(), why.lines().next().unwrap_or_default())
        }
        _ => format!("not applicable, {}", end.kind()),
    };
    let mut shares = [Some(0.95), Some(1.1)];
    if options.scene == "xie-leo" {
        let half = at(0.5);
        if !matches!(half, End::Sound | End::Warned(_) | End::Failed(_)) {
            return (kind(&half), Vec::new());
        }
        match observed_shares(options) {
            Some(observed) => shares = observed,
            None => return ("nothing observed".to_owned(), Vec::new()),
        }
    }
    let [below, above] = shares.map(|share| share.map(at));
    let told = |share: Option<f64>, end: &End| {
        Violation::of(
            "shares",
            format!("{:.3} of the critical step ends: {end:?}", share.unwrap_or_default()),
        )
    };
    match (below, above) {
        (Some(end @ (End::Refused(_) | End::TooLong | End::Impossible(_))), _) => (kind(&end), Vec::new()),
        (Some(End::Failed(why)), _) if why.contains("no limit is known") => {
            ("no limit".to_owned(), Vec::new())
        }
        (Some(end @ End::Failed(_)), _) => ("failed below".to_owned(), vec![told(shares[0], &end)]),
        (_, None) => ("runs below, said to be no limit".to_owned(), Vec::new()),
        (_, Some(End::Failed(_))) => ("fails above".to_owned(), Vec::new()),
        (_, Some(End::Warned(_))) => ("warned above".to_owned(), Vec::new()),
        (_, Some(end)) => ("runs above".to_owned(), vec![told(shares[1], &end)]),
    }
}
