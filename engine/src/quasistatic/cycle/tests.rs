use super::*;
use crate::annuli::Ground;
use crate::contact::Control;
use crate::ritz::examples::wavy;

pub fn run(gamma: f64, control: Control, turn: Turn, areas: Areas) -> Cycle {
    let ground = Ground::of(wavy(gamma).gap, 0.7).unwrap();
    let setting = Setting { control, turn, areas, mobility: EVEN };
    cycle(&ground, gamma, &setting, &|_| true).unwrap()
}

#[test]
fn look() {
    for gamma in [0.025 / std::f64::consts::TAU, 1e-4] {
        let start = std::time::Instant::now();
        let found = run(gamma, Control::Displacement, Turn::Control(0.14), Areas::Yes);
        for event in &found.events {
            println!(
                "{:12} {:.11} {:?} {:?} -> {:?} {:.8e}",
                event.kind.name(),
                event.control_value,
                event.radius,
                event.before.as_ref().map(|s| (s.force, s.contacts.clone())),
                event.after.as_ref().map(|s| (s.force, s.contacts.clone())),
                event.dissipated.unwrap_or(f64::NAN)
            );
        }
        println!("{:?} {:?} {}", found.totals, start.elapsed(), found.states.len());
    }
}
