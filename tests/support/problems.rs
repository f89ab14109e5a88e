//! Random problems of every shape, as a user writes them, and the terms of their gaps for the quadrature.

use super::quadrature::{Bump, Disc, Term};
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::preset::measured::rows as columns;
use pulloff_engine::preset::profile::parse;
use pulloff_engine::preset::{Files, Preset};
use pulloff_engine::problem::Control;
use pulloff_engine::read_in;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// Random numbers for one problem.
struct Random(fastrand::Rng);

impl Random {
    fn even(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.0.f64()
    }

    /// Uniform in the logarithm.
    fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        self.even(lo.ln(), hi.ln()).exp()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.0.f64() < share
    }

    fn of<T: Copy>(&mut self, these: &[T]) -> T {
        these[self.0.usize(..these.len())]
    }
}

/// What a problem starts from.
#[derive(Debug, Clone, Copy)]
pub enum Start {
    Radius(f64),
    Approach(f64),
    Force(f64),
}

/// A problem: in units in which its numbers are of order one, and as a user writes it in other units.
pub struct Problem {
    /// The shape, for the table of worst errors.
    pub kind: &'static str,
    pub terms: Vec<Term>,
    pub gamma: f64,
    pub control: Control,
    pub start: Start,
    /// The radius from which the start was drawn.
    pub drawn: f64,
    /// A length and a modulus in the user's units.
    pub length: f64,
    pub modulus: f64,
    pub preset: Preset,
    pub text: String,
    /// The radius beyond which nothing is known.
    pub end: f64,
}

/// The problem with this number, drawn independently of others; or why there is none, in words.
pub fn draw(number: u64) -> Result<Problem, String> {
    let mut random =
        Random(fastrand::Rng::with_seed(0x0070_756C_6C6F_6666 ^ number.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
    let r = &mut random;
    const KINDS: [&str; 15] = [
        "formula",
        "wavy-sphere",
        "formula",
        "profile",
        "harmonics",
        "formula",
        "sphere",
        "formula",
        "random-waves",
        "cone",
        "formula",
        "power-law",
        "profile",
        "formula",
        "exact-sphere",
    ];
    let kind = KINDS[usize::try_from(number).unwrap() % KINDS.len()];
    let si = r.chance(0.25);
    // A coefficient contains a power of the length.
    let si = si && kind != "power-law";
    let (length, modulus) = match (si, r.chance(0.5)) {
        (true, _) => (r.scale(1e-9, 1.0), r.scale(1e3, 1e12)),
        (false, true) if kind == "power-law" => (r.scale(1e-4, 1e4), r.scale(1e-6, 1e6)),
        (false, true) => (r.scale(1e-12, 1e12), r.scale(1e-6, 1e6)),
        (false, false) => (1.0, 1.0),
    };
    let start = if kind == "exact-sphere" { r.even(0.2, 0.9) } else { r.even(0.2, 1.0) };
    let mut gap = String::new();
    let mut terms = Vec::new();
    let mut folder = None;
    write!(gap, "[gap]\nshape = \"{kind}\"\n").unwrap();
    let radius = |gap: &mut String| writeln!(gap, "radius_of_curvature = {length:e}").unwrap();
    let paraboloid = || Term::Power { c: 0.5, n: 2.0 };
    match kind {
        "sphere" => {
            radius(&mut gap);
            terms.push(paraboloid());
        }
        "exact-sphere" => {
            radius(&mut gap);
            terms.push(Term::Sphere);
        }
        "wavy-sphere" => {
            radius(&mut gap);
            let (amplitude, wavelength) = wave(r, start);
            let [a, l] = [amplitude, wavelength].map(|x| x * length);
            write!(gap, "amplitude = {a:e}\nwavelength = {l:e}\n").unwrap();
            terms.extend([paraboloid(), Term::Wave { amplitude, wavenumber: TAU / wavelength, phase: 0.0 }]);
        }
        "harmonics" => {
            radius(&mut gap);
            terms.push(paraboloid());
            for _ in 0..r.of(&[1, 2, 3, 4]) {
                let (amplitude, wavelength) = wave(r, start);
                let phase = if r.chance(0.3) { 0.0 } else { r.even(-3.0, 3.0) };
                let [a, l] = [amplitude, wavelength].map(|x| x * length);
                write!(gap, "[[gap.waves]]\namplitude = {a:e}\nwavelength = {l:e}\nphase = {phase:e}\n")
                    .unwrap();
                terms.push(Term::Wave { amplitude, wavenumber: TAU / wavelength, phase });
            }
        }
        "random-waves" => {
            radius(&mut gap);
            let (amplitude, wavelength) = wave(r, start);
            let [rms, longest, shortest] =
                [amplitude, wavelength * 1.5, wavelength / r.even(1.2, 3.0)].map(|x| x * length);
            let (count, seed, hurst) = (r.of(&[1, 3, 10, 30]), r.0.u32(..1000), r.even(0.2, 1.0));
            write!(
                gap,
                "rms = {rms:e}\nlongest_wavelength = {longest:e}\nshortest_wavelength = {shortest:e}\nhurst = {hurst:e}\n\
                 count = {count}\nseed = {seed}\n"
            )
            .unwrap();
        }
        "cone" => {
            let slope = r.scale(1e-2, 1.0);
            writeln!(gap, "slope = {slope:e}").unwrap();
            terms.push(Term::Power { c: slope, n: 1.0 });
        }
        "power-law" => {
            let n = if r.chance(0.3) { r.of(&[1.0, 2.0, 3.0, 4.0, 8.0]) } else { r.even(1.05, 6.0) };
            let c = r.scale(0.05, 5.0);
            let coefficient = c * length.powf(1.0 - n);
            write!(gap, "coefficient = {coefficient:e}\nexponent = {n:e}\n").unwrap();
            terms.push(Term::Power { c: coefficient / length.powf(1.0 - n), n });
        }
        "profile" => {
            let made = tempfile::tempdir().unwrap();
            let path = made.path().join("rows.txt");
            std::fs::write(&path, rows(r, start, length, si)).unwrap();
            writeln!(gap, "file = {:?}", path.to_str().unwrap()).unwrap();
            let smoothing = r.even(0.02, 0.3) * length;
            writeln!(
                gap,
                "smoothing = {}",
                r.of(&["\"none\"", "\"none\"", "\"auto\"", &format!("{smoothing:e}")])
            )
            .unwrap();
            folder = Some(made);
        }
        _ => {
            let typed = r.chance(0.5);
            let base = if typed { "r^2/(2*R)".to_owned() } else { format!("r^2/{:e}", 2.0 * length) };
            terms.push(paraboloid());
            let mut formula = base;
            for _ in 0..r.of(&[1, 1, 2, 3]) {
                let term = feature(r, start);
                formula += &typed_term(&term, length);
                terms.push(term);
            }
            writeln!(gap, "formula = \"{formula}\"").unwrap();
            if typed {
                write!(gap, "[gap.parameters]\nR = {length:e}\n").unwrap();
            }
        }
    }
    // The adhesion is set by the pull-off radius that it gives the body under the waves and features, or that of the profile.
    let body = match &terms[..] {
        [] => vec![paraboloid()],
        [first, ..] => vec![first.clone()],
    };
    let critical = start * r.scale(0.02, 0.6);
    let slope = if kind == "profile" { 2.0 * critical } else { slope_of_transform(&body, critical) };
    let gamma = 2.0 / PI * critical * slope * slope;
    let control = match r.0.u32(..3) {
        0 => Control::Displacement,
        1 => Control::Force,
        _ => Control::Stiffness(r.scale(1e-3, 1e3)),
    };
    let shown = match control {
        Control::Stiffness(k) => format!("{{ stiffness = {:e} }}", k * modulus * length),
        other => format!("\"{other}\""),
    };
    let by = r.0.u32(..4);
    let write = |start_line: &str| {
        format!(
            "format = 1\n{}[material]\neffective_modulus = {modulus:e}\nwork_of_adhesion = {:e}\n{gap}[path]\ncontrol = \
             {shown}\n{start_line}\n",
            if si { "units = \"SI\"\n" } else { "" },
            gamma * modulus * length,
        )
    };
    let radius_line = format!("start_contact_radius = {:e}", start * length);
    let mut text = write(&radius_line);
    let mut preset = read(&text)?;
    // What the program draws or fits is part of the problem, not of its answer.
    let mut end = f64::INFINITY;
    match &preset.gap {
        Shape::RandomWaves { drawn, .. } => {
            terms.push(paraboloid());
            terms.extend(drawn.waves().iter().map(|wave| Term::Wave {
                amplitude: wave.amplitude / length,
                wavenumber: TAU / wave.wavelength * length,
                phase: wave.phase,
            }));
        }
        Shape::Profile(measured) => {
            let profile = measured.profile();
            let knots: Vec<f64> = profile.knots().to_vec();
            let slope = |ends: &[f64]| {
                let middle = 0.5 * (ends[0] + ends[1]);
                let (t, jet) = (ends[0] - middle, profile.jet(middle));
                let (second, third) = (jet.second * length, 0.5 * jet.third * length * length);
                let t = t / length;
                [jet.first + t * (second + t * third), second + 2.0 * t * third, third]
            };
            let slopes = knots.windows(2).map(slope).collect();
            terms.push(Term::Spline { knots: knots.iter().map(|k| k / length).collect(), slopes });
            end = knots[knots.len() - 1] / length * (1.0 - 1e-12);
        }
        Shape::ExactSphere(_) => end = 0.999,
        _ => {}
    }
    // A start by approach or force: that of the state with the drawn radius.
    let mut begin = Start::Radius(start);
    if by >= 2 && start < 0.9 * end {
        let state = Disc::new(&terms, gamma, start).state(start);
        let (value, key, unit) = if by == 2 {
            (state.approach, "start_approach", length)
        } else {
            (state.force, "start_force", modulus * length * length)
        };
        begin = if by == 2 { Start::Approach(value) } else { Start::Force(value) };
        text = write(&format!("{key} = {:e}", value * unit));
        preset = read(&text)?;
    }
    drop(folder);
    Ok(Problem {
        kind,
        terms,
        gamma,
        control,
        start: begin,
        drawn: start,
        length,
        modulus,
        preset,
        text,
        end,
    })
}

/// g' of a body, by a finite difference: it only sets the size of the adhesion.
fn slope_of_transform(terms: &[Term], s: f64) -> f64 {
    let disc = Disc::new(terms, 0.0, 1.01 * s);
    (disc.value(1.001 * s) - disc.value(0.999 * s)) / (0.002 * s)
}

/// Amplitude and wavelength of a wave whose slope is up to a few times that of the body at the start.
fn wave(r: &mut Random, start: f64) -> (f64, f64) {
    let wavelength = start * r.scale(0.03, 0.5);
    let q = TAU / wavelength;
    let amplitude = r.scale(0.05, 3.0) * 2.0 * start / (q * (0.5 * PI * q * start).sqrt());
    (amplitude, wavelength)
}

/// A bump or a corner.
fn feature(r: &mut Random, start: f64) -> Term {
    let (b, size) = (start * r.even(0.05, 1.05), r.scale(0.02, 3.0));
    let sign = if r.chance(0.5) { 1.0 } else { -1.0 };
    // The jump of h' that changes g' by `size` times that of the body, a tenth further out.
    let slope = sign * size * start * 0.3;
    match r.0.u32(..14) {
        0..=5 => {
            let width = start * r.scale(1e-4, 1e-1);
            let bump = r.of(&[Bump::Gauss, Bump::Tanh, Bump::Lorentz]);
            let power = if bump == Bump::Tanh { 0.5 } else { 1.5 };
            let unit = if bump == Bump::Tanh { width } else { 1.0 };
            let amplitude = sign * size * unit * width.powf(power) * b.sqrt();
            Term::Bump { bump, amplitude, centre: b, width }
        }
        6 => Term::Abs { c: slope, b },
        7 => Term::Max { c: slope, b },
        8 => Term::Min { c: slope, b },
        9 => {
            let period = start * r.even(0.08, 1.2);
            Term::AbsSine { c: slope.abs() * period / PI, period }
        }
        10 => Term::Triangle { c: slope, b, w: b * r.scale(1e-3, 0.5) },
        11 => Term::Valley { c: slope, b, w: b * r.scale(1e-3, 0.5) },
        12 => Term::AbsSquares { c: 0.5 * slope / start, b },
        _ => Term::MaxSquare { c: slope.abs() / (start * r.scale(1e-2, 1.0)), b },
    }
}

/// The term as a user types it, with lengths in units of `length`.
fn typed_term(term: &Term, length: f64) -> String {
    let l = |x: f64| format!("{:e}", x * length);
    match *term {
        Term::Bump { bump, amplitude, centre, width } => {
            let (a, x) = (l(amplitude), format!("(r-{})/{}", l(centre), l(width)));
            match bump {
                Bump::Gauss => format!(" + {a}*exp(-({x})^2)"),
                Bump::Tanh => format!(" + {a}*tanh({x})"),
                Bump::Lorentz => format!(" + {a}/(1+({x})^2)"),
            }
        }
        Term::Abs { c, b } => format!(" + {c:e}*abs(r-{})", l(b)),
        Term::Max { c, b } => format!(" + {c:e}*max(r-{},0)", l(b)),
        Term::Min { c, b } => format!(" + {c:e}*min(r,{})", l(b)),
        Term::AbsSine { c, period } => format!(" + {}*abs(sin(pi*r/{}))", l(c), l(period)),
        Term::Triangle { c, b, w } => format!(" + {c:e}*max({}-abs(r-{}),0)", l(w), l(b)),
        Term::Valley { c, b, w } => format!(" + {c:e}*max(abs(r-{})-{},0)", l(b), l(w)),
        Term::AbsSquares { c, b } => format!(" + {:e}*abs(r^2-{}^2)", c / length, l(b)),
        Term::MaxSquare { c, b } => format!(" + {:e}*max(r-{},0)^2", c / length, l(b)),
        _ => panic!("{term:?} is not typed"),
    }
}

/// The rows of a measured gap: unevenly spaced, with a wave and noise.
fn rows(r: &mut Random, start: f64, length: f64, si: bool) -> String {
    let count = r.0.usize(8..90);
    let last = start * r.even(1.05, 2.0);
    let mut radii = vec![if r.chance(0.5) { 0.0 } else { 0.5 }];
    for _ in 1..count {
        let step = r.scale(0.1, 2.0);
        radii.push(radii[radii.len() - 1] + step);
    }
    let unit = last / radii[radii.len() - 1];
    let (amplitude, wavelength) = wave(r, start);
    let wavelength = wavelength.max(4.0 * last / count as f64);
    let noise = r.scale(1e-7, 1e-4);
    let mut text = if si { "r [m], h [m]\n".to_owned() } else { String::new() };
    for radius in radii {
        let x = radius * unit;
        let h = 0.5 * x * x + amplitude * (1.0 - (TAU * x / wavelength).cos()) + noise * r.even(-1.0, 1.0);
        writeln!(text, "{:e}, {:e}", x * length, h * length).unwrap();
    }
    text
}

/// Reads a preset whose profile is on the disk.
fn read(text: &str) -> Result<Preset, String> {
    let files = Files {
        rows: |folder, name| {
            let bytes = std::fs::read(name).map_err(|error| error.to_string())?;
            columns(folder, name, parse(&bytes).map_err(|error| error.to_string())?)
        },
        ..Files::NONE
    };
    read_in(files, None, "campaign", text, &[] as &[&str]).map_err(|error| error.to_string())
}
