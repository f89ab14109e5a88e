//! The whole loop: the approach, the first touch, loading to a turn and back until the bodies are apart, with rings of contact.
//!
//! Stable states are followed by arc length in all edges and the control. Three things can happen along them: the
//! control has a limit point and edges run; a crest outside touches and a new contact runs; the turn is reached. Jumps
//! happen at held control ([`jump`]). Each loses the drop of the potential and, computed independently,
//! ```text
//! −∫ Σ 2πe_i (G_i − γ) dα_i  between the edges before and after,     Π(last) = Σ ∫ (dΠ/dc) dc − Σ losses,  dΠ/dc = P, −δ (dead load)
//! ```
//!
//! Contacts that merged on loading stay merged on unloading: for γ > 0 an interior bears any tension in the limit of
//! Johnson, Kendall and Roberts. This memory is what makes the loop.
//!
//! | file | what lives there |
//! |---|---|
//! | [`balance`] | equilibrium of given contacts at a control value, stability |
//! | [`point`] | points of the equilibria, places beside them |
//! | [`stepped`] | steps along the equilibria, past corners, to what ends them |
//! | [`jump`] | where edges land when they run at held control |
//! | [`event`] | events and states |
//! | [`error`] | why there is none, and what is to be known about one, in words |
//! | [`setting`] | what a path is asked for, and what it answers |
//! | `record` | what has happened so far |
//! | [`lane`] | the equilibria of one disc, exactly |
//! | `one_disc` | a path on those equilibria |
//! | [`course`] | the loop |
//! | `unload` | the way down from a disc |
//! | `follow` | the stable stretches between events |
//! | `area` | losses, computed a second time |
//! | `zones` | the equilibria of adhesion with a range |
//! | [`zone`] | paths along them |
//! | `zero` | the loop without adhesion |

mod area;
pub mod balance;
pub mod course;
pub mod error;
pub mod event;
mod follow;
pub mod jump;
pub mod lane;
mod one_disc;
pub mod point;
mod record;
pub mod setting;
pub mod stepped;
mod unload;
mod zero;
pub mod zone;
mod zones;

pub use super::energy::Losses;
pub use balance::{Balance, HeldEdges, NotFound};
pub use course::{cycle, cycle_on};
pub use error::{PathError, Warning};
pub use event::{Direction, Event, EventKind, Passed, PassedKind, PathState};
pub use follow::LONGEST;
pub use jump::{EVEN, Mobility};
pub use lane::Lane;
pub use point::{GROWTH, PathPoint, PathStep};
pub use setting::{AskedState, DeadBand, Path, PathSetting, PathStop, Totals, TurnReached, WhyNot};
pub use stepped::{SingularSide, TakenStep};
pub use unload::unload;
pub use zone::{ZoneStartError, cycle_in_zone, start_in_zone, unload_in_zone};
pub use zones::Zones;
pub(super) use zones::place_of;
