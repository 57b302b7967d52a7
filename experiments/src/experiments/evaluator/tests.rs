//! What could be wrong of the measure itself.

use polhode::flow::FreeMotion;
use polhode::rotation::{Quat, Vec3};

use super::bound::{Found, UNIT, errors, library, measure};
use super::forms::FORMS;
use super::grid::{CELLS, Start};
use super::reference::Reference;

/// Numbers of motions all over the grid.
fn some() -> impl Iterator<Item = u64> {
    (0..CELLS).step_by(41)
}

#[test]
fn an_evaluator_that_is_off_by_little_is_seen() {
    let [largest, median] = measure(some(), 8, library).unwrap().largest_and_median();
    assert!(largest < 12.0 && median < 3.0, "{largest} {median}");
    let turned = |motion: &FreeMotion, times: &[f64]| {
        let turn = Quat::new(1.0, Vec3([8.0 * UNIT, 0.0, 0.0]));
        let off = |(q, omega): Found| (q * turn, omega);
        library(motion, times).map(|found| found.into_iter().map(off).collect())
    };
    let [largest, median] = measure(some(), 8, turned).unwrap().largest_and_median();
    assert!(largest > 17.0 && (median - 16.0).abs() < 1.0, "{largest} {median}");
}

/// The forms agree with the reference where nothing is delicate, whichever axis is which, on both sides of the separatrix: a wrong
/// sign in one of them would be a wrong motion.
#[test]
fn every_form_is_the_motion() {
    let moments = [0.5, 0.75, 1.0];
    for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
        for omega in [[1.0, 0.25, 0.5], [0.25, -0.5, 1.0], [-1.0, 0.5, -0.125], [0.125, 0.25, -1.0]] {
            let start = Start { moments: axes.map(|k| moments[k]), omega };
            let reference = Reference::new(&start);
            for form in FORMS {
                let motion = (form.motion)(&start);
                for t in [-40.0, -1.0, 0.0, 0.5, 3.0, 77.0] {
                    let error = errors((motion(t), Vec3(omega)), reference.at(t))[0] * UNIT;
                    assert!(error < 1e-12, "{} {start:?} {t}: {error:e}", form.name);
                    let backward = errors((motion(-t), Vec3(omega)), reference.at(t))[0] * UNIT;
                    assert!(t == 0.0 || backward > 1e-3, "{} {start:?} {t}: {backward:e}", form.name);
                }
            }
        }
    }
}
