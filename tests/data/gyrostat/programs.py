"""Writes programs.csv: one spacecraft with two wheels, as other programs integrate it.

    python3 tests/data/gyrostat/programs.py        (python 3.11 with numpy, scipy and bsk, which is Basilisk)

scipy's DOP853 follows the carrier and the wheels as separate bodies, which act on each other in their bearings:

    p = Ic w                     carrier, without the spin inertia of the wheels: Ic = I - sum J a a^T
    l = J (a.w + W)              each wheel about its axis a, W its speed against the carrier
    l' = T,   p' = (p + sum l a) x w - sum T a,   q' = q o (0, w)/2

with the motor torque T: 0 of a free wheel, given of a driven one, J a.w' of a held one, which follows from p' = Ic w'.
Basilisk has wheels that are free or driven; it integrates its own equations by its classical Runge-Kutta method.

The column error is the largest difference of a row from the same program with half the digits more: scipy at rtol 2.3e-14
beside 1e-13, Basilisk at half the step. Quaternions are scalar first, active, body to space, w is the rate in body axes.
"""

import csv
import platform
from pathlib import Path

import numpy
import scipy
from scipy.integrate import solve_ivp

I = numpy.array([[10.0, -0.5, 0.25], [-0.5, 12.0, 0.75], [0.25, 0.75, 15.0]])
AXES = numpy.array([[1.0, 2.0, -2.0], [0.0, 0.0, 1.0]]) / numpy.array([[3.0], [1.0]])
J = numpy.array([0.05, 0.1])
SPEED = numpy.array([60.0, -25.0])
RATE = numpy.array([0.3, -0.2, 0.5])
ATTITUDE = numpy.array([0.5, 0.5, -0.5, 0.5])
TIMES = [10.0, 20.0, 40.0, 60.0]

# of each wheel: None is held, else the torque of its motor and when it works
ALWAYS = (0.0, numpy.inf)
CASES = {
    "held": (None, None),
    "free": ((0.0, ALWAYS), (0.0, ALWAYS)),
    "driven": ((0.3, ALWAYS), (-0.05, ALWAYS)),
    "switched": ((0.3, (12.5, 30.0)), None),
}


def scipy_rows(wheels, rtol):
    carrier = I - sum(j * numpy.outer(a, a) for j, a in zip(J, AXES))
    inverse = numpy.linalg.inv(carrier)
    held = [k for k, wheel in enumerate(wheels) if wheel is None]
    together = carrier + sum((J[k] * numpy.outer(AXES[k], AXES[k]) for k in held), numpy.zeros((3, 3)))
    solve = numpy.linalg.inv(together)

    def field(motors):
        def rates(_, y):
            p, l, q = y[:3], y[3:5], y[5:]
            w = inverse @ p
            torque = numpy.array(motors)
            force = numpy.cross(p + l @ AXES, w) - torque @ AXES
            acceleration = solve @ force
            for k in held:
                torque[k] = J[k] * (AXES[k] @ acceleration)
            turned = numpy.concatenate(([-q[1:] @ w], q[0] * w + numpy.cross(q[1:], w)))
            return numpy.concatenate((carrier @ acceleration, torque, 0.5 * turned))

        return rates

    y = numpy.concatenate((carrier @ RATE, J * (AXES @ RATE + SPEED), ATTITUDE))
    switchings = {t for wheel in wheels if wheel for t in wheel[1] if 0.0 < t < TIMES[-1]}
    now, rows = 0.0, []
    for t in sorted(switchings | set(TIMES)):
        motors = [wheel[0] if wheel and wheel[1][0] <= now < wheel[1][1] else 0.0 for wheel in wheels]
        found = solve_ivp(field(motors), (now, t), y, method="DOP853", rtol=rtol, atol=1e-15)
        if not found.success:
            raise SystemExit(found.message)
        y, now = found.y[:, -1], t
        if t in TIMES:
            q = y[5:] / numpy.linalg.norm(y[5:])
            rows.append(numpy.concatenate((q, inverse @ y[:3])))
    return numpy.array(rows)


def basilisk_rows(wheels, step):
    from Basilisk.architecture import messaging
    from Basilisk.simulation import reactionWheelStateEffector, spacecraft
    from Basilisk.utilities import SimulationBaseClass, macros, simIncludeRW
    from Basilisk.utilities.RigidBodyKinematics import MRP2EP

    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("process")
    process.addTask(simulation.CreateNewTask("task", macros.sec2nano(step)))
    craft = spacecraft.Spacecraft()
    craft.ModelTag = "craft"
    craft.hub.mHub = 100.0
    craft.hub.IHubPntBc_B = I.tolist()
    # modified Rodrigues parameters of the start
    craft.hub.sigma_BNInit = [[x / (1.0 + ATTITUDE[0])] for x in ATTITUDE[1:]]
    craft.hub.omega_BN_BInit = [[x] for x in RATE]
    effector = reactionWheelStateEffector.ReactionWheelStateEffector()
    factory = simIncludeRW.rwFactory()
    for axis, inertia, speed in zip(AXES, J, SPEED):
        factory.create(
            "custom",
            axis,
            Js=inertia,
            Omega=speed * 60.0 / (2.0 * numpy.pi),  # rpm
            u_max=10.0,
            Omega_max=1e6,
            RWModel=messaging.BalancedWheels,
        )
    factory.addToSpacecraft("wheels", effector, craft)
    payload = messaging.ArrayMotorTorqueMsgPayload()
    payload.motorTorque = [wheel[0] for wheel in wheels]
    message = messaging.ArrayMotorTorqueMsg().write(payload)
    effector.rwMotorCmdInMsg.subscribeTo(message)
    simulation.AddModelToTask("task", effector, 2)
    simulation.AddModelToTask("task", craft, 1)
    record = craft.scStateOutMsg.recorder(macros.sec2nano(TIMES[0]))
    simulation.AddModelToTask("task", record)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(TIMES[-1]))
    simulation.ExecuteSimulation()
    seconds = record.times() * macros.NANO2SEC
    rows = []
    for t in TIMES:
        (k,) = numpy.flatnonzero(numpy.isclose(seconds, t, atol=1e-6))
        rows.append(numpy.concatenate((MRP2EP(record.sigma_BN[k]), record.omega_BN_B[k])))
    return numpy.array(rows)


def apart(a, b):
    signs = numpy.sign(numpy.sum(a[:, :4] * b[:, :4], axis=1))
    turned = b.copy()
    turned[:, :4] *= signs[:, None]
    return numpy.abs(a - turned).max()


def main():
    import Basilisk

    rows = []
    for name, wheels in CASES.items():
        best = scipy_rows(wheels, 2.3e-14)
        rows += [("scipy", name, apart(best, scipy_rows(wheels, 1e-13)), t, row) for t, row in zip(TIMES, best)]
        if name in ("free", "driven"):
            best = basilisk_rows(wheels, 1e-3)
            rows += [
                ("Basilisk", name, apart(best, basilisk_rows(wheels, 2e-3)), t, row) for t, row in zip(TIMES, best)
            ]
    with open(Path(__file__).with_name("programs.csv"), "w", newline="") as file:
        file.write(
            f"# python {platform.python_version()}, numpy {numpy.__version__}, scipy {scipy.__version__}, "
            f"Basilisk {Basilisk.__version__}; tests/data/gyrostat/programs.py\n"
        )
        write = csv.writer(file, lineterminator="\n").writerow
        write(["program", "case", "error", "t", "q_w", "q_x", "q_y", "q_z", "omega_x", "omega_y", "omega_z"])
        for program, case, error, t, row in rows:
            write([program, case, f"{error:.2g}", t, *(repr(float(x)) for x in row)])


if __name__ == "__main__":
    main()
