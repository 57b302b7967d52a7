//! `tsit5`: the coefficients of order 5(4) of Tsitouras, Comput. Math. Appl. 62 (2011) 770, table 1, with dense output
//! of order 4.
//!
//! They are printed with some 16 digits and meet the conditions of order 5 within 2e-14: enough for every tolerance that there
//! is. In the tables stages count from 0.

use crate::body::Phase;
use crate::method::runge_kutta::{Control, Embedded, Pair, Stage, Terms, sum};
use crate::num::{Dd, Real};

/// Order 5(4) of Tsitouras with dense output of order 4 and a proportional and integral step control, `e^−7/50 e'^2/25`: 6 right
/// sides a step. Its tolerance is 1e-6 unless another is given.
pub type Tsit5 = Embedded<Tsitouras54>;

/// The pair of Tsit5: order 5, error estimate of order 4, dense output of order 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tsitouras54;

impl Pair for Tsitouras54 {
    const NAME: &'static str = "tsit5";
    const SOURCE: &'static str = "Tsitouras, Comput. Math. Appl. 62 (2011) 770";
    const USUAL_TOLERANCE: f64 = 1e-6;
    const ORDER: u32 = 5;
    const CONTROL: Control = Control {
        proportional: |e| libm::pow(e, -0.14),
        integral: |e| libm::pow(e, 0.08),
        least: 0.2,
        most: 10.0,
        grows_after_rejection: true,
    };
    const STAGES: &'static [Stage] = STAGES;
    const WEIGHTS: &'static Terms = WEIGHTS;
    const END: usize = 6;
    const END_IN_ESTIMATE: bool = true;
    const DENSE_STAGES: &'static [Stage] = &[];

    /// `|e₄|`, the difference of the results of orders 5 and 4.
    fn estimate<S: Real>(rates: &[Phase<S>], weigh: impl Fn(&Phase<S>) -> f64) -> f64 {
        weigh(&sum(rates, FOURTH)).sqrt()
    }

    fn dense<S: Real>(rates: &[Phase<S>], _: Phase<S>, h: S) -> [Phase<S>; 7] {
        let [a, b, c, d] = DENSE.map(|terms| sum(rates, terms) * h);
        [a, b, c, d, Phase::zero(), Phase::zero(), Phase::zero()]
    }

    /// `Σ p_n θⁿ`.
    fn at<S: Real>(dense: &[Phase<S>; 7], theta: S) -> Phase<S> {
        dense[..4].iter().rev().fold(Phase::zero(), |change, p| (change + *p) * theta)
    }
}

/// Nodes and stages 2 to 6.
const STAGES: &[Stage] = &[
    (Dd::sum(0.161, 0.0), &[(0, Dd::sum(0.161, 0.0))]),
    (Dd::sum(0.327, 0.0), &[(0, Dd::sum(-0.008480655492356989, 0.0)), (1, Dd::sum(0.335480655492357, 0.0))]),
    (
        Dd::sum(0.9, 0.0),
        &[
            (0, Dd::sum(2.8971530571054935, 0.0)),
            (1, Dd::sum(-6.359448489975075, 0.0)),
            (2, Dd::sum(4.3622954328695815, 0.0)),
        ],
    ),
    (
        Dd::sum(0.9800255409045097, 0.0),
        &[
            (0, Dd::sum(5.325864828439257, 0.0)),
            (1, Dd::sum(-11.748883564062828, 0.0)),
            (2, Dd::sum(7.4955393428898365, 0.0)),
            (3, Dd::sum(-0.09249506636175525, 0.0)),
        ],
    ),
    (
        Dd::ONE,
        &[
            (0, Dd::sum(5.86145544294642, 0.0)),
            (1, Dd::sum(-12.92096931784711, 0.0)),
            (2, Dd::sum(8.159367898576159, 0.0)),
            (3, Dd::sum(-0.071584973281401, 0.0)),
            (4, Dd::sum(-0.028269050394068383, 0.0)),
        ],
    ),
];

/// Weights of order 5.
const WEIGHTS: &Terms = &[
    (0, Dd::sum(0.09646076681806523, 0.0)),
    (1, Dd::sum(0.01, 0.0)),
    (2, Dd::sum(0.4798896504144996, 0.0)),
    (3, Dd::sum(1.379008574103742, 0.0)),
    (4, Dd::sum(-3.290069515436081, 0.0)),
    (5, Dd::sum(2.324710524099774, 0.0)),
];

/// What the result differs by from that of order 4.
const FOURTH: &Terms = &[
    (0, Dd::sum(-0.001780011052225777, 0.0)),
    (1, Dd::sum(-0.0008164344596567469, 0.0)),
    (2, Dd::sum(0.007880878010261995, 0.0)),
    (3, Dd::sum(-0.1447110071732629, 0.0)),
    (4, Dd::sum(0.5823571654525552, 0.0)),
    (5, Dd::sum(-0.45808210592918697, 0.0)),
    (6, Dd::sum(0.015151515151515152, 0.0)),
];

/// Dense output: coefficients of θ, θ², θ³ and θ⁴.
const DENSE: [&Terms; 4] = [
    &[(0, Dd::ONE)],
    &[
        (0, Dd::sum(-2.763706197274826, 0.0)),
        (1, Dd::sum(0.13169999999999998, 0.0)),
        (2, Dd::sum(3.9302962368947516, 0.0)),
        (3, Dd::sum(-12.411077166933676, 0.0)),
        (4, Dd::sum(37.50931341651104, 0.0)),
        (5, Dd::sum(-27.896526289197286, 0.0)),
        (6, Dd::sum(1.5, 0.0)),
    ],
    &[
        (0, Dd::sum(2.9132554618219126, 0.0)),
        (1, Dd::sum(-0.2234, 0.0)),
        (2, Dd::sum(-5.941033872131505, 0.0)),
        (3, Dd::sum(30.33818863028232, 0.0)),
        (4, Dd::sum(-88.1789048947664, 0.0)),
        (5, Dd::sum(65.09189467479366, 0.0)),
        (6, Dd::sum(-4.0, 0.0)),
    ],
    &[
        (0, Dd::sum(-1.0530884977290216, 0.0)),
        (1, Dd::sum(0.1017, 0.0)),
        (2, Dd::sum(2.490627285651253, 0.0)),
        (3, Dd::sum(-16.548102889244902, 0.0)),
        (4, Dd::sum(47.37952196281928, 0.0)),
        (5, Dd::sum(-34.87065786149661, 0.0)),
        (6, Dd::sum(2.5, 0.0)),
    ],
];
