"""Rotation of rigid bodies: exact motion, integrators, audits of trajectories, inertia tensors, in arrays.

Quaternions are scalar first (w, x, y, z) unless order="xyzw", active, body to space; angular velocities are in body axes, rad/s;
inertia tensors are about the centre of mass with entries I_xy = -int x y dm, kg m^2 or any consistent unit. What cannot be used is
refused by `PolhodeError`, a `ValueError`; what limits the use of a result is a `PolhodeWarning`.

>>> import polhode
>>> attitude, omega = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at([0, 1e9])
"""

from polhode._polhode import (
    Advice,
    Body,
    Ensemble,
    Estimate,
    Force,
    FreeMotion,
    LagrangeTop,
    Link,
    Links,
    MassProperties,
    PolhodeError,
    PolhodeWarning,
    Record,
    Samples,
    States,
    Trajectory,
    Verdict,
    __version__,
    advise,
    audit,
    bodies,
    body,
    diagnose,
    drag,
    fit,
    force,
    gravity,
    gravity_gradient,
    mesh,
    methods,
    read,
    run,
    solid,
    torque_body,
    torque_space,
)

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]
