//! A walk along the equilibrium curve, one request at a time: steps, runs, jumps, moves.
//!
//! A [`Walk`] says where the walker stands and how it goes; each state it arrives at is handed over with how it was
//! reached. A step that would pass a limit point of the control, a touch of the next crest, or a corner of the curve
//! stops exactly there. At a touch the walk either goes on without the new contact, through states that are not
//! admissible, or lets the contact run: then there are rings, and the same steps follow all edges. All quantities are
//! reduced.
//!
//! | file | what lives there |
//! |---|---|
//! | [`walker`] | where a walker stands |
//! | [`arrival`] | what it arrives at |
//! | `disc` | steps and jumps of one disc |
//! | [`edges`] | any number of edges as a walk keeps them |
//! | `rings` | steps with rings |
//! | `land` | where edges land when they run |
//! | [`along`] | steps along a known path |

pub mod along;
pub mod arrival;
mod disc;
pub mod edges;
mod land;
mod rings;
pub mod walker;

pub use along::{Along, Passing};
pub use arrival::{Ahead, Arrival, Emit, Reached, WalkEnd, WalkFailure, Walked};
pub use walker::{At, ROOM, Walk};

use super::Event;

impl Walk<'_> {
    /// Takes `count` steps of the length asked for or, in a `run`, of the length that the curve allows; stops at a
    /// limit point of the control and where a crest touches.
    ///
    /// # Errors
    /// [`WalkFailure`] where it could not go on.
    pub fn steps(&self, count: usize, run: bool, emit: &mut Emit<'_>) -> Walked {
        if self.has_rings() { self.ring_steps(count, run, emit) } else { self.disc_steps(count, run, emit) }
    }

    /// Lets the edges run at constant control to the next stable state; from a touch, with the new contact.
    ///
    /// # Errors
    /// [`WalkFailure`] where nothing runs, or the edges do not land.
    pub fn jump(&self, emit: &mut Emit<'_>) -> Walked {
        let from = self.begun("jump")?;
        let is_touch = matches!(self.at, At::Touch(_));
        let jumped = if self.has_rings() || is_touch {
            self.try_rings()?
        } else {
            match self.runs_into_crests() {
                Some(jumped) => jumped,
                None => return self.disc_jump(emit),
            }
        };
        // What the jump passed depends on how fast edges move, so it is not kept.
        let event = jumped.event.map(|event| Box::new(Event { passed: Vec::new(), ..event }));
        let arrival = event.map_or(Arrival::Step, Arrival::Jump);
        let reached = match jumped.held {
            Some(held) => self.landed(&self.running(&jumped.ground), arrival, held)?,
            None if self.has_rings() => self
                .of_rings(&jumped.ground, arrival, from.clone())
                .ok_or(WalkFailure::NoEquilibrium("before the jump"))?,
            None => self.of_disc(arrival, from.clone()),
        };
        emit(reached);
        Ok(WalkEnd::Done)
    }
}
