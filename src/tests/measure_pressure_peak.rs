//! The peak of the pressure.

use crate::campaign::runner::records_of;
use crate::measure::other_measures::{pressure_at_the_end, pressure_peak};
use crate::record::Record;

#[test]
fn the_middle_is_found_from_two_rows_of_an_even_field() {
    let even = |height: f64| 3.0 - 2.0 * height * height;
    let heights = [0.15, 0.05, 0.05, 0.25, 0.15];
    let pressures = heights.map(even);
    assert!((pressure_at_the_end(&heights, &pressures) - 3.0).abs() < 1e-14);
}

#[test]
fn a_peak_lies_between_outputs_and_none_at_their_ends() {
    let study = "title = \"t\"\nscene = \"mandel\"\noutput = { time_factors = [0.05, 0.06, 0.07] }\n[[sweep]]\n\
                 method = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\ncells = [10]\n";
    let mut record = records_of(study).remove(0);
    let set = |record: &mut Record, heights: [f64; 3]| {
        for (snapshot, height) in record.snapshots.iter_mut().zip(heights) {
            snapshot.centres.pressure.fill(height);
        }
    };
    // A parabola in ln T_v about 0.062.
    let of = |time: f64| 0.55 - 0.3 * (time / 0.062_f64).ln().powi(2);
    set(&mut record, [0.05, 0.06, 0.07].map(of));
    let peak = pressure_peak(&record.case, &record.snapshots).expect("a peak");
    assert!((peak.time_factor - 0.062).abs() < 1e-12 && (peak.height - 0.55).abs() < 1e-12, "{peak:?}");
    for monotone in [[0.1, 0.2, 0.3], [0.3, 0.2, 0.1], [0.2; 3]] {
        set(&mut record, monotone);
        assert_eq!(pressure_peak(&record.case, &record.snapshots), None);
    }
}
