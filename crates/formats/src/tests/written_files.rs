//! Files in which no two lengths are equal and no number stands twice: each number is read at its own place, component
//! and time, wherever a format lets them be counted otherwise.

use crate::frame::{Association, Frame, Wanted};
use crate::{read_states, steps_of};
use hdf5_pure::{FileBuilder, GroupBuilder};
use std::collections::BTreeSet;
use std::path::Path;

/// Every state of a file with its time.
fn states(path: &Path) -> Vec<(Option<f64>, Frame)> {
    let names: BTreeSet<String> = ["p", "u", "e"].map(str::to_owned).into();
    let steps = steps_of(path, &mut Vec::new()).expect("states");
    let mut found = Vec::new();
    let taken = read_states(&steps, Wanted(&names), &mut |step, frame| {
        found.push((frame.time.or(step.time), frame));
        Ok(())
    });
    taken.expect("a sound file");
    found
}

/// The only state of a file of text.
fn state_of(name: &str, text: &str) -> Frame {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("a file");
    let [(_, frame)] = <[_; 1]>::try_from(states(&path)).expect("one state");
    frame
}

fn values<'a>(frame: &'a Frame, name: &str) -> &'a [f64] {
    &frame.arrays.iter().find(|array| array.name == name).expect("an array").values
}

/// A data set: its path, its shape and its numbers.
type Set<'a> = (&'a str, &'a [u64], &'a [f64]);

/// Writes data sets into the groups of their paths.
fn write_store(path: &Path, texts: &[(&str, &[&str])], sets: &[Set<'_>]) {
    fn fill(group: &mut GroupBuilder, sets: &[Set<'_>]) {
        let mut inner: Vec<(&str, Vec<Set<'_>>)> = Vec::new();
        for (path, shape, numbers) in sets {
            let Some((first, rest)) = path.split_once('/') else {
                group.create_dataset(path).with_f64_data(numbers).with_shape(shape);
                continue;
            };
            match inner.iter_mut().find(|(name, _)| *name == first) {
                Some((_, known)) => known.push((rest, shape, numbers)),
                None => inner.push((first, vec![(rest, shape, numbers)])),
            }
        }
        for (name, sets) in inner {
            let mut below = group.create_group(name);
            fill(&mut below, &sets);
            group.add_group(below.finish());
        }
    }
    let mut file = FileBuilder::new();
    for (name, words) in texts {
        let letters: Vec<u8> = words.concat().into_bytes();
        file.create_dataset(name).with_u8_data(&letters).with_shape(&[words.len() as u64, 1]);
    }
    let (inside, root): (Vec<Set<'_>>, Vec<Set<'_>>) = sets.iter().partition(|(path, ..)| path.contains('/'));
    for (name, shape, numbers) in root {
        file.create_dataset(name).with_f64_data(numbers).with_shape(shape);
    }
    let mut names: Vec<&str> = inside.iter().filter_map(|(path, ..)| Some(path.split_once('/')?.0)).collect();
    names.dedup();
    for name in names {
        let mut group = file.create_group(name);
        let below = inside.iter().filter_map(|(path, shape, numbers)| {
            let (first, rest) = path.split_once('/')?;
            (first == name).then_some((rest, *shape, *numbers))
        });
        fill(&mut group, &below.collect::<Vec<_>>());
        file.add_group(group.finish());
    }
    file.write(path).expect("a file");
}

/// Exodus says how many nodes an element has and no more: which element that is depends on whether the mesh is flat.
#[test]
fn elements_of_exodus_are_flat_on_a_flat_mesh_and_solid_on_another() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.e");
    // Exodus II manual, tables of element types; VTK's numbers.
    for (nodes, flat, solid) in [(4, 9, 10), (6, 22, 13), (8, 23, 12)] {
        for (third, kind) in [(0.0, flat), (0.5, solid)] {
            let line: Vec<f64> = (0..nodes).map(f64::from).collect();
            let square: Vec<f64> = line.iter().map(|x| x * x).collect();
            let up: Vec<f64> = line.iter().map(|x| third * x).collect();
            let list: Vec<f64> = line.iter().map(|x| x + 1.0).collect();
            let count = [u64::try_from(nodes).expect("few")];
            write_store(
                &path,
                &[("name_nod_var", &["q", "p"]), ("name_elem_var", &["d", "e"])],
                &[
                    ("coordx", &count, &line),
                    ("coordy", &count, &square),
                    ("coordz", &count, &up),
                    ("connect1", &[1, count[0]], &list),
                    ("connect2", &[2, 2], &[1.0, 2.0, 3.0, 2.0]),
                    ("time_whole", &[2], &[5.0, 7.0]),
                    ("vals_nod_var2", &[2, count[0]], &[list.clone(), square.clone()].concat()),
                    ("vals_elem_var2eb2", &[2, 2], &[11.0, 12.0, 13.0, 14.0]),
                ],
            );
            let found = states(&path);
            assert_eq!(found.iter().map(|state| state.0).collect::<Vec<_>>(), [Some(5.0), Some(7.0)]);
            for ((_, frame), (p, e)) in found.iter().zip([(&list, [11.0, 12.0]), (&square, [13.0, 14.0])]) {
                let cells = frame.cells.as_ref().expect("cells");
                assert_eq!(cells.types, [kind, 3, 3], "{nodes} nodes, third axis {third}");
                assert_eq!((cells.points(0).len(), cells.points(2)), (line.len(), &[2, 1][..]));
                assert_eq!(values(frame, "p"), p);
                let [first, rest @ ..] = values(frame, "e") else { panic!("three elements") };
                assert!(first.is_nan() && rest == e, "the first block has no such variable");
                assert_eq!(frame.coordinates[2], [2.0, 4.0, 2.0 * third]);
            }
        }
    }
}

/// The places of old files are one data set, `[axis][node]`.
#[test]
fn places_of_exodus_stand_in_one_data_set_or_in_one_for_each_axis() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.e");
    let places: [&[f64]; 3] = [&[0.0, 2.0, 0.0, 1.0], &[0.0, 0.0, 3.0, 4.0], &[5.0, 6.0, 7.0, 8.0]];
    let list: Set<'_> = ("connect1", &[1, 4], &[1.0, 2.0, 3.0, 4.0]);
    for axes in [2, 3] {
        let right: Vec<[f64; 3]> = (0..4)
            .map(|node| [places[0][node], places[1][node], if axes == 3 { places[2][node] } else { 0.0 }])
            .collect();
        let whole = places[..axes].concat();
        write_store(&path, &[], &[list, ("coord", &[axes as u64, 4], &whole)]);
        assert_eq!(states(&path)[0].1.coordinates, right);
        let names = ["coordx", "coordy", "coordz"];
        let each = names.iter().zip(places).take(axes).map(|(name, places)| (*name, &[4_u64][..], places));
        write_store(&path, &[], &std::iter::once(list).chain(each).collect::<Vec<_>>());
        assert_eq!(states(&path)[0].1.coordinates, right);
    }
}

/// A mesh that stays is written once, and each array has its offsets; a moving mesh is written for each step.
#[test]
fn arrays_of_a_transient_vtkhdf_begin_at_their_own_step_whether_the_mesh_stays_or_moves() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.vtkhdf");
    let triangle: &[f64] = &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0];
    let moved: Vec<f64> = triangle.iter().map(|place| place + 10.0).collect();
    let both = [triangle, &moved].concat();
    for moves in [false, true] {
        let begin: &[f64] = if moves { &[0.0, 1.0] } else { &[0.0, 0.0] };
        let points: Vec<f64> = begin.iter().map(|part| 3.0 * part).collect();
        let parts = if moves { 2 } else { 1 };
        let repeated = |numbers: &[f64]| numbers.repeat(parts);
        let count = |numbers: &[f64]| [numbers.len() as u64];
        let (of_points, types, offsets, connectivity) =
            (repeated(&[3.0]), repeated(&[5.0]), repeated(&[0.0, 3.0]), repeated(&[0.0, 1.0, 2.0]));
        let (cells, ids) = (repeated(&[1.0]), repeated(&[3.0]));
        let places = if moves { &both[..] } else { triangle };
        write_store(
            &path,
            &[],
            &[
                ("VTKHDF/Points", &[places.len() as u64 / 3, 3], places),
                ("VTKHDF/NumberOfPoints", &count(&of_points), &of_points),
                ("VTKHDF/NumberOfCells", &count(&cells), &cells),
                ("VTKHDF/NumberOfConnectivityIds", &count(&ids), &ids),
                ("VTKHDF/Types", &count(&types), &types),
                ("VTKHDF/Offsets", &count(&offsets), &offsets),
                ("VTKHDF/Connectivity", &count(&connectivity), &connectivity),
                ("VTKHDF/PointData/p", &[6], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
                ("VTKHDF/PointData/u", &[6, 2], &std::array::from_fn::<f64, 12, _>(|place| place as f64)),
                ("VTKHDF/CellData/e", &[2], &[7.0, 8.0]),
                ("VTKHDF/Steps/Values", &[2], &[0.5, 1.5]),
                ("VTKHDF/Steps/PartOffsets", &[2], begin),
                ("VTKHDF/Steps/PointOffsets", &[2], &points),
                ("VTKHDF/Steps/CellOffsets", &[2], begin),
                ("VTKHDF/Steps/ConnectivityIdOffsets", &[2], &points),
                ("VTKHDF/Steps/PointDataOffsets/p", &[2], &[0.0, 3.0]),
                ("VTKHDF/Steps/PointDataOffsets/u", &[2], &[0.0, 3.0]),
                ("VTKHDF/Steps/CellDataOffsets/e", &[2], &[0.0, 1.0]),
            ],
        );
        let found = states(&path);
        assert_eq!(found.iter().map(|state| state.0).collect::<Vec<_>>(), [Some(0.5), Some(1.5)]);
        let (first, second) = (&found[0].1, &found[1].1);
        assert_eq!((values(first, "p"), values(second, "p")), (&[1.0, 2.0, 3.0][..], &[4.0, 5.0, 6.0][..]));
        assert_eq!((values(first, "u")[5], values(second, "u")[0]), (5.0, 6.0));
        assert_eq!((values(first, "e"), values(second, "e")), (&[7.0][..], &[8.0][..]));
        assert_eq!(second.coordinates[1], if moves { [12.0, 10.0, 10.0] } else { [2.0, 0.0, 0.0] });
    }
}

/// PFLOTRAN's cells lie between planes, and its data sets are `[x][y][z]`.
#[test]
fn a_block_of_pflotran_has_its_cells_along_z_first_and_its_times_in_order() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.h5");
    let numbers: Vec<f64> = (0..24).map(f64::from).collect();
    let later: Vec<f64> = numbers.iter().map(|number| number + 100.0).collect();
    write_store(
        &path,
        &[],
        &[
            ("Coordinates/X [m]", &[3], &[0.0, 2.0, 6.0]),
            ("Coordinates/Y [m]", &[4], &[0.0, 10.0, 30.0, 60.0]),
            ("Coordinates/Z [m]", &[5], &[0.0, 100.0, 300.0, 600.0, 1000.0]),
            ("Time:  1.00000E+01 d/p", &[2, 3, 4], &later),
            ("Time:  2.00000E+00 d/p", &[2, 3, 4], &numbers),
        ],
    );
    let found = states(&path);
    assert_eq!(found.iter().map(|state| state.0).collect::<Vec<_>>(), [Some(2.0), Some(10.0)]);
    let places: Vec<[f64; 3]> = [1.0, 4.0]
        .iter()
        .flat_map(|x| [5.0, 20.0, 45.0].map(|y| [50.0, 200.0, 450.0, 800.0].map(|z| [*x, y, z])))
        .flatten()
        .collect();
    assert_eq!(found[0].1.coordinates, places);
    assert_eq!((values(&found[0].1, "p"), values(&found[1].1, "p")), (&numbers[..], &later[..]));
}

/// Version 2.2 with nodes and elements that are not numbered in order, and version 4.1 in blocks with parametric places.
#[test]
fn data_of_gmsh_belong_to_their_tags_component_by_component() {
    let data = "$NodeData\n1\n\"u\"\n1\n2.5\n3\n0\n3\n3\n9 7 8 9\n4 1 2 3\n6 4 5 6\n$EndNodeData\n\
                $ElementData\n1\n\"e\"\n1\n2.5\n3\n0\n1\n2\n8 21\n5 22\n$EndElementData\n";
    let old = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n4 0 0 0\n6 2 0 0\n9 0 3 0\n$EndNodes\n\
               $Elements\n2\n5 2 2 1 1 4 6 9\n8 1 2 1 1 4 6\n$EndElements\n";
    let new = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 3 4 9\n1 1 1 2\n4\n6\n0 0 0 0.25\n2 0 0 0.75\n\
               2 1 0 1\n9\n0 3 0\n$EndNodes\n$Elements\n2 2 5 8\n2 1 2 1\n5 4 6 9\n1 1 1 1\n8 4 6\n$EndElements\n";
    for mesh in [old, new] {
        let frame = state_of("a.msh", &format!("{mesh}{data}"));
        assert_eq!(frame.time, Some(2.5));
        assert_eq!(frame.coordinates, [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]);
        assert_eq!(frame.cells.as_ref().map(|cells| cells.types.clone()), Some(vec![5, 3]));
        assert_eq!(values(&frame, "u"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        assert_eq!(values(&frame, "e"), [22.0, 21.0]);
    }
    let view =
        "View \"u\" {\nVT(0,0,0,2,0,0,0,3,0){1,2,3,4,5,6,7,8,9};\nVL(5,0,0,6,0,0){11,12,13,14,15,16};\n};\n";
    let frame = state_of("a.pos", view);
    assert_eq!((frame.coordinates[1], frame.coordinates[4]), ([2.0, 0.0, 0.0], [6.0, 0.0, 0.0]));
    assert_eq!(values(&frame, "u")[3..6], [4.0, 5.0, 6.0]);
    assert_eq!(values(&frame, "u")[12..], [14.0, 15.0, 16.0]);
    assert_eq!(frame.arrays[0].on, Association::Points);
}

/// Times as a list of a collection, as a slab of equal steps, and in each grid; a spatial collection is one state.
#[test]
fn every_grid_of_a_collection_has_its_own_of_the_times() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.xdmf");
    let list = |kind: &str, numbers: &str| {
        format!("<Time TimeType=\"{kind}\"><DataItem Dimensions=\"3\">{numbers}</DataItem></Time>")
    };
    let own = |time: &str| format!("<Time Value=\"{time}\"/>");
    for (times, own) in [
        (list("List", "0.5 2 7"), [const { String::new() }; 3]),
        (list("HyperSlab", "0.5 1.5 3"), [const { String::new() }; 3]),
        (String::new(), ["0.5", "2", "3.5"].map(own)),
        (list("List", "9 8 7"), ["0.5", "2", "3.5"].map(own)),
    ] {
        let grid = |place: usize| {
            let item = format!("<DataItem Dimensions=\"1\">{}</DataItem>", place + 11);
            format!("<Grid>{}<Attribute Name=\"p\" Center=\"Node\">{item}</Attribute></Grid>", own[place])
        };
        let grids = [0, 1, 2].map(grid).concat();
        let collection =
            format!("<Grid GridType=\"Collection\" CollectionType=\"Temporal\">{times}{grids}</Grid>");
        std::fs::write(&path, format!("<Xdmf><Domain>{collection}</Domain></Xdmf>")).expect("a file");
        let found: Vec<(Option<f64>, f64)> =
            states(&path).iter().map(|(time, frame)| (*time, values(frame, "p")[0])).collect();
        let last = if times.contains("2 7") { 7.0 } else { 3.5 };
        assert_eq!(found, [(Some(0.5), 11.0), (Some(2.0), 12.0), (Some(last), 13.0)], "{times}");
    }
}
