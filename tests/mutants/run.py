#!/usr/bin/env python3
"""How many small faults the tests find: samples of mutants by module.

    cargo install cargo-mutants --version 27.1.0 --locked
    python3 tests/mutants/run.py num rotation       (python 3.11; minutes to hours)
    python3 tests/mutants/run.py --every 1 num      all mutants of a module
    python3 tests/mutants/run.py --table            only the table of CONTRIBUTING.md, from results.csv

A mutant is one changed operator, constant or return value; .cargo/mutants.toml holds the settings. Of each module every
n-th mutant in the order of the source is tried, so that the same source gives the same sample, and only the tests named
here are run. A mutant is caught if a test fails or does not end; one that does not compile does not count.
"""

import argparse
import csv
import json
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RESULTS = Path(__file__).with_name("results.csv")
COLUMNS = ["module", "of", "every", "commit", "mutant", "outcome"]
MARKERS = ("<!-- begin generated: mutants -->", "<!-- end generated: mutants -->")

# files, every n-th mutant, package, parts of the names of the tests that are run; all tests where there are none
MODULES = {
    "num": (["src/num/**"], 8, "polhode", ["num::"]),
    "rotation": (["src/rotation/**"], 4, "polhode", ["rotation::", "euler::", "properties::", "laws::"]),
    "flow": (["src/flow/free/theta/**", *(f"src/flow/free/{name}.rs" for name in ("circulation", "polhode", "phase")), "src/flow/lagrange/cubic.rs", "src/flow/lagrange/nutation.rs"], 40, "polhode", ["flow::", "exact::", "properties::", "tops::"]),
    "method": (["src/method/**"], 50, "polhode", ["method::", "laws::", "dmv::", "two_turns::", "schemes::", "taylor::", "exact_step::"]),
    "observe": (["src/observe/**"], 2, "polhode", ["observe::", "properties::"]),
    "fit": (["crates/polhode-fit/src/**"], 100, "polhode-fit", []),
}
OUTCOMES = {"CaughtMutant": "caught", "Timeout": "timeout", "MissedMutant": "missed", "Unviable": "unviable"}


def output(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


def sample(module, every):
    """Rows of the sample of one module."""
    files, default, package, tests = MODULES[module]
    every = every or default
    chosen = [part for file in files for part in ("--file", file)]
    total = len(output("cargo", "mutants", "--list", *chosen).splitlines())
    commit = output("git", "rev-parse", "--short", "HEAD").strip()
    with tempfile.TemporaryDirectory() as folder:
        command = ["cargo", "mutants", *chosen, "-j", "1", "--shard", f"0/{every}", "--sharding", "round-robin"]
        # ends with 2 or 3 where mutants are missed or do not end
        done = subprocess.run([*command, "--output", folder, "--", f"--package={package}", "--lib", "--tests", "--", *tests], cwd=ROOT)
        if done.returncode not in (0, 2, 3):
            raise SystemExit(f"cargo mutants ended with {done.returncode}")
        outcomes = json.loads((Path(folder) / "mutants.out" / "outcomes.json").read_text())["outcomes"]
    for outcome in outcomes:
        if outcome["scenario"] != "Baseline":
            yield [module, total, every, commit, outcome["scenario"]["Mutant"]["name"], OUTCOMES[outcome["summary"]]]


def stored():
    if not RESULTS.exists():
        return []
    with open(RESULTS, newline="") as file:
        return list(csv.reader(file))[1:]


def table(rows):
    """Between the markers of CONTRIBUTING.md."""
    lines = ["| files | mutants | tried | caught | missed | share caught |", "|---|---|---|---|---|---|"]
    for module in MODULES:
        mine = [row for row in rows if row[0] == module]
        if not mine:
            continue
        count = {name: sum(row[5] == name for row in mine) for name in OUTCOMES.values()}
        caught = count["caught"] + count["timeout"]
        tried = caught + count["missed"]
        share = f"{100 * caught / tried:.0f} %" if tried else ""
        files = ", ".join(f"`{file}`" for file in MODULES[module][0])
        lines.append(f"| {files} | {mine[0][1]} | {tried} | {caught} | {count['missed']} | {share} |")
    path = ROOT / "CONTRIBUTING.md"
    before, rest = path.read_text().split(MARKERS[0])
    after = rest.split(MARKERS[1])[1]
    path.write_text(before + MARKERS[0] + "\n" + "\n".join(lines) + "\n" + MARKERS[1] + after)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", choices=[[], *MODULES], help="which; all without it")
    parser.add_argument("--every", type=int, help="try every n-th mutant instead of the usual share")
    parser.add_argument("--table", action="store_true", help="write the table from the results there are")
    arguments = parser.parse_args()
    rows = stored()
    for module in [] if arguments.table else arguments.modules or MODULES:
        fresh = list(sample(module, arguments.every))
        rows = [row for row in rows if row[0] != module] + [[str(cell) for cell in row] for row in fresh]
        order = list(MODULES)
        rows.sort(key=lambda row: order.index(row[0]))
        with open(RESULTS, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
    table(rows)


if __name__ == "__main__":
    main()
