#!/usr/bin/env python3
"""Holds `oedometer check` against single faults in the solver and in the exact solutions.

    tests/mutations/run.py [--only NAME,NAME] [--keep DIR]

Copies the tree, puts every fault of faults.toml behind a switch, builds once, and runs
`check` with one switch on at a time, the cheapest study first, until one study objects that passes
with all switches off. Keeps what it finds in outcomes.csv and OUTCOME.md beside this file; exits
with 1 where a fault that changes results is let through. Needs Python 3.11 and cargo, nothing else; about half an hour on
two idle cores.
"""

import argparse
import csv
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
OUTCOMES = HERE / "outcomes.csv"
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
    library.write_text("#![allow(unused_parens)]\n" + library.read_text() + SWITCH)


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
    for headline in re.finditer(r"^[\w-]+: (\d+) of (\d+) expectations met.*$", done.stdout, re.M):
        text = headline.group()
        if headline.group(1) != headline.group(2) or any(sign in text for sign in [" do not", "failed", "complaints"]):
            return f"exit code {done.returncode}: {text}"
    last = (done.stderr.strip().splitlines() or ["nothing"])[-1]
    return f"exit code {done.returncode}: {last}"


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
            named = re.match(r"exit code \d+: ([\w-]+): ", said)
            return named.group(1) if named else study[0], said
    return None, None


def load_outcomes():
    """What earlier runs found, by the name of the fault."""
    if not OUTCOMES.exists():
        return {}
    with OUTCOMES.open(newline="") as file:
        return {row["fault"]: row for row in csv.DictReader(file)}


def keep_outcomes(outcomes, faults):
    """Writes outcomes in the order of the list, as CSV and as Markdown; the number let through."""
    rows = [outcomes[fault["name"]] for fault in faults if fault["name"] in outcomes]
    with OUTCOMES.open("w", newline="") as file:
        writer = csv.DictWriter(file, ["fault", "study", "said", "commit"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    of_name = {fault["name"]: fault for fault in faults}
    equivalent = [row for row in rows if not row["study"] and "equivalent" in of_name[row["fault"]]]
    through = [row for row in rows if not row["study"] and "equivalent" not in of_name[row["fault"]]]
    lines = [
        "# Faults put into the solver and the exact solutions, one at a time",
        "",
        f"By `tests/mutations/run.py`: {len(rows)} faults, {len(rows) - len(equivalent) - len(through)} caught by the CI",
        f"tier of `check`, {len(equivalent)} that change nothing beyond round-off, {len(through)} let through. The study",
        "named is the first, in order of cost, that objects; what it said follows. The last column is the commit that the",
        "fault was last run at; `run.py --only NAME` runs it again.",
        "",
        "| fault | in | what is wrong | caught by | what `check` said | commit |",
        "| :-- | :-- | :-- | :-- | :-- | :-- |",
    ]
    for row in rows:
        fault = of_name[row["fault"]]
        study, said = row["study"], row["said"]
        if not study:
            study = "equivalent" if row in equivalent else "**let through**"
            said = fault.get("equivalent", "")
        said = said.replace("|", "\\|")
        lines.append(
            f"| {row['fault']} | {fault['file'][4:]} | {fault['what']} | {study} | {said} | {row['commit']} |"
        )
    waiting = [fault["name"] for fault in faults if fault["name"] not in outcomes]
    if waiting:
        lines += ["", f"Not run yet, {len(waiting)} of the list: {', '.join(waiting)}."]
    (HERE / "OUTCOME.md").write_text("\n".join(lines) + "\n")
    return len(through)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="NAME,NAME", help="these faults only; the outcomes of the others stay")
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
    studies[0].append("--references")  # the exact solutions cost nothing

    sound = []
    outcomes = load_outcomes()
    git = ["git", "rev-parse", "--short=12", "HEAD"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip()
    wanted = set(arguments.only.split(",")) if arguments.only else set(names)
    for fault in faults:
        if fault["name"] in wanted:
            start = time.monotonic()
            study, said = outcome_of(program, tree, studies, fault, sound)
            # Neighbours in the list are neighbours in the code: what caught one may catch the next.
            place = next((place for place, one in enumerate(studies) if one[0] == f"studies/{study}.toml"), 0)
            if place > CHEAP:
                studies.insert(CHEAP, studies.pop(place))
            outcomes[fault["name"]] = {
                "fault": fault["name"], "study": study or "", "said": said or "", "commit": commit
            }
            keep_outcomes(outcomes, faults)
            print(f"{fault['name']}: {study or 'LET THROUGH'} ({time.monotonic() - start:.0f} s) {said or ''}", flush=True)
    through = keep_outcomes(outcomes, faults)
    print(f"{through} let through; see {HERE / 'OUTCOME.md'}")
    if not arguments.keep:
        shutil.rmtree(tree)
    sys.exit(1 if through else 0)


if __name__ == "__main__":
    main()
