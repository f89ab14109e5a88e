//! Pinned curves on the screen.

use super::*;
use pulloff_engine::report::path::TotalsReport;

#[test]
fn a_state_of_a_pinned_curve_leads_to_the_present_one_which_is_told() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("p:set gamma=0.008\ri");
    let reading = |screen: &Screen| screen.text(120, 40).lines().rev().nth(1).unwrap().to_owned();
    for _ in 0..60 {
        if reading(&screen).contains("on pin D") {
            break;
        }
        screen.press(KeyCode::Up);
    }
    assert!(reading(&screen).contains("on pin D"), "{}", screen.text(120, 40));
    screen.keys("\r");
    let node = screen.app.model.walker().unwrap();
    let state = node.state.in_units(node.setting.units());
    let critical = critical_force(&screen.app.model.preset).unwrap();
    let [s, force] = [state.contact_radius, state.force / critical].map(|x| significant(x, 5));
    let said = format!("now on the present curve, not on pin D: s {s}, P {force} Pc, δ ");
    assert!(screen.text(80, 24).contains(&said), "{said} {}", screen.text(80, 24));
}

#[test]
fn a_pin_beside_a_loop_is_compared_by_its_unloading() {
    let mut screen = Screen::new("fig-9-weak");
    screen.keys("p");
    let text = screen.text(120, 40);
    assert!(text.contains("Unloading P/Pc δ/R s/λ W"), "{text}");
    // The pin is the present curve.
    for name in ["A P", "snaps", "W "] {
        let row = text.lines().find_map(|line| line.strip_prefix(&format!("│ {name}"))).unwrap();
        let [now, pin] = [0, 1].map(|at| row.split_whitespace().nth(at).unwrap());
        assert_eq!(now, pin, "{name}: {text}");
    }
}

#[test]
fn loops_with_a_dead_band_are_compared_as_loops() {
    let mut screen = Screen::new("fig-9-cycle");
    screen.keys(":set gamma_a=0.003\rp:set gamma_a=0.002\r");
    let text = screen.text(120, 40);
    assert!(text.contains("Loop P/Pc δ/R s/λ W"), "{text}");
    let model = &screen.app.model;
    let now = &model.path().unwrap().totals;
    let pin = &model.pins.all()[0].whole.as_ref().unwrap().totals;
    let band = |of: &TotalsReport| of.dead_band.unwrap().dissipated;
    for (name, values) in
        [("band", [band(now), band(pin)]), ("W", [now, pin].map(|of| of.dissipated.unwrap()))]
    {
        let row = text.lines().find_map(|line| line.strip_prefix(&format!("│ {name} "))).unwrap();
        for (at, value) in values.into_iter().enumerate() {
            let shown: f64 = row.split_whitespace().nth(at).unwrap().parse().unwrap();
            // The present value gives way to the name of its row.
            let digits = if name == "band" && at == 0 { 0.05 } else { 6e-3 };
            assert!((shown / value - 1.0).abs() < digits, "{name} {value}: {text}");
        }
    }
    assert!(band(now) > 1.2 * band(pin));
}

#[test]
fn a_pin_with_another_critical_force_is_compared_in_forces() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("p");
    let pinned = screen.app.model.path().unwrap().totals.largest_pull.as_ref().unwrap().force;
    assert!(screen.text(120, 40).contains("Result P/Pc δ/R s/λ W"), "{}", screen.text(120, 40));
    screen.keys(":set gamma=0.008\r");
    let text = screen.text(120, 40);
    let row = text.lines().find(|line| line.contains(" A P ")).unwrap();
    assert!(text.contains("Result P raw δ/R s/λ W") && row.contains(&significant(pinned, 3)), "{text}");
    let mut screen = Screen::new("fig-9-si");
    let unit =
        screen.app.model.preset.units.unit(pulloff_engine::units::Quantity::Force).unwrap().to_string();
    let text = screen.text(120, 40);
    let row = text.lines().skip_while(|line| !line.starts_with("│ A largest pull ")).nth(1).unwrap();
    assert!(row.contains("P/Pc -") && row.contains(&format!(" {unit} ")), "{text}");
    screen.keys("p:set gamma=1 J/m^2\r");
    let text = screen.text(120, 40);
    assert!(text.contains(&format!("Result P {unit} δ ")), "{text}");
}

#[test]
fn pins_are_listed_and_taken_away_one_by_one() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("p}p");
    let text = screen.text(120, 40);
    assert!(text.contains("D A 0.0025") && text.contains("pinned as E"), "{text}");
    screen.keys("P");
    let text = screen.text(120, 40);
    assert!(text.contains("D   A 0.0025") && text.contains("E   same values"), "{text}");
    screen.keys("\rPj");
    assert!(screen.text(120, 40).contains("> all"));
    screen.keys("\r");
    assert!(screen.app.model.pins.is_empty());
}
