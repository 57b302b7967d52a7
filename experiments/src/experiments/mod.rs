//! The experiments, one file each, and what two of them share.

mod advice;
mod audit;
mod chaos;
mod compared;
mod conservation;
mod contestants;
mod derivative;
mod dissipation;
mod drift;
mod evaluator;
mod exact;
mod fit_attitudes;
mod fit_efficiency;
mod fit_field;
mod fit_stress;
mod flyby;
mod followed;
mod fourth_order;
mod heavy_top;
mod inertia;
mod lecture;
mod long_run;
mod modified_energy;
mod order;
mod phase;
mod random_bodies;
mod round_off;
mod scoreboard;
mod separatrix;
mod splitting_order;
mod strapdown;
mod tensors;
mod tumblers;
mod wheels;
mod work_precision;

pub(crate) use work_precision::Which;

use crate::experiment::Experiment;

/// What runs where none is named: what the project exists for, within a minute.
pub(crate) const MAIN: [&str; 6] =
    ["scoreboard", "order", "exact", "inertia", "fit-efficiency", "work-precision"];

/// All of them, in the order in which `all` runs them.
pub(crate) const ALL: &[Experiment] = &[
    Experiment {
        name: "scoreboard",
        question: "how near the best method of each family comes to the exact motion, at equal cost on real bodies",
        run: scoreboard::run,
    },
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
        name: "fourth-order",
        question: "which methods of order four lose less of the attitude than rk4, at the same step and at the same cost, over random bodies, near the separatrix too",
        run: fourth_order::run,
    },
    Experiment {
        name: "exact",
        question: "how accurate the exact motion is, in every regime and at any time",
        run: exact::run,
    },
    Experiment {
        name: "evaluator",
        question: "what one evaluation of the exact motion loses to rounding, and what other forms of the solution lose",
        run: evaluator::run,
    },
    Experiment {
        name: "derivative",
        question: "how exact the derivative of the exact motion is, whether all motions through two attitudes are found, and what a covariance is worth",
        run: derivative::run,
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
        name: "fit-attitudes",
        question: "how close a tensor from measured attitudes comes to the Cramer-Rao bound, and what differencing them loses",
        run: fit_attitudes::run,
    },
    Experiment {
        name: "fit-field",
        question: "what drag, torques, wheels, sensors that are off, spikes and mistaken units do to a fit",
        run: fit_field::run,
    },
    Experiment {
        name: "fit-stress",
        question: "what a fit makes of bodies that are neither free nor rigid, and of sensors with errors of every kind",
        run: fit_stress::run,
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
    Experiment {
        name: "phase",
        question: "how fast the attitude error grows, as time along the polhode and as twist about L: predicted and measured",
        run: phase::run,
    },
    Experiment {
        name: "conservation",
        question: "what each family of methods conserves, with its sign, against time",
        run: conservation::run,
    },
    Experiment {
        name: "round-off",
        question: "how rounding errors grow with the number of steps, with compensated sums and without",
        run: round_off::run,
    },
    Experiment {
        name: "separatrix",
        question: "how long each method turns a body over at the right times, next to the separatrix",
        run: separatrix::run,
    },
    Experiment {
        name: "work-precision",
        question: "which method reaches which accuracy at least cost, by body, force and horizon",
        run: work_precision::run,
    },
    Experiment {
        name: "random-bodies",
        question: "from which share of random bodies and starts a method is the quickest for an attitude error, and how far the others are behind",
        run: random_bodies::run,
    },
    Experiment {
        name: "modified-energy",
        question: "what energy a splitting keeps, and how small the rest is that no modified energy keeps",
        run: modified_energy::run,
    },
    Experiment {
        name: "splitting-order",
        question: "how the order of the axes changes the errors of a splitting, predicted and measured",
        run: splitting_order::run,
    },
    Experiment {
        name: "chaos",
        question: "what each method says of a chaotic top: energy, L_z, Lyapunov exponent, and how long the attitude holds",
        run: chaos::run,
    },
    Experiment {
        name: "dissipation",
        question: "how a tumbling body with inner friction comes to a steady spin, and what the splitting keeps on the way",
        run: dissipation::run,
    },
    Experiment {
        name: "tumblers",
        question: "whether the tumbling bodies of the catalogue have the figures of their papers",
        run: tumblers::run,
    },
    Experiment {
        name: "wheels",
        question: "how a wheel takes up the spin of a spacecraft, whether the closed form with wheels holds between switchings, and which method follows wheels best",
        run: wheels::run,
    },
    Experiment {
        name: "flyby",
        question: "what the Earth does to the spin of Apophis on 13 April 2029, from published spin states",
        run: flyby::run,
    },
    Experiment {
        name: "audit",
        question: "whether an audit finds the convention of a trajectory, its mistakes, and whether it is right",
        run: audit::run,
    },
    Experiment {
        name: "advice",
        question: "whether the method and step that are advised keep the error that is stated, under every kind of force",
        run: advice::run,
    },
    Experiment {
        name: "strapdown",
        question: "how far attitudes from measured rates are off, by rule, noise and rate of samples, and whether their budgets hold",
        run: strapdown::run,
    },
];
