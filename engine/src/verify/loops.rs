//! Contact on rings, and whole loops of loading and unloading.
//!
//! The rigid flat annulus carries P = 2E*δb times a number that depends only on a/b and is known in closed form only in
//! its limits: for a narrow hole 1 − 4ε³/(3π²), ε = a/b, and for a thin ring π²(1 + ε)/(4 ln(16(1 + ε)/(1 − ε))), with
//! an error that goes to zero (W. D. Collins, Proc. Edinburgh Math. Soc. 13, 235 (1963)). Between the limits, and for
//! the loops on the waves of Fig. 9, the reference numbers come from a program of another kind that shares no code with
//! this one: contact added and removed in ring elements, its states refined by collocation. The unloading of a loop
//! without rings is that of the exact path.
//!
//! The balance of a loop compares energies with works: what is lost in all jumps against ∮ P dδ along the stable
//! states.

use super::cases::fig_9;
use super::row::{Group, VerifyRow};
use super::settings::VerifyError;
use crate::annuli::{Contacts, Ground, Wanted};
use crate::disc::Table;
use crate::elementary::ln;
use crate::gap::Shape;
use crate::gap::shapes::{Harmonic, Harmonics};
use crate::problem::Turn;
use crate::problem::{Control, Problem};
use crate::progress::Unwatched;
use crate::quasistatic::path::{Event, EventKind, Path, PathSetting, cycle};
use std::f64::consts::PI;
use std::sync::Arc;

/// P/(2E*δb) of the rigid flat annulus, by a/b.
const ANNULUS: [[f64; 2]; 6] = [
    [0.1, 0.999_864_355_578],
    [0.2, 0.998_901_152_221],
    [0.5, 0.981_017_896_923],
    [0.8, 0.897_616_307_068],
    [0.9, 0.821_029_779_368],
    [0.99, 0.608_763_092_119],
];

/// The approach at which the loops turn round.
const TURN: f64 = 0.14;

/// γ/(E*R) of the weak-adhesion loop.
const WEAK: f64 = 1e-4;

/// What the other program found for a loop.
struct KnownLoop {
    name: &'static str,
    work_of_adhesion: f64,
    /// The approach of every event in order.
    approaches: &'static [f64],
    /// The outermost edge after every event except the last contact.
    landings: &'static [f64],
    lost: f64,
    first_touch: [f64; 2],
    last_contact: [f64; 2],
}

/// A loop without rings that last.
fn strong() -> KnownLoop {
    KnownLoop {
        name: "Fig. 9",
        work_of_adhesion: fig_9().problem.work_of_adhesion,
        approaches: &[
            0.0,
            0.011_284_022_050_739_45,
            0.035_124_627_716_597_67,
            0.064_409_265_505_459_14,
            0.099_051_433_802_212_03,
            0.138_989_879_598_934_2,
            0.14,
            0.109_589_511_598_742_5,
            0.069_955_042_898_599_88,
            0.035_718_654_691_018_39,
            0.006_960_018_017_568_46,
            -0.016_211_119_437_663_13,
            -0.033_636_284_989_041_95,
            -0.045_071_642_164_052_56,
            -0.050_106_566_009_330_49,
        ],
        landings: &[
            0.261_057_637_821_063_2,
            0.307_128_975_494_295,
            0.356_294_562_744_128_2,
            0.405_593_165_907_550_4,
            0.454_983_430_354_452_7,
            0.504_440_667_296_341_6,
            0.504_695_958_171_977_8,
            0.457_784_399_923_083_8,
            0.407_178_571_652_467_2,
            0.356_479_301_584_352_1,
            0.305_642_990_858_619_8,
            0.254_586_933_542_099_5,
            0.203_123_810_447_138_5,
            0.150_648_243_654_073_8,
        ],
        lost: 2.112_003_387_295_31e-3,
        first_touch: [0.261_057_637_821_063_2, -0.012_934_170_552_290_24],
        last_contact: [0.143_650_617_504_202_8, -0.017_090_567_155_220_04],
    }
}

/// A loop with a ring before every merge.
fn weak() -> KnownLoop {
    KnownLoop {
        name: "Fig. 9, γ = 1e-4",
        work_of_adhesion: WEAK,
        approaches: &[
            0.0,
            0.001_192_888_873_469_99,
            0.006_347_805_749_873_639,
            0.011_679_832_233_207_54,
            0.016_400_899_523_766_04,
            0.020_972_974_634_125_46,
            0.031_639_554_166_149_66,
            0.035_022_977_669_901_72,
            0.051_943_756_188_663_22,
            0.053_960_843_924_955_09,
            0.077_291_472_990_967_36,
            0.077_842_989_126_575_38,
            0.107_668_223_881_070_9,
            0.14,
            0.084_765_100_591_309_44,
            0.055_709_240_974_054_13,
            0.031_878_026_925_358_35,
            0.013_347_593_149_320_54,
            0.000_247_302_494_019_016_1,
            -0.007_168_452_791_605_264,
            -0.008_250_030_346_817_322,
        ],
        landings: &[
            0.007_794_041_435_951_271,
            0.057_028_061_653_889_07,
            0.106_108_392_664_002_4,
            0.110_140_703_780_629_1,
            0.155_419_221_834_140_6,
            0.158_259_176_689_266_2,
            0.204_949_456_613_144_4,
            0.206_855_596_040_935_6,
            0.254_570_258_480_746_9,
            0.255_718_947_807_500_2,
            0.304_264_209_216_642_8,
            0.304_751_694_685_594_3,
            0.354_203_806_770_184_9,
            0.365_282_364_917_295_3,
            0.307_045_471_035_432_6,
            0.256_362_165_422_154,
            0.205_537_737_868_555_1,
            0.154_466_403_646_383_8,
            0.102_840_741_864_302_4,
            0.048_558_903_823_708_82,
        ],
        lost: 1.297_949_009_458_416e-4,
        first_touch: [0.007_794_041_435_951_271, -1.200_135_018_168_304e-5],
        last_contact: [0.044_369_618_571_360_78, -0.001_001_787_873_017_846],
    }
}

/// The annulus, the loops, and their balance.
///
/// # Errors
/// [`VerifyError::Table`].
pub fn groups() -> Result<Vec<Group>, VerifyError> {
    let mut groups = vec![annulus()?];
    let mut balances = Vec::new();
    for known in [strong(), weak()] {
        let found = run(known.work_of_adhesion)?;
        groups.push(of_loop(&known, found.as_ref()));
        balances.push(balance(&known, found.as_ref()));
    }
    let title = "Self-consistency: whole loops".to_owned();
    groups.push(Group { title, measure: super::balance::OWN_MEASURE, rows: balances });
    Ok(groups)
}

fn annulus() -> Result<Group, VerifyError> {
    /// Rounding of the constants; the limits are of leading order.
    const ROUNDING: f64 = 1e-11;
    const NARROW: f64 = 1e-11;
    const THIN: f64 = 1e-6;
    // Flat: a sphere so large that its curvature does not matter.
    const FLAT: f64 = 1e12;
    let waves = vec![Harmonic { amplitude: 0.0, wavelength: 10.0, phase: 0.0 }];
    let title = "Rigid flat annulus, force over 2E*δb".to_owned();
    let measure = "relative";
    let Ok(flat) = Harmonics::new(FLAT, waves) else {
        return Ok(Group { title, measure, rows: vec![VerifyRow::worst("flat gap", [], 1.0, 0.0)] });
    };
    let ground = Ground::of(Arc::new(flat), 2.0)?;
    let force = |ratio: f64| {
        let contacts = Contacts { disc: 0.0, rings: vec![[ratio, 1.0]] };
        ground.state(&contacts, Wanted::Values).map_or(f64::NAN, |state| 0.5 * state.force[1])
    };
    let mut rows: Vec<VerifyRow> = ANNULUS
        .iter()
        .map(|[ratio, exact]| VerifyRow::relative(format!("a/b = {ratio}"), force(*ratio), *exact, ROUNDING))
        .collect();
    let narrow = 0.01_f64;
    let exact = 1.0 - 4.0 * narrow.powi(3) / (3.0 * PI * PI);
    rows.insert(0, VerifyRow::relative("a narrow hole, a/b = 0.01", force(narrow), exact, NARROW));
    let thin = 0.999_f64;
    let exact = PI * PI * (1.0 + thin) / (4.0 * ln(16.0 * (1.0 + thin) / (1.0 - thin)));
    rows.push(VerifyRow::relative("a thin ring, a/b = 0.999", force(thin), exact, THIN));
    Ok(Group { title, measure, rows })
}

/// The loop on the waves of Fig. 9; `None` if it could not be computed.
fn run(work_of_adhesion: f64) -> Result<Option<Path>, VerifyError> {
    let Shape::WavySphere { radius_of_curvature, amplitude, wavelength } = fig_9().problem.shape else {
        return Ok(None);
    };
    let shape = Shape::WavySphere { radius_of_curvature, amplitude, wavelength };
    let reduced = Problem { effective_modulus: 1.0, work_of_adhesion, shape }.reduced();
    let table = Arc::new(Table::new(reduced.gap, fig_9().start, &Unwatched)?);
    let (control, turn) = (Control::Displacement, Turn::Approach(TURN));
    Ok(cycle(&table, work_of_adhesion, turn, &PathSetting::new(control), &Unwatched).ok())
}

fn of_loop(known: &KnownLoop, found: Option<&Path>) -> Group {
    /// Bounds for states, relative to their range, and for losses, relative to themselves.
    const STATES: f64 = 1e-9;
    const LOSSES: f64 = 1e-8;
    let title = format!("{}: the loop up to δ = {TURN}", known.name);
    let measure = "states over their range, losses relative";
    let events = found.map_or(&[][..], |found| &found.events);
    let pairs = |of: &dyn Fn(&Event) -> Option<f64>, known: &[f64]| -> Vec<(f64, f64)> {
        let ours: Vec<f64> = events.iter().filter_map(of).collect();
        // One event too many or too few means that it is not a loop of this kind.
        if ours.len() == known.len() { ours.into_iter().zip(known.iter().copied()).collect() } else { vec![] }
    };
    let range = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
    };
    let lost = found.and_then(|found| found.totals.dissipated).unwrap_or(f64::NAN);
    let approaches = pairs(&|event| Some(event.control_value), known.approaches);
    let landings = pairs(&|event| event.after.as_ref().map(|state| state.contact_radius), known.landings);
    let of = |kind: EventKind| events.iter().find(|event| event.kind == kind);
    let first = of(EventKind::FirstTouch).and_then(|event| event.after.as_ref());
    let last = of(EventKind::LastContact).and_then(|event| event.before.as_ref());
    let mut rows = vec![
        VerifyRow::new("number of events", events.len() as f64, known.approaches.len() as f64, 1.0, 0.0),
        VerifyRow::worst("approach of the events, the worst", approaches, range(known.approaches), STATES),
        VerifyRow::worst("outermost edge after them, the worst", landings, range(known.landings), STATES),
    ];
    let ends = [
        ("after the first touch", first, known.first_touch),
        ("at the last contact", last, known.last_contact),
    ];
    for (what, state, [radius, force]) in ends {
        let [ours_radius, ours_force] =
            state.map_or([f64::NAN; 2], |state| [state.contact_radius, state.force]);
        let scale = known.last_contact[1].abs();
        rows.push(VerifyRow::new(
            format!("contact radius {what}"),
            ours_radius,
            radius,
            range(known.landings),
            STATES,
        ));
        rows.push(VerifyRow::new(format!("force {what}"), ours_force, force, scale, STATES));
    }
    rows.push(VerifyRow::relative("energy lost in the loop", lost, known.lost, LOSSES));
    Group { title, measure, rows }
}

/// The energies lost compared with the areas that the path encloses.
fn balance(known: &KnownLoop, found: Option<&Path>) -> VerifyRow {
    /// The share of the losses that may be unaccounted for.
    const BOUND: f64 = 1e-7;
    let what = format!("{}: work against loss", known.name);
    let sums = found.and_then(|found| {
        let Path { totals, .. } = found;
        Some((totals.work_of_loading? + totals.work_of_unloading?, totals.dissipated?))
    });
    let (work, lost) = sums.unwrap_or((f64::NAN, f64::NAN));
    VerifyRow::own(what, work, lost, known.lost, BOUND)
}
