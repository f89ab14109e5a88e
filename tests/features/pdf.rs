//! Figures as PDF. Needs a build that draws them (`pdf`).
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

/// The streams of a PDF that are text.
fn streams(pdf: &[u8]) -> Vec<String> {
    let find = |from: usize, what: &[u8]| {
        pdf[from..].windows(what.len()).position(|window| window == what).map(|at| from + at)
    };
    let (mut from, mut all) = (0, Vec::new());
    while let Some(begin) = find(from, b"stream\n") {
        let begin = begin + b"stream\n".len();
        let end = find(begin, b"endstream").unwrap();
        let mut text = Vec::new();
        let mut packed = flate2::read::ZlibDecoder::new(&pdf[begin..end]);
        if std::io::Read::read_to_end(&mut packed, &mut text).is_ok() {
            all.push(String::from_utf8_lossy(&text).into_owned());
        }
        from = end + b"endstream".len();
    }
    all
}

#[test]
fn a_pdf_is_a_page_of_the_figure_with_letters_dashes_and_hatches() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("pulloff").unwrap();
        command.current_dir(folder.path()).env("HOME", folder.path()).env("XDG_CONFIG_HOME", folder.path());
        let output = command.args(["plot", "-o", "a.pdf", "--overwrite"]).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read(folder.path().join("a.pdf")).unwrap()
    };
    for (width, mm) in [("one-column", 86.0), ("two-columns", 178.0)] {
        let pdf = drawn(&["fig-9", "--view", "unloading", "--width", width]);
        let text = String::from_utf8_lossy(&pdf);
        assert!(text.starts_with("%PDF-") && text.trim_end().ends_with("%%EOF"));
        let page = text.split("/MediaBox").nth(1).and_then(|rest| rest.split(['[', ']']).nth(1)).unwrap();
        let sides: Vec<f64> = page.split_whitespace().map(|side| side.parse().unwrap()).collect();
        assert!((sides[2] - mm / 25.4 * 72.0).abs() < 0.05, "{width}: {page}");
        assert!(text.contains("DejaVuSans") && text.contains("/FontFile"), "no font");
        assert!(!text.contains("/Subtype/Image") && !text.contains("/Subtype /Image"), "pixels");
        let streams = streams(&pdf);
        let has = |words: &str| streams.iter().any(|stream| stream.contains(words));
        // The letter δ of the axis by its code, letters, dashes, and the hatching pattern.
        assert!(has("beginbfchar") && has("<03B4>") || has("<03b4>"), "no δ");
        assert!(has("TJ") || has("Tj"), "no letters");
        assert!(has("[3") || has("[2.25"), "no dashes");
        assert!(has("/Pattern cs"), "no hatches");
        // The same figure gives the same file.
        assert!(drawn(&["fig-9", "--view", "unloading", "--width", width]) == pdf);
    }
}
