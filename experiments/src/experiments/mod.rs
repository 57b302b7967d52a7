//! The experiments, one file each, and what two of them share.

mod drift;
mod exact;
mod fit_efficiency;
mod followed;
mod heavy_top;
mod inertia;
mod lecture;
mod long_run;
mod order;

use crate::experiment::Experiment;

/// All of them, in the order in which `all` runs them.
pub(crate) const ALL: &[Experiment] = &[
    Experiment {
        name: "drift",
        question: "what each method keeps and loses on real bodies, and how wrong its attitude is",
        run: drift::run,
    },
    Experiment {
        name: "order",
        question: "whether each method converges with the order it claims",
        run: order::run,
    },
    Experiment {
        name: "exact",
        question: "how exact the exact motion is, in every regime and at any time",
        run: exact::run,
    },
    Experiment {
        name: "long-run",
        question: "what grows over very many steps, and how fast",
        run: long_run::run,
    },
    Experiment {
        name: "inertia",
        question: "whether inertia tensors are right: closed forms, meshes, the lecture's statements, the doctor",
        run: inertia::run,
    },
    Experiment {
        name: "fit-efficiency",
        question: "how close a fitted tensor comes to the Cramer-Rao bound, and what other formulations lose",
        run: fit_efficiency::run,
    },
    Experiment {
        name: "lecture",
        question: "whether every statement of a lecture on rotating bodies is confirmed",
        run: lecture::run,
    },
    Experiment {
        name: "heavy-top",
        question: "what each method keeps of tops under gravity, and how wrong its attitude is",
        run: heavy_top::run,
    },
];
