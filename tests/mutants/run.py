#!/usr/bin/env python3
"""How many small faults the tests find: samples of mutants by module.

    cargo install cargo-mutants --version 27.1.0 --locked
    python3 tests/mutants/run.py method run          (python 3.11; about a minute a mutant)
    python3 tests/mutants/run.py --sample 1000 num   another size of sample than the usual one
    python3 tests/mutants/run.py --again run         those that were not caught, with the tests of the present commit
    python3 tests/mutants/run.py --table             only the table of CONTRIBUTING.md, from results.csv

A mutant is one changed operator, constant or return value. Those of a module are put in an order that only --seed and
their text decide, and the first of them are tried, in a clone beside the target folder. Each result is written at once:
run again, the script goes on where it was stopped, as long as the commit and the seed are the same. First the tests named
here are run, and where they find nothing all tests of the package. A mutant is caught if a test fails, and fails again:
tests that measure times may fail by themselves. One whose tests do not end in time is a timeout, to be looked at; one that
does not compile does not count. `by` names the first test that failed, `again` what became of the mutant at a later commit.
"""

import argparse
import csv
import hashlib
import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CLONE = ROOT / "target" / "mutants"
RESULTS = Path(__file__).with_name("results.csv")
COLUMNS = ["module", "of", "seed", "commit", "mutant", "outcome", "by", "again"]
MARKERS = ("<!-- begin generated: mutants -->", "<!-- end generated: mutants -->")

# files, package, size of the sample, parts of the names of the tests that are run first
MODULES = {
    "num": (["src/num/**"], "polhode", 150, ["num::"]),
    "rotation": (["src/rotation/**"], "polhode", 45, ["rotation::", "euler::", "properties::", "laws::"]),
    "flow": (["src/flow/free/theta/**", *(f"src/flow/free/{name}.rs" for name in ("circulation", "polhode", "phase")), "src/flow/lagrange/cubic.rs", "src/flow/lagrange/nutation.rs"], "polhode", 45, ["exact::", "properties::", "tops::"]),
    "method": (["src/method/**"], "polhode", 30, ["laws::", "schemes::", "dmv::", "two_turns::", "taylor::", "exact_step::", "adaptive::", "programs::"]),
    "observe": (["src/observe/**"], "polhode", 30, ["observe::", "properties::", "forces::"]),
    "run": (["src/run/**", "src/events/**"], "polhode", 30, ["events::", "switched::", "adaptive::", "ensemble::", "observe::", "forces::"]),
    "advise": (["src/advise/**"], "polhode", 30, ["advise::"]),
    "audit": (["src/audit/**"], "polhode", 30, ["audit::"]),
    "fit": (["crates/polhode-fit/src/**"], "polhode-fit", 25, [""]),
}
# at least this long before a test counts as one that does not end, s
PATIENCE = 120


def output(*command, cwd=ROOT):
    return subprocess.run(command, cwd=cwd, check=True, capture_output=True, text=True).stdout


def mutants(module):
    """All of a module, in the clone."""
    chosen = [part for file in MODULES[module][0] for part in ("--file", file)]
    return json.loads(output("cargo", "mutants", "--list", "--json", *chosen, cwd=CLONE))


def apply(mutant):
    """Changes the clone."""
    path = CLONE / mutant["file"]
    lines = path.read_text().splitlines(keepends=True)
    start, end = mutant["span"]["start"], mutant["span"]["end"]
    first, last = lines[start["line"] - 1], lines[end["line"] - 1]
    changed = first[: start["column"] - 1] + mutant["replacement"] + last[end["column"] - 1 :]
    lines[start["line"] - 1 : end["line"]] = [changed]
    path.write_text("".join(lines))


def prepared(commit):
    """A clone at `commit`, with the settings of a quick build."""
    if not (CLONE / ".git").exists():
        subprocess.run(["git", "clone", "--quiet", ROOT, CLONE], check=True)
    subprocess.run(["git", "fetch", "--quiet", "origin"], cwd=CLONE, check=True)
    subprocess.run(["git", "checkout", "--quiet", "--force", commit], cwd=CLONE, check=True)


def tests(package, *what, filters=(), limit=None):
    """`passed`, `unviable` where the tests do not compile, `timeout`, or the name of one that failed."""
    build = ["cargo", "test", "--quiet", "--profile", "mutants", "--package", package, "--all-features", *what]
    if subprocess.run([*build, "--no-run"], cwd=CLONE, capture_output=True).returncode != 0:
        return "unviable"
    # a group of its own, so that the tests end with cargo
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "start_new_session": True}
    with subprocess.Popen([*build, "--", *filters], cwd=CLONE, **pipes) as run:
        try:
            said, _ = run.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            return "timeout"
    failed = re.findall(r"^---- (.+) stdout ----$", said, re.MULTILINE)
    return "passed" if run.returncode == 0 else (min(failed) if failed else "aborted")


def targets(package):
    return ["--test", "library"] if package == "polhode" else ["--lib", "--tests"]


def outcome(mutant, package, filters, limit):
    """What the tests say of it, and which of them."""
    apply(mutant)
    try:
        # those named first, then all of them, with those that stand beside the code
        for what, filters, limit in [(targets(package), filters, limit), (["--lib", "--tests"], (), 10 * limit)]:
            found = tests(package, *what, filters=filters, limit=limit)
            if found in ("unviable", "timeout"):
                return found, ""
            if found != "passed" and tests(package, *what, filters=filters, limit=limit) != "passed":
                return "caught", found
        return "missed", ""
    finally:
        subprocess.run(["git", "checkout", "--quiet", "--force", "."], cwd=CLONE, check=True)


def patience(module, package, filters):
    """How long tests may take, s; they have to pass without a mutant."""
    for _ in range(2):  # the first time builds
        begin = time.monotonic()
        if (found := tests(package, *targets(package), filters=filters)) != "passed":
            raise SystemExit(f"{module}: {found} without a mutant")
    return PATIENCE + 5 * (time.monotonic() - begin)


def sample(module, size, seed, commit, rows, write):
    """Tries the mutants of the sample that `rows` do not hold yet."""
    _, package, usual, filters = MODULES[module]
    prepared(commit)
    every = mutants(module)
    every.sort(key=lambda one: hashlib.sha256(f"{seed} {one['name']}".encode()).digest())
    chosen = every[: size or usual]
    known = {row[4] for row in rows if row[0] == module and row[2:4] == [str(seed), commit]}
    rows[:] = [row for row in rows if row[0] != module or row[4] in known]
    missing = [one for one in chosen if one["name"] not in known]
    limit = patience(module, package, filters) if missing else None
    for mutant in missing:
        found, by = outcome(mutant, package, filters, limit)
        print(f"{found:8} {mutant['name']} {by}", flush=True)
        rows.append([module, str(len(every)), str(seed), commit, mutant["name"], found, by, ""])
        write()


def again(module, commit, rows, write):
    """Tries those that were not caught once more, where the present code still has them."""
    _, package, _, filters = MODULES[module]
    prepared(commit)
    # by file and text; of several those of the nearest line
    place = re.compile(r"(.+?):(\d+):\d+: (.*)", re.DOTALL)
    every = [(place.fullmatch(one["name"]), one) for one in mutants(module)]
    limit = patience(module, package, filters)
    for row in [row for row in rows if row[0] == module and row[5] in ("missed", "timeout")]:
        file, line, text = place.fullmatch(row[4]).groups()
        alike = [(abs(int(at[2]) - int(line)), one["name"], one) for at, one in every if (at[1], at[3]) == (file, text)]
        if alike:
            found, by = outcome(min(alike)[2], package, filters, limit)
            print(f"{found:8} {row[4]} {by}", flush=True)
            row[7] = f"{found} at {commit}" + (f" by {by}" if by else "")
            write()


def stored():
    if not RESULTS.exists():
        return []
    with open(RESULTS, newline="") as file:
        return [row + [""] * (len(COLUMNS) - len(row)) for row in list(csv.reader(file))[1:]]


def table(rows):
    """Between the markers of CONTRIBUTING.md."""
    heads = ["files", "mutants", "tried", "caught", "no end", "missed", "share caught", "with the tests since"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for module in MODULES:
        mine = [row for row in rows if row[0] == module and row[5] != "unviable"]
        if not mine:
            continue
        caught, ended, missed = (sum(row[5] == found for row in mine) for found in ("caught", "timeout", "missed"))
        since = sum(row[7].startswith("caught") for row in mine)
        files = ", ".join(f"`{file}`" for file in MODULES[module][0])
        share = [f"{100 * part / len(mine):.0f} %" for part in (caught + ended, caught + ended + since)]
        cells = [files, mine[0][1], len(mine), caught, ended, missed, *share]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    path = ROOT / "CONTRIBUTING.md"
    before, rest = path.read_text().split(MARKERS[0])
    after = rest.split(MARKERS[1])[1]
    path.write_text(before + MARKERS[0] + "\n" + "\n".join(lines) + "\n" + MARKERS[1] + after)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", choices=[[], *MODULES], help="which; all without it")
    parser.add_argument("--sample", type=int, metavar="N", help="how many of each module")
    parser.add_argument("--seed", type=int, default=1, help="which of them")
    parser.add_argument("--commit", default="HEAD", help="of which state of the code")
    parser.add_argument("--again", action="store_true", help="try those that were not caught once more")
    parser.add_argument("--table", action="store_true", help="write the table from the results there are")
    arguments = parser.parse_args()
    rows = stored()

    def write():
        order = list(MODULES)
        rows.sort(key=lambda row: order.index(row[0]))
        new = RESULTS.with_suffix(".new")
        with open(new, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
        new.replace(RESULTS)

    commit = output("git", "rev-parse", "--short", arguments.commit).strip()
    for module in [] if arguments.table else arguments.modules or MODULES:
        if arguments.again:
            again(module, commit, rows, write)
        else:
            sample(module, arguments.sample, arguments.seed, commit, rows, write)
    table(rows)


if __name__ == "__main__":
    main()
