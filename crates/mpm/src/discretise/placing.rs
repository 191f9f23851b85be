//! The points of an arrangement at their places: the regular lattice, shifted, jittered or alternating.

use crate::state::points::Points;
pub use oedometer_problem::arrangement::Arrangement;

/// The points of `extent` cells of a size, m, at their places.
pub fn place_points<const D: usize>(
    arrangement: &Arrangement,
    cell_size: f64,
    extent: [usize; D],
    per_cell: usize,
) -> Points<D> {
    let mut points = if arrangement.alternating {
        alternating(cell_size, extent, per_cell)
    } else {
        Points::lattice(cell_size, extent, per_cell)
    };
    arrange(arrangement, &mut points, cell_size, extent[D - 1]);
    points
}

/// Moves the points of a full lattice of `cells` cells to their places; what a shift would take out of the body
/// stays on its edge.
fn arrange<const D: usize>(arrangement: &Arrangement, points: &mut Points<D>, cell_size: f64, cells: usize) {
    if arrangement.is_lattice() {
        return;
    }
    let top_cell = (cells - 1) as f64 * cell_size;
    let surface = top_cell + arrangement.filling * cell_size;
    for point in 0..points.len() {
        let up = D - 1;
        let mut height = points.initial_position[point][up];
        if height > top_cell {
            height = top_cell + arrangement.filling * (height - top_cell);
            points.half_length[point][up] *= arrangement.filling;
            points.initial_volume[point] *= arrangement.filling;
        }
        let spacing = 2.0 * points.half_length[point][up];
        let row = row_of(points.initial_position[point][up], spacing);
        height += spacing * (arrangement.offset + arrangement.jitter * scatter(row));
        height = height.clamp(0.0, surface);
        points.initial_position[point][up] = height;
        points.position[point][up] = height;
    }
}

/// Cells that have `per_cell` points and one more, in turn: those of a lattice of the larger number, of which every other
/// cell drops one.
fn alternating<const D: usize>(cell_size: f64, extent: [usize; D], per_cell: usize) -> Points<D> {
    let more = per_cell + 1;
    let full = Points::lattice(cell_size, extent, more);
    let kept: Vec<usize> =
        (0..full.len()).filter(|point| point / more % 2 == 1 || point % more < per_cell).collect();
    let mut points = full.select(&kept);
    for (point, of_full) in
        kept.into_iter().enumerate().filter(|(_, of_full)| (of_full / more).is_multiple_of(2))
    {
        let (cell, number) = ((of_full / more) as f64, (of_full % more) as f64);
        let place = [(cell + (number + 0.5) / per_cell as f64) * cell_size; D];
        points.initial_position[point] = place;
        points.position[point] = place;
        points.half_length[point] = [0.5 * cell_size / per_cell as f64; D];
        points.initial_volume[point] = cell_size / per_cell as f64;
    }
    points
}

/// Row of a point of the full lattice: a number that every point of the row shares.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a height above the base")]
fn row_of(height: f64, spacing: f64) -> u64 {
    (height / spacing) as u64
}

/// A number between −1 and 1 for a row, without pattern (splitmix64; Steele, Lea & Flood 2014).
fn scatter(row: u64) -> f64 {
    let mut bits = row.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arranged(arrangement: Arrangement, cells: usize, per_cell: usize) -> (f64, Points<1>) {
        let cell_size = arrangement.cell_size(1.0, cells);
        (cell_size, place_points(&arrangement, cell_size, [cells], per_cell))
    }

    #[test]
    fn a_partly_filled_top_cell_keeps_the_height_and_the_volume() {
        let (cell_size, points) = arranged(Arrangement { filling: 0.1, ..Arrangement::default() }, 5, 2);
        assert!((cell_size - 1.0 / 4.1).abs() < 1e-15);
        assert!((points.initial_volume.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        let top = points.len() - 1;
        assert!((points.position[top][0] + points.half_length[top][0] - 1.0).abs() < 1e-14);
        let bottoms: Vec<f64> = (0..10).map(|i| points.position[i][0] - points.half_length[i][0]).collect();
        let tops: Vec<f64> = (0..10).map(|i| points.position[i][0] + points.half_length[i][0]).collect();
        for i in 1..10 {
            assert!((bottoms[i] - tops[i - 1]).abs() < 1e-14, "domains tile the column");
        }
    }

    #[test]
    fn every_second_cell_has_one_point_more_and_domains_tile_the_column() {
        let arrangement = Arrangement { alternating: true, ..Arrangement::default() };
        let (cell_size, points) = arranged(arrangement, 5, 2);
        assert_eq!(points.len(), arrangement.points_up(5, 2));
        let in_cell = |cell: u32| {
            let cell = f64::from(cell) * cell_size..f64::from(cell + 1) * cell_size;
            points.position.iter().filter(|place| cell.contains(&place[0])).count()
        };
        assert_eq!((0..5).map(in_cell).collect::<Vec<_>>(), [2, 3, 2, 3, 2]);
        let mut base = 0.0;
        for (point, (place, half)) in points.position.iter().zip(&points.half_length).enumerate() {
            assert!((place[0] - half[0] - base).abs() < 1e-15);
            assert!((points.initial_volume[point] - 2.0 * half[0]).abs() < 1e-15);
            base = place[0] + half[0];
        }
        assert!((base - 1.0).abs() < 1e-15);
    }

    #[test]
    fn points_shifted_down_by_half_a_spacing_lie_on_the_faces() {
        let (cell_size, points) = arranged(Arrangement { offset: -0.5, ..Arrangement::default() }, 4, 2);
        for (i, place) in points.position.iter().enumerate() {
            assert!((place[0] - 0.5 * i as f64 * cell_size).abs() < 1e-15);
        }
    }

    #[test]
    fn jitter_scatters_within_its_bounds_and_is_always_the_same() {
        let jitter = Arrangement { jitter: 0.3, ..Arrangement::default() };
        let (cell_size, points) = arranged(jitter, 50, 2);
        let (_, regular) = arranged(Arrangement::default(), 50, 2);
        let shifts: Vec<f64> = (0..points.len())
            .map(|i| (points.position[i][0] - regular.position[i][0]) / (0.5 * cell_size))
            .collect();
        assert!(shifts.iter().all(|shift| shift.abs() <= 0.3));
        let mean = shifts.iter().sum::<f64>() / shifts.len() as f64;
        let spread = shifts.iter().map(|shift| shift * shift).sum::<f64>() / shifts.len() as f64;
        assert!(mean.abs() < 0.05 && (0.02..0.04).contains(&spread), "{mean} {spread}: uniform has 0.03");
        assert_eq!(points, arranged(jitter, 50, 2).1);
    }

    #[test]
    fn points_shifted_out_of_the_body_stay_on_its_edge() {
        for (offset, jitter) in [(0.5, 0.5), (-0.5, 0.5), (0.3, 0.3)] {
            let (_, points) = arranged(Arrangement { offset, jitter, ..Arrangement::default() }, 30, 2);
            let heights: Vec<f64> = points.position.iter().map(|place| place[0]).collect();
            assert!(heights.iter().all(|height| (0.0..=1.0 + 1e-15).contains(height)), "{offset} {jitter}");
            assert!(heights.is_sorted(), "rows keep their order");
        }
    }
}
