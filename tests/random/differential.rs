//! The differential sweep: the same random cases by two programs, and what differs in ends, errors, orders and work.
//!
//! `OEDOMETER_OTHER` is the program of an earlier commit; the present one is that of this build, or `OEDOMETER_THIS`. It is
//! run before each release, and its summary is kept beside this file (`SWEEP.md`).

use crate::options::Options;
use crate::{asked, draw, solved, swept};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs::File;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Cases of a call that asks for no other number.
const CASES: u64 = 1000;
/// Longest that a program may take for one case, s: the draw estimates a tenth of a second.
const PATIENCE: f64 = 20.0;
/// Relative errors that are compared: below are round-off and floors, above is another solution.
const COMPARED: std::ops::RangeInclusive<f64> = 1e-4..=5e-2;
/// Errors between which an order is taken: a fine mesh may be below what is compared.
const ORDERED: std::ops::RangeInclusive<f64> = 1e-6..=5e-2;
/// Least exact value over its first amplitude at which an error means something.
const LEAST_EXACT: f64 = 1e-2;
/// Draws of a case until both programs know one.
const ATTEMPTS: u64 = 6;
/// Growth of an error, or of the work, that is told.
const GROWTH: f64 = 1.1;
/// Loss of an order that is told.
const LOST_ORDER: f64 = 0.3;

/// A relative error with what it is relative to, over its first amplitude.
#[derive(Clone, Copy, Debug)]
struct Error {
    relative: f64,
    exact: f64,
}

/// What a program made of a case.
#[derive(Clone, Debug, Default)]
struct Answer {
    /// Name of its end.
    end: String,
    /// Errors by time, quantity, place and reference.
    errors: BTreeMap<String, Error>,
    /// Steps, factorisations and iterations.
    work: BTreeMap<&'static str, f64>,
    seconds: f64,
}

impl Answer {
    /// Of a command.
    fn of(program: &str, options: &Options) -> Self {
        let command = options.command();
        let path = tempfile::NamedTempFile::new().expect("a temporary file");
        let stdout = File::create(path.path()).expect("a temporary file");
        let mut child = Command::new(program)
            .args(command.split_whitespace().skip(1))
            .args(["--format", "json"])
            .stdin(Stdio::null())
            .stdout(stdout)
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| panic!("{program}: {error}"));
        let start = Instant::now();
        let code = loop {
            if let Some(status) = child.try_wait().expect("a child") {
                break status.code();
            }
            if start.elapsed().as_secs_f64() > PATIENCE {
                child.kill().expect("a child");
                child.wait().expect("a child");
                return Self { end: format!("longer than {PATIENCE} s"), ..Self::default() };
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        let text = std::fs::read_to_string(path.path()).expect("a temporary file");
        Self::read(&text).unwrap_or_else(|| Self {
            end: code.map_or("killed".to_owned(), |code| format!("refused with {code}")),
            ..Self::default()
        })
    }

    /// Of what `solve --format json` prints; `None` where it printed no record.
    fn read(text: &str) -> Option<Self> {
        let record: serde_json::Value = serde_json::from_str(text).ok()?;
        let mut answer = Self { end: record["status"].as_str()?.to_owned(), ..Self::default() };
        for measure in record["measures"].as_array()? {
            let word = |key: &str| measure[key].as_str().unwrap_or_default();
            if !matches!(word("norm"), "l2" | "relative") {
                continue;
            }
            let (Some(relative), Some(absolute)) = (measure["value"].as_f64(), measure["absolute"].as_f64())
            else {
                continue;
            };
            let key = format!(
                "{} at {} against {}, T_v = {:.3e}",
                word("quantity"),
                word("sample"),
                word("reference"),
                measure["time_factor"].as_f64()?
            );
            answer.errors.insert(key, Error { relative, exact: absolute / relative });
        }
        for counter in ["steps", "factorisations", "iterations"] {
            answer.work.insert(counter, record[counter].as_f64().unwrap_or_default());
        }
        answer.seconds = record["wall_seconds"].as_f64().unwrap_or_default();
        Some(answer)
    }

    fn is_ok(&self) -> bool {
        self.end == "ok"
    }

    /// Whether it came near the exact solution: an end `ok` far from it is none that a later program loses.
    fn is_near(&self) -> bool {
        let is_near = |error: &Error| error.relative <= *COMPARED.end() && error.exact >= LEAST_EXACT;
        self.is_ok() && self.errors.values().any(is_near)
    }

    fn is_refused(&self) -> bool {
        self.end.starts_with("refused")
    }
}

/// One case by both programs, on its mesh and on one of twice as many cells where that is short enough.
struct Compared {
    options: Options,
    /// The earlier answer and the present one, per mesh.
    answers: Vec<[Answer; 2]>,
}

impl Compared {
    /// The first draw of an index that both programs know.
    fn of(seed: u64, index: u64, programs: &[String; 2]) -> Self {
        let mut attempts = (0..ATTEMPTS).map(|attempt| {
            let options = draw::drawn(seed, ATTEMPTS * index + attempt);
            let mut compared = Self { options, answers: Vec::new() };
            let finer = Options { cells: 2 * compared.options.cells, ..compared.options.clone() };
            for options in [compared.options.clone(), finer] {
                if solved::is_short(&options) && !compared.is_refused() {
                    compared.answers.push(programs.each_ref().map(|program| Answer::of(program, &options)));
                }
            }
            compared
        });
        let last = attempts.next().expect("an attempt");
        if last.is_refused() { attempts.find(|other| !other.is_refused()).unwrap_or(last) } else { last }
    }

    /// Whether nothing was run, or one of the programs does not know the case.
    fn is_refused(&self) -> bool {
        self.answers.last().is_some_and(|answers| answers.iter().any(Answer::is_refused))
    }

    /// Ends that differ: the earlier one and the present one, with the number of cells, and whether one that was right is
    /// lost.
    fn changed_ends(&self) -> Vec<(String, usize, bool)> {
        let cells = |mesh: usize| self.options.cells << mesh;
        let differs = |(_, [then, now]): &(usize, &[Answer; 2])| then.end != now.end;
        let meshes = self.answers.iter().enumerate().filter(differs);
        let of = |mesh: usize, [then, now]: &[Answer; 2]| {
            (format!("{} → {}", then.end, now.end), cells(mesh), then.is_near())
        };
        meshes.map(|(mesh, answers)| of(mesh, answers)).collect()
    }

    /// Errors of both that are compared, with the number of cells and what they are of.
    fn errors(&self) -> impl Iterator<Item = Pair<'_>> {
        let meshes = self.answers.iter().enumerate().filter(|(_, [then, now])| then.is_ok() && now.is_ok());
        meshes.flat_map(|(mesh, [then, now])| {
            let cells = self.options.cells << mesh;
            then.errors.iter().filter_map(move |(what, before)| {
                let after = now.errors.get(what)?;
                let is_told = [before, after].into_iter().all(|error| error.exact >= LEAST_EXACT)
                    && [before, after].into_iter().any(|error| COMPARED.contains(&error.relative));
                is_told.then_some(Pair { what, cells, then: before.relative, now: after.relative })
            })
        })
    }

    /// Orders of both between the two meshes.
    fn orders(&self) -> impl Iterator<Item = Pair<'_>> {
        let [coarse, fine] = self.answers.as_slice() else { return Vec::new().into_iter() };
        let mut orders = Vec::new();
        for what in coarse[0].errors.keys() {
            let order = |program: usize| {
                let [coarse, fine] = [coarse, fine].map(|mesh| mesh[program].errors.get(what).copied());
                let [coarse, fine] = [coarse?, fine?];
                let is_told = [coarse, fine]
                    .iter()
                    .all(|error| ORDERED.contains(&error.relative) && error.exact >= LEAST_EXACT)
                    && self.answers.iter().all(|mesh| mesh[program].is_ok());
                is_told.then(|| (coarse.relative / fine.relative).log2())
            };
            if let (Some(then), Some(now)) = (order(0), order(1)) {
                orders.push(Pair { what, cells: 2 * self.options.cells, then, now });
            }
        }
        orders.into_iter()
    }
}

/// One number by both programs.
struct Pair<'a> {
    what: &'a str,
    cells: usize,
    then: f64,
    now: f64,
}

impl Pair<'_> {
    /// Growth of an error, from the least that is compared on.
    fn growth(&self) -> f64 {
        self.now.max(*COMPARED.start()) / self.then.max(*COMPARED.start())
    }

    fn told(&self) -> String {
        format!("{} cells, {}: {:.3e} → {:.3e}", self.cells, self.what, self.then, self.now)
    }
}

/// What was found, as Markdown: a table of counts, then the cases. The number of findings is that of cases that ended well
/// and do not, whose errors grew or whose orders fell.
fn summary(compared: &[Compared]) -> (String, usize) {
    let mut ends: BTreeMap<(bool, String), Vec<String>> = BTreeMap::new();
    let (mut grown, mut lost, mut work) = (Vec::new(), Vec::new(), BTreeMap::new());
    let (mut runs, mut ok, mut worse, mut errors, mut better, mut orders) = (0, 0, 0, 0, 0, 0);
    for case in compared {
        let command = |cells: usize| Options { cells, ..case.options.clone() }.command();
        runs += case.answers.len();
        ok += case.answers.iter().filter(|[then, now]| then.is_ok() && now.is_ok()).count();
        for (change, cells, is_lost) in case.changed_ends() {
            worse += usize::from(is_lost);
            ends.entry((!is_lost, change)).or_default().push(command(cells));
        }
        let growth: Vec<Pair> = case.errors().collect();
        errors += growth.len();
        better += growth.iter().filter(|pair| pair.growth() < 1.0 / GROWTH).count();
        if let Some(worst) = growth.into_iter().max_by(|a, b| a.growth().total_cmp(&b.growth()))
            && (worst.growth().is_nan() || worst.growth() > GROWTH)
        {
            grown.push((worst.growth(), worst.told(), command(worst.cells)));
        }
        let orders_of: Vec<Pair> = case.orders().collect();
        orders += orders_of.len();
        let worst = orders_of.into_iter().max_by(|a, b| (a.then - a.now).total_cmp(&(b.then - b.now)));
        if let Some(worst) =
            worst.filter(|pair| (pair.then - pair.now).is_nan() || pair.then - pair.now > LOST_ORDER)
        {
            lost.push((worst.then - worst.now, worst.told(), command(worst.cells)));
        }
        for [then, now] in case.answers.iter().filter(|[then, now]| then.is_ok() && now.is_ok()) {
            for (counter, before) in &then.work {
                let after = now.work[counter];
                let entry: &mut (f64, f64, usize) = work.entry(*counter).or_default();
                *entry = (entry.0 + before, entry.1 + after, entry.2 + usize::from(after > GROWTH * before));
            }
        }
    }
    for list in [&mut grown, &mut lost] {
        list.sort_by(|a, b| b.0.total_cmp(&a.0));
    }
    let mut text = String::new();
    let mut row = |what: &str, value: String| writeln!(text, "| {what} | {value} |").expect("memory");
    row("runs of both programs", format!("{runs}, {ok} of them `ok` by both"));
    row("other ends", format!("{}", ends.values().map(Vec::len).sum::<usize>()));
    row("of them, ended near the exact solution and fail now", format!("{worse}"));
    row("errors compared", format!("{errors}; {better} below 1/{GROWTH} of what they were"));
    row("cases with an error beyond 1.1 times", format!("{}", grown.len()));
    row("orders compared", format!("{orders}"));
    row("cases with an order lost", format!("{}", lost.len()));
    for (counter, (before, after, more)) in work {
        row(counter, format!("{before} → {after}; more by a tenth in {more} runs"));
    }
    for ((is_kept, change), commands) in &ends {
        let near = if *is_kept { "" } else { ", near the exact solution then" };
        writeln!(text, "\n{change}{near}: {}\n", commands.len()).expect("memory");
        let most = if *is_kept { 3 } else { commands.len() };
        for command in commands.iter().take(most) {
            writeln!(text, "    {command}").expect("memory");
        }
    }
    for (heading, list) in [("Errors that grew, the worst per case", &grown), ("Orders that fell", &lost)] {
        writeln!(text, "\n{heading}: {}\n", list.len()).expect("memory");
        for (factor, told, command) in list {
            writeln!(text, "- {factor:.2}: {told}\n\n      {command}").expect("memory");
        }
    }
    let head = "| what | then → now |\n| --- | --- |\n";
    (format!("{head}{text}"), worse + grown.len() + lost.len())
}

#[test]
#[ignore = "compares with another program: OEDOMETER_OTHER is its path"]
fn differential() {
    let other = std::env::var("OEDOMETER_OTHER").expect("OEDOMETER_OTHER is the path of the earlier program");
    let this = std::env::var("OEDOMETER_THIS").unwrap_or(env!("CARGO_BIN_EXE_oedometer").to_owned());
    let (cases, seed) = (asked("OEDOMETER_RANDOM_CASES", CASES), asked("OEDOMETER_RANDOM_SEED", 62));
    let programs = [other, this];
    let compared = swept(cases, |index| Compared::of(seed, index, &programs));
    let (text, findings) = summary(&compared);
    let text = format!("# Differential sweep\n\n{cases} draws of seed {seed}.\n\n{text}");
    let path = std::env::var("OEDOMETER_SWEEP").unwrap_or("target/sweep.md".to_owned());
    std::fs::write(&path, &text).unwrap_or_else(|error| panic!("{path}: {error}"));
    let told = format_args!("{text}\n{findings} findings, in {path}\n").to_string();
    std::io::Write::write_all(&mut std::io::stderr(), told.as_bytes()).expect("a stream");
}

/// What `solve --format json` prints of one error on a mesh.
fn printed(status: &str, value: f64, exact: f64, steps: u64) -> Answer {
    let measure = serde_json::json!({
        "time_factor": 0.5, "quantity": "pressure", "sample": "points", "norm": "l2", "reference": "terzaghi",
        "value": value, "absolute": value * exact,
    });
    let record = serde_json::json!({ "status": status, "steps": steps, "measures": [measure] });
    Answer::read(&record.to_string()).expect("a record")
}

#[test]
fn what_the_other_program_did_better_is_found() {
    let options = || Options { scene: "terzaghi", cells: 8, ..Options::default() };
    let usual = || printed("ok", 4e-3, 0.5, 100);
    let fine = || printed("ok", 1e-3, 0.5, 400);
    let count = |coarse: Answer, finer: Answer| {
        let answers = vec![[usual(), coarse], [fine(), finer]];
        summary(&[Compared { options: options(), answers }]).1
    };
    for (what, coarse, finer, findings) in [
        ("nothing", usual(), fine(), 0),
        ("another end", printed("not-converged", 4e-3, 0.5, 100), fine(), 1),
        ("a refusal", Answer { end: "refused with 2".to_owned(), ..Answer::default() }, fine(), 1),
        ("an error", usual(), printed("ok", 1.2e-3, 0.5, 400), 1),
        ("an error and an order", usual(), printed("ok", 1.5e-3, 0.5, 400), 2),
        ("no number", printed("ok", 4e-3, 0.5, 100), printed("ok", 1.05e-3, 0.5, 400), 0),
        ("an error of nothing", usual(), printed("ok", 3e-3, 5e-3, 400), 0),
        ("a better one", printed("ok", 2e-3, 0.5, 100), printed("ok", 4e-4, 0.5, 400), 0),
    ] {
        assert_eq!(count(coarse, finer), findings, "{what}");
    }
    let wrong = vec![[printed("ok", 0.3, 0.5, 100), printed("unstable", 0.3, 0.5, 100)]];
    assert_eq!(summary(&[Compared { options: options(), answers: wrong }]).1, 0, "an end that was wrong");
    let text = |finer: Answer| {
        let answers = vec![[usual(), usual()], [fine(), finer]];
        summary(&[Compared { options: options(), answers }]).0
    };
    assert!(text(printed("ok", 1e-3, 0.5, 800)).contains("| steps | 500 → 900; more by a tenth in 1 runs |"));
    assert!(
        text(printed("diverged", 1e-3, 0.5, 800))
            .contains("ok → diverged, near the exact solution then: 1\n")
    );
}
