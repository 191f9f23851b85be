//! Functions for Python. Each calls `oedometer::api` and computes nothing.
//!
//! Lists of numbers are passed as bytes of native doubles, which any buffer of Python has, and structured values as JSON.
//! The module `oedometer` around this one gives them shapes and names.

use oedometer::api::convergence::Demand;
use oedometer::api::error::ApiError;
use oedometer::api::score::Samples;
use oedometer::api::{self, Meaning};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// Bytes to doubles.
fn doubles(bytes: &[u8]) -> Vec<f64> {
    let (chunks, _) = bytes.as_chunks::<8>();
    chunks.iter().map(|chunk| f64::from_ne_bytes(*chunk)).collect()
}

/// Doubles to bytes.
fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyBytes> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
    PyBytes::new(py, &bytes)
}

#[expect(clippy::needless_pass_by_value, reason = "it stands in `map_err`, which hands over the error")]
fn refused(why: impl ToString) -> PyErr {
    PyValueError::new_err(why.to_string())
}

/// Calls the interface without the lock of the interpreter. What it refuses is a `ValueError`; a panic, which would be a
/// fault of this program, is a `RuntimeError` and never the end of the interpreter.
fn call<T: Send>(py: Python<'_>, of: impl FnOnce() -> Result<T, ApiError> + Send) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(of))) {
        Ok(found) => found.map_err(refused),
        Err(_) => Err(PyRuntimeError::new_err(
            "oedometer failed at these inputs, which is a fault of it: please report it",
        )),
    }
}

fn json(value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(refused)
}

/// Assignments of bare names with their tables, as for `--set`.
fn assignments(scene: &str, inputs: Vec<(String, String)>) -> PyResult<Vec<String>> {
    let of = |(name, value): (String, String)| {
        api::dotted_key(scene, &name).map(|key| format!("{key}={value}")).map_err(refused)
    };
    inputs.into_iter().map(of).collect()
}

/// Names and bytes of the fields of an exact solution.
#[pyfunction]
fn exact<'py>(
    py: Python<'py>,
    solution: &str,
    time_factors: &[u8],
    depths: &[u8],
    x: &[u8],
    inputs: Vec<(String, String)>,
) -> PyResult<Vec<(&'static str, Bound<'py, PyBytes>)>> {
    let assignments = assignments(solution, inputs)?;
    let (time_factors, depths, x) = (doubles(time_factors), doubles(depths), doubles(x));
    let found = call(py, || api::exact::exact(solution, &time_factors, &depths, &x, &assignments))?;
    Ok(vec![
        ("time", bytes(py, &found.time)),
        ("pressure", bytes(py, &found.pressure)),
        ("effective_stress", bytes(py, &found.effective_stress)),
        ("displacement", bytes(py, &found.displacement)),
        ("horizontal_displacement", bytes(py, &found.horizontal_displacement)),
        ("settlement", bytes(py, &found.settlement)),
        ("degree_of_consolidation", bytes(py, &found.degree_of_consolidation)),
        ("tail_bound", bytes(py, &found.tail_bound)),
        ("scales", bytes(py, &[found.height, found.load])),
    ])
}

/// The score of samples as JSON; `lists` are in the order of the fields of `Samples`.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "Python hands over owned lists")]
fn score(
    py: Python<'_>,
    scene: &str,
    lists: Vec<Vec<u8>>,
    sample: &str,
    reference: Option<&str>,
    inputs: Vec<(String, String)>,
) -> PyResult<String> {
    let assignments = assignments(scene, inputs)?;
    let lists: Vec<Vec<f64>> = lists.iter().map(|list| doubles(list)).collect();
    let [
        time,
        height,
        distance,
        volume,
        pressure,
        effective_stress,
        displacement,
        horizontal_displacement,
        settlement,
    ] = &lists[..]
    else {
        return Err(refused(format!("{} lists for 9", lists.len())));
    };
    let samples = Samples {
        time,
        height,
        distance,
        volume,
        pressure,
        effective_stress,
        displacement,
        horizontal_displacement,
        settlement,
    };
    json(&call(py, || api::score::score(scene, &samples, sample, reference, &assignments))?)
}

/// Preset, mapping file, text of a mapping, time step and cells of files.
type Given = (Option<String>, Option<PathBuf>, Option<String>, Option<f64>, Vec<usize>);

/// Names and scores of files as JSON, one per mesh.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "Python hands over owned lists")]
fn score_files(
    py: Python<'_>,
    scene: &str,
    files: Vec<PathBuf>,
    meaning: Given,
    reference: Option<&str>,
    inputs: Vec<(String, String)>,
) -> PyResult<String> {
    let assignments = assignments(scene, inputs)?;
    let (preset, mapping, mapping_text, time_step, cells) = meaning;
    let meaning = Meaning { preset, mapping, mapping_text, time_step, cells };
    json(&call(py, || api::score::score_files(scene, &files, &meaning, reference, &assignments))?)
}

/// The case file of a scene as JSON.
#[pyfunction]
fn case(
    py: Python<'_>,
    scene: &str,
    cells: usize,
    time_factors: &[u8],
    inputs: Vec<(String, String)>,
) -> PyResult<String> {
    let assignments = assignments(scene, inputs)?;
    let time_factors = doubles(time_factors);
    call(py, || api::score::case_file(scene, cells, &time_factors, &assignments))
}

/// Class and orders of errors as JSON.
#[pyfunction]
fn convergence(py: Python<'_>, sizes: &[u8], errors: &[u8], formal_order: Option<f64>) -> PyResult<String> {
    let (sizes, errors) = (doubles(sizes), doubles(errors));
    json(&call(py, || api::convergence::convergence(&sizes, &errors, formal_order))?)
}

/// Whether errors meet a demand, and the reason.
#[pyfunction]
fn verdict(
    py: Python<'_>,
    sizes: &[u8],
    errors: &[u8],
    order: Option<(f64, f64, f64)>,
    at: Option<(f64, f64)>,
    class: Option<String>,
) -> PyResult<(bool, String)> {
    let demand = Demand { order, at, class };
    let (sizes, errors) = (doubles(sizes), doubles(errors));
    call(py, || api::convergence::verdict(&sizes, &errors, &demand))
}

/// Runs a command line, beginning with the program's name, and returns the exit code.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| oedometer::main_with(words))
}

/// The module behind `oedometer`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(exact, module)?)?;
    module.add_function(wrap_pyfunction!(score, module)?)?;
    module.add_function(wrap_pyfunction!(score_files, module)?)?;
    module.add_function(wrap_pyfunction!(case, module)?)?;
    module.add_function(wrap_pyfunction!(convergence, module)?)?;
    module.add_function(wrap_pyfunction!(verdict, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)
}
