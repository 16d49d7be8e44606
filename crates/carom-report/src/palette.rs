//! Colours that remain distinct for colour-blind readers and in greyscale print.

/// Line colours: M. Okabe and K. Ito, "Color Universal Design", black first, without yellow, which
/// is too light for print.
pub(crate) const LINES: [&str; 7] =
    ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// RdBu of ColorBrewer (C. Brewer; colour-blind safe), blue for compression, from −1 to 1 in ten
/// steps.
const DIVERGING: [[f64; 3]; 11] = [
    [5.0, 48.0, 97.0],
    [33.0, 102.0, 172.0],
    [67.0, 147.0, 195.0],
    [146.0, 197.0, 222.0],
    [209.0, 229.0, 240.0],
    [247.0, 247.0, 247.0],
    [253.0, 219.0, 199.0],
    [244.0, 165.0, 130.0],
    [214.0, 96.0, 77.0],
    [178.0, 24.0, 43.0],
    [103.0, 0.0, 31.0],
];

/// YlOrRd of ColorBrewer from 0 to 1 in eight steps: darker is more, in print without colours too.
const SEQUENTIAL: [[f64; 3]; 9] = [
    [255.0, 255.0, 204.0],
    [255.0, 237.0, 160.0],
    [254.0, 217.0, 118.0],
    [254.0, 178.0, 76.0],
    [253.0, 141.0, 60.0],
    [252.0, 78.0, 42.0],
    [227.0, 26.0, 28.0],
    [189.0, 0.0, 38.0],
    [128.0, 0.0, 38.0],
];

/// The colour at a position between 0 and 1 of a scale.
fn mixed(scale: &[[f64; 3]], position: f64) -> String {
    let x = position.clamp(0.0, 1.0) * (scale.len() - 1) as f64;
    let i = (x as usize).min(scale.len() - 2);
    let s = x - i as f64;
    let [r, g, b] = [0, 1, 2].map(|c| (scale[i][c] * (1.0 - s) + scale[i + 1][c] * s).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Colour of a signed value between −1 and 1; white is zero.
pub(crate) fn diverging(value: f64) -> String {
    mixed(&DIVERGING, 0.5 * (value + 1.0))
}

/// Colour of a value between 0 and 1.
pub(crate) fn sequential(value: f64) -> String {
    mixed(&SEQUENTIAL, value)
}

/// The parts red, green and blue of a colour `#rrggbb`.
pub(crate) fn rgb(color: &str) -> [u8; 3] {
    let part = |c: usize| color.get(1 + 2 * c..3 + 2 * c).and_then(|text| u8::from_str_radix(text, 16).ok());
    [0, 1, 2].map(|c| part(c).unwrap_or(0))
}

/// Colours of successive instants from dark to light: the first four fifths of plasma (S. van der
/// Walt and N. Smith, matplotlib 1.5). The style sheet has lighter ones for a dark ground.
pub(crate) fn sequence(i: usize, n: usize) -> &'static str {
    const STEPS: [&str; 5] = ["#0d0887", "#6a00a8", "#b12a90", "#e16462", "#fca636"];
    STEPS[(i * STEPS.len() / n.max(1)).min(STEPS.len() - 1)]
}
