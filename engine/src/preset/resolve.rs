//! The units of a preset, and its texts with units converted to numbers in them.

use super::edge;
use super::family::{is_parameter, is_phase};
use super::invalid::Invalid;
use super::rows::parameter;
use super::schema::{CHOOSERS, COEFFICIENT, DISPLAY, Key, LIQUID_KEYS, SYSTEMS, table_of};
use super::value::Value;
use super::values::{Values, chosen, of_coefficient};
use crate::problem::Control;
use crate::units::{
    DisplayUnits, Quantity, TypedValue, Unit, UnitSystem, ValueError, number, parse_quantity,
};

/// The units that these values state.
pub(super) fn system(values: &Values, faults: &mut Vec<Invalid>) -> UnitSystem {
    if chosen(values, CHOOSERS[2]).as_deref() != Some(SYSTEMS[1]) {
        return UnitSystem::Reduced;
    }
    let mut units = DisplayUnits::default();
    for (key, quantity) in DISPLAY {
        let Some(Value::Text(name)) = values.get(key) else { continue };
        match units.clone().with(quantity, name) {
            Ok(changed) => units = changed,
            Err(cause) => faults.push(Invalid::Units { key: key.into(), cause }),
        }
    }
    UnitSystem::Si(units)
}

/// The values, with every text that stands for a number converted in the units of the preset; a text without a value in
/// them stays a text.
pub(super) fn resolved(values: &Values, units: &UnitSystem, faults: &mut Vec<Invalid>) -> Values {
    let mut all = values.clone();
    for (key, value) in &mut all {
        let Value::Typed(text) = value else { continue };
        match in_units(values, units, key, text) {
            Ok(k) if key == "path.control" => *value = Control::Stiffness(k).into(),
            Ok(x) => *value = x.into(),
            Err(fault) => faults.push(fault),
        }
    }
    all
}

/// The number of a text, in SI or reduced units.
pub(super) fn in_units(values: &Values, units: &UnitSystem, key: &Key, text: &str) -> Result<f64, Invalid> {
    let fault = |cause: ValueError| Invalid::Units { key: key.clone(), cause };
    let typed = parse_quantity(text).map_err(fault)?;
    if let Some(degrees) = typed.degrees().filter(|_| **key == *LIQUID_KEYS[2]) {
        return Ok(degrees);
    }
    let is_reduced = *units == UnitSystem::Reduced;
    // The phase of a wave is in radians, and so is what a formula takes.
    if typed.is_angle() && (is_phase(key) || is_reduced && parameter_of(key).is_some()) {
        return typed.in_own_si().map_err(fault);
    }
    if is_reduced {
        return typed.pure().map_err(fault);
    }
    if let Some(parameter) = parameter_of(key) {
        return of_parameter(values, parameter, &typed)
            .map_err(|cause| Invalid::Made { key: key.clone(), cause });
    }
    match (quantity(values, key), exponent(values)) {
        (Some(quantity), _) => typed.in_si(quantity, None).map_err(fault),
        (None, Some(n)) => {
            let cause = format!(
                "with n = {n:?} it is a length to the power {}, for which there is no unit: expected a bare \
                 number in SI, got {typed}",
                number::short(1.0 - n, 6)
            );
            Err(Invalid::Made { key: key.clone(), cause })
        }
        // Without an exponent there is no gap, which is reported elsewhere.
        (None, None) => typed.in_own_si().map_err(fault),
    }
}

/// What a key measures; `None` for the coefficient of a power law whose exponent gives it no unit.
pub(super) fn quantity(values: &Values, key: &str) -> Option<Quantity> {
    match key {
        "path.control" => Some(Quantity::ForcePerLength),
        edge::RATE => Some(edge::rate_quantity(matches!(
            values.get("path.control"),
            Some(control) if *control == Control::Force.into() || *control == "force".into()
        ))),
        COEFFICIENT => of_coefficient(exponent(values)?),
        _ => parameter(key).map(|row| row.quantity),
    }
}

fn exponent(values: &Values) -> Option<f64> {
    if let Some(Value::Number(n)) = values.get("gap.exponent") { Some(*n) } else { None }
}

/// The parameter of a formula that a key names, or whose range it belongs to.
fn parameter_of(key: &str) -> Option<&str> {
    [Some(key), table_of(key)].into_iter().flatten().find(|key| is_parameter(key))
}

/// The number of a parameter of a formula, or of one end of its range, in SI. Its dimension must be that of the
/// parameter's own unit; it may be any if the program does not know that unit and a gap, which is a length, can have it.
fn of_parameter(values: &Values, parameter: &str, typed: &TypedValue) -> Result<f64, String> {
    match (stated_unit(values, parameter), &typed.unit) {
        (Some(stated), Some(own)) if stated.dimension() != own.dimension() => Err(format!(
            "expected {} such as {}, the unit of the parameter, got {typed}, {}",
            stated.measures(),
            stated.ascii(),
            own.measures()
        )),
        (None, Some(own)) if is_mechanical(own) && !may_cancel(values, parameter) => Err(format!(
            "expected a length or another quantity without mass and time, since the gap is a length, got {typed}, {}",
            own.measures()
        )),
        _ => typed.in_own_si().map_err(|cause| cause.to_string()),
    }
}

/// Whether a unit has a mass or a time in it.
fn is_mechanical(unit: &Unit) -> bool {
    let dimension = unit.dimension();
    (dimension.kilogram, dimension.second) != (0, 0)
}

/// Whether a parameter of the formula other than this one may cancel the mass or the time of this one: one that has such
/// a unit itself, or that is a bare number.
fn may_cancel(values: &Values, parameter: &str) -> bool {
    let mut others = values.iter().filter(|(key, _)| is_parameter(key) && &***key != parameter);
    others.any(|(key, value)| match (stated_unit(values, key), value) {
        (Some(stated), _) => is_mechanical(&stated),
        (None, Value::Typed(text)) => match parse_quantity(text) {
            Ok(typed) => typed.unit.is_some_and(|own| is_mechanical(&own)),
            Err(_) => true,
        },
        (None, _) => true,
    })
}

/// The unit given beside a parameter of a formula, if the program knows it.
fn stated_unit(values: &Values, parameter: &str) -> Option<Unit> {
    match values.get(&*format!("{parameter}.unit")) {
        Some(Value::Text(unit)) => Unit::parse(unit, 0).ok(),
        _ => None,
    }
}

/// Converts the bare numbers of a formula's parameters, as a user writes them, from the unit beside them if the preset
/// is in SI. Not for values that are in SI already.
pub(super) fn count_in_own_units(values: &mut Values) {
    if chosen(values, CHOOSERS[2]).as_deref() != Some(SYSTEMS[1]) {
        return;
    }
    let bare = values.iter().filter_map(|(key, value)| {
        let Value::Number(x) = value else { return None };
        let unit = stated_unit(values, parameter_of(key)?)?;
        Some((key.clone(), Value::Typed(format!("{x:?} {}", unit.ascii()))))
    });
    for (key, typed) in bare.collect::<Vec<_>>() {
        values.insert(key, typed);
    }
}

/// A value as a message quotes it: with every digit, as a user would type it, and its unit in ASCII.
pub(super) fn shown(units: &UnitSystem, quantity: Quantity, x: f64) -> String {
    number::with_unit(units, quantity, x, true, |x| format!("{x:?}"))
}

/// A fault of a number in SI, reported in the unit in which the quantity is shown; its range stays in SI.
pub(super) fn told(units: &UnitSystem, quantity: Option<Quantity>, value: &Value, fault: Invalid) -> Invalid {
    let si = quantity.and_then(|quantity| units.unit(quantity).and(quantity.si()).zip(Some(quantity)));
    match (fault, value, si) {
        (Invalid::Range { key, allowed, .. }, Value::Number(x), Some((si, quantity))) => {
            let value = shown(units, quantity, *x);
            Invalid::Range { key, value, allowed: format!("{allowed} (in {si})") }
        }
        (fault, ..) => fault,
    }
}
