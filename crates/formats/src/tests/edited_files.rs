//! Small files of every format, each edited in one place at a time: what is read of them, or why they are refused, whole.

use crate::cells::Cells;
use crate::frame::{Frame, Wanted};
use crate::{collection_of, read_states, steps_of};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Every array that a test file has, but for `other`, whose numbers are not read.
const WANTED: [&str; 6] = ["p", "u", "tensor", "level", "with space", "coord_x"];

fn cells_told(cells: &Cells, points: usize) -> String {
    let corners: Vec<_> = (0..cells.count()).map(|cell| cells.corners(cell)).collect();
    let ends = cells.are_corners(points).iter().filter(|is_corner| **is_corner).count();
    format!(
        "cells {:?} of {} dimensions with corners {corners:?}, {ends} in all",
        cells.types,
        cells.dimension()
    )
}

fn frame_told(frame: &Frame) -> String {
    let mut text = format!("time {:?} points {:?}", frame.time, frame.coordinates);
    if let Some(cells) = &frame.cells {
        write!(text, " {}", cells_told(cells, frame.coordinates.len())).expect("memory");
    }
    for array in &frame.arrays {
        let (name, on) = (&array.name, array.on.name());
        write!(text, "\n      {name} on {on} {} × {}: {:?}", array.tuples, array.components, array.values)
            .expect("memory");
    }
    if !frame.notes.is_empty() {
        write!(text, "\n      notes {:?}", frame.notes).expect("memory");
    }
    text
}

/// All states of a file, or why it is refused; the folder of the test has another name each time.
fn told(path: &Path) -> String {
    let names: BTreeSet<String> = WANTED.map(str::to_owned).into();
    let mut text = String::new();
    let mut notes = Vec::new();
    let end = steps_of(path, &mut notes).and_then(|steps| {
        read_states(&steps, Wanted(&names), &mut |step, frame| {
            let file = step.file.file_name().unwrap_or_default().to_string_lossy();
            let named = step.named.file_name().unwrap_or_default().to_string_lossy();
            let (place, time) = (step.place, step.time);
            write!(text, "\n    {:?} {place} of {file} by {named}, listed at {time:?}: ", step.kind)
                .expect("memory");
            text.push_str(&frame_told(&frame));
            Ok(())
        })
    });
    for note in notes {
        write!(text, "\n    note {note}").expect("memory");
    }
    if let Err(error) = end {
        write!(text, "\n    {error}").expect("memory");
    }
    let folder = if path.is_dir() { path } else { path.parent().expect("a folder") };
    text.replace(&folder.display().to_string(), "FOLDER")
}

/// A file as it is and after each edit.
fn edits(text: &mut String, folder: &Path, name: &str, file: &str, edits: &[(&str, &str)]) {
    let path = folder.join(name);
    for (from, to) in [("", "")].iter().chain(edits) {
        assert!(file.contains(from), "{from}");
        fs::write(&path, file.replacen(from, to, 1)).expect("a file");
        let told = told(&path);
        let to: String = to.chars().take(90).collect();
        writeln!(text, "{name}: {from:?} → {to:?}{told}").expect("memory");
    }
}

fn assert_snapshot(name: &str, text: &str) {
    insta::with_settings!({
        snapshot_path => "../../../../tests/snapshots", prepend_module_to_snapshot => false, omit_expression => true
    }, { insta::assert_snapshot!(name, text) });
}

const VTU: &str = r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>
<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">2.5</DataArray>
<DataArray type="Int32" Name="level" NumberOfTuples="2" format="ascii">3 4</DataArray></FieldData>
<Piece NumberOfPoints="4" NumberOfCells="2">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0  1 0 0  1 2 0  0 2 0.5</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 0 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3 6</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5 22</DataArray></Cells>
<PointData><DataArray type="Float64" Name="p" format="ascii">10 20 30 -40.5</DataArray>
<DataArray type="Float64" Name="u" NumberOfComponents="2" format="ascii">1 2 3 4 5 6 7 8</DataArray>
<DataArray type="Float64" Name="other" format="ascii">9 9 9 9</DataArray></PointData>
<CellData><DataArray type="Float64" Name="tensor" NumberOfComponents="3" format="ascii">1 2 3 4 5 6</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>
"#;

#[test]
fn vtu_files_with_one_edit() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mut text = String::new();
    let piece =
        VTU.split_once("<Piece").and_then(|(_, rest)| rest.split_once("</Piece>")).expect("a piece").0;
    let twice = format!("</Piece><Piece{piece}</Piece>");
    edits(
        &mut text,
        folder.path(),
        "a.vtu",
        VTU,
        &[
            ("</Piece>", &twice),
            ("</Piece>", &twice.replacen("\"u\"", "\"v\"", 1)),
            (
                "</Piece>",
                &twice.replacen(
                    "\"tensor\" NumberOfComponents=\"3\"",
                    "\"tensor\" NumberOfComponents=\"1\"",
                    1,
                ),
            ),
            ("</Piece>", "</Piece><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>"),
            ("type=\"UnstructuredGrid\"", "type=\"PolyData\""),
            ("type=\"UnstructuredGrid\"", "type=\"ImageData\""),
            ("</VTKFile>", ""),
            ("</VTKFile>", "</VTKFile> trailing"),
            ("header_type=\"UInt64\"", "compressor=\"vtkLZ4DataCompressor\""),
            ("NumberOfPoints=\"4\"", "NumberOfPoints=\"3\""),
            ("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\""),
            ("NumberOfPoints=\"4\"", "NumberOfPoints=\"four\""),
            ("NumberOfCells=\"2\"", "NumberOfCells=\"1\""),
            ("NumberOfCells=\"2\"", ""),
            ("\"TimeValue\"", "\"TIME\""),
            ("\"TimeValue\"", "\"Times\""),
            (">2.5<", ">2.5 3.5<"),
            (">2.5<", "><"),
            ("0 1 2 0 2 3", "0 1 2 0 2 4"),
            ("0 1 2 0 2 3", "0 1 2 0 2"),
            ("0 1 2 0 2 3", "0 1 2 0 2 -3"),
            ("0 1 2 0 2 3", "0 1 2 0 2 2.5"),
            (">3 6<", ">6 3<"),
            (">3 6<", ">3 5<"),
            (">3 6<", ">3 3<"),
            (">5 22<", ">5<"),
            (">5 22<", ">5 300<"),
            (">5 22<", ">3 10<"),
            (">5 22<", ">1 2<"),
            (">5 22<", ">23 12<"),
            ("10 20 30 -40.5", "10 20 30"),
            ("10 20 30 -40.5", "10 20 30 -40.5 50"),
            ("10 20 30 -40.5", "10 20 30 wet"),
            ("10 20 30 -40.5", "10 nan inf 1e-3"),
            ("Name=\"u\" NumberOfComponents=\"2\"", "Name=\"u\""),
            ("Name=\"u\" NumberOfComponents=\"2\"", "Name=\"u\" NumberOfComponents=\"0\""),
            ("Name=\"u\" NumberOfComponents=\"2\"", "Name=\"u\" NumberOfComponents=\"x\""),
            ("Name=\"p\" format=\"ascii\"", "Name=\"p\" format=\"binary\""),
            ("Name=\"p\" format=\"ascii\"", "Name=\"p\" format=\"appended\" offset=\"0\""),
            ("Name=\"p\" format=\"ascii\"", "Name=\"p\" format=\"hex\""),
            ("type=\"Float64\" Name=\"p\"", "type=\"String\" Name=\"p\""),
            ("type=\"Float64\" Name=\"p\"", "type=\"Bit\" Name=\"p\""),
            ("<Points>", "<Points hidden=\"1\"></Points><Other>"),
            ("<Cells>", "<NoCells>"),
        ],
    );
    assert_snapshot("formats_vtu", &text);
}

const VTK: &str = "# vtk DataFile Version 3.0\na title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n\
    0 0 0  1 0 0  1 2 0  0 2 0.5\nCELLS 2 8\n3 0 1 2 3 0 2 3\nCELL_TYPES 2\n5 5\nPOINT_DATA 4\n\
    SCALARS p double 1\nLOOKUP_TABLE default\n10 20 30 -40.5\nVECTORS u float\n1 2 3 4 5 6 7 8 9 10 11 12\n\
    CELL_DATA 2\nFIELD FieldData 2\nlevel 1 2 int\n3 4\nwith%20space 2 2 double\n5 6 7 8\n";

#[test]
fn legacy_files_with_one_edit() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mut text = String::new();
    edits(
        &mut text,
        folder.path(),
        "a.vtk",
        VTK,
        &[
            ("ASCII", "ascii"),
            ("ASCII", "TEXT"),
            ("ASCII", "BINARY"),
            ("UNSTRUCTURED_GRID", "POLYDATA"),
            ("UNSTRUCTURED_GRID", "STRUCTURED_GRID\nDIMENSIONS 2 2 1"),
            ("UNSTRUCTURED_GRID", "RECTILINEAR_GRID"),
            ("POINTS 4 float", "POINTS 4 vtktypefloat32"),
            ("POINTS 4 float", "POINTS 4 real"),
            ("POINTS 4 float", "POINTS four float"),
            ("POINTS 4 float", "POINTS 3 float"),
            ("POINTS 4 float", "POINTS 400 float"),
            ("POINTS 4 float", "POINTS 0 float"),
            ("CELLS 2 8", "CELLS 3 8"),
            ("CELLS 2 8", "CELLS 2 7"),
            ("3 0 1 2 3 0 2 3", "3 0 1 2 3 0 2 4"),
            ("3 0 1 2 3 0 2 3", "3 0 1 2 4 0 2 3"),
            (
                "CELLS 2 8\n3 0 1 2 3 0 2 3",
                "CELLS 3 6\nOFFSETS vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 2 0 2 3",
            ),
            (
                "CELLS 2 8\n3 0 1 2 3 0 2 3",
                "CELLS 3 6\nOFFSETS vtktypeint64\n0 3 6\nPOINTS vtktypeint64\n0 1 2 0 2 3",
            ),
            ("CELL_TYPES 2\n5 5", "CELL_TYPES 1\n5"),
            ("CELL_TYPES 2\n5 5", "CELL_TYPES 2\n3 4"),
            ("CELLS 2 8\n3 0 1 2 3 0 2 3\nCELL_TYPES 2\n5 5", "POLYGONS 2 8\n3 0 1 2 3 0 2 3"),
            ("CELLS 2 8\n3 0 1 2 3 0 2 3\nCELL_TYPES 2\n5 5", "VERTICES 2 4\n1 0 1 3"),
            ("POINT_DATA 4", "POINT_DATA 3"),
            ("POINT_DATA 4", "METADATA\nanything 3\n\nPOINT_DATA 4"),
            ("SCALARS p double 1\nLOOKUP_TABLE default", "SCALARS p double"),
            ("SCALARS p double 1\nLOOKUP_TABLE default", "SCALARS p double\nLOOKUP_TABLE default"),
            ("SCALARS p double 1", "SCALARS p double 2"),
            ("SCALARS p double 1", "SCALARS p bit 1"),
            ("-40.5", "dry"),
            ("-40.5", ""),
            ("-40.5", "-40.5 50"),
            ("VECTORS u float", "NORMALS u float"),
            ("VECTORS u float\n", "TENSORS tensor double\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 "),
            ("CELL_DATA 2", "CELL_DATA 4"),
            ("CELL_DATA 2", "CELL_DATA x"),
            ("FIELD FieldData 2", "FIELD FieldData 3"),
            ("FIELD FieldData 2", "FIELD FieldData 1"),
            ("level 1 2 int", "level 1 3 int"),
            ("level 1 2 int", "other 1 2 int"),
            ("level 1 2 int", "METADATA\nINFORMATION 0\n\nlevel 1 2 unsigned_char"),
            ("POINTS 4", "FIELD FieldData 2\nTIME 1 1 double\n7.25\nCYCLE 1 1 int\n3\nPOINTS 4"),
            ("7 8\n", "7 8"),
            ("POINTS 4 float\n", "FIELD none 1\nx 3 4 float\n"),
            ("CELLS 2 8\n3 0 1 2 3 0 2 3\nCELL_TYPES 2\n5 5\n", ""),
            ("CELLS 2 8\n3 0 1 2 3 0 2 3\nCELL_TYPES 2\n5 5\n", "CELLS 0 0\nCELL_TYPES 0\n"),
        ],
    );
    assert_snapshot("formats_legacy_vtk", &text);
}

const XDMF: &str = r#"<Xdmf Version="3.0"><Domain><Grid GridType="Collection" CollectionType="Temporal">
<Grid Name="first"><Time Value="1.5"/><Geometry GeometryType="XYZ"><DataItem Dimensions="4 3">0 0 0 1 0 0 1 2 0 0 2 0.5</DataItem></Geometry>
<Topology TopologyType="Triangle"><DataItem Dimensions="2 3" Format="XML">0 1 2 0 2 3</DataItem></Topology>
<Attribute Name="p" Center="Node"><DataItem Dimensions="4">10 20 30 -40.5</DataItem></Attribute>
<Attribute Name="tensor" Center="Cell"><DataItem Dimensions="2 2 2">1 2 3 4 5 6 7 8</DataItem></Attribute>
<Attribute Name="level" Center="Grid"><DataItem Dimensions="1">3</DataItem></Attribute>
<Attribute Name="other"><DataItem Dimensions="4">9 9 9 9</DataItem></Attribute></Grid>
<Grid Name="second"><Time Value="2.5"/><Attribute Name="p" Center="Node"><DataItem Dimensions="4">1 2 3 4</DataItem></Attribute></Grid>
</Grid></Domain></Xdmf>
"#;

#[test]
fn xdmf_files_with_one_edit() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mut text = String::new();
    let include = |pointer: &str| format!("<Time Value=\"2.5\"/><include xpointer=\"{pointer}\"/>");
    let of = |kind: &str, points: &str| {
        let count = points.split(' ').count();
        format!("TopologyType=\"{kind}\"><DataItem Dimensions=\"{count}\">{points}<")
    };
    let triangles = "TopologyType=\"Triangle\"><DataItem Dimensions=\"2 3\" Format=\"XML\">0 1 2 0 2 3<";
    let kinds = [
        of("Quadrilateral", "0 1 2 3"),
        of("Tetrahedron", "3 2 1 0"),
        of("Polyline", "0 1 2 3"),
        of("Polyvertex", "1 3"),
        of("Edge_3", "0 2 1"),
        of("Mixed", "4 0 1 2 2 2 1 3 1 1 0"),
        of("Mixed", "5 0 1 2 3"),
        of("Mixed", "99 0 1 2 3"),
        of("Mixed", "4 0 1"),
        of("3DSMesh", "0 1"),
        of("Triangle", "0 1 9"),
    ];
    let second = "<Time Value=\"2.5\"/>";
    let pointers = [
        "element(/1/1/1/1)",
        "element(/1/1/1/9)",
        "xpointer(//Grid[@Name=&quot;first&quot;]/*[self::Topology or self::Geometry])",
        "xpointer(//Grid[@Name='none'])",
        "/Xdmf/Domain/Grid/Grid[1]/Geometry",
        "//Geometry[1]",
    ]
    .map(include);
    let mut list: Vec<(&str, &str)> = kinds.iter().map(|kind| (triangles, kind.as_str())).collect();
    list.extend(pointers.iter().map(|pointer| (second, pointer.as_str())));
    list.extend([
        (second, "<Time Value=\"2.5\"/><Geometry Reference=\"XML\">/Xdmf/Domain/Grid/Grid[1]/Geometry</Geometry>"),
        (second, "<Time Value=\"2.5\"/><Geometry Type=\"XY\"><DataItem Dimensions=\"4 2\">5 6 7 8 5 6 7 8</DataItem></Geometry>"),
        (second, ""),
        ("<Time Value=\"1.5\"/>", ""),
        ("Value=\"1.5\"", "Value=\"early\""),
        ("Value=\"1.5\"", "Value=\"inf\""),
        ("GeometryType=\"XYZ\"", "GeometryType=\"VXVYVZ\""),
        ("GeometryType=\"XYZ\"", ""),
        ("\"4 3\"", "\"4 -3\""),
        ("\"4 3\"", "\"4 2\""),
        ("10 20 30 -40.5", "10 20 30"),
        ("10 20 30 -40.5", "10 20 30 -40.5 5"),
        ("10 20 30 -40.5", "10 20 30 wet"),
        ("<DataItem Dimensions=\"4\">10", "<DataItem Dimensions=\"4\" Format=\"Binary\">10"),
        ("<DataItem Dimensions=\"4\">10", "<DataItem Dimensions=\"4\" Format=\"HDF\">10"),
        ("<DataItem Dimensions=\"4\">10 20 30 -40.5", "<DataItem Dimensions=\"4\" Format=\"HDF\">a.h5:/run/p"),
        ("<DataItem Dimensions=\"4\">10 20 30 -40.5", "<DataItem Dimensions=\"2\" Format=\"HDF\">a.h5:/run/p|1:1:2:4"),
        ("<DataItem Dimensions=\"4\">10 20 30 -40.5", "<DataItem Dimensions=\"3\" Format=\"HDF\">a.h5:/run/p|1:1:2:4"),
        ("<DataItem Dimensions=\"4\">10 20 30 -40.5", "<DataItem Dimensions=\"2\" Format=\"HDF\">a.h5:/run/p|1:1"),
        ("<DataItem Dimensions=\"4\">10 20 30 -40.5", "<DataItem Dimensions=\"4\" Format=\"HDF\">a.h5:/run/q"),
        (
            "<DataItem Dimensions=\"4\">10 20 30 -40.5",
            "<DataItem ItemType=\"HyperSlab\" Dimensions=\"2\"><DataItem Dimensions=\"3\">2 1 2</DataItem>\
             <DataItem Dimensions=\"4\" Format=\"HDF\">a.h5:/run/p</DataItem>",
        ),
        ("<DataItem Dimensions=\"4\">10 20 30 -40.5", "<DataItem ItemType=\"HyperSlab\" Dimensions=\"2\">"),
        ("Grid GridType=\"Collection\"", "Grid GridType=\"Tree\""),
        ("<Attribute Name=\"p\" Center=\"Node\"><DataItem Dimensions=\"4\">10 20 30 -40.5</DataItem>", "<Attribute Name=\"p\">"),
        ("</Xdmf>", ""),
    ]);
    let mut store = hdf5_pure::FileBuilder::new();
    let mut run = store.create_group("run");
    run.create_dataset("p").with_f64_data(&[0.5, 1.5, 2.5, 3.5]).with_shape(&[4]);
    store.add_group(run.finish());
    store.write(folder.path().join("a.h5")).expect("a file");
    edits(&mut text, folder.path(), "a.xdmf", XDMF, &list);
    assert_snapshot("formats_xdmf", &text);
}

/// An array as `NumPy` writes it: bytes 1, 2, 3, … as its numbers.
fn npy(version: u8, header: &str, count: u8) -> Vec<u8> {
    let length = u32::try_from(header.len()).expect("short").to_le_bytes();
    let length = if version == 1 { &length[..2] } else { &length };
    let content: Vec<u8> = (1..=count).collect();
    [b"\x93NUMPY", &[version, 0][..], length, header.as_bytes(), &content].concat()
}

#[test]
fn arrays_of_numpy_of_every_type_and_shape() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("p.npy");
    let mut text = String::new();
    let mut tell = |version, header: &str, count| {
        fs::write(&path, npy(version, header, count)).expect("a file");
        writeln!(text, "{header} with {count} bytes, version {version}{}", told(&path)).expect("memory");
    };
    for kind in ["i1", "u1", "b1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"] {
        for order in ["<", ">"] {
            tell(1, &format!("{{'descr': '{order}{kind}', 'fortran_order': False, 'shape': (2,), }}"), 16);
        }
    }
    for shape in [
        "()",
        "(4,)",
        "(2, 3)",
        "(3L, 2L)",
        "(2, 2, 2)",
        "(2, 4,)",
        "(0,)",
        "(x,)",
        "(99999999999, 99999999999)",
    ] {
        for order in ["False", "True"] {
            tell(1, &format!("{{'descr': '|u1', 'fortran_order': {order}, 'shape': {shape}, }}"), 8);
        }
    }
    tell(2, "{'descr': '<u2', 'fortran_order': False, 'shape': (2,), }", 4);
    tell(1, "{'descr': '<u2', 'fortran_order': False, 'shape': (2,), }", 3);
    tell(1, "{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", 16);
    tell(1, "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (2,), }", 16);
    assert_snapshot("formats_numpy", &text);
}

#[test]
fn collections_with_one_edit() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mut text = String::new();
    for (name, time) in [("a.vtu", "1.25"), ("b.vtu", "2.5")] {
        fs::write(folder.path().join(name), VTU.replace("2.5", time)).expect("a file");
    }
    fs::write(folder.path().join("edge.vtu"), VTU.replace(">5 22<", ">3 3<")).expect("a file");
    let pvd = "<VTKFile type=\"Collection\"><Collection>\n<DataSet timestep=\"3.5\" file=\"a.vtu\"/>\n\
               <DataSet timestep=\"4.5\" file=\"b.vtu\"/></Collection></VTKFile>\n";
    edits(
        &mut text,
        folder.path(),
        "all.pvd",
        pvd,
        &[
            ("4.5", "late"),
            ("timestep=\"4.5\"", ""),
            ("b.vtu", "a.vtu"),
            ("timestep=\"4.5\" file=\"b.vtu\"", "timestep=\"3.5\" file=\"a.vtu\""),
            ("b.vtu", "gone.vtu"),
            ("</Collection>", "</Collections>"),
        ],
    );
    let series = "{\"file-series-version\": \"1.0\", \"files\": [{\"name\": \"a.vtu\", \"time\": 3.5}, {\"name\": \"b.vtu\", \"time\": 4.5}]}";
    edits(
        &mut text,
        folder.path(),
        "all.vtu.series",
        series,
        &[("4.5", "\"late\""), ("\"name\": \"b.vtu\"", "\"nam\": \"b.vtu\""), ("b.vtu", "gone.vtu")],
    );
    let blocks = "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>\n<DataSet index=\"0\" file=\"a.vtu\"/>\n\
                  <DataSet index=\"1\" file=\"b.vtu\"/></vtkMultiBlockDataSet></VTKFile>\n";
    edits(
        &mut text,
        folder.path(),
        "all.vtm",
        blocks,
        &[
            ("b.vtu", "edge.vtu"),
            ("b.vtu", "a.vtu"),
            ("file=\"b.vtu\"", "file=\"\""),
            ("b.vtu", "all.vtm"),
            ("<DataSet index=\"0\" file=\"a.vtu\"/>\n<DataSet index=\"1\" file=\"b.vtu\"/>", ""),
        ],
    );
    // What a folder, and a file that a collection names, is told to be.
    let shorter = |found: String| found.replace(&folder.path().display().to_string(), "FOLDER");
    let mut tell = |what: &str, found: String| {
        writeln!(text, "{what}: {}", found.replace(&folder.path().display().to_string(), "FOLDER"))
            .expect("memory");
    };
    tell("the folder", told(folder.path()));
    for name in ["a.vtu", "b.vtu", "none.vtu", "edge.vtu"] {
        let found = collection_of(&folder.path().join(name));
        tell(name, found.map_or("no collection".to_owned(), |path| shorter(path.display().to_string())));
    }
    for (names, what) in [
        (&["a.txt"][..], "a folder without results"),
        (&["b.CSV", "a.txt"], "a folder with a table"),
        (&["z.npz", "y.npz", "c.csv"], "a folder with arrays"),
        (&["c.csv", "a.xdmf"], "a folder with a document"),
    ] {
        let other = tempfile::TempDir::new().expect("a folder");
        for name in names {
            fs::write(other.path().join(name), "1").expect("a file");
        }
        let found = steps_of(other.path(), &mut Vec::new()).expect_err("a folder").to_string();
        tell(what, found.replace(&other.path().display().to_string(), "OTHER"));
    }
    assert_snapshot("formats_collections", &text);
}

/// A data set: its name and its shape.
type Set = (&'static str, &'static [u64]);

#[test]
fn stores_are_read_by_time_by_name_and_by_shape() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.h5");
    let mut text = String::new();
    let numbers = |count: u32| (1..=count).map(|number| f64::from(number) + 0.25).collect::<Vec<f64>>();
    let stores: [(&str, &[Set]); 6] = [
        (
            "by time",
            &[
                ("times", &[2]),
                ("geometry", &[1, 3, 3]),
                ("p", &[2, 3]),
                ("u", &[2, 3, 2]),
                ("other", &[2, 3]),
            ],
        ),
        ("moving points", &[("Time", &[2]), ("points", &[2, 3, 2]), ("p", &[2, 3])]),
        ("one state", &[("coordinates", &[3, 2]), ("p", &[3]), ("tensor", &[3, 2, 2])]),
        ("no place", &[("nodes", &[3, 4]), ("p", &[3])]),
        ("times that are a table", &[("times", &[2, 2]), ("p", &[2])]),
        ("nothing", &[("times", &[2])]),
    ];
    for (what, sets) in stores {
        let mut store = hdf5_pure::FileBuilder::new();
        for (name, shape) in sets {
            let count = shape.iter().product::<u64>();
            let data = numbers(u32::try_from(count).expect("few"));
            store.create_dataset(name).with_f64_data(&data).with_shape(shape);
        }
        store.write(&path).expect("a file");
        writeln!(text, "{what}{}", told(&path)).expect("memory");
    }
    assert_snapshot("formats_hdf5", &text);
}

#[test]
fn files_of_other_programs_are_read_as_they_were() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/foreign");
    let names: BTreeSet<String> = [
        "p",
        "u",
        "pressure",
        "displacement",
        "WATER_PRESSURE",
        "DISPLACEMENT",
        "coord_y",
        "pore_pressures",
        "position",
    ]
    .map(str::to_owned)
    .into();
    let mut text = String::new();
    for name in [
        "cb-geo/particles005.h5",
        "cb-geo/pore_pressures005.vtp",
        "geotaichi/particles/MPMParticle000001.npz",
        "geotaichi/GraphicMPMParticle000001.vtu",
        "kratos-mpm/column_0_2.vtk",
        "kratos-mpm/binary_0_2.vtk",
        "kratos-vtk/porous_computational_model_part_0_50.vtk",
        "kratos-vtu/PorousDomain.porous_computational_model_part.vtm.series",
        "ogs/col.pvd",
        "ogs-xdmf/col_bulk.xdmf",
        "porepy/col_2_000000.vtu",
    ] {
        writeln!(text, "## {name}").expect("memory");
        let steps = steps_of(&folder.join(name), &mut Vec::new()).expect("states");
        let taken = read_states(&steps[..steps.len().min(2)], Wanted(&names), &mut |step, frame| {
            let (points, cells) = (frame.coordinates.len(), frame.cells.as_ref().map_or(0, Cells::count));
            let ends = [frame.coordinates.first(), frame.coordinates.last()];
            writeln!(text, "{:?} {:?} {points} points {ends:?}, {cells} cells", step.time, frame.time)
                .expect("memory");
            for array in &frame.arrays {
                let ends = [array.values.first(), array.values.last()].map(Option::<&f64>::copied);
                let sum: f64 = array.values.iter().sum();
                let of =
                    format!("{} on {} {} × {}", array.name, array.on.name(), array.tuples, array.components);
                writeln!(text, "  {of}: {} numbers {ends:?}, sum {sum:.6e}", array.values.len())
                    .expect("memory");
            }
            writeln!(text, "  notes {:?}", frame.notes).expect("memory");
            Ok(())
        });
        taken.expect("they are read");
    }
    assert_snapshot("formats_foreign", &text);
}
