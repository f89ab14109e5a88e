//! Forms in which instruments, their programs and spreadsheets export curves. Each can be read at once, or with the one
//! option that its error message names, and yields the numbers that were written.

mod makers;
mod programs;

use crate::gap::shapes::split_mix::SplitMix64;
use crate::measured::role::ColumnSpec;
use crate::measured::{Abscissa, ColumnRole, CurveReadError, Measured, Segment, columns, parse};
use crate::units::{DisplayUnits, UnitSystem};
use std::fmt::Write;

/// x in nm and P in nN, down to contact and back.
fn rows() -> Vec<[f64; 2]> {
    let down = (0..10).map(|i| [f64::from(i) * 12.5 - 50.0, f64::from(i * i) * 0.25]);
    let up = (0..10).rev().map(|i| [f64::from(i) * 12.5 - 62.5, f64::from(i * i) * 0.25 - 3.5]);
    down.chain(up).collect()
}

/// Ten rows of a branch.
fn half(retraction: bool) -> Vec<[f64; 2]> {
    let rows = rows();
    if retraction { rows[10..].to_vec() } else { rows[..10].to_vec() }
}

/// Rows as lines; `write` makes the cells of x and P.
fn lines(rows: &[[f64; 2]], write: impl Fn(usize, f64, f64) -> String) -> String {
    rows.iter().enumerate().fold(String::new(), |mut text, (i, [x, p])| {
        writeln!(text, "{}", write(i, *x, *p)).unwrap();
        text
    })
}

/// x and P with this separator, each scaled.
fn two(separator: &str, x: f64, p: f64) -> String {
    lines(&rows(), |_, a, b| format!("{:e}{separator}{:e}", a * x, b * p))
}

/// A number as a German spreadsheet writes it.
fn comma(number: f64) -> String {
    format!("{number}").replace('.', ",")
}

/// A form: its name, its bytes, the option, and the expected result.
struct FileForm {
    name: &'static str,
    bytes: Vec<u8>,
    /// The option that its error message names, as a user would fill it in.
    option: &'static str,
    abscissa: Abscissa,
    stiffness: Option<f64>,
    radius: Option<f64>,
    /// How many rows belong to each branch, if any do.
    segments: Option<[usize; 2]>,
    skipped: usize,
    /// What the notes must contain.
    says: &'static str,
}

fn form(name: &'static str, text: impl Into<Vec<u8>>) -> FileForm {
    FileForm {
        name,
        bytes: text.into(),
        option: "",
        abscissa: Abscissa::Approach,
        stiffness: None,
        radius: None,
        segments: None,
        skipped: 0,
        says: "",
    }
}

impl FileForm {
    fn over(self, abscissa: Abscissa) -> Self {
        Self { abscissa, ..self }
    }

    fn position(self) -> Self {
        self.over(Abscissa::Position)
    }

    fn after(self, option: &'static str) -> Self {
        Self { option, ..self }
    }

    fn spring(self, stiffness: f64) -> Self {
        Self { stiffness: Some(stiffness), ..self }
    }

    fn tip(self, radius: f64) -> Self {
        Self { radius: Some(radius), ..self }
    }

    fn halves(self) -> Self {
        Self { segments: Some([10, 10]), ..self }
    }

    fn over_segments(self, segments: [usize; 2]) -> Self {
        Self { segments: Some(segments), ..self }
    }

    fn without(self, skipped: usize) -> Self {
        Self { skipped, ..self }
    }

    fn says(self, says: &'static str) -> Self {
        Self { says, ..self }
    }

    /// Reads it and compares every number.
    fn check(&self) {
        let name = self.name;
        let mut read = parse(&self.bytes, &ColumnSpec::default());
        if !self.option.is_empty() {
            let refusal = read.expect_err(name).to_string();
            assert!(refusal.contains("data.columns \"approach=1,force=2\""), "{name}: {refusal}");
            assert!(columns(&self.bytes).unwrap().len() > 1, "{name}");
            read = parse(&self.bytes, &ColumnSpec::parse(self.option).unwrap());
        }
        let read = read.unwrap_or_else(|error| panic!("{name}: {error}"));
        let points = read.points(&UnitSystem::Si(DisplayUnits::default()), Some(1.0));
        let points = points.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(points.abscissa, self.abscissa, "{name}: {:?}", read.notes);
        let expected = rows();
        assert_eq!(points.x.len(), expected.len(), "{name}: {:?}", read.notes);
        for (i, [x, p]) in expected.iter().enumerate() {
            let x = if self.abscissa == Abscissa::Radius { x + 75.0 } else { *x };
            let off = [points.x[i] - 1e-9 * x, points.force[i] - 1e-9 * p];
            assert!(off[0].abs() < 1e-16 && off[1].abs() < 1e-16, "{name}: row {i} is off by {off:?}");
        }
        let near =
            |stated: Option<super::stated::StatedValue>, expected: Option<f64>| match (stated, expected) {
                (Some(stated), Some(expected)) => (stated.value / expected - 1.0).abs() < 1e-12,
                (stated, expected) => stated.is_none() && expected.is_none(),
            };
        assert!(near(read.stiffness, self.stiffness), "{name}: {:?}", read.stiffness);
        assert!(near(read.radius, self.radius), "{name}: {:?}", read.radius);
        let counted = read.segments.as_ref().map(|segments| {
            [Segment::Approach, Segment::Retraction].map(|of| segments.iter().filter(|s| **s == of).count())
        });
        assert_eq!(counted, self.segments, "{name}");
        assert_eq!(read.skipped, self.skipped, "{name}: {:?}", read.notes);
        assert!(read.notes.join("; ").contains(self.says), "{name}: {:?}", read.notes);
    }
}

fn utf_16(text: &str, of: fn(u16) -> [u8; 2], mark: &[u8]) -> Vec<u8> {
    mark.iter().copied().chain(text.encode_utf16().flat_map(of)).collect()
}

fn western(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect()
}

/// All forms.
fn all() -> Vec<FileForm> {
    let makers = [makers::of_microscopes(), makers::of_igor(), makers::of_indenters(), makers::of_testers()];
    let programs = [programs::of_spreadsheets(), programs::of_own_programs()];
    makers.into_iter().chain(programs).flatten().collect()
}

#[test]
fn every_form_is_read_at_once_or_after_the_option_that_is_named() {
    let forms = all();
    assert!(forms.len() >= 50, "{}", forms.len());
    for form in &forms {
        form.check();
    }
}

#[test]
fn damage_is_read_or_refused_in_a_sentence_and_columns_stay_alike() {
    let mut random = SplitMix64::new(11);
    for form in all() {
        for _ in 0..20 {
            let mut bytes = form.bytes.clone();
            for _ in 0..4 {
                let bits = random.bits();
                let at = usize::try_from(bits >> 16).unwrap() % bytes.len();
                match bits % 4 {
                    0 => bytes[at] = bits.to_le_bytes()[1],
                    1 => bytes[at] = b",;\t \n.-#"[usize::try_from(bits >> 8).unwrap() % 8],
                    2 => drop(bytes.remove(at)),
                    _ => bytes.insert(at, b"0\n;,x\"[\r"[usize::try_from(bits >> 8).unwrap() % 8]),
                }
            }
            for option in ["", "x=1,force=2"] {
                match parse(&bytes, &ColumnSpec::parse(option).unwrap()) {
                    Err(error) => {
                        let text = error.to_string();
                        assert!(
                            !text.chars().any(|c| c != '\n' && crate::text::is_unsafe(c)),
                            "{}: {text:?}",
                            form.name
                        );
                    }
                    Ok(read) => {
                        let rows = read.columns[0].values.len();
                        assert!(
                            read.columns.iter().all(|column| column.values.len() == rows),
                            "{}",
                            form.name
                        );
                        assert!(read.segments.is_none_or(|segments| segments.len() == rows), "{}", form.name);
                    }
                }
            }
            let _ = columns(&bytes);
        }
    }
}

fn refused(bytes: &[u8]) -> String {
    parse(bytes, &ColumnSpec::default()).expect_err("it is refused").to_string()
}

#[test]
fn what_cannot_be_read_is_refused_in_a_sentence() {
    let good = "indentation (nm),force (nN)\n".to_owned() + &two(",", 1.0, 1.0);
    let cut = &good[..good.len() - 8];
    let head = "indentation (nm);force (nN)\n";
    let body = two(";", 1.0, 1.0);
    for (what, bytes, expected) in [
        ("a line that is cut", format!("{good}-4.5"), "line 22: has 1 cells, and the first row has 2"),
        ("separators of two kinds", format!("{good}1;2\n3;4\n"), "line 22: "),
        (
            "a million columns",
            format!("{good}{}", "1,".repeat(1_000_000)),
            "line 22: has 2000000 bytes, more than the 2048",
        ),
        ("many columns", "1,".repeat(100) + "\n", "has 101 columns; at most 64 are read"),
        ("zero bytes", format!("{good}1,\0\n"), "line 22: holds a zero byte"),
        ("a ZIP archive", "PK\u{3}\u{4}\0\0".to_owned(), "pulloff.read_afm(path)"),
        ("controls", format!("{good}1,\u{7}2\n"), "line 22: holds control or invisible characters"),
        (
            "points and commas",
            format!("{head}{body}1,5;2\n"),
            "\"1,5\" has a comma, and line 3 has a number with a point",
        ),
        ("thousands", format!("{head}{body}1.234,5;2\n"), "\"1.234,5\" has more than one comma or point"),
        ("commas that part all", "0,5, 1,5\n".repeat(20), "line 1: some commas are followed by a space"),
        (
            "volts alone",
            format!("Z (nm);Deflection (V)\n{body}"),
            "column 2, \"Deflection\", is the deflection in V, and the sensitivity",
        ),
        ("volts in a name", format!("Z_nm;Defl_V\n{body}"), "column 2, \"Defl_V\", is the deflection in V"),
        (
            "another unit",
            format!("Z (nN);Force (nN)\n{body}"),
            "the unit \"nN\" of position is not a unit of length",
        ),
        (
            "waves of other curves",
            "IGOR\nWAVES Z\nBEGIN\n1\n2\nEND\nWAVES F\nBEGIN\n1\nEND\n".to_owned(),
            "waves have 1 to 2 rows",
        ),
        ("nothing but words", "a\nb c\n".to_owned(), "has 0 rows"),
        (
            "no numbers at all",
            format!("{head}{}", "1;NaN\n".repeat(30)),
            "has 0 rows of numbers besides 30 without a number",
        ),
        (
            "a first row with a fault",
            format!("{head}x1;2\n{body}"),
            "line 2: column 1: the approach \"x1\" is not a number",
        ),
        (
            "words among rows",
            format!("{head}{body}oops;2\n{body}"),
            "line 22: column 1: the approach \"oops\" is not a number",
        ),
    ] {
        let message = refused(bytes.as_bytes());
        assert!(message.contains(expected), "{what}: {message}");
        assert!(
            message.len() < 400 && !message.chars().any(|c| c != '\n' && crate::text::is_unsafe(c)),
            "{what}: {message}"
        );
    }
    // A truncated number is unreadable or a different number; the rows before it remain.
    assert!(
        parse(cut.as_bytes(), &ColumnSpec::default()).is_ok()
            || refused(cut.as_bytes()).starts_with("line 21")
    );
    assert!(matches!(parse(b"\xff\xfe1\x00\n", &ColumnSpec::default()), Err(CurveReadError::NotText(_))));
}

#[test]
fn columns_are_listed_with_their_first_values() {
    let text = "u1 [nm];u2;Force (nN)\n1,5;2;x y\n2,5;3;4\n3;4;5\n9;9;9\n";
    let seen = columns(text.as_bytes()).unwrap();
    let names: Vec<(&str, Option<&str>)> =
        seen.iter().map(|seen| (&*seen.name, seen.unit.as_deref())).collect();
    assert_eq!(names, [("u1", Some("nm")), ("u2", None), ("Force", Some("nN"))]);
    assert_eq!(seen[0].first, ["1,5", "2,5", "3"]);
    assert_eq!(seen[2].role, Some(ColumnRole::Force));
    assert!(columns(b"words\n").is_err());
}

/// The stiffness that a file states, unless it is 1, which means that it was not calibrated.
fn stated(line: &str) -> Measured {
    let text = format!("{line}\nindentation (nm),force (nN)\n{}", two(",", 1.0, 1.0));
    parse(text.as_bytes(), &ColumnSpec::default()).unwrap_or_else(|error| panic!("{line}: {error}"))
}

#[test]
fn settings_are_found_in_every_usual_form() {
    for line in [
        "Force Constant, nN/nm: 0.25",
        "Spring constant [N/m];0,25",
        "\"Spring constant (N/m)\",0.25",
        "# springConstant: 0.25",
        "%k (mN/m)\t250",
        "\"\\Spring Constant: 0.25\"",
        "Cantilever spring constant = 0.25 N/m",
        "cantilever stiffness: 250 pN/nm",
        "Spring constant: 0.25N/m",
        "k = 250mN/m",
        "Spring constant: 0.25 N/m +- 0.1",
        "Spring constant: 0.25 N/m (thermal)",
        "Spring constant: 0.25 (N/m)",
        "Spring constant: 2.5e-1N/m ± 10 %",
        "Spring constant: 250 ± 10 mN/m",
        "Spring constant: 250 ± 5 % mN/m",
        "springConstant: 250 (+- 10) mN/m",
        "Spring constant: 250;mN/m",
    ] {
        let found = stated(line).stiffness.unwrap_or_else(|| panic!("{line}"));
        assert!((found.value - 0.25).abs() < 1e-12, "{line}: {found:?}");
    }
    for line in [
        "Tip radius (um)\t2.5",
        "Sphere diameter: 5 um",
        "# indenter radius = 2500 nm",
        "R [um]: 2,5",
        "Tip radius: 2.5um",
        "Tip radius: 2500nm (nominal)",
        "Tip radius: 2.5 um; range of the piezo 100 um",
    ] {
        let found = stated(line).radius.unwrap_or_else(|| panic!("{line}"));
        assert!((found.value - 2.5e-6).abs() < 1e-15, "{line}: {found:?}");
    }
    let sentence = stated("R = 1 mm, E* = 1 MPa, work of adhesion 50 mJ/m^2");
    assert!(sentence.radius.is_some_and(|found| (found.value - 1e-3).abs() < 1e-15), "{:?}", sentence.notes);
    let uncalibrated = stated("Spring constant (N/m): 1.0");
    assert!(uncalibrated.stiffness.is_none() && uncalibrated.notes[0].contains("uncalibrated"));
    let unknown = stated("Tip radius: 20");
    assert!(
        unknown.radius.is_none() && unknown.notes[0].contains("without a known unit"),
        "{:?}",
        unknown.notes
    );
    for line in
        ["Tip radius: < 25 um", "Tip radius: 20 um (max), 10 um (min)", "Tip radius: 25 um (diameter)"]
    {
        let bound = stated(line);
        assert!(
            bound.radius.is_none() && bound.notes[0].contains("no single value"),
            "{line}: {:?}",
            bound.notes
        );
    }
    let two = stated("k (N/m)\t0.25\nk (N/m)\t0.5");
    assert!(two.stiffness.is_some() && two.notes[0].contains("two springs"), "{:?}", two.notes);
    // A rounded value does not contradict.
    let rounded = stated("k (N/m)\t0.25").stiffness.unwrap();
    assert!(rounded.is(0.2541) && !rounded.is(0.26));
}

/// A second table with other units below the first is refused, whichever way they are written.
#[test]
fn tables_that_continue_each_other_have_the_same_units() {
    let [down, up] = [false, true].map(|is_up| lines(&half(is_up), |_, x, p| format!("{x:?},{p:?}")));
    let below = |first: &str, second: &str| {
        parse(format!("{first}\n{down}\n{second}\n{up}").as_bytes(), &ColumnSpec::default())
    };
    for (first, second, said) in [
        ("Depth [nm],Load [nN]", "Depth [nm],Load [gf]", "line 13: column 2 is in gf here and in nN before"),
        ("Depth [nm],Load [nN]", "Depth [um],Load [nN]", "line 13: column 1 is in um here and in nm before"),
        ("Depth,Load\nnm,nN", "Depth,Load\num,nN", "column 1 is in um here and in nm before"),
        ("Depth,Load", "Depth [um],Load [nN]", "column 1 is in um here and in no unit before"),
    ] {
        let refused = below(first, second).unwrap_err().to_string();
        assert!(refused.contains(said), "{first} {second}: {refused}");
    }
    for second in ["Depth [nm],Load [nN]", "Depth,Load", "Depth (nm),Load (nN)"] {
        let read = below("Depth [nm],Load [nN]", second).unwrap();
        assert_eq!(read.columns[1].values.len(), 20, "{second}");
    }
    let micro = ["Depth [um],Load [mN]", "Depth [µm],Load [mN]"];
    assert_eq!(below(micro[0], micro[1]).unwrap().columns[0].values.len(), 20);
}

#[test]
fn numbers_of_branches_are_those_of_one_convention() {
    let file = |codes: [&str; 3]| {
        let pause = lines(&[[62.5, 20.0]; 4], |_, x, p| format!("{x:?},{p:?},{}", codes[1]));
        let [down, up] = [(false, codes[0]), (true, codes[2])]
            .map(|(is_up, code)| lines(&half(is_up), |_, x, p| format!("{x:?},{p:?},{code}")));
        let pause = if codes[1].is_empty() { String::new() } else { pause };
        let text = format!("depth [nm],load [nN],segment\n{down}{pause}{up}");
        parse(text.as_bytes(), &ColumnSpec::default())
    };
    for (codes, pauses) in [(["0", "", "1"], 0), (["0", "2", "1"], 4), (["0.0", "2.0", "1.0"], 4)] {
        let segments = file(codes).unwrap().segments.unwrap();
        let count = |of| segments.iter().filter(|segment| **segment == of).count();
        let found = [Segment::Approach, Segment::Other, Segment::Retraction].map(count);
        assert_eq!(found, [10, pauses, 10], "{codes:?}");
    }
    for (codes, said) in [
        (["1", "", "2"], "line 12: column 3: which branches are numbered 1, 2 is not known"),
        (["0", "1", "2"], "line 16: column 3: which branches are numbered 0, 1, 2 is not known"),
        (["0", "", "2"], "which branches are numbered 0, 2 is not known"),
    ] {
        let refused = file(codes).unwrap_err().to_string();
        assert!(refused.contains(said) && refused.contains("--columns"), "{codes:?}: {refused}");
    }
}

#[test]
fn a_comma_that_may_separate_thousands_is_refused() {
    let file = |write: fn(f64) -> String| {
        let rows =
            lines(&half(false), |i, _, p| format!("{};{}", write(50.0 * (i + 3) as f64 + 0.95), p * 1e6));
        parse(format!("depth [nm];load [nN]\n{rows}").as_bytes(), &ColumnSpec::default())
    };
    let refused = file(|x| format!("{x:.3}").replace('.', ",")).unwrap_err().to_string();
    assert!(refused.contains("line 2: in \"150,950\", as in all numbers with a comma"), "{refused}");
    // A column that is not used tells, too.
    let beside = lines(&half(false), |i, _, p| format!("{i},5;{},950;{}", 100 + i, p * 1e6));
    parse(format!("time [s];depth [nm];load [nN]\n{beside}").as_bytes(), &ColumnSpec::default()).unwrap();
    for write in [
        |x: f64| format!("{x:.2}").replace('.', ","),
        |x: f64| format!("{:.3}", x - 300.0).replace('.', ","),
        |x: f64| format!("{:.3}", x + 500.0).replace('.', ","),
    ] {
        assert_eq!(file(write).unwrap().columns[0].values.len(), 10);
    }
}

#[test]
fn a_letter_in_brackets_is_no_other_quantity() {
    let file = |unit: &str| format!("approach [{unit}],force [nN]\n{}", two(",", 1.0, 1.0));
    for unit in ["A", "a", "S"] {
        let refused = parse(file(unit).as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
        assert!(refused.contains(&format!("the unit \"{unit}\"")), "{refused}");
    }
    assert_eq!(
        parse(file("angstrom").as_bytes(), &ColumnSpec::default()).unwrap().columns[0].role,
        ColumnRole::Approach
    );
}

#[test]
fn a_multiple_of_a_unit_is_not_the_unit() {
    let file = |header: &str| format!("{header}\n{}", two(";", 1.0, 1.0));
    for header in [
        "depth [um];Force [10 mN]",
        "depth [um];Force [10^-3 N]",
        "depth [um];Force [N*10^-3]",
        "depth [um];Force [N/1000]",
        "depth [um];Force [N (10^-3)]",
        "depth [um];Force (10^-3) N",
        "depth [um];Force [N] 10^-3",
        "depth [um];Force/10^-3 N",
        "depth [um];Force 10 mN",
        "depth [um];Force N/1000",
        "depth [um];Force [mN] *10",
        "depth [um];Force × 1000 (mN)",
        "depth [um];Force (×1000) [mN]",
        "depth [um];Force [N] (1000)",
        "depth [um];Force [mN]/10",
        "depth [0.1 um];Force [mN]",
        "depth [2 um];Force [mN]",
    ] {
        let said = refused(file(header).as_bytes());
        assert!(said.contains("line 1: the unit") && said.contains("is not a unit of"), "{header}: {said}");
    }
    // Numbers of channels and exponents are none.
    for header in [
        "depth 2 [um];Force (Ch 1) [mN]",
        "depth [um];Force 1 [mN]",
        "depth/um;Force 2 mN",
        "depth/um.1;Force/mN.1",
        "depth [um];Force / mN 1",
        "depth [um];Force Ch 10 mN",
        "depth [um];Force [mN] (1)",
        "depth [um] (9);Force [mN] (10)",
        "depth [um];Force 12/10 [mN]",
        "depth (sample 3/10) [um];Force (sample 3/10) [mN]",
        "depth [um];Force (PDMS) [mN]",
        "depth [um];Force [mN] (PDMS)",
    ] {
        let measured = parse(file(header).as_bytes(), &ColumnSpec::default());
        let used = measured.as_ref().map(|measured| measured.used.iter().all(|used| used.has_unit));
        assert_eq!(used.map_err(ToString::to_string), Ok(true), "{header}");
    }
}

#[test]
fn a_remark_on_both_branches_is_that_of_neither() {
    let segments = |remark: &str| {
        let text = format!("# segment: {remark}\n# depth [um];force [mN]\n{}", two(";", 1.0, 1.0));
        let segments = parse(text.as_bytes(), &ColumnSpec::default()).unwrap().segments;
        segments.map(|all| {
            [Segment::Approach, Segment::Retraction].map(|of| all.iter().filter(|one| **one == of).count())
        })
    };
    assert_eq!(segments("approach then retract"), None);
    assert_eq!(segments("retract"), Some([0, 20]));
    assert_eq!(segments("extend in air"), Some([20, 0]));
}

#[test]
fn wide_brackets_and_units_in_one_character_are_read() {
    let file = |header: &str| format!("{header}\n{}", two(";", 1.0, 1.0));
    for header in ["depth（µm）;Force（mN）", "depth(㎛);Force(mN)", "depth\u{3000}[µm];Ｆｏｒｃｅ [mN]"]
    {
        let measured = parse(file(header).as_bytes(), &ColumnSpec::default());
        let used = measured.as_ref().map(|measured| measured.used.iter().all(|used| used.has_unit));
        assert_eq!(used.map_err(ToString::to_string), Ok(true), "{header}");
    }
}

#[test]
fn a_column_left_out_for_its_unit_is_told() {
    let rows = two(";", 1.0, 1.0).lines().fold(String::new(), |text, row| text + row + ";1\n");
    let text = format!("depth [um];Force [mN];Time [10 ms]\n{rows}");
    let notes = parse(text.as_bytes(), &ColumnSpec::default()).unwrap().notes.join("; ");
    assert!(notes.contains("\"10 ms\" of time") && notes.contains("left out"), "{notes}");
}

#[test]
fn marks_of_inches_are_no_quotation_marks() {
    let text = format!("approach 5\" tip [nm],force 3\" [nN]\n{}", two(",", 1.0, 1.0));
    let names: Vec<String> = columns(text.as_bytes()).unwrap().into_iter().map(|seen| seen.name).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(names[0].contains("tip") && names[1].contains("force"), "{names:?}");
}
