//! Kinds of measured curves, each made from a seed: what was measured, what is asked, and what is true.

use super::bodies::{Body, Gap};
use super::device::{By, Device, Peel, Way};
use super::record::{Random, Record, Seen};
use std::f64::consts::PI;

/// One made curve.
pub struct Made {
    /// The file.
    pub text: String,
    /// The preset.
    pub preset: String,
    /// The free keys.
    pub free: Vec<&'static str>,
    /// Their true values.
    pub truth: Vec<(&'static str, f64)>,
}

/// A kind of curves.
pub struct Kind {
    pub name: &'static str,
    /// Whether the fitted model is the one that made the curve, so that a right value need not be doubted.
    pub is_model: bool,
    pub make: fn(&mut Random) -> Made,
}

pub const MODULUS: &str = "material.effective_modulus";
pub const ADHESION: &str = "material.work_of_adhesion";
pub const STIFFNESS: &str = "path.control.stiffness";

/// The kinds that are tried with a thousand seeds.
pub const MEASURED: [Kind; 11] = [
    Kind { name: "white noise", is_model: true, make: white },
    Kind { name: "k free", is_model: true, make: free_spring },
    Kind { name: "k known to 10 %", is_model: true, make: uncertain_spring },
    Kind { name: "R known to 3 %", is_model: true, make: uncertain_radius },
    Kind { name: "20 rows", is_model: true, make: |random| few(random, 20) },
    Kind { name: "10 rows", is_model: true, make: |random| few(random, 10) },
    Kind { name: "tilt", is_model: true, make: tilted },
    Kind { name: "3 % outliers", is_model: true, make: outliers },
    Kind { name: "AR(1) 0.9", is_model: true, make: correlated },
    Kind { name: "P(s)", is_model: true, make: of_radius },
    Kind { name: "12 bit", is_model: true, make: converted },
];

/// Curves that no sphere with adhesion only at its edge gives, or that no instrument should: values are right, or
/// doubted.
pub const DOUBTFUL: [Kind; 38] = [
    Kind {
        name: "Gent-Schultz P(s), 29 rows",
        is_model: false,
        make: |random| peeled(random, 29, By::Time, false),
    },
    Kind {
        name: "Gent-Schultz P(s), 38 rows",
        is_model: false,
        make: |random| peeled(random, 38, By::Time, false),
    },
    Kind {
        name: "Gent-Schultz P(s), with times",
        is_model: false,
        make: |random| peeled(random, 38, By::Time, true),
    },
    Kind {
        name: "Gent-Schultz P(s), even in s, with times",
        is_model: false,
        make: |random| peeled(random, 38, By::Radius, true),
    },
    Kind {
        name: "Gent-Schultz P(s), even in s",
        is_model: false,
        make: |random| peeled(random, 38, By::Radius, false),
    },
    Kind { name: "P(s), with times", is_model: true, make: radii_with_times },
    Kind { name: "force noise 0.1 P_c", is_model: true, make: loud },
    Kind { name: "ends at the last contact", is_model: true, make: cut_at_contact },
    Kind { name: "retraction alone, ends at the last contact", is_model: true, make: cut_retraction },
    Kind { name: "clipped", is_model: false, make: clipped },
    Kind { name: "12 bit, coarse", is_model: false, make: coarse },
    Kind { name: "P(s), 3 % outliers", is_model: true, make: radii_with_outliers },
    Kind { name: "tare of P(s)", is_model: false, make: tare },
    Kind { name: "gap r^4", is_model: false, make: quartic },
    Kind { name: "Tabor 0.5", is_model: false, make: |random| ranged(random, 0.5) },
    Kind { name: "Tabor 1", is_model: false, make: |random| ranged(random, 1.0) },
    Kind { name: "Tabor 2", is_model: false, make: |random| ranged(random, 2.0) },
    Kind { name: "retraction, 2 % free", is_model: true, make: |random| soft_retraction(random, 0.02) },
    Kind { name: "retraction, 3 % free", is_model: true, make: |random| soft_retraction(random, 0.03) },
    Kind { name: "retraction, 5 % free", is_model: true, make: |random| soft_retraction(random, 0.05) },
    Kind { name: "retraction, 10 % free", is_model: true, make: |random| soft_retraction(random, 0.1) },
    Kind { name: "x turned, 2 % free", is_model: true, make: |random| turned_retraction(random, 0.02) },
    Kind { name: "x turned, 3 % free", is_model: true, make: |random| turned_retraction(random, 0.03) },
    Kind { name: "x turned, 5 % free", is_model: true, make: |random| turned_retraction(random, 0.05) },
    Kind { name: "x turned, 10 % free", is_model: true, make: |random| turned_retraction(random, 0.1) },
    Kind { name: "retraction first", is_model: true, make: turned_round },
    Kind { name: "three loops", is_model: true, make: three_loops },
    Kind { name: "every row twice", is_model: false, make: doubled },
    Kind { name: "k wrong by 20 %", is_model: false, make: wrong_spring },
    Kind { name: "Hertz", is_model: false, make: hertz },
    Kind { name: "cone", is_model: false, make: cone },
    Kind { name: "punch", is_model: false, make: punch },
    Kind { name: "layer", is_model: false, make: layer },
    Kind { name: "drift", is_model: false, make: drifting },
    Kind { name: "drag", is_model: false, make: dragged },
    Kind { name: "waves taken for smooth", is_model: false, make: wavy },
    Kind { name: "tilt not asked for", is_model: false, make: tilt_untold },
    Kind { name: "two works of adhesion", is_model: false, make: hysteretic },
];

/// A soft sphere, and the guesses for it.
#[derive(Debug, Clone, Copy)]
struct Ball {
    radius: f64,
    modulus: f64,
    adhesion: f64,
    /// The contact radius at the largest load.
    most: f64,
    /// The values in the preset, divided by the true ones.
    guess: [f64; 2],
}

impl Ball {
    fn draw(random: &mut Random) -> Self {
        let (radius, modulus) = (random.scale(2e-4, 5e-3), random.scale(3e5, 1e7));
        let adhesion = random.scale(0.02, 0.2);
        // A multiple of the contact radius without load.
        let most = random.even(1.2, 2.2) * (4.5 * PI * adhesion * radius * radius / modulus).cbrt();
        // A wider contact is not that of a paraboloid, and the fit says so.
        let most = most.min(0.4 * radius);
        let guess = [random.scale(1.0 / 3.0, 3.0), random.scale(1.0 / 3.0, 3.0)];
        Self { radius, modulus, adhesion, most, guess }
    }

    fn gap(&self) -> Gap {
        Gap::Sphere { radius: self.radius }
    }

    fn body(&self) -> Body {
        Body::adhesive(self.gap(), self.modulus, self.adhesion, self.most)
    }

    /// The force of pull-off.
    fn critical(&self) -> f64 {
        1.5 * PI * self.adhesion * self.radius
    }

    /// The stiffness of the contact at the largest load.
    fn contact(&self) -> f64 {
        2.0 * self.modulus * self.most
    }

    fn preset(&self, control: &str) -> String {
        let [e, w] = self.guess;
        format!(
            "format = 1\nunits = \"SI\"\n[material]\neffective_modulus = {:e}\nwork_of_adhesion = {:e}\n[gap]\nshape = \"sphere\"\n\
             radius_of_curvature = {:e}\n[path]\ncontrol = {control}\nstart_contact_radius = {:e}\n",
            e * self.modulus,
            w * self.adhesion,
            self.radius,
            0.1 * self.radius
        )
    }

    fn truth(&self) -> Vec<(&'static str, f64)> {
        vec![(MODULUS, self.modulus), (ADHESION, self.adhesion)]
    }

    /// δ and P, with an offset of x and a baseline of P.
    fn under_grips(&self, record: &Record, random: &mut Random) -> Made {
        let mut made = self.made(&shifted(record, self, random), "\"displacement\"");
        made.free.push("data.offset");
        made
    }

    /// Behind a spring whose stiffness is stated as `k`.
    fn behind(&self, k: f64, record: &Record, random: &mut Random) -> Made {
        let mut made = self.made(&shifted(record, self, random), &format!("{{ stiffness = {k:e} }}"));
        made.free.push("data.offset");
        made
    }

    fn made(&self, record: &Record, control: &str) -> Made {
        Made {
            text: record.text(),
            preset: self.preset(control),
            free: vec!["E*", "gamma"],
            truth: self.truth(),
        }
    }
}

/// The record with x and P shifted to other zeros.
fn shifted(record: &Record, ball: &Ball, random: &mut Random) -> Record {
    let offset = random.even(-3.0, 3.0) * ball.most * ball.most / ball.radius;
    let baseline = random.even(-1.0, 1.0) * ball.critical();
    record.clone().changed(|_, x, force| [x + offset, force + baseline])
}

fn grips(rows: usize, apart: f64) -> Device {
    Device { stiffness: f64::INFINITY, rows, apart }
}

/// A clean loop of a ball under fixed grips.
fn looped(ball: &Ball, rows: usize, apart: f64) -> Record {
    Record::of(&grips(rows, apart).cycle(&ball.body()), Seen::Approach)
}

fn white(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.04) * ball.critical();
    let apart = random.even(0.15, 0.4);
    let record = looped(&ball, 150, apart).noisy(sigma, random);
    ball.under_grips(&record, random)
}

fn free_spring(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let k = random.scale(0.3, 2.0) * ball.contact();
    let device = Device { stiffness: k, rows: 200, apart: 0.25 };
    let sigma = random.scale(0.002, 0.01) * ball.critical();
    let record = Record::of(&device.cycle(&ball.body()), Seen::Position).noisy(sigma, random);
    let mut made = ball.behind(k * random.scale(0.8, 1.25), &record, random);
    made.free.push("k");
    made.truth.push((STIFFNESS, k));
    made
}

/// A spring whose stiffness is off by as much as its stated uncertainty.
fn uncertain_spring(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let k = random.scale(0.3, 2.0) * ball.contact();
    let device = Device { stiffness: k, rows: 200, apart: 0.25 };
    let sigma = random.scale(0.002, 0.01) * ball.critical();
    let record = Record::of(&device.cycle(&ball.body()), Seen::Position).noisy(sigma, random);
    let mut made = ball.behind(k * (1.0 + 0.1 * random.normal()), &record, random);
    made.preset.push_str("\n[data.uncertain]\n\"path.control.stiffness\" = \"10 %\"\n");
    made.truth.push((STIFFNESS, k));
    made
}

/// A radius that is off by as much as its stated uncertainty.
fn uncertain_radius(random: &mut Random) -> Made {
    let mut ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = looped(&ball, 150, 0.3).noisy(sigma, random);
    ball.radius *= 1.0 + 0.03 * random.normal();
    let mut made = ball.under_grips(&record, random);
    made.preset.push_str("\n[data]\nuncertain = \"gap.radius_of_curvature=3%\"\n");
    made
}

fn few(random: &mut Random, rows: usize) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = looped(&ball, rows, 0.2).noisy(sigma, random);
    ball.under_grips(&record, random)
}

/// The rows of `white` with a slope of P over x of up to a fifth of the force of pull-off over the range of x.
fn sloped(random: &mut Random) -> (Ball, Record) {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = looped(&ball, 150, 0.35).noisy(sigma, random);
    let [lo, hi] = ends(&record.x);
    let slope = random.even(0.05, 0.2) * ball.critical() / (hi - lo);
    (ball, record.changed(|_, x, force| [x, force + slope * x]))
}

fn ends(x: &[f64]) -> [f64; 2] {
    x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(*x), hi.max(*x)])
}

fn tilted(random: &mut Random) -> Made {
    let (ball, record) = sloped(random);
    let mut made = ball.under_grips(&record, random);
    made.free.push("data.tilt");
    made
}

fn tilt_untold(random: &mut Random) -> Made {
    let (ball, record) = sloped(random);
    ball.under_grips(&record, random)
}

fn outliers(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = looped(&ball, 150, 0.3).noisy(sigma, random).with_outliers(0.03, 20.0 * sigma, random);
    ball.under_grips(&record, random)
}

fn correlated(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = looped(&ball, 400, 0.3).correlated(sigma, 0.9, random);
    ball.under_grips(&record, random)
}

/// Force and contact radius of a retraction in contact.
fn radii(ball: &Ball, rows: usize, random: &mut Random) -> Record {
    let samples = grips(rows, 0.0).cycle(&ball.body());
    let samples: Vec<_> = samples.into_iter().filter(|sample| sample.way == Way::Out).collect();
    let blur = random.scale(0.0005, 0.004) * ball.most;
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let touching: Vec<_> = samples.into_iter().filter(|sample| sample.state.radius > 0.0).collect();
    Record::of(&touching, Seen::Radius)
        .noisy(sigma, random)
        .changed(|_, s, force| [s + blur * random.normal(), force])
}

fn of_radius(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let record = radii(&ball, 80, random);
    ball.made(&record, "\"displacement\"")
}

/// Samples at uneven times, denser where an operator likes.
fn radii_with_times(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let share = random.even(0.2, 0.8);
    let mut record = radii(&ball, 160, random);
    let middle = record.x.len() / 2;
    record = record.kept(|i| i % 2 == 0 || (i < middle) == (share < 0.5));
    record.has_times = true;
    ball.made(&record, "\"displacement\"")
}

fn radii_with_outliers(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let record = radii(&ball, 80, random).with_outliers(0.03, 0.3 * ball.critical(), random);
    ball.made(&record, "\"displacement\"")
}

fn tare(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let tare = 0.15 * ball.critical() * random.normal().signum();
    let record = radii(&ball, 80, random).changed(|_, s, force| [s, force + tare]);
    ball.made(&record, "\"displacement\"")
}

/// Twelve bits over a range of which the loop fills some part.
fn converted(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let filled = random.scale(0.1, 0.8);
    digitized(&ball, filled, random)
}

/// Twelve bits of which the loop fills one part in 200: about twenty steps.
fn coarse(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    digitized(&ball, 0.005, random)
}

fn digitized(ball: &Ball, filled: f64, random: &mut Random) -> Made {
    let sigma = random.scale(0.0003, 0.01) * ball.critical();
    let record = looped(ball, 150, 0.3).noisy(sigma, random);
    let [lo, hi] = ends(&record.force);
    let step = (hi - lo) / filled / 4096.0;
    let baseline = random.even(-1.0, 1.0) * ball.critical();
    // The converter comes after the baseline, not before it.
    let record = record.changed(|_, x, force| [x, force + baseline]).quantized(step);
    let mut made = ball.made(&record, "\"displacement\"");
    made.free.push("data.offset");
    made
}

fn peeled(random: &mut Random, rows: usize, by: By, has_times: bool) -> Made {
    let mut ball = Ball::draw(random);
    ball.most *= 1.2;
    let exponent = random.even(0.4, 0.6);
    let reference = 1e-7;
    let peel = Peel {
        radius: ball.radius,
        modulus: ball.modulus,
        adhesion: ball.adhesion,
        exponent,
        reference,
        speed: reference * random.scale(0.03, 3.0),
        stiffness: random.scale(0.5, 20.0) * ball.contact(),
        begin: ball.most,
    };
    let sigma = random.scale(0.003, 0.01) * ball.critical();
    let mut record = Record::of(&peel.samples(rows, 0.35, by), Seen::Radius).noisy(sigma, random);
    record.has_times = has_times;
    let blur = 0.002 * ball.most;
    ball.made(&record.changed(|_, s, force| [s + blur * random.normal(), force]), "\"displacement\"")
}

fn loud(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = 0.1 * ball.critical();
    let apart = random.even(0.15, 0.4);
    let record = looped(&ball, 150, apart).noisy(sigma, random);
    ball.under_grips(&record, random)
}

fn cut_at_contact(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let samples = grips(150, 0.3).cycle(&ball.body());
    let touches = |i: usize| samples[i].way == Way::In || samples[i].state.radius > 0.0;
    let record = Record::of(&samples, Seen::Approach).kept(touches).noisy(sigma, random);
    ball.under_grips(&record, random)
}

fn cut_retraction(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let samples = grips(150, 0.3).cycle(&ball.body());
    let touches = |i: usize| samples[i].way == Way::Out && samples[i].state.radius > 0.0;
    let record = Record::of(&samples, Seen::Approach).kept(touches).noisy(sigma, random);
    // The zero of the force is taken as given: nothing in the file shows it.
    let mut made = ball.made(&record, "\"displacement\"");
    made.free.push("data.offset");
    made
}

fn clipped(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let least = -random.even(0.5, 0.85) * ball.critical();
    let record = looped(&ball, 150, 0.3).noisy(sigma, random).changed(|_, x, force| [x, force.max(least)]);
    ball.under_grips(&record, random)
}

fn quartic(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    // As high as the sphere at the edge of contact.
    let gap = Gap::Quartic { coefficient: 0.5 / (ball.radius * ball.most * ball.most) };
    let body = Body::adhesive(gap, ball.modulus, ball.adhesion, ball.most);
    of_body(&ball, &body, random)
}

fn of_body(ball: &Ball, body: &Body, random: &mut Random) -> Made {
    let record = Record::of(&grips(150, 0.3).cycle(body), Seen::Approach);
    let [lo, hi] = ends(&record.force);
    let record = record.noisy(random.scale(0.001, 0.005) * (hi - lo), random);
    ball.under_grips(&record, random)
}

fn ranged(random: &mut Random, mu: f64) -> Made {
    let ball = Ball::draw(random);
    let body = Body::of_range(ball.radius, ball.modulus, ball.adhesion, mu, ball.most);
    of_body(&ball, &body, random)
}

/// A retraction alone, behind a soft spring.
fn soft(random: &mut Random, apart: f64) -> (Ball, f64, Record) {
    let ball = Ball::draw(random);
    let k = random.scale(0.1, 0.4) * ball.contact();
    let device = Device { stiffness: k, rows: 300, apart };
    let sigma = random.scale(0.003, 0.01) * ball.critical();
    let record = Record::of(&device.cycle(&ball.body()), Seen::Position).only(Way::Out).noisy(sigma, random);
    (ball, k, record)
}

/// A retraction with a stiff or soft spring, few or many rows, much or little noise, from any load.
pub fn any_retraction(random: &mut Random) -> Made {
    let mut ball = Ball::draw(random);
    ball.most *= random.even(0.7, 1.3);
    let rows = random.scale(30.0, 600.0);
    // At least three rows apart: two of them can be lost to rounding.
    let apart = random.scale(0.02, 0.3).max(5.0 / rows);
    let rows = rows as usize;
    let device = Device { stiffness: random.scale(0.02, 2.0) * ball.contact(), rows, apart };
    let sigma = random.scale(0.001, 0.05) * ball.critical();
    let record = Record::of(&device.cycle(&ball.body()), Seen::Position);
    let mut record = record.only(Way::Out).noisy(sigma, random);
    record.names_ways = false;
    ball.behind(device.stiffness, &record, random)
}

fn soft_retraction(random: &mut Random, apart: f64) -> Made {
    let (ball, k, mut record) = soft(random, apart);
    record.names_ways = false;
    ball.behind(k, &record, random)
}

fn turned_retraction(random: &mut Random, apart: f64) -> Made {
    let (ball, k, mut record) = soft(random, apart);
    record.names_ways = false;
    ball.behind(k, &record.changed(|_, x, force| [-x, force]), random)
}

fn turned_round(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let mut record = looped(&ball, 150, 0.3).noisy(sigma, random).turned_round();
    record.names_ways = false;
    ball.under_grips(&record, random)
}

fn three_loops(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let mut one = || looped(&ball, 100, 0.3).noisy(sigma, random);
    let mut record = one().then(&one()).then(&one());
    record.names_ways = false;
    ball.under_grips(&record, random)
}

fn doubled(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = looped(&ball, 150, 0.3).noisy(sigma, random).doubled();
    ball.under_grips(&record, random)
}

fn wrong_spring(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let k = random.scale(0.1, 0.4) * ball.contact();
    let device = Device { stiffness: k, rows: 150, apart: 0.3 };
    let sigma = random.scale(0.003, 0.02) * ball.critical();
    let record = Record::of(&device.cycle(&ball.body()), Seen::Position).noisy(sigma, random);
    let wrong = k * if random.even(0.0, 1.0) < 0.5 { 0.8 } else { 1.2 };
    ball.behind(wrong, &record, random)
}

fn hertz(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let body = Body::adhesive(ball.gap(), ball.modulus, 0.0, ball.most);
    let mut made = of_body(&ball, &body, random);
    // The true work of adhesion is zero: the value found must be within one of its errors of zero, or doubted.
    made.truth[1].1 = 0.0;
    made
}

fn cone(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let gap = Gap::Cone { slope: 0.5 * ball.most / ball.radius };
    of_body(&ball, &Body::adhesive(gap, ball.modulus, ball.adhesion, ball.most), random)
}

fn punch(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let body = Body::punch(ball.most, ball.modulus, ball.adhesion, ball.most * ball.most / ball.radius);
    of_body(&ball, &body, random)
}

fn layer(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let body = Body::layer(ball.radius, ball.modulus, random.even(1.0, 3.0) * ball.most, ball.most);
    let mut made = of_body(&ball, &body, random);
    made.truth[1].1 = 0.0;
    made
}

fn drifting(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.01) * ball.critical();
    let drift = random.even(0.1, 0.3) * ball.critical() / 300.0;
    let record =
        looped(&ball, 150, 0.3).changed(|i, x, force| [x, force + drift * i as f64]).noisy(sigma, random);
    ball.under_grips(&record, random)
}

fn dragged(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.01) * ball.critical();
    let drag = random.even(0.05, 0.15) * ball.critical();
    let record = looped(&ball, 150, 0.3);
    let ways = record.ways.clone();
    let against = |way: Way| if way == Way::In { drag } else { -drag };
    let record = record.changed(|i, x, force| [x, force + against(ways[i])]).noisy(sigma, random);
    ball.under_grips(&record, random)
}

fn wavy(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let wavelength = ball.most / random.even(3.0, 8.0);
    // From crests that are only just visible up to crests that touch before the contact reaches them.
    let amplitude = random.even(0.2, 1.0) * wavelength * wavelength / (8.5761 * ball.radius);
    let gap = Gap::Wavy { radius: ball.radius, amplitude, wavelength };
    of_body(&ball, &Body::adhesive(gap, ball.modulus, ball.adhesion, ball.most), random)
}

fn hysteretic(random: &mut Random) -> Made {
    let ball = Ball::draw(random);
    let sigma = random.scale(0.003, 0.01) * ball.critical();
    let smaller = Ball { adhesion: random.even(0.3, 0.7) * ball.adhesion, ..ball };
    let (there, back) = (looped(&smaller, 150, 0.3).only(Way::In), looped(&ball, 150, 0.3).only(Way::Out));
    ball.under_grips(&there.then(&back).noisy(sigma, random), random)
}

/// White noise from one seed.
pub fn plain(seed: u64) -> Made {
    white(&mut Random::new(seed))
}
