//! Measurements of other programs on the seed column, and errors that they pin in tests of their own; `peers.csv` and
//! `peer_series.csv` say what was measured and how.

use crate::case::{Quantity, Sample};
use crate::judge::comparison::work_precision::TimedRun;
use crate::judge::paths::{first_error, grouped};
use crate::measure::statistics::largest;
use oedometer_convergence::{Classification, Context, ErrorSeries, Undefined, classify, pair_orders};
use oedometer_exact::ReferenceKind;
use oedometer_soil::wording::words;
use std::sync::LazyLock;

/// Time factors of the comparison.
pub const TIME_FACTORS: [f64; 3] = [0.05, 0.2, 1.0];

/// Where a number that stands beside ours comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// A closed form or a series with a bound on its error.
    Exact,
    /// A numerical solution that was refined until it no longer changed.
    ConvergedReference,
    /// The output of another program, as we ran it.
    OtherProgram,
    /// A published figure.
    ReadOffAFigure,
}

words!(
    Evidence:
    Exact "exact", ConvergedReference "converged reference", OtherProgram "other program",
    ReadOffAFigure "read off a figure",
);

/// Another program.
#[derive(Clone, Debug, PartialEq)]
pub struct Peer {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: String,
    /// Cells over the height, where they are known.
    pub cells: Option<usize>,
    /// Where its errors were sampled.
    pub samples: String,
    /// How it steps through time.
    pub time_scheme: String,
    /// Errors at the time factors, where they were measured.
    pub errors: [Option<f64>; 3],
    /// CPU seconds, where the run ended.
    pub seconds: Option<f64>,
    /// Wall seconds, where they were taken.
    pub wall_seconds: Option<f64>,
    /// Where its numbers come from.
    pub evidence: Evidence,
}

impl Peer {
    /// The worst of its errors, where it has all of them.
    pub fn worst_error(&self) -> Option<f64> {
        largest(self.errors.into_iter().collect::<Option<Vec<f64>>>()?)
    }
}

/// Every program that was measured.
pub static PEERS: LazyLock<Vec<Peer>> =
    LazyLock::new(|| read(include_str!("peers.csv")).expect("a test reads the table of the sources"));

fn read(text: &str) -> Result<Vec<Peer>, csv::Error> {
    type Number = Option<f64>;
    type Columns =
        (String, String, Option<usize>, String, String, Number, Number, Number, Number, Number, Evidence);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let peer = |columns: Result<Columns, csv::Error>| {
        let (name, kind, cells, samples, time_scheme, early, middle, late, seconds, wall_seconds, evidence) =
            columns?;
        let errors = [early, middle, late];
        Ok(Peer { name, kind, cells, samples, time_scheme, errors, seconds, wall_seconds, evidence })
    };
    reader.deserialize().map(peer).collect()
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
        pair_orders(&ErrorSeries::of(&self.levels))
    }

    /// The class of the series, for elements of second order.
    pub fn classified(&self) -> Classification {
        classify(&ErrorSeries::of(&self.levels), &Context { formal_order: Some(2.0), ..Context::default() })
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
    let reference = ReferenceKind::TerzaghiIncompressible.name();
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
        let mut pairs = peer.errors.iter().zip(errors);
        pairs.all(|(theirs, own)| theirs.is_none_or(|theirs| own.is_some_and(|own| own <= theirs)))
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
    use crate::judge::comparison::work_precision::WorkPrecision;
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
        assert_eq!(PEERS.len(), 12);
        let errors = |name: &str| PEERS.iter().find(|peer| peer.name == name).expect("a peer").errors;
        assert_eq!(errors("GeoTaichi"), [Some(0.065), None, None]);
        assert!(
            PEERS.iter().all(|peer| peer.errors.iter().flatten().all(|error| (0.0..1.0).contains(error)))
        );
        let broken = read("# a note\na,b,c,d,e,f,g,h,i,j,k\nx,y,10,,,many,,,,,exact\n")
            .expect_err("no number")
            .to_string();
        assert!(broken.contains("line: 3"), "{broken}");
        // No number without a label.
        assert!(read("a,b,c,d,e,f,g,h,i,j,k\nx,y,10,,,0.1,,,,,guessed\n").is_err());
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
        let precision = WorkPrecision::of(&column, "terzaghi").expect("timed runs");
        assert!(solve_their_column(&precision.runs));
        let ahead: Vec<_> = compare(&precision.runs)
            .into_iter()
            .filter_map(|comparison| comparison.ahead.map(|(_, errors)| (comparison.peer, errors)))
            .collect();
        assert!(ahead.iter().any(|(peer, _)| peer.name == "OpenSees quadUP"), "{ahead:?}");
        for (peer, errors) in ahead {
            assert!(peer.errors.iter().zip(errors).all(|(theirs, own)| match (theirs, own) {
                (Some(theirs), Some(own)) => own <= *theirs,
                (theirs, _) => theirs.is_none(),
            }));
        }
        // Large strain has no error against Terzaghi's solution, so nothing to hold theirs against.
        let squeezed = runs_of("xie-leo", "[column]\nload = 1e5");
        let precision = WorkPrecision::of(&squeezed, "large-strain").expect("timed runs");
        assert!(!solve_their_column(&precision.runs));
    }
}
