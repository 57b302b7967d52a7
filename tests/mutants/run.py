#!/usr/bin/env python3
"""How many small faults the tests find: samples of mutants by module.

    cargo install cargo-mutants --version 27.1.0 --locked
    python3 tests/mutants/run.py method run            (python 3.11, nothing beside it; less than a minute a mutant)
    python3 tests/mutants/run.py --total 150 --seed 2 method audit   so many, in proportion to what each module has
    python3 tests/mutants/run.py --again run           those that were not caught, with the tests of the present commit
    python3 tests/mutants/run.py --table               only the table of CONTRIBUTING.md, from results.csv

A mutant is one changed operator, constant or return value. Those of a module are put in an order that only --seed and
their text decide; the first that compile are the sample. It is written to results.csv before any of it is tried, and so is
each result at once: run again, the script goes on where it was stopped. All mutants of a sample are built together, in a
clone beside the target folder (switches.py); a constant, which the compiler works out, takes a build of its own.

Of each mutant those tests are run that can see it, the likeliest first, up to the first that fails; examples of the
documentation are not among them. A mutant is caught if a test fails, and fails again: tests that measure times may fail by
themselves. One whose tests do not end in five times their usual time is a timeout: it counts as caught, and is counted
apart. `by` names the test that failed, `again` what became of the mutant at a later commit, or, written by hand, why it is
equivalent: no answer differs.
"""

import argparse
import csv
import hashlib
import json
import os
import re
import signal
import subprocess
import threading
import time
from pathlib import Path

from switches import SWITCH, VARIABLE, Source, switched

ROOT = Path(__file__).resolve().parents[2]
CLONE = ROOT / "target" / "mutants"
RESULTS = Path(__file__).with_name("results.csv")
COLUMNS = ["module", "of", "seed", "commit", "mutant", "outcome", "by", "again"]
MARKERS = ("<!-- begin generated: mutants -->", "<!-- end generated: mutants -->")

# files, size of the sample, and programs of tests with the parts of the names of those that are run; `polhode` and
# `polhode_fit` stand beside the code, `library` and `cli` are tests/main.rs and the command's
ALL = ["polhode", "library"]
MODULES = {
    "num": (["src/num/**"], 150, ["library num::", *ALL]),
    "rotation": (["src/rotation/**"], 45, ["library rotation:: euler:: properties:: laws::", *ALL]),
    "flow": (["src/flow/free/theta/**", *(f"src/flow/free/{name}.rs" for name in ("circulation", "polhode", "phase")), "src/flow/lagrange/cubic.rs", "src/flow/lagrange/nutation.rs"], 45, ["library exact:: properties:: tops::", *ALL]),
    "method": (["src/method/**"], 60, ["library units::a_run", "library laws:: schemes:: two_turns:: programs::", *ALL]),
    "observe": (["src/observe/**"], 30, ["library units::a_run", "library observe:: properties:: forces::", *ALL]),
    "run": (["src/run/**", "src/events/**"], 30, ["library units::a_run", "library events:: switched:: adaptive:: ensemble:: observe:: forces::", *ALL]),
    "advise": (["src/advise/**"], 30, ["polhode advise::", "library advise:: hostile::", "cli advise::"]),
    "audit": (["src/audit/**"], 50, ["library audit::units::", "polhode audit::", "library audit:: hostile::", "cli audit::"]),
    "fit": (["crates/polhode-fit/src/**"], 25, ["polhode_fit", "suite"]),
}
PACKAGES = {"polhode": "polhode", "library": "polhode-tests", "cli": "polhode-cli", "polhode_fit": "polhode-fit", "suite": "polhode-fit"}
# tests may take so many times as long as without a mutant, and this, s
PATIENCE = (5, 60)
# tests that are not run, since they take minutes
MINUTES = (ROOT / ".ci" / "minutes").read_text().split()


def output(*command, cwd=ROOT):
    return subprocess.run(command, cwd=cwd, check=True, capture_output=True, text=True).stdout


def mutants(module):
    """All of a module, in the clone."""
    chosen = [part for file in MODULES[module][0] for part in ("--file", file)]
    return json.loads(output("cargo", "mutants", "--list", "--json", *chosen, cwd=CLONE))


def checkout(commit):
    """The clone at `commit`, unchanged."""
    if not (CLONE / ".git").exists():
        subprocess.run(["git", "clone", "--quiet", ROOT, CLONE], check=True)
    subprocess.run(["git", "fetch", "--quiet", "origin"], cwd=CLONE, check=True)
    subprocess.run(["git", "checkout", "--quiet", "--force", commit], cwd=CLONE, check=True)


def source(mutant):
    return Source((CLONE / mutant["file"]).read_text())


def switch(commit, numbered):
    """Writes pairs of number and mutant into the clone; which lines of which file are whose: file, number, first, last."""
    checkout(commit)
    places, roots = [], set()
    for file in sorted({mutant["file"] for _, mutant in numbered}):
        text, lines = switched(Source((CLONE / file).read_text()), [one for one in numbered if one[1]["file"] == file])
        (CLONE / file).write_text(text)
        places += [(file, *line) for line in lines]
        roots.add(file.split("src/")[0] + "src/lib.rs")
    for root in roots:
        with open(CLONE / root, "a") as library:
            library.write(SWITCH)
    return places


def cargo(*arguments):
    """What it says of each package, and whether it succeeded."""
    command = ["cargo", *arguments, "--all-features", "--message-format", "json"]
    ended = subprocess.run(command, cwd=CLONE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return [json.loads(line) for line in ended.stdout.splitlines() if line.startswith("{")], ended.returncode == 0


def check(package):
    """Places of what does not compile: file and line; `None` if all does."""
    said, compiles = cargo("check", "--lib", "--package", package)
    if compiles:
        return None
    errors = [one["message"] for one in said if one["reason"] == "compiler-message" and one["message"]["level"] == "error"]
    return [(span["file_name"], span["line_start"]) for error in errors for span in error["spans"] if span["is_primary"]]


def unviable(commit, every, package):
    """Those of `every` that do not compile, by name."""
    lost = set()
    while True:
        left = [(number, one) for number, one in enumerate(every, 1) if one["name"] not in lost and source(one).function(one)]
        places = switch(commit, left)
        wrong = check(package)
        if wrong is None:
            break
        found = {number for file, number, first, last in places for at, line in wrong if at == file and first <= line <= last}
        if not found:
            raise SystemExit(f"the switches themselves do not compile: {wrong}")
        lost |= {every[number - 1]["name"] for number in found}
        checkout(commit)
    checkout(commit)
    for mutant in (one for one in every if not source(one).function(one)):
        before = source(mutant)
        (CLONE / mutant["file"]).write_text(before.mutated(mutant))
        if check(package) is not None:
            lost.add(mutant["name"])
        (CLONE / mutant["file"]).write_text(before.text)
    return lost


def build(modules):
    """The programs of tests by name, each with the folder that it runs in; `None` if they do not compile."""
    packages = sorted({PACKAGES[stage.split()[0]] for module in modules for stage in MODULES[module][2]})
    said, compiles = cargo("test", "--no-run", "--tests", *(part for package in packages for part in ("--package", package)))
    made = [one for one in said if one["reason"] == "compiler-artifact" and one["profile"]["test"] and one["executable"]]
    return {one["target"]["name"]: (one["executable"], Path(one["manifest_path"]).parent) for one in made} if compiles else None


def tests(program, filters, number, limit=None):
    """`passed`, `timeout`, `aborted`, or the first test that failed with the mutant `number`."""
    executable, folder = program
    # a group of its own, so that commands which tests run end with them
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "start_new_session": True}
    late = threading.Event()
    with subprocess.Popen([executable, *filters, "--include-ignored", *MINUTES], cwd=folder, env={**os.environ, VARIABLE: str(number)}, **pipes) as run:

        def end():
            late.set()
            os.killpg(run.pid, signal.SIGKILL)

        watch = threading.Timer(limit, end) if limit else None
        try:
            if watch:
                watch.start()
            for line in run.stdout:
                if failed := re.match(r"test (\S+).* \.\.\. FAILED", line):
                    os.killpg(run.pid, signal.SIGKILL)
                    return failed[1]
        finally:
            if watch:
                watch.cancel()
    return "timeout" if late.is_set() else "passed" if run.returncode == 0 else "aborted"


class Tests:
    """Those of the modules, built; how long they take without a mutant."""

    def __init__(self, modules):
        self.programs = build(modules)
        if self.programs is None:
            raise SystemExit("the tests do not compile")
        self.limits = {}
        for stage in sorted({stage for module in modules for stage in MODULES[module][2]}):
            name, *filters = stage.split()
            begin = time.monotonic()
            if (found := tests(self.programs[name], filters, 0)) != "passed":
                raise SystemExit(f"{stage}: {found} without a mutant")
            times, least = PATIENCE
            self.limits[stage] = least + times * (time.monotonic() - begin)
            print(f"{stage}: {time.monotonic() - begin:.0f} s", flush=True)

    def outcome(self, module, number):
        """What the tests say of a mutant, and which of them."""
        done = {}
        for stage in MODULES[module][2]:
            name, *filters = stage.split()
            # those that have passed before are not run again
            skipped = [part for one in done.get(name, []) for part in ("--skip", one)]
            found = tests(self.programs[name], filters + skipped, number, self.limits[stage])
            if found == "timeout":
                return found, ""
            again = filters + skipped if found == "aborted" else ["--exact", found]
            if found != "passed" and tests(self.programs[name], again, number, self.limits[stage]) != "passed":
                return "caught", found
            done[name] = done.get(name, []) + filters
        return "missed", ""


def tried(commit, wanted, tell):
    """Tries `wanted`, pairs of a module and a mutant; `tell` is given the place of each with its outcome."""
    checkout(commit)
    modules = {module for module, _ in wanted}
    own = [place for place, (_, mutant) in enumerate(wanted) if not source(mutant).function(mutant)]
    together = [place for place in range(len(wanted)) if place not in own]
    switch(commit, [(place + 1, wanted[place][1]) for place in together])
    program = Tests(modules)
    for place in together:
        tell(place, *program.outcome(wanted[place][0], place + 1))
    for place in own:
        checkout(commit)
        module, mutant = wanted[place]
        (CLONE / mutant["file"]).write_text(source(mutant).mutated(mutant))
        program.programs = build(modules)
        tell(place, *(program.outcome(module, 0) if program.programs else ("unviable", "")))
    checkout(commit)


def sizes(modules, total, sample):
    """How many of each module: `total` in proportion to what each has, or `sample`, or as many as usual."""
    if not total:
        return {module: sample or MODULES[module][1] for module in modules}
    counts = {module: len(mutants(module)) for module in modules}
    shares = {module: total * counts[module] / sum(counts.values()) for module in modules}
    chosen = {module: int(shares[module]) for module in modules}
    for module in sorted(modules, key=lambda module: chosen[module] - shares[module])[: total - sum(chosen.values())]:
        chosen[module] += 1
    return chosen


def draw(module, size, seed, commit, rows):
    """Puts a sample into `rows`, not tried yet, with those before its last that do not compile."""
    every = mutants(module)
    every.sort(key=lambda one: hashlib.sha256(f"{seed} {one['name']}".encode()).digest())
    package = PACKAGES[MODULES[module][2][0].split()[0]]
    lost, looked = set(), 0
    while (viable := looked - len(lost)) < min(size, len(every) - len(lost)):
        more = every[looked : looked + int(1.3 * (size - viable)) + 3]
        lost |= unviable(commit, more, package)
        looked += len(more)
    taken = 0
    for mutant in every:
        if taken == size:
            break
        compiles = mutant["name"] not in lost
        taken += compiles
        rows.append([module, str(len(every)), str(seed), commit, mutant["name"], "" if compiles else "unviable", "", ""])


def sample(modules, wanted, seed, commit, rows, write):
    """Tries the mutants of the samples that were not tried yet."""
    checkout(commit)
    for module, size in sizes(modules, *wanted).items():
        if not any(row[0] == module and row[2:4] == [str(seed), commit] for row in rows):
            draw(module, size, seed, commit, rows)
            write()
    checkout(commit)
    named = {one["name"]: one for module in modules for one in mutants(module)}
    missing = [row for row in rows if row[0] in modules and row[2:4] == [str(seed), commit] and not row[5]]

    def tell(place, *found):
        missing[place][5:7] = found
        print(f"{found[0]:8} {missing[place][4]} {found[1]}", flush=True)
        write()

    if missing:
        tried(commit, [(row[0], named[row[4]]) for row in missing], tell)


def again(modules, commit, rows, write):
    """Tries those of the last samples that were not caught once more, where the present code still has them."""
    checkout(commit)
    # by file and text; of several those of the nearest line
    place = re.compile(r"(.+?):(\d+):\d+: (.*)", re.DOTALL)
    every = [(place.fullmatch(one["name"]), one) for module in modules for one in mutants(module)]
    wanted = []
    for row in [row for module in modules for row in last(rows, module) if row[5] in ("missed", "timeout") and not row[7].startswith("equivalent")]:
        file, line, text = place.fullmatch(row[4]).groups()
        alike = [(abs(int(at[2]) - int(line)), one["name"], one) for at, one in every if (at[1], at[3]) == (file, text)]
        if alike:
            wanted.append((row, min(alike)[2]))
        else:
            row[7] = f"gone at {commit}"

    def tell(place, found, by):
        wanted[place][0][7] = f"{found} at {commit}" + (f" by {by}" if by else "")
        print(f"{found:8} {wanted[place][0][4]} {by}", flush=True)
        write()

    write()
    if wanted:
        tried(commit, [(row[0], one) for row, one in wanted], tell)


def last(rows, module):
    """Those of the last sample of a module that was tried to its end."""
    mine = [row for row in rows if row[0] == module]
    untried = {tuple(row[2:4]) for row in mine if not row[5]}
    mine = [row for row in mine if tuple(row[2:4]) not in untried]
    return [row for row in mine if row[2:4] == mine[-1][2:4]]


def stored():
    if not RESULTS.exists():
        return []
    with open(RESULTS, newline="") as file:
        return [row + [""] * (len(COLUMNS) - len(row)) for row in list(csv.reader(file))[1:]]


def table(rows):
    """Between the markers of CONTRIBUTING.md: the last sample of each module that is finished."""
    heads = ["files", "mutants", "tried", "caught", "no end", "missed", "share caught", "with the tests since"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for module in MODULES:
        mine = [row for row in last(rows, module) if row[5] not in ("", "unviable")]
        if not mine:
            continue
        caught, ended, missed = (sum(row[5] == found for row in mine) for found in ("caught", "timeout", "missed"))
        since = sum(row[5] == "missed" and row[7].startswith(("caught", "gone")) for row in mine)
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
    parser.add_argument("--total", type=int, metavar="N", help="how many of all modules, in proportion to what each has")
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
    modules = arguments.modules or list(MODULES)
    if arguments.again:
        again(modules, commit, rows, write)
    elif not arguments.table:
        sample(modules, (arguments.total, arguments.sample), arguments.seed, commit, rows, write)
    table(rows)


if __name__ == "__main__":
    main()
