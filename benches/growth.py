#!/usr/bin/env python3
"""How the cost of the command grows: instructions by valgrind against rows, samples, members, and the order of `taylor` under forces.

    cargo build --release -p polhode-cli
    python3 benches/growth.py target/release/polhode

Each series doubles a size some times. The exponent is that of the last doubling, without what the first row costs: 1 is a cost for each
row, sample or member, 2 of the order one that grows as its square. Instructions do not depend on what else the machine does. Exits with 1
where an exponent is above its bound.
"""

import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

BODY = ["--moments", "1,2,2.6", "--omega", "0.3,0.8,0.5"]
# name, sizes, bound
SERIES = [
    ("rows of the exact motion", [1_000, 2_000, 4_000], 1.05),
    ("rows of rk4", [1_000, 2_000, 4_000], 1.05),
    ("samples of a fit", [20_000, 40_000, 80_000], 1.15),
    ("members of an ensemble", [128, 256, 512], 1.05),
    ("order of taylor, free", [10, 20, 40], 2.1),
    ("order of taylor, gravity gradient on a circle", [10, 20, 40], 2.1),
    ("order of taylor, gravity gradient on an ellipse", [10, 20, 40], 2.1),
    ("order of taylor, drag", [10, 20, 40], 2.1),
]
FORCES = {
    "free": [],
    "gravity gradient on a circle": ["--gravity-gradient", "1e-3"],
    "gravity gradient on an ellipse": ["--gravity-gradient", "1e-3,0.1"],
    "drag": ["--drag", "1e-3,1e-3"],
}
ENSEMBLE = """
[body]
moments = [1.0, 2.0, 2.6]
[start]
omega = [0.3, 0.8, 0.5]
[spread]
omega = 0.01
[run]
members = {size}
seed = 1
method = "rk4"
step = 0.01
until = 2.0
every = 1.0
"""


def command(name, size, folder):
    """The arguments of one run."""
    if name == "rows of the exact motion":
        return ["propagate", *BODY, "--until", str(size), "--every", "1"]
    if name == "rows of rk4":
        return ["propagate", *BODY, "--until", str(size / 8), "--every", "0.125", "--method", "rk4", "--step", "0.125"]
    if name == "samples of a fit":
        return ["fit", str(folder / f"{size}.csv")]
    if name == "members of an ensemble":
        return ["ensemble", str(folder / f"{size}.toml"), "--out", str(folder / f"{size}"), "--threads", "1"]
    force = FORCES[name.split(", ", 1)[1]]
    return ["propagate", *BODY, *force, "--until", "100", "--every", "100", "--method", f"taylor:{size}", "--step", "0.1"]


def prepare(program, name, size, folder):
    """What a run reads."""
    if name == "samples of a fit":
        # with the first seed one of the records seems to have a torque by chance, and is fitted with it too
        record = ["simulate", *BODY, "--until", str(size / 100), "--every", "0.01", "--noise", "0.01", "--seed", "2"]
        with open(folder / f"{size}.csv", "w") as file:
            subprocess.run([program, *record], check=True, stdout=file)
    if name == "members of an ensemble":
        (folder / f"{size}.toml").write_text(ENSEMBLE.format(size=size))


def instructions(arguments):
    """How many a program takes."""
    run = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *arguments]
    found = subprocess.run(run, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True).stderr
    return int(re.search(r"Collected : (\d+)", found)[1])


def main():
    program, failed = sys.argv[1], False
    least = instructions([program, "--version"])
    for name, sizes, bound in SERIES:
        with tempfile.TemporaryDirectory() as folder:
            counts = []
            for size in sizes:
                prepare(program, name, size, Path(folder))
                counts.append(instructions([program, *command(name, size, Path(folder))]) - least)
        exponent = math.log2(counts[-1] / counts[-2])
        failed |= exponent > bound
        listed = ", ".join(f"{size}: {count / 1e6:.1f}" for size, count in zip(sizes, counts))
        print(f"{name}: exponent {exponent:.2f} (at most {bound}); millions of instructions at {listed}", flush=True)
    sys.exit(failed)


if __name__ == "__main__":
    main()
