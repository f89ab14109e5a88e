//! What is typed, pasted and chosen.

use super::*;

#[test]
fn pasted_text_is_never_a_command() {
    let mut screen = Screen::new("fig-3-jkr");
    screen.app.paste("q\n   ");
    assert!(!screen.app.model.quit);
    screen.keys("\r");
    screen.app.paste("1\u{1b}[31m\nq");
    let text = screen.text(80, 24);
    assert!(text.contains("1\u{fffd}[31m") && !text.contains('\u{1b}'), "{text}");
}

#[test]
fn escape_and_the_next_key_arriving_together_are_both_heard() {
    let mut screen = Screen::new("fig-3-jkr");
    screen.keys("?");
    let alt = KeyEvent::new(KeyCode::Char(' '), crossterm::event::KeyModifiers::ALT);
    let effects = screen.app.key(alt);
    screen.settle(effects);
    assert!(screen.app.overlay.is_none());
    assert_eq!(screen.app.model.history.current().unwrap().step, 1);
}

#[test]
fn the_footer_shows_only_what_can_be_done() {
    let mut screen = Screen::new("wavy-sphere");
    assert!(!screen.text(120, 40).contains("x jump"));
    screen.keys("n");
    assert!(screen.text(120, 40).contains("x jump"));
    assert!(crate::explorer::table::row_of(Id::Undo).short.len() < 10);
}

#[test]
fn the_columns_of_a_foreign_file_are_chosen_from_lists() {
    let mut screen = Screen::new("lens");
    let path = screen.folder.path().join("foreign.csv");
    let rows: Vec<String> = (0..40).map(|i| format!("7,{i},{},out", i * i)).collect();
    std::fs::write(&path, format!("u1,u2,u3,u4\n{}\n", rows.join("\n"))).unwrap();
    screen.keys(&format!(":data {}\r", path.display()));
    let text = screen.text(100, 30);
    assert!(text.contains("What is x") && text.contains("approach   column 2 \"u2\": 0, 1, 2"), "{text}");
    // The position is column 2, in um; the force column 3, in nN; no column names the branch.
    screen.keys("position   column 2\r");
    assert!(screen.text(100, 30).contains("Unit of column 2, position"), "{}", screen.text(100, 30));
    screen.keys("um\r");
    let text = screen.text(100, 30);
    assert!(text.contains("What is the force") && !text.contains("column 2"), "{text}");
    assert!(!text.contains("column 4"), "words are no force: {text}");
    screen.keys("force      column 3\rnN\r");
    assert!(screen.text(100, 30).contains("Does a column name the branch"), "{}", screen.text(100, 30));
    screen.keys("\r");
    let preset = &screen.app.model.preset;
    assert_eq!(preset.data.columns, "position=2 [um],force=3 [nN]");
    assert!(preset.data.source.as_ref().is_some_and(|source| source.name.ends_with("foreign.csv")));
    assert!(screen.app.overlay.is_none());
}

#[test]
fn shapes_are_chosen_by_their_pictures() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("kk\r");
    let text = screen.text(100, 30);
    assert!(
        text.contains("> wavy-sphere   paraboloid with one wave") && text.contains("┌wavy-sphere─"),
        "{text}"
    );
    // The disc ends at the start, which the picture shows beside the list.
    let row = text.lines().find(|line| line.contains("random-waves")).unwrap();
    assert!(row.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "{text}");
    screen.keys("j");
    assert!(screen.text(100, 30).contains("┌exact-sphere─"));
    // Narrow screens show the list alone, and no size is too small to draw.
    assert!(!screen.text(60, 18).contains("┌exact-sphere─"));
    for width in 0..120 {
        for height in [0, 1, 3, 9, 10, 12, 18, 24] {
            screen.draw(width, height);
        }
    }
    screen.app.theme = PLAIN;
    let text = screen.text(100, 30);
    assert!(text.is_ascii() && text.contains("> exact-sphere  R - sqrt(R2 - r2), up to R"), "{text}");
    let row = text.lines().find(|line| line.contains("random-waves")).unwrap();
    assert!(row.split("law").last().is_some_and(|picture| picture.contains('o')), "{text}");
    screen.keys("\r");
    assert_eq!(screen.app.model.preset.gap.name(), "exact-sphere");
    assert!(screen.app.overlay.is_none());
    // A chosen list closed again changes nothing.
    screen.keys("\rj\x1b");
    assert_eq!(screen.app.model.preset.gap.name(), "exact-sphere");
}

#[test]
fn a_formula_shows_where_it_is_wrong() {
    let mut screen = Screen::new("formula");
    screen.keys("jjj\r");
    let before = screen.app.model.preset.clone();
    let curve = screen.app.model.curve.clone().unwrap();
    for _ in 0..screen.app.model.preset.get("gap.formula").unwrap().to_string().len() {
        screen.press(KeyCode::Backspace);
    }
    screen.keys("r^2/(2*R) + * B");
    let text = screen.text(100, 30);
    let lines: Vec<&str> = text.lines().collect();
    let at = lines.iter().position(|line| line.contains("> r^2/(2*R) + * B")).unwrap();
    // The column counts from the first character of the formula.
    let column = |line: &str, what: &str| line.split(what).next().unwrap().chars().count();
    assert_eq!(column(lines[at + 1], "^"), column(lines[at], "* B"), "{text}");
    assert!(text.contains("column 13: expected a number, a name or '('"), "{text}");
    // The knobs and the curve are those of the last text that was a formula, R^2/(2*R), and stay visible.
    assert!(screen.app.model.preset.get("gap.parameters.A").is_none() && text.contains("Problem"), "{text}");
    let tried = screen.app.model.curve.clone().unwrap();
    assert!(!std::sync::Arc::ptr_eq(&curve, &tried));
    screen.keys("\r");
    assert!(screen.text(100, 30).contains("column 13"), "Enter takes no text that is no formula");
    for width in 0..100 {
        for height in [0, 1, 3, 9, 10, 12, 18, 24] {
            screen.draw(width, height);
        }
    }
    screen.keys("\x1b");
    assert_eq!(screen.app.model.preset, before);
    assert!(screen.app.overlay.is_none() && !screen.app.model.is_computing());
    // Pasted as well as typed.
    screen.keys("\r");
    let effects = screen.app.paste(" + 0*r");
    screen.settle(effects);
    screen.keys("\r");
    assert!(screen.app.model.preset.get("gap.formula").unwrap().to_string().ends_with("lambda)) + 0*r"));
    assert!(screen.app.model.untried.is_none() && screen.app.model.is_unsaved());
}
