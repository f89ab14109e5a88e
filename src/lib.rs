//! pulloff: a terminal explorer for adhesive contact, and the engine behind it.
//!
//! Two elastic bodies stick. The force P, the approach δ and the radius s of the contact disc follow an equilibrium
//! curve with folds; on a wavy surface the contact edge jumps from wave to wave, and each jump dissipates energy.
//! The curve is computed by a variational boundary-element method (Kalker's principle with a term for adhesion),
//! after *A numerical method for axisymmetric adhesive contact based on Kalker's variational principle*.
//!
//! # The floors
//!
//! Each imports only floors below it.
//!
//! | floor | module | what lives there |
//! |---|---|---|
//! | 6 | [`cli`] | the door: command line, one file per subcommand, exit codes |
//! | 5 | `tui` | the terminal: guard, keys, layout, charts, one file per screen region (feature `tui`) |
//! | 4 | [`plot`] | figures for print, those of the paper, maps of sweeps: SVG, CSV |
//! | 4 | [`print`](mod@print) | a figure's SVG as the bytes of a file: SVG, PNG, PDF |
//! | 4 | [`config`] | the person's settings: keys of commands, looks |
//! | 4 | [`figure`] | figures of a curve, a walk and a state for any renderer: lines, marks, areas with roles |
//! | 4 | [`explorer`] | the model of a session, its commands, `update`, the history tree, the workers, the sessions kept on disk |
//! | 4 | [`report`] | the one serializable form of a trace, an unloading and a verification: JSON, CSV, table |
//! | 4 | [`verify`] | our numbers against theory: convergence, extreme values, instabilities, losses, work |
//! | 4 | [`sweep`] | one preset over many values, on all cores, into one CSV file: specs, quantities, shards |
//! | 4 | [`mend`] | which faults the person can mend, and which are failures |
//! | 3 | [`case`] | a preset made ready for the engine |
//! | 3 | [`preset`] | the TOML schema, the shipped library, the atomic store |
//! | 2 | [`quasistatic`] | controls, stability, limit points, jumps, losses, the unloading; profiles, landscapes, admissibility |
//! | 2 | [`continuation`] | generic: arc length, tangents, events, location; knows no contact |
//! | 2 | [`disc`] | one disc, exactly: the table of the gap's transform, the equilibria over all radii, the gap outside |
//! | 2 | [`ritz`] | Kalker's functional in ring elements: kernel, rings, Newton-Raphson |
//! | 2 | [`theory`] | exact solutions: Hertz, JKR, Guduru, Sneddon for any gap; the envelope of Kesari and Lew |
//! | 1 | [`units`] | dimensions, unit names, values with units read and shown |
//! | 1 | [`contact`] | the problem: E*, γ, the gap, the control; reduced units, dimensionless groups |
//! | 0 | `fault` | panics on demand, in test builds only (feature `fault-injection`) |
//! | 0 | [`expression`] | the one grammar of gap formulas and of values |
//!
//! # Where the equations are
//!
//! | equation of the paper | module |
//! |---|---|
//! | (1), (2) functional, (16) its discretization, (19) stationarity | [`ritz::functional`], [`ritz::newton`] |
//! | (10), (17) coefficients B | [`ritz::kernel`], [`ritz::rings`] |
//! | (11), (18) coefficients W, (13)-(15) the scaled mesh | [`ritz::rings`] |
//! | one disc of any gap, exactly | [`disc::table`], [`disc::solution`], [`disc::outside`] |
//! | (20), (23) gaps; further ones, each in its file | [`contact::shape`], [`contact::shapes`] |
//! | (21) Hertz, (22) JKR | [`theory::hertz`], [`theory::jkr`] |
//! | the exact solution for (23) and any other gap | [`theory::guduru`], [`theory::sneddon`], [`theory::disc`], [`theory::unloading`] |
//! | the same for spheres, power laws, sums of waves | [`theory::sphere`], [`theory::power_law`], [`theory::harmonics`] |
//! | spherical arc length | [`continuation::corrector`], [`continuation::step`] |
//! | Fig. 10, jumps and dissipation | [`quasistatic::jump`], [`quasistatic::energy`] |
//!
//! # The engine from code
//!
//! ```
//! use pulloff::case::Case;
//! use pulloff::preset::{read, shipped};
//!
//! let preset = read("wavy-sphere", shipped::find("wavy-sphere").expect("shipped").text)?;
//! let case = Case::new(&preset)?;
//! let curve = case.curve(|| true)?;
//! let unloading = case.unload(&curve, case.control)?;
//! assert_eq!(unloading.events.len(), 6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod case;
pub mod cli;
pub mod config;
pub mod contact;
pub mod continuation;
pub mod disc;
pub mod explorer;
pub mod expression;
mod fault;
pub mod figure;
pub mod mend;
pub mod plot;
pub mod preset;
pub mod print;
pub mod quasistatic;
pub mod report;
pub mod ritz;
pub mod sweep;
pub mod theory;
#[cfg(feature = "tui")]
pub mod tui;
pub mod units;
pub mod verify;
