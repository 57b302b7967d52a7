#!/usr/bin/env python3
"""What calls from Python cost: import, one state, arrays, two threads. Least of several trials, as other work only adds; POSIX.

    python3 crates/polhode-python/measure.py

With `--library` arrays are compared with the library itself, which cargo builds for it: the example `array_cost`, least of as many trials.
"""

import os
import pathlib
import resource
import subprocess
import sys
import threading
import time

import numpy as np

import polhode

def least(work, trials, clock=time.perf_counter):
    """The shortest of several times, s."""
    times = []
    for _ in range(trials):
        begun = clock()
        work()
        times.append(clock() - begun)
    return min(times)


def imported(modules):
    """Processor time of a Python that imports these, s."""

    def spent():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    return least(lambda: subprocess.run([sys.executable, "-c", f"import {modules}"], check=True), 15, spent)


def library():
    """Time of a state by the library itself, s, of arrays of these lengths."""
    root = pathlib.Path(__file__).parents[2]
    command = ["cargo", "run", "--release", "--quiet", "--example", "array_cost"]
    found = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout
    return {int(count): float(seconds) for count, seconds in (line.split() for line in found.splitlines())}


def calls(work, threads, seconds=4.0):
    """How often so many threads do `work` in that time, all together."""
    counts, end = [0] * threads, time.perf_counter() + seconds

    def repeat(k):
        while time.perf_counter() < end:
            work()
            counts[k] += 1

    all_of_them = [threading.Thread(target=repeat, args=(k,)) for k in range(threads)]
    [thread.start() for thread in all_of_them]
    [thread.join() for thread in all_of_them]
    return sum(counts)


def main():
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores, Python {sys.version.split()[0]}, numpy {np.__version__}")
    print(f"import beyond numpy's: {1e3 * (imported('numpy, polhode') - imported('numpy')):.1f} ms of processor time")
    motion = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    at, ten = motion.at, range(1000)

    def scalars():
        for _ in ten:
            at(12.5)

    print(f"one state: {1e9 * least(scalars, 300) / len(ten):.0f} ns")
    t = np.linspace(0, 1e4, 1_000_000)
    alone = library() if "--library" in sys.argv else {}
    for count, trials in ((1_000, 1000), (10_000, 300), (100_000, 50)):
        few = t[:count].copy()
        seconds = least(lambda: at(few), trials) / count
        beside = f", {seconds / alone[count]:.2f} times the library's {1e9 * alone[count]:.1f}" if count in alone else ""
        print(f"{count} states: {1e9 * seconds:.1f} ns a state{beside}")
    print(f"1000000 states: {1e9 * least(lambda: at(t), 15, time.process_time) / t.size:.1f} ns of processor time a state")
    part = t[:100_000]
    ratios = [calls(lambda: at(part), 2) / calls(lambda: at(part), 1) for _ in range(3)]
    print(f"two threads: {', '.join(f'{ratio:.2f}' for ratio in sorted(ratios))} times one")
    package = os.path.dirname(polhode.__file__)
    size = sum(os.path.getsize(os.path.join(package, name)) for name in os.listdir(package) if name.endswith((".so", ".pyd")))
    print(f"compiled half: {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
