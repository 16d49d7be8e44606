//! Texts in STL: one or more solids, whose words are in either case and between any white space.
//! What follows `solid` and `endsolid` in their line is a name.
//!
//! ```text
//! solid NAME
//!   facet normal N N N  outer loop  vertex X Y Z  vertex X Y Z  vertex X Y Z  endloop  endfacet
//! endsolid NAME
//! ```

use super::error::StlError;
use crate::triangles::Corners;

/// The byte order mark that editors write before a text in UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Whether a file begins like a text.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    Words::new(bytes).next().is_some_and(|word| is(word, "solid"))
}

/// The triangles of all solids of a text.
pub(super) fn triangles(bytes: &[u8]) -> Result<Vec<Corners>, StlError> {
    let mut words = Words::new(bytes);
    let mut triangles = Vec::new();
    loop {
        words.one_of(&["solid"], triangles.len())?;
        words.skip_line();
        while words.one_of(&["facet", "endsolid"], triangles.len())? == "facet" {
            let triangle = words.facet(triangles.len())?;
            triangles.push(triangle);
        }
        words.skip_line();
        if words.clone().next().is_none() {
            return Ok(triangles);
        }
    }
}

fn is(word: &[u8], wanted: &str) -> bool {
    word.eq_ignore_ascii_case(wanted.as_bytes())
}

/// The words of a text from a place on.
#[derive(Clone)]
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: if bytes.starts_with(MARK) { MARK.len() } else { 0 } }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        let is_space = u8::is_ascii_whitespace;
        self.at += self.bytes[self.at..].iter().take_while(|byte| is_space(byte)).count();
        let rest = &self.bytes[self.at..];
        let word = &rest[..rest.iter().position(is_space).unwrap_or(rest.len())];
        self.at += word.len();
        (!word.is_empty()).then_some(word)
    }

    /// Goes to the end of the line: LF, CR LF or, in old files, CR.
    fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|byte| b"\r\n".contains(byte)).unwrap_or(rest.len());
    }

    /// The corners of a facet after its first word; `before`: triangles read before it.
    fn facet(&mut self, before: usize) -> Result<Corners, StlError> {
        self.one_of(&["normal"], before)?;
        for _ in 0..3 {
            self.next();
        }
        self.one_of(&["outer"], before)?;
        self.one_of(&["loop"], before)?;
        let mut corners = Corners::default();
        for corner in &mut corners {
            self.one_of(&["vertex"], before)?;
            for x in corner {
                *x = self.number(before)?;
            }
        }
        self.one_of(&["endloop"], before)?;
        self.one_of(&["endfacet"], before)?;
        Ok(corners)
    }

    /// The next word, which must be one of these.
    fn one_of(&mut self, wanted: &[&'static str], triangles: usize) -> Result<&'static str, StlError> {
        let word = self.next().unwrap_or_default();
        if let Some(found) = wanted.iter().find(|wanted| is(word, wanted)) {
            return Ok(found);
        }
        let begins = |wanted: &&str| wanted.get(..word.len()).is_some_and(|start| is(word, start));
        let names: Vec<String> = wanted.iter().map(|wanted| format!("`{wanted}`")).collect();
        Err(self.unexpected(word, &names.join(" or "), wanted.iter().any(begins), triangles))
    }

    fn number(&mut self, triangles: usize) -> Result<f64, StlError> {
        let word = self.next().unwrap_or_default();
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number
            .filter(|x: &f64| x.is_finite())
            .ok_or_else(|| self.unexpected(word, "a finite number", true, triangles))
    }

    /// The error of a word just read; `begins`: whether it may be the beginning of what is wanted.
    fn unexpected(&self, word: &[u8], wanted: &str, begins: bool, triangles: usize) -> StlError {
        let before = self.bytes[..self.at - word.len()].trim_ascii_end();
        let until = if word.is_empty() { before } else { &self.bytes[..self.at] };
        let ends = until.iter().enumerate().filter(|(i, byte)| match byte {
            b'\n' => true,
            b'\r' => until.get(i + 1) != Some(&b'\n'),
            _ => false,
        });
        let line = ends.count() + 1;
        if word.is_empty() || (begins && self.at == self.bytes.len()) {
            return StlError::Cut(format!(
                "line {line} is the last one, after {triangles} triangles, and {wanted} is missing"
            ));
        }
        let found: String = String::from_utf8_lossy(word).chars().take(40).collect();
        StlError::Format(format!("line {line}: expected {wanted}, found `{found}`"))
    }
}
