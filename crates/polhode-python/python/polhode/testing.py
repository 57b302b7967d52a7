"""A check of rotations for the tests of other programs.

>>> import numpy, polhode
>>> from polhode.testing import assert_rotation_right
>>> t = numpy.arange(200) * 0.1
>>> attitude, omega = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at(t)
>>> verdict = assert_rotation_right(t, attitude, omega, moments=[1, 2, 3])
>>> verdict.attitude_error < 1e-12
True
"""

from __future__ import annotations

from typing import Any

from polhode._polhode import Verdict, audit

__all__ = ["assert_rotation_right"]


def assert_rotation_right(t: Any, attitude: Any = None, omega: Any = None, **question: Any) -> Verdict:
    """Raises `AssertionError` with the whole verdict unless `polhode.audit` finds the trajectory right.

    Takes what `polhode.audit` takes, and returns its verdict. State `order`, `direction` and `omega_frame`, so that a test also
    fails when a convention changes.

    >>> import numpy
    >>> t = numpy.arange(100) * 0.1
    >>> half = numpy.column_stack([numpy.cos(t / 2), 0 * t, 0 * t, numpy.sin(t / 2)])
    >>> assert_rotation_right(t, half, numpy.tile([0, 0, 0.5], (100, 1)), moments=[1, 2, 3])
    Traceback (most recent call last):
        ...
    AssertionError: record: wrong...
    """
    __tracebackhide__ = True
    verdict = audit(t, attitude, omega, **question)
    if not verdict.is_right:
        raise AssertionError(str(verdict))
    return verdict
