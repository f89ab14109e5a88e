//! The exact solution of a problem: the closed form where there is one, quadrature otherwise.

use super::disc::Disc;
use super::guduru::Guduru;
use super::harmonics::HarmonicDisc;
use super::jkr::Jkr;
use super::power_law::PowerLawDisc;
use super::sneddon::Sneddon;
use super::sphere::Sphere;
use crate::gap::{Gap, Shape};
use crate::gap::{shapes::ExactSphere, shapes::Harmonics, shapes::PowerLaw};
use crate::problem::Problem;
use std::ops::Deref;
use std::sync::Arc;

/// The exact solution of one problem, used as a [`Disc`].
///
/// ```
/// use pulloff_engine::gap::Shape;
/// use pulloff_engine::problem::Problem;
/// use pulloff_engine::theory::Exact;
///
/// let shape = Shape::Sphere { radius_of_curvature: 2.0 };
/// let exact = Exact::of(&Problem { effective_modulus: 3.0, work_of_adhesion: 0.0, shape });
/// assert_eq!((exact.name(), exact.approach(0.5)), ("Hertz 1881", 0.125));
/// ```
#[derive(Debug, Clone)]
pub struct Exact(Arc<dyn Disc>);

impl Exact {
    /// The solution of `problem`, in its units: in closed form if the shape has one, by quadrature for a formula and a
    /// profile.
    pub fn of(problem: &Problem) -> Self {
        let Problem { effective_modulus, work_of_adhesion, ref shape } = *problem;
        Self(match *shape {
            Shape::Sphere { radius_of_curvature } => {
                Arc::new(Jkr { effective_modulus, work_of_adhesion, radius_of_curvature })
            }
            Shape::WavySphere { radius_of_curvature, amplitude, wavelength } => Arc::new(Guduru {
                effective_modulus,
                work_of_adhesion,
                radius_of_curvature,
                amplitude,
                wavelength,
            }),
            Shape::ExactSphere(ExactSphere { radius }) => {
                Arc::new(Sphere { effective_modulus, work_of_adhesion, radius })
            }
            Shape::Cone { slope } => {
                Arc::new(PowerLawDisc::new(effective_modulus, work_of_adhesion, &PowerLaw::cone(slope)))
            }
            Shape::PowerLaw(ref law) => Arc::new(PowerLawDisc::new(effective_modulus, work_of_adhesion, law)),
            Shape::Harmonics(ref waves) | Shape::RandomWaves { drawn: ref waves, .. } => {
                Arc::new(HarmonicDisc { effective_modulus, work_of_adhesion, gap: Harmonics::clone(waves) })
            }
            Shape::Formula(_) | Shape::Profile(_) => {
                let gap = Arc::new(shape.clone());
                Arc::new(Sneddon { effective_modulus, work_of_adhesion, gap })
            }
        })
    }

    /// The solution for a gap that has no closed form, by quadrature.
    pub fn by_quadrature(effective_modulus: f64, work_of_adhesion: f64, gap: Arc<dyn Gap>) -> Self {
        Self(Arc::new(Sneddon { effective_modulus, work_of_adhesion, gap }))
    }
}

impl Deref for Exact {
    type Target = dyn Disc;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}
