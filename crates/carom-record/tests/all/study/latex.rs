//! `ranking.tex`: the ranking as a table for a paper, one row per arm.

use carom_record::study::latex::{escaped, number};

#[test]
fn texts_and_numbers_are_written_for_latex() {
    assert_eq!(escaped("CH_a, ρ∞ = 50 %"), "CH\\_a, $\\rho$$_\\infty$ = 50 \\%");
    assert_eq!([number(1.875e-4), number(0.25)], ["$1.88\\times10^{-4}$", "0.25"]);
}
