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

/// Colour of a signed value between −1 and 1; white is zero.
pub(crate) fn diverging(value: f64) -> String {
    let x = (value.clamp(-1.0, 1.0) + 1.0) * 5.0;
    let i = (x as usize).min(9);
    let s = x - i as f64;
    let [r, g, b] = [0, 1, 2].map(|c| (DIVERGING[i][c] * (1.0 - s) + DIVERGING[i + 1][c] * s).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Colours of successive instants from dark to light: the darker three quarters of cividis
/// (J. R. Nuñez et al., PLOS ONE 13(7), 2018).
pub(crate) fn sequence(i: usize, n: usize) -> &'static str {
    const STEPS: [&str; 5] = ["#00224e", "#3b496c", "#6c6e72", "#9a9376", "#c9b764"];
    STEPS[(i * STEPS.len() / n.max(1)).min(STEPS.len() - 1)]
}
