//! The cheapest method within a tolerance, and the methods that fail, over conductivity and stiffness.

use crate::case::work_estimate::seconds_per_step;
use crate::judge::comparison::work_precision::worst_error;
use crate::record::{Record, Status};
use std::collections::{BTreeMap, BTreeSet};

/// Error of the pore pressure at the points that is asked for.
pub const TOLERANCE: f64 = 1e-2;

/// A soil of the map, by the bits of its two numbers, which have the order of positive numbers.
type SoilKey = (u64, u64);

/// One soil of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct MappedSoil {
    /// Hydraulic conductivity, m/s.
    pub conductivity: f64,
    /// Young's modulus of the skeleton, Pa.
    pub stiffness: f64,
    /// Methods and integrators that were tried, each once.
    pub tried: Vec<String>,
    /// The fastest way of each that comes within the tolerance; the cheapest of all first.
    pub ways: Vec<Way>,
    /// Methods and integrators of which some case failed, each once.
    pub broken: Vec<String>,
}

impl MappedSoil {
    /// The method and integrator that come within the tolerance for the least time, where any do.
    pub fn cheapest(&self) -> Option<&Way> {
        self.ways.first()
    }

    /// The way of a method and integrator to the tolerance.
    pub fn way_of(&self, name: &str) -> Option<&Way> {
        self.ways.iter().find(|way| way.name == name)
    }
}

/// How a tolerance is reached.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Method and integrator.
    pub name: String,
    /// Cells over the height.
    pub cells: usize,
    /// Seconds on one core, from the number of steps and the cost of one: equal on any machine.
    pub seconds: f64,
    /// Its error.
    pub error: f64,
}

/// Method and integrator of a record.
fn name_of(record: &Record) -> String {
    format!("{} {}", record.case.method, record.case.integrator.name())
}

/// The soils of records, by conductivity and stiffness; empty unless both vary.
pub fn mapped_soils(records: &[Record], reference: &str) -> Vec<MappedSoil> {
    let mut soils: BTreeMap<SoilKey, Vec<&Record>> = BTreeMap::new();
    for record in records {
        let soil = &record.case.material;
        let key = (soil.hydraulic_conductivity.to_bits(), soil.youngs_modulus.to_bits());
        soils.entry(key).or_default().push(record);
    }
    let varies = |part: fn(&SoilKey) -> u64| soils.keys().map(part).collect::<BTreeSet<_>>().len() > 1;
    if !(varies(|key| key.0) && varies(|key| key.1)) {
        return Vec::new();
    }
    soils
        .into_iter()
        .map(|((conductivity, stiffness), records)| MappedSoil {
            conductivity: f64::from_bits(conductivity),
            stiffness: f64::from_bits(stiffness),
            tried: names_of(records.iter().copied()),
            ways: ways(&records, reference),
            broken: names_of(records.iter().copied().filter(|record| record.status != Status::Ok)),
        })
        .collect()
}

/// The cheapest way of every method and integrator to the tolerance, the cheapest of all first; of two with equal cost
/// the more accurate one.
fn ways(records: &[&Record], reference: &str) -> Vec<Way> {
    let way = |record: &&Record| {
        let error = worst_error(record, reference).filter(|error| *error <= TOLERANCE)?;
        let seconds = record.counters.steps as f64 * seconds_per_step(&record.case);
        Some(Way { name: name_of(record), cells: record.case.cells, seconds, error })
    };
    let sound = records.iter().filter(|record| record.status == Status::Ok);
    let mut ways: Vec<Way> = sound.filter_map(way).collect();
    ways.sort_by(|a, b| {
        a.seconds.total_cmp(&b.seconds).then(a.error.total_cmp(&b.error)).then_with(|| a.name.cmp(&b.name))
    });
    let mut seen = BTreeSet::new();
    ways.retain(|way| seen.insert(way.name.clone()));
    ways
}

/// Methods and integrators of records, each once.
fn names_of<'a>(records: impl Iterator<Item = &'a Record>) -> Vec<String> {
    let names: BTreeSet<String> = records.map(name_of).collect();
    names.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

    const STUDY: &str = "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = [\"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [3, 10, 20]\ntime_step = [{ growth = 0.02 }]\n\
        hydraulic_conductivity = [1e-5, 1e-3]\nyoungs_modulus = [1e6, 1e7]\n";

    #[test]
    fn the_cheapest_within_the_tolerance_is_found_on_every_soil_and_what_failed_is_named() {
        let mut records = records_of(STUDY);
        let soils = mapped_soils(&records, "terzaghi");
        assert_eq!(soils.len(), 4);
        for soil in &soils {
            let way = soil.cheapest().expect("ten cells are enough");
            // Three cells are cheaper and not within a percent; twenty are, and cost more.
            assert_eq!((way.cells, way.name.as_str()), (10, "GC-SRI-patch implicit"), "{way:?}");
            assert!(way.error <= TOLERANCE && soil.broken.is_empty());
        }
        for record in records.iter_mut().filter(|record| record.case.material.youngs_modulus == 1e7) {
            let reason = "a test".to_owned();
            let kind = FailureKind::Unstable;
            record.status = Status::Failed(Failure { kind, step: 1, time: 1.0, growth: None, reason });
        }
        let soils = mapped_soils(&records, "terzaghi");
        let broken: Vec<bool> = soils.iter().map(|soil| soil.cheapest().is_none()).collect();
        assert_eq!(broken, [false, true, false, true]);
        assert_eq!(soils[1].broken, ["GC-SRI-patch implicit"]);
        assert!(mapped_soils(&records[..1], "terzaghi").is_empty(), "one soil is no map");
    }
}
