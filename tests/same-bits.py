#!/usr/bin/env python3
"""Holds two builds of the program together: the same cases by hash, and the same records to the byte.

    tests/same-bits.py OLD NEW [STUDY ...] [--tier ci] [--keep DIR]

OLD and NEW are programs, or folders that an earlier run kept. The hashes are those of `plan --tier full`; the records those
of `run --tier ci`, without provenance, seal and wall times. STUDY are study files or names of shipped studies; none are all
files of `studies/`. Ends with 1 where anything differs, and names the first differences of each record.
"""

import argparse
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

# A record's text from here on says what made it, and seals it.
PROVENANCE = ',"provenance":'


def made(side, folder, studies, tier):
    """The folder of a side: as it lies there, or made by its program."""
    side = pathlib.Path(side)
    if side.is_dir():
        return side
    folder.mkdir(parents=True, exist_ok=True)
    program = side.resolve()
    plan = subprocess.run([program, "plan", "--tier", "full", *studies], check=True, capture_output=True, text=True)
    (folder / "plan.csv").write_text(plan.stdout)
    ended = subprocess.run(
        [program, "run", "--tier", tier, "--out", folder / "out", *studies], capture_output=True, text=True
    )
    # 3: a case failed, which its record says.
    if ended.returncode not in (0, 3):
        sys.exit(f"{program} ended with {ended.returncode}:\n{ended.stderr[-2000:]}")
    return folder


def cases(folder):
    """Study, hash and label of every case that is planned."""
    lines = (folder / "plan.csv").read_text().splitlines()[1:]
    return [",".join(line.split(",")[:2]) + " " + line.split(",", 3)[3].rsplit(",", 1)[0] for line in lines]


def records(folder):
    """Text of the records by study and hash; of two of a case the later."""
    found = {}
    for pack in sorted((folder / "out").glob("*/records/*.jsonl.gz")):
        for line in gzip.open(pack, "rt", encoding="utf-8"):
            if PROVENANCE in line:
                study = pack.parent.parent.name
                found[study, json.loads(line)["hash"]] = line[: line.rindex(PROVENANCE)]
    return found


def differences(old, new, path=""):
    """Places at which two values differ, with both."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in {**old, **new}:
            yield from differences(old.get(key), new.get(key), f"{path}.{key}")
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for number, pair in enumerate(zip(old, new)):
            yield from differences(*pair, f"{path}[{number}]")
    elif old != new:
        yield f"{path}: {str(old)[:60]} → {str(new)[:60]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("studies", nargs="*")
    parser.add_argument("--tier", default="ci", help="tier of the records")
    parser.add_argument("--keep", help="folder in which both sides are kept")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as passing:
        place = pathlib.Path(arguments.keep or passing)
        sides = [(arguments.old, place / "old"), (arguments.new, place / "new")]
        old, new = (made(side, folder, arguments.studies, arguments.tier) for side, folder in sides)
        planned, kept = [set(cases(side)) for side in (old, new)], [records(side) for side in (old, new)]
        differ = 0
        for side, lines in (("OLD", planned[0] - planned[1]), ("NEW", planned[1] - planned[0])):
            for line in sorted(lines):
                print(f"only {side} plans {line}")
                differ += 1
        for key in sorted({**kept[0], **kept[1]}):
            texts = [side.get(key) for side in kept]
            if texts[0] == texts[1]:
                continue
            differ += 1
            print(f"{key[0]} {key[1]}:")
            values = [json.loads(text + "}", parse_float=str) if text else None for text in texts]
            for number, line in enumerate(differences(*values)):
                if number < 3:
                    print(f"    {line}")
        print(f"{len(planned[1])} cases planned, {len(kept[1])} records; {differ} differ")
        if not kept[1]:
            sys.exit("no record was compared")
        sys.exit(1 if differ else 0)


main()
