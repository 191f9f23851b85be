//! The race's findings from hand-made situations with known answers.

use super::*;
use crate::campaign::runner::solved;
use crate::case::contender::CONTENDERS;
use crate::race::finish::{Level, Reason};
use crate::race::situation::Entry;
use crate::record::WallSample;
use crate::record::race_errors::RunErrors;

/// A situation in which the methods of a list need as many seconds for 1 % on their second mesh; no other runs.
fn situation(name: &str, arrivals: &[(&str, Option<f64>)]) -> Situation {
    let family = name.split('-').next().expect("a word");
    let entry = |contender: &str| {
        let cost = arrivals.iter().find(|(known, _)| *known == contender).map(|(_, cost)| *cost);
        let level = |(cells, share, error): (usize, f64, f64), cost: Option<f64>| Level {
            cells,
            step: "growth=0.03".to_owned(),
            cost: share * cost.unwrap_or(9.0),
            errors: RunErrors {
                at: [vec![[Some(error), Some(error), None]; 3], vec![[Some(0.5 * error), None, None]; 3]],
                is_whole: true,
            },
            ..Level::default()
        };
        let meshes = |cost: Option<f64>| {
            let fine = if cost.is_some() { 0.01 } else { 0.05 };
            [(4, 0.1, 0.2), (8, 1.0, fine), (16, 10.0, 0.4 * fine)].map(|mesh| level(mesh, cost)).to_vec()
        };
        Entry { contender: contender.to_owned(), levels: cost.map_or(Vec::new(), meshes), ..Entry::default() }
    };
    Situation {
        family: family.to_owned(),
        name: name.to_owned(),
        title: format!("the {name}"),
        study: format!("race-{name}"),
        moves: family == "strain",
        integrator: "implicit".to_owned(),
        outputs: ["0.05", "0.2", "1"].map(str::to_owned).to_vec(),
        meshes: vec![4, 8, 16],
        entries: CONTENDERS.iter().map(|one| entry(one.name)).collect(),
        ..Situation::default()
    }
}

fn findings() -> RaceFindings {
    RaceFindings::from_situations(vec![
        situation("column-a", &[("GIMP", Some(1.0)), ("MPM", Some(3.0))]),
        situation("column-b", &[("GIMP", Some(1.0)), ("MPM", None)]),
        situation("waves", &[("GIMP", Some(4.0)), ("MPM", Some(1.0))]),
        situation("strain", &[("GIMP", None), ("MPM", Some(1.0)), ("TL-GC-SRI-patch", Some(1.0))]),
    ])
}

#[test]
fn each_group_has_the_answer_of_its_own_methods_in_its_own_situations() {
    let findings = findings();
    let told: Vec<(&str, &str, &str, usize, usize)> = findings
        .answers
        .iter()
        .map(|one| (one.group.name(), one.read_out.name(), one.method.as_str(), one.reached, one.of))
        .collect();
    // At rest, families alike: GIMP reaches all and is near twice; MPM reaches ½ · ½ + ½. Read at the centres the error is half as
    // large: on 16 cells, beyond the budget, no more than on 8.
    let wanted = [
        ("moving", "points", "MPM", 1, 1),
        ("moving", "centres", "MPM", 1, 1),
        ("rest", "points", "GIMP", 3, 3),
        ("rest", "centres", "GIMP", 3, 3),
        ("total", "points", "TL-GC-SRI-patch", 1, 1),
        ("total", "centres", "TL-GC-SRI-patch", 1, 1),
    ];
    assert_eq!(told, wanted);
    let rest = findings.best(Group::Rest, ReadOut::Points).expect("somebody arrives");
    assert_eq!((rest.share, rest.within_two, rest.interval), (1.0, 0.5, [1.0, 1.0]));
    // On the coarsest mesh no method reaches the tolerance; at 0.5 % on the finest alone.
    assert!(rest.holds.time && rest.holds.read_out && !rest.holds.budget && !rest.holds.tolerance);
    assert!(!rest.holds.everywhere());
    let mpm = &answer::answers(&findings.situations[..2], Group::Rest, ReadOut::Points)[0];
    assert_eq!((mpm.method.as_str(), mpm.alike.len()), ("GIMP", 0));
    let gimp = findings.profiles(Group::Moving, ReadOut::Points, RaceQuantity::All);
    assert_eq!(
        gimp.iter().find(|one| one.method == "GIMP").map(|one| one.steps.last().map(|step| step.1)),
        Some(Some(0.0))
    );
    // Nobody runs the second step of the ladder: what reached the tolerance without it is lost.
    let reached = |step: usize, group: Group| findings.reached(LADDER[step].0, group, ReadOut::Points);
    assert_eq!([0, 1].map(|step| reached(step, Group::Moving)), [Some(0); 2]);
    assert_eq!([0, 1].map(|step| reached(step, Group::Rest)), [Some(3), Some(0)]);
    assert_eq!([0, 3].map(|step| reached(step, Group::Total)), [None, Some(1)]);
    let of_locked = &findings.situations[1];
    let mpm =
        of_locked.entry("MPM").and_then(|entry| of_locked.reason(entry, &Terms::usual(ReadOut::Points)));
    assert!(matches!(mpm, Some(Reason::Budget(order)) if (order - 2.5_f64.log2()).abs() < 1e-12), "{mpm:?}");
}

#[test]
fn findings_do_not_depend_on_the_order_of_studies() {
    let mut situations = findings().situations;
    situations.reverse();
    assert_eq!(RaceFindings::from_situations(situations), findings());
    assert!(RaceFindings::from_studies([]).is_none());
}

/// Costs are counted work times a committed calibration: a slower machine comes to the same findings, but for the seconds that
/// it measured.
#[test]
fn findings_are_the_same_on_any_machine() {
    let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['race']\n\
                integrator = ['implicit']\ncells = [4, 8]\ntime_step = [{ growth = 0.1 }]\n";
    let (study, records) = solved("race-column", text);
    let on = |factor: f64, processor: &str| {
        let mut records = records.clone();
        for record in &mut records {
            let sample = |seconds: f64| WallSample {
                seconds: factor * seconds,
                cpu_seconds: Some(0.9 * factor * seconds),
                ..WallSample::default()
            };
            record.wall = [1e-3, 2e-3, 4e-3].map(sample).to_vec();
            record.provenance.target = processor.to_owned();
        }
        let mut findings = RaceFindings::from_studies([(&study, records.as_slice())]).expect("a race");
        let levels =
            findings.situations.iter_mut().flat_map(|one| &mut one.entries).flat_map(|one| &mut one.levels);
        let seconds: Vec<f64> = levels.filter_map(|level| level.seconds.take()).collect();
        (seconds[0], findings)
    };
    let [(quick, ours), (slow, theirs)] = [on(1.0, "x86_64"), on(7.3, "aarch64")];
    assert!((slow / quick - 7.3).abs() < 1e-9, "{quick} {slow}");
    assert!(ours == theirs, "costs or choices follow the clock");
}
