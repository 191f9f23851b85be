//! How fast somebody else's file is read, and in how much memory: `cargo bench --bench reading`.
//!
//! Writes VTU files of a million points (a plate of a thousand cells each way: places, pressure, displacement, cells),
//! raw, base64 and packed by zlib, and reads each in a process of its own, so that the peak of its memory is the
//! reading's. `cargo bench --bench reading -- POINTS` takes another number of points.

#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use oedometer::api::read;
use std::fmt::Write as _;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Set in the process that reads one file.
const ONE: &str = "OEDOMETER_READS_ONE";

/// How the arrays of a file are written.
#[derive(Clone, Copy)]
enum Way {
    Text,
    Raw,
    Base64,
    Packed,
}

fn main() {
    if let Some(path) = std::env::var_os(ONE) {
        return read_one(&PathBuf::from(path));
    }
    let points = std::env::args().find_map(|word| word.parse().ok()).unwrap_or(1_000_000);
    let folder = tempfile::TempDir::new().expect("a folder");
    println!(
        "{:8} {:>9} {:>8} {:>10} {:>9} {:>9} {:>9}",
        "way", "points", "MB", "seconds", "peak MB", "peak/file", "peak/data"
    );
    let ways = [("text", Way::Text), ("raw", Way::Raw), ("base64", Way::Base64), ("zlib", Way::Packed)];
    let mut of_data = 1.0;
    for (name, way) in ways.into_iter().skip(1).chain(ways.into_iter().take(1)) {
        let path = folder.path().join(format!("{name}.vtu"));
        write(&path, points, way).expect("a file");
        let told = Command::new(std::env::current_exe().expect("this program")).env(ONE, &path).output();
        let told = String::from_utf8(told.expect("it starts").stdout).expect("words");
        let numbers: Vec<f64> = told.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [rows, seconds, peak] = numbers[..] else { panic!("no numbers: {told}") };
        let megabytes = fs::metadata(&path).expect("a file").len() as f64 / 1e6;
        if matches!(way, Way::Raw) {
            of_data = megabytes;
        }
        println!(
            "{name:8} {rows:>9} {megabytes:>8.1} {seconds:>10.3} {peak:>9.1} {:>9.2} {:>9.2}",
            peak / megabytes,
            peak / of_data
        );
    }
}

/// Reads a file and prints rows, seconds, and the peak of this process's memory beyond what it had, MB.
fn read_one(path: &Path) {
    let before = peak_megabytes();
    let start = Instant::now();
    let meshes = read(&[path.to_owned()], "meshio", Some(1.0), 1.0).expect("a state");
    let seconds = start.elapsed().as_secs_f64();
    let rows: usize = meshes.iter().flatten().map(|state| state.pressure.len()).sum();
    println!("{rows} {seconds} {}", peak_megabytes() - before);
}

/// Largest memory of this process so far, MB; 0 where the system does not tell.
fn peak_megabytes() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or("0 kB");
    line.trim().trim_end_matches(" kB").trim().parse::<f64>().unwrap_or(0.0) * 1024.0 / 1e6
}

/// Writes a plate of square cells as VTU.
fn write(path: &Path, points: usize, way: Way) -> std::io::Result<()> {
    let across = points.isqrt();
    let (rows, cells) = (across, (across - 1) * (across - 1));
    let at = |place: usize| (place % across) as f64 / (across - 1) as f64;
    let height = |place: usize| (place / across) as f64 / (rows - 1) as f64;
    let all = across * rows;
    let floats = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<u8> {
        (0..all).flat_map(of).flat_map(f64::to_le_bytes).collect()
    };
    let corners = |cell: usize| {
        let first = cell / (across - 1) * across + cell % (across - 1);
        [first, first + 1, first + across + 1, first + across]
    };
    let integer = |number: usize| i64::try_from(number).expect("few").to_le_bytes();
    let arrays: [(&str, &str, &str, usize, Vec<u8>); 6] = [
        (
            "PointData",
            "pressure",
            "Float64",
            1,
            floats(&|place| vec![1.0 - height(place) + 1e-3 * at(place)]),
        ),
        ("PointData", "displacement", "Float64", 3, floats(&|place| vec![0.0, -1e-6 * height(place), 0.0])),
        ("Points", "Points", "Float64", 3, floats(&|place| vec![at(place), height(place), 0.0])),
        ("Cells", "connectivity", "Int64", 1, (0..cells).flat_map(corners).flat_map(integer).collect()),
        ("Cells", "offsets", "Int64", 1, (1..=cells).flat_map(|cell| integer(4 * cell)).collect()),
        ("Cells", "types", "UInt8", 1, vec![9; cells]),
    ];
    let mut appended = Vec::new();
    let mut text = String::new();
    for (section, name, kind, components, bytes) in arrays {
        if matches!(way, Way::Text) {
            writeln!(
                text,
                "<{section}><DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                 format=\"ascii\">{}</DataArray></{section}>",
                written(kind, &bytes)
            )
            .expect("in memory");
            continue;
        }
        writeln!(
            text,
            "<{section}><DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/></{section}>",
            appended.len()
        )
        .expect("in memory");
        appended.extend(payload(&bytes, way));
    }
    let packer = if matches!(way, Way::Packed) { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
    let encoding = if matches!(way, Way::Base64) { "base64" } else { "raw" };
    let mut file = fs::File::create(path)?;
    write!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\"{packer}>\n<UnstructuredGrid><Piece NumberOfPoints=\"{all}\" \
         NumberOfCells=\"{cells}\">\n{text}</Piece></UnstructuredGrid>\n"
    )?;
    if matches!(way, Way::Text) {
        return file.write_all(b"</VTKFile>\n");
    }
    write!(file, "<AppendedData encoding=\"{encoding}\">\n_")?;
    file.write_all(&appended)?;
    file.write_all(b"\n</AppendedData></VTKFile>\n")
}

/// Numbers of an array as a text, ten a line.
fn written(kind: &str, bytes: &[u8]) -> String {
    let mut text = String::new();
    let mut add = |place: usize, number: &dyn std::fmt::Display| {
        let space = if place % 10 == 9 { '\n' } else { ' ' };
        write!(text, "{number}{space}").expect("in memory");
    };
    match kind {
        "UInt8" => bytes.iter().enumerate().for_each(|(place, number)| add(place, number)),
        "Int64" => {
            let numbers = bytes.as_chunks::<8>().0.iter().map(|bytes| i64::from_le_bytes(*bytes));
            numbers.enumerate().for_each(|(place, number)| add(place, &number));
        }
        _ => {
            let numbers = bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
            numbers.enumerate().for_each(|(place, number)| add(place, &number));
        }
    }
    text
}

/// Bytes of an array with their header.
fn payload(bytes: &[u8], way: Way) -> Vec<u8> {
    let number = |number: usize| (number as u64).to_le_bytes();
    match way {
        Way::Text | Way::Raw => [&number(bytes.len())[..], bytes].concat(),
        Way::Base64 => base64(&[&number(bytes.len())[..], bytes].concat()),
        Way::Packed => {
            let block = 1 << 15;
            let packed: Vec<Vec<u8>> = bytes.chunks(block).map(packed).collect();
            let head = [packed.len(), block, bytes.len() % block];
            let sizes = packed.iter().map(Vec::len);
            let head: Vec<u8> = head.into_iter().chain(sizes).flat_map(number).collect();
            [head, packed.concat()].concat()
        }
    }
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).expect("in memory");
    encoder.finish().expect("in memory")
}

fn base64(bytes: &[u8]) -> Vec<u8> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = Vec::with_capacity(bytes.len() / 3 * 4 + 4);
    for chunk in bytes.chunks(3) {
        let word =
            chunk.iter().chain([&0, &0]).take(3).fold(0_usize, |word, byte| (word << 8) | usize::from(*byte));
        for digit in 0..4 {
            text.push(if digit <= chunk.len() { DIGITS[(word >> (18 - 6 * digit)) & 63] } else { b'=' });
        }
    }
    text
}
