"""Robot models and meshes of other packages, examined by polhode and compared with MuJoCo and trimesh.

    pip install example-robot-data gymnasium-robotics mujoco trimesh
    python3 compare.py PATH/TO/polhode FOLDER [FOLDER...]

Every model below the folders is examined: exit codes, rows, and of the MJCF models that MuJoCo compiles the tensors of all
bodies. Every mesh is given to polhode and, where trimesh calls it watertight, both answers are compared; the others are
closed by a fan. The repaired copies of models with invalid links are read again, those of MJCF models for a moment from beside
the model, where its includes and meshes are found.
"""
import json
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import mujoco
import numpy as np
import trimesh

PROGRAM = sys.argv[1]
FOLDERS = [Path(folder) for folder in sys.argv[2:]]


def run(*arguments):
    done = subprocess.run([PROGRAM, "inertia", *map(str, arguments)], capture_output=True, text=True, timeout=600)
    return done.returncode, done.stdout, done.stderr


def several(text):
    """A single link is an object, several are an array, none is an empty one."""
    found = json.loads(text) if text.strip() else []
    return found if isinstance(found, list) else [found]


def files(*endings):
    for folder in FOLDERS:
        for path in sorted(folder.rglob("*")):
            if path.suffix.lower() in endings and path.is_file():
                yield path


def language(path):
    if path.suffix == ".urdf":
        return "urdf"
    if path.suffix in (".sdf", ".world"):
        return "sdf"
    return "mjcf" if "<mujoco" in path.read_text(errors="replace") else None


def compiled(path):
    """Mass, centre and tensor in the frame of the body, of every body but the world."""
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except Exception:
        return None
    rows = []
    for body in range(1, model.nbody):
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[body])
        turn = turn.reshape(3, 3)
        tensor = turn @ np.diag(model.body_inertia[body]) @ turn.T
        moments = np.sort(model.body_inertia[body])
        rows.append((model.body(body).name, model.body_mass[body], model.body_ipos[body], moments, tensor))
    return rows


def apart(link, mass, center, moments, tensor):
    """Relative differences of mass, centre and moments, and of the tensor, which needs MuJoCo's axes as well."""
    if link["verdict"] == "massless":
        return max(mass, moments[2]), 0.0
    if mass == 0:
        return np.inf, np.inf
    if link["inertia"] is None:
        return np.inf, np.inf
    size = moments[2] if moments[2] > 0 else 1.0
    length = max(np.sqrt(size / max(mass, 1e-300)), np.abs(center).max())
    scalars = max(
        abs(link["mass"] / mass - 1),
        np.abs(np.array(link["center_of_mass"]) - center).max() / length,
        np.abs(np.array(link["principal_moments"]) - moments).max() / size,
    )
    return scalars, np.abs(np.array(link["inertia"]) - tensor).max() / size


def models():
    codes, verdicts, compared, bodies, differ = Counter(), Counter(), 0, 0, []
    worst = np.zeros(2)
    repaired = Counter()
    for path in files(".urdf", ".sdf", ".world", ".xml"):
        kind = language(path)
        if kind is None:
            continue
        root = ["--root", path.parent.parent] if kind == "mjcf" else []
        code, out, err = run(kind, path, "--format", "json", *root)
        codes[kind, code] += 1
        if code == 2:
            print("refused:", path, err.strip().splitlines()[-1][:200])
            continue
        links = several(out)
        verdicts.update(link["verdict"] for link in links)
        # a file to be included in others may compile to no body at all
        if kind == "mjcf" and (rows := compiled(path)):
            compared += 1
            bodies += len(rows)
            if len(rows) != len(links):
                differ.append((path, "bodies", len(rows), len(links)))
                continue
            for link, (name, *numbers) in zip(links, rows):
                difference = apart(link, *numbers)
                worst = np.maximum(worst, difference)
                if max(difference) > 1e-9:
                    differ.append((path, name, *difference, link["verdict"], link["trouble"]))
        if any(link["verdict"] == "invalid" for link in links):
            check_repair(kind, path, root, links, repaired)
    print("models by language and exit code:", dict(codes))
    print("links by verdict:", dict(verdicts))
    print(f"MJCF models compared with MuJoCo: {compared}, bodies: {bodies}")
    print("largest relative difference of mass, centre, moments, and of the tensor:", *worst)
    for entry in differ[:40]:
        print("  differs:", *entry)
    print("repairs:", dict(repaired))


def check_repair(kind, path, root, links, repaired):
    with tempfile.TemporaryDirectory() as folder:
        run(kind, path, "--repair", folder, *root)
        copy = Path(folder) / path.name
        if kind == "mjcf":
            # includes and meshes are looked for beside the copy
            beside = path.parent / f".polhode-{path.name}"
            beside.write_bytes(copy.read_bytes())
            try:
                after = several(run(kind, beside, "--format", "json", *root)[1])
                repaired["compiles"] += compiled(beside) is not None
            finally:
                beside.unlink()
        else:
            after = several(run(kind, copy, "--format", "json")[1])
    repaired["files"] += 1
    repaired["invalid before"] += sum(link["verdict"] == "invalid" for link in links)
    repaired["invalid after"] += sum(link["verdict"] == "invalid" for link in after)
    for before, now in zip(links, after):
        same = before["inertia"] == now["inertia"]
        repaired["links changed" if not same else "links kept"] += 1
        if not same and before["verdict"] != "invalid":
            print("  changed a link that was not invalid:", path, before["name"])


def meshes():
    answers, worst, differ, open_left = Counter(), 0.0, [], []
    for path in files(".stl", ".obj", ".ply"):
        code, out, err = run("mesh", path, "--density", 1000, "--length-unit", "m", "--format", "json")
        kind = "closed" if code == 0 and "mended" not in err else "mended" if code == 0 else "open"
        if code != 0:
            code, out, err = run(
                "mesh", path, "--density", 1000, "--length-unit", "m", "--close", "fan", "--format", "json"
            )
            if code != 0:
                answers["refused"] += 1
                open_left.append((path.name, err.strip()[-160:]))
                continue
            assert "mended" in err, path
        answers[kind] += 1
        if kind != "closed":
            continue
        body = json.loads(out)
        mesh = trimesh.load(path, force="mesh", process=False)
        mesh.merge_vertices(digits_vertex=None)
        if not mesh.is_watertight or not mesh.is_winding_consistent:
            answers["closed, but not to trimesh"] += 1
        mesh.density = 1000
        size = np.abs(mesh.moment_inertia).max()
        difference = max(abs(mesh.mass / body["mass"] - 1), np.abs(mesh.moment_inertia - body["inertia"]).max() / size)
        worst = max(worst, difference)
        if difference > 1e-9:
            differ.append((path, difference))
    total = sum(answers[kind] for kind in ("closed", "mended", "open", "refused"))
    print("meshes:", total, dict(answers), f"answered: {100 * (1 - answers['refused'] / max(total, 1)):.1f} %")
    print("largest relative difference from trimesh:", worst)
    for entry in differ[:40]:
        print("  differs:", *entry)
    for entry in open_left:
        print("  refused:", *entry)


models()
meshes()
