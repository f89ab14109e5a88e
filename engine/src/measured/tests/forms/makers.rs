//! What the programs of instrument makers write.

use super::{FileForm, comma, form, half, lines, rows, western};
use crate::measured::Abscissa;
use std::fmt::Write;

/// A JPK file: a block for each segment, in SI.
fn jpk(segments: &[(&str, Vec<[f64; 2]>)], columns: &str, units: &str) -> String {
    let mut text = "# exportName: standard\n# springConstant: 0.0425\n# sensitivity: 5.9e-8\n#\n".to_owned();
    for (i, (segment, rows)) in segments.iter().enumerate() {
        writeln!(text, "# segmentIndex: {i}\n# segment: {segment}\n#\n# {columns}\n# units: {units}\n#")
            .unwrap();
        text += &lines(rows, |i, x, p| format!("{:e} {:e} {:e}", x * 1e-9, p * 1e-9, 1e-3 * i as f64));
        text.push('\n');
    }
    text
}

/// Approach and retraction side by side.
fn beside(separator: &str) -> String {
    let pairs: Vec<_> = half(false).into_iter().zip(half(true)).collect();
    pairs.iter().fold(String::new(), |mut text, ([x, p], [z, f])| {
        writeln!(text, "{x}{separator}{z}{separator}{}{separator}{}", p * 1e3, f * 1e3).unwrap();
        text
    })
}

/// Forms of microscope makers.
pub(super) fn of_microscopes() -> Vec<FileForm> {
    let both = [("extend", half(false)), ("retract", half(true))];
    let workshop = |head: &str| {
        let pairs: Vec<_> = half(false).into_iter().zip(half(true)).collect();
        pairs.iter().fold(head.to_owned(), |mut text, ([x, p], [z, f])| {
            writeln!(text, "{x},{p},{z},{f}").unwrap();
            text
        })
    };
    let tab = "# BEGIN METADATA\n# {\n#   \"imaging mode\": \"force-distance\",\n#   \"spring constant\": 0.0425\n# }\n# END METADATA\n#\n";
    let tab = format!("{tab}# force\theight (measured)\theight (piezo)\tindex\tsegment\ttime\n");
    let tab = tab
        + &lines(&rows(), |i, x, p| {
            let back = if i < 10 { "False" } else { "True" };
            format!("{:e}\t{:e}\t7e-6\t{i}\t{back}\t{:e}", p * 1e-9, x * 1e-9, 1e-3 * i as f64)
        });
    vec![
        form("JPK, extend and retract", jpk(&both, "columns: measuredHeight vDeflection seriesTime", "m N s"))
            .position()
            .spring(0.0425)
            .halves(),
        form("JPK, tip-sample separation", jpk(&both, "columns: tipSampleSeparation vDeflection time", "m N s"))
            .spring(0.0425)
            .halves(),
        form(
            "JPK, names in words alone",
            jpk(&both, "fancyNames: \"Height (measured)\" \"Vertical deflection\" \"Series Time\"", "m N s"),
        )
        .position()
        .spring(0.0425)
        .halves(),
        form("JPK, one segment", jpk(&[("extend", rows())], "columns: height vDeflection time", "m N s"))
            .position()
            .spring(0.0425)
            .over_segments([20, 0]),
        form("Nanoscope", format!("Calc_Ramp_Ex_nm\tCalc_Ramp_Rt_nm\tDefl_pN_Ex\tDefl_pN_Rt\n{}", beside("\t")))
            .position()
            .halves(),
        form(
            "Nanoscope with its header",
            format!(
                "\"\\*Force file list\"\n\"\\Version: 0x09400202\"\n\"\\Spring Constant: 0.0425\"\n\"\\Samps/line: 10 10\"\n\
                 \"\\*File list end\"\nHeight_Sensor_nm_Ex\tHeight_Sensor_nm_Rt\tDefl_pN_Ex\tDefl_pN_Rt\n{}",
                beside("\t")
            ),
        )
        .position()
        .spring(0.0425)
        .halves(),
        form(
            "AFM Workshop",
            workshop(
                "Force-Distance Curve\nFile Format:    3\n\nDate:    Wednesday, August 1, 2018\nTime:    1:07:47 PM\nMode:    \
                 Mapping\nPoint:    16\nX, um:    27.250000\nY, um:    27.250000\n\nExtend Z-Sense(nm),Extend T-B(nN),Retract \
                 Z-Sense(nm),Retract T-B(nN)\n",
            ),
        )
        .position()
        .halves(),
        form(
            "AFM Workshop, with forces by name",
            workshop(
                "Force-Distance Curve\nFile Format:    3\n\nForce Constant, nN/nm: 0.0425\n\nExtend Z-Sense(nm),Extend \
                 Force(nN),Retract Z-Sense(nm),Retract Force(nN)\n",
            ),
        )
        .position()
        .spring(0.0425)
        .halves(),
        form("afmformats .tab", tab).position().spring(0.0425).halves(),
    ]
}

/// Forms of text that Igor writes.
pub(super) fn of_igor() -> Vec<FileForm> {
    let igor = lines(&rows(), |_, x, p| format!("\t{:e}\t{:e}", x * 1e-9, p * 1e-9));
    let wave = |scale: f64, at: usize| lines(&rows(), |_, x, p| format!("\t{:e}", [x, p][at] * scale));
    vec![
        form("Igor, two waves in a block", format!("IGOR\nWAVES/D\tZSnsr\tForce\nBEGIN\n{igor}END\n"))
            .position(),
        form(
            "Igor, a block for each wave",
            format!("IGOR\nWAVES/D/N=(20) Ind\nBEGIN\n{}END\nWAVES/D/N=(20) Force\nBEGIN\n{}END\n", wave(1e-9, 0), wave(1e-9, 1))
                .replace("Ind\n", "Indentation\n"),
        ),
        form(
            "Igor, with units, notes and old ends of lines",
            format!(
                "IGOR\nWAVES/D\t'Line0001Point0002ZSnsr_Ext'\tDefl_Ext\nBEGIN\n{}END\nX SetScale/P x 0,1,\"s\", Defl_Ext; \
                 SetScale y 0,0,\"nm\", Defl_Ext\nX SetScale d 0,0,\"nm\", 'Line0001Point0002ZSnsr_Ext'\n\
                 X Note Defl_Ext, \"ScanRate: 1\\rSpringConstant: 0.0425\\rInvOLS: 6e-8\"\n",
                lines(&rows(), |_, x, p| format!("\t{x}\t{p}"))
            )
            .replace('\n', "\r"),
        )
        .position()
        .spring(0.0425),
        form("Igor, waves indented", format!("IGOR\nWAVES\tDepth, Force\nBEGIN\n{igor}END\n")),
    ]
}

/// Forms of other instruments.
pub(super) fn of_indenters() -> Vec<FileForm> {
    let hysitron = |head: &str| {
        let rows = lines(&rows(), |i, x, p| format!("{x}\t{}\t{}\t0.5\t0.25", p * 1e-3, 0.01 * i as f64));
        format!("\r\nNumber of Points  =  20\r\n\r\n{head}\r\n{}", rows.replace('\n', "\r\n"))
    };
    let chiaro = "Date\t30/06/2021\tTime\t10:22:13\tStatus \tSingle indentation\nMax load (µN)\t0.02\nDevice:\tChiaro\n\
                  Piezo position (nm) (Measured)\t1500.5\nTip radius (um)\t27.5\nk (N/m)\t0.018\nPiezo speed  (µm/s)\t1\n\n\
                  Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary\n";
    let chiaro = chiaro.to_owned()
        + &lines(&rows(), |i, x, p| {
            format!(
                "{:.3}\t{:.9}\t{x:.3}\t{:.4}\t{:.3}\t0.0",
                0.001 * i as f64,
                p * 1e-3,
                p * 2.0,
                x + p * 2.0
            )
        });
    let lvm = |mark: char, several: bool| {
        let head = "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nMulti_Headings\tNo\n\
                    X_Columns\tOne\nTime_Pref\tAbsolute\nOperator\tme\nDate\t2021/03/02\nTime\t14:23:12,312\n\
                    ***End_of_Header***\t\n\t\n";
        let segment = |rows: &[[f64; 2]]| {
            let count = rows.len();
            let rows =
                lines(rows, |i, x, p| format!("{:.6}\t{:.6}\t{:.9}\t", 0.001 * i as f64, x * 1e-3, p * 1e-6));
            format!(
                "Channels\t2\t\t\nSamples\t{count}\t{count}\t\nDate\t2021/03/02\t2021/03/02\t\nTime\t14:23:12.3\t14:23:12.3\t\n\
                 Y_Unit_Label\tMicrometers\tMillinewton\t\nX_Dimension\tTime\tTime\t\nX0\t0.0E+0\t0.0E+0\t\n\
                 Delta_X\t0.001\t0.001\t\n***End_of_Header***\t\t\t\nX_Value\tPosition\tForce\tComment\n{rows}\n"
            )
        };
        let all = if several { segment(&half(false)) + &segment(&half(true)) } else { segment(&rows()) };
        (head.to_owned() + &all).replace('.', &mark.to_string())
    };
    // Written without the tab at the end of each line, and with whole numbers above the rows.
    let bare = lvm(',', false).replace("0,0E+0", "0").replace("\t\n", "\n");
    vec![
        form("Hysitron", western(&hysitron("Depth (nm)\tLoad (µN)\tTime (s)\tDepth (V)\tLoad (V)")))
            .says("Windows-1252"),
        form("Hysitron, in UTF-8", hysitron("Depth (nm)\tLoad (\u{3bc}N)\tTime (s)\tDepth (V)\tLoad (V)")),
        form("Chiaro", western(&chiaro)).spring(0.018).tip(27.5e-6),
        form("Chiaro, in UTF-8", chiaro).spring(0.018).tip(27.5e-6),
        form("LabVIEW, decimal commas", lvm(',', false)).position().says("decimals are written with a comma"),
        form("LabVIEW, lines without a last tab", bare).position().says("decimals are written with a comma"),
        form("LabVIEW, decimal points", lvm('.', false)).position(),
        form("LabVIEW, a heading for each segment", lvm(',', true)).position().says("2 tables"),
    ]
}

/// Forms of material testers and of home-built rigs.
pub(super) fn of_testers() -> Vec<FileForm> {
    let all = "Time [s]\tPiezo [nm]\tDefl [V]\tDefl [nm]\tIndentation [nm]\tForce [nN]\tTemperature [°C]\n"
        .to_owned()
        + &lines(&rows(), |i, x, p| {
            format!("{}\t{}\t{}\t{p}\t{x}\t{p}\t21.5", 0.5 * i as f64, x + p, 0.01 * p)
        });
    vec![
        form("every usual column", all),
        form(
            "texture analyser",
            "Force (g);Distance (mm);Time (sec)\n".to_owned()
                + &lines(&rows(), |i, x, p| format!("{:e};{:e};{i}", p * 1e-9 / 9.80665e-3, x * 1e-6)),
        ),
        form(
            "tensile tester, units in a line of their own",
            "\"Time\",\"Extension\",\"Load\"\n\"(s)\",\"(mm)\",\"(N)\"\n\n".to_owned()
                + &lines(&rows(), |i, x, p| format!("\"{i}\",\"{:e}\",\"{:e}\"", x * 1e-6, p * 1e-9)),
        )
        .position(),
        form(
            "tensile tester, German",
            western(
                &("Prüfer: Müller\r\nStandardweg;Standardkraft\r\nmm;N\r\n".to_owned()
                    + &lines(&rows(), |_, x, p| format!("{};{}", comma(x * 1e-6), comma(p * 1e-9)))),
            ),
        )
        .position(),
        form(
            "balance, in milligrams, with the time of day",
            "Time,Stage (um),Load (mg)\n".to_owned()
                + &lines(&rows(), |i, x, p| {
                    format!("2021-03-02 14:23:{:02},{},{:e}", i + 10, x * 1e-3, p * 1e-9 / 9.80665e-6)
                }),
        )
        .position(),
        form(
            "a lens on rubber, contact area",
            "Load [mN],Contact area [um^2]\n".to_owned()
                + &lines(&rows(), |_, x, p| {
                    let s = (x + 75.0) * 1e-3;
                    format!("{:e},{:e}", p * 1e-6, std::f64::consts::PI * s * s)
                }),
        )
        .over(Abscissa::Radius)
        .says("s = √(A/π)"),
        form(
            "a lens on rubber, contact area in mm²",
            "area (mm²)\tforce (mN)\n".to_owned()
                + &lines(&rows(), |_, x, p| {
                    let s = (x + 75.0) * 1e-6;
                    format!("{:e}\t{:e}", std::f64::consts::PI * s * s, p * 1e-6)
                }),
        )
        .over(Abscissa::Radius),
        form(
            "a lens on rubber, contact diameter",
            "contact diameter [um];force [uN]\n".to_owned()
                + &lines(&rows(), |_, x, p| format!("{};{}", 2e-3 * (x + 75.0), p * 1e-3)),
        )
        .over(Abscissa::Radius)
        .says("s = d/2"),
    ]
}
