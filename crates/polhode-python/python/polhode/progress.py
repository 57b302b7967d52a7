"""A bar for long work, in terminals and notebooks: `polhode.run(..., progress=polhode.progress.bar)`."""

from __future__ import annotations

import sys

__all__ = ["bar"]

WIDTH = 30


def bar(stage: str, done: float, seconds: float | None = None) -> None:
    """Shows on standard error what is being done, which part of it is done, and about how long all of it takes.

    >>> import polhode
    >>> from polhode.progress import bar
    >>> advice = polhode.advise([1, 2, 3], [0.4, 1, -0.3], until=100, attitude_error=1e-6, progress=bar)
    """
    full = round(WIDTH * min(max(done, 0.0), 1.0))
    of = "" if seconds is None else f" of about {seconds:.0f} s"
    sys.stderr.write(f"\r{stage[:40]:40} [{'#' * full}{' ' * (WIDTH - full)}] {100 * done:3.0f} %{of}\033[K")
    if done >= 1.0:
        sys.stderr.write("\n")
    sys.stderr.flush()
