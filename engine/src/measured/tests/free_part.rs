//! Which rows are apart: by the points, by what a person says, by contact radii.

use super::*;

#[test]
fn much_noise_and_a_pause_hide_no_free_part_and_rows_around_the_jump_are_dropped() {
    let noisy = branches(&csv(&jkr(2e-3))).unwrap();
    assert!(noisy.baseline.is_some() && noisy.turned == [false; 2], "{:?}", noisy.notes);
    let mut rows = jkr(2e-5);
    let top = rows[300];
    let mut random = SplitMix64::new(6);
    rows.splice(300..300, (0..150).map(|_| (top.0 - 1e-4 * random.unit(), top.1, false)));
    let paused = branches(&csv(&rows)).unwrap();
    assert!(paused.baseline.is_some() && paused.list.iter().all(|branch| branch.free.len() > 40));
    // Some rows of the free end are outliers.
    let mut rows = jkr(2e-5);
    for row in rows.iter_mut().take(30).step_by(6) {
        row.1 += 0.02;
    }
    let found = branches(&csv(&rows)).unwrap();
    assert!(found.list.iter().all(|branch| branch.free.len() > 40));
    // Some rows have noise in x: those that lie on the wrong side of the jump are no outliers.
    let mut rows = jkr(2e-5);
    for row in &mut rows {
        row.0 += 2e-3 * (random.unit() + random.unit() - 1.0);
    }
    let found = branches(&csv(&rows)).unwrap();
    let baseline = found.baseline.unwrap();
    for branch in &found.list {
        let jump = branch.attached.last().unwrap().force;
        assert!(jump < -0.01 && branch.jump > 0, "{jump} {}", branch.jump);
        assert!(branch.free.iter().all(|point| (point.force - baseline).abs() < 1e-3));
    }
}

/// The branches of rows, for this request.
fn taken(rows: &[(f64, f64, bool)], asked: &Asked) -> Result<Branches, BranchError> {
    let measured = parse(csv(rows).as_bytes(), &ColumnSpec::default()).unwrap();
    measured.points(&UnitSystem::Reduced, Some(1.0)).unwrap().branches(asked)
}

/// The rows in contact, within the jump and apart of each branch.
fn parts(found: &Branches) -> Vec<[usize; 3]> {
    found.list.iter().map(|branch| [branch.attached.len(), branch.jump, branch.free.len()]).collect()
}

#[test]
fn a_person_says_which_rows_are_apart_and_which_count() {
    let rows = jkr(1e-4);
    let usual = Asked::default();
    let found = taken(&rows, &usual).unwrap();
    assert_eq!((found.rows, found.pauses), ([301, 301], 0));
    let [approach, retraction] = parts(&found)[..] else { panic!("{found:?}") };
    assert_eq!(approach[0] + approach[2], 301);
    // With all rows below -0.08 apart, the free part is the same on both branches; the rows of the approach from there
    // to its jump belong to neither.
    let free = FreePart::Within(ValueRange { lo: f64::NEG_INFINITY, hi: -0.08 });
    let named = taken(&rows, &Asked { free, ..usual }).unwrap();
    assert_eq!(parts(&named), [[approach[0], 0, 41], [retraction[0], 0, 41]]);
    assert_eq!(named.rows, [301, 301]);
    // A narrower range leaves out what is beyond it.
    let free = FreePart::Within(ValueRange { lo: -0.0901, hi: -0.0799 });
    let within = taken(&rows, &Asked { free, ..usual }).unwrap();
    assert_eq!(parts(&within), [[approach[0], 0, 21], [retraction[0], 0, 21]]);
    // The range has the sign of x in the file; it then also fixes the direction of x.
    let turned: Vec<_> = rows.iter().map(|(x, p, back)| (-x, *p, *back)).collect();
    let free = FreePart::Within(ValueRange { lo: 0.08, hi: f64::INFINITY });
    let other = taken(&turned, &Asked { free, ..usual }).unwrap();
    assert_eq!((parts(&other), other.turned), (parts(&named), [true, false]));
    let said = taken(&turned, &Asked { turned: Some([true, false]), ..usual }).unwrap();
    assert_eq!((parts(&said), said.notes.len()), (parts(&found), 0));
    let contact: Vec<_> =
        rows.iter().filter(|(x, _, back)| *x > 0.0 || (*back && *x > -0.07)).copied().collect();
    let none = taken(&contact, &Asked { free: FreePart::None, ..usual }).unwrap();
    assert!(parts(&none).iter().all(|[_, jump, free]| jump + free == 0) && none.baseline.is_none());
    let skipped = taken(&rows, &Asked { skip: 100, ..usual }).unwrap();
    assert_eq!(parts(&skipped), [[approach[0], 0, approach[2] - 100], retraction]);
    assert_eq!(skipped.rows, [301, 301]);
    let nowhere = FreePart::Within(ValueRange { lo: 5.0, hi: 6.0 });
    assert_eq!(taken(&rows, &Asked { free: nowhere, ..usual }), Err(BranchError::NothingFree));
    assert_eq!(taken(&rows, &Asked { skip: 600, ..usual }), Err(BranchError::Few(2)));
}

#[test]
fn contact_radii_are_apart_where_they_are_zero_alone() {
    let rows = (0..40).fold("contact radius, force\n".to_owned(), |mut text, i| {
        let s = if i < 30 { 0.5 - 0.01 * f64::from(i) } else { 0.0 };
        writeln!(text, "{s:?},{:?}", 4.0 / 3.0 * s.powi(3) - (0.2 * s.powi(3)).sqrt()).unwrap();
        text
    });
    let measured = parse(rows.as_bytes(), &ColumnSpec::default()).unwrap();
    let points = measured.points(&UnitSystem::Reduced, None).unwrap();
    let usual = Asked::default();
    assert_eq!(parts(&points.branches(&usual).unwrap()), [[30, 0, 10]]);
    let none = points.branches(&Asked { free: FreePart::None, ..usual }).unwrap();
    assert_eq!((parts(&none), none.rows), (vec![[30, 0, 0]], [0, 40]));
    // A negative radius is refused if its row is used, and does not matter if the first rows of the file are left out.
    let mut noisy = points.clone();
    noisy.x[1] = -0.001;
    let refused = BranchError::NegativeRadius { row: 2, radius: -0.001 };
    assert_eq!(noisy.branches(&Asked { skip: 1, ..usual }), Err(refused));
    assert_eq!(parts(&noisy.branches(&Asked { skip: 2, ..usual }).unwrap()), [[28, 0, 10]]);
    let within = FreePart::Within(ValueRange { lo: 0.0, hi: 0.1 });
    assert_eq!(points.branches(&Asked { free: within, ..usual }), Err(BranchError::FreeRadius));
    assert_eq!(
        points.branches(&Asked { turned: Some([true, false]), ..usual }),
        Err(BranchError::TurnedRadius)
    );
}

/// A microscope sees no contact while the bodies are apart.
#[test]
fn rows_without_a_radius_are_apart_or_left_out() {
    let text = |has_way: bool, gone: &str| {
        let mut text =
            if has_way { "delta,force,contact radius\n" } else { "force,contact radius\n" }.to_owned();
        for i in 0..60 {
            let s = 0.6 - 0.01 * f64::from(i);
            let root = (TAU * 0.01 * s).sqrt();
            // Behind the pull-off at s = 0.158.
            let is_apart = s < 0.158;
            let delta = if is_apart { -0.1 - 0.003 * f64::from(i) } else { s * s - root };
            let force = if is_apart { 0.0 } else { 4.0 / 3.0 * s.powi(3) - 2.0 * s * root };
            let radius = if is_apart { gone.to_owned() } else { format!("{s:?}") };
            let radius = if i == 7 { "NaN".to_owned() } else { radius };
            let way = if has_way { format!("{delta:?},") } else { String::new() };
            writeln!(text, "{way}{force:?},{radius}").unwrap();
        }
        text
    };
    for gone in ["", "NaN", "0"] {
        let found = branches(&text(true, gone)).unwrap();
        assert_eq!(parts(&found), [[44, 0, 15]], "{gone}");
        assert!(found.notes.iter().any(|note| note.ends_with("left out: 1")), "{:?}", found.notes);
        assert_eq!(found.baseline, Some(0.0));
        let measured = parse(text(false, gone).as_bytes(), &ColumnSpec::default()).unwrap();
        assert_eq!(measured.skipped, 1);
        let is_told = measured.notes.iter().any(|note| note.ends_with("taken to be apart: 15"));
        assert_eq!(is_told, gone != "0", "{:?}", measured.notes);
        assert_eq!(parts(&branches(&text(false, gone)).unwrap()), [[44, 0, 15]], "{gone}");
    }
    // A contact that is lost from sight goes on.
    let whole = text(false, "");
    let lost = whole.lines().take(40).enumerate().fold(String::new(), |mut all, (i, line)| {
        let (force, _) = line.split_once(',').unwrap();
        writeln!(all, "{}", if i > 30 { format!("{force},") } else { line.to_owned() }).unwrap();
        all
    });
    let measured = parse(lost.as_bytes(), &ColumnSpec::default()).unwrap();
    assert_eq!((measured.skipped, measured.lines.len()), (10, 29));
}

#[test]
fn a_free_part_on_one_branch_alone_is_said_and_none_is_made_up() {
    let rows = jkr(1e-4);
    // A retraction that ends at its last contact, where the force stays constant.
    let cut: Vec<_> = rows.iter().filter(|(x, _, back)| !back || *x >= -0.0735).copied().collect();
    let found = taken(&cut, &Asked::default()).unwrap();
    let [approach, retraction] = parts(&found)[..] else { panic!("{found:?}") };
    assert!(approach[2] == 200 && retraction[2] == 0, "{approach:?} {retraction:?}");
    let said = found.notes.join("; ");
    assert!(said.contains("no rows of the retraction look apart: all are taken to be in contact"), "{said}");
    // Neither branch has one: no baseline is made up.
    let attached: Vec<_> = cut.iter().filter(|(x, _, back)| *back || *x >= 0.0).copied().collect();
    let found = taken(&attached, &Asked::default()).unwrap();
    assert!(found.baseline.is_none() && parts(&found).iter().all(|part| part[2] == 0), "{:?}", parts(&found));
}

#[test]
fn rows_in_which_x_stands_still_at_the_turn_are_a_pause() {
    let row = |time: usize, x: f64, force: f64| format!("{time},{x},{force}\n");
    let held = |rows: usize| {
        let up = (0..60).map(|i| row(i, 0.1 * i as f64 - 3.0, (0.1 * i as f64 - 3.0).max(0.0)));
        let hold = (0..rows).map(|i| row(60 + i, 3.0, 3.0 - 0.001 * i as f64));
        let down = (0..80).map(|i| {
            row(60 + rows + i, 3.0 - 0.1 * i as f64, if i < 40 { 3.0 - 0.1 * i as f64 } else { 0.0 })
        });
        let text = up.chain(hold).chain(down).collect::<String>();
        let measured =
            parse(format!("time,approach,force\n{text}").as_bytes(), &ColumnSpec::default()).unwrap();
        measured.points(&UnitSystem::Reduced, None).unwrap().branches(&Asked::default()).unwrap()
    };
    let paused = held(30);
    assert_eq!((paused.rows, paused.pauses), ([60, 80], 30), "{:?}", paused.notes);
    assert!(
        paused.notes.iter().any(|note| note.contains("30 rows in which x stands still")),
        "{:?}",
        paused.notes
    );
    // A few rows at the turn are no pause.
    assert_eq!(held(3).pauses, 0);
}

#[test]
fn on_waves_the_bodies_are_apart_behind_the_last_jump_and_not_the_highest() {
    // An approach that jumps into contact, rises, and jumps again, by more.
    let force = |i: usize| match i {
        0..100 => 0.0,
        100..130 => -16.0 + 0.4 * (i - 100) as f64,
        _ => -28.0 + 0.5 * (i - 130) as f64,
    };
    let mut random = SplitMix64::new(4);
    let rows = (0..260).map(|i| format!("{},{}\n", 0.1 * i as f64, force(i) + 0.2 * random.unit()));
    let text = format!("approach,force\n{}", rows.collect::<String>());
    let found = branches(&text).unwrap();
    let [approach] = &found.list[..] else { panic!("{:?}", found.list) };
    assert!(approach.free.len() >= 95 && approach.free.len() <= 100, "{}", approach.free.len());
    assert!(approach.attached.len() >= 158, "{}", approach.attached.len());
}
