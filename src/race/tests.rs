//! The race's findings from hand-made situations with known answers.

use super::*;
use crate::campaign::runner::solved;
use crate::case::contender::CONTENDERS;
use crate::race::finish::{Level, reason_of};
use crate::race::situation::{OtherCosts, THRESHOLDS};
use crate::record::WallSample;

/// A situation in which the contenders of a list need as many seconds for 1 % on their second mesh; nobody else runs.
fn situation(family: &str, name: &str, arrivals: &[(&str, Option<f64>)]) -> Situation {
    let entry = |contender: &str| {
        let cost = arrivals.iter().find(|(known, _)| *known == contender).map(|(_, cost)| *cost);
        let levels: Vec<Level> = cost.map_or(Vec::new(), |cost| {
            let (seconds, error) = cost.map_or((9.0, 0.05), |cost| (cost, 0.01));
            let level = |cells, cost, error: f64| Level {
                cells,
                cost,
                seconds: None,
                errors: [Some(error), Some(error), None],
            };
            vec![level(4, 0.1 * seconds, 0.2), level(8, seconds, error)]
        });
        let costs = THRESHOLDS.map(|threshold| finish::cost_to(&levels, RaceQuantity::All, threshold));
        Entry {
            contender: contender.to_owned(),
            costs,
            reason: costs[1].is_none().then(|| reason_of(&levels, None, None)),
            errors: levels.last().map_or([None; 3], |level| level.errors),
            cost: levels.last().map(|level| level.cost),
            levels,
            ..Entry::default()
        }
    };
    Situation {
        family: family.to_owned(),
        name: name.to_owned(),
        title: name.to_owned(),
        study: format!("race-{name}"),
        moves: family == "strain",
        integrator: if family == "waves" { "explicit" } else { "implicit" }.to_owned(),
        is_property: false,
        budget: 8,
        common_cells: 8,
        entries: CONTENDERS.iter().map(|one| entry(one.name)).collect(),
    }
}

fn findings() -> RaceFindings {
    RaceFindings::from_situations(vec![
        situation(
            "column",
            "column-a",
            &[("GIMP", Some(1.0)), ("MPM", Some(3.0)), ("TL-GC-SRI-patch", Some(0.1))],
        ),
        situation("column", "column-b", &[("GIMP", Some(1.0)), ("MPM", None)]),
        situation("waves", "waves", &[("GIMP", Some(4.0)), ("MPM", Some(1.0))]),
        situation("strain", "strain", &[("GIMP", None), ("MPM", Some(1.0)), ("TL-GC-SRI-patch", Some(1.0))]),
    ])
}

#[test]
fn each_question_has_the_answer_of_its_own_contenders() {
    let findings = findings();
    let moving = findings.answer(Question::Moving).expect("somebody arrives");
    // MPM: (½ + 1 + 1)/3 reached and 2/3 within twice the best; GIMP: 2/3 and 1/3.
    assert_eq!((moving.method.as_str(), moving.integrator.as_str()), ("MPM", "implicit"));
    assert!((moving.reached - 2.5 / 3.0).abs() < 1e-12 && (moving.within_two - 2.0 / 3.0).abs() < 1e-12);
    assert_eq!((moving.situations, moving.families, moving.moving), (4, 3, 1));
    assert_eq!(moving.contenders, CONTENDERS.iter().filter(|one| !one.is_total()).count());
    assert_eq!(moving.missed, [Missed { situation: "column-b".to_owned(), reason: Reason::Budget }]);
    let families: Vec<&str> =
        moving.by_family.iter().map(|one| one.choice.as_ref().map_or("", |choice| &choice.method)).collect();
    assert_eq!(families, ["GIMP", "MPM", "MPM"]);
    // Without the large strain GIMP would be better.
    let turns: Vec<bool> = moving.variants[..3].iter().map(|one| one.holds).collect();
    assert_eq!(turns, [true, false, true]);
    let total = findings.answer(Question::Total).expect("somebody arrives");
    assert_eq!((total.method.as_str(), total.missed.len()), ("TL-GC-SRI-patch", 2));
    // Its own contenders alone: that it is ten times as fast as GIMP does not touch GIMP's profile.
    let gimp = |quantity| {
        let profiles = findings.profiles(Question::Moving, quantity);
        profiles.iter().find(|one| one.contender == "GIMP").map(|one| one.share(1.0))
    };
    assert_eq!(gimp(RaceQuantity::All), Some(1.0 / 3.0));
    assert_eq!(gimp(RaceQuantity::Settlement), Some(0.0), "no settlement was measured");
    assert_eq!(findings.profiles.len(), 8);
    assert_eq!(findings.families().iter().map(|one| one.1.len()).collect::<Vec<_>>(), [2, 1, 1]);
}

#[test]
fn findings_do_not_depend_on_the_order_of_studies() {
    let mut situations = findings().situations;
    situations.reverse();
    assert_eq!(RaceFindings::from_situations(situations), findings());
}

#[test]
fn findings_are_plain_data() {
    let text = serde_json::to_string(&findings()).expect("plain data");
    let back: RaceFindings = serde_json::from_str(&text).expect("the same");
    assert_eq!(back, findings());
    assert!(text.contains("\"question\":\"moving\"") && text.contains("\"within_two\""), "{text}");
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
        let findings = RaceFindings::from_studies([(&study, records.as_slice())]).expect("a race");
        let seconds = findings.situations[0].entries[0].levels[0].seconds.expect("measured");
        (seconds, without_seconds(&findings))
    };
    let [(quick, ours), (slow, theirs)] = [on(1.0, "x86_64"), on(7.3, "aarch64")];
    assert!((slow / quick - 7.3).abs() < 1e-9, "{quick} {slow}");
    assert!(ours == theirs, "costs or choices follow the clock");
}

fn without_seconds(findings: &RaceFindings) -> RaceFindings {
    let mut findings = findings.clone();
    for situation in findings.situations.iter_mut().chain(&mut findings.properties) {
        for entry in &mut situation.entries {
            entry.seconds = None;
            entry.levels.iter_mut().for_each(|level| level.seconds = None);
        }
    }
    findings
}

/// Nobody runs the other steps of the ladder: a contender without a mesh neither wins nor loses a situation.
#[test]
fn an_operator_without_runs_changes_nothing() {
    for trade in findings().trades {
        assert_eq!((trade.situations, trade.cost_ratio), (0, None), "{}", trade.operator);
        assert!(trade.effects.iter().all(|effect| (effect.won, effect.lost) == (0, 0)), "{}", trade.operator);
    }
}

#[test]
fn other_ends_are_of_a_quantity_alone_or_of_all_at_another_threshold() {
    let level = |cells: usize, cost: f64, errors: [f64; 3]| Level {
        cells,
        cost,
        seconds: None,
        errors: errors.map(Some),
    };
    // The pressure arrives on the first mesh, stress and settlement on the second.
    let levels = vec![level(4, 1.0, [1e-3, 0.5, 0.1]), level(8, 10.0, [1e-4, 1e-3, 1e-3])];
    let costs = OtherCosts::new(&Entry { levels, ..Entry::default() });
    let is_late = |cost: &Option<f64>| cost.is_some_and(|cost| cost > 1.0 && cost < 10.0);
    assert_eq!(costs.alone[0], Some(1.0));
    assert!(costs.alone[1..].iter().chain(&costs.thresholds).all(is_late), "{costs:?}");
    // A smaller threshold costs more.
    let [half, two, three] = costs.thresholds;
    assert!(half > two && two > three, "{costs:?}");
}
