"""What the tests share: the folder of the project, and the command beside which results are held."""

import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAMS = ROOT / "crates/polhode-cli/tests/data/programs"


def command_path():
    """The binary of the command: that of POLHODE_COMMAND, or one that cargo has built."""
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    built = [target / profile / "polhode" for profile in ("release", "debug")]
    asked = os.environ.get("POLHODE_COMMAND")
    found = [pathlib.Path(asked)] if asked else [path for path in built if path.is_file()]
    return max(found, key=lambda path: path.stat().st_mtime, default=None)


@pytest.fixture
def command(tmp_path):
    """Runs the command in an empty folder; the JSON that it prints, whatever it judges."""
    binary = command_path()
    if binary is None:
        pytest.skip("the command polhode is not built; POLHODE_COMMAND names one")

    def run(*arguments, format="json"):
        words = [binary, *map(str, arguments), *(["--format", format] if format else [])]
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        return json.loads(done.stdout) if format == "json" else done.stdout

    run.folder = tmp_path
    return run


def stl_of_an_open_cube():
    """A cube of 20 mm without its last triangle."""
    corners = [[20 * (k & 1), 20 * (k >> 1 & 1), 20 * (k >> 2)] for k in range(8)]
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    halves = [half for a, b, c, d in faces for half in ([a, b, c], [a, c, d])][:11]
    lines = ["solid part"]
    for half in halves:
        vertices = ["vertex {} {} {}".format(*corners[k]) for k in half]
        lines += ["facet normal 0 0 0", "outer loop", *vertices, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part", ""])
