//! MPM-Geomechanics: files made after its sources (`src/Output.cpp` at 002af18 of `github.com/fabricix/MPM-Geomechanics`).

use crate::score::written_files::{Point, SECONDS, STEPS, points, score};
use std::fmt::Write;
use std::fs;
use tempfile::TempDir;

#[test]
fn mpm_geomechanics_writes_five_digits_z_upward_and_a_pore_pressure_that_is_zero_with_two_phases() {
    let folder = TempDir::new().expect("a folder");
    let mut series = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\" \
         compressor=\"vtkZLibDataCompressor\">\n\t<Collection>\n",
    );
    for (place, step) in STEPS.into_iter().enumerate() {
        let points = points(step);
        let count = points.len();
        let array = |name: &str, components: usize, of: &dyn Fn(&Point) -> String| {
            let name = if name.is_empty() { String::new() } else { format!(" Name=\"{name}\"") };
            let mut text = format!(
                "<DataArray type=\"Float64\"{name} NumberOfComponents=\"{components}\" Format=\"ascii\">\n"
            );
            text.extend(points.iter().map(|point| of(point) + "\n"));
            text + "</DataArray>\n"
        };
        let whole = |name: &str, of: &dyn Fn(usize) -> usize| {
            let numbers: String = (0..count).map(|point| of(point).to_string() + "\n").collect();
            format!("<DataArray type=\"UInt64\" Name=\"{name}\" Format=\"ascii\">\n{numbers}</DataArray>\n")
        };
        let text = [
            format!(
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
                 <UnstructuredGrid>\n<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\">\n<Points>\n"
            ),
            array("", 3, &|point| format!("{:.4e} 0.0000e+00 {:.4e}", point.now()[0], point.now()[1])),
            "</Points>\n<PointData>\n".to_owned(),
            array("Pressure", 1, &|point| format!("{:.4e}", point.fields.pressure)),
            array("Pore Pressure", 1, &|_| "0.0000e+00".to_owned()),
            array("Displacement", 3, &|point| format!("0.0 0.0 {:.4e}", point.fields.displacement)),
            array("Stress_ZZ", 1, &|point| format!("{:.4e}", point.fields.effective_stress)),
            "</PointData>\n<Cells>\n".to_owned(),
            whole("connectivity", &|point| point),
            whole("offsets", &|point| point + 1),
            whole("types", &|_| 1),
            "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n".to_owned(),
        ];
        let name = format!("particles_{}.vtu", place + 1);
        fs::write(folder.path().join(&name), text.concat()).expect("a file");
        let time = step as f64 * SECONDS;
        writeln!(series, "\t\t<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{name}\"/>")
            .expect("text");
    }
    fs::write(folder.path().join("particleTimeSerie.pvd"), series + "\t</Collection>\n</VTKFile>\n")
        .expect("a file");
    let gate = ["--preset", "mpm-geomechanics", "--below", "1e-3"];
    let told = score(folder.path(), &["particleTimeSerie.pvd"], &gate);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    assert!(told.out.contains("effective_stress") && told.out.contains("pressure"), "{}", told.out);
}
