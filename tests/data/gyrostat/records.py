"""Writes records.csv: rows of the cases of programs.py as scipy follows them, from the start on, for audits of trajectories.

    python3 tests/data/gyrostat/records.py        (python 3.11 with numpy and scipy)
"""

import csv
import platform
from pathlib import Path

import numpy
import programs
import scipy

# the motor of the case switched begins and ends between two rows
TIMES = [float(t) for t in range(1, 41)]


def main():
    programs.TIMES = TIMES
    start = numpy.concatenate((programs.ATTITUDE, programs.RATE))
    with open(Path(__file__).with_name("records.csv"), "w", newline="") as file:
        file.write(
            f"# python {platform.python_version()}, numpy {numpy.__version__}, scipy {scipy.__version__}; "
            "tests/data/gyrostat/records.py\n"
        )
        write = csv.writer(file, lineterminator="\n").writerow
        write(["case", "t", "q_w", "q_x", "q_y", "q_z", "omega_x", "omega_y", "omega_z"])
        for name, wheels in programs.CASES.items():
            rows = numpy.vstack((start, programs.scipy_rows(wheels, 2.3e-14)))
            for t, row in zip([0.0, *TIMES], rows):
                write([name, t, *(repr(float(x)) for x in row)])


if __name__ == "__main__":
    main()
