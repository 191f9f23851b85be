//! What is measured of a run, by runs of small studies.

use crate::campaign::runner::records_of;
use crate::case::Case;
use crate::measure::other_measures::SPURIOUS_VELOCITY;
use crate::measure::theory::{known_reference, theory_isochrones};
use crate::record::Record;
use crate::record::csv::tidy;
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_exact::reference::ReferenceKind;

#[test]
fn a_peak_and_what_moves_at_rest_are_rows_of_the_table() {
    for (scene, more, name, exact) in [
        ("mandel", "output = { time_factors = [0.0645, 0.068, 0.0717] }", "peak_pressure", 0.546_059_661_7),
        ("at-rest", "output = { time_factors = [1e-4] }", SPURIOUS_VELOCITY, 0.0),
    ] {
        let study = format!(
            "title = \"t\"\nscene = \"{scene}\"\n{more}\n[[sweep]]\nmethod = [\"GIMP-SRI\"]\n\
             integrator = [\"implicit\"]\ncells = [10]\ntime_step = [{{ growth = 0.02 }}]\n"
        );
        let record = records_of(&study).remove(0);
        let row = record.measures.iter().find(|row| row.name == name).expect("the measure");
        assert!((row.exact - exact).abs() < 1e-10 && row.error().abs() < 5e-3, "{row:?}");
        let table = tidy::rows_of("t", &record).expect("rows");
        let told = table.lines().filter(|line| line.contains(&format!(",{name},,"))).count();
        assert_eq!(told, 1, "{table}");
    }
}

fn seed_case() -> Case {
    let text = "title = 'x'\nscene = 'terzaghi'\n[[sweep]]\nmethod = ['GIMP-SRI']\ncells = [10]\n".to_owned();
    let study = Study::check(&StudySource { name: "x.toml".to_owned(), text }).expect("a sound study");
    study.planned[0].case.clone()
}

#[test]
fn a_theory_line_begins_at_the_drained_surface_and_falls_with_time() {
    let case = Case { time_factors: vec![0.05, 0.5].into(), ..seed_case() };
    let lines = theory_isochrones(&case, ReferenceKind::Terzaghi).expect("the seed column");
    let [early, late] = [0, 1].map(|place| &lines[place].line);
    assert!(lines[0].degree < lines[1].degree && lines[0].time_factor == 0.05);
    assert_eq!(early[0], (0.0, 0.0));
    assert!((early[100].0 - 1.0).abs() < 0.01 && (early[100].1 - 1.0).abs() < 1e-15);
    assert!(late[100].0 < early[100].0);
}

#[test]
fn the_degree_of_consolidation_of_a_run_is_that_of_its_solution() {
    let clay = "[material]\nhydraulic_conductivity = 1e-6\nreload_modulus = 1.2e7\npreconsolidation = 0.5\n";
    let soils = "column.soils = [{ thickness = 0.5 }, { thickness = 0.5, hydraulic_conductivity = 1e-5 }]\n";
    for (scene, more, time_factor) in [
        ("yield-front", clay, 0.002),
        ("layered", soils, 0.5),
        ("sealed-element", "material.water_bulk_modulus = 1e6\n", 0.1),
    ] {
        let record = records_of(&format!(
            "title = \"t\"\nscene = \"{scene}\"\noutput.time_factors = [{time_factor}]\n{more}[[sweep]]\nmethod = \
             [\"GIMP-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [40]\ntime_step = [{{ growth = 0.02 }}]\n"
        ))
        .remove(0);
        let own = known_reference(
            &record.case,
            record.references[0].name.parse().expect("its name"),
            &[time_factor],
        );
        let exact = own.and_then(|own| own.degree_of_consolidation(time_factor)).expect("a degree");
        let found = record.history.last().expect("an end").degree_of_consolidation;
        assert!((found / exact - 1.0).abs() < 0.02, "{scene}: {found} for {exact}");
    }
}

#[test]
fn the_last_digits_of_a_soil_that_yields_decide_neither_its_errors_nor_its_work() {
    let records = records_of(
        "title = \"t\"\nscene = \"yield-front\"\noutput.time_factors = [2e-4]\n[[sweep]]\nmethod = [\"GIMP-SRI\"]\n\
         integrator = [\"implicit\"]\nreload_modulus = [1.2e7, 12000000.000000002, 12000000.000000013]\ncells = [120]\n\
         time_step = [{ growth = 0.02 }]\n",
    );
    for counters in records.iter().map(|record| &record.counters) {
        // A tangent whose perturbation passes the yield limit asks for a dozen iterations a step, and for halved steps.
        assert!(counters.rejected_steps == 0 && counters.iterations < 5 * counters.steps, "{counters:?}");
    }
    let values = |record: &Record| record.errors.iter().map(|row| row.value).collect::<Vec<_>>();
    let first = values(&records[0]);
    assert_eq!(records.len(), 3);
    for other in records[1..].iter().map(values) {
        for (value, other) in first.iter().zip(&other) {
            assert!((value / other - 1.0).abs() < 1e-9, "{value} and {other}");
        }
    }
}

#[test]
fn the_energy_of_a_wave_is_that_of_its_fields_goes_to_and_fro_and_is_not_made() {
    for choice in
        ["integrator = [\"explicit\"]\ntime_step = [{ courant = 0.25 }]", "integrator = [\"implicit\"]"]
    {
        let record = records_of(&format!(
            "title = \"t\"\nscene = \"standing-wave\"\noutput.time_factors = [3e-5]\n[[sweep]]\nmethod = [\"GC-SRI-patch\"]\n\
             cells = [20]\n{choice}\n"
        ))
        .remove(0);
        let energies: Vec<_> = record.history.iter().map(|row| row.energy.expect("an energy")).collect();
        assert_eq!(energies.len(), 96, "{choice}");
        let (soil, points) = (&record.case.material, &record.snapshots[0].points);
        let of_point = |point: usize| {
            let (stress, pressure) = (points.effective_stress[point], points.pressure[point]);
            let skeleton = stress * stress / soil.oedometric_modulus();
            let water = soil.porosity * pressure * pressure / soil.water_bulk_modulus;
            0.5 * points.volume[point] * (skeleton + water)
        };
        let at_end: f64 = (0..points.volume.len()).map(of_point).sum();
        assert!(
            (energies[95].strain / at_end - 1.0).abs() < 1e-6,
            "{choice}: {:?} for {at_end}",
            energies[95]
        );
        let sums: Vec<f64> = energies.iter().map(|energy| energy.kinetic + energy.strain).collect();
        assert!(sums.iter().all(|sum| *sum <= 1.02 * sums[0]), "{choice}: {sums:?}");
        let shares = energies.iter().zip(&sums).map(|(energy, sum)| energy.kinetic / sum);
        let [least, most] =
            shares.fold([1.0_f64, 0.0_f64], |[low, high], share| [low.min(share), high.max(share)]);
        assert!(least < 0.02 && most > 0.9, "{choice}: {least} to {most}");
    }
}
