//! Schemes with force gradients: some of their kicks are those of the potential V − c h² τᵀI⁻¹τ, τ the torque.
//!
//! That term is a double bracket, `[V, [T, V]] = τᵀI⁻¹τ`, a function of the attitude alone, so that its kick is exact too.
//! Without it no scheme of order above 2 has positive shares of both flows; with it these have order 4, and need fewer kicks.

use super::{Part, Scheme, Stages};
use crate::num::Dd;

const CHIN: &str = "Chin, Phys. Lett. A 226 (1997) 344";

/// Two free flows and, two neighbouring ones merged, two kicks, one of them with a gradient. All shares are positive.
pub const CHIN_4A: Scheme = Scheme {
    name: "chin-4a",
    order: 4,
    source: CHIN,
    stages: Stages::ForceGradient {
        first: Part::B,
        a: &[],
        b: &[Dd::sum(0.16666666666666666, 9.251858538542988e-18)],
        c: &[Dd::sum(0.0, 0.0), Dd::sum(0.013888888888888888, 7.709882115452695e-19)],
    },
};

/// Two kicks with gradients and, two neighbouring ones merged, two free flows. All shares are positive.
pub const CHIN_4B: Scheme = Scheme {
    name: "chin-4b",
    order: 4,
    source: CHIN,
    stages: Stages::ForceGradient {
        first: Part::A,
        a: &[Dd::sum(0.2113248654051871, 1.1030435245950732e-17)],
        b: &[],
        c: &[Dd::sum(0.005582274842315056, 2.2232208842598036e-19)],
    },
};

/// Three kicks, one of them with a gradient, and, two neighbouring ones merged, three free flows. All shares are positive.
pub const CHIN_4C: Scheme = Scheme {
    name: "chin-4c",
    order: 4,
    source: CHIN,
    stages: Stages::ForceGradient {
        first: Part::A,
        a: &[Dd::sum(0.16666666666666666, 9.251858538542988e-18)],
        b: &[Dd::sum(0.375, 0.0)],
        c: &[Dd::sum(0.0, 0.0), Dd::sum(0.005208333333333333, 2.891205793294514e-19)],
    },
};

/// As [`CHIN_4C`] with a smaller error: one share is free, and the source chooses that of the outer kicks.
pub const OMELYAN_MRYGLOD_FOLK_4: Scheme = Scheme {
    name: "omelyan-mryglod-folk-4",
    order: 4,
    source: "Omelyan, Mryglod & Folk, Phys. Rev. E 66 (2002) 026701",
    stages: Stages::ForceGradient {
        first: Part::A,
        a: &[Dd::sum(0.08935804763220159, -4.88512492480263e-18)],
        b: &[Dd::sum(0.2470939580390842, -1.0520641704533769e-17)],
        c: &[Dd::sum(0.0, 0.0), Dd::sum(0.006938106540706987, 1.4020920874978297e-19)],
    },
};
