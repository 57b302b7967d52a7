//! Processed schemes: a kernel between a processor and its inverse, which are taken once each, however many steps there are.
//!
//! The kernels have fewer stages or smaller errors than any composition of their order, because only those conditions bind them
//! that no change of variables can satisfy; the processor is that change. The digits are those of the source brought to 30 by
//! Newton's method on the conditions of order, in tests/data/schemes/processed.py.

use super::{Pairs, Scheme, Stages};
use crate::num::Dd;

const SOURCE: &str = "Blanes, Casas & Murua, SIAM J. Sci. Comput. 27 (2006) 1817";

/// Order 6 with a kernel of eleven stages and a processor of twelve.
pub const BLANES_CASAS_MURUA_6_11: Scheme = Scheme {
    name: "blanes-casas-murua-6-11",
    order: 6,
    source: SOURCE,
    stages: Stages::Processed {
        kernel: &[
            Dd::sum(0.1705768865009222, 1.2196987753965861e-17),
            Dd::sum(0.1705768865009222, 1.2196987753965861e-17),
            Dd::sum(0.1705768865009222, 1.2196987753965861e-17),
            Dd::sum(0.1705768865009222, 1.2196987753965861e-17),
            Dd::sum(-0.42336614089265806, 1.2501508949411642e-17),
        ],
        processor: &[
            Dd::sum(0.26803723597976836, 1.1688663421408266e-17),
            Dd::sum(0.20621953139125973, 1.8207161672630526e-19),
            Dd::sum(-0.23651387483203115, -2.4364843811025176e-18),
            Dd::sum(-0.09086982276240825, -6.382317114226107e-19),
            Dd::sum(-0.2468730697765887, 1.0632883985330826e-17),
            Dd::sum(0.1, -5.551115123125763e-18),
        ],
    },
};

/// Order 6 with a kernel of thirteen stages and a processor of twelve.
pub const BLANES_CASAS_MURUA_6_13: Scheme = Scheme {
    name: "blanes-casas-murua-6-13",
    order: 6,
    source: SOURCE,
    stages: Stages::Processed {
        kernel: &[
            Dd::sum(0.12569628872010605, -6.4802607322599985e-18),
            Dd::sum(0.12569628872010605, -6.4802607322599985e-18),
            Dd::sum(0.12569628872010605, -6.4802607322599985e-18),
            Dd::sum(0.12569628872010605, -6.4802607322599985e-18),
            Dd::sum(0.14807066011496475, 6.388893783306539e-18),
            Dd::sum(-0.35085637082382914, -2.232845879292226e-17),
        ],
        processor: &[
            Dd::sum(-0.1, 5.551115123125763e-18),
            Dd::sum(-0.225080298761176, 8.428084644912625e-18),
            Dd::sum(-0.191244694511161, 1.20263452468887e-17),
            Dd::sum(0.21276379219489003, -2.6916336501113773e-18),
            Dd::sum(0.09660157306582294, 9.062632943740385e-19),
            Dd::sum(0.20695962801162401, -1.0342386851375391e-17),
        ],
    },
};

/// Order 8 with a kernel of thirteen stages and a processor of twenty, fewer than the fifteen that a composition needs.
pub const BLANES_CASAS_MURUA_8_13: Scheme = Scheme {
    name: "blanes-casas-murua-8-13",
    order: 8,
    source: SOURCE,
    stages: Stages::Processed {
        kernel: &[
            Dd::sum(0.168, -1.0436096431476456e-17),
            Dd::sum(0.168, -1.0436096431476456e-17),
            Dd::sum(0.5855505308055625, -4.6645976941339074e-17),
            Dd::sum(-0.46009045751687183, 2.130547036695657e-17),
            Dd::sum(0.17286314872972955, -1.3539984245906682e-17),
            Dd::sum(0.17966453969504048, -5.9973436938105065e-18),
        ],
        processor: &[
            Dd::sum(0.5189243107374701, -2.072789214014042e-18),
            Dd::sum(0.008488123494574356, -5.776588691845855e-19),
            Dd::sum(0.3371889673543381, -2.4289832416805326e-17),
            Dd::sum(-0.3339877681645969, -2.3843731620928834e-18),
            Dd::sum(-0.5883511890038489, 3.00366474506675e-17),
            Dd::sum(-0.16232420759924102, 4.052221484458071e-18),
            Dd::sum(0.5117449261164131, -2.6604853861082307e-17),
            Dd::sum(-0.23688595236338394, -7.888016971389611e-19),
            Dd::sum(-0.5982129759433811, 3.673512237692919e-17),
            Dd::sum(0.543415765371656, 5.354853347135882e-17),
        ],
    },
};

/// Order 10 with a kernel of 23 stages and a processor of 24; compositions of that order have 31 at least.
pub const BLANES_CASAS_MURUA_10_23: Scheme = Scheme {
    name: "blanes-casas-murua-10-23",
    order: 10,
    source: SOURCE,
    stages: Stages::Processed {
        kernel: &[
            Dd::sum(0.12165774891938645, 6.507181069233259e-18),
            Dd::sum(0.12165774891938645, 6.507181069233259e-18),
            Dd::sum(0.12165774891938645, 6.507181069233259e-18),
            Dd::sum(0.12165774891938645, 6.507181069233259e-18),
            Dd::sum(0.12165774891938645, 6.507181069233259e-18),
            Dd::sum(-0.5113187801547755, -6.721456090559302e-18),
            Dd::sum(-0.17285861488493595, 7.946949296603958e-18),
            Dd::sum(0.1230162588330761, -1.9960389801959785e-19),
            Dd::sum(0.4415039516715601, -2.4577490212079442e-17),
            Dd::sum(-0.3270713241655216, 1.4541759046324372e-17),
            Dd::sum(0.07095270095772091, -3.385232440920296e-18),
        ],
        processor: &[
            Dd::sum(-0.32941750280614973, 1.580194336830588e-17),
            Dd::sum(-0.47271420581796136, -2.9184198153986542e-18),
            Dd::sum(-0.013447506163907759, 3.855189413505983e-19),
            Dd::sum(0.4637104690311466, 7.140834931419737e-18),
            Dd::sum(0.30455909204077225, 1.8060669846623963e-17),
            Dd::sum(0.5382945811190418, -5.516070938850975e-17),
            Dd::sum(0.1899795525597184, -9.916991135387603e-18),
            Dd::sum(-0.1548256469637176, -1.143855394390123e-17),
            Dd::sum(0.35941480242978924, 1.9925375671463468e-17),
            Dd::sum(-0.3430345662478961, -1.0874917528066803e-17),
            Dd::sum(-0.5334030273674978, -1.57719179275392e-17),
            Dd::sum(-0.00911604181333797, -3.356433957572941e-19),
        ],
    },
};

/// Two stages for H = A + εB, A quadratic in the momenta and B a function of the attitude: the error is of size
/// ε h⁶ + ε² h⁴.
pub const PROCESSED_6_4: Scheme = Scheme {
    name: "processed-6-4",
    order: 4,
    source: "Blanes, Casas & Murua, Acta Numer. 33 (2024) 1, table 8.5",
    stages: Stages::ProcessedAlternating {
        a: &[Dd::sum(-0.23394491250693528, -2.9616864732833764e-18)],
        b: &[Dd::sum(1.2339449125069353, 2.9616864732833764e-18)],
        processor_a: &[
            Dd::sum(-0.48422967984578613, 8.010795217560749e-18),
            Dd::sum(0.3104400973059574, 2.6304198238084036e-17),
            Dd::sum(0.9112603236884161, 3.092677798731437e-17),
        ],
        processor_b: &[
            Dd::sum(-0.5, 0.0),
            Dd::sum(-0.07144449182724576, 5.429060591803395e-20),
            Dd::sum(0.5119423407689261, -3.6975687322951804e-17),
            Dd::sum(-0.225647154894841, 1.3087402277959031e-17),
        ],
        pairs: Pairs::NearIntegrableNystrom(&[6, 4]),
    },
};
