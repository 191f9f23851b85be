//! Real files of other programs, damaged on purpose: never a panic, never more memory or time than their size allows.
//!
//! A hundred cases, always the same, run with every test. Thousands of every program's files, other ones each time:
//! `cargo test --release --test damaged_files -- --ignored`; `DAMAGED_CASES` says how many of each.

use oedometer::api::read;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use tempfile::TempDir;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// The counter is the whole process's: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Bytes that reading may allocate in all, one after the other, whatever a small file claims.
const ANY: usize = 96 << 20;
/// And for each byte of its files: deflate packs a thousand bytes into one.
const PER_BYTE: usize = 2500;
/// No file of some kilobytes takes longer on the slowest machine.
const LONGEST: Duration = Duration::from_secs(60);
/// Cases of each family in every test.
const FEW: u32 = 15;
/// Cases of each family in the long test, where nobody says how many.
const MANY: u32 = 20_000;

/// A result of a program: its folder, what is read of it, and how.
struct Family {
    folder: &'static str,
    read: &'static str,
    preset: &'static str,
    time_step: Option<f64>,
}

const fn family(folder: &'static str, read: &'static str, preset: &'static str) -> Family {
    Family { folder, read, preset, time_step: None }
}

const FAMILIES: [Family; 24] = [
    family("ogs", "col.pvd", "ogs"),
    family("ogs-xdmf", "col_bulk.xdmf", "ogs"),
    family("ogs-xdmf", "col.h5", "meshio"),
    Family { time_step: Some(0.08175), ..family("kratos-vtk", "*.vtk", "kratos") },
    family("kratos-vtu", "PorousDomain.porous_computational_model_part.vtm.series", "kratos"),
    family("porepy", "col.pvd", "porepy"),
    family("geotaichi/particles", "*.npz", "geotaichi"),
    Family { time_step: Some(2.0), ..family("geotaichi", "*.vtu", "geotaichi") },
    family("dolfinx", "column.xdmf", "meshio"),
    family("dolfinx", "all.pvd", "meshio"),
    family("mfem", "column.pvd", "meshio"),
    Family { time_step: Some(8.175), ..family("getfem", "p_1.vtu", "meshio") },
    Family { time_step: Some(8.175), ..family("getfem", "p_1.pos", "meshio") },
    Family { time_step: Some(8.175), ..family("freefem", "bin_1.vtk", "meshio") },
    family("formats", "col.nc", "meshio"),
    family("formats", "transient.vtkhdf", "meshio"),
    family("formats", "fenics.xdmf", "meshio"),
    family("formats", "series.xdmf", "meshio"),
    family("formats", "col_0.e", "meshio"),
    family("formats", "col_0.msh", "meshio"),
    family("formats", "col_0_22.msh", "meshio"),
    family("pylith", "step.h5", "meshio"),
    family("pylith", "step.xmf", "meshio"),
    Family { time_step: Some(8.175), ..family("celltypes", "lag_1.vtu", "meshio") },
];

/// One damage to a file.
#[derive(Clone, Debug)]
enum Damage {
    /// A byte becomes another.
    Flip(f64, u8),
    /// The file ends here.
    Cut(f64),
    /// A written number becomes huge, negative, or none.
    Inflate(f64, &'static str),
    /// Eight bytes become a huge number: of bytes, blocks, members, offsets.
    Widen(f64, u64),
    /// Two words change places: tags, keywords, names.
    Swap(f64, f64),
    /// A stretch is gone, doubled, or zero.
    Drop(f64, usize),
    Repeat(f64, usize),
    Blank(f64, usize),
}

fn damages() -> impl Strategy<Value = Damage> {
    let at = || 0.0..1.0_f64;
    let numbers = ["9999999999", "18446744073709551615", "-1", "nan", "1e999", "0", "4294967296", ""];
    let wide = [0, 1, 1 << 20, 10_000_000_000, 1 << 32, u64::MAX, u64::MAX / 8, 1 << 62];
    prop_oneof![
        3 => (at(), any::<u8>()).prop_map(|(at, byte)| Damage::Flip(at, byte)),
        1 => at().prop_map(Damage::Cut),
        3 => (at(), prop::sample::select(numbers.to_vec())).prop_map(|(at, text)| Damage::Inflate(at, text)),
        3 => (at(), prop::sample::select(wide.to_vec())).prop_map(|(at, number)| Damage::Widen(at, number)),
        2 => (at(), at()).prop_map(|(one, other)| Damage::Swap(one, other)),
        1 => (at(), 1..200_usize).prop_map(|(at, length)| Damage::Drop(at, length)),
        1 => (at(), 1..200_usize).prop_map(|(at, length)| Damage::Repeat(at, length)),
        1 => (at(), 1..64_usize).prop_map(|(at, length)| Damage::Blank(at, length)),
    ]
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
fn place(share: f64, length: usize) -> usize {
    ((length as f64 * share) as usize).min(length.saturating_sub(1))
}

/// Stretches of letters and digits that a test holds of.
fn words(bytes: &[u8], is_of: impl Fn(u8) -> bool) -> Vec<(usize, usize)> {
    let mut words = Vec::new();
    let mut start = None;
    for (at, byte) in bytes.iter().chain([&b' ']).enumerate() {
        match (start, is_of(*byte)) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                words.push((from, at));
                start = None;
            }
            _ => {}
        }
    }
    words
}

impl Damage {
    fn done(&self, bytes: &mut Vec<u8>) {
        let length = bytes.len();
        if length == 0 {
            return;
        }
        match *self {
            Self::Flip(at, byte) => bytes[place(at, length)] = byte,
            Self::Cut(at) => bytes.truncate(place(at, length)),
            Self::Inflate(at, text) => {
                let numbers = words(bytes, |byte| byte.is_ascii_digit());
                if let Some((from, to)) = numbers.get(place(at, numbers.len())).copied() {
                    bytes.splice(from..to, text.bytes());
                }
            }
            Self::Widen(at, number) => {
                let from = place(at, length);
                let to = (from + 8).min(length);
                bytes[from..to].copy_from_slice(&number.to_le_bytes()[..to - from]);
            }
            Self::Swap(one, other) => {
                let all = words(bytes, |byte| byte.is_ascii_alphabetic());
                if all.is_empty() {
                    return;
                }
                let (a, b) = (all[place(one, all.len())], all[place(other, all.len())]);
                let (first, second) = (a.min(b), a.max(b));
                let (of_first, of_second) =
                    (bytes[first.0..first.1].to_vec(), bytes[second.0..second.1].to_vec());
                bytes.splice(second.0..second.1, of_first);
                bytes.splice(first.0..first.1, of_second);
            }
            Self::Drop(at, many) => {
                let from = place(at, length);
                bytes.drain(from..(from + many).min(length));
            }
            Self::Repeat(at, many) => {
                let from = place(at, length);
                let twice = bytes[from..(from + many).min(length)].to_vec();
                bytes.splice(from..from, twice);
            }
            Self::Blank(at, many) => {
                let from = place(at, length);
                bytes[from..(from + many).min(length)].fill(0);
            }
        }
    }
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> =
        entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect();
    files.sort();
    files
}

/// A copy of the files of all programs.
struct Copies {
    root: TempDir,
}

impl Copies {
    fn new() -> Self {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign");
        let root = TempDir::new().expect("a folder");
        for file in files_below(&source) {
            let copy = root.path().join(file.strip_prefix(&source).expect("below"));
            fs::create_dir_all(copy.parent().expect("a folder")).expect("a folder");
            fs::copy(&file, copy).expect("a file");
        }
        Self { root }
    }

    fn files(&self, family: &Family) -> Vec<PathBuf> {
        files_below(&self.root.path().join(family.folder))
    }

    fn read(&self, family: &Family) -> Result<usize, String> {
        let entry = self.root.path().join(family.folder).join(family.read);
        let meshes =
            read(&[entry], family.preset, family.time_step, 1.0).map_err(|error| error.to_string())?;
        Ok(meshes.iter().flatten().map(|state| state.initial_height.len()).sum())
    }

    /// Reads a family with one file damaged.
    fn damaged(&self, family: &Family, share: f64, damages: &[Damage]) -> Result<(), TestCaseError> {
        let files = self.files(family);
        let path = &files[place(share, files.len())];
        let whole = fs::read(path).expect("a file");
        let mut bytes = whole.clone();
        for damage in damages {
            damage.done(&mut bytes);
        }
        fs::write(path, &bytes).expect("a file");
        let all: u64 = files.iter().map(|file| fs::metadata(file).map_or(0, |told| told.len())).sum();
        let bound = ANY + PER_BYTE * usize::try_from(all).expect("small");
        let (region, started) = (Region::new(ALLOCATOR), Instant::now());
        let found = std::panic::catch_unwind(|| self.read(family));
        let (taken, allocated) = (started.elapsed(), region.change().bytes_allocated);
        fs::write(path, &whole).expect("a file");
        let name = path.display();
        prop_assert!(found.is_ok(), "{name}: a panic");
        prop_assert!(taken < LONGEST, "{name}: {taken:?}");
        prop_assert!(allocated < bound, "{name}: {allocated} bytes allocated, {bound} allowed");
        if let Ok(Err(sentence)) = found {
            prop_assert!(sentence.len() > 10, "{name}: `{sentence}` says nothing");
        }
        Ok(())
    }
}

/// Damages the files of every family so many times.
fn damage_all(cases: u32, runner_of: impl Fn(Config) -> TestRunner) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let copies = Copies::new();
    for family in &FAMILIES {
        let config = Config { cases, failure_persistence: None, ..Config::default() };
        let which = (0.0..1.0_f64, prop::collection::vec(damages(), 1..4));
        let run = runner_of(config).run(&which, |(share, damages)| copies.damaged(family, share, &damages));
        run.unwrap_or_else(|error| panic!("{}: {error}", family.folder));
    }
}

#[test]
fn every_family_is_read_where_nothing_is_damaged() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let copies = Copies::new();
    for family in &FAMILIES {
        let rows = copies.read(family).unwrap_or_else(|error| panic!("{}: {error}", family.folder));
        assert!(rows >= 18, "{}: {rows} rows", family.folder);
    }
}

#[test]
fn damaged_files_are_refused_within_bounds() {
    damage_all(FEW, |config| {
        TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
    });
}

#[test]
#[ignore = "minutes: thousands of cases, for an optimised program"]
fn thousands_of_damaged_files_are_refused_within_bounds() {
    let asked = std::env::var("DAMAGED_CASES").ok().and_then(|typed| typed.parse().ok());
    damage_all(asked.unwrap_or(MANY), TestRunner::new);
}

#[test]
fn claims_of_ten_gigabytes_and_bombs_allocate_next_to_nothing() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = TempDir::new().expect("a folder");
    for (name, bytes) in bombs() {
        let path = folder.path().join(name);
        fs::write(&path, &bytes).expect("a file");
        let region = Region::new(ALLOCATOR);
        let refused = read(&[path], "meshio", Some(1.0), 1.0).expect_err(name);
        let allocated = region.change().bytes_allocated;
        assert!(allocated < (32 << 20), "{name}: {allocated} bytes allocated; {refused}");
        let refused = refused.to_string();
        assert!(
            refused.contains("claim") || refused.contains("cut") || refused.contains("hold"),
            "{refused}"
        );
    }
}

/// Bytes of nothing but zeros, packed by zlib, and as an array of `NumPy` by deflate, which has the same length.
fn packed_zeros(length: usize) -> (Vec<u8>, Vec<u8>) {
    use flate2::Compression;
    use std::io::Write;
    let mut zeros = vec![0_u8; length];
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), Compression::best());
    zlib.write_all(&zeros).expect("in memory");
    let head = b"\x93NUMPY\x01\0\x76\0{'descr': '<f8', 'fortran_order': False, 'shape': (1000000,), }";
    zeros[..head.len()].copy_from_slice(head);
    let mut bare = flate2::write::DeflateEncoder::new(Vec::new(), Compression::best());
    bare.write_all(&zeros).expect("in memory");
    (zlib.finish().expect("in memory"), bare.finish().expect("in memory"))
}

/// Files that are small and claim or hold much.
fn bombs() -> Vec<(&'static str, Vec<u8>)> {
    let block = 8 << 20;
    let (zlib, bare) = packed_zeros(block);
    vec![
        ("many-blocks.vtu", vtu_of_blocks(&zlib, block, 64)),
        ("claimed.vtu", vtu_of_blocks(&zlib[..100], 10_000_000_000, 1)),
        ("overlapping.npz", npz_of_one_member_many_times(&bare, block, 64)),
        ("claimed.npz", npz_of_one_member_many_times(&bare[..100], 4_000_000_000, 1)),
    ]
}

/// A VTU whose places are packed blocks, all alike.
fn vtu_of_blocks(packed: &[u8], block: usize, blocks: usize) -> Vec<u8> {
    let head: Vec<u64> =
        [blocks, block, 0].into_iter().chain(vec![packed.len(); blocks]).map(|size| size as u64).collect();
    let text = format!(
        "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\
         <UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" \
         Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>\
         </UnstructuredGrid><AppendedData encoding=\"raw\">_",
        block / 24 * blocks
    );
    let head = head.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    [text.into_bytes(), head, packed.repeat(blocks), b"</AppendedData></VTKFile>".to_vec()].concat()
}

/// A zip whose list names the same packed bytes many times.
fn npz_of_one_member_many_times(packed: &[u8], size: usize, members: u16) -> Vec<u8> {
    let narrow = |number: usize| u32::try_from(number).expect("small").to_le_bytes();
    let local = [&b"PK\x03\x04"[..], &[0; 22], &1_u16.to_le_bytes(), &[0; 2], b"p", packed].concat();
    let entry = [
        &b"PK\x01\x02"[..],
        &[0; 6],
        &8_u16.to_le_bytes(),
        &[0; 8],
        &narrow(packed.len()),
        &narrow(size),
        &1_u16.to_le_bytes(),
        &[0; 16],
        b"p",
    ]
    .concat();
    let list = entry.repeat(usize::from(members));
    let end = [
        &b"PK\x05\x06"[..],
        &[0; 4],
        &members.to_le_bytes(),
        &members.to_le_bytes(),
        &narrow(list.len()),
        &narrow(local.len()),
        &[0; 2],
    ]
    .concat();
    [local, list, end].concat()
}
