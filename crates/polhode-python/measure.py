#!/usr/bin/env python3
"""What calls from Python cost: import, one state, arrays, two threads. Least of several trials, as other work only adds.

    python3 crates/polhode-python/measure.py
"""

import os
import subprocess
import sys
import threading
import time

import numpy as np

import polhode

TRIALS = 15


def least(work, trials=TRIALS):
    """The shortest of several times, s."""
    times = []
    for _ in range(trials):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def imported(modules):
    return least(lambda: subprocess.run([sys.executable, "-c", f"import {modules}"], check=True))


def main():
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores, Python {sys.version.split()[0]}, numpy {np.__version__}")
    print(f"import beyond numpy's: {1e3 * (imported('numpy, polhode') - imported('numpy')):.1f} ms")
    motion = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    at, calls = motion.at, range(10_000)

    def scalars():
        for _ in calls:
            at(12.5)

    print(f"one state: {1e9 * least(scalars) / len(calls):.0f} ns")
    t = np.linspace(0, 1e4, 1_000_000)
    alone = least(lambda: at(t))
    print(f"a million states: {1e3 * alone:.1f} ms, {1e9 * alone / t.size:.0f} ns a state")

    def together(count):
        threads = [threading.Thread(target=at, args=(t,)) for _ in range(count)]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]

    print(f"two threads: {2 * least(lambda: together(1)) / least(lambda: together(2)):.2f} times one")
    package = os.path.dirname(polhode.__file__)
    size = sum(os.path.getsize(os.path.join(package, name)) for name in os.listdir(package) if name.endswith((".so", ".pyd")))
    print(f"compiled half: {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
