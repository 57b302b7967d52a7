//! Compositions of one symmetric map of order 2.

use super::{Scheme, Stages};
use crate::num::Dd;

/// The map itself; of two flows B(½) A(1) B(½).
pub const STRANG: Scheme = Scheme {
    name: "strang",
    order: 2,
    source: "Strang, SIAM J. Numer. Anal. 5 (1968) 506",
    stages: Stages::Composition(&[]),
};

/// Three stages, γ₁ = 1/(2 − ∛2): as many lengths as conditions.
pub const YOSHIDA_4: Scheme = Scheme {
    name: "yoshida-4",
    order: 4,
    source: "Yoshida, Phys. Lett. A 150 (1990) 262",
    stages: Stages::Composition(&[Dd::sum(1.3512071919596575, 8.427417755451761e-17)]),
};

/// Five stages, γ₁ = γ₂ = 1/(4 − ∛4): the smallest Σ|γ| of all compositions of order 4 with five stages or fewer, palindromes
/// or not.
///
/// Order 4 needs Σγ = 1 and Σγ³ = 0. Let n be the sum of the negative lengths without their sign; the sum of their cubes is n³ at
/// most. The positive ones, four at most, add up to 1 + n, and their cubes to (1 + n)³/16 at least, when they are equal. So
/// (1 + n)³ ≤ 16 n³, and Σ|γ| = 1 + 2n ≥ 1 + 2/(∛16 − 1), which this scheme attains.
pub const SUZUKI_4: Scheme = Scheme {
    name: "suzuki-4",
    order: 4,
    source: "Suzuki, Phys. Lett. A 146 (1990) 319",
    stages: Stages::Composition(&[
        Dd::sum(0.4144907717943757, 2.5197374150855996e-17),
        Dd::sum(0.4144907717943757, 2.5197374150855996e-17),
    ]),
};

/// Five stages, γ₁ = 0.28, γ₂ from the condition of order 4.
pub const MCLACHLAN_4: Scheme = Scheme {
    name: "mclachlan-4",
    order: 4,
    source: "McLachlan, SIAM J. Sci. Comput. 16 (1995) 151",
    stages: Stages::Composition(&[
        Dd::sum(0.28, -2.664535259100378e-17),
        Dd::sum(0.6254664284676701, -4.304152576880079e-17),
    ]),
};

/// Seven stages: as many lengths as conditions.
/// Digits of Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), V.3.2.
pub const YOSHIDA_6: Scheme = Scheme {
    name: "yoshida-6",
    order: 6,
    source: "Yoshida, Phys. Lett. A 150 (1990) 262, solution A",
    stages: Stages::Composition(&[
        Dd::sum(0.7845136104775573, -3.556352475224422e-17),
        Dd::sum(0.23557321335935813, 3.5702639627194775e-18),
        Dd::sum(-1.177679984178871, -2.033558367431901e-17),
    ]),
};

/// Nine stages.
/// Digits of Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), V.3.2.
pub const KAHAN_LI_6: Scheme = Scheme {
    name: "kahan-li-6",
    order: 6,
    source: "Kahan & Li, Math. Comp. 66 (1997) 1089",
    stages: Stages::Composition(&[
        Dd::sum(0.3921614440073141, 1.9826094706010702e-17),
        Dd::sum(0.33259913678935943, 9.998816861580816e-18),
        Dd::sum(-0.7062461725576393, -3.081725796915952e-17),
        Dd::sum(0.0822135962935508, 5.55121888491532e-18),
    ]),
};

/// Eleven stages. The scheme of thirteen stages in the same source is left out: at equal cost its error is about
/// the same.
pub const SOFRONIOU_SPALETTA_6: Scheme = Scheme {
    name: "sofroniou-spaletta-6",
    order: 6,
    source: "Sofroniou & Spaletta, Optim. Methods Softw. 20 (2005) 597",
    stages: Stages::Composition(&[
        Dd::sum(0.21375583945878254, 2.7827836190363788e-18),
        Dd::sum(0.18329381407425713, 1.153622127331333e-17),
        Dd::sum(0.17692819473098945, -8.543598008614992e-18),
        Dd::sum(-0.4432908268117022, 1.8116810931696665e-17),
        Dd::sum(0.11728560432865935, 2.484334487596978e-18),
    ]),
};

/// Fifteen stages: as many lengths as conditions.
/// Digits of Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), V.3.2.
pub const SUZUKI_UMENO_8: Scheme = Scheme {
    name: "suzuki-umeno-8",
    order: 8,
    source: "Suzuki & Umeno, Computer Simulation Studies in Condensed-Matter Physics VI (1993) 74",
    stages: Stages::Composition(&[
        Dd::sum(0.741670364350613, -5.148655322768889e-19),
        Dd::sum(-0.4091008258000316, 3.8036097216716534e-18),
        Dd::sum(0.1907547102962384, -8.968542234075819e-18),
        Dd::sum(-0.5738624711160822, -2.6626178225233602e-17),
        Dd::sum(0.2990641813036559, 5.612964695238494e-18),
        Dd::sum(0.33462491824529816, 1.9697115983338864e-17),
        Dd::sum(0.3152930923967666, -1.994874881567808e-17),
    ]),
};

/// Seventeen stages.
/// Digits of Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), V.3.2.
pub const KAHAN_LI_8: Scheme = Scheme {
    name: "kahan-li-8",
    order: 8,
    source: "Kahan & Li, Math. Comp. 66 (1997) 1089",
    stages: Stages::Composition(&[
        Dd::sum(0.13020248308889007, 1.116092647858709e-17),
        Dd::sum(0.5611629817751084, 1.3032594121955572e-17),
        Dd::sum(-0.38947496264484727, -1.9606416555400342e-17),
        Dd::sum(0.1588419065551556, 7.801358343533897e-18),
        Dd::sum(-0.39590389413323757, -1.1269790435660092e-17),
        Dd::sum(0.1845396409783157, -3.914442028717325e-18),
        Dd::sum(0.25837438768632204, 9.400318801672467e-18),
        Dd::sum(0.2950117236093103, 2.648390331662844e-17),
    ]),
};

/// 21 stages.
pub const SOFRONIOU_SPALETTA_8: Scheme = Scheme {
    name: "sofroniou-spaletta-8",
    order: 8,
    source: "Sofroniou & Spaletta, Optim. Methods Softw. 20 (2005) 597",
    stages: Stages::Composition(&[
        Dd::sum(0.10647728984550031, 6.845541886003246e-18),
        Dd::sum(0.10837408645835726, 6.892324821645033e-19),
        Dd::sum(0.35337821052654345, -2.169537824710007e-17),
        Dd::sum(-0.23341414023165083, 7.594418906545191e-18),
        Dd::sum(-0.2444526679152884, 2.973481211429229e-19),
        Dd::sum(0.11317848435755633, 5.514010809029843e-18),
        Dd::sum(0.1189290562500035, 5.2838924930806035e-18),
        Dd::sum(0.12603912321825989, -3.892054941470884e-18),
        Dd::sum(0.12581718736176042, -6.1251531385963115e-18),
        Dd::sum(0.11699135019217642, 2.9976708886671677e-19),
    ]),
};

/// 35 stages.
pub const SOFRONIOU_SPALETTA_10: Scheme = Scheme {
    name: "sofroniou-spaletta-10",
    order: 10,
    source: "Sofroniou & Spaletta, Optim. Methods Softw. 20 (2005) 597",
    stages: Stages::Composition(&[
        Dd::sum(0.07879572252168641, 4.378563061195694e-18),
        Dd::sum(0.3130961034151085, 1.0155656902409903e-17),
        Dd::sum(0.027918383235078066, -1.9588702426139176e-20),
        Dd::sum(-0.22959284159390708, -1.201954863153999e-17),
        Dd::sum(0.13096206107716488, -1.3146875601399399e-17),
        Dd::sum(-0.2697334056545107, -9.292846834513666e-18),
        Dd::sum(0.07497334315589144, -8.294709988096802e-19),
        Dd::sum(0.1119934239998102, 3.315063244238864e-18),
        Dd::sum(0.36613344954622673, 2.097299279146865e-17),
        Dd::sum(-0.3991056301360359, -4.105091391756163e-18),
        Dd::sum(0.10308739852747108, -1.426477956866179e-19),
        Dd::sum(0.41143087395589023, 7.234085746576852e-18),
        Dd::sum(-0.0048663605831352616, -1.9975821350632564e-19),
        Dd::sum(-0.3920333537086399, -8.609231761832131e-18),
        Dd::sum(0.05194250296244965, -2.224772738016289e-18),
        Dd::sum(0.050665090759924494, 2.045607139069123e-18),
        Dd::sum(0.049674370639729876, 3.4007127165069045e-18),
    ]),
};
