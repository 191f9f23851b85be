//! The problems of textbooks against values of 40 digits, their limits, and what they refuse.

use oedometer_exact::{
    ColumnParameters, ExactError, Reference, ReferenceKind, TextbookParameters, TextbookProblem,
};
use oedometer_soil::material::Material;

/// The cases of `crates/exact/tests/reference/make_textbook.py`.
fn column(case: &str) -> ColumnParameters {
    let (seed, textbook) = (ColumnParameters::default(), TextbookParameters::default());
    let (biot_coefficient, grain_bulk_modulus) = (Some(0.8), Some(3e6));
    let (water_bulk_modulus, textbook) = match case {
        "soft" => (6e5, textbook),
        "biot" => (2e6, TextbookParameters { biot_coefficient, grain_bulk_modulus, ..textbook }),
        "stiff-grains" => (2.2e9, TextbookParameters { grain_bulk_modulus: Some(2.5e6), ..textbook }),
        "wide-drain" => (2.2e9, TextbookParameters { drain_radius: 0.5, ..textbook }),
        "slow-wave" => {
            (2e6, TextbookParameters { wave_period: 600.0, biot_coefficient: Some(0.7), ..textbook })
        }
        "small-load" => (2.2e9, TextbookParameters { initial_stress: Some(50.0), ..textbook }),
        _ => (2.2e9, textbook),
    };
    ColumnParameters { soil: Material { water_bulk_modulus, ..seed.soil }, textbook, ..seed }
}

fn reference(problem: TextbookProblem, column: &ColumnParameters) -> Reference {
    Reference::new(ReferenceKind::Textbook(problem), column, &[]).expect("a possible problem")
}

/// Pressure, stress, displacement and settlement as the table has them.
fn ratios(reference: &Reference, column: &ColumnParameters, time: f64, zeta: f64) -> [f64; 4] {
    let fields = reference.fields(time, zeta).expect("inside");
    let settlement = reference.settlement(time).expect("a time");
    let end = column.final_settlement();
    [
        fields.pressure / column.load,
        fields.effective_stress / column.load,
        fields.displacement / end,
        settlement / end,
    ]
}

/// Largest difference of two problems over times and depths.
fn largest_difference(
    first: (TextbookProblem, &ColumnParameters),
    second: (ReferenceKind, &ColumnParameters),
) -> f64 {
    let ours = reference(first.0, first.1);
    let theirs = Reference::new(second.0, second.1, &[]).expect("a possible problem");
    let mut worst = 0.0_f64;
    for time in [0.001, 0.02, 0.3, 2.0] {
        for zeta in [0.05, 0.3, 0.8, 1.0] {
            let pair = [(&ours, first.1), (&theirs, second.1)];
            let [ours, theirs] = pair.map(|(reference, column)| ratios(reference, column, time, zeta));
            worst = ours.iter().zip(theirs).fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
        }
    }
    worst
}

#[test]
#[expect(clippy::print_stdout, reason = "the worst differences are for --nocapture")]
fn every_problem_agrees_with_forty_digits() {
    let mut worst = [0.0_f64; TextbookProblem::ALL.len()];
    let mut compared = 0;
    for line in include_str!("reference/textbook.csv").lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells[place].parse::<f64>().expect("a number");
        let problem = TextbookProblem::named(cells[0]).expect("a problem");
        let column = column(cells[1]);
        let computed = ratios(&reference(problem, &column), &column, number(2), number(3));
        for (place, value) in computed.into_iter().enumerate() {
            let exact = number(4 + place);
            // A pressure near a source is larger than the load.
            let off = (value - exact).abs() / exact.abs().max(1.0);
            assert!(off < 1e-12, "{line}: {value} in column {place}");
            let at = TextbookProblem::ALL.iter().position(|listed| *listed == problem).expect("one of all");
            worst[at] = worst[at].max(off);
            compared += 1;
        }
    }
    assert_eq!(compared, 19 * 5 * 4 * 4);
    for (problem, worst) in TextbookProblem::ALL.iter().zip(worst) {
        println!("{problem:<20} {worst:.1e}");
    }
}

#[test]
fn stated_bounds_are_small_and_hold_what_fewer_terms_leave_out() {
    for problem in TextbookProblem::ALL {
        let reference = reference(problem, &column("default"));
        for time in [0.0, 1e-3, 0.1, 3.0] {
            let accuracy = reference.accuracy(time).expect("a time");
            assert!(accuracy.tail_bound <= 1e-15, "{problem} {time}: {accuracy:?}");
            assert!(accuracy.phase_bound < 1e-12, "{problem} {time}: {accuracy:?}");
        }
        assert!(reference.accuracy(1.0).expect("a time").terms < 20, "{problem}");
    }
}

#[test]
fn the_round_off_of_a_sphere_without_bulk_modulus_is_within_what_is_stated() {
    // make_textbook.py with these Poisson's ratios, T_v = 0.5, r = a/2.
    for (poissons_ratio, exact) in
        [(-0.9, 1.636_874_514_567_765), (-0.99, 1.850_658_404_803_831_8), (-0.999, 1.872_527_904_672_868_7)]
    {
        let sphere = reference(
            TextbookProblem::Cryer,
            &ColumnParameters {
                soil: Material { poissons_ratio, ..column("default").soil },
                ..column("default")
            },
        );
        let off = (sphere.fields(0.5, 0.5).expect("inside").pressure - exact).abs();
        let bound = sphere.accuracy(0.5).expect("a time").bound();
        assert!(off < bound && bound < 1e-6, "{poissons_ratio}: {off:e} {bound:e}");
    }
}

#[test]
fn a_biot_coefficient_of_one_is_terzaghis_column() {
    for water_bulk_modulus in [6e5, 2.2e9] {
        let seed = ColumnParameters {
            soil: Material { water_bulk_modulus, ..Material::default() },
            ..ColumnParameters::default()
        };
        assert!(
            largest_difference((TextbookProblem::BiotColumn, &seed), (ReferenceKind::Terzaghi, &seed))
                < 1e-14
        );
    }
    // Grains a million times stiffer than the skeleton nearly so.
    let seed = ColumnParameters::default();
    let grain_bulk_modulus = Some(6.7e11);
    let textbook = TextbookParameters { grain_bulk_modulus, ..TextbookParameters::default() };
    let stiff = ColumnParameters { textbook, ..seed };
    let off = largest_difference((TextbookProblem::BiotColumn, &stiff), (ReferenceKind::Terzaghi, &seed));
    assert!((1e-8..1e-5).contains(&off), "{off:e}");
}

#[test]
fn a_load_far_below_the_stress_of_the_start_is_terzaghis_column() {
    let mut before = f64::NAN;
    for initial_stress in [1e3, 1e4, 1e5] {
        let seed = ColumnParameters {
            soil: Material { water_bulk_modulus: 1e30, ..Material::default() },
            ..ColumnParameters::default()
        };
        let textbook =
            TextbookParameters { initial_stress: Some(initial_stress), ..TextbookParameters::default() };
        let small = ColumnParameters { textbook, ..seed };
        let (ours, theirs) = (
            reference(TextbookProblem::DavisRaymond, &small).fields(0.1, 0.7).expect("inside"),
            Reference::new(ReferenceKind::TerzaghiIncompressible, &seed, &[])
                .expect("a column")
                .fields(0.1, 0.7)
                .expect("inside"),
        );
        let off = ours.pressure - theirs.pressure;
        assert!(off > 0.0 && off < 1.0 / initial_stress, "{off:e}");
        // The difference is of first order in q/σ'_0.
        if before.is_finite() {
            assert!((before / off - 10.0).abs() < 0.1, "{before:e} {off:e}");
        }
        before = off;
    }
}

#[test]
fn a_thin_ring_around_a_wide_drain_is_one_dimensional() {
    let seed = ColumnParameters {
        soil: Material { water_bulk_modulus: 1e30, ..Material::default() },
        ..ColumnParameters::default()
    };
    let drain_radius = 1e4;
    let thin = ColumnParameters { textbook: TextbookParameters { drain_radius, ..seed.textbook }, ..seed };
    for zeta in [0.2, 0.6, 1.0] {
        let ours = reference(TextbookProblem::BarronFreeStrain, &thin).fields(0.2, zeta).expect("inside");
        let theirs = Reference::new(ReferenceKind::TerzaghiIncompressible, &seed, &[]).expect("a column");
        let theirs = theirs.fields(0.2, zeta).expect("inside");
        assert!((ours.pressure - theirs.pressure).abs() < 1e-4, "{zeta}");
    }
    // Of equal strain the mean falls by 3 c_v t/H² in the exponent: μ → (2/3)(H/r_e)².
    let drained = reference(TextbookProblem::Barron, &thin).degree_of_consolidation(0.2).expect("a time");
    assert!((drained - (1.0 - (-0.6_f64).exp())).abs() < 1e-3, "{drained}");
}

#[test]
fn early_every_body_drains_like_a_half_space_and_late_all_is_drained() {
    let seed = column("default");
    for problem in [TextbookProblem::BiotColumn, TextbookProblem::Cryer, TextbookProblem::BarronFreeStrain] {
        let reference = reference(problem, &seed);
        let inside = reference.fields(0.0, 0.5).expect("inside").pressure;
        assert!(reference.fields(0.0, 0.0).expect("inside").pressure == 0.0, "{problem}");
        // Depths of the diffusion's width, 1/200 of the body: its curvature is a few per cent.
        for depth in [1.0, 2.0] {
            let width = 2.0 * 2.5e-5_f64.sqrt();
            let computed = reference.fields(2.5e-5, depth * width).expect("inside").pressure / inside;
            assert!((computed / libm::erf(depth) - 1.0).abs() < 0.07, "{problem} {depth}: {computed}");
        }
        let late = reference.fields(200.0, 1.0).expect("inside").pressure;
        assert!(late.abs() < 1e-12, "{problem}: {late:e}");
        let degree = reference.degree_of_consolidation(200.0).expect("a time");
        assert!((degree - 1.0).abs() < 1e-12, "{problem}: {degree}");
    }
    let textbook = reference(TextbookProblem::Injection, &seed);
    let (late, half) = (textbook.fields(1e12, 0.5).expect("inside"), 0.5 * seed.final_settlement());
    // The steady state: p = q H/r, the same displacement everywhere.
    assert!((late.pressure - 2.0).abs() < 1e-5 && (late.displacement / half - 1.0).abs() < 1e-5);
    assert_eq!(textbook.fields(0.0, 0.5).expect("inside").pressure, 0.0);
}

#[test]
fn a_sphere_rises_above_its_start_as_cryers_does() {
    // Cryer (1963), figure 2, and Verruijt (2013): for ν = 0 the middle rises above its start by 50 to 60 %; a body that
    // keeps its shape, ν → ½, does not rise.
    let middle = |poissons_ratio: f64| {
        let seed = ColumnParameters {
            soil: Material { poissons_ratio, ..Material::default() },
            ..ColumnParameters::default()
        };
        let sphere = reference(TextbookProblem::Cryer, &seed);
        let start = sphere.fields(0.0, 1.0).expect("inside").pressure;
        (1..200)
            .map(|at| sphere.fields(0.002 * f64::from(at), 1.0).expect("inside").pressure / start)
            .fold(0.0, f64::max)
    };
    assert!((1.5..1.6).contains(&middle(0.0)), "{}", middle(0.0));
    assert!((1.2..1.4).contains(&middle(0.25)), "{}", middle(0.25));
    assert!((1.0..1.002).contains(&middle(0.499)), "{}", middle(0.499));
}

#[test]
fn a_slow_wave_is_drained_and_a_fast_one_undrained_below_its_skin() {
    let seed = column("default");
    let bed = |wave_period: f64| {
        let textbook = TextbookParameters { wave_period, ..seed.textbook };
        reference(
            TextbookProblem::Seabed,
            &ColumnParameters { soil: Material { water_bulk_modulus: 6e5, ..seed.soil }, textbook, ..seed },
        )
    };
    let slow = bed(1e9).fields(0.0, 1.0).expect("inside");
    assert!((slow.pressure - 1.0).abs() < 1e-6 && slow.effective_stress.abs() < 1e-6);
    let fast = bed(1e-3).fields(0.0, 0.5).expect("inside");
    // B = Q/(Q + E_oed) of soft water: 0.625.
    assert!((fast.pressure - 0.625).abs() < 1e-9, "{}", fast.pressure);
}

#[test]
fn impossible_problems_are_refused_in_sentences() {
    let answer = |problem, change: fn(&mut TextbookParameters), time: f64, zeta: f64| {
        let mut textbook = TextbookParameters::default();
        change(&mut textbook);
        let column = ColumnParameters { textbook, ..ColumnParameters::default() };
        let asked = Reference::new(ReferenceKind::Textbook(problem), &column, &[])
            .and_then(|reference| reference.fields(time, zeta));
        asked.map_or_else(|error: ExactError| error.to_string(), |fields| format!("{fields:?}"))
    };
    for (answer, wanted) in [
        (
            answer(TextbookProblem::BiotColumn, |s| s.biot_coefficient = Some(1.2), 0.1, 0.5),
            "between the porosity 0.3 and 1, got 1.2",
        ),
        (
            answer(TextbookProblem::Cryer, |s| s.grain_bulk_modulus = Some(1e3), 0.1, 0.5),
            "stiffer than the skeleton",
        ),
        (answer(TextbookProblem::Cryer, |s| s.grain_bulk_modulus = Some(-1.0), 0.1, 0.5), "must be positive"),
        (answer(TextbookProblem::Seabed, |s| s.biot_coefficient = Some(f64::NAN), 0.1, 0.5), "got NaN"),
        (
            answer(TextbookProblem::Seabed, |s| s.wave_period = 0.0, 0.1, 0.5),
            "period of the wave must be positive",
        ),
        (
            answer(TextbookProblem::Barron, |s| s.drain_radius = -0.1, 0.1, 0.5),
            "radius of the drain must be positive",
        ),
        (
            answer(TextbookProblem::DavisRaymond, |s| s.initial_stress = Some(0.0), 0.1, 0.5),
            "effective stress of the start",
        ),
        (answer(TextbookProblem::Injection, |_| (), 0.1, 1.0), "infinite"),
        (answer(TextbookProblem::Cryer, |_| (), 1e-9, 0.5), "too early"),
        (answer(TextbookProblem::BarronFreeStrain, |_| (), 1e-9, 0.5), "too early"),
        (answer(TextbookProblem::Cryer, |_| (), 0.1, 1.5), "relative depth"),
        (answer(TextbookProblem::Barron, |_| (), -1.0, 0.5), "time factor"),
    ] {
        assert!(answer.contains(wanted), "{answer}: {wanted}");
    }
}
