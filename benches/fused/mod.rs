//! What doing without fused multiply-add costs: the steps of the library's lanes written again, with and without it.
//!
//! The library has none, so that its bits are those of every processor. Here `FUSED` alone makes the difference: the text, the
//! instructions and the order of the loops are the same.

use std::hint::black_box;
use std::time::Instant;

use multiversion::multiversion;

const LANES: usize = 64;
/// Steps of a burst.
const STEPS: u64 = 400;
const STEP: f64 = 0.01;

#[derive(Clone, Copy)]
#[repr(align(64))]
struct Lane([f64; LANES]);

const ZERO: Lane = Lane([0.0; LANES]);

/// Attitude, momentum, and what rounding carries of each; constants of the steps.
struct Block {
    points: [Lane; 14],
    constants: [Lane; 5],
}

#[derive(Clone, Copy)]
enum Steps {
    TwoTurns,
    Rk4,
}

/// `a b + c`.
#[allow(clippy::disallowed_methods)] // compiled for processors that have it
#[inline(always)]
fn product<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn widest(block: &mut Block, steps: Steps) {
    run::<false>(block, steps);
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn widest_fused(block: &mut Block, steps: Steps) {
    run::<true>(block, steps);
}

#[multiversion(targets("x86_64+avx2"))]
fn avx2(block: &mut Block, steps: Steps) {
    run::<false>(block, steps);
}

#[multiversion(targets("x86_64+avx2+fma"))]
fn avx2_fused(block: &mut Block, steps: Steps) {
    run::<true>(block, steps);
}

#[inline(always)]
fn run<const FUSED: bool>(block: &mut Block, steps: Steps) {
    match steps {
        Steps::TwoTurns => {
            let mut angles = [ZERO; 2];
            for step in 0..STEPS {
                turn::<FUSED, 0>(block, &mut angles);
                turn::<FUSED, 2>(block, &mut angles);
                if step % 8 == 7 {
                    renormalize::<FUSED>(&mut block.points);
                }
            }
        }
        Steps::Rk4 => {
            for _ in 0..STEPS {
                rk4::<FUSED>(block);
            }
        }
    }
}

/// `sum += delta`, carried.
#[inline(always)]
fn add(sum: &mut f64, carry: &mut f64, delta: f64) {
    let new = *sum + delta;
    *carry = delta - (new - *sum);
    *sum = new;
}

#[inline(always)]
fn turn<const FUSED: bool, const AXIS: usize>(block: &mut Block, [sines, cosines]: &mut [Lane; 2]) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let rates = &block.constants[AXIS / 2];
    for n in 0..LANES {
        let x = block.points[4 + AXIS].0[n] * rates.0[n];
        let z = x * x;
        let sine = product::<FUSED>(z, product::<FUSED>(z, -1.0 / 5040.0, 1.0 / 120.0), -1.0 / 6.0);
        sines.0[n] = product::<FUSED>(x * z, sine, x);
        let half = 0.5 * z;
        let c = 1.0 - half;
        let high = product::<FUSED>(z, -1.0 / 720.0, 1.0 / 24.0);
        let tail = product::<FUSED>(z * z, 1.0 / 40320.0, high);
        cosines.0[n] = c + product::<FUSED>(z * z, tail, (1.0 - c) - half);
    }
    for n in 0..LANES {
        let (s, c) = (sines.0[n], cosines.0[n]);
        let less = 1.0 - c;
        let (v, w) = ((s + s) * s, (s + s) * c);
        let p = &mut block.points;
        let (mj, mk) = (p[4 + j].0[n], p[4 + k].0[n]);
        let (q0, qa, qj, qk) = (p[0].0[n], p[1 + AXIS].0[n], p[1 + j].0[n], p[1 + k].0[n]);
        let changes = [
            (4 + j, product::<FUSED>(w, mk, -(v * mj))),
            (4 + k, -product::<FUSED>(w, mj, v * mk)),
            (0, -product::<FUSED>(s, qa, less * q0)),
            (1 + AXIS, product::<FUSED>(s, q0, -(less * qa))),
            (1 + j, product::<FUSED>(s, qk, -(less * qj))),
            (1 + k, -product::<FUSED>(s, qj, less * qk)),
        ];
        for (place, change) in changes {
            let (mut sum, mut carry) = (p[place].0[n], p[place + 7].0[n]);
            let delta = change + carry;
            add(&mut sum, &mut carry, delta);
            (p[place].0[n], p[place + 7].0[n]) = (sum, carry);
        }
    }
}

#[inline(always)]
fn renormalize<const FUSED: bool>(p: &mut [Lane; 14]) {
    for n in 0..LANES {
        let (mut sum, mut rest) = (-1.0, 0.0);
        for k in 0..4 {
            let (q, low) = (p[k].0[n], p[k + 7].0[n]);
            let square = q * q;
            let error = if FUSED { product::<FUSED>(q, q, -square) } else { error_of_square(q, square) };
            for term in [square, product::<FUSED>(q + q, low, error)] {
                let new = sum + term;
                let added = new - sum;
                rest += (sum - (new - added)) + (term - added);
                sum = new;
            }
        }
        let factor = -0.5 * (sum + rest);
        for k in 0..4 {
            let (mut sum, mut carry) = (p[k].0[n], p[k + 7].0[n]);
            let delta = product::<FUSED>(sum, factor, carry);
            add(&mut sum, &mut carry, delta);
            (p[k].0[n], p[k + 7].0[n]) = (sum, carry);
        }
    }
}

/// Dekker's.
#[inline(always)]
fn error_of_square(q: f64, square: f64) -> f64 {
    let high = f64::from_bits(q.to_bits().wrapping_add(1 << 26) & !((1 << 27) - 1));
    let low = q - high;
    (high * high - square + 2.0 * (high * low)) + low * low
}

type Phase = [f64; 7];

/// `q ∘ (0, ω)` and `m × ω`.
#[inline(always)]
fn rate<const FUSED: bool>([w, x, y, z, m0, m1, m2]: Phase, [i0, i1, i2]: [f64; 3]) -> Phase {
    let (a, b, c) = (m0 * i0, m1 * i1, m2 * i2);
    let plus = product::<FUSED>;
    [
        -plus(z, c, plus(y, b, x * a)),
        plus(w, a, plus(y, c, -(z * b))),
        plus(w, b, plus(z, a, -(x * c))),
        plus(w, c, plus(x, b, -(y * a))),
        plus(m1, c, -(m2 * b)),
        plus(m2, a, -(m0 * c)),
        plus(m0, b, -(m1 * a)),
    ]
}

#[inline(always)]
fn moved<const FUSED: bool>(x: Phase, k: Phase, [q, m]: [f64; 2]) -> Phase {
    let plus = product::<FUSED>;
    [
        plus(k[0], q, x[0]),
        plus(k[1], q, x[1]),
        plus(k[2], q, x[2]),
        plus(k[3], q, x[3]),
        plus(k[4], m, x[4]),
        plus(k[5], m, x[5]),
        plus(k[6], m, x[6]),
    ]
}

#[inline(always)]
fn rk4<const FUSED: bool>(block: &mut Block) {
    let (h, sixth) = (STEP, STEP / 6.0);
    let Block { points: [p0, p1, p2, p3, p4, p5, p6, ..], constants: [_, _, i0, i1, i2] } = block;
    for n in 0..LANES {
        let x = [p0.0[n], p1.0[n], p2.0[n], p3.0[n], p4.0[n], p5.0[n], p6.0[n]];
        let inner = [i0.0[n], i1.0[n], i2.0[n]];
        let outer = [0.5 * inner[0], 0.5 * inner[1], 0.5 * inner[2]];
        let k1 = rate::<FUSED>(x, outer);
        let k2 = rate::<FUSED>(moved::<FUSED>(x, k1, [0.5 * h, h]), inner);
        let k3 = rate::<FUSED>(moved::<FUSED>(x, k2, [0.25 * h, 0.5 * h]), inner);
        let k4 = rate::<FUSED>(moved::<FUSED>(x, k3, [0.5 * h, h]), outer);
        let mut sum = k1;
        for (sum, ((k2, k3), k4)) in sum.iter_mut().zip(k2.iter().zip(&k3).zip(&k4)) {
            *sum = *sum + (k2 + k3) + k4;
        }
        let x = moved::<FUSED>(x, sum, [sixth, 2.0 * sixth]);
        [p0.0[n], p1.0[n], p2.0[n], p3.0[n], p4.0[n], p5.0[n], p6.0[n]] = x;
    }
}

/// Bodies that differ from lane to lane.
fn block() -> Block {
    let mut block = Block { points: [ZERO; 14], constants: [ZERO; 5] };
    for n in 0..LANES {
        let part = n as f64 / LANES as f64;
        let [i0, i1, i2] = [1.0, 1.0 / (1.6 + 0.4 * part), 1.0 / (2.2 + 0.4 * part)];
        let start = [1.0, 0.0, 0.0, 0.0, 0.4 + 0.2 * part, 1.6, -0.7 - 0.2 * part];
        for (lane, x) in block.points.iter_mut().zip(start) {
            lane.0[n] = x;
        }
        let constants = [0.5 * STEP * (i0 - i1), 0.5 * STEP * (i2 - i1), i0, i1, i2];
        for (lane, x) in block.constants.iter_mut().zip(constants) {
            lane.0[n] = x;
        }
    }
    block
}

/// Whether the processor has fused multiply-add; else it would be a call of the library of C.
fn available() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    return cfg!(target_arch = "aarch64");
}

/// Prints the time for a step of one body with separate roundings and fused, in ns, and the quotient.
pub(super) fn table(bursts: usize) {
    if !available() {
        println!("what doing without fused multiply-add costs: this processor has none");
        return;
    }
    println!("what doing without fused multiply-add costs, ns/body-step:");
    println!("{:10} {:16} {:>14} {:>12} {:>8}", "", "", "separate", "fused", "ratio");
    type Job = fn(&mut Block, Steps);
    let sets: [(&str, [Job; 2]); 2] = [("widest", [widest, widest_fused]), ("avx2", [avx2, avx2_fused])];
    for (set, jobs) in sets {
        for (name, steps) in [("two turns", Steps::TwoTurns), ("rk4", Steps::Rk4)] {
            let mut blocks = [block(), block()];
            let mut least = [f64::INFINITY; 2];
            for _ in 0..bursts {
                for ((job, block), least) in jobs.iter().zip(&mut blocks).zip(&mut least) {
                    let begun = Instant::now();
                    job(black_box(block), black_box(steps));
                    *least = least.min(begun.elapsed().as_secs_f64());
                }
            }
            let [separate, fused] = least.map(|time| 1e9 * time / (STEPS * LANES as u64) as f64);
            println!("{set:10} {name:16} {separate:14.2} {fused:12.2} {:8.2}", separate / fused);
        }
    }
}
