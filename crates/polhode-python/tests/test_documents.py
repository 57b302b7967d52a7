"""Examples of docstrings run, every public name has one, and the stubs are those of the running module."""

import ast
import decimal
import doctest
import fractions
import inspect
import pathlib
import shutil
import subprocess
import sys
import warnings

import numpy
import pytest

import polhode
import polhode.progress
import polhode.testing
from conftest import PROGRAMS, ROOT, stl_of_an_open_cube

NAMES = [name for name in polhode.__all__ if name not in ("__version__", "testing")]
FOLDER = pathlib.Path(polhode.__file__).parent
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL


def documented():
    """Every public name and member with its docstring."""
    yield "polhode", polhode.__doc__
    yield "polhode.testing", polhode.testing.__doc__
    yield "polhode.progress.bar", polhode.progress.bar.__doc__
    yield "polhode.testing.assert_rotation_right", polhode.testing.assert_rotation_right.__doc__
    for name in NAMES:
        value = getattr(polhode, name)
        yield f"polhode.{name}", value.__doc__
        if inspect.isclass(value):
            for member, of_class in vars(value).items():
                if not member.startswith("_"):
                    yield f"polhode.{name}.{member}", of_class.__doc__


@pytest.mark.parametrize("name, text", list(documented()))
def test_examples_run(name, text):
    assert text and len(text.split()) > 1, f"{name} says nothing"
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=FLAGS)
    test = parser.get_doctest(text, {"assert_rotation_right": polhode.testing.assert_rotation_right}, name, None, 0)
    said = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        runner.run(test, out=said.append)
    assert runner.summarize(verbose=False).failed == 0, "".join(said)


def test_what_people_call_has_an_example():
    without = [name for name in NAMES if callable(getattr(polhode, name)) and ">>>" not in getattr(polhode, name).__doc__]
    # results and what needs no more than its name
    assert set(without) <= {
        "Advice", "Attitudes", "CarrierEstimate", "Estimate", "FittedMotion", "Force", "Link", "Links", "MeasuredBody", "Passage", "PolhodeError", "PolhodeWarning", "Record", "Samples", "States", "SteadySpin", "Trajectory",
        "Verdict", "bodies", "drag", "gravity_gradient", "methods", "torque_body", "torque_space",
    }


def blocks(page):
    """The Python blocks of a page."""
    return [block.split("\n```")[0] for block in page.read_text().split("```python\n")[1:]]


def supplied(folder):
    """Files that stand for those of a reader."""
    shutil.copy(PROGRAMS / "mujoco-euler.csv", folder / "mujoco.csv")
    (folder / "robot.urdf").write_text(
        '<robot name="r"><link name="forearm"><inertial><mass value="1.5"/>'
        '<inertia ixx="0.01" iyy="0.02" izz="0.025" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
    )
    (folder / "part.stl").write_text(stl_of_an_open_cube())


@pytest.mark.parametrize("page", ["docs/python.md", "crates/polhode-python/package.md"])
def test_programs_of_the_pages_run(page, tmp_path, monkeypatch):
    supplied(tmp_path)
    monkeypatch.chdir(tmp_path)
    names, found = {}, blocks(ROOT / page)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for block in found:
            exec(compile(block, page, "exec"), names)
    assert found


@pytest.mark.parametrize("name", ["flip", "record"])
def test_notebooks_run(name, tmp_path):
    client, notebooks = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    notebook = notebooks.read(ROOT / f"crates/polhode-python/notebooks/{name}.ipynb", 4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.execution_count for cell in code), "it is committed with its outputs"
    client.NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()


@pytest.mark.skipif(sys.version_info < (3, 11), reason="the register is TOML")
def test_the_table_of_simulators_is_what_the_logs_say():
    program = ROOT / "crates/polhode-python/simulators.py"
    done = subprocess.run([sys.executable, program, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def stub():
    return ast.parse((FOLDER / "_polhode.pyi").read_text())


def parameters(arguments):
    """Names, kinds and defaults of a function of the stub."""
    positional = [argument.arg for argument in arguments.args if argument.arg not in ("self", "cls")]
    defaults = dict(zip(positional[len(positional) - len(arguments.defaults) :], arguments.defaults))
    defaults |= {a.arg: d for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults) if d is not None}
    values = {name: ast.literal_eval(value) for name, value in defaults.items()}
    return positional, [argument.arg for argument in arguments.kwonlyargs], values


def of_runtime(function):
    found = list(inspect.signature(function).parameters.values())
    found = [parameter for parameter in found if parameter.name not in ("self", "cls")]
    empty = inspect.Parameter.empty
    return (
        [p.name for p in found if p.kind in (p.POSITIONAL_OR_KEYWORD, p.POSITIONAL_ONLY)],
        [p.name for p in found if p.kind == p.KEYWORD_ONLY],
        {p.name: p.default for p in found if p.default is not empty},
    )


def test_stubs_are_those_of_the_running_module():
    seen = set()
    for node in stub().body:
        if isinstance(node, ast.FunctionDef):
            seen.add(node.name)
            assert parameters(node.args) == of_runtime(getattr(polhode, node.name)), node.name
        elif isinstance(node, ast.ClassDef):
            seen.add(node.name)
            found = getattr(polhode, node.name)
            # of the classes only the exception and the warning have heirs
            assert [getattr(d, "id", "") for d in node.decorator_list] == ([] if issubclass(found, Exception) else ["final"]), node.name
            members = [member for member in node.body if isinstance(member, ast.FunctionDef)]
            told = {member.name for member in members if not member.name.startswith("_")}
            if node.name == "Verdict":
                continue  # its names are those of the JSON: the test below
            assert told == {name for name in vars(found) if not name.startswith("_")}, node.name
            for member in members:
                if member.name == "__new__":
                    assert parameters(member.args) == of_runtime(found), node.name
                elif not member.name.startswith("_"):
                    is_property = any(getattr(d, "id", "") == "property" for d in member.decorator_list)
                    of_class = inspect.getattr_static(found, member.name)
                    assert is_property == inspect.isgetsetdescriptor(of_class), f"{node.name}.{member.name}"
                    if not is_property:
                        assert parameters(member.args) == of_runtime(of_class), f"{node.name}.{member.name}"
    assert set(NAMES) == seen


def test_the_stub_of_a_verdict_has_what_a_verdict_has():
    t = numpy.arange(40) * 0.2
    attitude, omega = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at(t)
    verdict = polhode.audit(t, attitude, omega, moments=[1, 2, 3])
    told = next(node for node in stub().body if isinstance(node, ast.ClassDef) and node.name == "Verdict")
    told = {member.name for member in told.body if not member.name.startswith("_")}
    assert told == {name for name in dir(verdict) if not name.startswith("_")}
    for name in told:
        getattr(verdict, name)
    with pytest.raises(AttributeError, match="no 'verdicts'"):
        verdict.verdicts


def test_a_checker_of_types_takes_the_stubs(tmp_path):
    checker = shutil.which("pyright") or shutil.which("mypy")
    if checker is None:
        pytest.skip("neither pyright nor mypy is installed")
    program = tmp_path / "program.py"
    program.write_text(
        "import numpy as np\nimport polhode\nfrom polhode.testing import assert_rotation_right\n"
        "motion = polhode.FreeMotion([1, 2, 3], omega=[0.4, 1, -0.3])\n"
        "attitude, omega = motion.at(np.linspace(0, 1, 100))\n"
        "right: bool = polhode.audit(np.linspace(0, 1, 100), attitude, omega, moments=[1, 2, 3]).is_right\n"
        "shape: tuple[int, ...] = polhode.fit(np.zeros(3), np.zeros((3, 3))).principal.shape\n"
        "assert_rotation_right([0.0], attitude)\n"
    )
    arguments = ["--strict"] if checker.endswith("mypy") else ["--pythonpath", sys.executable]
    done = subprocess.run([checker, *arguments, str(program)], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    # and sees a mistake
    program.write_text("import polhode\npolhode.FreeMotion([1, 2, 3]).at(0).attitudes\n")
    done = subprocess.run([checker, *arguments, str(program)], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 1 and "attitudes" in done.stdout, done.stdout


def starts():
    """The other arguments of each function and method of the stub that takes a number."""
    moments, omega, t = [1, 2, 3], [0.4, 1, -0.3], numpy.arange(3.0)
    motion = polhode.FreeMotion(moments, omega)
    attitude = motion.at(t).attitude
    rows, tensor = numpy.zeros((3, 3)), numpy.eye(3)
    drift = polhode.phase("two-turn", moments, omega, step=0.1)
    wheel = polhode.Wheel([0, 0, 1], 0.1, 1)
    return {
        "gravity_gradient": (polhode.gravity_gradient, dict(mean_motion=1)),
        "gravity_gradient_on_conic": (polhode.gravity_gradient_on_conic, dict(gm=1, periapsis=1, eccentricity=0)),
        "gravity_gradient_on_table": (polhode.gravity_gradient_on_table, dict(t=t, places=rows)),
        "drag": (polhode.drag, dict(linear=1)),
        "Wheel": (polhode.Wheel, dict(axis=[0, 0, 1], inertia=1, speed=1)),
        "Wheel.driven": (wheel.driven, dict(torque=1, omega=omega)),
        "Wheel.speed": (wheel.speed, dict(omega=omega)),
        "FreeMotion.through": (motion.through, dict(inertia=moments, t=t[:2], attitude=attitude[:2])),
        "FreeMotion.fitted": (motion.fitted, dict(inertia=moments, t=t, attitude=attitude, guess=motion)),
        "FreeMotion.flips": (motion.flips, {}),
        "Interpolation": (polhode.Interpolation, dict(inertia=moments, t=t, attitude=attitude)),
        "run": (polhode.run, dict(method="rk4", body=moments, omega=omega, times=[0])),
        "Ensemble.run": (polhode.Ensemble(moments, omega).run, dict(method="rk4", times=[0], step=1)),
        "attitude": (polhode.attitude, dict(t=t, rates=rows, kind="rate")),
        "audit": (polhode.audit, dict(t=t, attitude=attitude)),
        "advise": (polhode.advise, dict(body=moments, omega=omega, until=1, attitude_error=0.1)),
        "phase": (polhode.phase, dict(method="rk4", body=moments, omega=omega)),
        "PhaseDrift.departure": (drift.departure, {}),
        "PhaseDrift.attitude_error": (drift.attitude_error, {}),
        "PhaseDrift.rounding": (drift.rounding, {}),
        "fit": (polhode.fit, dict(t=t, rates=rows)),
        "fit_carrier": (polhode.fit_carrier, dict(carrier=(t, rows))),
        "MassProperties": (polhode.MassProperties, dict(center_of_mass=[0, 0, 0], tensor=tensor)),
        "solid": (polhode.solid, dict(name="sphere", sizes=[1])),
        "mesh": (polhode.mesh, dict(vertices=rows, triangles=rows)),
        "diagnose": (polhode.diagnose, dict(tensor=tensor)),
        "read": (polhode.read, dict(path={"t": t})),
    }


def numbers_of(node):
    """The arguments of a function of the stub that are one number, and whether each may be left out as None."""
    arguments = [one for one in node.args.args + node.args.kwonlyargs if one.annotation]
    kinds = {one.arg: ast.unparse(one.annotation) for one in arguments}
    return [(name, kind != "float") for name, kind in kinds.items() if kind in ("float", "float | None")]


def test_numbers_that_are_none_are_refused_by_their_names():
    known, seen = starts(), set()
    functions = [(node.name, node) for node in stub().body if isinstance(node, ast.FunctionDef)]
    for of_class in (node for node in stub().body if isinstance(node, ast.ClassDef)):
        for member in (member for member in of_class.body if isinstance(member, ast.FunctionDef)):
            functions.append((of_class.name if member.name == "__new__" else f"{of_class.name}.{member.name}", member))
    for name, node in functions:
        for argument, is_optional in numbers_of(node):
            call, others = known[name]
            seen.add(name)
            for wrong, says in [
                (2**53 + 1, "9007199254740993 has too many digits for a double, the nearest is 9007199254740992; "),
                (numpy.int64(2**53 + 1), "9007199254740993 has too many digits"),
                (10**400, "outside the range of a double"),
                (True, "True; it must be a number"),
                ("1", "'1'; it must be a number"),
                (numpy.bool_(True), "an array of bool"),
                ([1.0], r"an array of shape \(1,\); it must be of shape \(\)"),
            ]:
                with pytest.raises(polhode.PolhodeError, match=f"^{argument}: {says}"):
                    call(**{**others, argument: wrong})
            if not is_optional:
                with pytest.raises(polhode.PolhodeError, match=f"^{argument}: None; it must be a number"):
                    call(**{**others, argument: None})
    assert seen == set(known)


@pytest.mark.parametrize("wrong", [-1, 1.5, 2**17, True, 10**30, float("nan")])
def test_threads_are_a_whole_number(wrong):
    with pytest.raises(polhode.PolhodeError, match="^threads: "):
        polhode.Ensemble([1, 2, 3], [0.4, 1, -0.3], threads=wrong)


def test_numbers_of_any_kind_that_are_doubles_are_taken():
    end = polhode.run("rk4", [1, 2, 3], [0.4, 1, -0.3], times=[2], step=0.5).attitude
    for step in (numpy.float32(0.5), numpy.array(0.5), fractions.Fraction(1, 2), decimal.Decimal("0.5")):
        assert (polhode.run("rk4", [1, 2, 3], [0.4, 1, -0.3], times=[2], step=step).attitude == end).all()
    assert polhode.drag(numpy.int64(2**60)).name == "drag"
    for wrong, says in [
        (dict(pole=[1, 2, 3]), r"pole: an array of shape \(3,\); it must be of shape \(2,\)"),
        (dict(phases=[True, False]), "phases: an array of bool"),
        (dict(periods={"P_phi": "1h", "P_psi": 1e6}), "P_phi: '1h'; it must be a number"),
        (dict(periods={"P_phi": 1e5, "P_Psi": 1e6}), "periods: 'P_Psi, P_phi'; give two of P_phi, P_psi and P_1"),
    ]:
        with pytest.raises(polhode.PolhodeError, match=f"^{says}"):
            polhode.FreeMotion.tumbling(**{**dict(inertia=[0.61, 0.965, 1], periods={"P_phi": 1e5, "P_psi": 1e6}, mode="sam"), **wrong})
    with pytest.raises(polhode.PolhodeError, match=r"^time_unit: an array of shape \(1,\)"):
        polhode.read({"t": [0, 1]}, time_unit=[1.0])
    with pytest.raises(polhode.PolhodeError, match="^t: None; it must be a number, or an array of numbers"):
        polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at(None)
    with pytest.raises(polhode.PolhodeError, match="^start_time: NaN is not a finite number"):
        polhode.advise([1, 2, 3], [0.4, 1, -0.3], until=1, attitude_error=0.1, start_time=float("nan"))
