//! Formats of other programs: all ways of writing an array are one array, and no damage is more than a sentence.

mod edited_files;
mod flags;
mod written_files;

use super::frame::{Association, Frame, Wanted};
use super::steps::{Kind, Step, read_states, steps_of};
use super::{ImportError, legacy_vtk, numpy, vtu, xdmf, xml};
use base64::Engine;
use flate2::{Compression, write::ZlibEncoder};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

fn all_names() -> BTreeSet<String> {
    [
        "p",
        "u",
        "pressure",
        "displacement",
        "WATER_PRESSURE",
        "DISPLACEMENT",
        "position",
        "volume",
        "stress",
        "sigma",
    ]
    .map(str::to_owned)
    .into()
}

fn encoded(bytes: &[u8]) -> String {
    base64::engine::general_purpose::STANDARD.encode(bytes)
}

/// The first state of steps.
fn first_frame(steps: &[Step], wanted: Wanted) -> Result<Frame, ImportError> {
    let mut frame = None;
    read_states(&steps[..1], wanted, &mut |_, found| {
        frame = Some(found);
        Ok(())
    })?;
    Ok(frame.expect("a state"))
}

/// A way of writing VTU.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the format, independent of the others"
)]
#[derive(Clone, Copy, Debug)]
struct Way {
    format: &'static str,
    is_raw: bool,
    is_packed: bool,
    is_wide: bool,
    is_single: bool,
    is_big: bool,
    block: usize,
}

impl Way {
    fn header(self, numbers: &[usize]) -> Vec<u8> {
        let bytes = |number: &usize| {
            let wide = *number as u64;
            let narrow = u32::try_from(*number).expect("small");
            match (self.is_wide, self.is_big) {
                (true, false) => wide.to_le_bytes().to_vec(),
                (true, true) => wide.to_be_bytes().to_vec(),
                (false, false) => narrow.to_le_bytes().to_vec(),
                (false, true) => narrow.to_be_bytes().to_vec(),
            }
        };
        numbers.iter().flat_map(bytes).collect()
    }

    /// The payload of numbers, as bytes of the file.
    fn payload(self, numbers: &[f64]) -> Vec<u8> {
        let number = |x: &f64| {
            #[expect(clippy::cast_possible_truncation, reason = "numbers of the tests fit single precision")]
            let single = *x as f32;
            match (self.is_single, self.is_big) {
                (false, false) => x.to_le_bytes().to_vec(),
                (false, true) => x.to_be_bytes().to_vec(),
                (true, false) => single.to_le_bytes().to_vec(),
                (true, true) => single.to_be_bytes().to_vec(),
            }
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(number).collect();
        let (head, body) = if self.is_packed {
            let blocks: Vec<Vec<u8>> = bytes
                .chunks(self.block)
                .map(|block| {
                    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                    encoder.write_all(block).expect("in memory");
                    encoder.finish().expect("in memory")
                })
                .collect();
            let sizes = blocks.iter().map(Vec::len);
            let head: Vec<usize> =
                [blocks.len(), self.block, bytes.len() % self.block].into_iter().chain(sizes).collect();
            (self.header(&head), blocks.concat())
        } else {
            (self.header(&[bytes.len()]), bytes)
        };
        match (self.is_raw, self.is_packed) {
            (true, _) => [head, body].concat(),
            (false, true) => (encoded(&head) + &encoded(&body)).into_bytes(),
            (false, false) => encoded(&[head, body].concat()).into_bytes(),
        }
    }

    /// Points in a line with a pressure each.
    fn file(self, pressure: &[f64]) -> Vec<u8> {
        let places: Vec<f64> = (0..3 * pressure.len()).map(|place| place as f64 / 4.0).collect();
        let kind = if self.is_single { "Float32" } else { "Float64" };
        let order = if self.is_big { "BigEndian" } else { "LittleEndian" };
        let width = if self.is_wide { "UInt64" } else { "UInt32" };
        let packer = if self.is_packed { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let mut appended = Vec::new();
        let mut array = |name: &str, components: usize, numbers: &[f64]| {
            let mut text = format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"{}\"",
                self.format
            )
            .into_bytes();
            match self.format {
                "ascii" => {
                    let written: Vec<String> = numbers.iter().map(f64::to_string).collect();
                    text.extend(format!(">\n{}\n</DataArray>", written.join(" ")).into_bytes());
                }
                "binary" => {
                    text.extend(b">\n  ");
                    text.extend(self.payload(numbers));
                    text.extend(b"\n</DataArray>");
                }
                _ => {
                    text.extend(format!(" offset=\"{}\"/>", appended.len()).into_bytes());
                    appended.extend(self.payload(numbers));
                }
            }
            text
        };
        let (points, data) = (array("Points", 3, &places), array("p", 1, pressure));
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" \
             header_type=\"{width}\"{packer}>\n<UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"0\">\n",
            pressure.len()
        );
        let encoding = if self.is_raw { "raw" } else { "base64" };
        let tail = if self.format == "appended" {
            [
                format!("<AppendedData encoding=\"{encoding}\">\n_").into_bytes(),
                appended,
                b"\n</AppendedData>".into(),
            ]
            .concat()
        } else {
            Vec::new()
        };
        [
            head.as_bytes(),
            b"<Points>",
            &points,
            b"</Points><PointData>",
            &data,
            b"</PointData></Piece></UnstructuredGrid>\n",
            &tail,
            b"</VTKFile>\n",
        ]
        .concat()
    }
}

fn ways() -> impl Strategy<Value = Way> {
    let format = prop_oneof![Just("ascii"), Just("binary"), Just("appended")];
    (format, any::<[bool; 5]>(), 1_usize..9).prop_map(|(format, [raw, packed, wide, single, big], block)| {
        Way {
            format,
            is_raw: raw && format == "appended",
            is_packed: packed,
            is_wide: wide,
            is_single: single,
            is_big: big,
            block: 8 * block,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_way_of_writing_is_the_same_array(way in ways(), small in prop::collection::vec(-4000_i32..4000, 1..40)) {
        let pressure: Vec<f64> = small.iter().map(|number| f64::from(*number) / 8.0).collect();
        let names = all_names();
        let frame = vtu::read(&way.file(&pressure), Wanted(&names));
        let frame = frame.map_err(|why| TestCaseError::fail(format!("{way:?}: {why}")))?;
        prop_assert_eq!(&frame.arrays[0].values, &pressure);
        prop_assert_eq!(frame.coordinates.last().map(|at| at[2]), Some((3 * pressure.len() - 1) as f64 / 4.0));
    }

    #[test]
    fn what_is_cut_is_refused(way in ways(), share in 0.0_f64..0.999) {
        let file = way.file(&[0.5, 1.5, 2.5, 3.5]);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
        let end = (file.len() as f64 * share) as usize;
        let end = end.min(file.len() - b"\n</AppendedData></VTKFile>\n".len() - 2);
        let names = all_names();
        prop_assert!(vtu::read(&file[..end], Wanted(&names)).is_err());
    }

    #[test]
    fn damage_to_real_files_is_never_a_panic(
        which in any::<prop::sample::Index>(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let files = files_to_damage();
        let (path, bytes) = &files[which.index(files.len())];
        let mut bytes = bytes.clone();
        for (place, byte) in flips {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        read_any(path, &bytes);
    }
}

/// Real files, and those of ways that no program at hand writes.
fn files_to_damage() -> Vec<(PathBuf, Vec<u8>)> {
    let way = Way {
        format: "binary",
        is_raw: false,
        is_packed: false,
        is_wide: false,
        is_single: false,
        is_big: true,
        block: 64,
    };
    let pressure = [0.5, 1.5, 2.5, 3.5];
    let made = [
        ("inline.vtu", way.file(&pressure)),
        ("text.vtu", Way { format: "ascii", ..way }.file(&pressure)),
        ("packed.vtu", Way { is_packed: true, ..way }.file(&pressure)),
        ("appended.vtu", Way { format: "appended", is_wide: true, ..way }.file(&pressure)),
        ("text.vtk", legacy(false)),
        ("binary.vtk", legacy(true)),
    ];
    let made = made.into_iter().map(|(name, bytes)| (PathBuf::from(name), bytes));
    let real = real_files().into_iter().map(|path| {
        let bytes = std::fs::read(&path).expect("a file");
        (path, bytes)
    });
    real.chain(made).collect()
}

fn real_files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/foreign");
    [
        "ogs/col_ts_50_t_4.087500.vtu",
        "ogs/col.pvd",
        "ogs-xdmf/col_bulk.xdmf",
        "ogs-xdmf/col.h5",
        "kratos-vtk/porous_computational_model_part_0_50.vtk",
        "kratos-vtu/PorousDomain.porous_computational_model_part.vtm.series",
        "kratos-vtu/PorousDomain.porous_computational_model_part/PorousDomain.porous_computational_model_part_elements_5.vtu",
        "porepy/col_2_000000.vtu",
        "geotaichi/particles/MPMParticle000002.npz",
        "geotaichi/GraphicMPMParticle000002.vtu",
    ]
    .map(|name| folder.join(name))
    .into()
}

/// Reads bytes as the kind of a file, whatever comes of it.
fn read_any(path: &Path, bytes: &[u8]) {
    let names = all_names();
    let wanted = Wanted(&names);
    let of_end = path.extension().and_then(|end| end.to_str()).unwrap_or_default();
    match of_end {
        "vtu" => drop(vtu::read(bytes, wanted)),
        "vtk" => drop(legacy_vtk::read(bytes, wanted)),
        "npz" => drop(numpy::read_npz(bytes, wanted)),
        "xdmf" => {
            let text = String::from_utf8_lossy(bytes);
            let Ok(document) = xml::parse(&text) else { return };
            drop(xdmf::Reader::of(path, &document).and_then(|mut reader| reader.frame(1, wanted)));
        }
        "pvd" => drop(super::collections::of_pvd(path, &String::from_utf8_lossy(bytes))),
        "series" => drop(super::collections::of_series(path, &String::from_utf8_lossy(bytes))),
        _ => {
            let folder = tempfile::TempDir::new().expect("a folder");
            let file = folder.path().join("a.h5");
            std::fs::write(&file, bytes).expect("a file");
            let mut notes = Vec::new();
            let steps = steps_of(&file, &mut notes).unwrap_or_default();
            drop(read_states(&steps, wanted, &mut |_, _| Ok(())));
        }
    }
}

#[test]
fn claims_of_ten_gigabytes_are_refused_at_once() {
    let names = all_names();
    let started = std::time::Instant::now();
    let way = Way {
        format: "appended",
        is_raw: true,
        is_packed: true,
        is_wide: true,
        is_single: false,
        is_big: false,
        block: 64,
    };
    let file = way.file(&[0.5; 8]);
    let claim = 1_250_000_000_u64;
    let text = String::from_utf8_lossy(&file).into_owned();
    let many = text.replace("NumberOfPoints=\"8\"", &format!("NumberOfPoints=\"{claim}\""));
    assert!(vtu::read(many.as_bytes(), Wanted(&names)).is_err());
    // Blocks that claim ten gigabytes each.
    let start = file.windows(2).position(|mark| mark == b"\n_").expect("a mark") + 2;
    let mut packed = file;
    packed[start + 8..start + 16].copy_from_slice(&(8 * claim).to_le_bytes());
    assert!(vtu::read(&packed, Wanted(&names)).is_err());
    let mut blocks = packed.clone();
    blocks[start..start + 8].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(vtu::read(&blocks, Wanted(&names)).is_err());
    let legacy =
        format!("# vtk DataFile Version 3.0\na\nBINARY\nDATASET POLYDATA\nPOINTS {claim} double\n12345678");
    let refused = legacy_vtk::read(legacy.as_bytes(), Wanted(&names));
    assert!(refused.is_err_and(|why| why.contains("the file is cut")));
    assert!(started.elapsed().as_secs() < 5);
}

/// A legacy file of three points in a line, in text or binary.
fn legacy(is_binary: bool) -> Vec<u8> {
    let places = [0.0_f32, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0];
    let pressures = [1.5_f64, -2.25, 1e-3];
    let numbers =
        |text: Vec<String>, bytes: Vec<u8>| if is_binary { bytes } else { text.join(" ").into_bytes() };
    let text = |list: &[f64]| list.iter().map(f64::to_string).collect::<Vec<_>>();
    let cells = [3_i32, 0, 2, 1];
    [
        format!(
            "# vtk DataFile Version 3.0\ntitle\n{}\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n",
            if is_binary { "BINARY" } else { "ASCII" }
        )
        .into_bytes(),
        numbers(text(&places.map(f64::from)), places.iter().flat_map(|x| x.to_be_bytes()).collect()),
        b"\nCELLS 1 4\n".to_vec(),
        numbers(text(&cells.map(f64::from)), cells.iter().flat_map(|x| x.to_be_bytes()).collect()),
        b"\nCELL_TYPES 1\n".to_vec(),
        numbers(vec!["21".to_owned()], 21_i32.to_be_bytes().to_vec()),
        b"\nPOINT_DATA 3\nSCALARS p double 1\nLOOKUP_TABLE default\n".to_vec(),
        numbers(text(&pressures), pressures.iter().flat_map(|x| x.to_be_bytes()).collect()),
        b"\n".to_vec(),
    ]
    .concat()
}

#[test]
fn legacy_files_in_text_and_binary_are_one() {
    let names = all_names();
    let read = |is_binary| legacy_vtk::read(&legacy(is_binary), Wanted(&names)).expect("a file");
    let frame: Frame = read(false);
    assert_eq!(frame.arrays[0].values, [1.5, -2.25, 1e-3]);
    assert_eq!(frame.cells.as_ref().expect("a cell").corners(0), [0, 2]);
    assert_eq!(frame, read(true));
    let cut = legacy(true);
    assert!(legacy_vtk::read(&cut[..cut.len() - 9], Wanted(&names)).is_err());
}

#[test]
fn metadata_between_arrays_are_passed_over_and_the_time_is_that_of_its_array() {
    let file = "# vtk DataFile Version 5.1\na\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nTimeValue 1 1 double\n2.5\n\
                METADATA\nINFORMATION 1\nNAME p LOCATION POINT_DATA\nDATA 1 7.0\n\nPOINTS 2 double\n0 0 0 0 1 0\n\
                METADATA\nINFORMATION 0\n\nPOINT_DATA 2\nSCALARS p double 1\nLOOKUP_TABLE default\n0.5 0.25\n\
                METADATA\nINFORMATION 0\n\nSCALARS pressure double 1\nLOOKUP_TABLE default\n3 4\n";
    let frame = legacy_vtk::read(file.as_bytes(), Wanted(&all_names())).expect("a file");
    assert_eq!(frame.time, Some(2.5));
    assert_eq!(frame.coordinates, [[0.0; 3], [0.0, 1.0, 0.0]]);
    let values: Vec<&[f64]> = frame.arrays.iter().map(|array| &array.values[..]).collect();
    assert_eq!(values[1..], [[0.5, 0.25], [3.0, 4.0]], "{frame:?}");
}

#[test]
fn collections_that_name_each_other_are_refused() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let pvd = |name: &str| {
        format!(
            "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"1\" file=\"{name}\"/></Collection></VTKFile>"
        )
    };
    std::fs::write(at("a.pvd"), pvd("b.pvd")).expect("a file");
    std::fs::write(at("b.pvd"), pvd("a.pvd")).expect("a file");
    let refused = steps_of(&at("a.pvd"), &mut Vec::new()).expect_err("a ring").to_string();
    assert!(refused.contains("which refers back to it"), "{refused}");
    std::fs::write(at("c.vtm"), "<VTKFile type=\"vtkMultiBlockDataSet\"><DataSet file=\"c.vtm\"/></VTKFile>")
        .expect("a file");
    let steps = steps_of(&at("c.vtm"), &mut Vec::new()).expect("one state");
    let names = all_names();
    assert!(first_frame(&steps, Wanted(&names)).is_err());
    std::fs::write(at("d.pvd"), pvd("gone.vtu")).expect("a file");
    assert!(
        steps_of(&at("d.pvd"), &mut Vec::new())
            .is_err_and(|error| error.to_string().contains("none of its 1 files"))
    );
}

#[test]
fn kinds_are_known_by_their_content() {
    for (head, kind) in [
        (&b"t,y,p\n"[..], Kind::Table),
        (b"\x93NUMPY\x01\0", Kind::Npy),
        (b"PK\x03\x04", Kind::Npz),
        (b"\x89HDF\r\n\x1a\n", Kind::Hdf5),
        (b"# vtk DataFile Version 4.0\n", Kind::LegacyVtk),
        (b"<?xml version='1.0'?><Xdmf Version='3.0'>", Kind::Xdmf),
        (b"<VTKFile type=\"UnstructuredGrid\">", Kind::Vtu),
        (b"<VTKFile type=\"Collection\">", Kind::Collection),
        (b"<VTKFile byte_order=\"LittleEndian\" type=\"vtkMultiBlockDataSet\">", Kind::Blocks),
        (b"{ \"files\" : [] }", Kind::Series),
    ] {
        assert_eq!(Kind::of_head(head), kind);
    }
    // HDF5 may stand behind a block of its user.
    for (block, kind) in [(512, Kind::Hdf5), (1024, Kind::Hdf5), (2048, Kind::Hdf5), (511, Kind::Table)] {
        let head = [&vec![b' '; block], &b"\x89HDF\r\n\x1a\n"[..]].concat();
        assert_eq!(Kind::of_head(&head), kind, "{block}");
    }
}

/// A document of states, each with what stands in its grid.
fn xdmf_of(states: impl Iterator<Item = String>) -> String {
    let grid = |(number, inside)| format!("<Grid><Time Value=\"{}\"/>{inside}</Grid>\n", number + 1);
    let grids = states.enumerate().map(grid).collect::<Vec<_>>().concat();
    format!("<Xdmf><Domain><Grid GridType=\"Collection\">{grids}</Grid></Domain></Xdmf>")
}

fn pressure_of(item: &str) -> String {
    format!("<Attribute Name=\"p\" Center=\"Node\">{item}</Attribute>")
}

#[test]
fn a_state_without_a_mesh_has_that_of_the_state_before_and_not_of_the_first() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.xdmf");
    let heights = |list: &str| {
        format!("<Geometry Type=\"XY\"><DataItem Dimensions=\"2 2\">{list}</DataItem></Geometry>")
    };
    let own = [heights("0 0 0 1"), heights("0 1 0 0"), String::new()];
    let pressure = pressure_of("<DataItem Dimensions=\"2\">3 0</DataItem>");
    std::fs::write(&path, xdmf_of(own.iter().map(|mesh| format!("{mesh}{pressure}")))).expect("a file");
    let names = all_names();
    let steps = steps_of(&path, &mut Vec::new()).expect("three states");
    let mut heights = Vec::new();
    let taken = read_states(&steps, Wanted(&names), &mut |_, frame| {
        heights.push(frame.coordinates[0][1]);
        Ok(())
    });
    assert!(taken.is_ok());
    assert_eq!(heights, [0.0, 1.0, 1.0]);
}

#[test]
fn a_document_that_declares_more_numbers_than_memory_has_is_refused() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.xdmf");
    let names = all_names();
    // Eight bytes each: 2^64 of them, and one less than may be counted.
    for declared in [1_u64 << 61, u64::MAX] {
        let item = format!("<DataItem Dimensions=\"{declared}\">1</DataItem>");
        std::fs::write(&path, xdmf_of(std::iter::once(pressure_of(&item)))).expect("a file");
        let steps = steps_of(&path, &mut Vec::new()).expect("one state");
        let refused = first_frame(&steps, Wanted(&names)).map(|_| ()).map_err(|error| error.to_string());
        assert!(refused.as_ref().is_err_and(|why| why.contains("it declares")), "{declared}: {refused:?}");
    }
}

#[test]
fn thousands_of_states_of_one_document_are_read() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.xdmf");
    let one = pressure_of("<DataItem Dimensions=\"1\">0.5</DataItem>");
    std::fs::write(&path, xdmf_of((0..5000).map(|_| one.clone()))).expect("a file");
    let names = all_names();
    let steps = steps_of(&path, &mut Vec::new()).expect("states");
    let mut taken = 0;
    let read = read_states(&steps, Wanted(&names), &mut |_, frame| {
        assert_eq!(frame.arrays[0].values, [0.5]);
        taken += 1;
        Ok(())
    });
    assert!(read.is_ok());
    assert_eq!((steps.len(), taken), (5000, 5000));
}

/// As meshio writes: a data set a state, all in one store.
#[test]
fn a_store_of_many_data_sets_is_walked_once() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mut builder = hdf5_pure::FileBuilder::new();
    let sets = 2000;
    for set in 0..sets {
        builder.create_dataset(&format!("data{set}")).with_f64_data(&[f64::from(set), 1.0]);
    }
    builder.write(folder.path().join("a.h5")).expect("a file");
    let mut store = super::hdf5::Store::open(&folder.path().join("a.h5")).expect("a store");
    for set in 0..sets {
        assert_eq!(store.numbers(&format!("/data{set}"), None).expect("there"), [f64::from(set), 1.0]);
    }
    let names = all_names();
    assert_eq!(store.frame(0, Wanted(&names)).expect("a state").arrays.len(), 2000);
    assert_eq!(store.listed, 2000);
    let item = |set: i32| {
        pressure_of(&format!("<DataItem Format=\"HDF\" Dimensions=\"2\">a.h5:/data{set}</DataItem>"))
    };
    let path = folder.path().join("a.xdmf");
    std::fs::write(&path, xdmf_of((0..sets).map(item))).expect("a file");
    let text = std::fs::read_to_string(&path).expect("a file");
    let document = xml::parse(&text).expect("XML");
    let mut reader = xdmf::Reader::of(&path, &document).expect("a document");
    for state in [0, 7, 1999] {
        let frame = reader.frame(state, Wanted(&names)).expect("a state");
        assert_eq!(frame.arrays[0].values, [state as f64, 1.0]);
    }
    assert_eq!(reader.stores.len(), 1);
}

#[cfg(unix)]
#[test]
fn a_document_that_names_a_device_or_a_pipe_is_refused_at_once() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    let names = all_names();
    for file in ["/dev/zero", "pipe", "/dev/stdin"] {
        let item = format!("<DataItem Format=\"HDF\" Dimensions=\"2\">{file}:/p</DataItem>");
        let path = folder.path().join("a.xdmf");
        std::fs::write(&path, xdmf_of(std::iter::once(pressure_of(&item)))).expect("a file");
        let steps = steps_of(&path, &mut Vec::new()).expect("one state");
        let refused = first_frame(&steps, Wanted(&names)).map(|_| ()).map_err(|error| error.to_string());
        // Where the tests' own input is a file, it is a file.
        let is_told = |why: &str| why.contains("a device or a pipe may never end") || file == "/dev/stdin";
        assert!(refused.as_ref().is_err_and(|why| is_told(why)), "{file}: {refused:?}");
    }
}

/// A zip of an array, packed or not, as `NumPy` writes it.
fn npz(is_packed: bool) -> Vec<u8> {
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (4,), }";
    let length = u16::try_from(header.len()).expect("short").to_le_bytes();
    let numbers =
        [0.5_f64, 1.5, 2.5, 3.5].iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let content = [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), &numbers].concat();
    let packed = if is_packed {
        let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(&content).expect("in memory");
        encoder.finish().expect("in memory")
    } else {
        content.clone()
    };
    let size = |bytes: &[u8]| u32::try_from(bytes.len()).expect("small").to_le_bytes();
    let method = [if is_packed { 8_u8 } else { 0 }, 0];
    let name = b"p.npy";
    let about = [
        &method[..],
        &[0; 4],
        &rawzip::crc32(&content).to_le_bytes(),
        &size(&packed),
        &size(&content),
        &[5, 0, 0, 0],
    ]
    .concat();
    let local = [b"PK\x03\x04\x14\x00\x00\x00", &about[..], name, &packed].concat();
    let listed = [b"PK\x01\x02\x14\x00\x14\x00\x00\x00", &about[..], &[0; 14], name].concat();
    let end = [b"PK\x05\x06\0\0\0\0\x01\0\x01\0", &size(&listed)[..], &size(&local), &[0; 2]].concat();
    [local, listed, end].concat()
}

/// A reader of a file's bytes: arrays and coordinates, m.
type Read<'a> = &'a dyn Fn(&[u8]) -> Result<(Vec<super::frame::Array>, Vec<[f64; 3]>), String>;

#[test]
fn one_changed_byte_of_what_has_a_checksum_is_refused_or_changes_nothing() {
    let names = all_names();
    let way = Way {
        format: "appended",
        is_raw: true,
        is_packed: true,
        is_wide: false,
        is_single: false,
        is_big: false,
        block: 64,
    };
    let vtu = way.file(&[0.5, 1.5, 2.5, 3.5]);
    // Behind the underscore stand counts and packed blocks.
    let start = vtu.windows(2).position(|mark| mark == b"\n_").expect("a mark") + 2;
    let end = vtu.windows(3).rposition(|mark| mark == b"\n</").expect("an end") - b"\n</AppendedData>".len();
    let read_vtu =
        |bytes: &[u8]| vtu::read(bytes, Wanted(&names)).map(|frame| (frame.arrays, frame.coordinates));
    let read_npz =
        |bytes: &[u8]| numpy::read_npz(bytes, Wanted(&names)).map(|frame| (frame.arrays, Vec::new()));
    for (what, sound, range, read) in [
        ("VTU", vtu.clone(), start..end, &read_vtu as Read<'_>),
        ("NPZ", npz(false), 0..npz(false).len(), &read_npz),
        ("packed NPZ", npz(true), 0..npz(true).len(), &read_npz),
    ] {
        let expected = read(&sound).expect("a sound file");
        assert_eq!(expected.0[0].values, [0.5, 1.5, 2.5, 3.5], "{what}");
        let mut refused = 0;
        for place in range.clone() {
            for change in [0x01, 0x10, 0x80, 0xff] {
                let mut bytes = sound.clone();
                bytes[place] ^= change;
                match read(&bytes) {
                    Ok(found) => assert_eq!(found, expected, "{what}: byte {place} ^ {change}"),
                    Err(_) => refused += 1,
                }
            }
        }
        assert!(refused > 2 * range.len(), "{what}: {refused} of {}", 4 * range.len());
    }
    // A checksum that is cut off was never held.
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&[7; 100]).expect("in memory");
    let packed = encoder.finish().expect("in memory");
    let unpacked = |bytes: &[u8]| super::bytes::unpack(bytes, 100, true);
    assert_eq!(unpacked(&packed), Ok(vec![7; 100]));
    for cut in 1..=4 {
        assert!(unpacked(&packed[..packed.len() - cut]).is_err_and(|why| why.contains("checksum")), "{cut}");
    }
}

#[test]
fn a_slab_that_leaves_out_rows_or_begins_inside_one_is_refused() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.xdmf");
    let names = all_names();
    let refused = |item: &str| {
        std::fs::write(&path, xdmf_of([pressure_of(item)].into_iter())).expect("a file");
        let steps = steps_of(&path, &mut Vec::new()).expect("one state");
        first_frame(&steps, Wanted(&names)).expect_err("there is no such store").to_string()
    };
    // Start, stride and size along both axes.
    for (slab, is_read) in [
        ("0 0 1 1 2 3", true),
        ("4 0 1 1 2 3", true),
        ("0 1 1 1 2 3", false),
        ("0 0 2 1 2 3", false),
        ("0 0 1 2 2 3", false),
    ] {
        let source = "<DataItem Format=\"HDF\" Dimensions=\"9 3\">gone.h5:/p</DataItem>";
        let item = format!(
            "<DataItem ItemType=\"HyperSlab\" Dimensions=\"2 3\"><DataItem Dimensions=\"3 2\">{slab}</DataItem>{source}</DataItem>"
        );
        let numbers: Vec<&str> = slab.split(' ').collect();
        let after = numbers.chunks(2).map(|pair| pair.join(" ")).collect::<Vec<_>>().join(":");
        let beside = format!("<DataItem Format=\"HDF\" Dimensions=\"2 3\">gone.h5:/p|{after}:9 3</DataItem>");
        for item in [item, beside] {
            let told = refused(&item);
            assert_eq!(told.contains("consecutive whole rows"), !is_read, "{slab}: {told}");
            assert_eq!(told.contains("gone.h5: "), is_read, "{slab}: {told}");
        }
    }
}

#[test]
fn the_time_of_a_state_goes_over_that_of_the_list_which_names_it() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let state = format!("<Grid>{}</Grid>", pressure_of("<DataItem Dimensions=\"1\">3</DataItem>"));
    for (own, wanted) in [("<Time Value=\"2\"/>", 2.0), ("", 7.0)] {
        let state = state.replacen("<Grid>", &format!("<Grid>{own}"), 1);
        std::fs::write(at("a.xdmf"), format!("<Xdmf><Domain>{state}</Domain></Xdmf>")).expect("a file");
        let list = "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"7\" file=\"a.xdmf\"/></Collection></VTKFile>";
        std::fs::write(at("a.pvd"), list).expect("a file");
        let steps = steps_of(&at("a.pvd"), &mut Vec::new()).expect("a state");
        assert_eq!((steps.len(), steps[0].time), (1, Some(wanted)), "{own}");
    }
}
