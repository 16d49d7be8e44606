//! Pieces as an image with a depth for each pixel.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::pieces::{EDGE, LINE, Paint, Piece};
use super::skin::Place;
use crate::again::Rectangle;
use crate::palette::rgb;
use crate::pen::{NOTHING, Point, around};

/// Pixels of the image per pixel of the page, and samples along each side of one of them.
const DENSITY: usize = 2;
const SAMPLES: usize = 2;

/// A rectangle of the page, sample by sample.
struct Samples {
    width: usize,
    height: usize,
    depth: Vec<f64>,
    color: Vec<[u8; 3]>,
}

/// Twice the signed area of a triangle of the page.
fn area(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

impl Samples {
    /// Draws the samples of a triangle that are not hidden; its corners are in samples.
    fn fill(&mut self, piece: &Piece, corners: [Place; 3], colors: &[[u8; 3]], paint: &Paint, edge: f64) {
        let flat = corners.map(|[x, y, _]| [x, y]);
        let whole = area(flat[0], flat[1], flat[2]);
        if whole == 0.0 || !whole.is_finite() {
            return;
        }
        let line = rgb(LINE);
        let length = |side: usize| {
            let [a, b] = [flat[side], flat[(side + 1) % 3]];
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        let lengths = [0, 1, 2].map(length);
        let box_of = around(NOTHING, flat);
        let span = |d: usize, end: usize| {
            let [low, high] = [box_of[2 * d], box_of[2 * d + 1]];
            (low - 0.5).ceil().max(0.0) as usize
                ..((high - 0.5).floor().max(-1.0) + 1.0).min(end as f64) as usize
        };
        for y in span(1, self.height) {
            for x in span(0, self.width) {
                let p = [x as f64 + 0.5, y as f64 + 0.5];
                // Weights of the corners; that of corner k is the distance from the opposite side.
                let weights = [0, 1, 2].map(|k: usize| area(flat[(k + 1) % 3], flat[(k + 2) % 3], p) / whole);
                if weights.iter().any(|w| *w < 0.0) {
                    continue;
                }
                let mix = |f: &dyn Fn(usize) -> f64| (0..3).map(|k| weights[k] * f(k)).sum::<f64>();
                let depth = mix(&|k| corners[k][2]);
                let at = y * self.width + x;
                if depth <= self.depth[at] {
                    continue;
                }
                self.depth[at] = depth;
                let near = |side: usize| weights[(side + 2) % 3] * whole.abs() < edge * lengths[side];
                let on_edge = (0..3).any(|side| piece.edges[side] && near(side));
                let value = mix(&|k| piece.values[k]);
                self.color[at] = if on_edge {
                    line
                } else if value.is_finite() {
                    paint.lit(colors[paint.of(value)], piece.brightness)
                } else {
                    [255; 3]
                };
            }
        }
    }
}

/// A PNG file of pixels red, green, blue (ISO/IEC 15948), of which those that are white are clear.
fn png(width: usize, height: usize, pixels: &[u8]) -> Vec<u8> {
    // Each row is preceded by the number of its filter: 1, differences from the pixel to the left.
    let row = |row: &[u8]| {
        let before = |k: usize| k.checked_sub(3).map_or(0, |k| row[k]);
        std::iter::once(1).chain((0..row.len()).map(|k| row[k].wrapping_sub(before(k)))).collect::<Vec<u8>>()
    };
    let rows: Vec<u8> = pixels.chunks(3 * width).flat_map(row).collect();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |name: &[u8], data: &[u8]| {
        let named = [name, data].concat();
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(&named);
        file.extend(checksum(&named).to_be_bytes());
    };
    // Eight bits for each of three colours, no interlacing.
    let header = [&(width as u32).to_be_bytes()[..], &(height as u32).to_be_bytes(), &[8, 2, 0, 0, 0]];
    chunk(b"IHDR", &header.concat());
    chunk(b"tRNS", &[0, 255, 0, 255, 0, 255]);
    chunk(b"IDAT", &miniz_oxide::deflate::compress_to_vec_zlib(&rows, 6));
    chunk(b"IEND", &[]);
    file
}

/// The cyclic redundancy check of PNG and ISO 3309.
fn checksum(bytes: &[u8]) -> u32 {
    let step = |c: u32, byte: &u8| {
        (0..8).fold(c ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    };
    !bytes.iter().fold(u32::MAX, step)
}

/// A rectangle of the page as an SVG image of the pieces.
pub(crate) fn image(pieces: &[Piece], paint: &Paint, [left, top, wide, high]: Rectangle) -> String {
    let fine = DENSITY * SAMPLES;
    let [across, down] = [wide, high].map(|s| (s * DENSITY as f64).ceil().max(1.0) as usize);
    let width = across * SAMPLES;
    let height = down * SAMPLES;
    let depth = vec![f64::NEG_INFINITY; width * height];
    let color = vec![[255; 3]; width * height];
    let mut samples = Samples { width, height, depth, color };
    let colors: Vec<[u8; 3]> = (0..paint.count()).map(|number| paint.rgb(number)).collect();
    for piece in pieces {
        let scaled = |[x, y, z]: Place| [(x - left) * fine as f64, (y - top) * fine as f64, z];
        samples.fill(piece, piece.corners.map(scaled), &colors, paint, 0.5 * EDGE * fine as f64);
    }
    let mut pixels = Vec::with_capacity(3 * across * down);
    for (y, x) in (0..down).flat_map(|y| (0..across).map(move |x| (y, x))) {
        for part in 0..3 {
            let of = |k: usize| {
                let at = (y * SAMPLES + k / SAMPLES) * width + x * SAMPLES + k % SAMPLES;
                u32::from(samples.color[at][part])
            };
            pixels.push(((0..SAMPLES * SAMPLES).map(of).sum::<u32>() / (SAMPLES * SAMPLES) as u32) as u8);
        }
    }
    format!(
        "<image x=\"{left:.2}\" y=\"{top:.2}\" width=\"{:.2}\" height=\"{:.2}\" \
         href=\"data:image/png;base64,{}\"/>\n",
        across as f64 / DENSITY as f64,
        down as f64 / DENSITY as f64,
        STANDARD.encode(png(across, down, &pixels))
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the catalogue of cyclic redundancy checks.
    #[test]
    fn checksum_of_the_digits() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }

    /// Of two triangles that cut each other, the nearer one is seen on either side of the cut.
    #[test]
    fn the_nearer_triangle_is_seen() {
        let piece = |value: f64, [p, q, r]: [f64; 3]| Piece {
            corners: [[0.0, 0.0, p], [20.0, 0.0, q], [0.0, 20.0, r]],
            values: [value; 3],
            brightness: 1.0,
            edges: [false; 3],
        };
        let paint = Paint::Parts(&["#ff0000", "#0000ff"]);
        let colors = [paint.rgb(0), paint.rgb(1)];
        let mut samples = Samples {
            width: 20,
            height: 20,
            depth: vec![f64::NEG_INFINITY; 400],
            color: vec![[255; 3]; 400],
        };
        for piece in [piece(0.0, [0.0, 10.0, 0.0]), piece(1.0, [5.0; 3])] {
            samples.fill(&piece, piece.corners, &colors, &paint, 0.5);
        }
        // The first one is at depth x/2, the second one at 5.
        for (at, color) in samples.color.iter().enumerate() {
            let x = (at % 20) as f64 + 0.5;
            let y = (at / 20) as f64 + 0.5;
            let seen = if x + y > 20.0 { [255; 3] } else { colors[usize::from(x < 10.0)] };
            assert_eq!(*color, seen, "{x} {y}");
        }
    }
}
