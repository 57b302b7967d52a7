//! What the noise of the rates makes of the weak equations of one stretch: the band of its covariance.

use multiversion::multiversion;
use nalgebra::Matrix3;

use super::model::{Terms, cross_derivative};
use super::moments::Group;
use super::test_functions::{Seen, TestFunctions};
use crate::fit::physical::coordinates::ENTRIES;
use crate::num::banded::{Banded, REGISTER};

/// Room for the rows of all tests that overlap at one time, and for a column from any of them on.
const BLOCKS: usize = 64;

/// Σ A Aᵀ with A = −φ' J + φ K by pairs of tests.
pub(super) fn covariance(
    groups: impl Iterator<Item = Group>,
    terms: &Terms,
    tests: &TestFunctions,
) -> Banded {
    let mut sum = Banded::zeros(3 * tests.count, 3 * tests.reach + 2);
    let jj = terms.j * terms.j;
    // K is linear in the rate
    let per_rate: [Matrix3<f64>; 3] =
        core::array::from_fn(|a| cross_derivative(&terms.j, &terms.sensor.column(a).into_owned()));
    let pairs: [Matrix3<f64>; 6] = core::array::from_fn(|entry| {
        let (a, b) = ENTRIES[entry];
        let product = per_rate[a] * per_rate[b].transpose();
        if a == b { product } else { product + product.transpose() }
    });
    for group in groups {
        let k = terms.by_rate(&terms.rate(&group.reading), &group.wheel);
        let mut kk = k * k.transpose();
        for (pair, (a, b)) in pairs.iter().zip(ENTRIES) {
            kk += pair * group.scatter[(a, b)];
        }
        let products = Products {
            jj: jj * group.square,
            jk: terms.j * k.transpose() * group.square,
            kk: kk * group.square,
        };
        add_pairs(&mut sum, tests, group.time, &products);
    }
    sum
}

/// J J, J Kᵀ and K Kᵀ of a group of samples.
struct Products {
    jj: Matrix3<f64>,
    jk: Matrix3<f64>,
    kk: Matrix3<f64>,
}

/// Adds A Aᵀ of a group of samples at `time`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_pairs(sum: &mut Banded, tests: &TestFunctions, time: f64, products: &Products) {
    let Products { jj, jk, kk } = products;
    let kj = jk.transpose();
    let seen = Seen::new(tests, time);
    let rows = 3 * seen.count;
    // the blocks of all tests in a column of this one: one multiplies its φ', the other its φ
    let (mut slopes, mut values) = ([0.0; BLOCKS], [0.0; BLOCKS]);
    for k in 0..rows {
        (slopes[k], values[k]) = (seen.slope[k / 3], seen.value[k / 3]);
    }
    let (mut by_slope, mut by_value) = ([[0.0; BLOCKS]; 3], [[0.0; BLOCKS]; 3]);
    for q in 0..3 {
        let column = |m: &Matrix3<f64>| {
            let (x, y, z) = (m[(0, q)], m[(1, q)], m[(2, q)]);
            let mut column = [0.0; BLOCKS / 2];
            for three in column.chunks_exact_mut(3) {
                three.copy_from_slice(&[x, y, z]);
            }
            column
        };
        let (jj, kj, jk, kk) = (column(jj), column(&kj), column(jk), column(kk));
        for k in 0..BLOCKS / 2 {
            by_slope[q][k] = kj[k] * values[k] - jj[k] * slopes[k];
            by_value[q][k] = kk[k] * values[k] - jk[k] * slopes[k];
        }
    }
    for row in 0..seen.count {
        let (c, d) = (seen.slope[row], seen.value[row]);
        for q in 0..3 {
            let from = 3 * row + q;
            // whole registers: behind the last row stand zeros
            let column = sum.column_mut(3 * (seen.first + row) + q);
            // tests that only touch add nothing
            let used = ((rows - from).div_ceil(REGISTER) * REGISTER).min(column.len());
            let values = by_value[q][from..from + used].chunks_exact(REGISTER);
            let slopes = by_slope[q][from..from + used].chunks_exact(REGISTER);
            for ((into, value), slope) in column[..used].chunks_exact_mut(REGISTER).zip(values).zip(slopes) {
                for k in 0..REGISTER {
                    into[k] += value[k] * d - slope[k] * c;
                }
            }
        }
    }
}
