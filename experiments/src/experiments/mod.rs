//! The experiments, one file each, and what two of them share.

mod drift;
mod exact;
mod fit_efficiency;
mod fit_field;
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
        question: "what each method conserves on real bodies, and its attitude error",
        run: drift::run,
    },
    Experiment {
        name: "order",
        question: "whether each method converges with the order it claims",
        run: order::run,
    },
    Experiment {
        name: "exact",
        question: "how accurate the exact motion is, in every regime and at any time",
        run: exact::run,
    },
    Experiment {
        name: "long-run",
        question: "which errors grow over very many steps, and how fast",
        run: long_run::run,
    },
    Experiment {
        name: "inertia",
        question: "whether inertia tensors are right: closed forms, meshes, statements of the lecture, diagnosis of mistakes",
        run: inertia::run,
    },
    Experiment {
        name: "fit-efficiency",
        question: "how close a fitted tensor comes to the Cramer-Rao bound, and what other formulations lose",
        run: fit_efficiency::run,
    },
    Experiment {
        name: "fit-field",
        question: "what drag, torques, wheels, sensors that are off, spikes and mistaken units do to a fit",
        run: fit_field::run,
    },
    Experiment {
        name: "lecture",
        question: "whether every statement of a lecture on rotating bodies is confirmed",
        run: lecture::run,
    },
    Experiment {
        name: "heavy-top",
        question: "what each method conserves of tops under gravity, and its attitude error",
        run: heavy_top::run,
    },
];
