//! Which method should I take? Every contender in every situation, and sentences computed from it.

use crate::case::contender::PAPERS;
use crate::judge::race::grid::{Grid, GridRow, Overall, Score};
use crate::judge::race::{Ended, RaceCell, RaceRow, grid_of};
use crate::render::answers::{Answer, Question, page_of};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::labels::is_settled;
use crate::render::table::{Cell, Shade, Table, TableColumn, columns};
use oedometer_soil::wording::count_of;

const QUESTION: Question = Question { heading: "Which method should I take?", id: "choice" };

/// Contenders that a sentence names as tied with the best.
const MOST_TIED: usize = 5;
/// Relative change by half the step from which on the step counts.
const STEP_COUNTS: f64 = 0.05;

/// Relative asymmetry of a stiffness up to which it is round-off.
const ADJOINT: f64 = 1e-10;

/// Words for the groups of situations.
const GROUPS: [(&str, &str); 9] = [
    ("column", "columns at small strain"),
    ("points", "points out of place"),
    ("waves", "waves and explicit steps"),
    ("layer", "undrained layers and slabs"),
    ("strain", "columns at large strain"),
    ("plane", "large strain in the plane"),
    ("rest", "rest under weight"),
    ("soil", "soils with jumps and yielding"),
    ("footing", "a footing at collapse"),
];

/// The matrix with its switch, and the sentences.
pub(crate) fn answer(rows: &[RaceRow<'_>]) -> Answer {
    if rows.is_empty() {
        return None;
    }
    let grid = grid_of(rows);
    let ranked = grid.by_rank();
    let view = |show: &dyn Fn(&RaceCell, usize, usize) -> Shown| table_of(rows, &ranked, show);
    let errors = view(&|cell, row, contender| error_shown(cell, grid.rows[row].ratio(contender)))
        .note(format!(
            "Largest error of pressure, effective stress and settlement (of a plane, displacement; of a footing, load), in %, on the finest mesh \
             that every contender ran; at rest the largest velocity over the conductivity; for the critical step the observed one over the formula's. \
             Shades: as good as the best of the row, within a factor of 2, within 10, beyond, no usable result (an error of \
             100 % and more, or ✗ a run that failed); n/a what the method cannot do by its definition. Columns by mean rank over the \
             situations that a contender can run in (that of the first is {:.1})",
            ranked.first().map_or(f64::NAN, |one| one.mean_rank)
        ));
    let orders = view(&|cell, _, _| order_shown(cell)).note(
        "Order of the pressure at the points on three meshes; ~ marks an order that is not settled (pre-asymptotic, limited \
         by a floor, or by cancelling errors)",
    );
    let costs = view(&|cell, row, _| cost_shown(cell, &rows[row])).note(
        "Processor time to a largest error of 1 %, between meshes by powers; – where the finest mesh does not reach it. Of the \
         coarsest mesh where that is good enough already. The processor's time of one run: times of a millisecond vary by a fifth",
    );
    let views = [("Error, %", errors), ("Order", orders), ("Cost to 1 %", costs)];
    let views = views.map(|(word, table)| (word.to_owned(), vec![Block::Table(table)]));
    let mut sentences = sentences(&grid);
    sentences.extend(of_the_power(rows));
    let first = sentences.remove(0);
    let files = "[Every cell with all its measures](tables/race.csv).";
    let blocks = vec![Block::Switch(views.to_vec()), Block::List(sentences)];
    Some(QUESTION.told(&format!("{first} {files}"), [], blocks))
}

fn table_of(
    rows: &[RaceRow<'_>],
    ranked: &[Overall],
    show: &dyn Fn(&RaceCell, usize, usize) -> Shown,
) -> Table {
    let mut heads = columns("situation");
    heads.extend(ranked.iter().map(|one| TableColumn::number(rows[0].contenders[one.contender].name)));
    let row = |place: usize| {
        let (words, target) = (rows[place].title().to_owned(), page_of(&rows[place].study.name));
        let mut row = vec![Cell::Link { words, target: target.clone() }];
        row.extend(ranked.iter().map(|one| {
            let cell = &rows[place].contenders[one.contender];
            shaded(cell, target.clone(), || show(cell, place, one.contender))
        }));
        row
    };
    Table::of("", heads, (0..rows.len()).map(row))
}

/// Background, words, the number to sort by, and what is shown on request.
type Shown = (Shade, String, Option<f64>, String);

/// A cell of the matrix; one without a number says why it has none.
fn shaded(cell: &RaceCell, target: String, show: impl FnOnce() -> Shown) -> Cell {
    let without = |shade, words: &str| {
        let (name, why) = cell.ending();
        (shade, words.to_owned(), None, format!("{}: {name}, {why}", cell.name))
    };
    let (shade, words, value, title) = match &cell.ended {
        Ended::Well => show(),
        Ended::Failed(..) => without(Shade::Failed, "✗"),
        Ended::NotApplicable(_) => without(Shade::Empty, "n/a"),
    };
    Cell::Shaded { shade, words, value, title, target }
}

fn error_shown(cell: &RaceCell, ratio: Option<f64>) -> Shown {
    let is_error = cell.errors.iter().any(Option::is_some);
    let words = cell.score.map_or("✗".to_owned(), |score| match cell.step_ratio {
        _ if is_error => in_percent(score),
        Some(ratio) => times(ratio),
        None => number::error(score),
    });
    let (shade, title) = match ratio {
        Some(ratio) => (Shade::of_ratio(ratio), error_title(cell, ratio)),
        None => (Shade::Failed, format!("{}: no usable result", cell.name)),
    };
    (shade, words, cell.score, title)
}

/// The contender, its ratio to the best, and how much half the step changes.
fn error_title(cell: &RaceCell, ratio: f64) -> String {
    let scatter =
        cell.scatter.map(|scatter| format!("; half the step changes it by {}", number::percent(scatter)));
    format!("{}: {ratio:.1} times the best of the row{}", cell.name, scatter.unwrap_or_default())
}

fn order_shown(cell: &RaceCell) -> Shown {
    let (value, title) = (cell.order, cell.class.map_or("not measured", |class| class.name()));
    let settled = cell.class.is_some_and(is_settled);
    let words =
        value.map_or("–".to_owned(), |order| format!("{order:.1}{}", if settled { "" } else { "~" }));
    let shade = match value {
        Some(order) if order >= 1.7 => Shade::Best,
        Some(order) if order >= 1.3 => Shade::Good,
        Some(order) if order >= 0.7 => Shade::Middling,
        Some(_) => Shade::Poor,
        None => Shade::Empty,
    };
    (shade, words, value, format!("{}: {title}", cell.name))
}

fn cost_shown(cell: &RaceCell, row: &RaceRow<'_>) -> Shown {
    let least = row.contenders.iter().filter_map(|one| one.cost[0]).fold(f64::INFINITY, f64::min);
    let value = cell.cost[0];
    let words = value.map_or("–".to_owned(), number::seconds);
    let tenth = cell.cost[1].map_or("not reached".to_owned(), number::seconds);
    let title = format!("{}: 0.1 % {tenth}", cell.name);
    // A cost within a quarter of the least is as good.
    let shade = value.map_or(Shade::Empty, |seconds| Shade::of_ratio(seconds / least / 1.25));
    (shade, words, value, title)
}

/// A share in percent, two digits.
fn in_percent(share: f64) -> String {
    match 100.0 * share {
        percent if percent < 0.001 => "<0.001".to_owned(),
        percent if percent < 0.0995 => format!("{percent:.3}"),
        percent if percent < 0.995 => format!("{percent:.2}"),
        percent if percent < 9.95 => format!("{percent:.1}"),
        percent if percent < 999.5 => format!("{percent:.0}"),
        percent => format!("{percent:.0e}"),
    }
}

/// The sentences that follow from a grid: the one method to take, then one for each group, the paper's method, and the
/// situations that decide.
fn sentences(grid: &Grid) -> Vec<String> {
    let all = grid.everywhere();
    let Some(one) = grid.one_for(&all) else {
        return vec!["No contender has a usable result in any situation.".to_owned()];
    };
    let mut told = vec![the_one(grid, &one)];
    told.extend(grid.groups().into_iter().filter_map(|(group, places)| best_of_group(grid, group, &places)));
    told.extend(of_the_paper(grid));
    told.push(what_decides(grid, one.contender));
    told.extend(of_the_step(grid));
    told
}

/// Which contenders' forces do the power of their stresses.
fn of_the_power(rows: &[RaceRow<'_>]) -> Option<String> {
    let known =
        rows.iter().flat_map(|row| &row.contenders).filter_map(|cell| Some((cell.name, cell.asymmetry?)));
    let known: Vec<(&str, [f64; 2])> = known.collect();
    let adjoint = |part: usize| {
        let names = known
            .iter()
            .filter(|(_, asymmetry)| asymmetry[part] < ADJOINT)
            .map(|(name, _)| format!("`{name}`"));
        names.collect::<Vec<_>>()
    };
    let [skeleton, water] = [0, 1].map(adjoint);
    (!known.is_empty()).then(|| {
        format!(
            "**Power**: on the lattice of a column the forces of the skeleton do the power of its stresses, to round-off, in {} \
             of {} contenders, those of the water in {} ({}).",
            skeleton.len(),
            known.len(),
            water.len(),
            water.join(", ")
        )
    })
}

/// How far half the step changes the errors.
fn of_the_step(grid: &Grid) -> Option<String> {
    let scatter = |(place, row): (usize, &GridRow)| {
        let of_score = move |(one, score): (usize, &Score)| match score {
            // Where no second step was run there is no scatter.
            Score::Value { scatter, .. } if *scatter > 0.0 => Some((*scatter, one, place)),
            _ => None,
        };
        row.scores.iter().enumerate().filter_map(of_score).collect::<Vec<_>>()
    };
    let all: Vec<(f64, usize, usize)> = grid.rows.iter().enumerate().flat_map(scatter).collect();
    let counts = all.iter().filter(|one| one.0 > STEP_COUNTS).count();
    let (most, one, place) = all.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(
        "**Half the step** changes the largest error by more than {} in {counts} of {} cells, most that of `{}` in {} ({}). \
         Errors that differ by less than this scatter are ties.",
        number::percent(STEP_COUNTS),
        all.len(),
        grid.contenders[one],
        quoted(grid, place),
        number::percent(most)
    ))
}

fn the_one(grid: &Grid, one: &Overall) -> String {
    let (name, of) = (&grid.contenders[one.contender], grid.rows.len());
    let worst = one.worst_at.map_or(String::new(), |place| {
        format!(" and at most {} times the best ({})", times(one.worst_ratio), quoted(grid, place))
    });
    let results = match one.without {
        0 => "it has a result in each of them".to_owned(),
        lacking => {
            let places = grid
                .everywhere()
                .into_iter()
                .filter(|place| grid.rows[*place].ratio(one.contender).is_none());
            let names: Vec<String> = places.map(|place| quoted(grid, place)).collect();
            format!(
                "it has no usable result in {lacking} ({}), and no contender has one in all",
                names.join(", ")
            )
        }
    };
    format!(
        "If you may have only one method, take **`{name}`**: its error is within a factor of 2 of the best in {} of {}{worst}; \
         {results}.",
        one.nearly_best,
        count_of(of, "situation", "situations")
    )
}

fn best_of_group(grid: &Grid, group: &str, places: &[usize]) -> Option<String> {
    let best = grid.one_for(places)?;
    let words = GROUPS.iter().find(|(known, _)| *known == group).map_or(group, |(_, words)| words);
    let alike = (0..grid.contenders.len()).map(|one| grid.overall(one, places));
    let alike = alike.filter(|one| {
        one.contender != best.contender && one.without == best.without && one.worst_ratio <= best.worst_ratio
    });
    let mut tied: Vec<String> = alike.map(|one| format!("`{}`", grid.contenders[one.contender])).collect();
    if tied.len() > MOST_TIED {
        let others = tied.split_off(MOST_TIED - 1).len();
        tied.push(format!("{others} others"));
    }
    let tied = if tied.is_empty() { String::new() } else { format!(", tied with {}", tied.join(", ")) };
    let lacking = match best.without {
        0 => String::new(),
        lacking => format!("; without a result in {lacking}"),
    };
    Some(format!(
        "**{}** ({}): `{}`, at most {} times the best error{lacking}{tied}.",
        crate::render::report::labels::capitalised(words),
        count_of(places.len(), "situation", "situations"),
        grid.contenders[best.contender],
        times(best.worst_ratio)
    ))
}

/// Where the paper's method is best and worst.
fn of_the_paper(grid: &Grid) -> Option<String> {
    let paper = grid.contenders.iter().position(|name| name == PAPERS)?;
    let overall = grid.overall(paper, &grid.everywhere());
    let rank = 1 + grid.by_rank().iter().position(|one| one.contender == paper)?;
    let (mut failed, mut first) = (Vec::new(), Vec::new());
    for (place, row) in grid.rows.iter().enumerate() {
        if row.scores[paper] == Score::Failed {
            failed.push(quoted(grid, place));
        } else if row.rank(paper) == Some(1) {
            first.push(quoted(grid, place));
        }
    }
    let best = match first.as_slice() {
        [] => "it is first in no situation".to_owned(),
        all => format!("it is first, alone or tied, in {} ({})", all.len(), all.join(", ")),
    };
    let worst = overall.worst_at.filter(|_| overall.worst_ratio > 1.0).map_or(String::new(), |place| {
        format!(
            "; it is farthest from the best in {}, {} times its error",
            quoted(grid, place),
            times(overall.worst_ratio)
        )
    });
    let failed = if failed.is_empty() {
        String::new()
    } else {
        format!("; it has no result in {}", failed.join(", "))
    };
    Some(format!(
        "**The paper's method**, `{PAPERS}`, is number {rank} of {} by mean rank ({:.1} over {}): {best}{worst}{failed}.",
        grid.contenders.len(),
        overall.mean_rank,
        count_of(overall.ranked_in, "situation", "situations")
    ))
}

/// How the choice of one method depends on single situations.
fn what_decides(grid: &Grid, winner: usize) -> String {
    let (deciding, of) = (grid.deciding_situations(), grid.rows.len());
    let changes: Vec<String> = deciding
        .iter()
        .map(|(place, other)| {
            format!("without {} it would be `{}`", quoted(grid, *place), grid.contenders[*other])
        })
        .collect();
    let name = &grid.contenders[winner];
    match changes.as_slice() {
        [] => format!("**Leaving out any one** of the {of} situations, the choice stays `{name}`."),
        all => format!(
            "**Leaving out one situation** changes the choice of `{name}` in {} of {of}: {}.",
            all.len(),
            all.join("; ")
        ),
    }
}

fn quoted(grid: &Grid, place: usize) -> String {
    format!("“{}”", grid.rows[place].situation)
}

/// A ratio, two digits.
fn times(ratio: f64) -> String {
    if ratio < 9.95 { format!("{ratio:.1}") } else { format!("{ratio:.0}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::study_of;
    use oedometer_convergence::Class;

    /// A grid of the paper's method and two others, by rows of scores that scatter by a hundredth; infinite: failed, NaN:
    /// not applicable.
    fn grid(rows: &[(&str, [f64; 3])]) -> Grid {
        let score = |value: &f64| match *value {
            value if value.is_nan() => Score::NotApplicable,
            value if value.is_infinite() => Score::Failed,
            value => Score::Value { value, scatter: 0.01 },
        };
        let row = |(situation, scores): &(&str, [f64; 3])| GridRow {
            situation: (*situation).to_owned(),
            group: situation.split('-').next().unwrap_or_default().to_owned(),
            scores: scores.iter().map(score).collect(),
        };
        Grid {
            contenders: [PAPERS, "b", "c"].map(str::to_owned).to_vec(),
            rows: rows.iter().map(row).collect(),
        }
    }

    #[test]
    fn the_sentences_say_what_the_numbers_of_a_grid_are() {
        let told = sentences(&grid(&[
            ("column-a", [0.1, 0.101, 0.4]),
            ("column-b", [0.2, 0.3, 0.1]),
            ("plane", [f64::INFINITY, 0.3, f64::NAN]),
        ]));
        let expected = [
            "If you may have only one method, take **`b`**: its error is within a factor of 2 of the best in 2 of 3 \
             situations and at most 3.0 times the best (“column-b”); it has a result in each of them.",
            "**Columns at small strain** (2 situations): `GC-SRI-patch`, at most 2.0 times the best error.",
            "**Large strain in the plane** (1 situation): `b`, at most 1.0 times the best error.",
            "**The paper's method**, `GC-SRI-patch`, is number 1 of 3 by mean rank (1.7 over 3 situations): it is first, alone \
             or tied, in 1 (“column-a”); it is farthest from the best in “column-b”, 2.0 times its error; it has no result in \
             “plane”.",
            "**Leaving out one situation** changes the choice of `b` in 1 of 3: without “plane” it would be `GC-SRI-patch`.",
        ];
        assert_eq!(told[..expected.len()], expected);
        assert!(told[expected.len()].contains("by more than 5.00 % in 0 of 7 cells"), "{told:?}");
    }

    #[test]
    fn a_grid_without_a_usable_contender_recommends_none() {
        let told = sentences(&grid(&[("a", [f64::INFINITY, f64::NAN, f64::INFINITY])]));
        assert_eq!(told, ["No contender has a usable result in any situation."]);
        // Only `c` has both.
        let one = sentences(&grid(&[("a", [0.1, f64::INFINITY, 0.2]), ("b", [f64::NAN, 0.1, 0.3])]));
        assert!(
            one[0].contains("take **`c`**") && one[0].contains("it has a result in each of them"),
            "{}",
            one[0]
        );
        let none =
            sentences(&grid(&[("a", [0.1, f64::INFINITY, f64::INFINITY]), ("b", [f64::NAN, 0.1, 0.3])]));
        assert!(none[0].contains("and no contender has one in all"), "{}", none[0]);
    }

    #[test]
    fn shares_have_two_digits() {
        let told = [1e-6, 8.4e-5, 0.0056, 0.0123, 0.156, 4.38, 36.0].map(in_percent);
        assert_eq!(told, ["<0.001", "0.008", "0.56", "1.2", "16", "438", "4e3"]);
    }

    fn cell(name: &'static str) -> RaceCell {
        RaceCell {
            name,
            errors: [Some(0.02), None, None],
            levels: Vec::new(),
            order: None,
            class: None,
            cost: [None; 2],
            oscillation: None,
            locking: None,
            step_ratio: None,
            asymmetry: None,
            score: Some(0.02),
            scatter: None,
            ended: Ended::Well,
            complaint: None,
        }
    }

    #[test]
    fn a_cell_of_the_errors_is_shaded_by_its_ratio_and_says_why_it_has_none() {
        let shown = |change: &dyn Fn(&mut RaceCell), ratio: Option<f64>| {
            let mut cell = cell("a");
            change(&mut cell);
            let target = "t".to_owned();
            match shaded(&cell, target, || error_shown(&cell, ratio)) {
                Cell::Shaded { shade, words, value, title, .. } => (shade, words, value, title),
                other => panic!("{other:?}"),
            }
        };
        let is = |shade: Shade, words: &str, value: Option<f64>, title: &str| {
            (shade, words.to_owned(), value, format!("a: {title}"))
        };
        let best = "1.0 times the best of the row";
        assert_eq!(shown(&|_| (), Some(1.0)), is(Shade::Best, "2.0", Some(0.02), best));
        let scatter = "2.5 times the best of the row; half the step changes it by 3.10 %";
        let scattered = shown(&|cell| cell.scatter = Some(0.031), Some(2.5));
        assert_eq!(scattered, is(Shade::Middling, "2.0", Some(0.02), scatter));
        let at_rest = shown(&|cell| (cell.errors, cell.score) = ([None; 3], Some(3.2e-9)), Some(1.0));
        assert_eq!(at_rest, is(Shade::Best, "3.20e-9", Some(3.2e-9), best));
        // The critical step is told as a ratio, unless errors were measured.
        for (errors, words) in [([None; 3], "0.5"), ([None, None, Some(0.02)], "2.0")] {
            let step = shown(&|cell| (cell.errors, cell.step_ratio) = (errors, Some(0.51)), Some(1.0));
            assert_eq!(step, is(Shade::Best, words, Some(0.02), best));
        }
        assert_eq!(shown(&|_| (), None), is(Shade::Failed, "2.0", Some(0.02), "no usable result"));
        assert_eq!(shown(&|cell| cell.score = None, None), is(Shade::Failed, "✗", None, "no usable result"));
        let failed =
            shown(&|cell| cell.ended = Ended::Failed("unstable", "on 8 cells".to_owned()), Some(1.0));
        assert_eq!(failed, is(Shade::Failed, "✗", None, "unstable, on 8 cells"));
        let refused = shown(&|cell| cell.ended = Ended::NotApplicable("no plate".to_owned()), Some(1.0));
        assert_eq!(refused, is(Shade::Empty, "n/a", None, "n/a, no plate"));
    }

    #[test]
    fn orders_and_costs_have_shades_of_their_own() {
        for (order, class, words, shade) in [
            (Some(1.7), Class::Asymptotic, "1.7", Shade::Best),
            (Some(1.69), Class::Superconvergent, "1.7", Shade::Good),
            (Some(1.3), Class::PreAsymptotic, "1.3~", Shade::Good),
            (Some(1.29), Class::Contaminated, "1.3~", Shade::Middling),
            (Some(0.7), Class::Asymptotic, "0.7", Shade::Middling),
            (Some(0.69), Class::Asymptotic, "0.7", Shade::Poor),
            (Some(f64::NAN), Class::Asymptotic, "NaN", Shade::Poor),
            (None, Class::Divergent, "–", Shade::Empty),
        ] {
            let title = format!("a: {}", class.name());
            let own = RaceCell { order, class: Some(class), ..cell("a") };
            let (found, told, value, said) = order_shown(&own);
            assert_eq!((found, told.as_str(), said), (shade, words, title));
            assert!(value.map(f64::to_bits) == order.map(f64::to_bits), "{value:?}");
        }
        assert_eq!(order_shown(&cell("a")).3, "a: not measured");
        let study = study_of("race-column", RACED);
        let costs = [Some(2.5), Some(2.0), Some(2.6), Some(5.0), Some(5.1), Some(25.1), None];
        let mut contenders = costs.map(|cost| RaceCell { cost: [cost, None], ..cell("a") }).to_vec();
        contenders[1].cost[1] = Some(0.5);
        let row = RaceRow { study: &study, group: "column", cells: 8, contenders };
        let shown: Vec<Shown> = row.contenders.iter().map(|cell| cost_shown(cell, &row)).collect();
        // A quarter more than the least is as good.
        let shades =
            [Shade::Best, Shade::Best, Shade::Good, Shade::Good, Shade::Middling, Shade::Poor, Shade::Empty];
        assert_eq!(shown.iter().map(|one| one.0).collect::<Vec<_>>(), shades);
        assert_eq!(shown[0].1, "2.50 s");
        assert_eq!((shown[1].2, shown[1].3.as_str()), (Some(2.0), "a: 0.1 % 500 ms"));
        assert_eq!((shown[6].1.as_str(), shown[6].3.as_str()), ("–", "a: 0.1 % not reached"));
        // Forces do the power of the stresses where the stiffness is symmetric.
        let power = |all: [Option<[f64; 2]>; 4]| {
            let contenders = ["a", "b", "c", "d"].into_iter().zip(all);
            let contenders =
                contenders.map(|(name, asymmetry)| RaceCell { asymmetry, ..cell(name) }).collect();
            of_the_power(&[RaceRow { contenders, ..row.clone() }])
        };
        let told = power([Some([1e-12, 0.3]), Some([2e-11, 1e-11]), None, Some([1e-10, 9e-11])]);
        assert_eq!(
            told.as_deref(),
            Some(
                "**Power**: on the lattice of a column the forces of the skeleton do the power of its stresses, to \
                 round-off, in 2 of 3 contenders, those of the water in 2 (`b`, `d`)."
            )
        );
        assert_eq!(power([None; 4]), None);
    }

    const RACED: &str = "title = 'Race: a column'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [4]\n";

    #[test]
    fn contenders_that_are_as_good_are_named_and_what_the_step_changes_is_counted() {
        let alike = |count: usize| Grid {
            contenders: ["a", "b", "c", "d", "e", "f", "g"][..count]
                .iter()
                .copied()
                .map(str::to_owned)
                .collect(),
            rows: ["rest-a", "rest-b", "own"]
                .map(|situation| GridRow {
                    situation: situation.to_owned(),
                    group: situation.split('-').next().unwrap_or_default().to_owned(),
                    scores: vec![Score::Value { value: 0.1, scatter: 0.0 }; count],
                })
                .to_vec(),
        };
        let told =
            |grid: &Grid, group: &str, places: &[usize]| best_of_group(grid, group, places).expect("a best");
        let best = "**Rest under weight** (2 situations): `a`, at most 1.0 times the best error";
        assert_eq!(told(&alike(1), "rest", &[0, 1]), format!("{best}."));
        assert_eq!(told(&alike(6), "rest", &[0, 1]), format!("{best}, tied with `b`, `c`, `d`, `e`, `f`."));
        let mut grid = alike(7);
        assert_eq!(told(&grid, "rest", &[0, 1]), format!("{best}, tied with `b`, `c`, `d`, `e`, 2 others."));
        assert!(
            told(&grid, "own", &[2]).starts_with("**Own** (1 situation): "),
            "a group of somebody else's"
        );
        // One has a result in both, though a worse one; then none has.
        grid.rows[0].scores[..6].fill(Score::Failed);
        grid.rows[1].scores[6] = Score::Value { value: 0.3, scatter: 0.0 };
        let worse = "**Rest under weight** (2 situations): `g`, at most 3.0 times the best error.";
        assert_eq!(told(&grid, "rest", &[0, 1]), worse);
        grid.rows[0].scores[6] = Score::Failed;
        let none = format!("{best}; without a result in 1, tied with `b`, `c`, `d`, `e`, `f`.");
        assert_eq!(told(&grid, "rest", &[0, 1]), none);
        let of = |scatter: f64| Score::Value { value: 0.1, scatter };
        grid.rows[0].scores = [0.01, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0].map(of).to_vec();
        assert_eq!(
            of_the_step(&grid).as_deref(),
            Some(
                "**Half the step** changes the largest error by more than 5.00 % in 0 of 2 cells, most that of `b` in \
                 “rest-a” (5.00 %). Errors that differ by less than this scatter are ties."
            )
        );
        grid.rows[1].scores[3] = of(0.2);
        let told = of_the_step(&grid).expect("some have a scatter");
        assert!(told.contains("in 1 of 3 cells, most that of `d` in “rest-b” (20.0 %)."), "{told}");
        assert_eq!(of_the_step(&alike(3)), None);
        let never_first = self::grid(&[("column-a", [0.3, 0.1, 0.4]), ("column-b", [0.3, 0.3, 0.02])]);
        assert_eq!(
            of_the_paper(&never_first).as_deref(),
            Some(
                "**The paper's method**, `GC-SRI-patch`, is number 3 of 3 by mean rank (2.0 over 2 situations): it is first \
                 in no situation; it is farthest from the best in “column-b”, 15 times its error."
            )
        );
    }
}
