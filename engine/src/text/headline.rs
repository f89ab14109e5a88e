//! The beginning of a longer description.

/// The part of a text before the first comma, colon, semicolon or remark in brackets: a heading made from a description.
pub fn headline(text: &str) -> &str {
    let marks = [text.find([',', ':', ';']), text.find(" (")];
    let end = marks.into_iter().flatten().min().unwrap_or(text.len());
    text[..end].trim_end()
}

#[cfg(test)]
mod tests {
    use super::headline;

    #[test]
    fn a_description_is_cut_before_its_first_mark() {
        assert_eq!(headline("work of adhesion: twice a face's surface energy"), "work of adhesion");
        assert_eq!(headline("wavelength"), "wavelength");
        assert_eq!(headline("stiffness (of the device)"), "stiffness");
        assert_eq!(headline("2 pi gamma/(E* R); changes gamma"), "2 pi gamma/(E* R)");
        assert_eq!(headline(""), "");
    }
}
