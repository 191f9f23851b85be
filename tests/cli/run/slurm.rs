//! A campaign on a cluster from its first submission to its end, with programs that stand in for those of Slurm.
#![cfg(unix)]

use crate::program::{PROGRAM, Told, call_with, folder_with};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use tempfile::TempDir;

/// Four short cases, two of which fail.
const STUDY: &str = "title = \"Short\"\nscene = \"terzaghi\"\noutput.time_factors = [0.01]\n\n[[sweep]]\nmethod = [\"MPM\"]\n\
                     cells = [3, 4]\ntime_step = [{ stable = 0.8 }, { stable = 1.3 }]\n";
/// What a submission leaves undone.
const NOTHING: &str = "true";
/// A submission that is run at once, task by task.
const AT_ONCE: &str = "for word in \"$@\"; do script=$word; done\ncase \"$*\" in *--array=1-3*) tasks='1 2 3';; *) tasks=0;; esac\n\
                       for task in $tasks; do SLURM_ARRAY_TASK_ID=$task bash \"$script\" >/dev/null 2>&1; done";
/// No job has tasks, or the first question finds some where there is a file `busy`.
const QUEUE: &str = "if [ -e busy ]; then rm busy; echo RUNNING; fi";

struct Cluster {
    folder: TempDir,
    path: String,
}

impl Cluster {
    /// A cluster with what it says of its configuration and of a job that is over, and what a submission does.
    fn new(size: u64, state: &str, submitted: &str) -> Self {
        Self::of(STUDY, size, state, submitted)
    }

    fn of(study: &str, size: u64, state: &str, submitted: &str) -> Self {
        let folder = folder_with(study);
        let (bin, asked) = (folder.path().join("bin"), folder.path().join("asked").display().to_string());
        fs::create_dir(&bin).expect("a folder");
        let scontrol = format!(
            "case \"$*\" in *config*) echo 'MaxArraySize = {size}';; *) echo 'JobState={state}';; esac"
        );
        let sbatch =
            format!("echo \"$@\" >> {asked}\n{submitted}\necho \"$((100 + $(wc -l < {asked})));cluster\"");
        for (name, script) in [("scontrol", &*scontrol), ("sbatch", &sbatch), ("squeue", QUEUE)] {
            fs::write(bin.join(name), format!("#!/bin/sh\n{script}\n")).expect("a file");
            fs::set_permissions(bin.join(name), fs::Permissions::from_mode(0o755)).expect("rights");
        }
        let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default());
        Self { folder, path }
    }

    fn run(&self, options: &[&str]) -> Told {
        let words = ["run", "short.toml", "--engine", "slurm", "--tasks", "3"];
        call_with(self.folder.path(), &[("PATH", self.path.as_str())], &[&words, options].concat())
    }

    /// The exit code, and what is said of the study.
    fn said(&self, options: &[&str]) -> (i32, Vec<String>) {
        let told = self.run(options);
        (
            told.code,
            told.err.lines().filter_map(|line| Some(line.strip_prefix("short: ")?.to_owned())).collect(),
        )
    }

    fn asked(&self) -> Vec<String> {
        let text = fs::read_to_string(self.folder.path().join("asked")).unwrap_or_default();
        text.lines().map(str::to_owned).collect()
    }

    fn file(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.folder.path().join(name)).ok()
    }
}

fn submitted(array: usize) -> String {
    format!("submitted 3 tasks as job {array}, and the dependent merge as {}", array + 1)
}

fn given_up(submissions: &str) -> String {
    format!(
        "4 cases are without a result after {submissions}; see out/slurm/logs, and `oedometer plan short.toml --missing out`"
    )
}

#[test]
fn a_campaign_is_run_merged_and_ends_as_its_cases_do() {
    let cluster = Cluster::new(4, "COMPLETED", AT_ONCE);
    let end = "4 of 4 cases, 2 failed".to_owned();
    assert_eq!(cluster.said(&[]), (3, vec![submitted(101), end.clone()]));
    let asked = [
        "--parsable --array=1-3 out/slurm/array.sh",
        "--parsable --dependency=afterany:101 out/slurm/merge.sh",
    ];
    assert_eq!(cluster.asked(), asked);
    assert_eq!(cluster.file("out/slurm/job"), None, "nothing is under way");
    assert_eq!(cluster.file("out/slurm/short.toml").as_deref(), Some(STUDY), "the tasks have a copy");
    // Where every case has its record only the table is made.
    fs::remove_file(cluster.folder.path().join("out/short/short.csv")).expect("the table");
    let table = "4 of 4 cases, out/short/short.csv".to_owned();
    assert_eq!(cluster.said(&[]), (3, vec![table, end]));
    assert!(cluster.file("out/short/short.csv").is_some());
    let told = cluster.run(&["--dry-run"]);
    assert_eq!((told.code, told.out.as_str()), (0, ""));
    assert!(
        told.err.ends_with("short: every case has a record: there is nothing to submit\n"),
        "{}",
        told.err
    );
    assert_eq!(cluster.asked().len(), 2, "nothing was submitted again");
}

#[test]
fn failures_that_the_study_expects_are_none_of_a_campaign() {
    for (expected, code) in [
        ("status = \"unstable\"\ntime_step = { stable = 1.3 }\n", 0),
        ("status = \"unstable\"\ncells = 3\ntime_step = { stable = 1.3 }\n", 3),
        ("status = \"timed-out\"\n", 3),
    ] {
        let cluster = Cluster::of(&format!("{STUDY}[[expect_case]]\n{expected}"), 4, "COMPLETED", AT_ONCE);
        let end = "4 of 4 cases, 2 failed".to_owned();
        assert_eq!(cluster.said(&[]), (code, vec![submitted(101), end]), "{expected}");
        // So it is without a cluster.
        let told = call_with(cluster.folder.path(), &[], &["run", "short.toml", "--out", "own"]);
        assert_eq!(told.code, code, "{expected}: {}", told.err);
    }
}

#[test]
fn shares_without_a_result_are_submitted_as_often_as_told_and_then_given_up() {
    let cluster = Cluster::new(4, "COMPLETED", NOTHING);
    let said = cluster.said(&["--attempts", "2"]);
    assert_eq!(said, (6, vec![submitted(101), submitted(103), given_up("2 submissions")]));
    let merge = |array: usize| format!("--parsable --dependency=afterany:{array} out/slurm/merge.sh");
    let array = "--parsable --array=1-3 out/slurm/array.sh".to_owned();
    assert_eq!(cluster.asked(), [array.clone(), merge(101), array, merge(103)]);
    assert_eq!(cluster.file("out/slurm/job"), None);
}

#[test]
fn what_is_missing_of_any_study_of_a_campaign_is_counted() {
    let cluster = Cluster::new(4, "COMPLETED", NOTHING);
    let at = cluster.folder.path();
    fs::write(at.join("other.toml"), STUDY.replace("[3, 4]", "[5, 6]")).expect("a file");
    for studies in [["short.toml", "other.toml"], ["other.toml", "short.toml"]] {
        let words = ["--engine", "slurm", "--tasks", "3", "--attempts", "1"];
        let words = [&["run"], &studies[..], &words].concat();
        let told = call_with(at, &[("PATH", cluster.path.as_str())], &words);
        let is_counted = told.err.contains("8 cases are without a result after 1 submission");
        assert!(told.code == 6 && is_counted, "{}", told.err);
    }
}

#[test]
fn tasks_that_somebody_cancelled_are_not_submitted_again() {
    let cluster = Cluster::new(4, "CANCELLED by 0", NOTHING);
    let cancelled = "the tasks were cancelled; run the command again to submit what is missing".to_owned();
    assert_eq!(cluster.said(&[]), (6, vec![submitted(101), cancelled, given_up("1 submission")]));
    assert_eq!(cluster.asked().len(), 2);
}

#[test]
fn what_is_under_way_is_followed_and_not_submitted_beside_it() {
    let cluster = Cluster::new(4, "COMPLETED", NOTHING);
    let busy = || fs::write(cluster.folder.path().join("busy"), "").expect("a file");
    let left = "not followed; run the command without `--detach` to follow it".to_owned();
    assert_eq!(cluster.said(&["--detach"]), (0, vec![submitted(101), left.clone()]));
    assert_eq!(cluster.file("out/slurm/job").as_deref(), Some("101\n102\n"));
    let there = "job 101 is already submitted; following it".to_owned();
    busy();
    assert_eq!(cluster.said(&["--detach"]), (0, vec![there.clone(), left]));
    assert_eq!(cluster.asked().len(), 2);
    busy();
    let said = cluster.said(&["--attempts", "1"]);
    assert_eq!(said, (6, vec![there, submitted(103), given_up("1 submission")]));
}

#[test]
fn a_cluster_that_takes_no_array_or_is_none_is_told() {
    for (size, end) in [
        (
            0,
            "error: this Slurm accepts no arrays (MaxArraySize=0): `oedometer plan --tasks` writes a job list\n",
        ),
        (
            1,
            "error: this Slurm accepts no arrays (MaxArraySize=1): `oedometer plan --tasks` writes a job list\n",
        ),
    ] {
        let told = Cluster::new(size, "COMPLETED", NOTHING).run(&["--detach"]);
        assert_eq!((told.code, told.err.as_str()), (3, end));
    }
    let none = Cluster { path: "/nowhere".to_owned(), ..Cluster::new(4, "COMPLETED", NOTHING) };
    let told = none.run(&["--detach"]);
    let end =
        "error: cannot start sbatch: No such file or directory; is this machine part of a Slurm cluster?\n";
    assert!(told.code == 2 && told.err.ends_with(end), "{}: {}", told.code, told.err);
    let told = none.run(&["--tier", "smoke"]);
    assert_eq!((told.code, told.err.as_str()), (4, "error: this test level contains no case\n"));
}

#[test]
fn the_scripts_have_every_option_that_was_given() {
    let cluster = Cluster::new(4, "COMPLETED", NOTHING);
    let options = "--dry-run --partition short --time 1:30:00 --cores 5 --sbatch=--account=soil --tier ci";
    let told = cluster.run(&options.split(' ').collect::<Vec<_>>());
    let scripts = r#"# out/slurm/array.sh
#!/bin/bash
#SBATCH --job-name=oedometer-short
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --partition=short
#SBATCH --account=soil
#SBATCH --cpus-per-task=5
#SBATCH --output=out/slurm/logs/%A_%a.log
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=B:TERM@60
#SBATCH --time=1:30:00
# One shard of 3. It reuses finished cases, so it continues after a kill, a requeue or another submission.
# On SIGTERM it finishes or drops running cases and starts no others.
exec oedometer run out/slurm/short.toml --out out --tier ci --shard $SLURM_ARRAY_TASK_ID/3 --balance --resume --jobs "${SLURM_CPUS_PER_TASK:-1}"

# out/slurm/merge.sh
#!/bin/bash
#SBATCH --job-name=oedometer-short-merge
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --partition=short
#SBATCH --account=soil
#SBATCH --output=out/slurm/logs/merge-%j.log
exec oedometer merge out/slurm/short.toml out --out out --tier ci

# array=$(sbatch --parsable --array=1-3 out/slurm/array.sh)
# sbatch --parsable --dependency=afterany:$array out/slurm/merge.sh
"#;
    assert_eq!((told.code, told.out.replace(PROGRAM, "oedometer").as_str()), (0, scripts), "{}", told.err);
}
