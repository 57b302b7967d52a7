//! What kind of motion it is.

/// Readings of the motion of a gyrostat, in the solver frame: energies are divided by the scale of the body.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GyrostatCharacter {
    /// After which m is where it was in the body, s; `None` where it stays there.
    pub(crate) period: Option<f64>,
    /// By how much the body has turned about L after that, rad, less whole turns.
    pub(crate) turn_per_period: Option<f64>,
    /// ½ Σ (m_k − h_k)²/I_k.
    pub(crate) energy: f64,
    /// Energies of the unstable steady spins with the same |m|, rising: m of these energies runs on a separatrix, and between them
    /// it stays on one side. At most two.
    pub(crate) separatrix_energies: Vec<f64>,
}
