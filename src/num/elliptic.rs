//! Elliptic integrals in Carlson's forms and Jacobi's functions, from the complementary parameter.

use super::Precise;

/// R_F(x, y, z).
pub fn carlson_rf<S: Precise>(x: S, y: S, z: S) -> S {
    let third = S::of(1.0) / S::of(3.0);
    let (mut x, mut y, mut z) = (x, y, z);
    let a0 = (x + y + z) * third;
    let mut a = a0;
    let spread = |v: S| (a0 - v).magnitude();
    let q = spread(x).max(spread(y)).max(spread(z)) / libm::pow(3.0 * S::ROUNDOFF, 1.0 / 8.0);
    let (x0, y0) = (x, y);
    let mut power = 1.0;
    while power * q > a.magnitude() {
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * ry + rx * rz + ry * rz;
        let quarter = S::of(0.25);
        a = (a + lambda) * quarter;
        x = (x + lambda) * quarter;
        y = (y + lambda) * quarter;
        z = (z + lambda) * quarter;
        power *= 0.25;
    }
    let dx = (a0 - x0) * S::of(power) / a;
    let dy = (a0 - y0) * S::of(power) / a;
    let dz = -(dx + dy);
    let e2 = dx * dy - dz * dz;
    let e3 = dx * dy * dz;
    let r = |p: f64, q: f64| S::of(p) / S::of(q);
    let series = S::of(1.0) - e2 * r(1.0, 10.0) + e3 * r(1.0, 14.0) + e2 * e2 * r(1.0, 24.0)
        - e2 * e3 * r(3.0, 44.0)
        - e2 * e2 * e2 * r(5.0, 208.0)
        + e3 * e3 * r(3.0, 104.0)
        + e2 * e2 * e3 * r(1.0, 16.0);
    series / a.sqrt()
}

/// R_C(x, y), y > 0.
pub fn carlson_rc<S: Precise>(x: S, y: S) -> S {
    carlson_rf(x, y, y)
}

/// R_J(x, y, z, p), p > 0.
pub fn carlson_rj<S: Precise>(x: S, y: S, z: S, p: S) -> S {
    let (mut x, mut y, mut z, mut p) = (x, y, z, p);
    let fifth = S::of(1.0) / S::of(5.0);
    let a0 = (x + y + z + p + p) * fifth;
    let mut a = a0;
    let spread = |v: S| (a0 - v).magnitude();
    let q = spread(x).max(spread(y)).max(spread(z)).max(spread(p)) / libm::pow(S::ROUNDOFF * 0.25, 1.0 / 6.0);
    let mut delta = (p - x) * (p - y) * (p - z);
    let (x0, y0, z0) = (x, y, z);
    let mut power = 1.0;
    let mut sum = S::of(0.0);
    while power * q > a.magnitude() {
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * ry + rx * rz + ry * rz;
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        let e = delta / (d * d);
        sum = sum + S::of(power) / d * carlson_rc(S::of(1.0), S::of(1.0) + e);
        let quarter = S::of(0.25);
        a = (a + lambda) * quarter;
        x = (x + lambda) * quarter;
        y = (y + lambda) * quarter;
        z = (z + lambda) * quarter;
        p = (p + lambda) * quarter;
        delta = delta * S::of(1.0 / 64.0);
        power *= 0.25;
    }
    let scaled = S::of(power) / a;
    let (dx, dy, dz) = ((a0 - x0) * scaled, (a0 - y0) * scaled, (a0 - z0) * scaled);
    let dp = -(dx + dy + dz) * S::of(0.5);
    let xyz = dx * dy * dz;
    let e2 = dx * dy + dx * dz + dy * dz - S::of(3.0) * dp * dp;
    let e3 = xyz + S::of(2.0) * e2 * dp + S::of(4.0) * dp * dp * dp;
    let e4 = (S::of(2.0) * xyz + e2 * dp + S::of(3.0) * dp * dp * dp) * dp;
    let e5 = xyz * dp * dp;
    let r = |p: f64, q: f64| S::of(p) / S::of(q);
    let series = S::of(1.0) - e2 * r(3.0, 14.0) + e3 * r(1.0, 6.0) + e2 * e2 * r(9.0, 88.0)
        - e4 * r(3.0, 22.0)
        - e2 * e3 * r(9.0, 52.0)
        + e5 * r(3.0, 26.0);
    S::of(power) * series / (a * a.sqrt()) + S::of(6.0) * sum
}

/// The complete integral K from the complementary parameter; infinite at 0.
pub fn complete_k<S: Precise>(complement: S) -> S {
    if complement.magnitude() == 0.0 {
        return S::of(f64::INFINITY);
    }
    carlson_rf(S::of(0.0), complement, S::of(1.0))
}

/// sn, cn, dn of `u` with complementary parameter `complement`, |u| ≤ K.
pub fn jacobi<S: Precise>(u: S, complement: S) -> (S, S, S) {
    let one = S::of(1.0);
    if complement.magnitude() == 0.0 {
        let e = (-u.abs()).exp();
        let sech = S::of(2.0) * e / (one + e * e);
        let tanh = (one - e * e) / (one + e * e);
        return (if u < S::of(0.0) { -tanh } else { tanh }, sech, sech);
    }
    let mut means = [(one, one); 16];
    let (mut a, mut emc, mut c, mut last) = (one, complement, one, 0);
    for k in 0..16 {
        last = k;
        emc = emc.sqrt();
        means[k] = (a, emc);
        c = (a + emc) * S::of(0.5);
        if (a - emc).magnitude() <= S::ROUNDOFF.sqrt() * 0.01 * a.magnitude() {
            break;
        }
        emc = emc * a;
        a = c;
    }
    let (mut sn, mut cn) = (c * u).sin_cos();
    let mut dn = one;
    if sn.magnitude() != 0.0 {
        let mut a = cn / sn;
        c = c * a;
        for (b, e) in means[..=last].iter().rev() {
            a = c * a;
            c = c * dn;
            dn = (*e + a) / (*b + a);
            a = c / *b;
        }
        let r = one / (c * c + one).sqrt();
        sn = if sn < S::of(0.0) { -r } else { r };
        cn = c * sn;
    }
    (sn, cn, dn)
}
