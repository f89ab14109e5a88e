//! Fitting a problem to a measured curve: values, standard errors, and what cannot be told apart.
//!
//! | file | what lives there |
//! |---|---|
//! | [`least_squares`] | Levenberg and Marquardt with Huber's loss |
//! | [`way`] | the ways of a device along a curve with snaps |
//! | [`mover`] | what moves a path by a closed form |
//! | `track` | what the arcs of a path run along: equilibria over the contact radius or over the edge of a zone |
//! | [`path`] | the curve that points lie on: equilibria and jumps |
//! | [`distance`] | the signed distance of a point from it |
//! | `pulled` | the path of a pull at a rate |
//! | [`prior`] | what is known of values beforehand, as terms of least squares |
//! | [`problem`] | parameters, data, the paths of values |
//! | [`derivatives`] | residuals and their derivatives |
//! | `rings` | loading with rings of contact, which is left out |
//! | [`options`] | what is asked for, what can be free, why there is no fit |
//! | [`pose`] | points and parameters of the requested fit |
//! | `rates` | the rate at which the points of a retraction are pulled |
//! | `approached` | rows of a retraction in which the edge still closes |
//! | [`start`] | where a fit starts |
//! | `aligned` | where rows that end in contact may lie along a path with snaps |
//! | [`solve`] | one fit with its own scale of the noise |
//! | [`determined`] | covariance, condition, the direction in words |
//! | `degrees` | how well the errors are known |
//! | [`intervals`] | profile intervals and the block bootstrap |
//! | [`scatter`] | the noise of the rows as neighbours show it |
//! | `spread` | how that noise varies with the slope of the curve |
//! | [`chance`] | how likely a statistic is by chance |
//! | [`judge`] | what speaks against the fit: means along the path, rows apart, ranges, the device's stiffness |
//! | [`uncertain`] | values that are given with an error |
//! | [`verdict`] | what it comes to, in one word, and why |
//! | [`rows`] | what a fit makes of the rows of a file, counted |
//! | [`reach`] | how far a path goes, and how its states are seen |
//! | [`residuals`] | the points compared with a curve |
//! | `settled` | the last fit, with the noise that it shows |
//! | `bias` | the bias of distances where the curve bends within the noise |
//! | `folds` | what rows beside a fold of the curve tell |
//! | `shown` | noise of x that was not assumed, and noise of the force that grows with it |
//! | `laid` | the preset that a fit leaves |
//! | `run` | all of it, in order |
//! | [`outcome`] | what it comes to |
//! | [`models`] | several models side by side |
//! | [`together`] | one law for several curves, and whether they follow it |
//! | `directed` | the whole fit, in the direction in which the columns run |
//!
//! Distances are measured to the curve itself and not along one axis: a residual P − P(x) jumps when the values change
//! so that the pull-off passes a point, and its intervals then hold the truth in 8 % of trials.

mod aligned;
mod approached;
mod bias;
pub mod chance;
mod degrees;
pub mod derivatives;
pub mod determined;
mod directed;
pub mod distance;
pub mod fitted;
mod folds;
pub mod intervals;
pub mod judge;
mod laid;
pub mod least_squares;
pub mod models;
pub mod mover;
pub mod options;
pub mod outcome;
pub mod path;
pub mod pose;
pub mod prior;
pub mod problem;
mod pulled;
mod rates;
pub mod reach;
pub mod residuals;
mod rings;
pub mod rows;
mod run;
pub mod scatter;
mod settled;
mod shown;
pub mod solve;
mod spread;
pub mod start;
pub mod together;
pub mod track;
pub mod uncertain;
pub mod verdict;
pub mod way;

pub use directed::{doubt_of_wave, fit, fit_own};
pub use fitted::Fitted;
pub use models::{AdhesionModel, Models, fit_models};
pub use options::{FitError, Options};
pub use outcome::Fit;
pub use rows::{BranchRows, Rows};
pub use together::{Together, fit_together};
pub use verdict::{Reason, Verdict};

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_of_dead_bands;
#[cfg(test)]
mod tests_of_given;
#[cfg(test)]
mod tests_of_records;
#[cfg(test)]
mod tests_of_waves;
