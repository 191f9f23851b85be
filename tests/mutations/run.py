#!/usr/bin/env python3
"""Holds `oedometer check`, and the tests that are named, against single faults.

    tests/mutations/run.py [--only NAME,NAME] [--jobs N] [--keep DIR]

Copies the tree, puts every fault of the lists beside this file behind a switch, and builds once. With one
switch on at a time a fault must be seen: by the study of `check` that saw it last time, or else by the
first that objects, the cheapest first; where the list says `caught_by`, by that test. Nothing counts that does
not pass with all switches off. Keeps what it finds in outcomes.csv and OUTCOME.md; exits with 1 where a
fault that changes results is let through. Needs Python 3.11 and cargo, nothing else; about half an hour on
two idle cores, after the build.
"""

import argparse
import concurrent.futures
import csv
import datetime
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
OUTCOMES = HERE / "outcomes.csv"
REPORT = HERE / "OUTCOME.md"
# What is copied: folders and files that the program, the benches and the tests are made of.
PARTS = ["src", "crates", "studies", "golden", "benches", "tests", "examples", "docs", "python"]
FILES = ["Cargo.toml", "Cargo.lock", "build.rs", "rust-toolchain.toml", "README.md", "CONTRIBUTING.md", "CHANGELOG.md"]
# Seconds after which a study, or a test, that hangs counts as objecting.
LONGEST = 900
LONGEST_TEST = 200
# Seconds that a study is taken to cost whose golden file does not say.
UNKNOWN_COST = 5.0

SWITCH = '''
/// Which single fault is on; see tests/mutations.
pub mod fault {
    static ON: std::sync::LazyLock<usize> = std::sync::LazyLock::new(|| {
        std::env::var("OEDOMETER_FAULT").ok().and_then(|typed| typed.parse().ok()).unwrap_or(0)
    });

    /// Whether a fault is on.
    #[inline]
    pub fn is_on(number: usize) -> bool {
        *ON == number
    }
}
'''


def load_faults():
    """The faults of all lists, numbered from 1."""
    lists = sorted(HERE.glob("*faults*.toml"), key=lambda path: (path.name != "faults.toml", path.name))
    faults = [fault for path in lists for fault in tomllib.loads(path.read_text())["fault"]]
    for number, fault in enumerate(faults, 1):
        fault["number"] = number
    names = [fault["name"] for fault in faults]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        sys.exit(f"two faults have one name: {', '.join(twice)}")
    always = [fault["name"] for fault in faults if fault.get("raw") and "FAULT" not in fault["to"]]
    if always:
        sys.exit(f"a raw text without FAULT is always on: {', '.join(always)}")
    return faults


# ---- the tree with all faults behind switches ----


def place_of(text, fault):
    """Start of the text that a fault replaces."""
    found = [match.start() for match in re.finditer(re.escape(fault["from"]), text)]
    nth = fault.get("nth")
    if not found or (nth is None and len(found) != 1) or (nth is not None and len(found) < nth):
        sys.exit(f"{fault['name']}: `{fault['from']}` stands {len(found)} times in {fault['file']}")
    return found[(nth or 1) - 1]


def switched(fault, text):
    """What stands in the place of the text: the fault where its switch is on, `text` elsewhere."""
    on = f"crate::fault::is_on({fault['number']})"
    if fault.get("raw"):
        return fault["to"].replace("FAULT", on)
    to = fault["to"]
    binding = [re.fullmatch(r"let (\w+) = (.*);", one, re.S) for one in (to, text)]
    if all(binding) and binding[0].group(1) == binding[1].group(1):
        name, (other, own) = binding[1].group(1), [one.group(2) for one in binding]
        return f"let {name} = if {on} {{ {other} }} else {{ {own} }};"
    if text.endswith(";") and to.endswith(";"):
        return f"if {on} {{ {to} }} else {{ {text} }}"
    if all(one.startswith("if ") and "{" not in one and "let " not in one for one in (to, text)):
        return f"if (if {on} {{ {to[3:]} }} else {{ {text[3:]} }})"
    return f"(if {on} {{ {to} }} else {{ {text} }})"


def with_switches(tree, faults):
    """Puts every fault behind its switch. Faults of one and the same text stand inside one another."""
    for file in sorted({fault["file"] for fault in faults}):
        path = tree / file
        text = path.read_text()
        edits = {}
        for fault in (one for one in faults if one["file"] == file):
            start = place_of(text, fault)
            edits.setdefault((start, start + len(fault["from"])), []).append(fault)
        end_before = len(text)
        for (start, end), here in sorted(edits.items(), reverse=True):
            raw = [fault["name"] for fault in here if fault.get("raw")]
            if end > end_before or (raw and len(here) > 1):
                sys.exit(f"{file}: the text of {here[0]['name']} overlaps that of another fault")
            new = text[start:end]
            for fault in here:
                new = switched(fault, new)
            text = text[:start] + new + text[end:]
            end_before = start
        path.write_text(text)
    for library in (tree / "src/lib.rs", *sorted(tree.glob("crates/*/src/lib.rs"))):
        library.write_text("#![allow(unused_parens)]\n" + library.read_text() + SWITCH)


def bring_up_to_date(source, tree):
    """Makes a kept tree equal to a fresh one; what is equal keeps its time, so cargo builds it once."""
    for path in (path for path in tree.rglob("*") if path.is_file()):
        inside = path.relative_to(tree)
        if inside.parts[0] in PARTS and not (source / inside).exists():
            path.unlink()
    for path in (path for path in source.rglob("*") if path.is_file()):
        old = tree / path.relative_to(source)
        if not old.is_file() or old.read_bytes() != path.read_bytes():
            old.parent.mkdir(parents=True, exist_ok=True)
            old.write_bytes(path.read_bytes())


def stage(tree, faults):
    """Copies the sources to a tree, with all faults behind switches."""
    with tempfile.TemporaryDirectory() as staging:
        staging = pathlib.Path(staging)
        for part in (part for part in PARTS if (ROOT / part).is_dir()):
            shutil.copytree(ROOT / part, staging / part, ignore=shutil.ignore_patterns("*.snap.new"))
        for file in (file for file in FILES if (ROOT / file).is_file()):
            shutil.copy(ROOT / file, staging / file)
        with_switches(staging, faults)
        bring_up_to_date(staging, tree)


def finished(command, folder, environment, seconds):
    """What a command said, or None where it takes longer: then it ends with all that it started."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    process = subprocess.Popen(command, cwd=folder, env=environment, text=True, start_new_session=True, **pipes)
    try:
        out, errors = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return None
    return subprocess.CompletedProcess(command, process.returncode, out, errors)


# ---- studies of `check` ----


class Studies:
    """The shipped studies on one program: what passes without a fault, and what objects with one."""

    def __init__(self, program, tree, jobs):
        self.program, self.tree, self.jobs = program, tree, jobs
        self.lock = threading.Lock()
        self.sound = {}
        golden = {path.stem: path for path in (tree / "golden").glob("*.csv")}
        cost = {}
        for path in (tree / "studies").glob("*.toml"):
            known = golden.get(path.stem)
            seconds = re.search(r"^# seconds = (.*)$", known.read_text(), re.M) if known else None
            cost[path.stem] = float(seconds.group(1)) if seconds else UNKNOWN_COST
        # The exact solutions cost nothing.
        self.by_cost = ["references", *sorted(cost, key=cost.get)]

    def objection(self, study, number):
        """What `check` says against a study with one fault on, or None where it passes."""
        with tempfile.TemporaryDirectory() as out:
            command = [self.program, "check", "--jobs", str(self.jobs)]
            # References are no study: they go with the cheapest one.
            command += ["--references"] if study == "references" else []
            command += [f"studies/{self.by_cost[1] if study == 'references' else study}.toml"]
            environment = {**os.environ, "OEDOMETER_FAULT": str(number), "TMPDIR": out}
            done = finished(command, self.tree, environment, LONGEST)
            if done is None:
                return "hangs"
        if done.returncode == 0:
            return None
        for headline in re.finditer(r"^[\w-]+: (\d+) of (\d+) expectations met.*$", done.stdout, re.M):
            text = headline.group()
            signs = [" do not", "failed", "complaints", "no golden file"]
            if headline.group(1) != headline.group(2) or any(sign in text for sign in signs):
                return f"exit code {done.returncode}: {text}"
        last = (done.stderr.strip().splitlines() or ["nothing"])[-1]
        return f"exit code {done.returncode}: {last}"

    def is_sound(self, study):
        """Whether a study passes without any fault; ends the campaign where it does not."""
        with self.lock:
            known = self.sound.setdefault(study, threading.Lock())
        if known is True:
            return
        with known:
            if self.sound[study] is not True:
                said = self.objection(study, 0)
                if said is not None:
                    raise SystemExit(f"without any fault {study} does not pass: {said}")
                self.sound[study] = True

    def outcome_of(self, fault, first):
        """The study that objects to a fault and what it says, or nothing twice; `first` are tried first."""
        order = [study for study in dict.fromkeys(first) if study in self.by_cost]
        for study in order + [study for study in self.by_cost if study not in order]:
            self.is_sound(study)
            said = self.objection(study, fault["number"])
            if said is not None:
                named = re.match(r"exit code \d+: ([\w-]+): ", said)
                return (named.group(1) if named else study), said
        return "", ""


# ---- tests by name ----


class Tests:
    """The tests that faults name, in test programs of the tree with switches: only those are built."""

    def __init__(self, tree, faults):
        self.tree = tree
        self.program = self.programs_of({name for fault in faults for name in names_of(fault)})
        self.lock = threading.Lock()
        self.sound = set()

    def programs_of(self, names):
        """Builds all test programs, and gives each test the programs that list it."""
        if not names:
            return {}
        environment = {**os.environ, "CARGO_INCREMENTAL": "0", "CARGO_PROFILE_DEV_DEBUG": "0"}
        command = ["cargo", "test", "--no-run", "--locked", "--message-format", "json-render-diagnostics", "--target-dir", "target/tests"]
        told = subprocess.run(command, cwd=self.tree, env=environment, stdout=subprocess.PIPE, text=True, check=True).stdout
        holds = {}
        for message in map(json.loads, told.splitlines()):
            if message.get("reason") == "compiler-artifact" and message["profile"]["test"] and message["executable"]:
                program = message["executable"]
                listed = subprocess.run([program, "--list"], cwd=self.tree, stdout=subprocess.PIPE, text=True, check=True).stdout
                for line in listed.splitlines():
                    if line.endswith(": test"):
                        holds.setdefault(line.removesuffix(": test").rsplit("::", 1)[-1], []).append(program)
        missing = sorted(names - holds.keys())
        if missing:
            sys.exit(f"no test is called {', '.join(missing)}")
        return {name: holds[name] for name in names}

    def objection(self, name, number):
        """What a test says with one fault on, or None where it passes."""
        environment = {**os.environ, "OEDOMETER_FAULT": str(number), "INSTA_UPDATE": "no", "RUST_BACKTRACE": "0"}
        ran = 0
        for program in self.program[name]:
            done = finished([program, name], self.tree, environment, LONGEST_TEST)
            if done is None:
                return "hangs"
            if done.returncode != 0:
                break
            passed = re.search(r"test result: ok\. (\d+) passed", done.stdout)
            ran += int(passed.group(1)) if passed else 0
        else:
            return None if ran else "runs no test"
        failed = re.search(r"panicked at [^\n]*\n([^\n]*)", done.stdout + done.stderr)
        return failed.group(1).strip()[:160] if failed else f"exit code {done.returncode}"

    def outcome_of(self, fault):
        """The test that fails with a fault and what it says, or nothing twice."""
        for name in names_of(fault):
            with self.lock:
                if name not in self.sound:
                    said = self.objection(name, 0)
                    if said is not None:
                        raise SystemExit(f"without any fault the test `{name}` does not pass: {said}")
                    self.sound.add(name)
            said = self.objection(name, fault["number"])
            if said is not None:
                return f"test {name}", said
        return "", ""


def names_of(fault):
    """The tests that a fault names, without the modules they stand in."""
    caught_by = fault.get("caught_by", [])
    caught_by = [caught_by] if isinstance(caught_by, str) else caught_by
    return [name.replace("`", "").split("::")[-1].split()[-1] for name in caught_by]


# ---- what was found ----


def load_outcomes():
    """What earlier runs found, by the name of the fault."""
    if not OUTCOMES.exists():
        return {}
    with OUTCOMES.open(newline="") as file:
        return {row["fault"]: row for row in csv.DictReader(file)}


def commit_now():
    """The commit that is run, with a word where files have changed since."""
    git = ["git", "-C", str(ROOT)]
    commit = subprocess.run([*git, "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True).stdout.strip()
    changed = subprocess.run([*git, "status", "--porcelain", *PARTS], capture_output=True, text=True).stdout
    own = "tests/mutations/"
    is_dirty = any(own not in line for line in changed.splitlines())
    return commit + (" with changes" if is_dirty else "")


def head_of(is_whole, count):
    """The lines that say what was run where and when; a part of the list is said to be one."""
    now = f"commit {commit_now()}, {datetime.date.today().isoformat()}"
    if is_whole:
        return [f"One campaign: all faults of the list at {now}."]
    before = re.search(r"^One campaign: .*$", REPORT.read_text(), re.M) if REPORT.exists() else None
    before = before.group() if before else "No campaign has run the whole list at one commit."
    return [before, "", f"**Partial since:** {count} of the faults were run again alone, at {now}."]


def cell(text):
    """Text that does not end a cell of a table."""
    return text.replace("|", "\\|").replace("\n", " ")


def keep_outcomes(outcomes, faults, head):
    """Writes outcomes in the order of the list, as CSV and as Markdown; the number let through."""
    rows = [outcomes[fault["name"]] for fault in faults if fault["name"] in outcomes]
    with OUTCOMES.open("w", newline="") as file:
        writer = csv.DictWriter(file, ["fault", "caught_by", "said"], lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    of_name = {fault["name"]: fault for fault in faults}
    missed = [row for row in rows if not row["caught_by"]]
    equivalent = [row for row in missed if "equivalent" in of_name[row["fault"]]]
    through = [row for row in missed if "equivalent" not in of_name[row["fault"]]]
    by_test = [row for row in rows if row["caught_by"].startswith("test ")]
    by_study = len(rows) - len(missed) - len(by_test)
    lines = [
        "# Faults put into the program, one at a time",
        "",
        *head,
        "",
        f"By `tests/mutations/run.py`: {len(rows)} faults, {by_study} caught by the CI tier of `check`, {len(by_test)} by a",
        f"test that is named, {len(equivalent)} that change nothing beyond round-off, {len(through)} let through. A study named is",
        "the first that objects; what it or the test said follows.",
        "",
        "| fault | in | what is wrong | caught by | what was said |",
        "| :-- | :-- | :-- | :-- | :-- |",
    ]
    for row in rows:
        fault = of_name[row["fault"]]
        caught_by, said = row["caught_by"], row["said"]
        if not caught_by:
            caught_by = "equivalent" if row in equivalent else "**let through**"
            said = fault.get("equivalent", "")
        lines.append(f"| {row['fault']} | {fault['file'][4:]} | {cell(fault['what'])} | {caught_by} | {cell(said)} |")
    waiting = [fault["name"] for fault in faults if fault["name"] not in outcomes]
    if waiting:
        lines += ["", f"Not run yet, {len(waiting)} of the list: {', '.join(waiting)}."]
    REPORT.write_text("\n".join(lines) + "\n")
    return len(through)


def campaign(faults, wanted, studies, tests, jobs):
    """Runs the wanted faults, some at a time; the number let through."""
    outcomes = {} if len(wanted) == len(faults) else load_outcomes()
    last_time = load_outcomes()
    head = head_of(len(wanted) == len(faults), len(wanted))
    caught_in_file = {}

    def run_one(fault):
        start = time.monotonic()
        if names_of(fault):
            caught_by, said = tests.outcome_of(fault)
        else:
            # Neighbours in the list are neighbours in the code: what caught one may catch the next.
            row = last_time.get(fault["name"], {})
            first = [row.get("caught_by", ""), caught_in_file.get(fault["file"], "")]
            caught_by, said = studies.outcome_of(fault, first)
            caught_in_file[fault["file"]] = caught_by
        return fault, caught_by, said, time.monotonic() - start

    through = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=jobs) as pool:
        for done in concurrent.futures.as_completed([pool.submit(run_one, fault) for fault in wanted]):
            try:
                fault, caught_by, said, seconds = done.result()
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
            outcomes[fault["name"]] = {"fault": fault["name"], "caught_by": caught_by, "said": said}
            through = keep_outcomes(outcomes, faults, head)
            print(f"{fault['name']}: {caught_by or 'LET THROUGH'} ({seconds:.0f} s) {said}", flush=True)
    return through


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="NAME,NAME", help="these faults only; the outcomes of the others stay")
    parser.add_argument("--jobs", metavar="N", type=int, default=2, help="faults at a time (2)")
    parser.add_argument("--keep", metavar="DIR", type=pathlib.Path, help="build in this folder and keep it")
    arguments = parser.parse_args()
    # A shell that starts this in the background has it ignored, and tests of Ctrl-C with it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    faults = load_faults()
    names = set(arguments.only.split(",")) if arguments.only else {fault["name"] for fault in faults}
    unknown = names - {fault["name"] for fault in faults}
    if unknown:
        sys.exit(f"no fault is called {', '.join(sorted(unknown))}")
    wanted = [fault for fault in faults if fault["name"] in names]

    tree = (arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="oedometer-faults-"))).resolve()
    tree.mkdir(parents=True, exist_ok=True)
    stage(tree, faults)
    tests = Tests(tree, wanted)
    studies = None
    if any(not names_of(fault) for fault in wanted):
        subprocess.run(["cargo", "build", "--profile", "quick", "--locked"], cwd=tree, check=True)
        cores_each = max(1, (os.cpu_count() or 1) // arguments.jobs)
        studies = Studies(tree / "target/quick/oedometer", tree, cores_each)
    through = campaign(faults, wanted, studies, tests, arguments.jobs)
    print(f"{through} let through; see {REPORT}")
    if not arguments.keep:
        shutil.rmtree(tree)
    sys.exit(1 if through else 0)


if __name__ == "__main__":
    main()
