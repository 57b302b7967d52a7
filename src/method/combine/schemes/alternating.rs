//! Splittings of two flows that alternate.

use super::{Pairs, Part, Scheme, Stages};
use crate::num::Dd;

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
        pairs: Pairs::Any,
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
        pairs: Pairs::Any,
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
        pairs: Pairs::Any,
    },
};

/// Six stages. It has order 4 for any two flows, but is made for [`Pairs::Nystrom`]: its error is smaller than that
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
        pairs: Pairs::Any,
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
        pairs: Pairs::Nystrom,
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
        pairs: Pairs::Nystrom,
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
        pairs: Pairs::Nystrom,
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
        pairs: Pairs::NearIntegrable(&[4, 2]),
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
        pairs: Pairs::NearIntegrable(&[6, 2]),
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
        pairs: Pairs::NearIntegrable(&[8, 2]),
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
        pairs: Pairs::NearIntegrable(&[8, 4]),
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
        pairs: Pairs::NearIntegrable(&[8, 6, 4]),
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
        pairs: Pairs::NearIntegrable(&[10, 6, 4]),
    },
};
