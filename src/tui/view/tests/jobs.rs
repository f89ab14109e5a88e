//! What a person wants to know, and the keys that it takes: counted, so that it does not become more.

use super::Screen;

/// A question, the preset, the keys that answer it, at most how many those are, and what the screen says then.
type Job = (&'static str, &'static str, &'static str, usize, &'static [&'static str]);

const JOBS: &[Job] = &[
    (
        "which crest lets go first, and what does it cost",
        "wavy-sphere",
        "",
        0,
        &["1 snap", "8▸7", "1.217e-4"],
    ),
    (
        "is A = 0.003 or 0.004 nearer to theory at the third snap",
        "wavy-sphere",
        "\r0.003\rp\r0.004\r:select-event 3\r3T",
        34,
        &["at @: JKR 1971 ", ", 1 A 0.003 "],
    ),
    (
        "find a spring that makes the second snap vanish",
        "wavy-sphere",
        "cc3jQsnaps\ri11l",
        16,
        &["snaps over k", "k ", ": snaps "],
    ),
    (
        "show where the contact is at the worst state",
        "wavy-sphere",
        "LVabove\r",
        8,
        &["contact, s/λ", "A -1.480 Pc", "/Pc -1.480"],
    ),
    ("how does the largest pull depend on A here", "wavy-sphere", "Q\r", 2, &["largest pull over A", "now"]),
    (
        "what did I do between the second and the third jump",
        "wavy-sphere",
        "nxnx>>nxTT",
        10,
        &["jumps 3", "A 0.00255", "limit", "lost, changed"],
    ),
];

#[test]
fn questions_take_few_keys_and_the_screen_answers_them() {
    for (question, preset, keys, most, said) in JOBS {
        let mut screen = Screen::new(preset);
        // Drawn before and after, as on a terminal: views ask for what they show.
        screen.text(300, 70);
        screen.keys(keys);
        let text = screen.text(300, 70);
        for words in *said {
            assert!(text.contains(words), "{question}: {words} is missing\n{text}");
        }
        assert!(keys.chars().count() <= *most, "{question}: {} keys", keys.chars().count());
    }
}
