//! `oedometer report`: runs missing cases and renders everything.

use crate::campaign::case_run::all_cores;
use crate::campaign::runner::{RunOptions, RunReport, Tally};
use crate::campaign::taken_over::TakenOver;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{json_of, print_data, say, terminal_width};
use crate::cli::place::{DEFAULT_RESULTS, StudyArguments, chosen_as, golden_of};
use crate::cli::running::{jobs_of, refuse_unfinished, run_and_store};
use crate::cli::study_files::{load, tell_of_passed_over};
use crate::cli::trust::{self, TrustArguments};
use crate::golden::GoldenFile;
use crate::history::comparison::StudyComparison;
use crate::history::state::StudyState;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Place, findings_json};
use crate::questions::{answers, race_tables};
use crate::record::Record;
use crate::record::atomic_file::write_rebuildable;
use crate::record::calibration::{calibrate, calibration_csv};
use crate::record::csv::tidy;
use crate::record::provenance::Machine;
use crate::record::store::RecordStore;
use crate::render::escape::document;
use crate::render::page::{Page, all_figures, render_html, render_markdown, slug, tables};
use crate::report::answers::{Answers, Making, answer_page, changes_section, matrix_page};
use crate::report::check_page::{Terminal, text_of_answers};
use crate::report::studies_page::studies_page;
use crate::report::study_page::{among_others, study_page};
use crate::study::check::Study;
use crate::study::shipped::shipped_study;
use oedometer_formats::input_file::read_text;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    /// Folder of the records
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Folder of the golden values that the records are compared with [default: `golden` beside the study or above]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Run nothing; render existing records, of any build
    #[arg(long, conflicts_with = "jobs")]
    from_records: bool,
    /// Test level of the cases to run; others are rendered if they have records
    #[arg(long, alias = "test-level", value_enum, default_value_t = Tier::Full, conflicts_with = "from_records")]
    tier: Tier,
    /// Number of cases that run in parallel [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Write what counted work costs on this machine, measured by the records of the benchmark
    #[arg(long, value_name = "FILE", hide = true)]
    calibrate: Option<PathBuf>,
    #[command(flatten)]
    trust: TrustArguments,
}

/// Runs, renders and writes the answer page (`index.html`, `README.md`) and a page a study in `studies/`, each with
/// its figures and tables as files.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let start = Instant::now();
    let chosen = arguments.studies.chosen()?;
    let mut studies = load(&chosen, Some(&arguments.records))?;
    let reports = if arguments.from_records {
        stored_reports(&studies, arguments)?
    } else {
        arguments.trust.mark(&mut studies, &chosen);
        run_missing(&studies, arguments)?
    };
    if let Some(file) = &arguments.calibrate {
        let of_race = studies.iter().zip(&reports).filter(|(study, _)| study.is_race);
        let records: Vec<Record> = of_race.flat_map(|(_, report)| report.records.iter().cloned()).collect();
        write_page(file, &calibration_csv(&calibrate(&records)))?;
    }
    let with_records: Vec<(&Study, &RunReport)> =
        studies.iter().zip(&reports).filter(|(_, report)| !report.records.is_empty()).collect();
    let results = with_records
        .par_iter()
        .map(|(study, report)| {
            let results = StudyResults::new(study, &report.records, tier_of(study, report));
            StudyResults {
                file: typed_name(&study.name, &chosen),
                has_page: has_page(&study.name, &chosen, arguments.studies.names_none()),
                ..results.with_taken_over(&report.taken_over)
            }
        })
        .collect::<Vec<_>>();
    let making = Making {
        date: chrono::Utc::now().format("%Y-%m-%d").to_string(),
        processor: processor(),
        command: command(),
        seconds: 0.0,
        cases_run: reports.iter().map(|report| report.records.len() - report.resumed).sum(),
        left_out: results.iter().map(StudyResults::left_out).sum(),
    };
    let changes =
        changes(&studies, &reports, |study| golden_of(arguments.golden.as_deref(), study, &chosen).ok());
    match results.as_slice() {
        [one] if !one.study.is_race => {
            write_study_alone(&arguments.out, one, changes.as_deref(), making, start)?;
        }
        _ => write_all(&arguments.out, &results, changes, making, start)?,
    }
    if let [one] = results.as_slice() {
        let terminal = Terminal { width: terminal_width(), is_whole: false };
        print_data(&text_of_answers(&answers(std::slice::from_ref(one), Place::Terminal)?, terminal)?)?;
    }
    say!("the report is {}", arguments.out.join("index.html").display());
    let is_whole = reports.iter().all(|report| report.errors.is_empty());
    let mut tally = Tally::default();
    for report in &reports {
        tally.join(report.tally);
    }
    Ok(trust::end_with(tally, if is_whole { Exit::Pass } else { Exit::CaseFailed }))
}

/// The cases that a report runs of a study. Of the race all of them, whatever the tier: it has one budget, so that its
/// sentences are the same on every page.
fn selected(study: &Study) -> Study {
    let mut selected = study.clone();
    if study.is_race {
        selected.planned.iter_mut().for_each(|planned| planned.tier = Tier::Smoke);
    }
    selected
}

/// Whether a study has a page of its own: where it is named, and where it is not, byte for byte, one inside the program.
fn has_page(study: &str, chosen: &[PathBuf], names_none: bool) -> bool {
    let Some(shipped) = shipped_study(study).filter(|_| names_none) else { return true };
    chosen_as(study, chosen).and_then(|file| read_text(file).ok()).is_some_and(|text| text != shipped.text)
}

/// What a study is called at the command line: its file, or its name where it came from inside the program.
fn typed_name(study: &str, chosen: &[PathBuf]) -> String {
    chosen_as(study, chosen).map_or_else(|| study.to_owned(), |path| path.display().to_string())
}

fn run_missing(studies: &[Study], arguments: &Arguments) -> anyhow::Result<Vec<RunReport>> {
    let tier = arguments.tier;
    // A page shows what there is and says what made it; a gate runs it again.
    let whole = RunOptions::whole(tier, jobs_of(arguments.jobs));
    let options = RunOptions { resume: true, keep_unproven: true, ..whole };
    let chosen: Vec<Study> = studies.iter().map(selected).collect();
    // The tables are of `run` and `merge`: a page shows what is in them.
    let mut reports = run_and_store(studies, &chosen, &options, &arguments.records, None)?;
    refuse_unfinished(&reports)?;
    for ((study, chosen), report) in studies.iter().zip(&chosen).zip(&mut reports) {
        if chosen.cases(tier).len() < study.cases(Tier::Full).len() {
            add_finished(study, report, &arguments.records);
        }
    }
    Ok(reports)
}

/// Adds the finished records of the cases that the tier left out, where every one of them has its own.
fn add_finished(study: &Study, report: &mut RunReport, records: &Path) {
    let store = RecordStore::new(records, &study.name);
    let run: HashMap<String, Record> =
        report.records.drain(..).map(|record| (record.hash.clone(), record)).collect();
    let record_of = |case: &Case| run.get(&case.hash()).cloned().or_else(|| store.finished(case));
    let all: Vec<Option<Record>> = study.cases(Tier::Full).into_iter().map(record_of).collect();
    let is_whole = all.iter().all(Option::is_some);
    let kept = all.into_iter().flatten().filter(|record| is_whole || run.contains_key(&record.hash));
    report.records = kept.collect();
    let added = report.records.iter().filter(|record| !run.contains_key(&record.hash));
    report.taken_over.extend(added.filter_map(|record| TakenOver::of(record, false)));
    report.resumed += report.records.len() - run.len();
}

/// The tier that a study is judged by: the whole of it, unless it has the records of the CI tier and none beyond.
fn tier_of(study: &Study, report: &RunReport) -> Tier {
    let is_of_ci = !study.is_race && report.records.len() == study.cases(Tier::Ci).len();
    if is_of_ci && report.records.len() < study.cases(Tier::Full).len() { Tier::Ci } else { Tier::Full }
}

/// The records there are, as they are.
fn stored_reports(studies: &[Study], arguments: &Arguments) -> anyhow::Result<Vec<RunReport>> {
    let stores: Vec<RecordStore> =
        studies.iter().map(|study| RecordStore::new(&arguments.records, &study.name)).collect();
    for (study, store) in studies.iter().zip(&stores) {
        tell_of_passed_over(study, store);
    }
    let of_study = |(study, store): (&Study, &RecordStore)| {
        let records: Vec<Record> =
            study.cases(Tier::Full).into_iter().filter_map(|case| store.kept(case)).collect();
        let taken_over = records.iter().filter_map(|record| TakenOver::of(record, false)).collect();
        RunReport { resumed: records.len(), records, taken_over, ..RunReport::default() }
    };
    let reports: Vec<_> = studies.par_iter().zip(&stores).map(of_study).collect();
    if reports.iter().all(|report| report.records.is_empty()) {
        let reason = format!(
            "there are no records of these studies in {}: without `--from-records`, `report` makes them",
            arguments.records.display()
        );
        return Err(Ended::with(Exit::NothingSelected, reason));
    }
    Ok(reports)
}

/// The studies that differ from their golden values, which are those of the CI tier, those that got worse first; `None`
/// where no study has any.
fn changes(
    studies: &[Study],
    reports: &[RunReport],
    golden_of: impl Fn(&str) -> Option<GoldenFile> + Sync,
) -> Option<Vec<StudyComparison>> {
    let of_study = |(study, report): &(&Study, &RunReport)| {
        let before = StudyState::of_golden(golden_of(&study.name)?);
        let of_tier: HashSet<String> = study.cases(Tier::Ci).into_iter().map(Case::hash).collect();
        let is_compared = |record: &&Record| of_tier.contains(&record.hash);
        let records: Vec<Record> = report.records.iter().filter(is_compared).cloned().collect();
        let after = StudyState::of_records(&study.name, &records);
        (!records.is_empty()).then(|| StudyComparison::of(&study.name, &before, &after))
    };
    let all: Vec<(&Study, &RunReport)> = studies.iter().zip(reports).collect();
    let mut comparisons: Vec<StudyComparison> = all.par_iter().filter_map(of_study).collect();
    if comparisons.is_empty() {
        return None;
    }
    comparisons.retain(StudyComparison::has_changed);
    comparisons.sort_by_key(|comparison| !comparison.is_regression());
    Some(comparisons)
}

/// The processor by its name if the system reports it, else by its architecture, with the number of its threads.
fn processor() -> String {
    format!("{} × {}", all_cores(), Machine::this().processor)
}

/// The command as it was typed, without the path of the program.
fn command() -> String {
    let quoted = |word: String| if word.contains(char::is_whitespace) { format!("\"{word}\"") } else { word };
    let words = std::env::args().skip(1).map(quoted);
    std::iter::once("oedometer".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Writes the report of one study: its page is the first one.
fn write_study_alone(
    out: &Path,
    one: &StudyResults<'_>,
    changes: Option<&[StudyComparison]>,
    making: Making,
    start: Instant,
) -> anyhow::Result<()> {
    write_study(out, one, ["index", "README", "findings"], |mut page| {
        page.sections.extend(changes.map(changes_section).transpose()?);
        let making = Making { seconds: start.elapsed().as_secs_f64(), ..making };
        page.footer = format!("**How was it made?** {}", making.words(std::slice::from_ref(one)));
        Ok(page)
    })
}

/// Writes the report of several studies: a front page, the list of the studies, and the page of each that has one.
fn write_all(
    out: &Path,
    results: &[StudyResults<'_>],
    changes: Option<Vec<StudyComparison>>,
    mut making: Making,
    start: Instant,
) -> anyhow::Result<()> {
    let studies = out.join("studies");
    let write = |one: &StudyResults<'_>| {
        let name = slug(&one.study.name);
        let findings = format!("{name}.findings");
        write_study(&studies, one, [&name, &name, &findings], |page| Ok(among_others(page)))
    };
    // Collected before the first error is taken: the same error every time.
    let written: Vec<_> = results.par_iter().filter(|one| one.has_page).map(write).collect();
    written.into_iter().collect::<anyhow::Result<()>>()?;
    write_both(&studies, ["index", "README"], &studies_page(results), &[])?;
    let answers = Answers::new(results, changes)?;
    write_page(&out.join("findings.json"), &json_of(&findings_json(&answers.findings))?)?;
    making.seconds = start.elapsed().as_secs_f64();
    let front = Page { files: Some("answers".to_owned()), ..answer_page(&answers, &making)? };
    write_both(out, ["index", "README"], &front, results)?;
    if let Some(race) = &answers.race {
        let tables = out.join("tables");
        write_page(&tables.join("race.csv"), &race_tables::whole_table(race).to_plain_csv()?)?;
        write_page(&tables.join("profile.csv"), &race_tables::profile_table(race).to_plain_csv()?)?;
        write_both(out, ["race"; 2], &matrix_page(race), results)?;
    }
    Ok(())
}

/// Writes the page of a study, finished for where it stands, with its answers for programs, its file, and its measures as CSV.
fn write_study(
    folder: &Path,
    one: &StudyResults<'_>,
    [html, markdown, json]: [&str; 3],
    finished: impl FnOnce(Page) -> anyhow::Result<Page>,
) -> anyhow::Result<()> {
    let name = slug(&one.study.name);
    let findings = answers(std::slice::from_ref(one), Place::Study)?;
    write_both(folder, [html, markdown], &finished(study_page(one, &findings)?)?, &[])?;
    write_page(&folder.join(format!("{json}.json")), &json_of(&findings_json(&findings))?)?;
    let file = Path::new(&one.file);
    let text = match shipped_study(&one.study.name) {
        Some(shipped) if !file.is_file() => shipped.text.clone(),
        _ => read_text(file)?,
    };
    write_page(&folder.join(format!("{name}.toml")), &text)?;
    let rows = one.records.iter().map(|record| tidy::rows_of(&one.study.name, record));
    let csv = tidy::header_line() + &rows.collect::<Result<String, _>>()?;
    write_page(&folder.join("tables").join(format!("{name}.csv")), &csv)
}

/// A page as HTML and Markdown, with its figures and tables as files. Links to a study without a page of its own, and in Markdown, whose
/// pages of studies no repository keeps, lead to its file, or to the list of the studies.
fn write_both(
    folder: &Path,
    [html, markdown]: [&str; 2],
    page: &Page,
    linked: &[StudyResults<'_>],
) -> anyhow::Result<()> {
    let (mut of_html, mut of_markdown) = (render_html(page)?, render_markdown(page)?);
    for one in linked {
        let name = slug(&one.study.name);
        let shipped = format!("studies/{}.toml", one.study.name);
        let file = path_from(folder, &one.file).or_else(|| path_from(folder, &shipped));
        if !one.has_page {
            let file = file.as_deref().unwrap_or("studies/index.html");
            of_html = of_html.replace(&format!("\"studies/{name}.html\""), &format!("\"{file}\""));
        }
        let listed = (!one.has_page).then(|| "studies/README.md".to_owned());
        if let Some(file) = file.or(listed) {
            of_markdown = of_markdown.replace(&format!("](studies/{name}.md)"), &format!("]({file})"));
        }
    }
    write_page(&folder.join(format!("{html}.html")), &of_html)?;
    write_page(&folder.join(format!("{markdown}.md")), &of_markdown)?;
    write_exports(folder, page)
}

/// The path from the folder of the report to the file of a study, if both are below the current folder: the front page
/// in a repository links to the files of studies, because their pages are not kept.
fn path_from(out: &Path, file: &str) -> Option<String> {
    let is_plain =
        |path: &Path| path.components().all(|part| matches!(part, std::path::Component::Normal(_)));
    let is_near = is_plain(out) && is_plain(Path::new(file)) && Path::new(file).is_file();
    is_near.then(|| format!("{}{file}", "../".repeat(out.components().count())))
}

/// Whole or not at all, and not forced to the disk: after a loss of power the report is made again from its records.
fn write_page(path: &Path, text: &str) -> anyhow::Result<()> {
    Ok(write_rebuildable(path, document(text).as_bytes())?)
}

/// Every figure of a page as SVG with its data as CSV, and every table as CSV.
fn write_exports(folder: &Path, page: &Page) -> anyhow::Result<()> {
    let figures = folder.join("figures");
    for figure in all_figures(page) {
        write_page(&figures.join(format!("{}.svg", figure.name)), &figure.standalone_svg()?)?;
        write_page(&figures.join(format!("{}.csv", figure.name)), &figure.chart.data_csv())?;
    }
    for (name, table) in tables(page) {
        let folder = folder.join("tables");
        write_page(&folder.join(format!("{name}.csv")), &table.to_csv()?)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::study::file::StudySource;

    /// A study whose tiers have 1, 3 and 6 cases, and its records.
    fn study() -> (Study, Vec<Record>) {
        let sweep = |tier: &str, cells: &str| {
            format!(
                "[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [{cells}]\ntier = '{tier}'\n"
            )
        };
        let sweeps = [sweep("full", "2, 3, 4"), sweep("ci", "5, 6"), sweep("smoke", "7")].concat();
        let text = format!("title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n{sweeps}");
        let study = Study::check(&StudySource { name: "t.toml".to_owned(), text: text.clone() });
        (study.expect("sound"), records_of(&text))
    }

    fn cells(records: &[Record]) -> Vec<usize> {
        records.iter().map(|record| record.case.cells).collect()
    }

    #[test]
    fn the_race_is_run_whole_at_every_tier_and_of_all_else_what_the_tier_says() {
        let (mut study, _) = study();
        let run = |study: &Study| Tier::ALL.map(|tier| selected(study).cases(tier).len());
        assert_eq!(run(&study), [1, 3, 6]);
        study.is_race = true;
        assert_eq!(run(&study), [6; 3]);
    }

    #[test]
    fn a_study_is_judged_by_its_ci_tier_where_that_is_all_there_is() {
        let (study, records) = study();
        let of = |count: usize| {
            let report = RunReport { records: records[..count].to_vec(), ..RunReport::default() };
            tier_of(&study, &report)
        };
        let tiers = [Tier::Full, Tier::Full, Tier::Full, Tier::Ci, Tier::Full, Tier::Full, Tier::Full];
        assert_eq!([0, 1, 2, 3, 4, 5, 6].map(of), tiers);
        let mut whole = study.clone();
        whole.planned.retain(|planned| planned.tier <= Tier::Ci);
        let report = RunReport { records: records[3..].to_vec(), ..RunReport::default() };
        assert_eq!(tier_of(&whole, &report), Tier::Full, "the CI tier is the whole");
    }

    #[test]
    fn what_a_tier_left_out_joins_its_records_where_all_of_it_is_there() {
        let (study, records) = study();
        for (stored, wanted, resumed) in [
            (&records[..3], &[2, 3, 4, 5, 6, 7][..], 5),
            (&records[..2], &[5, 6, 7], 2),
            (&records[..0], &[5, 6, 7], 2),
        ] {
            let folder = tempfile::TempDir::new().expect("a folder");
            let store = RecordStore::new(folder.path(), "t");
            for record in stored {
                store.write(record).expect("written");
            }
            // In the order of the study whatever that of the run.
            let run: Vec<Record> = records[3..].iter().rev().cloned().collect();
            let mut report = RunReport { records: run, resumed: 2, ..RunReport::default() };
            add_finished(&study, &mut report, folder.path());
            assert_eq!((cells(&report.records), report.resumed), (wanted.to_vec(), resumed));
        }
    }

    #[test]
    fn changes_are_those_of_the_ci_tier_and_what_got_worse_stands_first() {
        let (study, records) = study();
        let named = |name: &str| Study { name: name.to_owned(), ..study.clone() };
        let studies = ["same", "better", "none", "worse"].map(named);
        let golden = |name: &str| {
            let mut records = records[3..].to_vec();
            for row in &mut records[0].errors {
                row.value *= match name {
                    "better" => 1.5,
                    "worse" => 0.5,
                    _ => 1.0,
                };
            }
            (name != "none").then(|| GoldenFile::of(name, &records, "a reason"))
        };
        let report = || RunReport { records: records.clone(), ..RunReport::default() };
        let reports: Vec<RunReport> = studies.iter().map(|_| report()).collect();
        let found = changes(&studies, &reports, golden).expect("golden values");
        let names: Vec<(&str, bool, usize)> = found
            .iter()
            .map(|comparison| (comparison.study.as_str(), comparison.is_regression(), comparison.unpaired))
            .collect();
        assert_eq!(names, [("worse", true, 0), ("better", false, 0)]);
        assert!(changes(&studies, &reports, |_| None).is_none(), "no golden values");
        let none: Vec<RunReport> = studies.iter().map(|_| RunReport::default()).collect();
        assert!(changes(&studies, &none, golden).is_none(), "no records");
        let same = changes(&studies[..1], &reports[..1], golden);
        assert_eq!(same.map(|found| found.len()), Some(0), "nothing changed");
    }

    #[test]
    fn a_study_is_linked_by_its_file_where_both_are_below_the_current_folder() {
        let own = "studies/terzaghi-mesh.toml";
        for (out, file, path) in [
            ("report", own, Some("../studies/terzaghi-mesh.toml")),
            ("a/b", own, Some("../../studies/terzaghi-mesh.toml")),
            ("../report", own, None),
            ("/tmp/report", own, None),
            ("report", "studies/none.toml", None),
            ("report", "./studies", None),
            ("report", "terzaghi-mesh", None),
            ("report", "src/../studies/terzaghi-mesh.toml", None),
        ] {
            assert_eq!(path_from(Path::new(out), file).as_deref(), path, "{out} {file}");
        }
        let chosen = [PathBuf::from("studies/a.toml"), "mandel".into()];
        let typed = ["a", "mandel", "b"].map(|study| typed_name(study, &chosen));
        assert_eq!(typed, ["studies/a.toml", "mandel", "b"]);
    }
}
