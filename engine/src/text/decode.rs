//! Bytes of a file → text: UTF-8, UTF-16 and the 8-bit encoding of Western Windows, which are what instruments and
//! spreadsheets write.
//!
//! Only what is certain is taken for text. A byte order mark decides. Without one, valid UTF-8 is UTF-8, bytes of which
//! every other one is zero are UTF-16, and bytes without any zero are Windows-1252. Anything else with a zero byte is
//! not text.

use encoding_rs::{UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};
use std::borrow::Cow;
use thiserror::Error;

/// This many bytes at the beginning tell whether a file without a byte order mark is UTF-16.
const LOOKED_AT: usize = 4096;

/// Why bytes are not text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum NotText {
    /// A kind of file recognized by its first bytes.
    #[error("is {0}, not text")]
    Known(&'static str),
    /// A zero byte among letters.
    #[error("line {0}: holds a zero byte: the file is binary or damaged, not text")]
    Zero(usize),
    /// A byte order mark that names an encoding which the bytes behind it do not have.
    #[error("is damaged: its byte order mark says {0}, but its bytes are not")]
    Damaged(&'static str),
}

/// The first bytes of files that people mistake for tables.
const KNOWN: [(&[u8], &str); 5] = [
    (b"PK\x03\x04", "a ZIP archive, such as an Excel workbook (.xlsx) or a JPK force curve (.jpk-force)"),
    (b"\x89HDF\r\n", "an HDF5 file"),
    (b"\xd0\xcf\x11\xe0", "a binary Microsoft Office file"),
    (b"\x1f\x8b", "a compressed file (gzip)"),
    (b"%PDF-", "a PDF file"),
];

/// The text in `bytes`, without a byte order mark, and what had to be assumed about its encoding.
///
/// # Errors
/// [`NotText`].
pub fn decode(bytes: &[u8]) -> Result<(Cow<'_, str>, Option<&'static str>), NotText> {
    if let Some((_, what)) = KNOWN.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Err(NotText::Known(what));
    }
    let marked = encoding_rs::Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
    let (encoding, note) = match marked.or_else(|| utf_16(bytes)) {
        Some(encoding) => (encoding, None),
        None if std::str::from_utf8(bytes).is_ok() => (UTF_8, None),
        None => (WINDOWS_1252, Some("the text is not UTF-8: it is read as Windows-1252")),
    };
    let (text, is_damaged) = encoding.decode_with_bom_removal(bytes);
    if is_damaged {
        return Err(NotText::Damaged(encoding.name()));
    }
    match text.lines().position(|line| line.contains('\0')) {
        Some(line) => Err(NotText::Zero(line + 1)),
        None => Ok((text, note)),
    }
}

/// UTF-16 without a byte order mark: nearly every other byte is zero, and hardly any of the others are.
fn utf_16(bytes: &[u8]) -> Option<&'static encoding_rs::Encoding> {
    let (pairs, _) = bytes.get(..bytes.len().min(LOOKED_AT))?.as_chunks::<2>();
    let zeros = |at: usize| pairs.iter().filter(|pair| pair[at] == 0).count();
    let is = |full: usize, empty: usize| full * 10 < pairs.len() && empty * 10 > pairs.len() * 9;
    let [first, second] = [zeros(0), zeros(1)];
    if pairs.is_empty() {
        None
    } else if is(first, second) {
        Some(UTF_16LE)
    } else {
        is(second, first).then_some(UTF_16BE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_told_from_bytes_in_every_usual_encoding() {
        let text = "Load (µN)\r\n1,5\r\n";
        let wide = |of: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(of).collect::<Vec<u8>>();
        let [le, be] = [wide(u16::to_le_bytes), wide(u16::to_be_bytes)];
        let mark = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            mark(b"\xef\xbb\xbf", text.as_bytes()),
            le.clone(),
            be.clone(),
            mark(b"\xff\xfe", &le),
            mark(b"\xfe\xff", &be),
        ] {
            assert_eq!(decode(&bytes), Ok((text.into(), None)), "{bytes:?}");
        }
        let (western, note) = decode(b"Load (\xb5N)\r\n1,5\r\n").unwrap();
        assert_eq!(western, text);
        assert!(note.unwrap().contains("Windows-1252"));
        assert_eq!(decode(b""), Ok(("".into(), None)));
        assert_eq!(decode(b"1 2\n3 \x00 4\n"), Err(NotText::Zero(2)));
        assert_eq!(decode(b"\xff\xfe1\x002"), Err(NotText::Damaged("UTF-16LE")));
        assert!(matches!(decode(b"PK\x03\x04\x14"), Err(NotText::Known(what)) if what.contains("jpk-force")));
    }
}
