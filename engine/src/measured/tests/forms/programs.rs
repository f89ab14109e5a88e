//! What spreadsheets and users' own programs write.

use super::{FileForm, comma, form, half, lines, rows, two, utf_16, western};

/// Forms of spreadsheets.
pub(super) fn of_spreadsheets() -> Vec<FileForm> {
    let german = "Weg [µm];Kraft [µN]\r\n".to_owned()
        + &lines(&rows(), |_, x, p| format!("{};{}", comma(x * 1e-3), comma(p * 1e-3))).replace('\n', "\r\n");
    let tabs = german.replace(';', "\t");
    vec![
        form("Excel, UTF-8 with its mark", format!("\u{feff}{german}")).position(),
        form("Excel, Windows-1252", western(&german)).position(),
        form("Excel, Unicode text", utf_16(&tabs, u16::to_le_bytes, b"\xff\xfe")).position(),
        form("Excel, Unicode text of a Mac", utf_16(&tabs, u16::to_be_bytes, b"\xfe\xff")).position(),
        form("UTF-16 without its mark", utf_16(&german, u16::to_le_bytes, b"")).position(),
        form("Excel, with its separator", format!("sep=;\r\n{german}")).position(),
        form("quoted numbers with decimal commas", {
            let rows = lines(&rows(), |_, x, p| format!("\"{}\",\"{}\"", comma(x), comma(p)));
            format!("\"Indentation (nm)\",\"Force (nN)\"\n{rows}")
        }),
        form("a comma within the quoted names", {
            format!("\"indentation, nm\",\"force, nN\"\n{}", two(",", 1.0, 1.0))
        }),
        form("decimal commas between spaces", {
            let rows = lines(&rows(), |_, x, p| format!("  {}   {}", comma(x), comma(p)));
            format!("indentation/nm force/nN\n{rows}")
        }),
        form("decimal commas between tabs", {
            let rows = lines(&rows(), |_, x, p| format!("{}\t{}", comma(x), comma(p)));
            format!("indentation/nm\tforce/nN\n{rows}")
        }),
        form("decimal commas between commas with spaces", {
            let rows = lines(&rows(), |_, x, p| {
                let [x, p] = [x, p].map(|x| if x.fract() == 0.0 { format!("{x},0") } else { comma(x) });
                format!("{x}, {p}")
            });
            format!("indentation [nm], force [nN]\n{rows}")
        }),
        form("empty columns and rows below", {
            let rows = lines(&rows(), |_, x, p| format!("{x};{p};;"));
            format!("depth (nm);load (nN);;\n{rows};;;\n;;;\n")
        }),
        form("a column without a name before", {
            let rows = lines(&rows(), |i, x, p| format!("{i},{x},{p}"));
            format!(",indentation_nm,force_nN\n{rows}")
        }),
        form("statistics below the rows", {
            let rows = lines(&rows(), |_, x, p| format!("{};{}", comma(x), comma(p)));
            format!("indentation (nm);force (nN)\n{rows}\nMean;0,3\nMin. load;-3,5 nN\n\nexported by me\n")
        })
        .says("lines 23 to 26 are text below the rows"),
        form("a title and remarks above", {
            let rows = lines(&rows(), |_, x, p| format!("{x}\t{p}"));
            format!(
                "Force Distance Curve 7\n% probe: glass\n// measured by me\n\nindentation (nm)\tforce (nN)\n{rows}"
            )
        }),
        form("no numbers in some rows", {
            let rows = lines(&rows(), |i, x, p| {
                let gap = ["NaN;1", "-12;#N/A", "3;", ";4", "--;2", "1;OVERLOAD", "9.9e37;1", "1;-inf"];
                let gap = gap.get(i).map_or(String::new(), |gap| format!("{gap}\n"));
                format!("{gap}{x};{p}")
            });
            format!("indentation (nm);force (nN)\n{rows}")
        })
        .without(8)
        .says("8 rows have no number"),
        form("a summary above", {
            let rows = lines(&rows(), |_, x, p| format!("{x};{p};1"));
            format!("Sample;E;G;n\n1;2.5;3;4\n2;2.5;3;4\n\nindentation (nm);force (nN);gain\n{rows}")
        })
        .says("lines 2 to 3 are another table"),
    ]
}

/// Forms of users' own programs.
pub(super) fn of_own_programs() -> Vec<FileForm> {
    let unit = |name, x: &str, p: &str, of_x: f64, of_p: f64| {
        form(name, format!("indentation [{x}]\tload [{p}]\n{}", two("\t", 1e-9 / of_x, 1e-9 / of_p)))
    };
    let nm = |name, head: &str, separator: &str| form(name, format!("{head}\n{}", two(separator, 1.0, 1.0)));
    let si = |name, head: &str, separator: &str| form(name, format!("{head}{}", two(separator, 1e-9, 1e-9)));
    vec![
        unit("gram-force", "µm", "gf", 1e-6, 9.80665e-3),
        unit("kilogram-force", "mm", "kgf", 1e-3, 9.80665),
        unit("millinewton", "Å", "mN", 1e-10, 1e-3),
        unit("piconewton", "micron", "pN", 1e-6, 1e-12),
        unit("inches and pounds", "in", "lbf", 0.0254, 4.448_221_615_260_5),
        unit("units spelt out", "Micrometers", "Newton", 1e-6, 1.0),
        unit("the Greek mu", "\u{3bc}m", "\u{3bc}N", 1e-6, 1e-6),
        nm("numpy.savetxt", "# indentation [nm] force [nN]", " "),
        nm("units behind slashes", "Indentation / nm; Force / nN", ";"),
        nm("bars", "indentation (nm) | force (nN)", " | "),
        nm("names with spaces, parted by more of them", "Indentation depth (nm)  Normal force (nN)", "    "),
        nm("units behind names", "delta_nm,F_nN", ", "),
        si("no header, two columns", "", "\t").says("there is no header"),
        si("a count above", "20\n", " ").says("there is no header"),
        si("other names", "u1,u2\n", ",").after("x=u1 [m],force=u2 [N]"),
        form("no header, three columns", lines(&rows(), |i, x, p| format!("{i} {x} {p}")))
            .after("x=2 [nm],force=3 [nN]"),
        form("names in another language", {
            let rows = lines(&rows(), |i, x, p| format!("{i};{};{}", comma(x), comma(p)));
            format!("czas;głębokość;siła\n{rows}")
        })
        .after("x=głębokość [nm],force=siła [nN]"),
        form("Fortran", {
            let rows = lines(&rows(), |_, x, p| format!(" {x:e}  {p:e}").replace('e', "D"));
            format!(" indentation_nm  force_nN\n{rows}")
        }),
        form("minus signs of typography", {
            let rows = lines(&rows(), |_, x, p| format!("{x}\t{p}").replace('-', "\u{2212}"));
            format!("indentation (nm)\tforce (nN)\n{rows}")
        }),
        form("a segment column in words", {
            let rows =
                lines(&rows(), |i, x, p| format!("{},{x},{p}", if i < 10 { "extend" } else { "retract" }));
            format!("segment,indentation (nm),force (nN)\n{rows}")
        })
        .halves(),
        form("a table for each branch", {
            let of = |retraction| lines(&half(retraction), |_, x, p| format!("{x}\t{p}"));
            let head = "indentation (nm)\tforce (nN)";
            format!("[Approach]\n{head}\n{}\n[Retract]\n{head}\n{}", of(false), of(true))
        })
        .halves(),
        form("two forces over one way", {
            let ways = |x: f64| format!("{x}");
            let rows: Vec<_> = half(false).into_iter().zip(half(true)).collect();
            let text = rows.iter().fold(String::new(), |text, ([x, p], [z, f])| {
                text + &format!("{},{p},\n{},,{f}\n", ways(*x), ways(*z))
            });
            format!("Z (nm),Force extend (nN),Force retract (nN)\n{text}")
        })
        .position()
        .halves(),
        form("texts before the numbers", {
            let rows = lines(&rows(), |i, x, p| format!("PDMS {};good;{x};{p}", i / 10));
            format!("sample;remark;indentation (nm);force (nN)\n{rows}")
        }),
        form("a text before the numbers, parted by spaces", {
            format!("name indentation_nm force_nN\n{}", lines(&rows(), |i, x, p| format!("S{i} {x} {p}")))
        }),
        form("texts before the numbers, without a header", {
            lines(&rows(), |i, x, p| format!("PDMS-{i},{x},{p},ok"))
        })
        .after("x=2 [nm],force=3 [nN]"),
        form("settings behind equal signs", {
            let rows = lines(&rows(), |_, x, p| format!("{x} {p}"));
            format!("# k = 42.5 mN/m\n# bead diameter: 10 um\n# z [nm] force [nN]\n{rows}")
        })
        .position()
        .spring(0.0425)
        .tip(5e-6),
    ]
}
