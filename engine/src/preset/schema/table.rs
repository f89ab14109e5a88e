//! The rows of the table of parameters.

use super::{
    ADHESION, Applies, CHOOSERS, COEFFICIENT, DISPLAY, EXACT, FORMAT, Fallback, Kind, LIQUID_KEYS, NONE,
    Parameter, RANGE_KEYS, START_KEYS, SYSTEMS, TURN_KEYS, WORK_OF_ADHESION,
};
use crate::preset::{data, edge};
use crate::problem::{Adhesion, Begin, ContactKind};
use crate::units::Quantity;
use std::borrow::Cow::Borrowed;

/// The dimension of speeds.
const SPEED: (&str, Quantity) = ("length / time", Quantity::Speed);

/// Where a loop turns if no key gives it.
const TURN: &str = "at the contact radius at which the unloading starts";

/// How far a tension reaches if no key gives it.
const RANGE: &str = "h_c = 0.97 z0, and gamma/h_c";

/// The row of a pure number, a count, a text or a choice: required, in every preset.
pub(in crate::preset) const fn row(
    key: &'static str,
    label: &'static str,
    meaning: &'static str,
    kind: Kind,
) -> Parameter {
    measured(key, label, meaning, kind, ("", Quantity::Number))
}

/// The same for a length.
const fn length(key: &'static str, label: &'static str, meaning: &'static str, kind: Kind) -> Parameter {
    measured(key, label, meaning, kind, ("length", Quantity::Length))
}

/// The same for a quantity, with its dimension in words.
const fn measured(
    key: &'static str,
    label: &'static str,
    meaning: &'static str,
    kind: Kind,
    (dimension, quantity): (&'static str, Quantity),
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

/// The row of the unit in which a quantity is shown.
const fn display(at: usize, label: &'static str, meaning: &'static str, fallback: &'static str) -> Parameter {
    row(DISPLAY[at].0, label, meaning, Kind::Text { max_chars: 20 })
        .or(Fallback::Text(fallback))
        .only(Applies::With { key: CHOOSERS[2], words: &["SI"] })
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

    /// The same row, for gaps of these shapes.
    const fn of_shape(self, words: &'static [&'static str]) -> Self {
        self.only(Applies::With { key: CHOOSERS[0], words })
    }

    /// The same row, for these bases.
    const fn of_basis(self, words: &'static [&'static str]) -> Self {
        self.only(Applies::With { key: CHOOSERS[1], words })
    }
}

/// The parameters, in the order in which files and screens show them.
pub static PARAMETERS: &[Parameter] = &[
    row("format", "format", "version of this file format", Kind::Integer { min: FORMAT, max: FORMAT })
        .or(Fallback::Integer(FORMAT)),
    row("title", "title", "one line that says what the preset shows", Kind::Text { max_chars: 100 })
        .or(Fallback::Text("")),
    row(
        "units",
        "units",
        "reduced: any consistent units; SI: bare numbers are SI, and text such as \"30 um\" has its unit",
        Kind::Choice(&SYSTEMS),
    )
    .or(Fallback::Text("reduced")),
    measured(
        "material.effective_modulus",
        "E*",
        "effective elastic modulus of the two bodies",
        Kind::Positive,
        ("stress", Quantity::Stress),
    ),
    measured(
        WORK_OF_ADHESION,
        "gamma",
        "work of adhesion: twice a face's surface energy",
        Kind::NonNegative,
        ("stress x length", Quantity::EnergyPerArea),
    )
    .only(Applies::With { key: ADHESION, words: &[Adhesion::NAMES[0], Adhesion::NAMES[1]] }),
    measured(
        edge::CLOSING_ADHESION,
        "gamma_a",
        "work of adhesion that a closing edge gains, at most what an opening one costs",
        Kind::Positive,
        ("stress x length", Quantity::EnergyPerArea),
    )
    .or(Fallback::Described("the work of adhesion")),
    length(
        "material.range_of_action",
        "z0",
        "range of action of the adhesion, for Tabor's number, and for the range of a tension where nothing \
         else sets it",
        Kind::Positive,
    )
    .or(Fallback::Described("0.3 nm in SI; in reduced units none, and no Tabor number")),
    row(
        ADHESION,
        "adhesion",
        "short-range: at the edge of contact; dugdale: a constant tension within a range; capillary: a liquid bridge",
        Kind::Choice(&Adhesion::NAMES),
    )
    .or(Fallback::Text(Adhesion::NAMES[0])),
    measured(
        RANGE_KEYS[0],
        "sigma0",
        "tension between the bodies within the range gamma/sigma0 of the adhesion",
        Kind::Positive,
        ("stress", Quantity::Stress),
    )
    .or(Fallback::Described(RANGE))
    .only(Applies::With { key: ADHESION, words: &[Adhesion::NAMES[1]] }),
    length(RANGE_KEYS[1], "h_c", "range of a constant tension gamma/h_c between the bodies", Kind::Positive)
        .or(Fallback::Described(RANGE))
        .only(Applies::With { key: ADHESION, words: &[Adhesion::NAMES[1]] }),
    measured(
        LIQUID_KEYS[0],
        "gamma_L",
        "surface tension of the liquid; the work of adhesion is 2 gamma_L cos theta",
        Kind::Positive,
        ("stress x length", Quantity::EnergyPerArea),
    )
    .only(Applies::With { key: ADHESION, words: &[Adhesion::NAMES[2]] }),
    length(LIQUID_KEYS[1], "r_K", "Kelvin radius: that of the meniscus at the given humidity", Kind::Positive)
        .only(Applies::With { key: ADHESION, words: &[Adhesion::NAMES[2]] }),
    row(
        LIQUID_KEYS[2],
        "theta",
        "angle at which the liquid meets the bodies, in degrees",
        Kind::Between { min: 0.0, max: 89.9 },
    )
    .or(Fallback::Number(0.0))
    .only(Applies::With { key: ADHESION, words: &[Adhesion::NAMES[2]] }),
    row(
        "gap.shape",
        "gap",
        "shape of the gap between the undeformed bodies",
        Kind::Choice(&[
            "sphere",
            "wavy-sphere",
            "exact-sphere",
            "cone",
            "power-law",
            "harmonics",
            "random-waves",
            "formula",
            "profile",
        ]),
    ),
    length("gap.radius_of_curvature", "R", "combined radius of curvature", Kind::Positive).of_shape(&[
        "sphere",
        "wavy-sphere",
        "exact-sphere",
        "harmonics",
        "random-waves",
    ]),
    length("gap.amplitude", "A", "amplitude of the wave", Kind::NonNegative).of_shape(&["wavy-sphere"]),
    length("gap.wavelength", "lambda", "wavelength", Kind::Positive).of_shape(&["wavy-sphere"]),
    row("gap.slope", "slope", "slope of the cone, the cotangent of its half apex angle", Kind::Positive)
        .of_shape(&["cone"]),
    measured(
        COEFFICIENT,
        "c",
        "coefficient c of the gap c r^n",
        Kind::Positive,
        ("length^(1-n)", Quantity::Number),
    )
    .of_shape(&["power-law"]),
    row("gap.exponent", "n", "exponent n of the gap c r^n", Kind::Between { min: 1.0, max: 100.0 })
        .of_shape(&["power-law"]),
    length("gap.rms", "rms", "root mean square of the random waves", Kind::NonNegative)
        .of_shape(&["random-waves"]),
    length("gap.longest_wavelength", "longest", "longest of the random waves", Kind::Positive)
        .of_shape(&["random-waves"]),
    length("gap.shortest_wavelength", "shortest", "shortest of the random waves", Kind::Positive)
        .of_shape(&["random-waves"]),
    row(
        "gap.hurst",
        "H",
        "Hurst exponent: near 0 the short waves are as high as the long ones",
        Kind::Between { min: 0.01, max: 1.0 },
    )
    .or(Fallback::Number(0.8))
    .of_shape(&["random-waves"]),
    row("gap.count", "waves", "number of random waves", Kind::Integer { min: 1, max: 1000 })
        .or(Fallback::Integer(50))
        .of_shape(&["random-waves"]),
    row(
        "gap.seed",
        "seed",
        "which of the surfaces with these numbers",
        Kind::Integer { min: 0, max: i64::MAX },
    )
    .or(Fallback::Integer(1))
    .of_shape(&["random-waves"]),
    row(
        "gap.formula",
        "h(r)",
        "the gap as a formula in r, pi, e and parameters",
        Kind::Text { max_chars: 4096 },
    )
    .of_shape(&["formula"]),
    row("gap.file", "file", "file with the columns r and h; relative to the preset's own folder", Kind::File)
        .of_shape(&["profile"]),
    length("gap.smoothing", "smoothing", "wavelength at which smoothing passes half", Kind::Smoothing)
        .or(Fallback::Text(NONE))
        .of_shape(&["profile"]),
    row(
        "basis.kind",
        "basis",
        "how the contact pressure is found: exactly, or with the ring elements of the paper",
        Kind::Choice(&[EXACT, "rings"]),
    )
    .or(Fallback::Text(EXACT)),
    row("basis.rings", "N", "number of ring elements", Kind::Integer { min: 4, max: 2000 })
        .or(Fallback::Integer(200))
        .of_basis(&["rings"]),
    row(
        "basis.grading",
        "grading",
        "spacing of the rings: uniform as in the paper, edge crowds at most 400 towards the edge",
        Kind::Choice(&["uniform", "edge"]),
    )
    .or(Fallback::Text("uniform"))
    .of_basis(&["rings"]),
    measured(
        edge::REFERENCE_SPEED,
        "v0",
        "speed v0 at which an opening edge costs twice the work of adhesion",
        Kind::Positive,
        SPEED,
    )
    .or(Fallback::Described("1 in reduced units; none in SI, and no pull at a rate")),
    row(
        edge::EXPONENT,
        "n edge",
        "exponent n of the law G = gamma (1 + (v/v0)^n) of an opening edge",
        Kind::Between { min: 0.05, max: 2.0 },
    )
    .or(Fallback::Described("none: the edge has no speed of its own, and every path is quasi-static")),
    measured(edge::CLOSING_SPEED, "v_a", "the same speed of a closing edge", Kind::Positive, SPEED)
        .or(Fallback::Described("that of an opening edge")),
    row(
        edge::CLOSING_EXPONENT,
        "m edge",
        "exponent m of a closing edge, G = gamma_a/(1 + (v/v_a)^m)",
        Kind::Between { min: 0.05, max: 2.0 },
    )
    .or(Fallback::Described("that of an opening edge")),
    row(
        edge::HIGHEST_RATIO,
        "G/gamma max",
        "largest G/gamma that the bodies can have, the ratio of their moduli; beyond it a pull warns",
        Kind::Positive,
    )
    .or(Fallback::Described("none: no bound is known")),
    measured(
        edge::RELAXATION_TIME,
        "tau",
        "longest relaxation time of the bodies; a pull warns where they would not be relaxed",
        Kind::Positive,
        ("time", Quantity::Time),
    )
    .or(Fallback::Described("none: the bodies are taken as relaxed")),
    row("path.control", "control", "what the loading device prescribes", Kind::Control)
        .or(Fallback::Text("displacement")),
    measured(
        "path.control.stiffness",
        "k",
        "stiffness of the loading device",
        Kind::Positive,
        ("force / length", Quantity::ForcePerLength),
    )
    .or(Fallback::Described("none: the device is not a spring"))
    .only(Applies::Spring),
    length(START_KEYS[0], "s start", "contact radius at which the path starts", Kind::Positive)
        .or(Fallback::Described("0.5 x the radius of curvature, if no start is given")),
    length(START_KEYS[1], "delta start", "approach at which the path starts", Kind::Finite)
        .or(Fallback::Described("none: another start is used")),
    measured(
        START_KEYS[2],
        "P start",
        "force at which the path starts, a preload",
        Kind::Finite,
        ("force", Quantity::Force),
    )
    .or(Fallback::Described("none: another start is used")),
    length("path.end_contact_radius", "s end", "contact radius at which the path ends", Kind::Positive)
        .or(Fallback::Described("0.004 x the contact radius at the start")),
    row(
        "path.begin",
        "begin",
        "where a walk begins: with the disc of the start, or apart, at the first touch",
        Kind::Choice(&Begin::NAMES),
    )
    .or(Fallback::Text(Begin::NAMES[0])),
    row(
        "path.contact",
        "contact",
        "which contacts a path follows: a disc and rings wherever they appear, or one disc alone",
        Kind::Choice(&ContactKind::NAMES),
    )
    .or(Fallback::Text(ContactKind::NAMES[0])),
    measured(
        edge::RATE,
        "rate",
        "rate at which a pull moves what is controlled, until the bodies are apart",
        Kind::Positive,
        ("length / time", Quantity::Speed),
    )
    .or(Fallback::Described("none: infinitely slow")),
    row(
        edge::STEPS,
        "steps",
        "what a pull does instead, one after the other: to 0.1 mm at 1 um/s; hold 60 s; apart at 10 um/s",
        Kind::Text { max_chars: 500 },
    )
    .or(Fallback::Text("")),
    length(
        TURN_KEYS[0],
        "delta turn",
        "approach at which a loop of loading and unloading turns round",
        Kind::Finite,
    )
    .or(Fallback::Described(TURN)),
    measured(
        TURN_KEYS[1],
        "P turn",
        "force at which it turns round",
        Kind::Finite,
        ("force", Quantity::Force),
    )
    .or(Fallback::Described(TURN)),
    length(TURN_KEYS[2], "s turn", "outermost radius of contact at which it turns round", Kind::Positive)
        .or(Fallback::Described(TURN)),
    row(
        data::FILE,
        "data",
        "file with a measured curve, drawn behind the chart and fitted; relative to the preset's own folder",
        Kind::Points,
    )
    .or(Fallback::Text(NONE)),
    row(
        data::COLUMNS,
        "columns",
        "what its columns are, where its header does not say: approach=1,force=2",
        Kind::Text { max_chars: 200 },
    )
    .or(Fallback::Text("")),
    row(
        data::FREE,
        "free",
        "keys that a fit may change, dotted or by their letters: E*,gamma,data.offset",
        Kind::Text { max_chars: 300 },
    )
    .or(Fallback::Text("")),
    row(
        data::UNCERTAIN,
        "uncertain",
        "values known with an error, which a fit may change as far as that allows: path.control.stiffness=10%",
        Kind::Text { max_chars: 300 },
    )
    .or(Fallback::Text("")),
    row(data::SEGMENT, "segment", "the only branch that is used", Kind::Choice(&data::SEGMENTS))
        .or(Fallback::Described("none: both are used")),
    row(
        data::FREE_PART,
        "apart",
        "which rows are apart: x=LO..HI as in the file, in SI or with units, or none",
        Kind::Text { max_chars: 100 },
    )
    .or(Fallback::Text("")),
    row(
        data::SIGNS,
        "signs",
        "which way its columns run: x=-,force=+ reverses x alone; x must grow as the bodies approach, and \
         the force must be positive where they are pressed together",
        Kind::Text { max_chars: 40 },
    )
    .or(Fallback::Text("")),
    row(
        data::SKIP,
        "skip",
        "how many first rows are left out",
        Kind::Integer { min: 0, max: 1_000_000 },
    )
    .or(Fallback::Integer(0)),
    row(
        data::SETTINGS,
        "settings",
        "whether the stiffness and the tip radius that the file states count; they must agree with the preset",
        Kind::Choice(&data::SETTINGS_OF),
    )
    .or(Fallback::Described("file")),
    length(data::OFFSET, "delta0", "x of the measured curve at which the approach is zero", Kind::Finite)
        .or(Fallback::Described("0")),
    measured(
        data::BASELINE,
        "P0",
        "measured force that counts as zero",
        Kind::Finite,
        ("force", Quantity::Force),
    )
    .or(Fallback::Described("the median of its free part; 0 without one")),
    measured(
        data::TILT,
        "tilt",
        "slope of that force over x",
        Kind::Finite,
        ("force / length", Quantity::ForcePerLength),
    )
    .or(Fallback::Described("0")),
    display(0, "lengths", "unit in which lengths are shown", "um"),
    display(1, "forces", "unit in which forces are shown", "uN"),
    display(2, "stresses", "unit in which stresses are shown", "kPa"),
    display(3, "adhesions", "unit in which works of adhesion are shown", "mJ/m^2"),
    display(4, "energies", "unit in which energies are shown", "pJ"),
    display(5, "stiffnesses", "unit in which stiffnesses are shown", "N/m"),
];
