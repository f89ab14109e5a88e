//! Pulls of random problems of every shape: work and energy balance, whatever the gap, the device, the law and the rate.
//!
//! To run all five hundred:
//!
//! ```text
//! cargo test --release --test engine pulls:: -- --ignored --nocapture
//! ```
//!
//! With `PULLOFF_PULLS=17..18` before that line, only those numbers run.

#![allow(clippy::float_cmp, reason = "what is exact is compared so")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::problems::draw;
use pulloff_engine::Case;
use pulloff_engine::problem::{Control, Part};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::rate::{EdgeLaw, Moment, MovingEdge, Pull, PullSettings, Puller, RateError};
use pulloff_engine::report::pull::{AskedPulls, PullReport};
use rayon::prelude::*;
use std::ops::Range;

/// The largest residual of the balance, as a share of the work.
const BALANCE: f64 = 1e-9;

/// The pull of a problem number, with its description.
struct Drawn {
    case: Case,
    edge: MovingEdge,
    control: Control,
    parts: Vec<Part>,
    words: String,
}

impl Drawn {
    fn puller(&self) -> Puller<'_> {
        Puller {
            table: &self.case.table,
            control: self.control,
            edge: self.edge,
            start: self.case.start,
            wave: self.case.reduced.gap.feature_length(),
            rise: None,
            settings: PullSettings::default(),
        }
    }
}

/// The exponents of the law from which a pull is drawn.
#[derive(Debug, Clone, Copy)]
enum Exponents {
    UpToOne,
    /// From 1 on, where the edge begins to move with a speed of no bounded slope.
    UpToTwo,
}

/// The pull of a problem number; `None` where the problem has no adhesion or no start.
fn drawn(number: u64, exponents: Exponents) -> Option<Drawn> {
    let problem = draw(number).ok()?;
    let case = Case::new(&problem.preset).ok()?;
    let gamma = case.reduced.work_of_adhesion;
    // With weaker adhesion the edge is driven by less than a millionth of the radius, and a pull needs more steps than allowed.
    if gamma < 1e-12 {
        return None;
    }
    let mut random = fastrand::Rng::with_seed(number ^ 0x5EED);
    let mut scale = |from: i32, to: i32| 10.0_f64.powf(f64::from(from) + f64::from(to - from) * random.f64());
    let (rate, stiffness) = (scale(-8, 3), scale(-6, 6));
    let (exponent, rate, stiffness) = match exponents {
        Exponents::UpToOne => (0.1 + 0.9 * random.f64(), rate, stiffness),
        // With slower pulls and softer springs the drive of the edge is lost in rounding.
        Exponents::UpToTwo => (1.0 + random.f64(), rate.max(1e-3), stiffness.max(1e-3)),
    };
    let control = [Control::Displacement, Control::Force, Control::Stiffness(stiffness)][random.usize(0..3)];
    let closing = if random.bool() { gamma } else { gamma * (0.2 + 0.8 * random.f64()) };
    let edge = MovingEdge { law: EdgeLaw::symmetric(exponent), opening: gamma, closing };
    let mut parts = vec![Part::Apart { rate }];
    if random.f64() < 0.25 {
        let held = case.basis.equilibrium(&case.reduced, case.start)?;
        let c = control.value(held.approach, held.force);
        let to = c + 0.1 * c.abs();
        parts = vec![Part::Ramp { to, rate }, Part::Hold { time: 0.1 / rate }, Part::Apart { rate }];
    }
    let words = format!(
        "{number}: {} s {:e} γ {gamma:e} γ_a {closing:e} n {exponent:.3} V {rate:e} {control} {parts:?}",
        problem.kind, case.start
    );
    Some(Drawn { case, edge, control, parts, words })
}

/// What is wrong with the pull of a problem number; `None` where there is no pull.
fn judged(number: u64, exponents: Exponents) -> Option<Result<(f64, String), String>> {
    let drawn = drawn(number, exponents)?;
    let words = drawn.words.clone();
    let pull = match drawn.puller().pull(&drawn.parts, &Unwatched) {
        Ok(pull) => pull,
        // Where a gap is unknown it is not pulled, and where bodies touch ahead of the edge there is more than one disc.
        Err(RateError::Beyond { .. } | RateError::Pressed { .. }) => return None,
        // The edge may begin too slowly; that is told.
        Err(RateError::TooManySteps { .. }) if matches!(exponents, Exponents::UpToTwo) => return None,
        Err(error) => return Some(Err(format!("{words}: {error:?}"))),
    };
    Some(
        faults(&drawn, &pull)
            .map_or(Ok((pull.balance, words.clone())), |fault| Err(format!("{words}: {fault}"))),
    )
}

/// What is impossible in a pull.
fn faults(drawn: &Drawn, pull: &Pull) -> Option<String> {
    if pull.balance.is_nan() || pull.balance > BALANCE {
        return Some(format!("balance {:e} in {} steps", pull.balance, pull.steps));
    }
    if pull.last_contact.is_none() {
        return Some("does not end apart".to_owned());
    }
    let last = pull.moments.last().map_or(0.0, |moment| moment.dissipated);
    let falls = |pair: &[Moment]| pair[1].dissipated < pair[0].dissipated - BALANCE * last;
    if pull.moments.windows(2).any(falls) {
        let worst = pull.moments.windows(2).map(|pair| pair[0].dissipated - pair[1].dissipated);
        return Some(format!("gains {:e} of {last:e}", worst.fold(0.0, f64::max)));
    }
    let only_opens = drawn.parts.len() == 1;
    let grows = |pair: &[Moment]| pair[1].contact_radius > pair[0].contact_radius * (1.0 + 10.0 * BALANCE);
    (only_opens && pull.moments.windows(2).any(grows)).then(|| "grows while it is pulled".to_owned())
}

fn campaign(numbers: Range<u64>, exponents: Exponents) {
    let found: Vec<_> = numbers.into_par_iter().filter_map(|number| judged(number, exponents)).collect();
    let (right, wrong): (Vec<_>, Vec<_>) = found.into_iter().partition(Result::is_ok);
    let worst = right.iter().filter_map(|found| found.as_ref().ok()).max_by(|a, b| a.0.total_cmp(&b.0));
    println!("{} pulls right, {} wrong, worst {worst:?}", right.len(), wrong.len());
    let wrong: Vec<String> = wrong.into_iter().filter_map(Result::err).collect();
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn fifty_random_pulls_close_their_balance() {
    campaign(0..50, Exponents::UpToOne);
}

#[test]
fn thirty_pulls_with_an_exponent_above_one_close_their_balance() {
    campaign(0..30, Exponents::UpToTwo);
}

#[test]
#[ignore = "minutes; in release"]
fn five_hundred_random_pulls_close_their_balance() {
    let all = std::env::var("PULLOFF_PULLS").ok();
    let range = all.and_then(|text| {
        let (from, to) = text.split_once("..")?;
        Some(from.parse().ok()?..to.parse().ok()?)
    });
    let range = range.unwrap_or(0..600);
    campaign(range.clone(), Exponents::UpToOne);
    campaign(range, Exponents::UpToTwo);
}

/// Only the ratio of the two speeds matters, and exactly so.
#[test]
fn twice_both_speeds_is_half_the_time() {
    let pulled = |speed: &str, rate: f64| {
        let text = pulloff_engine::preset::shipped::find("wavy-sphere").unwrap().text;
        let mut preset = pulloff_engine::preset::read("wavy-sphere", text).unwrap();
        preset.assign("edge.exponent", "0.4").unwrap();
        preset.assign("edge.reference_speed", speed).unwrap();
        let asked = AskedPulls { rates: vec![rate], ..AskedPulls::default() };
        PullReport::compute(&preset, &asked, &Unwatched).unwrap().runs.remove(0)
    };
    let (slow, fast) = (pulled("1", 0.01), pulled("2", 0.02));
    assert_eq!(slow.peak.force.to_bits(), fast.peak.force.to_bits());
    assert_eq!(slow.dissipated, fast.dissipated);
    assert_eq!(slow.moments.len(), fast.moments.len());
    assert_eq!(slow.peak.time, 2.0 * fast.peak.time);
    assert_eq!(slow.top_edge_speed.map(|speed| 2.0 * speed), fast.top_edge_speed);
    let [a, b] = [&slow, &fast].map(|run| run.last_contact.unwrap());
    assert_eq!((a.time, a.control), (2.0 * b.time, b.control));
}
