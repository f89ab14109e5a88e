//! The settings of the integrator.

/// How a pull is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PullSettings {
    /// The error of a step as a share of the contact radius: 1e-12 to 1e-3.
    pub tolerance: f64,
    /// Newton's method ends when its change is this share of the tolerance: the next change would be of the order of
    /// the square.
    pub converged: f64,
    /// The most Newton iterations of a step.
    pub newton: usize,
    /// The edge goes at most this share of a wave in a step: longer steps can land beyond a snap.
    pub of_wave: f64,
    /// The same as a share of a panel of the table, for gaps without waves.
    pub of_panel: f64,
    /// The edge goes at most this share of its distance from a limit point.
    pub of_distance: f64,
    /// But it may always go this share of the way within which the speed rounds off the limit point.
    pub of_rounding: f64,
    /// The edge goes at most this share of the way to the axis: what is dissipated there grows as a power of 1/s,
    /// which a step must resolve.
    pub of_rest: f64,
    /// The edge is gone at this share of the radius at which its stretch began.
    pub gone: f64,
    /// The most steps of a stretch, with the rejected ones.
    pub steps: usize,
    /// Whether the derivatives of the moments with respect to the values are found too, for a pull that is one ramp to
    /// the last contact.
    pub derivatives: bool,
}

impl Default for PullSettings {
    /// As measured on the wavy sphere: 200 to 600 steps a pull.
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            converged: 1e-3,
            newton: 12,
            of_wave: 0.05,
            of_panel: 0.2,
            of_distance: 0.4,
            of_rounding: 0.5,
            of_rest: 0.25,
            gone: 1e-6,
            steps: 200_000,
            derivatives: false,
        }
    }
}
