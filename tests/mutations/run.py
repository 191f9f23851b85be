#!/usr/bin/env python3
"""Holds `oedometer check` against single faults in the solver and in the exact solutions.

    tests/mutations/run.py [--only NAME,NAME] [--keep DIR]

Copies the tree, puts every fault of faults.toml behind a switch, builds once, and runs
`check` with one switch on at a time, the cheapest study first, until one study objects that passes
with all switches off. Writes OUTCOME.md beside this file; exits with 1 where a fault that
changes results is let through. Needs Python 3.11 and cargo, nothing else; about half an hour on
two idle cores.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# Seconds after which a study that hangs counts as objecting.
LONGEST = 900
# Studies of seconds that always come first.
CHEAP = 3

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


def place_of(text, fault):
    """Start of the text that a fault replaces."""
    found = [match.start() for match in re.finditer(re.escape(fault["from"]), text)]
    nth = fault.get("nth")
    if not found or (nth is None and len(found) != 1) or (nth is not None and len(found) < nth):
        sys.exit(f"{fault['name']}: `{fault['from']}` stands {len(found)} times in {fault['file']}")
    return found[(nth or 1) - 1]


def with_switches(tree, faults):
    """Puts every fault behind its switch."""
    for file in sorted({fault["file"] for fault in faults}):
        path = tree / file
        text = path.read_text()
        edits = []
        for fault in (one for one in faults if one["file"] == file):
            start = place_of(text, fault)
            on = f"crate::fault::is_on({fault['number']})"
            if fault.get("raw"):
                new = fault["to"].replace("FAULT", on)
            else:
                new = f"(if {on} {{ {fault['to']} }} else {{ {fault['from']} }})"
            edits.append((start, start + len(fault["from"]), new))
        for start, end, new in sorted(edits, reverse=True):
            text = text[:start] + new + text[end:]
        path.write_text(text)
    library = tree / "src/lib.rs"
    library.write_text(library.read_text() + SWITCH)


def bring_up_to_date(source, tree):
    """Makes a kept tree equal to a fresh one; what is equal keeps its time, so cargo builds it once."""
    for path in (path for path in tree.rglob("*") if path.is_file()):
        inside = path.relative_to(tree)
        if inside.parts[0] in ["src", "studies", "golden", "benches"] and not (source / inside).exists():
            path.unlink()
    for path in (path for path in source.rglob("*") if path.is_file()):
        old = tree / path.relative_to(source)
        if not old.is_file() or old.read_bytes() != path.read_bytes():
            old.parent.mkdir(parents=True, exist_ok=True)
            old.write_bytes(path.read_bytes())


def studies_by_cost(program, tree):
    """Names of the shipped studies, the one with the cheapest CI tier first."""
    plan = subprocess.run([program, "plan", "--tier", "ci"], cwd=tree, capture_output=True, text=True, check=True)
    cost = {}
    for line in plan.stdout.splitlines()[1:]:
        study, _, updates, label = line.split(",", 3)
        scene = (tree / f"studies/{study}.toml").read_text()
        # Points that move cost some forty times as much a step as frozen ones.
        moving = 40 if "xie-leo" in scene or "updated" in label else 1
        cost[study] = cost.get(study, 0) + moving * int(updates)
    return sorted(cost, key=cost.get)


def objection(program, tree, study, number):
    """What `check` says against a study with one fault on, or None where it passes."""
    environment = {**os.environ, "OEDOMETER_FAULT": str(number)}
    command = [program, "check", *study]
    try:
        done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return "hangs"
    if done.returncode == 0:
        return None
    told = [line for line in done.stdout.splitlines() if line.strip()]
    said = told[0] if told else (done.stderr.strip().splitlines() or ["nothing"])[-1]
    return f"exit code {done.returncode}: {said}"


def outcome_of(program, tree, studies, fault, sound):
    """Name of the study that objects with what it says; both None where none does.

    `sound` are the studies already seen to pass without any fault.
    """
    for study in studies:
        if study not in sound:
            said = objection(program, tree, study, 0)
            if said is not None:
                sys.exit(f"without any fault {study} does not pass: {said}")
            sound.append(study)
        said = objection(program, tree, study, fault["number"])
        if said is not None:
            return study[0], said
    return None, None


def report(rows, commit):
    """The list of faults with their outcomes, as Markdown."""
    caught = sum(1 for fault, study, _ in rows if study)
    equivalent = sum(1 for fault, study, _ in rows if not study and "equivalent" in fault)
    through = len(rows) - caught - equivalent
    lines = [
        "# Faults put into the solver and the exact solutions, one at a time",
        "",
        f"At commit {commit}, by `tests/mutations/run.py`: {len(rows)} faults, {caught} caught by the CI tier of",
        f"`check`, {equivalent} that change nothing beyond round-off, {through} let through.",
        "",
        "| fault | in | what is wrong | caught by | what `check` said |",
        "| :-- | :-- | :-- | :-- | :-- |",
    ]
    for fault, study, said in rows:
        if study is None:
            study = "equivalent" if "equivalent" in fault else "**let through**"
            said = fault.get("equivalent", "")
        said = said.replace("|", "\\|")
        lines.append(f"| {fault['name']} | {fault['file'][4:]} | {fault['what']} | {study} | {said} |")
    return "\n".join(lines) + "\n", through


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="NAME,NAME", help="these faults only; OUTCOME.md is left alone")
    parser.add_argument("--keep", metavar="DIR", type=pathlib.Path, help="build in this folder and keep it")
    arguments = parser.parse_args()
    faults = tomllib.loads((HERE / "faults.toml").read_text())["fault"]
    for number, fault in enumerate(faults, 1):
        fault["number"] = number
    names = [fault["name"] for fault in faults]
    assert len(set(names)) == len(names), "two faults have one name"

    tree = arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="oedometer-faults-"))
    with tempfile.TemporaryDirectory() as staging:
        staging = pathlib.Path(staging)
        for part in ["src", "studies", "golden", "benches"]:
            shutil.copytree(ROOT / part, staging / part)
        for part in ["Cargo.toml", "Cargo.lock", "build.rs", "rust-toolchain.toml"]:
            shutil.copy(ROOT / part, staging / part)
        with_switches(staging, faults)
        bring_up_to_date(staging, tree)
    subprocess.run(["cargo", "build", "--profile", "quick", "--locked"], cwd=tree, check=True)
    program = tree / "target/quick/oedometer"
    studies = [[f"studies/{name}.toml"] for name in studies_by_cost(program, tree)]

    sound = []
    wanted = set(arguments.only.split(",")) if arguments.only else set(names)
    rows = []
    for fault in faults:
        if fault["name"] in wanted:
            start = time.monotonic()
            study, said = outcome_of(program, tree, studies, fault, sound)
            # Neighbours in the list are neighbours in the code: what caught one may catch the next.
            if study and studies.index([study]) > CHEAP:
                studies.insert(CHEAP, studies.pop(studies.index([study])))
            rows.append((fault, study, said))
            print(f"{fault['name']}: {study or 'LET THROUGH'} ({time.monotonic() - start:.0f} s) {said or ''}", flush=True)
    commit = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    text, through = report(rows, commit.stdout.strip())
    if not arguments.only:
        (HERE / "OUTCOME.md").write_text(text)
    print(text.splitlines()[2], text.splitlines()[3])
    if not arguments.keep:
        shutil.rmtree(tree)
    sys.exit(1 if through else 0)


if __name__ == "__main__":
    main()
