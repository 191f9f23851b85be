#!/usr/bin/env python3
"""Plants single faults in the program, one at a time, and requires that a study or a test catches each.

    tests/faults/run.py [--only NAME,NAME] [--jobs N] [--keep DIR]

Each entry of faults.toml names a function and says how it goes wrong: `result` is an expression that replaces what the
function returns (`result` stands for the right value), `before` is a statement at its start, which may shadow an
argument, `instead` is an expression in it and the one that takes its place. All faults are compiled into a copy of the tree behind a switch, OEDOMETER_FAULT, so there is one build. Then
`caught_by`, a study of `oedometer check` or a test, must pass with all switches off and fail with this one on. Writes
OUTCOME.md; exits with 1 where a fault is not caught. Needs Python 3.11 and cargo.
"""

import argparse
import concurrent.futures
import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# Seconds after which a study or a test that hangs counts as objecting.
LONGEST = 300

def switch(name):
    """Whether a planted fault is on: one expression that needs nothing else, so that it compiles in any function."""
    asked = f'::std::env::var_os("OEDOMETER_FAULT").is_some_and(|on| on == "{name}")'
    return f"{{ static ON: ::std::sync::LazyLock<bool> = ::std::sync::LazyLock::new(|| {asked}); *ON }}"


def end_of_block(text, start):
    """Place behind the brace that closes the one at `start`; braces in strings, characters and comments do not count."""
    skipped = re.compile(
        r'//[^\n]*|/\*.*?\*/|b?r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\[^\']*|[^\\\'])\'', re.S
    )
    depth, place = 0, start
    while place < len(text):
        other = skipped.match(text, place)
        if other:
            place = other.end()
            continue
        depth += {"{": 1, "}": -1}.get(text[place], 0)
        place += 1
        if depth == 0:
            return place
    raise ValueError("a block does not end")


def function(text, name):
    """Places of the body of a function, `name` or `Type::name`, and its return type."""
    start, stop = 0, len(text)
    if "::" in name:
        of, name = name.split("::")
        header = re.search(rf"^impl\b[^{{;]*\b{of}\b[^{{;]*\{{", text, re.M)
        while header:
            stop = end_of_block(text, header.end() - 1)
            if re.search(rf"\bfn {name}\b", text[header.end() : stop]):
                start = header.end()
                break
            header = re.compile(rf"^impl\b[^{{;]*\b{of}\b[^{{;]*\{{", re.M).search(text, stop)
        else:
            raise ValueError(f"no `impl` of `{of}` has a function `{name}`")
    found = re.compile(rf"\bfn {name}\b").search(text, start, stop)
    if not found:
        raise ValueError(f"there is no function `{name}`")
    # The body begins at the first brace behind the arguments.
    depth, place = 0, text.index("(", found.end())
    while True:
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        place += 1
        if depth == 0:
            break
    brace = text.index("{", place)
    between = text[place:brace].split(" where ")[0].split("\nwhere")[0].strip()
    returned = between.removeprefix("->").strip() or "()"
    return brace, end_of_block(text, brace), returned


def plant(text, fault):
    """The text with a fault behind its switch."""
    brace, end, returned = function(text, fault["function"])
    body = text[brace + 1 : end - 1]
    on = switch(fault["name"])
    if "instead" in fault:
        right, wrong = fault["instead"]
        if body.count(right) != 1:
            raise ValueError(f"`{fault['function']}` has `{right}` {body.count(right)} times")
        either = body.replace(right, f"(if {on} {{ {wrong} }} else {{ {right} }})")
        return text[: brace + 1] + either + text[end - 1 :]
    if "before" in fault:
        # `let x = ...` must last beyond the switch: both ways assign the same name.
        shadow = re.fullmatch(r"let (mut )?(\w+)(: [^=]+)? = (.*);", fault["before"], re.S)
        if shadow:
            mutable, name, kind, value = shadow.groups()
            first = f"let {mutable or ''}{name}{kind or ''} = if {on} {{ {value} }} else {{ {name} }};"
        else:
            first = f"if {on} {{ {fault['before']} }}"
        return text[: brace + 1] + "\n" + first + body + text[end - 1 :]
    wrapped = f"""
    #[allow(unused_mut, clippy::all, clippy::pedantic)]
    let mut right_result = || -> {returned} {{ {body} }};
    let result = right_result();
    if {on} {{ {fault["result"]} }} else {{ result }}
"""
    return text[: brace + 1] + wrapped + text[end - 1 :]


def copied_tree(folder, faults):
    """A copy of the tracked files with all faults planted; files that are there already are left alone."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True)
    planted, refused = {}, []
    for fault in faults:
        file = fault["file"]
        try:
            planted[file] = plant(planted.get(file) or (ROOT / file).read_text(), fault)
        except (ValueError, FileNotFoundError) as error:
            refused.append(f"{fault['name']}: {file}: {error}")
    if refused:
        sys.exit("\n".join(refused))
    for name in filter(None, listed.stdout.split("\0")):
        source, copy = ROOT / name, folder / name
        if not source.is_file():
            continue
        content = planted[name].encode() if name in planted else source.read_bytes()
        if not copy.is_file() or copy.read_bytes() != content:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(content)
            shutil.copymode(source, copy)


def built(folder):
    """The program and every test by its name."""
    command = ["cargo", "test", "--no-run", "--locked", "--message-format=json"]
    told = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True)
    if told.returncode != 0:
        for line in told.stdout.splitlines():
            message = json.loads(line).get("message") or {}
            if message.get("level") == "error":
                print(message["rendered"], file=sys.stderr)
        sys.exit("the tree with the faults does not compile")
    tests, program = {}, folder / "target/debug/oedometer"
    for line in told.stdout.splitlines():
        message = json.loads(line)
        if not (message.get("profile") or {}).get("test") or not message.get("executable"):
            continue
        home = pathlib.Path(message["manifest_path"]).parent
        listed = subprocess.run(
            [message["executable"], "--list", "--format", "terse"], cwd=home, capture_output=True, text=True
        )
        for name in listed.stdout.splitlines():
            if name.endswith(": test"):
                tests[name.removesuffix(": test")] = (message["executable"], home)
    return program, tests


def judge_of(caught_by, program, tests, folder):
    """The command that must object, and where it runs."""
    if caught_by.startswith("check "):
        study = caught_by.removeprefix("check ")
        # Nothing that another fault left is taken for what this one gives.
        return [str(program), "check", "--records", "no-records", study], folder
    whole = [name for name in tests if name == caught_by or name.endswith("::" + caught_by)]
    if len(whole) != 1:
        sys.exit(f"{len(whole)} tests are called `{caught_by}`")
    executable, home = tests[whole[0]]
    return [executable, "--exact", whole[0]], home


def ended(command, home, fault):
    """Exit code and last words of a command with a fault on."""
    environment = os.environ | {"OEDOMETER_FAULT": fault, "INSTA_UPDATE": "no", "CI": "true"}
    try:
        told = subprocess.run(
            command, cwd=home, env=environment, capture_output=True, text=True, timeout=LONGEST, errors="replace"
        )
    except subprocess.TimeoutExpired:
        return 124, "it hung"
    # The message of a panic stands in the line below its place.
    said = re.search(r"panicked at .*\n(.*)|(.*expectations met.*)|(error:.*)", told.stdout + told.stderr)
    return told.returncode, next(filter(None, said.groups()), "").strip()[:120] if said else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="names of faults, parted by commas")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="faults at the same time")
    parser.add_argument("--keep", help="folder for the copied tree; a later run builds only what changed")
    arguments = parser.parse_args()
    faults = tomllib.loads((HERE / "faults.toml").read_text())["fault"]
    only = set(filter(None, arguments.only.split(",")))
    folder = pathlib.Path(arguments.keep or tempfile.mkdtemp(prefix="oedometer-faults-")).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    copied_tree(folder, faults)
    program, tests = built(folder)
    chosen = [fault for fault in faults if not only or fault["name"] in only]
    commands = {fault["caught_by"]: judge_of(fault["caught_by"], program, tests, folder) for fault in chosen}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        sound = dict(zip(commands, pool.map(lambda judge: ended(*judge, ""), commands.values())))
        unsound = [f"{judge}: {said}" for judge, (code, said) in sound.items() if code != 0]
        if unsound:
            sys.exit("\n".join(["with all faults off these fail:", *unsound]))
        ends = list(pool.map(lambda one: ended(*commands[one["caught_by"]], one["name"]), chosen))
    missed = [fault["name"] for fault, (code, _) in zip(chosen, ends) if code == 0]
    if not only:
        write_outcome(chosen, ends, missed)
    for name in missed:
        print(f"not caught: {name}")
    print(f"{len(chosen) - len(missed)} of {len(chosen)} faults caught")
    if not arguments.keep:
        shutil.rmtree(folder)
    sys.exit(1 if missed else 0)


def write_outcome(chosen, ends, missed):
    """The table of all faults."""
    commit = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    lines = [
        "# Faults planted in the program, one at a time",
        "",
        f"`tests/faults/run.py` at commit {commit.stdout.strip()}, {datetime.date.today()}: "
        f"{len(chosen) - len(missed)} of {len(chosen)} caught.",
        "",
        "| fault | function | what is wrong | caught by | what it said |",
        "| :-- | :-- | :-- | :-- | :-- |",
    ]
    for fault, (code, said) in zip(chosen, ends):
        place = f"`{fault['file']}`, `{fault['function']}`"
        told = said.replace("|", "\\|") if code else "**not caught**"
        lines.append(f"| {fault['name']} | {place} | {fault['what']} | `{fault['caught_by']}` | {told} |")
    (HERE / "OUTCOME.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
