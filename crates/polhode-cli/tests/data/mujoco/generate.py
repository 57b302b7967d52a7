"""Logs of a free body by the four integrators of MuJoCo: pip install mujoco==4.0.0, then python generate.py."""

import csv
import hashlib

import mujoco

MODEL = """<mujoco>
  <option timestep="0.05" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 2 2.5"/></body></worldbody>
</mujoco>"""
ROWS = 120

for integrator in ["Euler", "implicit", "implicitfast", "RK4"]:
    model = mujoco.MjModel.from_xml_string(MODEL.format(integrator=integrator))
    data = mujoco.MjData(model)
    data.qvel[3:] = [0.8, 2.0, -0.6]
    name = f"{integrator.lower()}.csv"
    with open(name, "w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["time"] + [f"qpos[{k}]" for k in range(7)] + [f"qvel[{k}]" for k in range(6)])
        for _ in range(ROWS):
            rows.writerow([repr(float(x)) for x in (data.time, *data.qpos, *data.qvel)])
            mujoco.mj_step(model, data)
    with open(name, "rb") as file:
        print(hashlib.sha256(file.read()).hexdigest(), name)
print("MuJoCo", mujoco.__version__)
