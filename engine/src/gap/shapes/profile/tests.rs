use super::*;
use crate::gap::shapes::fixtures::check_two_derivatives;
use crate::gap::shapes::split_mix::SplitMix64;
use crate::gap::{Gap, Jet};
use crate::gap::{shapes::Harmonic, shapes::Harmonics};
use crate::units::UnitSystem;
use std::f64::consts::TAU;

fn even(n: usize, last: f64) -> Vec<f64> {
    (0..=n).map(|i| last * i as f64 / n as f64).collect()
}

fn sampled(gap: &dyn Gap, radii: &[f64]) -> Vec<f64> {
    radii.iter().map(|&r| gap.jet(r).value).collect()
}

fn wavy() -> Harmonics {
    let wave = Harmonic { amplitude: 0.0025, wavelength: 0.1, phase: 0.0 };
    Harmonics::new(1.0, vec![wave]).unwrap()
}

#[test]
fn derivatives_agree_with_central_differences_between_the_rows() {
    let radii = even(300, 0.5);
    let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
    for i in 1..299 {
        // In the middle of a piece, over less than its width: there h is a single cubic with a single h'''.
        let r = 0.5 * (radii[i] + radii[i + 1]);
        check_two_derivatives(&profile, r, 0.1);
        let (e, at) = (1e-4, profile.jet(r));
        let third = (profile.jet(r + e).second - profile.jet(r - e).second) / (2.0 * e);
        assert!((third - at.third).abs() <= 1e-9 * at.second.abs() / e);
    }
}

#[test]
fn it_passes_the_rows_and_nears_the_gap_in_the_fourth_order() {
    let error = |n: usize| {
        let radii = even(n, 0.5);
        let rows = sampled(&wavy(), &radii);
        let profile = ProfileGap::new(&radii, &rows, Smoothing::None).unwrap();
        for (&r, h) in radii.iter().zip(&rows) {
            assert!((profile.jet(r).value - h).abs() <= 1e-15, "{r}");
        }
        (0..1000)
            .map(|i| 4e-4 * f64::from(i))
            .map(|r| (profile.jet(r).value - wavy().jet(r).value).abs())
            .fold(0.0, f64::max)
    };
    let order = (error(100) / error(200)).log2();
    assert!((3.7..4.3).contains(&order), "{order}");
}

#[test]
fn a_measured_paraboloid_stays_one() {
    // In unusual units, with the heights measured from another level, and without a row on the axis.
    let radii: Vec<f64> = even(50, 3e-4).into_iter().skip(1).collect();
    let gaps: Vec<f64> = radii.iter().map(|r| 5e-6 + r * r / (2.0 * 2e-2)).collect();
    for smoothing in [Smoothing::None, Smoothing::Cutoff(1e-4), Smoothing::Auto] {
        let profile = ProfileGap::new(&radii, &gaps, smoothing).unwrap();
        assert!((profile.radius_of_curvature().unwrap() / 2e-2 - 1.0).abs() < 1e-8);
        assert_eq!((profile.knots()[0], profile.largest_radius()), (0.0, Some(3e-4)));
        for r in [0.0, 1e-6, 1.1e-4, 3e-4] {
            let jet = profile.jet(r);
            assert!((jet.value - r * r / 4e-2).abs() < 1e-8 * 2.25e-6, "{smoothing:?} {r}");
            assert!((jet.first - r / 2e-2).abs() < 1e-7 * 1.5e-2, "{smoothing:?} {r}");
        }
        let axis = profile.jet(0.0);
        assert_eq!(axis, Jet { second: axis.second, ..Jet::default() });
    }
}

#[test]
fn the_wave_and_the_sphere_are_told_apart() {
    let radii = even(500, 0.5);
    let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
    assert!((profile.feature_length().unwrap() / 0.1 - 1.0).abs() < 0.03, "{:?}", profile.feature_length());
    assert!((profile.reference_length() - 1.0).abs() < 0.01);
    assert_eq!((profile.cutoff(), profile.removed()), (None, 0.0));
    let sphere = crate::gap::Shape::Sphere { radius_of_curvature: 0.7 };
    let smooth = ProfileGap::new(&radii, &sampled(&sphere, &radii), Smoothing::None).unwrap();
    assert_eq!(smooth.feature_length(), None);
}

#[test]
fn noise_is_measured_and_removed() {
    let radii = even(2000, 0.5);
    let mut random = SplitMix64::new(5);
    let noise = 1e-4;
    let gaps: Vec<f64> = sampled(&wavy(), &radii)
        .into_iter()
        .map(|h| h + noise * 6.0_f64.sqrt() * (random.unit() + random.unit() - 1.0))
        .collect();
    let profile = ProfileGap::new(&radii, &gaps, Smoothing::Auto).unwrap();
    assert!((profile.removed() / noise - 1.0).abs() < 0.1, "{}", profile.removed());
    let cutoff = profile.cutoff().unwrap();
    assert!((0.01..0.1).contains(&cutoff), "{cutoff}");
    assert!((profile.feature_length().unwrap() / 0.1 - 1.0).abs() < 0.2, "{:?}", profile.feature_length());
}

#[test]
fn nothing_is_known_beyond_the_last_row() {
    let radii = even(20, 0.3);
    let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
    assert!(profile.jet(0.3).value.is_finite() && profile.jet(0.3_f64.next_up()).value.is_finite());
    for r in [0.300_000_1, 1e9, f64::NAN] {
        assert!(profile.jet(r).value.is_nan() && profile.jet(r).third.is_nan(), "{r}");
    }
}

#[test]
fn a_dimple_is_reduced_by_its_width() {
    let radii = even(20, 0.3);
    let gaps: Vec<f64> = radii.iter().map(|r| -r * r).collect();
    let profile = ProfileGap::new(&radii, &gaps, Smoothing::None).unwrap();
    assert_eq!((profile.radius_of_curvature(), profile.reference_length()), (None, 0.3));
    let flat = ProfileGap::new(&radii, &[0.0; 21], Smoothing::Auto).unwrap();
    assert_eq!(flat.jet(0.1), Jet::default());
}

#[test]
fn rows_that_are_no_profile_are_refused_with_their_number() {
    let good = even(9, 1.0);
    let refused = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>), smoothing| {
        let (mut radii, mut gaps) = (good.clone(), vec![0.5; 10]);
        change(&mut radii, &mut gaps);
        ProfileGap::new(&radii, &gaps, smoothing).unwrap_err()
    };
    let plain = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>)| refused(change, Smoothing::None);
    assert_eq!(plain(&|r, _| r.truncate(9)), InvalidProfile::Columns { radii: 9, gaps: 10 });
    let few = |r: &mut Vec<f64>, h: &mut Vec<f64>| (r.truncate(7), h.truncate(7)).0;
    assert_eq!(plain(&few), InvalidProfile::TooFew(7));
    assert_eq!(plain(&|_, h| h[4] = f64::INFINITY), InvalidProfile::NotFinite(4));
    assert_eq!(plain(&|r, _| r[0] = -0.1), InvalidProfile::Negative { row: 0, radius: -0.1 });
    let same = InvalidProfile::NotAscending { row: 3, radius: good[2], before: good[2] };
    assert_eq!(plain(&|r, _| r[3] = r[2]), same);
    for cutoff in [0.0, -1.0, f64::NAN, 112.0] {
        let error = refused(&|_, _| (), Smoothing::Cutoff(cutoff)).to_string();
        assert!(error.contains("out of range"), "{error}");
    }
}

fn noisy(radii: &[f64], noise: f64) -> Vec<f64> {
    let mut random = SplitMix64::new(5);
    let noise = noise * 6.0_f64.sqrt();
    sampled(&wavy(), radii).into_iter().map(|h| h + noise * (random.unit() + random.unit() - 1.0)).collect()
}

/// The largest error of the slope up to `to`.
fn error(profile: &ProfileGap, to: f64) -> f64 {
    (0..=2000)
        .map(|i| to * f64::from(i) / 2000.0)
        .map(|r| (profile.jet(r).first - wavy().jet(r).first).abs())
        .fold(0.0, f64::max)
}

#[test]
fn many_rows_are_averaged_in_cells() {
    let radii = even(40_000, 0.5);
    let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
    let cells = profile.cells().unwrap();
    assert_eq!((cells.rows, cells.count), (40_001, MOST_KNOTS));
    assert!((cells.width / 1.25e-4 - 1.0).abs() < 1e-12);
    // The axis, every mean, the last row.
    assert_eq!((profile.knots().len(), profile.largest_radius()), (MOST_KNOTS + 2, Some(0.5)));
    // A cell mean passes the share sin(x)/x of the wave, x = πw/λ.
    let x = std::f64::consts::PI * cells.width / 0.1;
    let lost = 0.0025 * TAU / 0.1 * (1.0 - x.sin() / x);
    assert!(error(&profile, 0.45) < 2.0 * lost + 1e-7, "{}", error(&profile, 0.45));
    assert_eq!(
        profile.remarks(&UnitSystem::Reduced),
        ["40 001 rows averaged in 4000 cells of 0.000125: waves shorter than 0.0005 are not in the gap"]
    );
    // All rows are knots as long as there are no more than the largest number of knots.
    let radii = even(3999, 0.5);
    let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
    assert_eq!(
        (profile.cells(), profile.knots().len(), profile.remarks(&UnitSystem::Reduced).len()),
        (None, 4000, 0)
    );
    assert_eq!(profile.coarser(&radii, &sampled(&wavy(), &radii)), None);
}

#[test]
fn averaging_takes_noise_away_and_leaves_the_wave() {
    let radii = even(200_000, 0.6);
    let gaps = noisy(&radii, 2e-5);
    let auto = ProfileGap::new(&radii, &gaps, Smoothing::Auto).unwrap();
    assert!((auto.removed() / 2e-5 - 1.0).abs() < 0.02, "{}", auto.removed());
    assert!((0.004..0.1).contains(&auto.cutoff().unwrap()), "{:?}", auto.cutoff());
    assert!(error(&auto, 0.55) < 3e-3, "{}", error(&auto, 0.55));
    let given = ProfileGap::new(&radii, &gaps, Smoothing::Cutoff(0.04)).unwrap();
    let cells = given.cells().unwrap();
    assert_eq!(cells.count, 120);
    assert!(error(&given, 0.55) < 0.05 * 0.157, "{}", error(&given, 0.55));
    let said = given.remarks(&UnitSystem::Reduced);
    assert_eq!(said[0], "200 001 rows averaged in 120 cells of 0.005");
    assert!(
        said[1].starts_with("smoothing: waves of 0.04 are halved, shorter ones reduced more"),
        "{said:?}"
    );
    // The same cutoff in cells of twice the width.
    let coarser = given.coarser(&radii, &gaps).unwrap();
    assert_eq!((coarser.cells().unwrap().count, coarser.cutoff()), (60, given.cutoff()));
    assert_ne!(coarser.pieces, given.pieces);
}

#[test]
fn a_cutoff_passes_half_of_its_wave_through_cells_too() {
    // Besides the wave there is a parabola, nearly all of which the paraboloid takes.
    let (n, wavelength) = (100_000, 0.02);
    let radii = even(n, 1.0);
    let gaps: Vec<f64> = radii.iter().map(|r| r * r / 2.0 + 1e-3 * (TAU * r / wavelength).cos()).collect();
    for (cutoff, share) in [(0.02, 0.487), (0.01, 0.93)] {
        let profile = ProfileGap::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).unwrap();
        let (crest, trough) = (profile.jet(0.5).value, profile.jet(0.51).value);
        let passed = (crest - trough + (0.51 * 0.51 - 0.25) / 2.0) / 2e-3;
        assert!((passed - share).abs() < 0.01, "{cutoff}: {passed}");
    }
}

#[test]
fn any_cutoff_up_to_the_last_radius_smooths() {
    let mut random = SplitMix64::new(9);
    for n in [300, 4000, 20_000] {
        let radii = even(n, 2e-4);
        let gaps: Vec<f64> = radii.iter().map(|r| r * r / 2e-2 + 1e-9 * (random.unit() - 0.5)).collect();
        for share in [0.002, 0.01, 0.1, 0.3, 0.77, 1.0] {
            let profile = ProfileGap::new(&radii, &gaps, Smoothing::Cutoff(share * 2e-4)).unwrap();
            assert!(profile.cutoff().is_some_and(|cutoff| (cutoff / (share * 2e-4) - 1.0).abs() < 1e-14));
            let noise = if share < 0.1 { 1e-9 } else { 1e-10 };
            for r in [1e-5, 1e-4, 2e-4] {
                let off = (profile.jet(r).value - r * r / 2e-2).abs();
                assert!(off < noise, "{n} rows, {share}: {off:e} at {r}");
            }
        }
    }
}

#[test]
fn cutoffs_that_need_too_many_cells_are_refused_with_one_that_works() {
    let radii = even(50_000, 0.5);
    let gaps = noisy(&radii, 1e-5);
    let refused = |cutoff| ProfileGap::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).unwrap_err();
    for cutoff in [1e-4, 0.6, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(cutoff);
        assert!(error.is_of_smoothing());
        let said = error.to_string();
        assert!(said.contains("out of range") && said.contains("from 0.001 to 0.5"), "{said}");
    }
    for cutoff in [0.001, 0.5] {
        assert!(ProfileGap::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).is_ok());
    }
}

#[test]
fn empty_cells_are_refused_with_their_radius_and_a_cutoff_that_works() {
    let radii: Vec<f64> = even(50_000, 0.5).into_iter().filter(|r| !(0.2..0.21).contains(r)).collect();
    let gaps = noisy(&radii, 1e-5);
    for smoothing in [Smoothing::None, Smoothing::Auto, Smoothing::Cutoff(0.01)] {
        let error = ProfileGap::new(&radii, &gaps, smoothing).unwrap_err();
        assert!(error.is_of_smoothing());
        let said = error.to_string();
        assert!(said.contains("no row lies between the radii 0.19999 and 0.21"), "{said}");
        let works = said.split("gap.smoothing = ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        let cutoff = works.parse().unwrap();
        assert!(ProfileGap::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).is_ok(), "{said}");
    }
    // With so many radii missing, no cutoff helps.
    let radii: Vec<f64> = even(50_000, 0.5).into_iter().filter(|r| !(0.2..0.4).contains(r)).collect();
    let said = ProfileGap::new(&radii, &noisy(&radii, 1e-5), Smoothing::None).unwrap_err().to_string();
    assert!(
        said.contains("no gap.smoothing gives cells that are wide enough, but up to 4000 rows need no cells"),
        "{said}"
    );
    // Few rows stay knots instead.
    let radii: Vec<f64> = even(2000, 0.5).into_iter().filter(|r| !(0.2..0.3).contains(r)).collect();
    let profile = ProfileGap::new(&radii, &noisy(&radii, 1e-5), Smoothing::Cutoff(0.05)).unwrap();
    assert_eq!(profile.cells(), None);
}

#[test]
fn it_does_not_matter_how_many_rows_fall_in_a_cell() {
    let mut random = SplitMix64::new(21);
    let mut radii: Vec<f64> = (0..100_000).map(|_| 0.5 * random.unit()).collect();
    radii.extend([0.0, 0.5]);
    radii.sort_by(f64::total_cmp);
    radii.dedup();
    let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
    assert!(error(&profile, 0.49) < 1e-4, "{}", error(&profile, 0.49));
    // As many rows as cells, up to rounding at their borders, and a few more.
    for n in [4000, 4001, 4100, 5500, 7999, 8000, 8001] {
        let radii = even(n, 0.5);
        let profile = ProfileGap::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert!(profile.cells().is_some() && error(&profile, 0.49) < 3e-4, "{n}: {}", error(&profile, 0.49));
    }
}
