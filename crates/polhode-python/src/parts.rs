//! Parts of a fitted tensor as dicts, with the keys of the JSON of `polhode fit`.

use polhode::record::Spike;
use polhode_files::ReadAs;
use polhode_fit::{AttitudeFit, Estimate, SegmentSummary};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;

/// Units of the files that were read.
pub(crate) fn read_as<'py>(py: Python<'py>, files: &[ReadAs]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let file = |of: &ReadAs| {
        let entry = PyDict::new(py);
        entry.set_item("file", &of.file)?;
        entry.set_item("rate_unit", of.rates.map(|(unit, _)| unit.to_string()))?;
        entry.set_item("rate_unit_by", of.rates.map(|(_, by)| by.name()))?;
        entry.set_item("time_unit", &of.times.0)?;
        entry.set_item("time_unit_by", of.times.1.name())?;
        entry.set_item("sample_rate", of.sample_rate)?;
        entry.set_item("axes", of.axes.map(|axes| axes.to_string()))?;
        entry.set_item("taken_as_right_handed", of.rates.is_some())?;
        Ok(entry)
    };
    files.iter().map(file).collect()
}

/// What each segment contributes, and the answer without it.
pub(crate) fn per_segment<'py>(py: Python<'py>, e: &Estimate) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let one = |s: &SegmentSummary| {
        let entry = PyDict::new(py);
        entry.set_item("segment", s.segment + 1)?;
        entry.set_item("samples", s.samples)?;
        entry.set_item("noise_sigma", s.noise_sigma)?;
        entry.set_item("torque_noise", s.torque_noise)?;
        entry.set_item("weight", s.weight)?;
        entry.set_item("shift", s.without.map(|w| w.shift))?;
        let ratios = |of: Option<[f64; 2]>| of.map(|of| array(py, of.to_vec(), &[2])).transpose();
        entry.set_item("ratios_without", ratios(s.without.map(|w| w.ratios))?)?;
        entry.set_item("sigma_ratios_without", ratios(s.without.map(|w| w.sigma_ratios))?)?;
        Ok(entry)
    };
    e.per_segment.iter().map(one).collect()
}

/// The samples that were left out because they stand out of their neighbours.
pub(crate) fn spikes<'py>(py: Python<'py>, spikes: &[Spike]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let one = |spike: &Spike| {
        let entry = PyDict::new(py);
        entry.set_item("segment", spike.segment + 1)?;
        entry.set_item("line", spike.line)?;
        entry.set_item("time", spike.time)?;
        Ok(entry)
    };
    spikes.iter().map(one).collect()
}

/// What was found of measured attitudes, which came as quaternions, body to space.
pub(crate) fn attitudes<'py>(py: Python<'py>, of: &AttitudeFit) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("reading", "quaternion")?;
    found.set_item("direction", "body-to-space")?;
    found.set_item("direction_stated", true)?;
    found.set_item("direction_gain", of.direction_gain.filter(|gain| gain.is_finite()))?;
    found.set_item("noise_sigma", of.noise_sigma)?;
    found.set_item("noise_given", of.noise_is_given)?;
    found.set_item("residual", of.residual)?;
    found.set_item("local_noise", of.local_noise)?;
    found.set_item("largest_turn", of.largest_turn)?;
    found.set_item("left_out", of.left_out)?;
    found.set_item("repeated", of.repeated)?;
    if let Some(alignment) = of.alignment {
        let turn = alignment.turn.scaled_axis().as_slice().to_vec();
        found.set_item("alignment", array(py, turn, &[3])?)?;
        found.set_item("alignment_sigma", array(py, alignment.sigma.to_vec(), &[3])?)?;
        found.set_item("moving", alignment.moving)?;
        found.set_item("moving_gain", alignment.moving_gain)?;
    }
    Ok(found)
}
