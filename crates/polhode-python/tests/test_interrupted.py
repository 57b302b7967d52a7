"""Ctrl-C ends every long computation."""

import signal
import subprocess
import sys
import time

import pytest

# a file that is read for as long as nobody writes it
ENDLESS = "import os, tempfile; name = os.path.join(tempfile.mkdtemp(), 'log.csv'); os.mkfifo(name); "

LONG = {
    "motion": "polhode.FreeMotion([1, 2, 3], [.4, 1, -.3]).at(numpy.zeros(30_000_000))",
    "run": "polhode.run('rk4', [1, 2, 3], [.4, 1, -.3], times=[0, 1e9], step=1e-2)",
    "force": "polhode.run('rk4', polhode.Body([1, 2, 3], [polhode.force('f', lambda t, q, w: -w * 1e-9)]), [.4, 1, -.3], times=[0, 1e9], step=1e-2)",
    "ensemble": "polhode.Ensemble([1, 2, 3], numpy.tile([.4, 1, -.3], (100000, 1))).run('rk4', times=numpy.arange(3) * 1e3, step=1e-2)",
    "advise": "[polhode.advise([1, 2, 3], [.4, 1, -.3], until=1e6, attitude_error=1e-9, exclude=['exact']) for _ in range(1000)]",
    "record": ENDLESS + "polhode.read(name, kind='record')",
    "table": ENDLESS + "polhode.read(name)",
    "mesh": ENDLESS.replace("csv", "stl") + "polhode.read(name, mass=1)",
}


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_long_work(name):
    program = f"import numpy, polhode\nprint('begun', flush=True)\ntry:\n    {LONG[name]}\n    print('ended')\nexcept KeyboardInterrupt:\n    print('interrupted')\n"
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    try:
        assert child.stdout.readline() == "begun\n"
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate(timeout=60)
    finally:
        child.kill()
    assert out == "interrupted\n"
