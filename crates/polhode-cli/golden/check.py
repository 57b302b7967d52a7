"""Largest angle between the attitudes of RUN.csv and GOLDEN.csv: python3 check.py GOLDEN.csv RUN.csv [TOLERANCE]"""
import csv, math, sys

def rows(name):
    with open(name) as file:
        return [{key: float(row[key]) for key in ("t", "q_w", "q_x", "q_y", "q_z")}
                for row in csv.DictReader(line for line in file if line[0] != "#")]

golden, run = rows(sys.argv[1]), rows(sys.argv[2])
tolerance = float(sys.argv[3]) if len(sys.argv) > 3 else 1e-6
near, worst, found, k = 1e-6 * (golden[1]["t"] - golden[0]["t"]), 0.0, 0, 0
for g in golden:
    while k < len(run) and run[k]["t"] < g["t"] - near:
        k += 1
    if k < len(run) and run[k]["t"] <= g["t"] + near:
        a, b = ([row["q_" + c] for c in "wxyz"] for row in (g, run[k]))
        along = sum(x * y for x, y in zip(a, b))  # scalar part of a* b
        across = math.hypot(*(a[0]*b[i] - b[0]*a[i] - a[j]*b[l] + a[l]*b[j] for i, j, l in ((1, 2, 3), (2, 3, 1), (3, 1, 2))))
        worst, found = max(worst, 2 * math.atan2(across, abs(along)) if along == along else math.inf), found + 1
print(f"{found} of {len(golden)} rows compared, largest angle {worst:.3e} rad, allowed {tolerance:.1e}")
sys.exit(0 if found == len(golden) and worst <= tolerance else 1)
