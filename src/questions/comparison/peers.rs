//! Measurements of other programs on the seed column, by `examples/adapters/run.py`, and errors that they pin in tests of their
//! own, in `peer_series.csv`.

use crate::case::{Quantity, Sample};
use crate::judge::paths::{first_error, grouped};
use crate::questions::comparison::work_precision::TimedRun;
use oedometer_convergence::{Classification, Context, ErrorSeries, Undefined, classify, pair_orders};
use oedometer_exact::ReferenceKind;
use serde::Deserialize;
use std::sync::LazyLock;

/// Time factors of the comparison.
pub const TIME_FACTORS: [f64; 3] = [0.05, 0.2, 1.0];

/// Another program on a mesh, as `examples/adapters/run.py` measured it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Peer {
    /// Its name and version.
    #[serde(rename = "program")]
    pub name: String,
    /// What it is.
    #[serde(rename = "what it is")]
    pub kind: String,
    /// Cells over the height.
    pub cells: usize,
    /// Where its errors were sampled.
    pub samples: String,
    /// How it steps through time.
    #[serde(rename = "time scheme")]
    pub time_scheme: String,
    #[serde(rename = "error at T_v=0.05")]
    early: f64,
    #[serde(rename = "error at T_v=0.2")]
    middle: f64,
    #[serde(rename = "error at T_v=1")]
    late: f64,
    /// The smaller of the processor time of the whole run and the wall time that the program reports for its solution, s.
    pub seconds: f64,
    /// Day of the measurement.
    #[serde(rename = "measured on")]
    pub day: String,
}

impl Peer {
    /// Errors at the time factors.
    pub fn errors(&self) -> [f64; 3] {
        [self.early, self.middle, self.late]
    }

    /// The worst of its errors.
    pub fn worst_error(&self) -> f64 {
        self.errors().into_iter().fold(0.0, f64::max)
    }
}

/// Every program that was measured.
pub static PEERS: LazyLock<Vec<Peer>> = LazyLock::new(|| {
    let text = include_str!("../../../examples/adapters/results.csv");
    read(text).expect("a test reads the table of the sources")
});

/// The programs with their meshes, each time scheme by itself; a program that has several is named with each.
pub fn by_program_and_scheme() -> Vec<(String, Vec<&'static Peer>)> {
    let groups = grouped(PEERS.iter(), |peer| (peer.name.as_str(), peer.time_scheme.as_str()));
    let schemes = |program: &str| groups.iter().filter(|((name, _), _)| *name == program).count();
    let named = |(program, scheme): (&str, &str)| {
        let scheme = scheme.split(',').next().and_then(|scheme| scheme.split(" with").next());
        match scheme.filter(|_| schemes(program) > 1) {
            Some(scheme) => format!("{program}, {scheme}"),
            None => program.to_owned(),
        }
    };
    groups.iter().map(|(key, peers)| (named(*key), peers.clone())).collect()
}

fn read(text: &str) -> Result<Vec<Peer>, csv::Error> {
    csv::Reader::from_reader(text.as_bytes()).deserialize().collect()
}

/// The errors of a convergence test of another program, from coarse to fine.
#[derive(Clone, Debug)]
pub struct PeerSeries {
    /// The program and its test.
    pub name: String,
    /// What the errors are of.
    pub quantity: String,
    /// Cell sizes, m, and errors.
    pub levels: Vec<(f64, f64)>,
}

impl PeerSeries {
    /// The order between neighbours.
    pub fn orders(&self) -> Vec<Result<f64, Undefined>> {
        pair_orders(&ErrorSeries::from_pairs(&self.levels))
    }

    /// The class of the series, for elements of second order.
    pub fn classified(&self) -> Classification {
        classify(
            &ErrorSeries::from_pairs(&self.levels),
            &Context { formal_order: Some(2.0), ..Context::default() },
        )
    }
}

/// Every convergence test whose errors are known.
pub static PEER_SERIES: LazyLock<Vec<PeerSeries>> = LazyLock::new(|| {
    read_series(include_str!("peer_series.csv")).expect("a test reads the table of the sources")
});

fn read_series(text: &str) -> Result<Vec<PeerSeries>, csv::Error> {
    type Row = (String, String, String, f64, f64);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let rows: Result<Vec<Row>, _> = reader.deserialize().collect();
    let series = |((name, quantity), rows): ((String, String), Vec<Row>)| PeerSeries {
        name,
        quantity,
        levels: rows.iter().map(|row| (row.3, row.4)).collect(),
    };
    let groups = grouped(rows?, |row| (format!("{}: {}", row.0, row.1), row.2.clone()));
    Ok(groups.into_iter().map(series).collect())
}

/// Errors of a run at the places and times of the peers' errors, where it has them.
pub fn comparable_errors(run: &TimedRun<'_>) -> [Option<f64>; 3] {
    let reference = ReferenceKind::Terzaghi.name();
    TIME_FACTORS.map(|factor| first_error(run.record, Quantity::Pressure, Sample::Points, reference, factor))
}

/// Whether some of the runs have errors that can be compared with the peers'.
pub fn solve_their_column(runs: &[TimedRun<'_>]) -> bool {
    runs.iter().any(|run| comparable_errors(run).iter().any(Option::is_some))
}

/// A peer and the fastest run that is nowhere worse.
#[derive(Clone, Debug)]
pub struct Comparison<'a, 'b> {
    /// The peer.
    pub peer: &'static Peer,
    /// The run and its errors; `None` where every run is somewhere worse.
    pub ahead: Option<(&'b TimedRun<'a>, [Option<f64>; 3])>,
}

/// Each peer with the first of the runs, the cheapest first, that is nowhere worse.
pub fn compare<'a, 'b>(runs: &'b [TimedRun<'a>]) -> Vec<Comparison<'a, 'b>> {
    let is_nowhere_worse = |peer: &Peer, errors: &[Option<f64>; 3]| {
        peer.errors().iter().zip(errors).all(|(theirs, own)| own.is_some_and(|own| own <= *theirs))
    };
    let ahead_of = |peer: &Peer| {
        let mut all = runs.iter().map(|run| (run, comparable_errors(run)));
        all.find(|(_, errors)| is_nowhere_worse(peer, errors))
    };
    PEERS.iter().map(|peer| Comparison { peer, ahead: ahead_of(peer) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::measure::statistics::spread;
    use crate::questions::comparison::work_precision::WorkPrecision;
    use crate::record::{Record, WallSample};
    use oedometer_convergence::Class;

    /// Runs of a scene on two meshes, with a cost that is the same on every machine.
    fn runs_of(scene: &str, table: &str) -> Vec<Record> {
        let text = format!(
            "title = \"Peers\"\nscene = \"{scene}\"\n{table}\n[output]\ntime_factors = [0.05, 0.2, 1.0]\n\
             [[sweep]]\nmethod = [\"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [8, 16]\n\
             time_step = [{{ growth = 0.02 }}]\n"
        );
        let mut records = records_of(&text);
        for record in &mut records {
            let seconds = 1e-9 * record.counters.point_updates as f64;
            record.wall = vec![WallSample { seconds, alone: true, ..WallSample::default() }; 2];
        }
        records
    }

    #[test]
    fn the_table_is_read_and_a_broken_one_is_refused_with_its_line() {
        let kratos = PEERS.iter().find(|peer| peer.name.starts_with("Kratos") && peer.cells == 10);
        let ogs = PEERS.iter().find(|peer| peer.name.starts_with("OpenGeoSys") && peer.cells == 10);
        let (kratos, ogs) = (kratos.expect("Kratos"), ogs.expect("OpenGeoSys"));
        assert_eq!(kratos.errors(), ogs.errors(), "the same elements in the same steps");
        let is_one = |error: &f64| (0.0..1.0).contains(error);
        assert!(PEERS.iter().all(|peer| peer.errors().iter().all(is_one) && peer.seconds > 0.0));
        let text = include_str!("../../../examples/adapters/results.csv");
        let broken = read(&text.replacen(",10,", ",many,", 1)).expect_err("no number").to_string();
        assert!(broken.contains("line: 2"), "{broken}");
    }

    #[test]
    fn the_errors_that_kratos_pins_are_no_settled_order_of_the_pressure() {
        let [displacement, pressure] = PEER_SERIES.as_slice() else { panic!("{PEER_SERIES:?}") };
        let orders: Vec<f64> = pressure.orders().into_iter().map(|order| order.expect("an order")).collect();
        // The orders by hand: log2 of the ratios of neighbours.
        for (order, by_hand) in orders.iter().zip([2.483, 1.753, 0.912]) {
            assert!((order - by_hand).abs() < 1e-3, "{orders:?}");
        }
        assert_ne!(pressure.classified().class, Class::Asymptotic);
        assert_eq!(displacement.levels.len(), 4);
    }

    #[test]
    fn peers_stand_beside_their_own_column_only() {
        let column = runs_of("terzaghi", "");
        let precision = WorkPrecision::of(&column, "terzaghi", &[]).expect("timed runs");
        assert!(solve_their_column(&precision.runs));
        let ahead: Vec<_> = compare(&precision.runs)
            .into_iter()
            .filter_map(|comparison| comparison.ahead.map(|(_, errors)| (comparison.peer, errors)))
            .collect();
        assert!(ahead.iter().any(|(peer, _)| peer.name.starts_with("Kratos Poromechanics")), "{ahead:?}");
        for (peer, errors) in ahead {
            assert!(
                peer.errors()
                    .into_iter()
                    .zip(errors)
                    .all(|(theirs, own)| own.is_some_and(|own| own <= theirs))
            );
        }
        // Large strain has no error against Terzaghi's solution, so nothing to hold theirs against.
        let squeezed = runs_of("xie-leo", "[column]\nload = 1e5");
        let precision = WorkPrecision::of(&squeezed, "large-strain", &[]).expect("timed runs");
        assert!(!solve_their_column(&precision.runs));
    }

    #[test]
    fn a_run_is_ahead_where_it_has_the_error_at_every_time_and_none_is_larger() {
        let record = runs_of("terzaghi", "").remove(0);
        let with = |errors: [Option<f64>; 3]| {
            let mut run = record.clone();
            run.errors.retain_mut(|row| {
                let is_asked = (row.quantity, row.sample, row.reference.as_str())
                    == (Quantity::Pressure, Sample::Points, "terzaghi");
                let place = TIME_FACTORS.iter().position(|time| *time == row.time_factor);
                let given = errors[place.expect("an output")];
                row.value = given.filter(|_| is_asked).unwrap_or(row.value);
                !is_asked || given.is_some()
            });
            run
        };
        let wall = spread(&[1.0, 1.0]).expect("two samples");
        let is_ahead = |errors: [Option<f64>; 3]| {
            let run = with(errors);
            let runs = [TimedRun { record: &run, error: 0.0, wall }];
            compare(&runs)[0].ahead.is_some()
        };
        let theirs = PEERS[0].errors();
        let equal = theirs.map(Some);
        assert!(is_ahead(equal), "as good is nowhere worse");
        assert!(!is_ahead([None; 3]), "a run without errors");
        for place in 0..3 {
            for (own, ahead) in [
                (Some(0.5 * theirs[place]), true),
                (Some(1.001 * theirs[place]), false),
                (Some(f64::NAN), false),
                (None, false),
            ] {
                let mut errors = equal;
                errors[place] = own;
                assert_eq!(is_ahead(errors), ahead, "{own:?} at {place}");
            }
        }
        // The first that is nowhere worse, with its own errors.
        let [worse, better] = [2.0, 0.5].map(|factor| theirs.map(|error| Some(factor * error)));
        let runs = [worse, better, equal].map(with);
        let timed = |record| TimedRun { record, error: 0.0, wall };
        let runs: Vec<TimedRun<'_>> = runs.iter().map(timed).collect();
        let first = compare(&runs)[0].ahead.expect("two are");
        assert!(std::ptr::eq(first.0, &raw const runs[1]) && first.1 == better, "{:?}", first.1);
    }

    #[test]
    fn every_column_of_a_table_of_peers_is_the_field_of_its_name() {
        let head = include_str!("../../../examples/adapters/results.csv").lines().next().expect("a head");
        let line = "a program,what,20,nodes,steps,0.3,0.5,0.2,1.9,+0.1,4.5,2026-01-02";
        let [peer] = &read(&format!("{head}\n{line}\n")).expect("a table")[..] else { panic!("one peer") };
        assert_eq!(
            (peer.errors(), peer.worst_error(), peer.cells, peer.seconds),
            ([0.3, 0.5, 0.2], 0.5, 20, 4.5)
        );
        let words = [&peer.name, &peer.kind, &peer.samples, &peer.time_scheme, &peer.day];
        assert_eq!(words, ["a program", "what", "nodes", "steps", "2026-01-02"]);
        // Series of errors, from lines in any order of their quantities.
        let text = "# a note\nprogram,test,quantity,cell size,error\np,t,u,0.2,4.0\np,t,v,0.4,8.0\np,t,u,0.1,1.0\nq,t,u,0.2,4.0\n";
        let series = read_series(text).expect("a table");
        let told: Vec<_> =
            series.iter().map(|one| (&*one.name, &*one.quantity, one.levels.clone())).collect();
        let first = vec![(0.2, 4.0), (0.1, 1.0)];
        assert_eq!(
            told,
            [("p: t", "u", first), ("p: t", "v", vec![(0.4, 8.0)]), ("q: t", "u", vec![(0.2, 4.0)])]
        );
        assert_eq!(series[0].orders(), [Ok(2.0)]);
    }
}
