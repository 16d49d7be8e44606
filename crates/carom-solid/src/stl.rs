//! Triangles of a file in STL, binary or text (3D Systems, Stereolithography Interface
//! Specification). Corners that coincide exactly are one vertex; the normals of the file are not
//! read, since the order of the corners gives them.

use std::collections::HashMap;
use std::io::Cursor;

use crate::triangles::{Triangles, TrianglesError};

/// Bytes before the first triangle of a binary file, and of every triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Why a file in STL gave no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StlError {
    /// It cannot be read.
    #[error("triangle {triangle} cannot be read: {why}")]
    Format {
        /// Its number, from 1.
        triangle: usize,
        /// Why.
        why: String,
    },
    /// It ends before its end.
    #[error("it ends early: {0}")]
    Cut(String),
    /// Its triangles are not a surface.
    #[error("{0}")]
    Surface(TrianglesError),
}

/// Reads a file in STL.
///
/// # Errors
/// A violation of the format, with the number of the triangle; triangles that are not a surface.
pub fn read(bytes: &[u8]) -> Result<Triangles, StlError> {
    if let Some(end) = cut(bytes) {
        return Err(StlError::Cut(end));
    }
    let mut bytes = bytes.to_vec();
    let format = |triangle: usize, why: String| StlError::Format { triangle, why };
    if is_binary(&bytes) {
        // Whatever the title is: texts begin with `solid`, and so do some binary files.
        bytes[0] = b' ';
    }
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    let mut number: HashMap<[u64; 3], usize> = HashMap::new();
    let mut file = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut file).map_err(|error| format(1, error.to_string()))?;
    for (k, triangle) in triangles.enumerate() {
        let triangle = triangle.map_err(|error| format(k + 1, error.to_string()))?;
        let mut nodes = [0; 3];
        for (node, corner) in nodes.iter_mut().zip(triangle.vertices) {
            // −0 is 0.
            let x = corner.0.map(|x| f64::from(x) + 0.0);
            if !x.iter().all(|x| x.is_finite()) {
                return Err(format(k + 1, "its coordinates are not finite".to_owned()));
            }
            *node = *number.entry(x.map(f64::to_bits)).or_insert_with(|| {
                points.push(x);
                points.len() - 1
            });
        }
        corners.push(nodes);
    }
    Triangles::new(points, corners).map_err(StlError::Surface)
}

/// Where a file ends early: a text before `endsolid`, a binary file before its last triangle.
fn cut(bytes: &[u8]) -> Option<String> {
    if is_binary(bytes) || bytes.is_empty() {
        return None;
    }
    if bytes.trim_ascii_start().starts_with(b"solid") && !bytes.contains(&0) {
        let lines = bytes.trim_ascii_end().split(|byte| *byte == b'\n');
        let (mut count, mut last, mut triangles) = (0, &b""[..], 0);
        for line in lines {
            (count, last) = (count + 1, line.trim_ascii());
            triangles += usize::from(last == b"endfacet");
        }
        let is_whole = last.starts_with(b"endsolid");
        return (!is_whole && is_beginning(last)).then(|| {
            format!("line {count} is the last one, after {triangles} triangles, and `endsolid` is missing")
        });
    }
    // No text: the count of the triangles of a binary file has a byte of zero.
    let count = bytes.get(80..HEADER).filter(|_| bytes.contains(&0))?;
    let count = u32::from_le_bytes(count.try_into().ok()?);
    let whole = HEADER + TRIANGLE * count as usize;
    (bytes.len() < whole).then(|| {
        let triangles = (bytes.len() - HEADER) / TRIANGLE;
        format!(
            "byte {} is the last one, in triangle {}, and {count} triangles need {whole}",
            bytes.len(),
            triangles + 1
        )
    })
}

/// Whether a line begins like one of a text in STL.
fn is_beginning(line: &[u8]) -> bool {
    let first = line.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    let words = ["solid", "facet", "outer", "vertex", "endloop", "endfacet", "endsolid"];
    words.iter().any(|word| word.as_bytes().starts_with(first))
}

/// Whether a file has the length that its count of triangles implies.
fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(80..HEADER).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    count.is_some_and(|count| bytes.len() == HEADER + TRIANGLE * count as usize)
}
