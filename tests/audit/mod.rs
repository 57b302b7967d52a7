//! Records of known motions in random conventions, and records of programs with a mistake: what is found is what was written.

mod causes;
mod conventions;
mod every_row;
mod figures;
mod hidden;
mod mistakes;
mod records;
mod ties;
mod units;
