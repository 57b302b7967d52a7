#!/usr/bin/env python3
"""Audits the logs that simulators wrote, and writes the table of docs/python.md.

    python3 crates/polhode-python/simulators.py           writes it
    python3 crates/polhode-python/simulators.py --check   fails if it is not what would be written

Needs the package polhode, and Python 3.11 or later.
"""

import pathlib
import sys
import tomllib

import polhode

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOGS = ROOT / "crates/polhode-cli/tests/data/programs"
PAGE = ROOT / "docs/python.md"
BEGIN, END = "<!-- begin simulators -->\n", "<!-- end simulators -->"

# log, what was simulated, body, how it is read, which body of the log, tolerance
CASES = [
    ("mujoco-euler.csv", "default integrator", [1, 2, 2.5], {}, None, 1e-6),
    ("mujoco-implicit.csv", "implicit", [1, 2, 2.5], {}, None, 1e-6),
    ("mujoco-implicitfast.csv", "implicitfast", [1, 2, 2.5], {}, None, 1e-6),
    ("mujoco-rk4.csv", "RK4", [1, 2, 2.5], {}, None, 1e-6),
    ("lammps-digits.dump", "fix nve/asphere", [0.05, 0.068, 0.082], {}, "1", 1e-6),
    (
        "lammps-rigid.dump",
        "fix rigid/nve",
        [1.16, 2.18, 2.98],
        {
            "time_unit": 0.02,
            "columns": "t=timestep,qw=c_r[2],qx=c_r[3],qy=c_r[4],qz=c_r[5],wx=c_r[6],wy=c_r[7],wz=c_r[8]",
        },
        None,
        1e-6,
    ),
    ("basilisk.csv", "spacecraft, RK4", [10, 20, 26], {}, None, 1e-6),
    ("drake.csv", "default accuracy", [1, 2, 2.6], {}, None, 1e-6),
    ("drake.csv", "the same, to 1e-2", [1, 2, 2.6], {}, None, 1e-2),
]


def number(x):
    return "" if x is None else f"{x:.1e}"


def words(verdict):
    """The verdict in one line."""
    if verdict.verdict == "right":
        return "every row and column within the tolerance"
    found = verdict.integrator
    if found:
        energy = found["measured_energy_change"]
        lost = f"; energy off by {abs(energy):.0e}" if energy is not None and abs(energy) > 1e-6 else ""
        return f"steps like `{found['method']}`, h = {found['step']:g}{lost}"
    if verdict.suspect != "none":
        return verdict.suspect
    kept = [name for name, line in verdict.conservation.items() if line["conserved"]]
    return f"outside the tolerance; kept: {len(kept)} of {len(verdict.conservation)} invariants"


def table():
    programs = tomllib.loads((LOGS / "programs.toml").read_text())
    lines = [
        "| program | simulated | verdict | energy | L in space | attitude [rad] | why |",
        "| :--- | :--- | :--- | ---: | ---: | ---: | :--- |",
    ]
    for log, what, moments, reading, name, tolerance in CASES:
        found = polhode.read(LOGS / log, **reading)
        verdict = polhode.audit(found[name] if name else found, moments=moments, tolerance=tolerance, advice=False)
        program = programs[log]["program"].split(",")[0]
        numbers = map(number, (verdict.energy_error, verdict.momentum_vector_error, verdict.attitude_error))
        lines.append(f"| {program} | {what} | {verdict.verdict} | {' | '.join(numbers)} | {words(verdict)} |")
    return "\n".join(lines) + "\n"


def main():
    before, rest = PAGE.read_text().split(BEGIN)
    _, after = rest.split(END)
    text = before + BEGIN + table() + END + after
    if sys.argv[1:] == ["--check"]:
        if text != PAGE.read_text():
            sys.exit("docs/python.md: the table of simulators is not what the logs say; run simulators.py")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        PAGE.write_text(text)


if __name__ == "__main__":
    main()
