"""What the scripts share that run other programs beside polhode: rigid bodies for heyoka, angles between attitudes, times, places of tables.

Attitudes are unit quaternions, scalar first, from body to space; angular velocities and torques are in body axes.
"""

import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]


def turning(q, omega):
    """The equations of the attitude q, as heyoka takes them."""
    (w, x, y, z), (a, b, c) = q, omega
    return [
        (w, -0.5 * (x * a + y * b + z * c)),
        (x, 0.5 * (w * a + y * c - z * b)),
        (y, 0.5 * (w * b + z * a - x * c)),
        (z, 0.5 * (w * c + x * b - y * a)),
    ]


def spinning(moments, omega, torque=(0.0, 0.0, 0.0)):
    """Euler's equations of the angular velocity, as heyoka takes them."""
    found = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        found.append((omega[k], ((moments[i] - moments[j]) * omega[i] * omega[j] + torque[k]) / moments[k]))
    return found


def to_body(q):
    """Rows of the matrix from space to body."""
    q0, q1, q2, q3 = q
    return [
        [1 - 2 * (q2 * q2 + q3 * q3), 2 * (q1 * q2 + q0 * q3), 2 * (q1 * q3 - q0 * q2)],
        [2 * (q1 * q2 - q0 * q3), 1 - 2 * (q1 * q1 + q3 * q3), 2 * (q2 * q3 + q0 * q1)],
        [2 * (q1 * q3 + q0 * q2), 2 * (q2 * q3 - q0 * q1), 1 - 2 * (q1 * q1 + q2 * q2)],
    ]


def gradient(moments, strength, place):
    """Torque of the gravity gradient, s p × I p: `place` p from the centre in body axes, `strength` s = 3 GM/r⁵."""
    found = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        found.append(strength * (moments[j] - moments[i]) * place[i] * place[j])
    return found


def apart(found, right):
    """Angles between attitudes in rows, rad."""
    found = found / np.linalg.norm(found, axis=1)[:, None]
    right = right / np.linalg.norm(right, axis=1)[:, None]
    a, u = right[:, 0], -right[:, 1:]
    b, w = found[:, 0], found[:, 1:]
    real = a * b - np.einsum("ij,ij->i", u, w)
    imaginary = a[:, None] * w + b[:, None] * u + np.cross(u, w)
    return 2 * np.arctan2(np.linalg.norm(imaginary, axis=1), np.abs(real))


def timed(work, rounds):
    """What `work` gives, and its least processor time, s."""
    least, found = float("inf"), None
    for _ in range(rounds):
        clock = time.process_time()
        found = work()
        least = min(least, time.process_time() - clock)
    return found, least


def put(page, name, text):
    """Writes `text` between the marks `name` of a page of docs."""
    page = ROOT / "docs" / page
    begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
    before, rest = page.read_text().split(begin)
    page.write_text(before + begin + text + end + rest.split(end)[1])
