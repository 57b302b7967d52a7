"""Slope of a line through 16 points and its 95 % interval: prints the rows SLOPES of tests/observe.rs.

    python3 tests/data/observe/regression.py        (mpmath 1.3, 30 digits)
"""

import mpmath as mp

mp.mp.dps = 30
NOISE = "0.3 -0.1 0.4 0.1 -0.5 0.9 -0.2 0.6 -0.5 0.3 0.5 -0.8 0.9 -0.7 0.9 0.3"


def student(t, n):
    """Distribution function of Student's t with n degrees of freedom at t > 0."""
    return 1 - mp.betainc(mp.mpf(n) / 2, mp.mpf(1) / 2, 0, n / (n + t * t), regularized=True) / 2


noise = [mp.mpf(float(value)) for value in NOISE.split()]
times = [mp.mpf(k) for k in range(16)]
quantile = mp.findroot(lambda t: student(t, 14) - mp.mpf("0.975"), 2.14)
for trend in (0.0, 0.1, -0.2):
    values = [mp.mpf(trend) * t + e for t, e in zip(times, noise)]
    t_mean, mean = sum(times) / 16, sum(values) / 16
    spread = sum((t - t_mean) ** 2 for t in times)
    slope = sum((t - t_mean) * (y - mean) for t, y in zip(times, values)) / spread
    residual = sum((y - mean - slope * (t - t_mean)) ** 2 for t, y in zip(times, values))
    half_width = quantile * mp.sqrt(residual / 14 / spread)
    secular = str(bool(abs(slope) > half_width)).lower()
    print(f"({trend}, {mp.nstr(slope, 17)}, {mp.nstr(half_width, 17)}, {secular}),")
