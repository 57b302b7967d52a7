"""One step as the papers write it: prints the rows ONE_STEP of tests/programs.rs.

    python3 tests/data/one_step/generate.py        (mpmath 1.3, 40 digits)

Attitudes are rotation matrices R, body to space, and angular velocities w are in the axes that the paper takes; the
programs of the crate work on quaternions and momenta instead. Moments (1, 2, 3), step 1/4, R0 of the quaternion
(1, 0.5, -0.25, 0.75)/norm, body angular velocity (0.4, 1, -0.3), no torque.
"""

import mpmath as mp

mp.mp.dps = 40
I = mp.diag([1, 2, 3])
H = mp.mpf(1) / 4
W0 = mp.matrix(["0.4", "1", "-0.3"]).apply(lambda x: mp.mpf(float(x)))
Q0 = [mp.mpf(x) / mp.sqrt(mp.mpf("1.875")) for x in ("1", "0.5", "-0.25", "0.75")]


def cross(a, b):
    return mp.matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def hat(a):
    return mp.matrix([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def rotation(q):
    w, v = q[0], mp.matrix(q[1:])
    return mp.eye(3) + 2 * w * hat(v) + 2 * hat(v) * hat(v)


def quaternion(r):
    w = mp.sqrt(1 + r[0, 0] + r[1, 1] + r[2, 2]) / 2
    return [w] + [(r[b, a] - r[a, b]) / (4 * w) for a, b in ((1, 2), (2, 0), (0, 1))]


def variational_cayley(r, w0):
    """Bou-Rabee and Marsden: angular velocities of the body, (1 - x/2)^-1 (1 + x/2) of the matrix x = h w."""
    inverse = I ** -1
    equation = lambda w, sign: cross(I * w, w) + sign * H / 2 * dot(w, I * w) * w
    lacking = lambda x, y, z: list(mp.matrix([x, y, z]) - w0 - H / 2 * inverse * equation(mp.matrix([x, y, z]), -1))
    w = mp.findroot(lacking, list(w0))
    end = w + H / 2 * inverse * equation(w, 1)
    return r * (mp.eye(3) - H / 2 * hat(w)) ** -1 * (mp.eye(3) + H / 2 * hat(w)), I * end


def buss(augmented):
    """Buss: angular momentum and velocity in space, R' = exp(h w) R."""

    def step(r, w0):
        space = r * I * r.T
        momentum = r * I * w0
        w = r * w0
        acceleration = -(space ** -1) * cross(w, momentum)
        mean = w + H / 2 * acceleration
        if augmented:
            mean += H ** 2 / 12 * cross(acceleration, w)
        end = mp.expm(hat(H * mean)) * r
        return end, end.T * momentum

    return step


steps = {"variational-cayley": variational_cayley, "buss-2": buss(False), "buss-2-augmented": buss(True)}
for name, step in steps.items():
    end, momentum = step(rotation(Q0), W0)
    show = lambda values: ", ".join(repr(float(x)) for x in values)
    print(f'("{name}", [{show(quaternion(end))}], [{show(momentum)}]),')
