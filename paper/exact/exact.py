"""The motion of a free rigid body by two theta functions: the algorithms of the article, written from its text alone.

    python3 exact.py

compares the closed form with the references that the tests read (or with a table that is named), and 100 algebraic
steps with the closed form, and prints the largest differences. It needs mpmath.  All is done in multiprecision (mpmath), so that the formulas are tested and not their rounding.
Quaternions are lists, scalar first; q takes a vector v of the body to the vector q v q* of space.
"""

import csv
import sys
from pathlib import Path

from mpmath import agm, cos, cosh, elliprf, exp, fmul, fsub, lu_solve, matrix, mp, mpc, mpf, pi, sin, sinh, sqrt

mp.dps = 50                                            # the working precision in digits

def qmul(p, q):
    w, x, y, z = p
    W, X, Y, Z = q
    return [w*W - x*X - y*Y - z*Z, w*X + x*W + y*Z - z*Y, w*Y - x*Z + y*W + z*X, w*Z + x*Y - y*X + z*W]

def conj(q):
    return [q[0], -q[1], -q[2], -q[3]]

def unit(q):
    n = sqrt(sum(x*x for x in q))
    return [x/n for x in q]

def prod(*factors):
    """The product, without rounding."""
    r = mpf(1)
    for x in factors:
        r = fmul(r, x, exact=True)
    return r

def middle_difference(Ia, Ib, Ic, ma, mc):
    """I_a I_c (2 H I_b - G^2), without rounding before the last operation: it vanishes on the separatrix."""
    x, y = prod(ma, ma, Ic, fsub(Ib, Ia, exact=True)), prod(mc, mc, Ia, fsub(Ic, Ib, exact=True))
    return fsub(x, y, exact=True)

def count(q, power):
    """How many terms q**power(n) count at the working precision."""
    n = 1
    while q**power(n) > mp.eps/1000:
        n += 1
    return n

class Motion:
    """Algorithm 1 (the constructor) and Algorithm 2 (at).  form: 'direct', 'dual', or None for the choice of the text."""

    def __init__(self, I, q, m, form=None):
        self.I, self.m0, self.q0 = I, m, q = [mpf(x) for x in I], [mpf(x) for x in m], unit([mpf(x) for x in q])
        self.G, self.H = G, H = sqrt(sum(x*x for x in m)), sum(x*x/i for x, i in zip(m, I))/2
        # The momentum is fixed in the body where m x I^-1 m = 0: on a principal axis, with equal moments, or at
        # right angles to an axis of symmetry.
        self.fixed = all(m[i]*m[j]*(I[i] - I[j]) == 0 for i, j in ((0, 1), (1, 2), (2, 0)))
        if self.fixed:
            return
        # Step 1: the axes a, b, c, each the number of a body axis and a sign.
        lo, mid, hi = sorted(range(3), key=lambda i: I[i])
        below = middle_difference(I[lo], I[mid], I[hi], m[lo], m[hi]) < 0
        self.axes = a, b, c = (hi, mid, lo) if below else (lo, mid, hi)
        turned = [-1 if m[a] < 0 else 1, -1 if m[c]*(I[c] - I[a]) < 0 else 1]
        self.sign = [turned[0], turned[0]*turned[1]*(1 if (b - a) % 3 == 1 else -1), turned[1]]
        Ia, Ib, Ic = I[a], I[b], I[c]
        ma, mb, mc = self.to_abc(m)
        # Step 2: the amplitudes, the frequency and the modulus.  The two differences have no cancellation.
        D = mb**2*(Ib - Ia)/Ib + mc**2*(Ic - Ia)/Ic    # G^2 - 2 H I_a
        E = ma**2*(Ic - Ia)/Ia + mb**2*(Ic - Ib)/Ib    # 2 H I_c - G^2
        self.A, self.B = A, B = sqrt(Ia*E/(Ic - Ia)), sqrt(Ib*D/(Ib - Ia))
        eps = 1 if Ic > Ia else -1
        self.C = C = eps*sqrt(Ic*D/(Ic - Ia))
        self.nu = nu = sqrt((Ib - Ia)*E/(Ia*Ib*Ic))
        self.k2 = k2 = (Ic - Ib)*D/((Ib - Ia)*E)
        self.kk2 = kk2 = (Ic - Ia)*middle_difference(Ia, Ib, Ic, ma, mc)/(Ia*Ic*(Ib - Ia)*E)
        # Steps 3 and 4: the place on the orbit and the quarter periods (None if infinite).
        s, c = mb/B, mc/C
        s, c = [x/sqrt(s*s + c*c) for x in (s, c)]
        self.K = K = pi/(2*agm(1, sqrt(kk2))) if kk2 else None
        self.KK = KK = pi/(2*agm(1, sqrt(k2))) if k2 else None
        self.u0 = s*elliprf(c*c, kk2 + k2*c*c, 1)
        # Step 5: the form, its coefficients, and the rate of the phase Psi, which starts from zero.
        nome = mpf(0) if KK is None else mpf(1) if K is None else exp(-pi*KK/K)
        self.form = form or ('direct' if nome <= mpf(1)/5 else 'dual')
        self.rate = (2*H + G*A/Ia)/(2*(G + A))
        if self.form == 'direct':
            v = exp(-pi*(A/G)*elliprf(C*C/G**2, B*B/G**2, 1)/K)
            g, N = nome/v, count(nome, lambda n: 2*n*n - n)
            z = [(nome**(2*n*n - n)*v**n, nome**(2*n*n)*g**n) for n in range(N + 1)]
            w = [(nome**(2*n*n + n)*v**n*sqrt(v), nome**(2*n*n + 2*n)*g**(n + 1)*sqrt(v)) for n in range(N)]
            self.z = [((-1)**n*(x + y), -eps*(-1)**n*(x - y)) for n, (x, y) in enumerate(z)]
            self.w = [((-1)**n*(x + y), eps*(-1)**n*(x - y)) for n, (x, y) in enumerate(w)]
            self.rate -= pi*nu/(2*K)*sum(2*n*y for n, (x, y) in enumerate(self.z))/self.sums(mpf(0))[0].real
        else:
            nn, rho = mpf(0) if K is None else exp(-pi*K/KK), abs(C)/B
            eta = eps*rho*elliprf(Ia*(Ic - Ib)/(Ib*(Ic - Ia)), k2*G**2/B**2, 1)
            self.xi = xi = pi*eta/(4*KK)
            f = [nn**(n*(n + 1)//2) for n in range(count(nn, lambda n: mpf(n*n)/2))]
            self.z = [(x*cos((2*n + 1)*xi), x*sin((2*n + 1)*xi)) for n, x in enumerate(f)]
            self.rate -= pi*nu/(4*KK)*sum((2*n + 1)*y for n, (x, y) in enumerate(self.z))/sum(x for x, y in self.z)
        # Step 7: P(0), along 1, a, b, c.
        Z0 = self.pair(mpf(0))[0]
        P0 = qmul(unit([Z0.real, Z0.imag, 0, 0]), unit([G + ma, 0, mc, -mb]))
        self.start = qmul(q, conj(P0[:1] + self.to_body(P0[1:])))

    def to_abc(self, v):
        return [s*v[i] for i, s in zip(self.axes, self.sign)]

    def to_body(self, v):
        r = [mpf(0)]*3
        for i, s, x in zip(self.axes, self.sign, v):
            r[i] = s*x
        return r

    def sums(self, x):
        """Z and W: the direct sums of x, or the dual ones of chi."""
        if self.form == 'direct':
            Z = 1 + sum(mpc(p*cos(2*n*x), r*sin(2*n*x)) for n, (p, r) in enumerate(self.z) if n)
            return Z, sum(mpc(p*sin((2*n + 1)*x), r*cos((2*n + 1)*x)) for n, (p, r) in enumerate(self.w))
        ch, sh = ([f((2*n + 1)*x) for n in range(len(self.z))] for f in (cosh, sinh))
        Z = sum(mpc(p*c, r*s) for (p, r), c, s in zip(self.z, ch, sh))
        return Z, sum((-1)**n*mpc(p*s, r*c) for n, ((p, r), c, s) in enumerate(zip(self.z, ch, sh)))

    def pair(self, t):
        """e^{i Psi} Z and e^{i Psi} W at the time t: steps 1 to 3 of Algorithm 2."""
        psi, u, n = self.rate*t, self.nu*t + self.u0, 0
        if self.form == 'direct':
            Z, W = self.sums(pi*u/(2*self.K))
        else:
            if self.K is not None:                     # on the separatrix nothing is subtracted
                n = int(mp.nint(u/(2*self.K)))
                u -= 2*self.K*n
            Z, W = self.sums(pi*u/(4*self.KK))
            psi += 2*self.xi*n
            W *= (-1)**n
        return mp.expj(psi)*Z, mp.expj(psi)*W

    def at(self, t):
        """Attitude and momentum at the time t."""
        if self.fixed:
            turn = self.H*t/self.G if self.G else mpf(0)           # half the angle, at the rate 2 H / G
            return qmul(self.q0, [cos(turn)] + [sin(turn)*x/(self.G or 1) for x in self.m0]), self.m0
        Z, W = self.pair(mpf(t))
        r = 1/sqrt(abs(Z)**2 + abs(W)**2)
        alpha, beta, side = r*Z, mpc(0, -1)*r*W, 2*self.G*r*r*mp.conj(Z)*W
        P = [alpha.real] + self.to_body([alpha.imag, beta.real, beta.imag])
        return qmul(self.start, P), self.to_body([self.G*r*r*(abs(Z)**2 - abs(W)**2), side.real, side.imag])

def turn_of(v):
    """The unit quaternion p whose vector times p_0 is v; a turn of at most a right angle."""
    p0 = sqrt((1 + sqrt(1 - 4*sum(x*x for x in v)))/2)
    return [p0] + [x/p0 for x in v]

class AlgebraicStep:
    """Algorithm 3 (the constructor) and Algorithm 4 (step); not for a momentum that is fixed in the body."""

    def __init__(self, motion, h):
        self.o = o = motion
        self.s, self.c, self.d = (mp.ellipfun(f, o.nu*h, m=o.k2 if o.kk2 else 1) for f in ('sn', 'cn', 'dn'))
        q, m = o.at(h)
        p, I = qmul(conj(o.q0), q), [o.I[i] for i in o.axes]
        v, M = o.to_abc(p[1:]), [x + y for x, y in zip(o.to_abc(o.m0), o.to_abc(m))]
        i, j, k = max(((0, 1, 2), (1, 2, 0), (2, 0, 1)),
                      key=lambda x: abs(M[x[0]]*M[x[1]]*(I[x[0]] - I[x[1]])*I[x[2]]))
        self.lam = [p[0]*x/y if n != k else None for n, (x, y) in enumerate(zip(v, M))]
        self.lam[k] = self.lam[i] + (self.lam[j] - self.lam[i])*(I[i] - I[k])*I[j]/((I[i] - I[j])*I[k])

    def step(self, q, m):
        o, s, c, d = self.o, self.s, self.c, self.d
        A, B, C, k2 = o.A, o.B, o.C, o.k2
        ma, mb, mc = o.to_abc(m)
        rho = 1 - k2*s*s*(mb/B)**2
        na = (d*ma - k2*s*c*A/(B*C)*mb*mc)/rho
        nb = (c*d*mb + s*B/(A*C)*mc*ma)/rho
        nc = (c*mc - s*d*C/(A*B)*ma*mb)/rho
        l = (1 - (nb/B)**2 - (nc/C)**2)/2
        la = (A*A*(o.kk2 + k2*(nc/C)**2) - na*na)/2 + l*A*A*k2*(nc/C)**2
        new = [na + la/na, nb + l*nb, nc + l*nc]
        p = turn_of([x*(y + z) for x, y, z in zip(self.lam, (ma, mb, mc), new)])
        length = (3 - sum(x*x for x in q))/2
        return [x*length for x in qmul(q, p[:1] + o.to_body(p[1:]))], o.to_body(new)

class Map:
    """Algorithm 5: the series of s and d for the discrete Moser-Veselov map of an even order; one step by iteration."""

    def __init__(self, I, order):
        self.I = I = [mpf(x) for x in I]
        N, (lo, mid, hi) = order//2 - 1, sorted(range(3), key=lambda i: I[i])
        x, y, z = 1/I[lo], 1/I[mid], 1/I[hi]           # with |m| = 1, e = H/C lies between z and x
        self.centre, self.half = (x + z)/2, (x - z)/2
        nodes, series = [cos(pi*(2*j + 1)/(2*N + 2)) for j in range(N + 1)], []
        for node in nodes:
            e, m = self.centre + self.half*node, [None]*3
            most = min((e - z)/(y - z) if y > z else mpf(1), (x - e)/(x - y) if x > y else mpf(1))
            m[mid] = sqrt(most/2)
            m[lo] = sqrt((e - z - (y - z)*most/2)/(x - z))
            m[hi] = sqrt(1 - m[mid]**2 - m[lo]**2)
            mt, pt = expand(I, m, order)
            r = []
            for i in (lo, hi):                         # the quotients r_i as power series in the step
                num, quo = [4*convolve(pt[0], pt[i + 1], n) for n in range(1, order)], []
                for n in range(order - 1):
                    quo.append((num[n] - sum(quo[k]*mt[i][n - k] for k in range(n)))/(2*m[i]))
                r.append(quo)
            s = [(b - a)/(z - x) for a, b in zip(*r)]
            series.append((s, [a - x*b for a, b in zip(r[0], s)]))
        self.odd = max(abs(f[n]) for pair in series for f in pair for n in range(1, order - 1, 2))     # zero
        # coefficients of (H/C - centre)/half, as C is 1/2 for all momenta used
        fit = lambda f, n: lu_solve(matrix([[x**i for i in range(n + 1)] for x in nodes[:n + 1]]),
                                    matrix([pair[f][2*n]*2**n for pair in series[:n + 1]]))
        self.coefs = [[fit(f, n) for n in range(N + 1)] for f in (0, 1)]

    def step(self, q, m, h):
        C, H = sum(x*x for x in m)/2, sum(x*x/i for x, i in zip(m, self.I))/2
        x = (H/C - self.centre)/self.half
        s, d = (sum((h*h*C)**n*sum(c*x**i for i, c in enumerate(row)) for n, row in enumerate(f)) for f in self.coefs)
        new, change = m, 1
        while change > 100*mp.eps*sqrt(C):
            p = turn_of([h/4*(s/i + d)*(a + b) for i, a, b in zip(self.I, m, new)])
            old, new = new, qmul(qmul(conj(p), [0] + list(m)), p)[1:]
            change = max(abs(a - b) for a, b in zip(old, new))
        return qmul(q, p), new

def convolve(f, g, n):
    return sum(f[k]*g[n - k] for k in range(n + 1))

def expand(I, m, degree):
    """The power series in the time of the momentum, and of the attitude that starts from 1."""
    m, p = [[x] for x in m], [[mpf(1)], [mpf(0)], [mpf(0)], [mpf(0)]]
    for n in range(degree):
        x, y, z = ([c/i for c in f] for f, i in zip(m, I))
        cross = [convolve(m[i], g, n) - convolve(m[j], f, n) for i, j, f, g in ((1, 2, y, z), (2, 0, z, x), (0, 1, x, y))]
        P = [[convolve(f, g, n) for g in (x, y, z)] for f in p]
        turn = [-P[1][0] - P[2][1] - P[3][2], P[0][0] + P[2][2] - P[3][1],
                P[0][1] + P[3][0] - P[1][2], P[0][2] + P[1][1] - P[2][0]]
        for f, c in zip(m + p, [2*c for c in cross] + turn):
            f.append(c/(2*n + 2))
    return m, p

def difference(one, two):
    """The largest difference of two attitudes and momenta by components, the momenta relative to their length."""
    length = sqrt(sum(x*x for x in two[1])) or 1
    return max([abs(x - y) for x, y in zip(one[0], two[0])] + [abs(x - y)/length for x, y in zip(one[1], two[1])])

def main(path):
    rows = list(csv.DictReader(line for line in open(path) if not line.startswith('#')))
    closed, algebraic, orbits = [mpf(0)], [mpf(0)], {}
    for row in rows:
        I, s, q = ([mpf(float(row[x])) for x in names.split()] for names in ('I1 I2 I3', 's1 s2 s3', 'q0w q0x q0y q0z'))
        motion = Motion(I, q, [prod(x, i) for x, i in zip(s, I)] if row['start'] == 'omega' else s)
        table = [mpf(row[x]) for x in ('qw', 'qx', 'qy', 'qz')], [mpf(row[x]) for x in ('m1', 'm2', 'm3')]
        closed.append(difference(motion.at(float(row['t'])), table))
        orbits[row['scenario']] = motion
    for motion in (o for o in orbits.values() if not o.fixed):
        h = min(motion.I)/motion.G/2                   # at most half a radian a step
        step, state = AlgebraicStep(motion, h), (motion.q0, motion.m0)
        for n in range(100):
            state = step.step(*state)
        algebraic.append(difference(state, motion.at(100*h)))
    print('closed form, %d rows of the table: %s' % (len(rows), mp.nstr(max(closed), 3)))
    print('algebraic step, 100 steps on %d orbits: %s' % (len(orbits), mp.nstr(max(algebraic), 3)))
    return int(not max(closed + algebraic) <= mpf(10)**-13)

if __name__ == '__main__':
    beside = Path(__file__).parents[2]/'tests/data/free_body/reference.csv'
    sys.exit(main(sys.argv[1] if sys.argv[1:] else beside))
