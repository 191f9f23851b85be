//! Problems of textbooks, printed and scored by the program, and what it refuses.

use crate::program::{Told, call};
use oedometer_exact::TextbookProblem;
use std::fmt::Write;
use std::path::Path;

fn run(words: &str) -> Told {
    call(Path::new("."), &words.split_whitespace().collect::<Vec<_>>())
}

#[test]
fn what_exact_prints_scores_nothing_and_another_soil_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("result.csv");
    for problem in TextbookProblem::NAMES {
        let told = run(&format!("exact {problem} --time-factor 0.05,0.5 --zeta 0.1,0.3,0.5,0.7,0.9"));
        assert_eq!(told.code, 0, "{problem}: {}", told.err);
        assert!(told.err.contains("tail below"), "{problem}: {}", told.err);
        let mut table = String::from("t,y,p,u_y\n");
        for line in told.out.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
            // The default column: c_v = 1.2e6·1e-4/9810 m²/s, H = 1 m, q = 1 Pa.
            let time = cells[0] * 9810.0 / 120.0;
            writeln!(table, "{time:.17e},{},{:e},{:e}", 1.0 - cells[1], cells[2], cells[6]).expect("text");
        }
        std::fs::write(&file, table).expect("a file");
        let score = format!("score {} --scene {problem} --below", file.display());
        let told = run(&format!("{score} 1e-9"));
        assert_eq!(told.code, 0, "{problem}: {}{}", told.out, told.err);
        let told = run(&format!("{score} 1e-7 --set material.hydraulic_conductivity=1.1e-4"));
        assert_eq!(told.code, 1, "{problem}: {}{}", told.out, told.err);
    }
}

#[test]
fn keys_without_effect_are_refused_with_the_problems_that_have_them() {
    for (words, wanted) in [
        (
            "exact barron --set material.biot_coefficient=1",
            "no effect in `barron`: it is for `biot-column`, `cryer`",
        ),
        ("exact barron --set material.water_bulk_modulus=1e9", "its water is incompressible"),
        ("exact cryer --set column.loading_time=1", "acts at once"),
        ("exact cryer --set material.biot_coefficient=stiff", "must be a number, got \"stiff\""),
        ("exact cryer --set material.biot_coefficient=0.1", "between the porosity 0.3 and 1"),
        ("exact injection --zeta 1", "infinite"),
        ("exact cryer --time-factor 1e-9", "too early"),
        ("exact crier", "davis-raymond"),
        ("score x.csv --scene cryer --reference terzaghi", "it is its own"),
    ] {
        let told = run(words);
        assert_eq!(told.code, 2, "{words}: {}", told.err);
        assert!(told.err.contains(wanted), "{words}: {}", told.err);
    }
}
