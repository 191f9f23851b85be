//! Attached solvers of scenes in the plane: a slab between plates, and a layer whose fields vary along it.
#![cfg(unix)]

use crate::program::{PROGRAM, call};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The exact pressures of the slab, a hundredth too large.
const SLAB: &str = r#"
"$2" exact mandel --time-factor 0.1 --x 0,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1 2>/dev/null |
    awk -F, 'BEGIN { print "t,x,p" } NR > 1 { printf "8.175,%s,%.17g\n", $2, 1.01 * $3 }' > "$1/result.csv"
"#;

/// Nodes of a square of ten cells each way, up to a distance from the crest; the surface under the crest goes down by
/// 1 µm.
const LAYER: &str = r#"
awk -v last="$2" 'BEGIN {
    print "t,x,y,p,u_x,u_y"
    for (i = 0; i <= last; i++) for (j = 0; j <= 10; j++)
        printf "8.175,%.17g,%.17g,%.17g,0,%.17g\n", i / 10, j / 10, 0.01 * (10 - j), -1e-7 * j * (10 - i) / 10
}' > "$1/result.csv"
"#;

fn write(at: &Path, scene: &str, command: &str, columns: &str, adapter: &str) {
    let study = format!(
        "title = \"In the plane\"\nscene = \"{scene}\"\noutput.time_factors = [0.1]\n[[solver]]\nname = \"own\"\n\
         command = [\"sh\", \"adapter.sh\", \"{{out}}\", {command}]\nresult = \"{{out}}/result.csv\"\n\
         mapping = \"map.toml\"\n[[sweep]]\nmethod = [\"own\"]\ncells = [10]\n"
    );
    let names: Vec<String> = columns.split_whitespace().map(|name| format!("{name} = \"{name}\"")).collect();
    let names = names.join("\n") + "\n";
    let signs =
        "[sign]\ny = \"up\"\np = \"compression-positive\"\nu_y = \"up\"\nx = \"right\"\nu_x = \"right\"\n";
    let mapping = format!("sample = \"nodes\"\n[columns]\n{names}{signs}");
    for (name, text) in [("s.toml", study.as_str()), ("map.toml", &mapping), ("adapter.sh", adapter)] {
        fs::write(at.join(name), text).expect("a file");
    }
}

/// Errors of the one case by quantity, of the L2 norm or of a settlement.
fn errors(at: &Path) -> Vec<(String, f64)> {
    let text = fs::read_to_string(at.join("out/s/s.csv")).expect("a table");
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let place = |name: &str| head.iter().position(|column| *column == name).expect(name);
    let (quantity, norm, value) = (place("quantity"), place("norm"), place("value"));
    let rows = lines.map(|line| line.split(',').collect::<Vec<_>>());
    let main = rows.filter(|row| ["l2", "relative"].contains(&row[norm]));
    main.map(|row| (row[quantity].to_owned(), row[value].parse().expect("a number"))).collect()
}

#[test]
fn a_slab_counts_from_its_middle_and_its_settlement_is_no_samples() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    write(at, "mandel", &format!("\"{PROGRAM}\""), "t x p", SLAB);
    let told = call(at, &["run", "s.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let found = errors(at);
    assert!(
        matches!(&found[..], [(name, error)] if name == "pressure" && (error - 0.01).abs() < 1e-9),
        "{found:?}"
    );
    // A displacement along the slab is none of its plate.
    let moved = SLAB.replace("t,x,p", "t,x,p,u_x").replace("%.17g\\n\"", "%.17g,0\\n\"");
    write(at, "mandel", &format!("\"{PROGRAM}\""), "t x p u_x", &moved);
    assert_eq!(call(at, &["run", "s.toml"]).code, 0);
    assert!(errors(at).iter().all(|(name, _)| name != "settlement"), "{:?}", errors(at));
    let plan = call(at, &["plan", "s.toml", "--format", "json"]);
    assert!(
        plan.out.contains("from the middle of the slab") && plan.out.contains("slab between rigid plates")
    );
}

#[test]
fn a_layer_has_places_along_it_and_lacks_none() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    write(at, "cosine-layer", "\"10\"", "t x y p u_x u_y", LAYER);
    let told = call(at, &["run", "s.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let of = |name: &str| errors(at).into_iter().filter(|(quantity, _)| quantity == name).count();
    // Against compressible and incompressible water.
    assert_eq!((of("pressure"), of("displacement"), of("settlement")), (2, 2, 2), "{:?}", errors(at));
    assert!(call(at, &["plan", "s.toml", "--format", "json"]).out.contains("the crest of the load"));
    write(at, "cosine-layer", "\"1\"", "t x y p u_x u_y", LAYER);
    let told = call(at, &["run", "s.toml"]);
    assert!(
        told.code == 3 && told.err.contains("no sample lies between the distances 0.1 m and 1 m"),
        "{}",
        told.err
    );
    // Without the place along it nothing can be held against anything.
    write(at, "cosine-layer", "\"10\"", "t y p", LAYER);
    let told = call(at, &["run", "s.toml"]);
    assert!(told.code != 0 && told.err.contains("`x`"), "{}", told.err);
}
