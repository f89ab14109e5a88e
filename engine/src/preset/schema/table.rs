//! The rows of the table of parameters.

use super::{
    ADHESION, Applies, CHOOSERS, COEFFICIENT, DISPLAY, EXACT, FORMAT, Fallback, Kind, LIQUID_KEYS, NONE,
    Parameter, RANGE_KEYS, START_KEYS, SYSTEMS, TURN_KEYS, WORK_OF_ADHESION,
};
use crate::preset::{data, edge};
use crate::problem::{Adhesion, Begin, ContactKind};
use crate::units::Quantity;
use std::borrow::Cow::Borrowed;

const SHAPE: &str = CHOOSERS[0];
const BASIS: &str = CHOOSERS[1];
const UNITS: &str = CHOOSERS[2];

/// Where a loop turns if no key gives it.
const TURN: &str = "at the contact radius at which the unloading starts";

/// How far a tension reaches if no key gives it.
const RANGE: &str = "h_c = 0.97 z0, and gamma/h_c";

/// A row, of its key, label and meaning: required, in every preset.
pub(in crate::preset) const fn row(
    [key, label, meaning]: [&'static str; 3],
    (dimension, quantity): (&'static str, Quantity),
    kind: Kind,
) -> Parameter {
    Parameter {
        key: Borrowed(key),
        label: Borrowed(label),
        meaning: Borrowed(meaning),
        dimension: Borrowed(dimension),
        quantity,
        unit: None,
        kind,
        fallback: Fallback::Required,
        applies: Applies::Always,
    }
}

/// The dimension of a quantity in words; empty for a pure number, and for a power of a length that only a preset gives.
const fn in_words(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Length => "length",
        Quantity::Force => "force",
        Quantity::Stress => "stress",
        Quantity::EnergyPerArea => "stress x length",
        Quantity::Energy => "force x length",
        Quantity::ForcePerLength => "force / length",
        Quantity::Speed => "length / time",
        Quantity::ForceRate => "force / time",
        Quantity::Time => "time",
        Quantity::InverseLength(_) | Quantity::Number => "",
    }
}

impl Parameter {
    /// The same row, with what it is when it is not given.
    pub(in crate::preset) const fn or(mut self, fallback: Fallback) -> Self {
        self.fallback = fallback;
        self
    }

    /// The same row, with where it applies.
    pub(in crate::preset) const fn only(mut self, applies: Applies) -> Self {
        self.applies = applies;
        self
    }
}

/// Makes [`PARAMETERS`] from the table: key, label, quantity, meaning, and which values it takes; then what it is when
/// it is not given, and where it applies, if it is not required or not in every preset. The dimension follows from the
/// quantity, except where one stands beside it.
macro_rules! parameters {
    ($($key:expr => $label:literal $quantity:ident $(($dimension:literal))? $meaning:literal:
        $kind:ident $(($of:expr))? $({$($range:tt)*})?
        $(or $fallback:ident($value:expr))? $(only $chooser:ident $words:tt)? $(while $state:ident)?;)*) => {
        /// The parameters, in the order in which files and screens show them.
        pub static PARAMETERS: &[Parameter] = &[$(
            row(
                [$key, $label, $meaning],
                ([$($dimension,)? in_words(Quantity::$quantity)][0], Quantity::$quantity),
                Kind::$kind $(($of))? $({$($range)*})?,
            )
            $(.or(Fallback::$fallback($value)))?
            $(.only(Applies::With { key: $chooser, words: &$words }))?
            $(.only(Applies::$state))?
        ),*];
    };
}

parameters! {
    "format" => "format" Number "version of this file format":
        Integer { min: FORMAT, max: FORMAT } or Integer(FORMAT);
    "title" => "title" Number "one line that says what the preset shows": Text { max_chars: 100 } or Text("");
    "units" => "units" Number "reduced: any consistent units; SI: bare numbers are SI, and text such as \"30 um\" has its unit":
        Choice(&SYSTEMS) or Text("reduced");
    "material.effective_modulus" => "E*" Stress "effective elastic modulus of the two bodies": Positive;
    WORK_OF_ADHESION => "gamma" EnergyPerArea "work of adhesion: twice a face's surface energy":
        NonNegative only ADHESION [Adhesion::NAMES[0], Adhesion::NAMES[1]];
    edge::CLOSING_ADHESION => "gamma_a" EnergyPerArea "work of adhesion that a closing edge gains, at most what an opening one costs":
        Positive or Described("the work of adhesion");
    "material.range_of_action" => "z0" Length "range of action of the adhesion, for Tabor's number, and for the range of a tension \
                                      where nothing else sets it":
        Positive or Described("0.3 nm in SI; in reduced units none, and no Tabor number");
    ADHESION => "adhesion" Number "model of adhesion: short-range at the edge of contact (JKR), dugdale with a tension within a range (Maugis, up to DMT), capillary as of a liquid bridge":
        Choice(&Adhesion::NAMES) or Text(Adhesion::NAMES[0]);
    RANGE_KEYS[0] => "sigma0" Stress "tension between the bodies within the range gamma/sigma0 of the adhesion":
        Positive or Described(RANGE) only ADHESION [Adhesion::NAMES[1]];
    RANGE_KEYS[1] => "h_c" Length "range of a constant tension gamma/h_c between the bodies":
        Positive or Described(RANGE) only ADHESION [Adhesion::NAMES[1]];
    LIQUID_KEYS[0] => "gamma_L" EnergyPerArea "surface tension of the liquid; the work of adhesion is 2 gamma_L cos theta":
        Positive only ADHESION [Adhesion::NAMES[2]];
    LIQUID_KEYS[1] => "r_K" Length "Kelvin radius: that of the meniscus at the given humidity":
        Positive only ADHESION [Adhesion::NAMES[2]];
    LIQUID_KEYS[2] => "theta" Number "angle at which the liquid meets the bodies, in degrees":
        Between { min: 0.0, max: 89.9 } or Number(0.0) only ADHESION [Adhesion::NAMES[2]];
    "gap.shape" => "gap" Number "shape of the gap between the undeformed bodies":
        Choice(&["sphere", "wavy-sphere", "exact-sphere", "cone", "power-law", "harmonics", "random-waves", "formula", "profile"]);
    "gap.radius_of_curvature" => "R" Length "combined radius of curvature":
        Positive only SHAPE ["sphere", "wavy-sphere", "exact-sphere", "harmonics", "random-waves"];
    "gap.amplitude" => "A" Length "amplitude of the wave": NonNegative only SHAPE ["wavy-sphere"];
    "gap.wavelength" => "lambda" Length "wavelength": Positive only SHAPE ["wavy-sphere"];
    "gap.slope" => "slope" Number "slope of the cone, the cotangent of its half apex angle":
        Positive only SHAPE ["cone"];
    COEFFICIENT => "c" Number("length^(1-n)") "coefficient c of the gap c r^n": Positive only SHAPE ["power-law"];
    "gap.exponent" => "n" Number "exponent n of the gap c r^n":
        Between { min: 1.0, max: 100.0 } only SHAPE ["power-law"];
    "gap.rms" => "rms" Length "root mean square of the random waves": NonNegative only SHAPE ["random-waves"];
    "gap.longest_wavelength" => "longest" Length "longest of the random waves": Positive only SHAPE ["random-waves"];
    "gap.shortest_wavelength" => "shortest" Length "shortest of the random waves":
        Positive only SHAPE ["random-waves"];
    "gap.hurst" => "H" Number "Hurst exponent: near 0 the short waves are as high as the long ones":
        Between { min: 0.01, max: 1.0 } or Number(0.8) only SHAPE ["random-waves"];
    "gap.count" => "waves" Number "number of random waves":
        Integer { min: 1, max: 1000 } or Integer(50) only SHAPE ["random-waves"];
    "gap.seed" => "seed" Number "which of the surfaces with these numbers":
        Integer { min: 0, max: i64::MAX } or Integer(1) only SHAPE ["random-waves"];
    "gap.formula" => "h(r)" Number "the gap as a formula in r, pi, e and parameters":
        Text { max_chars: 4096 } only SHAPE ["formula"];
    "gap.file" => "file" Number "file with the columns r and h; relative to the preset's own folder":
        File only SHAPE ["profile"];
    "gap.smoothing" => "smoothing" Length "wavelength at which smoothing passes half":
        Smoothing or Text(NONE) only SHAPE ["profile"];
    "basis.kind" => "basis" Number "how the contact pressure is found: exactly, or with the ring elements of the paper":
        Choice(&[EXACT, "rings"]) or Text(EXACT);
    "basis.rings" => "N" Number "number of ring elements":
        Integer { min: 4, max: 2000 } or Integer(200) only BASIS ["rings"];
    "basis.grading" => "grading" Number "spacing of the rings: uniform as in the paper, edge crowds at most 400 towards the edge":
        Choice(&["uniform", "edge"]) or Text("uniform") only BASIS ["rings"];
    edge::REFERENCE_SPEED => "v0" Speed "speed v0 at which an opening edge costs twice the work of adhesion":
        Positive or Described("1 in reduced units; none in SI, and no pull at a rate");
    edge::EXPONENT => "n edge" Number "exponent n of the law G = gamma (1 + (v/v0)^n) of an opening edge":
        Between { min: 0.05, max: 2.0 } or Described("none: the edge has no speed of its own, and every path is quasi-static");
    edge::CLOSING_SPEED => "v_a" Speed "the same speed of a closing edge":
        Positive or Described("that of an opening edge");
    edge::CLOSING_EXPONENT => "m edge" Number "exponent m of a closing edge, G = gamma_a/(1 + (v/v_a)^m)":
        Between { min: 0.05, max: 2.0 } or Described("that of an opening edge");
    edge::HIGHEST_RATIO => "G/gamma max" Number "largest G/gamma that the bodies can have, the ratio of their moduli; beyond it a pull warns":
        Positive or Described("none: no bound is known");
    edge::RELAXATION_TIME => "tau" Time "longest relaxation time of the bodies; a pull warns where they would not be relaxed":
        Positive or Described("none: the bodies are taken as relaxed");
    "path.control" => "control" Number "what the loading device prescribes": Control or Text("displacement");
    "path.control.stiffness" => "k" ForcePerLength "stiffness of the loading device":
        Positive or Described("none: the device is not a spring") while Spring;
    START_KEYS[0] => "s start" Length "contact radius at which the path starts":
        Positive or Described("0.5 x the radius of curvature, if no start is given");
    START_KEYS[1] => "delta start" Length "approach at which the path starts":
        Finite or Described("none: another start is used");
    START_KEYS[2] => "P start" Force "force at which the path starts, a preload":
        Finite or Described("none: another start is used");
    "path.end_contact_radius" => "s end" Length "contact radius at which the path ends":
        Positive or Described("0.004 x the contact radius at the start, or less where the contact still holds there");
    "path.begin" => "begin" Number "where a walk begins: with the disc of the start, or apart, at the first touch":
        Choice(&Begin::NAMES) or Text(Begin::NAMES[0]);
    "path.contact" => "contact" Number "which contacts a path follows: a disc and rings wherever they appear, or one disc alone":
        Choice(&ContactKind::NAMES) or Text(ContactKind::NAMES[0]);
    edge::RATE => "rate" Speed "rate at which a pull moves what is controlled, until the bodies are apart":
        Positive or Described("none: infinitely slow");
    edge::STEPS => "steps" Number "what a pull does instead, one after the other: to 0.1 mm at 1 um/s; hold 60 s; apart at 10 um/s":
        Text { max_chars: 500 } or Text("");
    TURN_KEYS[0] => "delta turn" Length "approach at which a loop of loading and unloading turns round":
        Finite or Described(TURN);
    TURN_KEYS[1] => "P turn" Force "force at which it turns round": Finite or Described(TURN);
    TURN_KEYS[2] => "s turn" Length "outermost radius of contact at which it turns round":
        Positive or Described(TURN);
    data::FILE => "data" Number "file with a measured curve, drawn behind the chart and fitted; relative to the preset's own folder":
        Points or Text(NONE);
    data::COLUMNS => "columns" Number "what its columns are, where its header does not say: approach=1,force=2":
        Text { max_chars: 200 } or Text("");
    data::FREE => "free" Number "keys that a fit may change, dotted or by their letters: E*,gamma,data.offset":
        Text { max_chars: 300 } or Text("");
    data::UNCERTAIN => "uncertain" Number "values known with an error, which a fit may change as far as that allows: path.control.stiffness=10%":
        Text { max_chars: 300 } or Text("");
    data::SEGMENT => "segment" Number "the only branch that is used":
        Choice(&data::SEGMENTS) or Described("none: both are used");
    data::FREE_PART => "apart" Number "which rows are apart: x=LO..HI as in the file, in SI or with units, or none":
        Text { max_chars: 100 } or Text("");
    data::SIGNS => "signs" Number "which way its columns run: x=-,force=+ reverses x alone; x must grow as the bodies approach, \
                              and the force must be positive where they are pressed together":
        Text { max_chars: 40 } or Text("");
    data::SKIP => "skip" Number "how many first rows are left out": Integer { min: 0, max: 1_000_000 } or Integer(0);
    data::SETTINGS => "settings" Number "whether the stiffness and the tip radius that the file states count; they must agree with the preset":
        Choice(&data::SETTINGS_OF) or Described("file");
    data::OFFSET => "delta0" Length "x of the measured curve at which the approach is zero": Finite or Described("0");
    data::BASELINE => "P0" Force "measured force that counts as zero":
        Finite or Described("the median of its free part; without one, 0, and a fit finds it");
    data::TARE => "tare" Force "the same as a fit has found it, where neither data.baseline nor rows apart say it": Finite or Described("0");
    data::TILT => "tilt" ForcePerLength "slope of that force over x": Finite or Described("0");
    DISPLAY[0].0 => "lengths" Number "unit in which lengths are shown":
        Text { max_chars: 20 } or Text("um") only UNITS ["SI"];
    DISPLAY[1].0 => "forces" Number "unit in which forces are shown":
        Text { max_chars: 20 } or Text("uN") only UNITS ["SI"];
    DISPLAY[2].0 => "stresses" Number "unit in which stresses are shown":
        Text { max_chars: 20 } or Text("kPa") only UNITS ["SI"];
    DISPLAY[3].0 => "adhesions" Number "unit in which works of adhesion are shown":
        Text { max_chars: 20 } or Text("mJ/m^2") only UNITS ["SI"];
    DISPLAY[4].0 => "energies" Number "unit in which energies are shown":
        Text { max_chars: 20 } or Text("pJ") only UNITS ["SI"];
    DISPLAY[5].0 => "stiffnesses" Number "unit in which stiffnesses are shown":
        Text { max_chars: 20 } or Text("N/m") only UNITS ["SI"];
}
