//! Bytes of a file as numbers: text by lines, or binary in either byte order. Counts are checked
//! against the remaining bytes before anything is allocated.

use super::error::{Fault, MshError, Place};

/// Encoding of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Binary { big_endian: bool },
}

pub(super) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    pub(super) encoding: Encoding,
}

type Result<T> = std::result::Result<T, MshError>;

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1, encoding: Encoding::Text }
    }

    pub(super) fn place(&self) -> Place {
        match self.encoding {
            Encoding::Text => Place::Line(self.line),
            Encoding::Binary { .. } => Place::Byte(self.at),
        }
    }

    pub(super) fn error(&self, fault: Fault) -> MshError {
        MshError { place: self.place(), fault }
    }

    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn advance(&mut self, to: usize) {
        self.line += self.bytes[self.at..to].split(|b| *b == b'\n').count() - 1;
        self.at = to;
    }

    /// The next line, trimmed, if there is one before the file ends; blank lines are skipped.
    pub(super) fn next_line(&mut self) -> Result<Option<(Place, &'a str)>> {
        let blank = self.bytes[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.advance(self.at + blank);
        if self.left() == 0 {
            return Ok(None);
        }
        let remaining = &self.bytes[self.at..];
        let place = self.place();
        let end = remaining.iter().position(|b| *b == b'\n').unwrap_or(remaining.len());
        let text = std::str::from_utf8(remaining[..end].trim_ascii())
            .map_err(|_| self.unexpected("text", &remaining[..end]))?;
        self.advance((self.at + end + 1).min(self.bytes.len()));
        Ok(Some((place, text)))
    }

    /// The next line, which must exist.
    pub(super) fn line(&mut self, within: &'static str) -> Result<(Place, &'a str)> {
        self.next_line()?.ok_or_else(|| self.error(Fault::Truncated(within)))
    }

    /// Skips to the line after `end`, which ends an unread section; binary data may precede it.
    pub(super) fn skip_past(&mut self, end: &str, within: &'static str) -> Result<()> {
        let found = self.bytes[self.at..].windows(end.len()).position(|w| w == end.as_bytes());
        let Some(found) = found else { return Err(self.error(Fault::Truncated(within))) };
        self.advance(self.at + found);
        self.line(within).map(|_| ())
    }

    pub(super) fn unexpected(&self, wanted: &str, found: &[u8]) -> MshError {
        let found: String = String::from_utf8_lossy(found).chars().take(40).collect();
        self.error(Fault::Unexpected { wanted: wanted.to_owned(), found })
    }

    /// The next word of this line.
    fn word(&mut self, what: &'static str) -> Result<&'a [u8]> {
        while let Some(b' ' | b'\t' | b'\r') = self.bytes.get(self.at) {
            self.at += 1;
        }
        let remaining = &self.bytes[self.at..];
        let word =
            &remaining[..remaining.iter().position(u8::is_ascii_whitespace).unwrap_or(remaining.len())];
        // A word at the end of the file may have lost digits.
        if word.len() == remaining.len() {
            return Err(self.error(Fault::Truncated(what)));
        }
        if word.is_empty() {
            return Err(self.error(Fault::ShortLine(what)));
        }
        self.at += word.len();
        Ok(word)
    }

    fn parsed<T: std::str::FromStr>(&mut self, what: &'static str, wanted: &str) -> Result<T> {
        let word = self.word(what)?;
        let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        parsed.ok_or_else(|| self.unexpected(wanted, word))
    }

    fn raw<const B: usize>(&mut self, what: &'static str) -> Result<([u8; B], bool)> {
        let Some(raw) = self.bytes[self.at..].first_chunk::<B>() else {
            return Err(self.error(Fault::Truncated(what)));
        };
        self.at += B;
        Ok((*raw, self.encoding == Encoding::Binary { big_endian: true }))
    }

    /// An `int` of the format: 4 bytes in binary files.
    pub(super) fn int(&mut self, what: &'static str) -> Result<i64> {
        if self.encoding == Encoding::Text {
            return self.parsed(what, "a whole number");
        }
        let (raw, big) = self.raw(what)?;
        Ok(i64::from(if big { i32::from_be_bytes(raw) } else { i32::from_le_bytes(raw) }))
    }

    /// A `size_t` of the format: 8 bytes in binary files.
    pub(super) fn size(&mut self, what: &'static str) -> Result<i64> {
        if self.encoding == Encoding::Text {
            return self.parsed(what, "a whole number");
        }
        let (raw, big) = self.raw(what)?;
        Ok(if big { i64::from_be_bytes(raw) } else { i64::from_le_bytes(raw) })
    }

    pub(super) fn double(&mut self, what: &'static str) -> Result<f64> {
        if self.encoding == Encoding::Text {
            return self.parsed(what, "a number");
        }
        let (raw, big) = self.raw(what)?;
        Ok(if big { f64::from_be_bytes(raw) } else { f64::from_le_bytes(raw) })
    }

    /// A count of items that take at least `bytes` each in a binary file, and two characters in a
    /// text.
    pub(super) fn count(&mut self, what: &'static str, bytes: usize) -> Result<usize> {
        let count = self.size(what)?;
        self.room(what, count, bytes)
    }

    /// Checks that the file is large enough for a count.
    pub(super) fn room(&self, what: &'static str, count: i64, bytes: usize) -> Result<usize> {
        let each = if self.encoding == Encoding::Text { 2 } else { bytes };
        let fits =
            usize::try_from(count).ok().filter(|n| n.checked_mul(each).is_some_and(|all| all <= self.left()));
        fits.ok_or_else(|| self.error(Fault::Count { what, count: count.max(0) as u64, left: self.left() }))
    }

    /// The end of a line in a text; nothing in a binary file.
    pub(super) fn end_row(&mut self) -> Result<()> {
        if self.encoding != Encoding::Text {
            return Ok(());
        }
        let remaining = &self.bytes[self.at..];
        let end = remaining.iter().position(|b| *b == b'\n').unwrap_or(remaining.len());
        let more = remaining[..end].trim_ascii();
        if !more.is_empty() {
            let fault = Fault::LongLine(String::from_utf8_lossy(more).chars().take(40).collect());
            return Err(self.error(fault));
        }
        self.at = (self.at + end + 1).min(self.bytes.len());
        self.line += 1;
        Ok(())
    }

    /// Reads as text what even binary files store as text.
    pub(super) fn as_text<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let encoding = std::mem::replace(&mut self.encoding, Encoding::Text);
        let value = read(self);
        let byte = self.at;
        self.encoding = encoding;
        value.map_err(|mut error| {
            if encoding != Encoding::Text {
                error.place = Place::Byte(byte);
            }
            error
        })
    }
}
