//! Schemes of composition and splitting: the lengths of the maps that make up one step, as data.
//!
//! ```text
//! composition    Φ_h = S_{γ₁h} ∘ S_{γ₂h} ∘ … ∘ S_{γ₂h} ∘ S_{γ₁h}            S a symmetric map of order 2
//! alternating    Φ_h = A_{a₁h} ∘ B_{b₁h} ∘ A_{a₂h} ∘ … ∘ B_{b₁h} ∘ A_{a₁h}   A, B flows; or B first and last
//! ```
//!
//! Every scheme reads the same from both ends, so Φ_h is symmetric, Φ_{−h} Φ_h = 1, and its order is even. The
//! constants hold the first half. What closes it follows: 1 − 2Σ in the centre of an odd number of lengths, ½ − Σ
//! on either side of the middle of an even number. Coefficients are multiples of 2⁻¹⁰⁴: so their sums are exact in
//! [`Dd`], and the lengths of a step add up to 1 without rounding.

use thiserror::Error;

use crate::num::{Dd, Real};

/// Coefficients of a composition or splitting method.
///
/// ```
/// use polhode::method::schemes::{Part, STRANG, SUZUKI_4};
/// use polhode::num::{Dd, Real};
/// assert_eq!(SUZUKI_4.lengths().map(|lengths| lengths.len()), Some(5));
/// let half = Dd::of(0.5);
/// assert_eq!(STRANG.flows(), [(Part::B, half), (Part::A, Dd::ONE), (Part::B, half)]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Name in [`ALL`].
    pub name: &'static str,
    /// Order of Φ_h.
    pub order: u32,
    /// Where the coefficients come from.
    pub source: &'static str,
    /// What they are coefficients of.
    pub stages: Stages,
}

/// The maps of one step and the first half of their lengths, as shares of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stages {
    /// γ₁, γ₂, … before the centre of a palindromic composition of one symmetric map of order 2; the centre is
    /// 1 − 2Σγ.
    Composition(&'static [Dd]),
    /// Two flows in turn, palindromic: a₁, a₂, … and b₁, b₂, … of the first half, what closes each left out.
    ///
    /// The whole step has one flow more of the part that is first. Its number of flows is odd if its list is
    /// longer by one than the other, and even if the lists are of the same length.
    Alternating {
        /// The part with which the step begins and ends.
        first: Part,
        /// Shares of A.
        a: &'static [Dd],
        /// Shares of B.
        b: &'static [Dd],
        /// The flows for which the scheme has its order.
        class: Class,
    },
}

/// One of the two flows of a splitting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The flow of A.
    A,
    /// The flow of B.
    B,
}

/// The pairs of flows for which a splitting has its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Any two flows.
    Any,
    /// Runge-Kutta-Nyström: A quadratic in the momenta, B a function of the attitude, so that `[B,[B,[B,A]]] = 0`.
    Nystrom,
    /// H = A + εB with p₁, p₂, …: the error is of size ε h^p₁ + ε² h^p₂ + …, the last p standing for all further
    /// powers of ε. The order is the last p, the smallest.
    NearIntegrable(&'static [u32]),
}

impl Scheme {
    /// Lengths of the steps of one symmetric map, all of them, palindromic; none for two flows in turn.
    pub fn lengths(&self) -> Option<Vec<Dd>> {
        match self.stages {
            Stages::Composition(gamma) => Some(closed(gamma, true)),
            Stages::Alternating { .. } => None,
        }
    }

    /// The flows of one step in order, each with its share of the step.
    ///
    /// A composition stands for that of Strang's map B(½) A(1) B(½), neighbouring flows of B merged into one.
    pub fn flows(&self) -> Vec<(Part, Dd)> {
        match self.stages {
            Stages::Composition(gamma) => {
                let a = closed(gamma, true);
                let mut b = vec![a[0] * 0.5];
                b.extend(a.windows(2).map(|pair| (pair[0] + pair[1]) * 0.5));
                b.push(b[0]);
                in_turn(Part::B, &b, &a)
            }
            Stages::Alternating { first, a, b, .. } => {
                let (outer, inner) = if first == Part::A { (a, b) } else { (b, a) };
                let odd = outer.len() > inner.len();
                in_turn(first, &closed(outer, odd), &closed(inner, !odd))
            }
        }
    }
}

/// The whole palindrome of a first half.
fn closed(half: &[Dd], odd: bool) -> Vec<Dd> {
    let sum = half.iter().fold(Dd::ZERO, |sum, &share| sum + share);
    let mut all = half.to_vec();
    if odd {
        all.push(Dd::ONE - sum * 2.0);
    } else {
        all.extend([Dd::of(0.5) - sum; 2]);
    }
    all.extend(half.iter().rev());
    all
}

/// `outer` and `inner` alternating, from the first of `outer` to its last.
fn in_turn(first: Part, outer: &[Dd], inner: &[Dd]) -> Vec<(Part, Dd)> {
    let second = if first == Part::A { Part::B } else { Part::A };
    let mut flows = Vec::with_capacity(outer.len() + inner.len());
    for (n, &share) in outer.iter().enumerate() {
        flows.push((first, share));
        flows.extend(inner.get(n).map(|&share| (second, share)));
    }
    flows
}

/// The scheme called `name`.
///
/// # Errors
/// A name that is not in [`ALL`].
///
/// ```
/// use polhode::method::schemes::scheme;
/// assert_eq!(scheme("kahan-li-8")?.order, 8);
/// assert_eq!(scheme("kahan-li8").map_err(|error| error.nearest), Err(Some("kahan-li-8")));
/// # Ok::<(), polhode::method::schemes::UnknownScheme>(())
/// ```
pub fn scheme(name: &str) -> Result<&'static Scheme, UnknownScheme> {
    ALL.iter()
        .find(|scheme| scheme.name == name)
        .ok_or_else(|| UnknownScheme { name: name.into(), nearest: nearest(name) })
}

/// A name that no scheme has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no scheme {name:?}{}; there are {}", suggestion(*nearest), names())]
pub struct UnknownScheme {
    /// What was asked for.
    pub name: String,
    /// The name that differs in the fewest letters, if that is a third of them at most.
    pub nearest: Option<&'static str>,
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |nearest| format!(", the nearest is {nearest}"))
}

fn names() -> String {
    ALL.iter().map(|scheme| scheme.name).collect::<Vec<_>>().join(", ")
}

fn nearest(name: &str) -> Option<&'static str> {
    let wanted = letters(name);
    ALL.iter()
        .map(|scheme| (letters(scheme.name), scheme.name))
        .map(|(known, name)| (distance(&wanted, &known), known.len(), name))
        .filter(|(distance, length, _)| 3 * distance <= *length)
        .min_by_key(|(distance, ..)| *distance)
        .map(|(.., name)| name)
}

/// Letters and digits in lower case: hyphens and capitals are no difference between names.
fn letters(name: &str) -> Vec<char> {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// How many letters must be changed, added or left out to turn `from` into `to` (Levenshtein).
fn distance(from: &[char], to: &[char]) -> usize {
    // row[n]: from what has been read of `from` to the first n letters of `to`
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for letter in from {
        let mut diagonal = row[0];
        row[0] += 1;
        for (n, wanted) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != wanted);
            diagonal = row[n + 1];
            row[n + 1] = replaced.min(row[n] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}

/// Every scheme: compositions first, each family by order.
pub const ALL: &[Scheme] = &[
    STRANG,
    YOSHIDA_4,
    SUZUKI_4,
    MCLACHLAN_4,
    YOSHIDA_6,
    KAHAN_LI_6,
    SOFRONIOU_SPALETTA_6,
    SUZUKI_UMENO_8,
    KAHAN_LI_8,
    SOFRONIOU_SPALETTA_8,
    SOFRONIOU_SPALETTA_10,
    MCLACHLAN_S5,
    BLANES_MOAN_S6,
    BLANES_MOAN_S10,
    SRKN_6B,
    SRKN_11B,
    SRKN_14A,
    BCE_22,
    SABA_2,
    SABA_3,
    SABA_4,
    ABA_8_4,
    ABA_8_6_4,
    ABA_10_6_4,
];

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

/// Five stages, γ₁ = γ₂ = 1/(4 − ∛4): the smallest Σ|γ| of all compositions of order 4 with five stages.
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

/// Five stages: five flows of A, six of B.
pub const MCLACHLAN_S5: Scheme = Scheme {
    name: "mclachlan-s5",
    order: 4,
    source: "McLachlan, SIAM J. Sci. Comput. 16 (1995) 151",
    stages: Stages::Alternating {
        first: Part::B,
        a: &[Dd::sum(0.4, -2.220446049250315e-17), Dd::sum(-0.1, 5.551115123125763e-18)],
        b: &[
            Dd::sum(0.08926945422647524, 5.46441640400309e-18),
            Dd::sum(-0.0973360426368955, -1.8404721723312994e-18),
        ],
        class: Class::Any,
    },
};

/// Six stages for any two flows.
pub const BLANES_MOAN_S6: Scheme = Scheme {
    name: "blanes-moan-s6",
    order: 4,
    source: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313",
    stages: Stages::Alternating {
        first: Part::B,
        a: &[
            Dd::sum(0.209515106613362, -6.582335084203826e-18),
            Dd::sum(-0.143851773179818, 9.928965238941614e-18),
        ],
        b: &[
            Dd::sum(0.0792036964311957, 5.750283845100035e-18),
            Dd::sum(0.353172906049774, -2.6904231050139063e-17),
            Dd::sum(-0.0420650803577195, -2.3942714797158475e-18),
        ],
        class: Class::Any,
    },
};

/// Ten stages for any two flows.
pub const BLANES_MOAN_S10: Scheme = Scheme {
    name: "blanes-moan-s10",
    order: 6,
    source: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313",
    stages: Stages::Alternating {
        first: Part::B,
        a: &[
            Dd::sum(0.148816447901042, -9.371863628075534e-18),
            Dd::sum(-0.132385865767784, -5.493398824910425e-18),
            Dd::sum(0.067307604692185, 3.135942788503619e-18),
            Dd::sum(0.432666402578175, -1.3360350931179716e-17),
        ],
        b: &[
            Dd::sum(0.0502627644003922, -3.775400318767524e-21),
            Dd::sum(0.413514300428344, 2.7284660694931504e-17),
            Dd::sum(0.0450798897943977, 1.6118047053168781e-18),
            Dd::sum(-0.188054853819569, -9.952371823601433e-18),
            Dd::sum(0.54196067845078, 2.083302460960135e-18),
        ],
        class: Class::Any,
    },
};

/// Six stages. It has order 4 for any two flows, but is made for [`Class::Nystrom`]: its error is smaller than that
/// of [`BLANES_MOAN_S6`] there, and larger elsewhere.
pub const SRKN_6B: Scheme = Scheme {
    name: "srkn-6b",
    order: 4,
    source: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313",
    stages: Stages::Alternating {
        first: Part::B,
        a: &[
            Dd::sum(0.245298957184271, 7.344926152654897e-19),
            Dd::sum(0.60487266571108, -4.236066542944152e-18),
        ],
        b: &[
            Dd::sum(0.0829844064174052, -4.2925922023641544e-18),
            Dd::sum(0.396309801498368, 2.48966792405554e-17),
            Dd::sum(-0.0390563049223486, 2.947680617580864e-19),
        ],
        class: Class::Any,
    },
};

/// Eleven stages.
pub const SRKN_11B: Scheme = Scheme {
    name: "srkn-11b",
    order: 6,
    source: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313",
    stages: Stages::Alternating {
        first: Part::B,
        a: &[
            Dd::sum(0.123229775946271, -5.726551095449405e-18),
            Dd::sum(0.290553797799558, 2.2078874515500477e-17),
            Dd::sum(-0.127049212625417, -9.325945681666774e-18),
            Dd::sum(-0.246331761062075, -5.771489850303606e-18),
            Dd::sum(0.357208872795928, -7.873132944950974e-19),
        ],
        b: &[
            Dd::sum(0.0414649985182624, -1.1836871602554346e-18),
            Dd::sum(0.198128671918067, 1.0256676652716105e-17),
            Dd::sum(-0.0400061921041533, 1.5401129030584224e-20),
            Dd::sum(0.0752539843015807, -8.441697689704664e-19),
            Dd::sum(-0.0115113874206879, 8.427195643093938e-19),
        ],
        class: Class::Nystrom,
    },
};

/// Fourteen stages.
pub const SRKN_14A: Scheme = Scheme {
    name: "srkn-14a",
    order: 6,
    source: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[
            Dd::sum(0.03785931984061157, 1.1474269566133294e-18),
            Dd::sum(0.102635633102435, 5.065651178028912e-18),
            Dd::sum(-0.02586788826655869, 3.910615035328925e-19),
            Dd::sum(0.314241403071447, 1.0307894055586076e-17),
            Dd::sum(-0.130144459517415, -1.0142457804249703e-17),
            Dd::sum(0.106417700369543, 2.6149249883929055e-18),
            Dd::sum(-0.00879424312851058, -1.5194377827445864e-19),
        ],
        b: &[
            Dd::sum(0.09171915262446165, 2.705959255217769e-18),
            Dd::sum(0.183983170005006, 2.9502926108762e-18),
            Dd::sum(-0.05653436583288827, -1.6116657036673161e-18),
            Dd::sum(0.004914688774712854, -1.5375890082145482e-19),
            Dd::sum(0.143761127168358, -1.0530724300224381e-17),
            Dd::sum(0.328567693746804, -1.5311032675526835e-18),
        ],
        class: Class::Nystrom,
    },
};

/// 19 stages.
pub const BCE_22: Scheme = Scheme {
    name: "bce-22",
    order: 8,
    source: "Blanes, Casas & Escorihuela-Tomàs, arXiv:2202.01541 (2022)",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[
            Dd::sum(0.0505805, -4.600764214046813e-19),
            Dd::sum(0.149999, 6.551204023708118e-18),
            Dd::sum(-0.055179551077161555, -2.134081634465169e-18),
            Dd::sum(0.42375589883533793, 2.180686078645742e-17),
            Dd::sum(-0.21349535358465904, -5.836534946049058e-18),
            Dd::sum(-0.06807697745740326, 2.9816692660556922e-18),
            Dd::sum(0.22791705697401343, 3.724363234364415e-18),
            Dd::sum(-0.2353736193810589, 6.2669753951039955e-18),
            Dd::sum(0.387413869179878, 2.463115708280229e-17),
        ],
        b: &[
            Dd::sum(0.12947860656053672, 6.427671535445141e-18),
            Dd::sum(0.22225726009267113, 1.0611284465797401e-17),
            Dd::sum(-0.05775148933251472, -2.5493421277401203e-19),
            Dd::sum(-0.05783122621039249, -3.4032624216646038e-18),
            Dd::sum(0.10308729743717536, -3.0120644092479e-18),
            Dd::sum(-0.14081961255409076, -1.2032045878485263e-17),
            Dd::sum(0.023446260349282627, 5.254531844838701e-19),
            Dd::sum(0.1348545173566841, -9.381893419627736e-18),
            Dd::sum(0.02879738210737793, 1.3289144676212062e-18),
        ],
        class: Class::Nystrom,
    },
};

/// Gauss and Legendre's two nodes and weights: every flow goes forward in time.
pub const SABA_2: Scheme = Scheme {
    name: "saba-2",
    order: 2,
    source: "Laskar & Robutel, Celest. Mech. Dyn. Astron. 80 (2001) 39",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[Dd::sum(0.2113248654051871, 1.1030435245950732e-17)],
        b: &[],
        class: Class::NearIntegrable(&[4, 2]),
    },
};

/// Gauss and Legendre's three nodes and weights: every flow goes forward in time.
pub const SABA_3: Scheme = Scheme {
    name: "saba-3",
    order: 2,
    source: "Laskar & Robutel, Celest. Mech. Dyn. Astron. 80 (2001) 39",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[Dd::sum(0.11270166537925831, -2.5675694035078595e-19)],
        b: &[Dd::sum(0.2777777777777778, -1.2335811384723967e-17)],
        class: Class::NearIntegrable(&[6, 2]),
    },
};

/// Gauss and Legendre's four nodes and weights: every flow goes forward in time.
pub const SABA_4: Scheme = Scheme {
    name: "saba-4",
    order: 2,
    source: "Laskar & Robutel, Celest. Mech. Dyn. Astron. 80 (2001) 39",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[
            Dd::sum(0.06943184420297371, -1.343070649335104e-18),
            Dd::sum(0.26057763400459816, -2.4025902041459873e-18),
        ],
        b: &[Dd::sum(0.17392742256872692, 3.83016819437472e-18)],
        class: Class::NearIntegrable(&[8, 2]),
    },
};

/// Five stages.
/// Digits from the conditions that define it: order 8 in the terms of ε, order 4 in those of ε².
pub const ABA_8_4: Scheme = Scheme {
    name: "aba-8-4",
    order: 4,
    source: "McLachlan, BIT 35 (1995) 258",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[
            Dd::sum(0.07534696026989289, -1.888537887653037e-18),
            Dd::sum(0.5179168546882568, 1.5330973441015132e-17),
        ],
        b: &[
            Dd::sum(0.19022593937367663, -8.72954331547291e-18),
            Dd::sum(0.8465240704435263, -3.156563642393361e-17),
        ],
        class: Class::NearIntegrable(&[8, 4]),
    },
};

/// Seven stages.
pub const ABA_8_6_4: Scheme = Scheme {
    name: "aba-8-6-4",
    order: 4,
    source: "Blanes, Casas, Farrés, Laskar, Makazaga & Murua, Appl. Numer. Math. 68 (2013) 58",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[
            Dd::sum(0.07113342649822312, 2.6359775707815445e-18),
            Dd::sum(0.2411534279566401, -5.2653186396815885e-18),
            Dd::sum(0.5214117617728148, 3.4473847006398237e-18),
        ],
        b: &[
            Dd::sum(0.18308368747219722, 1.2369803916738747e-18),
            Dd::sum(0.31078285989857485, 2.1450981759438636e-17),
            Dd::sum(-0.0265646185119588, -7.792741145892916e-19),
        ],
        class: Class::NearIntegrable(&[8, 6, 4]),
    },
};

/// Eight stages.
pub const ABA_10_6_4: Scheme = Scheme {
    name: "aba-10-6-4",
    order: 4,
    source: "Blanes, Casas, Farrés, Laskar, Makazaga & Murua, Appl. Numer. Math. 68 (2013) 58",
    stages: Stages::Alternating {
        first: Part::A,
        a: &[
            Dd::sum(0.038094497422412193, 1.9578337140092387e-18),
            Dd::sum(0.14529871611691375, -1.5902451824204334e-18),
            Dd::sum(0.20762769572554124, 1.1513933629912785e-17),
            Dd::sum(0.43590970365152615, 1.1151572706138482e-17),
        ],
        b: &[
            Dd::sum(0.09585888083707521, 2.3741519869608283e-18),
            Dd::sum(0.20444615314299877, 9.612101811843045e-18),
            Dd::sum(0.2170703479789911, -5.515179727878949e-18),
        ],
        class: Class::NearIntegrable(&[10, 6, 4]),
    },
};
