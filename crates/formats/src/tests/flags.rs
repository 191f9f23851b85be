//! What a format allows in any place: each flag, and the odd part that is not the first.

use super::*;

fn frame_of(folder: &Path, name: &str) -> Frame {
    let steps = steps_of(&folder.join(name), &mut Vec::new()).expect("a state");
    let names = all_names();
    first_frame(&steps, Wanted(&names)).expect("a frame")
}

/// A block of nodes of each dimension, with or without places on its entity, wherever it stands among the others.
#[test]
fn nodes_of_gmsh_have_places_on_entities_of_every_dimension() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let data = "$NodeData\n1\n\"p\"\n1\n2.5\n3\n0\n1\n3\n1 10\n2 20\n3 30\n$EndNodeData\n";
    for dimension in 0..4_usize {
        for parametric in 0..8_usize {
            let block = |at: usize| {
                let is_parametric = parametric >> at & 1;
                let on_entity = " 0.5".repeat(is_parametric * dimension);
                format!("{dimension} 1 {is_parametric} 1\n{}\n{at} 0 {}{on_entity}\n", at + 1, 7 - at)
            };
            let blocks: String = (0..3).map(block).collect();
            let text = format!(
                "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n3 3 1 3\n{blocks}$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n\
                 $EndElements\n{data}"
            );
            std::fs::write(folder.path().join("a.msh"), text).expect("a file");
            let frame = frame_of(folder.path(), "a.msh");
            let places = [[0.0, 0.0, 7.0], [1.0, 0.0, 6.0], [2.0, 0.0, 5.0]];
            assert_eq!(frame.coordinates, places, "dimension {dimension}, flags {parametric:03b}");
            assert_eq!(frame.array("p", None).map(|array| &array.values[..]), Some(&[10.0, 20.0, 30.0][..]));
        }
    }
}

/// Version, kind and size of numbers in the head of a mesh: text of two versions is read, whatever its numbers' size.
#[test]
fn a_mesh_of_gmsh_is_read_by_its_head() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let place = folder.path().join("a.msh");
    let nodes = [
        "$Nodes\n2\n1 0 0 0\n2 0 1 0\n$EndNodes\n",
        "$Nodes\n1 2 1 2\n1 1 0 2\n1\n2\n0 0 0\n0 1 0\n$EndNodes\n",
    ];
    for (head, layout, refused) in [
        ("2.2 0 8", 0, None),
        ("2 0 8", 0, Some("expected 2.2 or 4.1")),
        ("4.1 0 8", 1, None),
        ("4.1 0 4", 1, None),
        ("4.1 1 8", 1, Some("binary")),
        ("2.2 1 8", 0, Some("binary")),
        ("4 0 8", 1, Some("expected 2.2 or 4.1")),
        ("4.0 0 8", 1, Some("expected 2.2 or 4.1")),
        ("3 0 8", 1, Some("expected 2.2 or 4.1")),
    ] {
        let text = format!("$MeshFormat\n{head}\n$EndMeshFormat\n{}", nodes[layout]);
        std::fs::write(&place, text).expect("a file");
        let names = all_names();
        let read = steps_of(&place, &mut Vec::new()).and_then(|steps| first_frame(&steps, Wanted(&names)));
        match (read, refused) {
            (Ok(frame), None) => assert_eq!(frame.coordinates, [[0.0; 3], [0.0, 1.0, 0.0]], "{head}"),
            (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{head}: {error}"),
            (read, _) => panic!("{head}: {:?}", read.map(|frame| frame.coordinates)),
        }
    }
}

/// Points and cells of another piece in one part of a state, whichever it is.
#[test]
fn ghosts_are_left_out_of_any_part_of_a_state() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let array = |kind: &str, name: &str, components: usize, values: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">{values}</DataArray>"
        )
    };
    for odd in 0..3_usize {
        for on in [Association::Points, Association::Cells] {
            for part in 0..3_usize {
                let flag = |own: Association| {
                    if part == odd && own == on {
                        array("UInt8", "vtkGhostType", 1, "0 1 0")
                    } else {
                        String::new()
                    }
                };
                let places = [0, 1, 2].map(|at| format!("0 {} 0 ", 10 * part + at)).concat();
                let values = [0, 1, 2].map(|at| format!("{} ", 10 * part + at)).concat();
                let text = format!(
                    "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" \
                     NumberOfCells=\"3\"><Points>{}</Points><Cells>{}{}{}</Cells><PointData>{}{}</PointData><CellData>{}{}</CellData>\
                     </Piece></UnstructuredGrid></VTKFile>",
                    array("Float64", "Points", 3, &places),
                    array("Int64", "connectivity", 1, "0 1 1 2 0 2"),
                    array("Int64", "offsets", 1, "2 4 6"),
                    array("UInt8", "types", 1, "3 3 3"),
                    array("Float64", "p", 1, &values),
                    flag(Association::Points),
                    array("Float64", "stress", 1, &values),
                    flag(Association::Cells),
                );
                std::fs::write(folder.path().join(format!("{part}.vtu")), text).expect("a file");
            }
            let sources = [0, 1, 2].map(|part| format!("<Piece Source=\"{part}.vtu\"/>")).concat();
            let pieces = format!(
                "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>{sources}</PUnstructuredGrid></VTKFile>"
            );
            let parts = [0, 1, 2]
                .map(|part| format!("<DataSet timestep=\"1\" part=\"{part}\" file=\"{part}.vtu\"/>"))
                .concat();
            let collection =
                format!("<VTKFile type=\"Collection\"><Collection>{parts}</Collection></VTKFile>");
            for (name, text) in [("a.pvtu", pieces), ("a.pvd", collection)] {
                std::fs::write(folder.path().join(name), text).expect("a file");
                let frame = frame_of(folder.path(), name);
                let is_ghost: Vec<bool> =
                    (0..9).map(|at| on == Association::Points && at == 3 * odd + 1).collect();
                let ghosts = if frame.ghosts.is_empty() { vec![false; 9] } else { frame.ghosts.clone() };
                assert_eq!(ghosts, is_ghost, "{name}: part {odd}");
                let of_cells = frame.array("stress", Some(Association::Cells)).expect("there").values.clone();
                let left_out = (10 * odd + 1) as f64;
                let is_left_out = on == Association::Cells && !of_cells.contains(&left_out);
                let count = frame.cells.as_ref().map_or(0, crate::Cells::count);
                assert_eq!(
                    (of_cells.len(), count, is_left_out),
                    if on == Association::Cells { (8, 8, true) } else { (9, 9, false) },
                    "{name}: part {odd}"
                );
            }
        }
    }
}
