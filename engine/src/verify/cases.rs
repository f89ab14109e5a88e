//! The problems that are verified, E* = R = 1.

use crate::gap::Shape;
use crate::problem::{Control, Problem};
use crate::theory::jkr::Jkr;
use std::f64::consts::TAU;

/// A figure of the paper: a wavy sphere, and the way it is unloaded.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperFigure {
    /// Its name in the paper.
    pub name: &'static str,
    /// The problem.
    pub problem: Problem,
    /// The contact radius at which its paths start.
    pub start: f64,
    /// The stiffness of a device between the two extremes; it is below the steepest slope of the curve.
    pub stiffness: f64,
}

/// γ of γ' = 2πγ/(E*R).
fn work_of_adhesion(group: f64) -> f64 {
    group / TAU
}

/// Fig. 8: A = 0.001 R, λ = 0.1 R, γ' = 0.05; nearly smooth.
pub fn fig_8() -> PaperFigure {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.001, wavelength: 0.1 };
    let problem = Problem { effective_modulus: 1.0, work_of_adhesion: work_of_adhesion(0.05), shape };
    PaperFigure { name: "Fig. 8", problem, start: 0.5, stiffness: 0.18 }
}

/// Fig. 9: A = 0.0025 R, λ = 0.05 R, γ' = 0.025; the edge snaps from crest to crest.
pub fn fig_9() -> PaperFigure {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 };
    let problem = Problem { effective_modulus: 1.0, work_of_adhesion: work_of_adhesion(0.025), shape };
    PaperFigure { name: "Fig. 9", problem, start: 0.5, stiffness: 0.15 }
}

/// The smooth sphere.
pub fn sphere(work_of_adhesion: f64) -> Problem {
    let shape = Shape::Sphere { radius_of_curvature: 1.0 };
    Problem { effective_modulus: 1.0, work_of_adhesion, shape }
}

/// The smooth sphere in closed form.
pub fn smooth(work_of_adhesion: f64) -> Jkr {
    Jkr { effective_modulus: 1.0, work_of_adhesion, radius_of_curvature: 1.0 }
}

impl PaperFigure {
    /// The three controls: fixed grips, dead load, a spring.
    pub fn controls(&self) -> [Control; 3] {
        [Control::Displacement, Control::Force, Control::Stiffness(self.stiffness)]
    }
}
