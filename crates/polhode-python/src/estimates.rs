//! Fitted tensors.

use nalgebra::SMatrix;
use polhode_files::ReadAs;
use polhode_fit::{self as fits, Nuisance};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Column, Table, row};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{array, matrix};
use crate::parts;
use crate::shown;

/// A fitted tensor with its uncertainty. Moments are shares of the trace, as free motion does not determine the size of the tensor.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Estimate {
    pub(crate) found: fits::Estimate,
    pub(crate) flights: Vec<fits::Flight>,
    /// Names of columns.
    pub(crate) unused: Vec<String>,
    pub(crate) read_as: Vec<ReadAs>,
    pub(crate) warnings: Vec<String>,
}

pub(crate) fn six<'py>(py: Python<'py>, m: &SMatrix<f64, 6, 6>) -> PyResult<Bound<'py, PyAny>> {
    array(py, m.transpose().as_slice().to_vec(), &[6, 6])
}

pub(crate) fn named<'py>(py: Python<'py>, all: &[Nuisance]) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for one in all {
        let entry = PyDict::new(py);
        entry.set_item("value", one.value)?;
        entry.set_item("sigma", one.sigma)?;
        entry.set_item("unit", one.unit)?;
        entry.set_item("prior", one.prior)?;
        found.set_item(one.name, entry)?;
    }
    Ok(found)
}

#[pymethods]
impl Estimate {
    /// The tensor with trace 1, sensor axes.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        matrix(py, &self.found.shape.tensor())
    }

    /// Principal moments, ascending, as shares of the trace.
    #[getter]
    fn principal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.principal.to_vec(), &[3])
    }

    /// Standard deviations of the principal moments that the noise causes, as shares of the trace.
    #[getter]
    fn sigma_principal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.sigma_principal.to_vec(), &[3])
    }

    /// The rotation from principal axes to those of the sensor, w, x, y, z.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let q = self.found.axes.quaternion();
        array(py, vec![q.w, q.i, q.j, q.k], &[4])
    }

    /// Standard deviations of the rotation about each principal axis, rad; infinite where two moments are equal.
    #[getter]
    fn sigma_axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.sigma_axes.to_vec(), &[3])
    }

    /// The ratios I1/I3 and I2/I3.
    #[getter]
    fn ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.ratios.to_vec(), &[2])
    }

    /// Standard deviations of the ratios.
    #[getter]
    fn sigma_ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.sigma_ratios.to_vec(), &[2])
    }

    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the shape.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        six(py, &self.found.covariance)
    }

    /// The Cramer-Rao bound on this covariance; `None` where it is not computed.
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.bound.as_ref().map(|bound| six(py, bound)).transpose()
    }

    /// The tensor in kg m^2, sensor axes; `None` if nothing gives its size.
    #[getter]
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.inertia.as_ref().map(|inertia| matrix(py, &inertia.tensor())).transpose()
    }

    /// Covariance of the entries xx, yy, zz, xy, xz, yz of `inertia`, (kg m^2)^2.
    #[getter]
    fn inertia_covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.inertia_covariance.as_ref().map(|covariance| six(py, covariance)).transpose()
    }

    /// Noise of one component of the rates, rad/s.
    #[getter]
    fn noise_sigma(&self) -> f64 {
        self.found.noise_sigma
    }

    /// Chi squared of the residuals per degree of freedom.
    #[getter]
    fn chi2_per_dof(&self) -> f64 {
        self.found.chi2_per_dof
    }

    /// I1 + I2 - I3 as a share of the trace.
    #[getter]
    fn triangle_slack(&self) -> f64 {
        self.found.triangle_slack
    }

    /// Number of samples that were fitted, in segments that are long enough.
    #[getter]
    fn samples(&self) -> usize {
        self.found.samples
    }

    /// Number of segments that were fitted.
    #[getter]
    fn segments(&self) -> usize {
        self.found.segments
    }

    /// Half width of the test functions of the weak form, s; `None` for a fit by maximum likelihood.
    #[getter]
    fn radius(&self) -> Option<f64> {
        self.found.radius
    }

    /// Whether everything but the scale is determined.
    #[getter]
    fn identifiable(&self) -> bool {
        self.found.identifiability.complete()
    }

    /// What the record leaves undetermined, in words.
    #[getter]
    fn null_directions(&self) -> Vec<String> {
        self.found.identifiability.null_directions.iter().map(ToString::to_string).collect()
    }

    /// Share of the squared angular acceleration that free motion of this body leaves unexplained.
    #[getter]
    fn unexplained(&self) -> Option<f64> {
        self.found.unexplained
    }

    /// The tensor with trace 1 that explains the record equally well if the axes of the sensor are left-handed.
    #[getter]
    fn mirror<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.mirror.as_ref().map(|mirror| matrix(py, &mirror.tensor())).transpose()
    }

    /// Standard deviations of the principal moments of `mirror`, ascending.
    #[getter]
    fn sigma_mirror<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.sigma_mirror.map(|sigmas| array(py, sigmas.to_vec(), &[3])).transpose()
    }

    /// How large a change of each principal moment midway may go unseen in this record, as a share of the trace; `None` if its parts are not
    /// compared.
    #[getter]
    fn unseen_change<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.unseen_change.map(|most| array(py, most.to_vec(), &[3])).transpose()
    }

    /// The fitted torque: a dict by coefficient, each with `value`, `sigma`, `unit`, `prior`.
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named(py, &self.found.torque.coefficients)
    }

    /// How well each model of the torque explains the record: a dict by model.
    ///
    /// Each has `gain` (log-likelihood less that without a torque), `torque_noise` (whether the model has a level of torque noise), `share` (its
    /// Akaike weight), `principal`, `sigma_principal`, `ratios`, `sigma_ratios`, `unexplained`, and `held_out` (how well it predicts a segment
    /// from the others). A fit of attitudes in closed form compares no torque, drag and a small constant torque.
    #[getter]
    fn models<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for one in &self.found.models {
            let entry = PyDict::new(py);
            entry.set_item("gain", one.gain)?;
            entry.set_item("torque_noise", one.has_torque_noise)?;
            entry.set_item("share", one.share)?;
            entry.set_item("principal", array(py, one.principal.to_vec(), &[3])?)?;
            entry.set_item("sigma_principal", array(py, one.sigma_principal.to_vec(), &[3])?)?;
            entry.set_item("ratios", array(py, one.ratios.to_vec(), &[2])?)?;
            entry.set_item("sigma_ratios", array(py, one.sigma_ratios.to_vec(), &[2])?)?;
            entry.set_item("unexplained", one.unexplained)?;
            entry.set_item("held_out", one.held_out)?;
            found.set_item(one.model.to_string(), entry)?;
        }
        Ok(found)
    }

    /// How well errors of the sensor, or of the momentum of wheels, explain the record without a torque: a dict by error (`misalignment`,
    /// `axis-scales`, `offsets`, `delays`, `wheel-x`, `wheel-y`, `wheel-z`).
    ///
    /// Each has its `size` (rad, a ratio, rad/s or s), and `gain`, `torque_noise`, `share`, `principal`, `sigma_principal` and `held_out` as in
    /// `models`. Empty for a fit of attitudes.
    #[getter]
    fn reading_errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for one in &self.found.reading_errors {
            let entry = PyDict::new(py);
            entry.set_item("size", one.size)?;
            entry.set_item("gain", one.gain)?;
            entry.set_item("torque_noise", one.has_torque_noise)?;
            entry.set_item("share", one.share)?;
            entry.set_item("principal", array(py, one.principal.to_vec(), &[3])?)?;
            entry.set_item("sigma_principal", array(py, one.sigma_principal.to_vec(), &[3])?)?;
            entry.set_item("held_out", one.held_out)?;
            found.set_item(one.error.to_string(), entry)?;
        }
        Ok(found)
    }

    /// The estimated errors of the sensor: a dict by error, each with `value`, `sigma`, `unit`, `prior`.
    #[getter]
    fn nuisances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named(py, &self.found.nuisances)
    }

    /// By how much errors of an uncalibrated sensor would move the moments: a dict by error, each with `size`, `unit`, `principal`, `ratios`.
    #[getter]
    fn systematic<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for line in &self.found.systematic {
            let entry = PyDict::new(py);
            entry.set_item("size", line.size)?;
            entry.set_item("unit", line.unit)?;
            entry.set_item("principal", array(py, line.principal.to_vec(), &[3])?)?;
            entry.set_item("ratios", array(py, line.ratios.to_vec(), &[2])?)?;
            found.set_item(line.name, entry)?;
        }
        Ok(found)
    }

    /// For a fit of attitudes, what was found about them; else `None`.
    ///
    /// A dict of `noise_sigma`, `residual` and `local_noise` (of each component of the rotation vector, rad), `noise_given`, `largest_turn`, rad,
    /// `left_out` and `repeated` (numbers of samples). With rates beside the attitudes: `alignment`, the rotation vector from the axes of the
    /// attitudes to those of the rates, rad, with `alignment_sigma`; and `moving`, by how much the two sets of axes turn against each other, rad,
    /// with `moving_gain`, the gain of log-likelihood.
    #[getter]
    fn attitudes<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.found.attitudes.as_ref().map(|of| parts::attitudes(py, of)).transpose()
    }

    /// Root mean square of the size of the angular velocity, rad/s.
    #[getter]
    fn rms_rate(&self) -> f64 {
        self.found.rms_rate
    }

    /// Step of the digital readings of each axis, rad/s; 0 if there is none.
    #[getter]
    fn quanta<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.quanta.to_vec(), &[3])
    }

    /// How the tensor was found, in words.
    #[getter]
    fn method(&self) -> &'static str {
        self.found.method.words()
    }

    /// How many of the five numbers of the tensor with trace 1 the record determines.
    #[getter]
    fn rank(&self) -> usize {
        self.found.identifiability.rank
    }

    /// Standard deviations of the five independent combinations of its entries, ascending, as shares of the trace.
    #[getter]
    fn spectrum<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.identifiability.deviations.to_vec(), &[5])
    }

    /// Ratio of the standard deviations to the Cramer-Rao bound; `None` where the bound is not computed.
    #[getter]
    fn bound_ratio(&self) -> Option<f64> {
        self.found.bound_ratio
    }

    /// Constraints that the answer lies on: a dict of `name` and `multiplier` for each.
    #[getter]
    fn active_constraints<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |of: &fits::ActiveConstraint| {
            let entry = PyDict::new(py);
            entry.set_item("name", of.constraint.to_string())?;
            entry.set_item("multiplier", of.multiplier)?;
            Ok(entry)
        };
        self.found.active_constraints.iter().map(one).collect()
    }

    /// Residuals of the conditions of optimality: a dict of `stationarity`, `violation`, `dual_violation` and `rounds`.
    #[getter]
    fn certificate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (of, entry) = (&self.found.certificate, PyDict::new(py));
        entry.set_item("stationarity", of.stationarity)?;
        entry.set_item("violation", of.violation)?;
        entry.set_item("dual_violation", of.dual_violation)?;
        entry.set_item("rounds", of.rounds)?;
        Ok(entry)
    }

    /// By how many standard deviations the triangle inequalities and given limits moved the tensor.
    #[getter]
    fn pull(&self) -> f64 {
        self.found.pull
    }

    /// Degrees of freedom: equations beyond the unknowns.
    #[getter]
    fn dof(&self) -> usize {
        self.found.dof
    }

    /// Relative drift of |J w| and its standard deviation, 1/s; J is the tensor and w the angular velocity.
    #[getter]
    fn momentum_drift(&self) -> Option<(f64, f64)> {
        self.found.momentum_trend.map(|trend| (trend.rate, trend.sigma))
    }

    /// Relative drift of the energy and its standard deviation, 1/s.
    #[getter]
    fn energy_drift(&self) -> Option<(f64, f64)> {
        self.found.energy_trend.map(|trend| (trend.rate, trend.sigma))
    }

    /// Correlation of neighbouring residuals, and its standard deviation under white noise.
    #[getter]
    fn whiteness(&self) -> (f64, f64) {
        (self.found.whiteness.correlation, self.found.whiteness.sigma)
    }

    /// The model of the torque that was fitted.
    #[getter]
    fn torque_model(&self) -> String {
        self.found.torque.model.to_string()
    }

    /// Its gain of log-likelihood over no torque; `None` unless both were fitted.
    #[getter]
    fn torque_gain(&self) -> Option<f64> {
        self.found.torque.gain
    }

    /// I1/I3 and I2/I3 as they would be without the torque.
    #[getter]
    fn ratios_without<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.torque.ratios_without.map(|ratios| array(py, ratios.to_vec(), &[2])).transpose()
    }

    /// Distance between record and prior tensor: chi squared, and its degrees of freedom; `None` without a prior.
    #[getter]
    fn prior(&self) -> Option<(f64, usize)> {
        self.found.prior.map(|of| (of.chi2, of.dof))
    }

    /// Power spectral density of the angular acceleration that torque noise causes, (rad/s^2)^2 s: mean of the three components, and of the
    /// segments by their weights.
    #[getter]
    fn rho(&self) -> f64 {
        self.found.per_segment.iter().map(|s| s.torque_noise * s.weight).sum()
    }

    /// What each segment contributes: a dict for each.
    ///
    /// It has `segment`, counted from 1, `samples`, `noise_sigma`, rad/s, `torque_noise`, (rad/s^2)^2 s, and `weight`, its share of the
    /// information. The answer without this segment has the ratios `ratios_without`, I1/I3 and I2/I3, with `sigma_ratios_without`, and differs
    /// from that of all segments by `shift` standard deviations.
    #[getter]
    fn per_segment<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        parts::per_segment(py, &self.found)
    }

    /// Samples that were left out because they jump off their neighbours: a dict for each, of `segment`, counted from 1, `line` and `time`, s.
    #[getter]
    fn spikes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        parts::spikes(py, &self.found.spikes)
    }

    /// Correlations of the entries xx, yy, zz, xy, xz, yz of the shape.
    #[getter]
    fn correlation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        six(py, &self.found.correlation())
    }

    /// What to do next: sentences, that on the largest error first.
    #[getter]
    fn next_steps(&self) -> Vec<String> {
        self.found.next_steps().iter().map(ToString::to_string).collect()
    }

    /// Names of the columns of the record that were not read.
    #[getter]
    fn unused_columns(&self) -> Vec<String> {
        self.unused.clone()
    }

    /// In which units the files of the record were read, as `Record.read_as`; empty for arrays, which are in rad/s and s.
    #[getter]
    fn read_as<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        parts::read_as(py, &self.read_as)
    }

    /// Why each flight begins and ends where it does.
    #[getter]
    fn flight_limits(&self) -> Vec<(String, String)> {
        self.flights.iter().map(|flight| (flight.before.to_string(), flight.after.to_string())).collect()
    }

    /// Start and end of each flight that was fitted, s; empty if windows were given.
    #[getter]
    fn flights(&self) -> Vec<(f64, f64)> {
        self.flights.iter().map(|flight| (flight.start, flight.end)).collect()
    }

    /// What limits the use of the estimate: sentences, which are also Python warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn __repr__(&self) -> String {
        let columns = vec![
            Column::new("quantity", "", ""),
            Column::new("value", "", "").digits(7),
            Column::new("sigma", "", "").digits(2),
            Column::new("unit", "", ""),
        ];
        let mut table = Table::new("fit", "Inertia from measured angular velocity.", columns);
        for (k, name) in ["I1 / trace", "I2 / trace", "I3 / trace"].into_iter().enumerate() {
            table.push(row![name, self.found.principal[k], self.found.sigma_principal[k], ""]);
        }
        table.push(row!["I1 / I3", self.found.ratios[0], self.found.sigma_ratios[0], ""]);
        table.push(row!["I2 / I3", self.found.ratios[1], self.found.sigma_ratios[1], ""]);
        for one in self.found.torque.coefficients.iter().chain(&self.found.nuisances) {
            table.push(row![one.name, one.value, one.sigma, one.unit]);
        }
        let mut text = table.terminal();
        for warning in &self.warnings {
            text += &format!("warning: {warning}\n");
        }
        text.trim_end().into()
    }

    /// The numbers with a figure of the residuals.
    fn _repr_html_(&self) -> String {
        let title = "Residuals of the fit";
        let axes = (("time (s)", Scale::Linear), ("standard deviations", Scale::Linear));
        let mut figure = Figure::new("residuals", title, axes.0, axes.1).scatter();
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            let of = |segment: &fits::Residuals| {
                segment
                    .times
                    .iter()
                    .copied()
                    .zip(segment.values.iter().map(move |values| values[k]))
                    .collect::<Vec<_>>()
            };
            figure.series.push(Curve::new(name, self.found.residuals.iter().flat_map(of).collect()).dots());
        }
        shown::page(&self.__repr__(), &figure.svg())
    }
}
