//! `ranking.tex`: the ranking as a table for a paper, one row per arm.

use std::fmt::Write as _;

use super::Study;
use super::arm::step;
use super::digits::short;
use super::ranking::{Ranked, Ranking};

/// Signs that LaTeX gives a meaning, and letters that are not in its fonts.
const SIGNS: [(char, &str); 24] = [
    ('\\', "\\textbackslash{}"),
    ('&', "\\&"),
    ('%', "\\%"),
    ('$', "\\$"),
    ('#', "\\#"),
    ('_', "\\_"),
    ('{', "\\{"),
    ('}', "\\}"),
    ('^', "\\textasciicircum{}"),
    ('~', "\\textasciitilde{}"),
    ('−', "$-$"),
    ('×', "$\\times$"),
    ('≤', "$\\le$"),
    ('²', "$^2$"),
    ('μ', "$\\mu$"),
    ('β', "$\\beta$"),
    ('γ', "$\\gamma$"),
    ('λ', "$\\lambda$"),
    ('ρ', "$\\rho$"),
    ('∞', "$_\\infty$"),
    ('α', "$\\alpha$"),
    ('θ', "$\\theta$"),
    ('Δ', "$\\Delta$"),
    ('–', "--"),
];

/// A text with the characters that LaTeX reserves.
pub fn escaped(text: &str) -> String {
    let sign = |c: char| SIGNS.iter().find(|(sign, _)| *sign == c).map(|(_, written)| *written);
    text.chars().map(|c| sign(c).map_or_else(|| c.to_string(), str::to_owned)).collect()
}

/// A number in mathematical notation.
pub fn number(x: f64) -> String {
    let text = short(x);
    match text.split_once('e') {
        Some((digits, power)) => format!("${digits}\\times10^{{{power}}}$"),
        None => text,
    }
}

impl Study {
    /// The ranking as a LaTeX table; needs no package. The recommended arm is bold.
    pub(super) fn latex(&self, ranking: &Ranking) -> String {
        let start = self.metrics().into_iter().find(|metric| metric.name == "contact_start");
        let unit = start.map(|start| escaped(&start.unit)).filter(|unit| !unit.is_empty());
        let time = unit.map_or_else(String::new, |unit| format!(" ({unit})"));
        let words = ranking.measure.as_ref().map_or(String::new(), |measure| escaped(&measure.words));
        let mut out = format!(
            "% {words}\n\\begin{{tabular}}{{rlrrrrr}}\n\\hline\n\
             Place & Method & $\\Delta t${time} & Error & Interval & Noise & Cost \\\\\n\\hline\n"
        );
        for ranked in ranking.levels.iter().flatten() {
            let _ = writeln!(out, "{} \\\\", self.latex_row(ranking, ranked).join(" & "));
        }
        out + "\\hline\n\\end{tabular}\n"
    }

    fn latex_row(&self, ranking: &Ranking, ranked: &Ranked) -> [String; 7] {
        let arm = &self.manifest.arms[ranked.arm];
        let name = escaped(arm.method());
        let is_chosen = ranking.verdict.as_ref().is_ok_and(|verdict| verdict.arm == ranked.arm);
        let [low, high] = ranked.interval.map(number);
        [
            ranked.place.to_string(),
            if is_chosen { format!("\\textbf{{{name}}}") } else { name },
            step(arm, "time.step").map_or_else(String::new, number),
            number(ranked.error),
            format!("{low} to {high}"),
            ranked.noise.map_or_else(String::new, number),
            format!("{:.0}", ranked.cost),
        ]
    }
}
