//! Cells of VTK by their types: dimension, corners, centre, volume.
//!
//! Types and the order of their points: `vtkCellType.h`, and "VTK File Formats", docs.vtk.org. Cells of higher order,
//! Lagrange's and Bézier's of any, begin with their corners; sides are taken as straight.

/// Most points of a cell without fixed faces whose volume is found.
const MOST_OF_HULL: usize = 24;

/// A place.
type Place = [f64; 3];

/// Which points of a cell are its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Corners {
    /// So many, which come first.
    First(usize),
    /// The first half: each side has a point at its middle.
    Half,
    /// All of its points.
    All,
}

/// The body that the corners of a cell make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Points, without a volume.
    Points,
    /// A line from corner to corner.
    Line,
    /// A polygon around its corners.
    Ring,
    /// Triangles of each corner with the two before it.
    Strip,
    /// A ring of so many corners, and the same again above it.
    Prism(usize),
    /// Two pixels, one above the other.
    Stacked,
    /// A ring of so many corners, and an apex.
    Cone(usize),
    /// The convex hull of the corners.
    Hull,
}

/// A type of cells.
#[derive(Clone, Copy, Debug)]
struct CellType {
    /// Its number in VTK.
    number: u8,
    /// Its name in VTK, in words.
    name: &'static str,
    /// Its dimension.
    dimension: usize,
    corners: Corners,
    shape: Shape,
}

const fn of(number: u8, name: &'static str, dimension: usize, corners: Corners, shape: Shape) -> CellType {
    CellType { number, name, dimension, corners, shape }
}

use Corners::{All, First, Half};
use Shape::{Cone, Hull, Line, Points, Prism, Ring, Stacked, Strip};

/// All types of `vtkCellType.h`, by number.
const TYPES: [CellType; 64] = [
    of(0, "empty cell", 0, All, Points),
    of(1, "vertex", 0, All, Points),
    of(2, "poly-vertex", 0, All, Points),
    of(3, "line", 1, First(2), Line),
    of(4, "poly-line", 1, All, Line),
    of(5, "triangle", 2, First(3), Ring),
    of(6, "triangle strip", 2, All, Strip),
    of(7, "polygon", 2, All, Ring),
    of(8, "pixel", 2, First(4), Strip),
    of(9, "quad", 2, First(4), Ring),
    of(10, "tetrahedron", 3, First(4), Cone(3)),
    of(11, "voxel", 3, First(8), Stacked),
    of(12, "hexahedron", 3, First(8), Prism(4)),
    of(13, "wedge", 3, First(6), Prism(3)),
    of(14, "pyramid", 3, First(5), Cone(4)),
    of(15, "pentagonal prism", 3, First(10), Prism(5)),
    of(16, "hexagonal prism", 3, First(12), Prism(6)),
    of(21, "quadratic edge", 1, First(2), Line),
    of(22, "quadratic triangle", 2, First(3), Ring),
    of(23, "quadratic quad", 2, First(4), Ring),
    of(24, "quadratic tetrahedron", 3, First(4), Cone(3)),
    of(25, "quadratic hexahedron", 3, First(8), Prism(4)),
    of(26, "quadratic wedge", 3, First(6), Prism(3)),
    of(27, "quadratic pyramid", 3, First(5), Cone(4)),
    of(28, "biquadratic quad", 2, First(4), Ring),
    of(29, "triquadratic hexahedron", 3, First(8), Prism(4)),
    of(30, "quadratic linear quad", 2, First(4), Ring),
    of(31, "quadratic linear wedge", 3, First(6), Prism(3)),
    of(32, "biquadratic quadratic wedge", 3, First(6), Prism(3)),
    of(33, "biquadratic quadratic hexahedron", 3, First(8), Prism(4)),
    of(34, "biquadratic triangle", 2, First(3), Ring),
    of(35, "cubic line", 1, First(2), Line),
    of(36, "quadratic polygon", 2, Half, Ring),
    of(37, "triquadratic pyramid", 3, First(5), Cone(4)),
    of(41, "convex point set", 3, All, Hull),
    of(42, "polyhedron", 3, All, Hull),
    of(51, "parametric curve", 1, All, Line),
    of(52, "parametric surface", 2, All, Ring),
    of(53, "parametric triangular surface", 2, First(3), Ring),
    of(54, "parametric quad surface", 2, First(4), Ring),
    of(55, "parametric tetrahedral region", 3, First(4), Cone(3)),
    of(56, "parametric hexahedral region", 3, First(8), Prism(4)),
    of(60, "higher-order edge", 1, First(2), Line),
    of(61, "higher-order triangle", 2, First(3), Ring),
    of(62, "higher-order quad", 2, First(4), Ring),
    of(63, "higher-order polygon", 2, All, Ring),
    of(64, "higher-order tetrahedron", 3, First(4), Cone(3)),
    of(65, "higher-order wedge", 3, First(6), Prism(3)),
    of(66, "higher-order pyramid", 3, First(5), Cone(4)),
    of(67, "higher-order hexahedron", 3, First(8), Prism(4)),
    of(68, "Lagrange curve", 1, First(2), Line),
    of(69, "Lagrange triangle", 2, First(3), Ring),
    of(70, "Lagrange quad", 2, First(4), Ring),
    of(71, "Lagrange tetrahedron", 3, First(4), Cone(3)),
    of(72, "Lagrange hexahedron", 3, First(8), Prism(4)),
    of(73, "Lagrange wedge", 3, First(6), Prism(3)),
    of(74, "Lagrange pyramid", 3, First(5), Cone(4)),
    of(75, "Bézier curve", 1, First(2), Line),
    of(76, "Bézier triangle", 2, First(3), Ring),
    of(77, "Bézier quad", 2, First(4), Ring),
    of(78, "Bézier tetrahedron", 3, First(4), Cone(3)),
    of(79, "Bézier hexahedron", 3, First(8), Prism(4)),
    of(80, "Bézier wedge", 3, First(6), Prism(3)),
    of(81, "Bézier pyramid", 3, First(5), Cone(4)),
];
/// Types whose inner points are control points, at which a field has other values than those written there.
const BEZIER: std::ops::RangeInclusive<u8> = 75..=81;

/// The type of a number.
fn type_of(number: u8) -> Option<&'static CellType> {
    TYPES.binary_search_by_key(&number, |known| known.number).ok().map(|place| &TYPES[place])
}

/// Cells as lists of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// Type of each cell, as VTK numbers them.
    pub types: Vec<u8>,
    /// End of each cell in `connectivity`.
    pub ends: Vec<usize>,
    /// Points of the cells, one cell after the other, corners first.
    pub connectivity: Vec<u32>,
}

impl Cells {
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Points of a cell.
    pub fn points(&self, cell: usize) -> &[u32] {
        let start = if cell == 0 { 0 } else { self.ends[cell - 1] };
        &self.connectivity[start..self.ends[cell]]
    }

    fn type_of(&self, cell: usize) -> Option<&'static CellType> {
        self.types.get(cell).and_then(|number| type_of(*number))
    }

    /// Corners of a cell: its first points, without those at the middle of sides and inside.
    pub fn corners(&self, cell: usize) -> &[u32] {
        let points = self.points(cell);
        let corners = match self.type_of(cell).map(|known| known.corners) {
            Some(First(corners)) => corners.min(points.len()),
            Some(Half) => points.len() / 2,
            Some(All) | None => points.len(),
        };
        &points[..corners]
    }

    /// Dimension of a cell.
    pub fn dimension_of(&self, cell: usize) -> usize {
        self.type_of(cell).map_or(0, |known| known.dimension)
    }

    /// Highest dimension of the cells.
    pub fn dimension(&self) -> usize {
        self.types
            .iter()
            .filter_map(|number| type_of(*number))
            .map(|known| known.dimension)
            .max()
            .unwrap_or(0)
    }

    /// The cells of the highest dimension: edges and faces beside them are their borders.
    fn bodies(&self) -> impl Iterator<Item = usize> {
        let highest = self.dimension();
        (0..self.count()).filter(move |cell| self.dimension_of(*cell) == highest)
    }

    /// For each of a number of points, whether it is a corner of a cell of the highest dimension.
    pub fn are_corners(&self, points: usize) -> Vec<bool> {
        self.marked(points, |cell| self.corners(cell))
    }

    /// For each of a number of points, whether a cell of the highest dimension has it with the value of its fields: the
    /// inner points of a Bézier cell are control points.
    pub fn have_values(&self, points: usize) -> Vec<bool> {
        let is_bezier = |cell: usize| self.types.get(cell).is_some_and(|number| BEZIER.contains(number));
        self.marked(points, |cell| if is_bezier(cell) { self.corners(cell) } else { self.points(cell) })
    }

    fn marked<'a>(&'a self, points: usize, of_cell: impl Fn(usize) -> &'a [u32]) -> Vec<bool> {
        let mut are_marked = vec![false; points];
        for point in self.bodies().flat_map(of_cell) {
            if let Some(is_marked) = are_marked.get_mut(*point as usize) {
                *is_marked = true;
            }
        }
        are_marked
    }

    /// The centre of a cell, the mean of its corners; NaN if it has none.
    pub fn centre(&self, cell: usize, places: &[Place]) -> Place {
        mean(&self.places_of(cell, places))
    }

    /// The length, area or volume of a cell; NaN where it has neither, or more corners than are looked at.
    pub fn volume(&self, cell: usize, places: &[Place]) -> f64 {
        let Some(known) = self.type_of(cell) else { return f64::NAN };
        let corners = self.places_of(cell, places);
        match known.shape {
            Points => f64::NAN,
            Line => corners.windows(2).map(|pair| norm(minus(pair[1], pair[0]))).sum(),
            Ring => area(&corners),
            Strip => corners.windows(3).map(area).sum(),
            Prism(sides) => prism(&corners, sides),
            Stacked => {
                let swapped = [0, 1, 3, 2, 4, 5, 7, 6].map(|at| corners.get(at).copied());
                prism(&swapped.into_iter().flatten().collect::<Vec<Place>>(), 4)
            }
            Cone(sides) => {
                let side = |at: usize| vec![at, (at + 1) % sides, sides];
                enclosed(&corners, std::iter::once((0..sides).collect()).chain((0..sides).map(side)))
            }
            Hull => hull(&corners),
        }
    }

    fn places_of(&self, cell: usize, places: &[Place]) -> Vec<Place> {
        self.corners(cell).iter().filter_map(|point| places.get(*point as usize).copied()).collect()
    }

    /// Keeps the cells that a test holds of.
    pub(crate) fn keep(&mut self, is_kept: &[bool]) {
        let mut kept = Self::default();
        for cell in (0..self.count()).filter(|cell| is_kept.get(*cell).copied().unwrap_or(true)) {
            kept.connectivity.extend(self.points(cell));
            kept.ends.push(kept.connectivity.len());
            kept.types.extend(self.types.get(cell));
        }
        *self = kept;
    }

    /// Appends cells whose points are counted from another one on.
    pub(crate) fn append(&mut self, others: &Self, shift: u32) {
        let end = self.connectivity.len();
        self.types.extend(&others.types);
        self.ends.extend(others.ends.iter().map(|other| end + other));
        self.connectivity.extend(others.connectivity.iter().map(|point| point.saturating_add(shift)));
    }

    /// Checks that the lists fit each other and a number of points.
    pub(crate) fn check(&self, points: usize) -> Result<(), String> {
        if self.types.len() != self.ends.len() {
            return Err(format!("there are {} cells and types for {}", self.ends.len(), self.types.len()));
        }
        if self.ends.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err("the offsets of the cells decrease".to_owned());
        }
        let end = self.ends.last().copied().unwrap_or(0);
        if end != self.connectivity.len() {
            return Err(format!(
                "the cells have {} points, and their offsets end at {end}",
                self.connectivity.len()
            ));
        }
        if let Some(point) = self.connectivity.iter().find(|point| **point as usize >= points) {
            return Err(format!("a cell names the point {point} of {points}"));
        }
        for cell in 0..self.count() {
            let (number, there) = (self.types[cell], self.points(cell).len());
            let known = type_of(number)
                .ok_or_else(|| format!("the cell {cell} has the type {number}, which VTK does not have"))?;
            if let First(corners) = known.corners
                && there < corners
            {
                return Err(format!("the cell {cell}, a {}, has {there} points", known.name));
            }
        }
        Ok(())
    }
}

fn minus(a: Place, b: Place) -> Place {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Place, b: Place) -> Place {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: Place) -> f64 {
    dot(a, a).sqrt()
}

fn mean(places: &[Place]) -> Place {
    let sum = |axis: usize| places.iter().map(|place| place[axis]).sum::<f64>();
    [0, 1, 2].map(|axis| sum(axis) / places.len() as f64)
}

/// Area of a polygon by its corners: half the sum of the cross products of its edges about one of them.
fn area(ring: &[Place]) -> f64 {
    let Some(first) = ring.first() else { return 0.0 };
    let mut sum = [0.0; 3];
    for pair in ring.windows(2) {
        let part = cross(minus(pair[0], *first), minus(pair[1], *first));
        sum = [0, 1, 2].map(|axis| sum[axis] + part[axis]);
    }
    0.5 * norm(sum)
}

/// Volume between faces by their corners: tetrahedra of the centre of the body, that of a face, and an edge of the face.
fn enclosed(corners: &[Place], faces: impl Iterator<Item = Vec<usize>>) -> f64 {
    let centre = mean(corners);
    let mut sum = 0.0;
    for face in faces {
        let ring: Vec<Place> = face.iter().filter_map(|at| corners.get(*at).copied()).collect();
        let top = minus(mean(&ring), centre);
        for (at, place) in ring.iter().enumerate() {
            let next = ring[(at + 1) % ring.len()];
            sum += dot(top, cross(minus(*place, centre), minus(next, centre))).abs() / 6.0;
        }
    }
    sum
}

/// Volume of a ring of corners with another one above it.
fn prism(corners: &[Place], sides: usize) -> f64 {
    let ring = |from: usize| (from..from + sides).collect::<Vec<usize>>();
    let side = |at: usize| {
        let next = (at + 1) % sides;
        vec![at, next, sides + next, sides + at]
    };
    enclosed(corners, [ring(0), ring(sides)].into_iter().chain((0..sides).map(side)))
}

/// Volume of the convex hull of points: its faces are the planes through three of them with none beyond.
fn hull(points: &[Place]) -> f64 {
    if points.len() < 4 || points.len() > MOST_OF_HULL {
        return f64::NAN;
    }
    let centre = mean(points);
    let extent = points.iter().map(|point| norm(minus(*point, centre))).fold(0.0, f64::max);
    let near = 1e-9 * extent;
    let mut planes: Vec<Place> = Vec::new();
    let mut sum = 0.0;
    for (a, b, c) in triples(points.len()) {
        let [a, b, c] = [a, b, c].map(|at| points[at]);
        let across = cross(minus(b, a), minus(c, a));
        let length = norm(across);
        if length.partial_cmp(&(near * extent)) != Some(std::cmp::Ordering::Greater) {
            continue;
        }
        let outward = if dot(across, minus(a, centre)) < 0.0 { -length } else { length };
        let normal = across.map(|part| part / outward);
        let above = |point: &Place| dot(normal, minus(*point, a));
        let is_known = |plane: &Place| norm(minus(*plane, normal)) <= 1e-9;
        if points.iter().any(|point| above(point) > near) || planes.iter().any(is_known) {
            continue;
        }
        planes.push(normal);
        let face: Vec<Place> = points.iter().filter(|point| above(point).abs() <= near).copied().collect();
        sum += dot(normal, minus(a, centre)) * area_of_hull(&face, normal) / 3.0;
    }
    sum
}

fn triples(count: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..count).flat_map(move |a| (a + 1..count).flat_map(move |b| (b + 1..count).map(move |c| (a, b, c))))
}

/// Area of points in a plane: the ring of those on its border, from each the one with all others on one side.
fn area_of_hull(points: &[Place], normal: Place) -> f64 {
    let mut ring = vec![points[0]];
    // The one farthest from the mean is on the border.
    let centre = mean(points);
    for point in points {
        if norm(minus(*point, centre)) > norm(minus(ring[0], centre)) {
            ring[0] = *point;
        }
    }
    while ring.len() <= points.len() {
        let from = ring[ring.len() - 1];
        let mut next = from;
        for point in points {
            let turn = dot(normal, cross(minus(next, from), minus(*point, from)));
            let is_farther = norm(minus(*point, from)) > norm(minus(next, from));
            let scale = norm(minus(next, from)) * norm(minus(*point, from));
            if next == from || turn < -1e-12 * scale || (turn.abs() <= 1e-12 * scale && is_farther) {
                next = *point;
            }
        }
        if next == ring[0] || next == from {
            break;
        }
        ring.push(next);
    }
    area(&ring)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of corners of a regular polygon of radius 1 at a height, a pixel's order for `is_pixel`.
    fn ring(sides: usize, height: f64) -> Vec<Place> {
        let angle = |side: usize| std::f64::consts::TAU * (side as f64 + 0.5) / sides as f64;
        (0..sides).map(|side| [angle(side).cos(), angle(side).sin(), height]).collect()
    }

    /// Area of that polygon.
    fn area_of_ring(sides: usize) -> f64 {
        0.5 * sides as f64 * (std::f64::consts::TAU / sides as f64).sin()
    }

    /// Corners of a cell of a type, its volume, and points beyond the corners.
    fn sample(known: &CellType) -> (Vec<Place>, f64, usize) {
        let rectangle = vec![[0.0; 3], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0]];
        let swapped = |mut ring: Vec<Place>| {
            ring.swap(2, 3);
            ring
        };
        let lifted = |ring: &[Place]| ring.iter().map(|place| [place[0], place[1], 5.0]).collect::<Vec<_>>();
        let beyond = if known.corners == All { 0 } else { 3 };
        let (corners, volume) = match (known.number, known.shape) {
            (0..=2, _) => (vec![[1.0, 2.0, 3.0]], f64::NAN),
            (4 | 51, _) => (vec![[0.0; 3], [3.0, 4.0, 0.0], [3.0, 4.0, 2.0]], 7.0),
            (_, Line) => (vec![[0.0; 3], [3.0, 4.0, 0.0]], 5.0),
            (6 | 8, _) => (swapped(rectangle), 6.0),
            (11, _) => ([swapped(rectangle.clone()), swapped(lifted(&rectangle))].concat(), 30.0),
            (7 | 36 | 52 | 63, _) => (ring(5, 1.0), area_of_ring(5)),
            (_, Ring) if known.corners == First(3) => (ring(3, 0.5), area_of_ring(3)),
            (_, Ring) => (rectangle, 6.0),
            (_, Cone(sides)) => {
                ([ring(sides, 0.0), vec![[0.2, 0.1, 2.0]]].concat(), 2.0 / 3.0 * area_of_ring(sides))
            }
            (_, Prism(sides)) => ([ring(sides, 0.0), ring(sides, 2.0)].concat(), 2.0 * area_of_ring(sides)),
            (_, Hull) => ([ring(6, 0.0), ring(6, 2.0), vec![[0.0; 3]]].concat(), 2.0 * area_of_ring(6)),
            (number, _) => panic!("{number}"),
        };
        // A quadratic polygon has as many points at the middle of sides as corners.
        let beyond = if known.corners == Half { corners.len() } else { beyond };
        (corners, volume, beyond)
    }

    /// Of every type: `vtkCellType.h` by VTK's own `vtkCellTypes::GetDimension` and `vtkGenericCell`, dumped to this table.
    const VTK: [(u8, usize, usize); 64] = [
        (0, 0, 1),
        (1, 0, 1),
        (2, 0, 1),
        (3, 1, 2),
        (4, 1, 3),
        (5, 2, 3),
        (6, 2, 4),
        (7, 2, 5),
        (8, 2, 4),
        (9, 2, 4),
        (10, 3, 4),
        (11, 3, 8),
        (12, 3, 8),
        (13, 3, 6),
        (14, 3, 5),
        (15, 3, 10),
        (16, 3, 12),
        (21, 1, 2),
        (22, 2, 3),
        (23, 2, 4),
        (24, 3, 4),
        (25, 3, 8),
        (26, 3, 6),
        (27, 3, 5),
        (28, 2, 4),
        (29, 3, 8),
        (30, 2, 4),
        (31, 3, 6),
        (32, 3, 6),
        (33, 3, 8),
        (34, 2, 3),
        (35, 1, 2),
        (36, 2, 5),
        (37, 3, 5),
        (41, 3, 13),
        (42, 3, 13),
        (51, 1, 3),
        (52, 2, 5),
        (53, 2, 3),
        (54, 2, 4),
        (55, 3, 4),
        (56, 3, 8),
        (60, 1, 2),
        (61, 2, 3),
        (62, 2, 4),
        (63, 2, 5),
        (64, 3, 4),
        (65, 3, 6),
        (66, 3, 5),
        (67, 3, 8),
        (68, 1, 2),
        (69, 2, 3),
        (70, 2, 4),
        (71, 3, 4),
        (72, 3, 8),
        (73, 3, 6),
        (74, 3, 5),
        (75, 1, 2),
        (76, 2, 3),
        (77, 2, 4),
        (78, 3, 4),
        (79, 3, 8),
        (80, 3, 6),
        (81, 3, 5),
    ];

    #[test]
    fn every_type_of_vtk_has_its_dimension_corners_centre_and_volume() {
        assert_eq!(TYPES.len(), VTK.len());
        for (number, dimension, corners) in VTK {
            let known = type_of(number).expect("a type");
            let name = known.name;
            let (mut places, volume, beyond) = sample(known);
            let centre = mean(&places);
            assert_eq!(places.len(), corners, "{name}");
            // Points of a higher order follow, which count for nothing here.
            places.extend(vec![[100.0, -7.0, 3.0]; beyond]);
            let count = u32::try_from(places.len()).expect("few");
            // The second of two cells, with its points in another order in the file.
            let connectivity = [vec![0], (0..count).rev().collect()].concat();
            places.reverse();
            let cells = Cells { types: vec![1, number], ends: vec![1, connectivity.len()], connectivity };
            assert_eq!(cells.check(places.len()), Ok(()), "{name}");
            assert_eq!((cells.dimension_of(1), cells.dimension()), (dimension, dimension), "{name}");
            assert_eq!(cells.corners(1).len(), corners, "{name}");
            let found = cells.volume(1, &places);
            assert!(
                if volume.is_nan() { found.is_nan() } else { (found - volume).abs() < 1e-12 * volume },
                "{name}: {found} for {volume}"
            );
            let off = norm(minus(cells.centre(1, &places), centre));
            assert!(off < 1e-12, "{name}: {off}");
            let marked = cells.are_corners(places.len()).iter().filter(|is_corner| **is_corner).count();
            assert_eq!(marked, if dimension == 0 { 1.max(corners) } else { corners }, "{name}");
            let with_values = cells.have_values(places.len()).iter().filter(|has| **has).count();
            let all = if BEZIER.contains(&number) { corners } else { places.len() };
            assert_eq!(with_values, all, "{name}");
        }
        assert!([17, 20, 38, 43, 50, 57, 82, 255].iter().all(|number| type_of(*number).is_none()));
    }

    #[test]
    fn lists_that_do_not_fit_are_told() {
        let quad = |types: u8, connectivity: &[u32]| Cells {
            types: vec![types],
            ends: vec![connectivity.len()],
            connectivity: connectivity.to_vec(),
        };
        for (cells, points, told) in [
            (quad(9, &[0, 1, 2]), 3, "a quad, has 3 points"),
            (quad(99, &[0, 1, 2]), 3, "the type 99, which VTK does not have"),
            (quad(9, &[0, 1, 2, 11]), 11, "the point 11 of 11"),
            (Cells { types: vec![], ..quad(9, &[0, 1, 2, 3]) }, 4, "types for 0"),
            (Cells { ends: vec![3], ..quad(9, &[0, 1, 2, 3]) }, 4, "offsets end at 3"),
        ] {
            assert!(cells.check(points).is_err_and(|why| why.contains(told)), "{told}");
        }
    }

    #[test]
    fn borders_beside_bodies_give_no_corners_and_no_values() {
        // A triangle, one of its edges with a point that no triangle has, and a vertex.
        let mut cells =
            Cells { types: vec![5, 3, 1], ends: vec![3, 5, 6], connectivity: vec![0, 1, 2, 2, 3, 4] };
        assert_eq!(cells.are_corners(5), [true, true, true, false, false]);
        assert_eq!(cells.have_values(5), [true, true, true, false, false]);
        cells.keep(&[false, true, true]);
        assert_eq!((cells.count(), cells.points(0), cells.dimension()), (2, &[2, 3][..], 1));
    }
}
