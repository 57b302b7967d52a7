//! The command line as its users meet it: golden outputs, golden refusals, and files that are whole or absent.
//!
//! `POLHODE_BLESS=1 cargo test -p polhode-cli --test cli` rewrites the golden files; read the difference.

#![allow(clippy::unwrap_used)]
#![allow(clippy::disallowed_methods, reason = "tests look at files that a command has written")]

mod advise;
mod attitude;
mod audit;
mod compare;
mod compose;
mod costs;
mod documents;
mod ensemble;
mod events;
mod experiment;
mod fit;
mod fit_attitudes;
mod fit_carrier;
mod fit_inputs;
mod fit_report;
mod flights;
mod forces;
mod general;
mod harness;
mod heard;
mod hostile;
mod inertia;
#[cfg(unix)]
mod inputs;
#[cfg(unix)]
mod interrupted;
mod logs;
mod methods;
mod motion;
mod pages;
mod plot;
mod programs;
mod propagate;
mod report;
mod robots;
#[cfg(unix)]
mod scarce;
mod show;
mod tables;
mod through;
mod times;
mod wheels;
