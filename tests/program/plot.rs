//! Figures for print: every view is a valid document with the expected contents, whatever the problem.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

use assert_cmd::Command;
use std::path::Path;

fn pulloff(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::cargo_bin("pulloff").unwrap();
    command.current_dir(folder).env("HOME", folder).env("XDG_CONFIG_HOME", folder).args(arguments);
    command.output().unwrap()
}

fn svg(folder: &Path, arguments: &[&str]) -> String {
    let output = pulloff(folder, &[&["plot"], arguments].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The elements of a document with the names of their attributes, and its texts: its structure without its numbers.
fn structure(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let elements = document.descendants().filter(roxmltree::Node::is_element);
    let mut lines: Vec<String> = Vec::new();
    for element in elements {
        let dash =
            element.attribute("stroke-dasharray").map_or(String::new(), |dash| format!(" dash {dash}"));
        let text = element.text().filter(|text| !text.trim().is_empty()).unwrap_or_default();
        let is_number = text.chars().all(|c| c.is_ascii_digit() || "−.×⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c));
        let text = if text.is_empty() || is_number { String::new() } else { format!(" {text:?}") };
        let line = format!("{}{dash}{text}", element.tag_name().name());
        if lines.last() != Some(&line) {
            lines.push(line);
        }
    }
    lines
}

const VIEWS: [&str; 7] =
    ["force-approach", "force-radius", "radius-approach", "pressure", "gap", "energy", "unloading"];

#[test]
fn every_view_is_a_document_of_one_column_with_its_axes() {
    let folder = tempfile::tempdir().unwrap();
    for view in VIEWS {
        let svg = svg(folder.path(), &["wavy-sphere", "--view", view, "--theory"]);
        assert!(svg.starts_with("<svg ") && svg.contains(r#"width="86mm""#), "{view}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{view}");
        insta::assert_snapshot!(format!("plot_{view}"), structure(&svg).join("\n"));
    }
}

#[test]
fn every_shipped_preset_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    for preset in pulloff::store::shipped::SHIPPED {
        for view in ["force-radius", "pressure"] {
            let svg = svg(folder.path(), &[preset.name, "--view", view]);
            roxmltree::Document::parse(&svg).unwrap();
        }
    }
}

#[test]
fn an_si_preset_has_units_beside_its_axes() {
    let folder = tempfile::tempdir().unwrap();
    let svg = svg(folder.path(), &["fig-9-si", "--raw", "--view", "force-radius"]);
    let texts = structure(&svg).join("\n");
    assert!(texts.contains("\"P (") && texts.contains("\"s ("), "{texts}");
}

#[test]
fn data_beside_a_figure_are_the_points_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let output =
        pulloff(folder.path(), &["plot", "fig-3-jkr", "--data", "-o", "jkr.svg", "--width", "two-columns"]);
    assert!(output.status.success());
    assert!(std::fs::read_to_string(folder.path().join("jkr.svg")).unwrap().contains(r#"width="178mm""#));
    let text = std::fs::read_to_string(folder.path().join("jkr.csv")).unwrap();
    assert_eq!(text.lines().next().unwrap(), "name,curve,δ/R,P/Pc");
    let least = text
        .lines()
        .filter(|line| line.starts_with("stable") || line.starts_with("unstable"))
        .map(|line| line.rsplit(',').next().unwrap().parse::<f64>().unwrap())
        .fold(f64::INFINITY, f64::min);
    // The pull-off force of the smooth sphere is P_c; 200 rings reproduce it to a part in a thousand.
    assert!((least + 1.0).abs() < 3e-3, "{least}");
}

#[test]
fn what_cannot_be_drawn_is_refused_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (&["-o", "a.gif"][..], "ends in .svg or .png"),
        #[cfg(not(feature = "pdf"))]
        (&["-o", "a.pdf"][..], "this build cannot write PDF (feature `pdf` is off); use .svg"),
        (&["--width", "3"], "from 50 to 500 mm"),
        (&["--contact-radius", "0.2"], "shows the whole curve"),
        (&["--view", "gap", "--contact-radius", "7"], "outside the curve"),
        (&["--view", "gap", "--contact-radius", "3 N"], "--contact-radius: the problem is in reduced units"),
        (&["--view", "gap", "--contact-radius", "wide"], "--contact-radius: must be a number"),
        (
            &["fig-9-si", "--set", "basis.rings=20", "--view", "gap", "--contact-radius", "3 N"],
            "--contact-radius: expected a length such as um, got 3 N, a force",
        ),
        (
            &["fig-9-si", "--set", "basis.rings=20", "--view", "gap", "--contact-radius", "3"],
            "--contact-radius = 3e6 um is outside the curve, which goes from 10 um to 2500 um",
        ),
        (&["--data"], "--output <FILE>"),
    ] {
        let output = pulloff(folder.path(), &[&["plot"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// The status and the message.
fn refused(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = pulloff(folder, &[&["plot"], arguments].concat());
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_figure_and_its_data_replace_nothing_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let with_data = ["fig-3-jkr", "--data", "-o", "jkr.svg"];
    std::fs::write(file("jkr.csv"), "r,h\n0,0\n").unwrap();
    let (status, said) = refused(folder.path(), &with_data);
    assert!(status == Some(2) && said.contains("--data jkr.csv: already exists; --overwrite"), "{said}");
    assert_eq!(std::fs::read_to_string(file("jkr.csv")).unwrap(), "r,h\n0,0\n");
    assert!(!file("jkr.svg").exists(), "nothing is drawn before");
    // Without --data, that file is none of our business.
    assert_eq!(refused(folder.path(), &["fig-3-jkr", "-o", "jkr.svg"]).0, Some(0));
    let (status, said) = refused(folder.path(), &with_data);
    assert!(status == Some(2) && said.contains("-o jkr.svg: already exists; --overwrite"), "{said}");
    assert_eq!(refused(folder.path(), &[&with_data[..], &["--overwrite"]].concat()).0, Some(0));
    assert!(std::fs::read_to_string(file("jkr.csv")).unwrap().starts_with("name,curve,"));
    let (status, said) = refused(folder.path(), &["fig-3-jkr", "--data", "-o", "-"]);
    assert!(status == Some(2) && said.contains("--data: the data go beside the figure's file"), "{said}");
    std::fs::create_dir(file("folder.csv")).unwrap();
    let (status, said) = refused(folder.path(), &["fig-3-jkr", "--data", "-o", "folder.svg"]);
    assert!(
        status == Some(2) && said.contains("not a regular file") && !file("folder.svg").exists(),
        "{said}"
    );
}

#[test]
fn neither_the_figure_nor_its_data_replace_what_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let rows: Vec<String> = (0..=100).map(|i| format!("{},{}", 2 * i, f64::from(2 * i * i) / 1e3)).collect();
    let rows = rows.join("\n");
    std::fs::write(file("rows.csv"), format!("r,h\n{rows}")).unwrap();
    let preset = pulloff(folder.path(), &["presets", "show", "profile"]).stdout;
    let preset = String::from_utf8(preset).unwrap();
    let line = preset.lines().find(|line| line.trim_start().starts_with("file = ")).unwrap();
    std::fs::write(file("mine.toml"), preset.replace(line, "file = \"rows.csv\"")).unwrap();
    let (status, said) = refused(folder.path(), &["./mine.toml", "--data", "-o", "rows.svg", "--overwrite"]);
    assert!(status == Some(2) && said.contains("is also read, as the profile"), "{said}");
    assert!(!file("rows.svg").exists());
    std::os::unix::fs::symlink("mine.toml", file("mine.svg")).unwrap();
    let (status, said) = refused(folder.path(), &["./mine.toml", "-o", "mine.svg", "--overwrite"]);
    assert!(
        status == Some(2) && said.contains("-o ") && said.contains("is also read, as the preset"),
        "{said}"
    );
}

#[test]
fn a_range_of_an_axis_is_shown_in_its_own_units() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |range: &[&str]| {
        let output =
            pulloff(folder.path(), &[&["plot", "wavy-sphere", "--view", "force-radius"], range].concat());
        assert!(output.status.success(), "{range:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let ticks = |svg: &str| -> Vec<f64> {
        let document = roxmltree::Document::parse(svg).unwrap();
        let texts = document.descendants().filter_map(|node| node.text());
        texts.filter_map(|text| text.trim().replace('−', "-").parse().ok()).collect()
    };
    let whole = ticks(&drawn(&[]));
    let part = ticks(&drawn(&["--y", "-1..-0.5", "--x=2..4"]));
    assert!(whole.iter().any(|tick| *tick > 4.0), "{whole:?}");
    assert!(part.iter().all(|tick| (-1.0..=-0.5).contains(tick) || (2.0..=4.0).contains(tick)), "{part:?}");
    assert!(part.contains(&-1.0) && part.contains(&4.0), "{part:?}");
    let lower = ticks(&drawn(&["--y", "..1"]));
    assert!(lower.iter().all(|tick| *tick <= 1.0 || whole.contains(tick)), "{lower:?}");
    // Every view has ranges.
    for view in VIEWS {
        let both = ["wavy-sphere", "--view", view, "--x=0.0..", "--y=..1e3"];
        roxmltree::Document::parse(&svg(folder.path(), &both)).unwrap();
    }
    for (range, words) in [
        (&["--x", "1"][..], "expected LO..HI, two numbers in the units of the axis"),
        (&["--x", "0.02..0.0200001"], "--x <LO..HI>': the range is too narrow to draw"),
        (&["--y", "0.9999999..1"], "it must be at least 0.0001 wide"),
        (&["--x", "2..1"], "a number up to a larger one, not from 2 to 1"),
        (&["--y", "1000.."], "--y 1000..: shows none of the figure, where P/Pc goes from "),
    ] {
        let (status, said) = refused(folder.path(), range);
        assert!(status == Some(2) && said.contains(words), "{range:?}: {said}");
    }
}

#[test]
fn a_contact_radius_is_read_as_set_reads_it() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |preset: &str, radius: &str| {
        let output = pulloff(
            folder.path(),
            &["plot", preset, "--set", "basis.rings=20", "--view", "gap", "--contact-radius", radius],
        );
        assert!(output.status.success(), "{radius}: {}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let in_metres = drawn("fig-9-si", "1.25e-3");
    assert_eq!(drawn("fig-9-si", "1.25 mm"), in_metres);
    assert_eq!(drawn("fig-9-si", "(1+1/4)mm"), in_metres);
    assert_ne!(drawn("fig-9-si", "1 mm"), in_metres);
    assert_ne!(drawn("fig-9", "0.2"), drawn("fig-9", "1/4"));
}

#[test]
#[cfg(feature = "png")]
fn a_png_has_the_size_of_the_figure_and_letters() {
    let folder = tempfile::tempdir().unwrap();
    let output = pulloff(folder.path(), &["plot", "fig-3-jkr", "-o", "jkr.png"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bytes = std::fs::read(folder.path().join("jkr.png")).unwrap();
    let pixels = resvg::tiny_skia::Pixmap::decode_png(&bytes).unwrap();
    // 86 mm at 384 dots an inch.
    assert_eq!(pixels.width(), 1301);
    // Pixels per metre in both directions, and the unit, metres.
    let chunk = bytes.windows(4).position(|name| name == b"pHYs").unwrap() + 4;
    assert_eq!(bytes[chunk..chunk + 9], [0, 0, 0x3b, 0x0e, 0, 0, 0x3b, 0x0e, 1]);
    let millimetres = 1301.0 / f64::from(0x3b0e_u16) * 1e3;
    assert!((millimetres - 86.0).abs() < 25.4 / 384.0, "{millimetres}");
    // Something is drawn at the far left, where the axis title is, so letters are drawn.
    let dark = |x: u32| (0..pixels.height()).any(|y| pixels.pixel(x, y).unwrap().red() < 80);
    assert!((0..100).any(dark));
}

#[test]
#[cfg(feature = "png")]
fn every_view_is_a_png_too() {
    let folder = tempfile::tempdir().unwrap();
    for view in VIEWS {
        let output =
            pulloff(folder.path(), &["plot", "fig-3-jkr", "--view", view, "-o", "view.png", "--overwrite"]);
        assert!(output.status.success(), "{view}: {}", String::from_utf8_lossy(&output.stderr));
        let bytes = std::fs::read(folder.path().join("view.png")).unwrap();
        let pixels = resvg::tiny_skia::Pixmap::decode_png(&bytes).unwrap();
        let dark = pixels.pixels().iter().filter(|pixel| pixel.red() < 80).count();
        assert!(pixels.width() == 1301 && dark > 1000, "{view}: {dark} dark pixels");
    }
}

#[test]
fn the_figures_of_the_paper_agree_with_theory() {
    let folder = tempfile::tempdir().unwrap();
    let output = pulloff(folder.path(), &["figures", "-o", "all"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let captions = std::fs::read_to_string(folder.path().join("all/captions.md")).unwrap();
    for name in [
        "fig-1",
        "fig-2a",
        "fig-2b",
        "fig-3",
        "fig-4a",
        "fig-4b",
        "fig-5",
        "fig-7a",
        "fig-7b",
        "fig-8a",
        "fig-8b",
        "fig-9a",
        "fig-9b",
        "fig-10a",
        "fig-10b",
        "rate",
        "range-loss",
        "range-pull",
    ] {
        assert!(captions.contains(&format!("**{name}.**")), "{name}");
        let file = |ending: &str| {
            std::fs::read_to_string(folder.path().join(format!("all/{name}.{ending}"))).unwrap()
        };
        roxmltree::Document::parse(&file("svg")).unwrap();
        assert!(file("csv").lines().count() > 8, "{name}");
    }
    // 200 rings on the curves of Fig. 2 to 9: within three thousandths of the picture.
    let apart: Vec<f64> = captions
        .split("nowhere further from it than ")
        .skip(1)
        .map(|rest| rest.split(' ').next().unwrap().parse().unwrap())
        .collect();
    // The pull of the sphere is Maugis', and the waves of Fig. 9 break up into rings below λ_M = 2.9.
    let after = |words: &str| {
        captions.split(words).nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    assert!(after("closed form (dots) by at most ") < 1e-9, "{captions}");
    assert!((2.92..3.4).contains(&after("For the waves of Fig. 9 λ_M = ")), "{captions}");
    assert_eq!(apart.len(), 8);
    assert!(apart.iter().all(|share| *share < 3e-3), "{apart:?}");
}

#[test]
fn a_sweep_over_two_axes_is_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let spec = "preset = \"wavy-sphere\"\nquantities = [\"enhancement\", \"snaps\"]\n\
        [[axis]]\nkey = \"groups.amplitude_over_wavelength\"\nlinear = { from = 0.01, to = 0.05, count = 4 }\n\
        [[axis]]\nkey = \"groups.adhesion\"\nlogarithmic = { from = 0.01, to = 0.2, count = 4 }\n";
    std::fs::write(folder.path().join("map.toml"), spec).unwrap();
    let output = pulloff(folder.path(), &["sweep", "map.toml", "-o", "map.csv"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && said.contains("pulloff plot --sweep"), "{said}");
    let svg = svg(folder.path(), &["--sweep", "map.csv"]);
    let texts = structure(&svg).join("\n");
    for word in ["A/λ", "γ'", "enhancement"] {
        assert!(texts.contains(word), "{word}: {texts}");
    }
    let refused = pulloff(folder.path(), &["plot", "--sweep", "map.csv", "--quantity", "snps"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("did you mean snaps?"));
}

#[test]
fn a_sweep_over_one_axis_is_a_curve_with_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let spec = "preset = \"fig-9-si\"\nquantities = [\"kesari_lew\"]\n\
        set = [\"basis.kind=exact\", \"path.start_contact_radius=1 mm\"]\n\
        [[axis]]\nkey = \"gap.amplitude\"\nvalues = [\"3 um\", \"1 um\", \"2 um\", \"2.5 um\", \"4 um\"]\n";
    std::fs::write(folder.path().join("s.toml"), spec).unwrap();
    let output = pulloff(folder.path(), &["sweep", "s.toml", "-o", "r.csv"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("plot --sweep 'r.csv' --quantity kesari_lew -o curve.svg"), "{said}");
    // Its data are beside it, as for any figure.
    let with_data = ["plot", "--sweep", "r.csv", "--quantity", "kesari_lew", "--data", "-o", "p.svg"];
    assert!(pulloff(folder.path(), &with_data).status.success());
    let data = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    assert!(data.starts_with("name,curve,") && data.lines().count() > 5, "{data}");
    let shapes = |svg: &str| {
        let document = roxmltree::Document::parse(svg).unwrap();
        let count = |tag: &str| document.descendants().filter(|node| node.has_tag_name(tag)).count();
        (count("circle"), count("path"))
    };
    let whole = svg(folder.path(), &["--sweep", "r.csv", "--quantity", "kesari_lew"]);
    let texts = structure(&whole).join("\n");
    assert!(texts.contains("\"amplitude of the wave, A (µm)") && texts.contains("\"kesari lew, "), "{texts}");
    assert_eq!(shapes(&whole).0, 5);
    // A row without a value: its mark is missing and the line is split in two.
    let path = folder.path().join("r.csv");
    let results = std::fs::read_to_string(&path).unwrap();
    let row = results.lines().find(|line| line.starts_with("3,")).unwrap();
    let fields: Vec<&str> = row.split(',').collect();
    let empty = [fields[0], fields[1], "", "start not reached"].join(",");
    std::fs::write(&path, results.replace(row, &empty)).unwrap();
    let gap = svg(folder.path(), &["--sweep", "r.csv", "--quantity", "kesari_lew"]);
    assert_eq!(shapes(&gap), (4, shapes(&whole).1 + 1));
    for (column, words) in [
        ("error", "error = \"start not reached\" is not a number"),
        ("kesari_low", "did you mean kesari_lew?"),
    ] {
        let (status, said) = refused(folder.path(), &["--sweep", "r.csv", "--quantity", column]);
        assert!(status == Some(2) && said.contains(words), "{column}: {said}");
    }
    for (column, words) in [("gap.amplitude", "is an axis of the sweep"), ("row", "numbers the rows")] {
        let (status, said) = refused(folder.path(), &["--sweep", "r.csv", "--quantity", column]);
        let words = format!("--quantity {column}: {words}; choose one of kesari_lew");
        assert!(status == Some(2) && said.contains(&words), "{said}");
    }
    std::fs::write(&path, &results).unwrap();
    let (status, said) = refused(folder.path(), &["--sweep", "r.csv", "--quantity", "error"]);
    assert!(status == Some(2) && said.contains("the column error is empty in every row"), "{said}");
}

#[test]
fn a_part_of_a_sweep_is_drawn_and_said_to_be_one() {
    let folder = tempfile::tempdir().unwrap();
    let spec = "preset = \"wavy-sphere\"\nquantities = [\"kesari_lew\"]\n[[axis]]\nkey = \"gap.amplitude\"\n\
                linear = { from = 1e-3, to = 2e-3, count = 8 }\n";
    std::fs::write(folder.path().join("s.toml"), spec).unwrap();
    for (shard, expected) in [
        (
            "1/4",
            "warning: --sweep r.csv: has 2 of the 8 rows of the sweep (shard 1/4): the figure shows no others\n",
        ),
        ("1/1", ""),
    ] {
        let sweep = ["sweep", "s.toml", "-o", "r.csv", "--shard", shard, "--overwrite", "-q"];
        assert!(pulloff(folder.path(), &sweep).status.success());
        let output = pulloff(folder.path(), &["plot", "--sweep", "r.csv", "-o", "r.svg", "--overwrite"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success() && said.contains(expected) && said.is_empty() == expected.is_empty(),
            "{said}"
        );
    }
}

#[test]
fn the_only_quantity_of_a_sweep_is_drawn_and_of_several_one_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = |quantities: &str| {
        let spec = format!(
            "preset = \"fig-9-si\"\nquantities = [{quantities}]\n[[axis]]\nkey = \"A\"\nvalues = [\"1 um\", \"2 um\"]\n"
        );
        std::fs::write(folder.path().join("s.toml"), spec).unwrap();
        let output = pulloff(folder.path(), &["sweep", "s.toml", "-o", "r.csv", "--overwrite"]);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let said = sweep("\"largest_pull_force\"");
    assert!(
        said.contains("note: units of the columns: gap.amplitude in m; largest_pull_force in N\n"),
        "{said}"
    );
    assert!(structure(&svg(folder.path(), &["--sweep", "r.csv"])).join("\n").contains("largest pull force"));
    sweep("\"largest_pull_force\", \"snap_loss\"");
    let (status, said) = refused(folder.path(), &["--sweep", "r.csv"]);
    assert!(
        status == Some(2) && said.contains("choose with --quantity one of largest_pull_force, snap_loss"),
        "{said}"
    );
}

#[test]
fn a_column_is_of_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [&["--quantity", "snaps"][..], &["wavy-sphere", "--quantity", "snaps"]] {
        let (status, said) = refused(folder.path(), arguments);
        assert!(status == Some(2) && said.contains("--quantity: is a column of a sweep's results"), "{said}");
    }
}
