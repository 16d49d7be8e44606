//! Triangles of a file in STL, binary or text (3D Systems, Stereolithography Interface
//! Specification). Corners that coincide exactly are one vertex; the normals of the file are not
//! read, since the order of the corners gives them.
//!
//! The file is read to its last byte or not at all: all solids of a text are one list of triangles,
//! and a binary file has exactly the length that its count of triangles implies. Solids that touch
//! along whole faces are one (`united.rs`).

mod error;
mod text;
mod united;

use std::collections::HashMap;

use crate::triangles::{Corners, Triangles};

pub use error::StlError;

/// Bytes before the first triangle of a binary file, and of every triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads a file in STL.
///
/// # Errors
/// A violation of the format, with the line or the number of the triangle; triangles that are not a
/// surface.
pub fn read(bytes: &[u8]) -> Result<Triangles, StlError> {
    // The length decides: texts begin with `solid`, and so do some binary files.
    let triangles = match count(bytes) {
        Some(count) if bytes.len() == length(count) => binary(bytes)?,
        // Hardly a binary file is without a byte of zero, and no text has one.
        _ if text::is_text(bytes) && !bytes.contains(&0) => text::triangles(bytes)?,
        Some(count) if bytes.contains(&0) => return Err(of_another_length(bytes.len(), count)),
        _ if bytes.is_empty() => return Err(StlError::Format("the file is empty".to_owned())),
        _ => {
            let what = format!(
                "it neither begins with `solid`, as a text does, nor has the {HEADER} bytes of a binary header"
            );
            return Err(StlError::Format(what));
        }
    };
    let (points, corners) = vertices(&triangles);
    let inner = united::inner(&triangles, &corners);
    if !inner.contains(&true) {
        return Triangles::new(points, corners).map_err(StlError::Surface);
    }
    let outer: Vec<Corners> =
        triangles.iter().zip(&inner).filter(|(_, inner)| !**inner).map(|(triangle, _)| *triangle).collect();
    let (points, corners) = vertices(&outer);
    let surface = Triangles::new(points, corners).map_err(StlError::Surface)?;
    Ok(surface.without(triangles.len() - outer.len()))
}

/// The vertices of triangles, and their numbers at the corners.
fn vertices(triangles: &[Corners]) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let mut points = Vec::new();
    let mut number: HashMap<[u64; 3], usize> = HashMap::new();
    let mut of_corner = |corner: [f64; 3]| {
        // −0 is 0.
        let x = corner.map(|x| x + 0.0);
        *number.entry(x.map(f64::to_bits)).or_insert_with(|| {
            points.push(x);
            points.len() - 1
        })
    };
    let corners = triangles.iter().map(|triangle| triangle.map(&mut of_corner)).collect();
    (points, corners)
}

/// The number of triangles that a binary file states.
fn count(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(80..HEADER)?.try_into().ok()?;
    Some(u64::from(u32::from_le_bytes(count)))
}

/// Bytes of a binary file of so many triangles.
fn length(count: u64) -> usize {
    HEADER + TRIANGLE * count as usize
}

fn binary(bytes: &[u8]) -> Result<Vec<Corners>, StlError> {
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE).enumerate().map(|(k, triangle)| {
        let (numbers, _) = triangle.as_chunks::<4>();
        // The normal is before the corners.
        let corners = [3, 6, 9]
            .map(|first| std::array::from_fn(|axis| f64::from(f32::from_le_bytes(numbers[first + axis]))));
        if corners.as_flattened().iter().all(|x: &f64| x.is_finite()) {
            Ok(corners)
        } else {
            Err(StlError::Format(format!("the coordinates of triangle {} are not finite", k + 1)))
        }
    });
    triangles.collect()
}

/// Why a binary file has not the length of so many triangles.
fn of_another_length(bytes: usize, count: u64) -> StlError {
    let whole = length(count);
    if bytes > whole {
        return StlError::Format(format!(
            "its header states {count} triangles, which end at byte {whole}, but the file has {bytes} bytes"
        ));
    }
    let triangle = (bytes - HEADER) / TRIANGLE + 1;
    StlError::Cut(format!(
        "byte {bytes} is the last one, in triangle {triangle}, and {count} triangles need {whole}"
    ))
}
