"""Recomputes the race's answers, sentences and profiles from `race.csv` alone, in another language than the program.

    python3 tests/race.py report            # exit code 1 and every difference, or how much agrees
    python3 tests/race.py report --turn     # tries to turn each answer: by output, budget, tolerance, read-out and family
"""
import csv
import json
import math
import sys
from collections import defaultdict

TIE, NEARLY, RESAMPLES, INSIDE = 0.03, 2.0, 2000, 0.9
TAUS = [1.0, 1.3, 2.0, 5.0, 10.0, 100.0, 1000.0]
GROUPS, READOUTS = ["moving", "rest", "total"], ["points", "centres"]
PLACES = {"points": "sampled at the points", "centres": "averaged over cells"}
OTHER = {"budget": ["cost_half_budget", "cost_twice_budget"],
         "tolerance": ["cost_half_percent", "cost_2_percent", "cost_5_percent"]}


class Race:
    def __init__(self, folder):
        self.rows = list(csv.DictReader(open(f"{folder}/tables/race.csv", encoding="utf-8")))
        for row in self.rows:
            for column in row:
                if column.startswith("cost_"):
                    row[column] = float(row[column]) if row[column] else None

    def table(self, group, readout, column="cost_1_percent", output=None, without=None):
        """Per problem its family and the costs by method; `output` is the place of an output."""
        problems = defaultdict(dict)
        outputs = defaultdict(list)
        for row in self.rows:
            if (row["group"], row["readout"]) != (group, readout) or row["family"] == without:
                continue
            problem, times = row["situation"], outputs[row["situation"]]
            if row["time"] not in times:
                times.append(row["time"])
            if row["time"] == (times[1 + output] if output is not None and len(times) > 1 + output else "all") \
                    and (output is None or row["time"] != "all"):
                problems[problem, row["family"]][row["method"]] = row[column]
        return [(family, costs) for (_, family), costs in problems.items()]


def shares(table, taus):
    families = {family for family, _ in table}
    count = {family: sum(one == family for one, _ in table) for family in families}
    out = {method: [0.0] * len(taus) for method in (table[0][1] if table else {})}
    for family, costs in table:
        reached = [cost for cost in costs.values() if cost is not None]
        for method, cost in costs.items():
            for place, tau in enumerate(taus):
                if cost is not None and cost / min(reached) <= tau:
                    out[method][place] += 1.0 / (len(families) * count[family])
    return out


def best(table):
    both = shares(table, [float("inf"), NEARLY])
    largest = max((sum(one) for one in both.values()), default=0.0)
    ranked = sorted(both, key=lambda method: -round(1e9 * sum(both[method])))
    return [m for m in ranked if largest > 0 and sum(both[m]) >= largest - TIE - 1e-9], both


def intervals(table):
    state, mask = 0, (1 << 64) - 1
    drawn = defaultdict(list)
    for _ in range(RESAMPLES):
        places = []
        for _ in table:
            state = (state + 0x9E3779B97F4A7C15) & mask
            mixed = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & mask
            mixed = ((mixed ^ (mixed >> 27)) * 0x94D049BB133111EB) & mask
            places.append((mixed ^ (mixed >> 31)) % len(table))
        for method, both in shares([table[place] for place in places], [float("inf"), NEARLY]).items():
            drawn[method].append(both)
    outside = int((1 - INSIDE) / 2 * RESAMPLES + 0.5)
    ends = lambda values: [sorted(values)[place] for place in (outside, RESAMPLES - 1 - outside)]
    return {method: [ends([one[kind] for one in both]) for kind in (0, 1)] for method, both in drawn.items()}


def holds(race, group, readout, method):
    is_best = lambda **other: method in best(race.table(group, **{"readout": readout, **other}))[0]
    return {
        "time": all(is_best(output=place) for place in range(3)),
        "budget": all(is_best(column=column) for column in OTHER["budget"]),
        "tolerance": all(is_best(column=column) for column in OTHER["tolerance"]),
        "readout": all(is_best(readout=other) for other in READOUTS if other != readout),
    }


def leader(race, readout):
    """Who reaches 1 % most often of all methods in all problems, and its largest multiple of the least work."""
    problems = defaultdict(dict)
    for row in race.rows:
        if (row["readout"], row["time"]) == (readout, "all"):
            problems[row["situation"]][row["method"]] = row["cost_1_percent"]
    ratios = defaultdict(list)
    for costs in problems.values():
        reached = {method: cost for method, cost in costs.items() if cost is not None}
        for method, cost in reached.items():
            ratios[method].append(cost / min(reached.values()))
    method = min((one for one in ratios if not one.startswith("TL-")), key=lambda one: (-len(ratios[one]), max(ratios[one])))
    as_often = sum(len(of_one) == len(ratios[method]) for one, of_one in ratios.items() if not one.startswith("TL-"))
    moving = {row["situation"] for row in race.rows if row["group"] == "total"}
    of_total = {one for one in count_methods(race, "total")}
    form = lambda name, problem: name if problem in moving else name.removeprefix("TL-")
    counts = {name: sum(costs.get(form(name, problem)) is not None for problem, costs in problems.items()) for name in of_total}
    most = max(counts.values(), default=0)
    return {"readout": readout, "method": method, "as_often": as_often, "reached": len(ratios[method]), "of": len(problems),
            "dearest": max(ratios[method]),
            "following": most if most >= len(ratios[method]) else None}


def dearest(race, group, readout, method):
    """Its largest multiple of the least work of any method of any group, in the problems of its group."""
    problems, own = defaultdict(list), {}
    for row in race.rows:
        if (row["readout"], row["time"]) == (readout, "all") and row["cost_1_percent"] is not None:
            problems[row["situation"]].append(row["cost_1_percent"])
            if (row["group"], row["method"]) == (group, method):
                own[row["situation"]] = row["cost_1_percent"]
    return max([1.0] + [cost / min(problems[problem]) for problem, cost in own.items()])


def family_answers(race, group, readout):
    """Per family of a group the methods that tie for the best, how many problems the first reaches, and the range of its work."""
    table, out = race.table(group, readout), {}
    for family in dict.fromkeys(family for family, _ in table):
        rows = [(one, costs) for one, costs in table if one == family]
        own = {name: [costs[name] for _, costs in rows if costs[name] is not None] for name in best(rows)[0]}
        least = [min(c for c in costs.values() if c is not None) for _, costs in rows if any(c is not None for c in costs.values())]
        most = max(map(len, own.values()), default=0)
        # Of those that reach as many the cheapest on the average of the logarithms, whatever its name where several cost the same.
        mean = lambda name: sum(math.log(costs[name] / min(c for c in costs.values() if c is not None))
                                for _, costs in rows if costs[name] is not None) / most
        first = min((name for name in own if len(own[name]) == most), key=lambda name: (round(mean(name), 12)), default=None) if least else None
        out[family] = (set(own), most, len(rows), [min(own[first]), max(own[first])] if first else None)
    return out


def count_methods(race, group):
    return {row["method"] for row in race.rows if row["group"] == group}


def main(folder, turn):
    race, wrong, agree = Race(folder), [], 0

    def same(what, ours, theirs):
        nonlocal agree
        close = (lambda a, b: abs(a - b) < 1e-9 if isinstance(a, float) else a == b)
        if isinstance(ours, list) and isinstance(theirs, list) and len(ours) == len(theirs):
            is_same = all(close(a, b) for a, b in zip(ours, theirs))
        else:
            is_same = close(ours, theirs)
        agree += is_same
        if not is_same:
            wrong.append(f"{what}: {ours} here, {theirs} there")

    text = json.load(open(f"{folder}/findings.json", encoding="utf-8"))
    choice = [one["facts"] for one in text.get("findings", []) if one["question"] == "choice"] or [text]
    told = choice[0]["answers"]
    for one in choice[0].get("leaders", []):
        ours = leader(race, one["readout"])
        for key, value in ours.items():
            told_there = one[key] and one[key]["reached"] if key == "following" else one[key]
            same(f"leader {one['readout']} {key}", value, told_there)
    for one in choice[0].get("families", []):
        where = f"family {one['family']}, {one['group']}, {one['readout']}"
        names, reached, of, work = family_answers(race, one["group"], one["readout"])[one["family"]]
        same(f"{where}: methods", sorted(names), sorted(one["methods"]))
        same(f"{where}: counts", [reached, of], [one["reached"], one["of"]])
        same(f"{where}: work", work or [], one["work"] or [])
    page = open(f"{folder}/README.md", encoding="utf-8").read()
    for group in GROUPS:
        for readout in READOUTS:
            table = race.table(group, readout)
            if not table:
                continue
            names, both = best(table)
            answers = [one for one in told if (one["group"], one["readout"]) == (group, readout)]
            same(f"{group}, {readout}: methods", names, [one["method"] for one in answers])
            inside = intervals(table)
            for one in answers:
                method, where = one["method"], f"{group}, {readout}, {one['method']}"
                count = sum(costs[method] is not None for _, costs in table)
                same(where, [count, len(table)], [one["reached"], one["of"]])
                same(where, both[method], [one["share"], one["within_two"]])
                same(f"{where}: interval", inside[method][0], one["interval"])
                same(f"{where}: dearest", dearest(race, group, readout, method), one["dearest"])
                same(f"{where}: holds", holds(race, group, readout, method), one["holds"])
                alike = lambda other: all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(inside[method], inside[other]))
                same(f"{where}: alike", sorted(m for m in inside if m != method and alike(m)), sorted(one["alike"]))
            if answers:
                first, more = answers[0], len(names) - 3
                listed = ", ".join(f"`{name}`" for name in names[:3])
                listed += f" and {more} other{'s' if more > 1 else ''}" if more > 0 else ""
                problems = "problem" if first["of"] == 1 else "problems"
                same(f"{group}, {readout}: sentence", True,
                     f"{PLACES[readout]}, {listed} ({first['reached']} of {first['of']} {problems})" in page)
                both_ways = lambda name: all(
                    name in best(race.table(group, r))[0] and all(holds(race, group, r, name).values()) for r in READOUTS)
                strong = next((name for name in names if both_ways(name)), None)
                words = {"moving": "points that move through the mesh", "rest": "points at rest", "total": "a mesh that follows the soil"}
                told_strong = [name for name in count_methods(race, group) if f"**For {words[group]} use `{name}`**" in page]
                same(f"{group}, {readout}: strong", [strong] if strong else [], told_strong)
    profiles = defaultdict(list)
    for row in csv.DictReader(open(f"{folder}/tables/profile.csv", encoding="utf-8")):
        profiles[row["group"], row["readout"], row["quantity"]].append(row)
    for (group, readout, quantity), steps in profiles.items():
        column = "cost_1_percent" if quantity == "all" else f"cost_{quantity}"
        table = race.table(group, readout, column)
        taus = sorted({float(step["tau"]) for step in steps})
        known = shares(table, [tau * (1 + 1e-12) for tau in taus]) if table else {}
        for step in steps:
            ours = known[step["method"]][taus.index(float(step["tau"]))] if known else 0.0
            same(f"profile {group} {readout} {quantity} {step['method']} {step['tau']}", ours, float(step["share"]))
    if turn:
        for one in told:
            group, readout, method = one["group"], one["readout"], one["method"]
            families = sorted({row["family"] for row in race.rows if row["group"] == group})
            tries = [("1 % at all outputs", {})] + [(f"output {k + 1}", {"output": k}) for k in range(3)]
            tries += [(column[5:].replace("_", " "), {"column": column}) for column in sum(OTHER.values(), [])]
            tries += [(f"read at {other}", {"readout": other}) for other in READOUTS if other != readout]
            tries += [(f"without {family}", {"without": family}) for family in families if len(families) > 1]
            found = [(what, best(race.table(group, **{"readout": readout, **how}))[0]) for what, how in tries]
            turned = [f"{what}: {', '.join(names[:3]) or 'nobody'}" for what, names in found if method not in names]
            print(f"{group}, {readout}, {method}: holds in {len(found) - len(turned)} of {len(found)}", *turned, sep="\n    ")
    print(*wrong, f"{agree} of {agree + len(wrong)} agree", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], "--turn" in sys.argv))
