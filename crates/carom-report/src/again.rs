//! Parts of the broad picture of a figure that the narrow one shows again, so that a page holds
//! them once.

use std::fmt::Write as _;

/// A rectangle in pixels: left, top, width, height.
pub(crate) type Rectangle = [f64; 4];

/// Adds `content` with a name, which must be unique on its page, and the class of its picture: for
/// a dark page, the ancestors of a copy are not those of the original.
pub(crate) fn once(out: &mut String, name: &str, class: &str, content: &str) {
    let _ = write!(out, "<g id=\"{name}\" class=\"{class}\">\n{content}</g>\n");
}

/// Adds the content of that name again, with the first rectangle moved to the second.
pub(crate) fn again(out: &mut String, name: &str, from: Rectangle, to: Rectangle) {
    let scale = [0, 1].map(|d| to[d + 2] / from[d + 2]);
    let by = [0, 1].map(|d| to[d] - scale[d] * from[d]);
    let _ = writeln!(
        out,
        "<use href=\"#{name}\" transform=\"matrix({:.5} 0 0 {:.5} {:.2} {:.2})\"/>",
        scale[0], scale[1], by[0], by[1]
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 10 to 30 becomes 5 to 15, and 0 to 4 becomes 100 to 104.
    #[test]
    fn a_rectangle_is_moved_to_another() {
        let mut out = String::new();
        again(&mut out, "a", [10.0, 0.0, 20.0, 4.0], [5.0, 100.0, 10.0, 4.0]);
        assert_eq!(out, "<use href=\"#a\" transform=\"matrix(0.50000 0 0 1.00000 0.00 100.00)\"/>\n");
    }
}
