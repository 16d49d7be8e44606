//! Explanations as text for a terminal, and the table over the catalogue.
use std::fmt::{Display, Formatter, Result};

use serde::Serialize;

use crate::explain::{Accuracy, Explanation};
use crate::explained::Explained;
use crate::name::short;
use crate::nonsmooth_text::NonsmoothExplanation;
use crate::scheme::{ForceRule, Scheme};
use crate::schemes::KINDS;

/// ξ and PE without noise in the last digits.
fn cell(x: Option<f64>, scale: f64) -> String {
    match x.map(|x| x * scale) {
        None => "–".to_owned(),
        Some(x) if x.abs() < 1e-12 => "0".to_owned(),
        Some(x) if x.abs() < 1e-3 => format!("{x:.1e}"),
        Some(x) => format!("{x:.4}"),
    }
}

fn list<T: Display>(f: &mut Formatter, title: &str, items: &[T]) -> Result {
    if items.is_empty() {
        return Ok(());
    }
    writeln!(f, "\n{title}")?;
    items.iter().try_for_each(|item| writeln!(f, "  {item}"))
}

impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let rule = match self.scheme.map(|scheme| scheme.forces) {
            None => "",
            Some(ForceRule::AverageForces) => "forces averaged   ",
            Some(ForceRule::AverageState) => "state averaged   ",
        };
        if let Some((name, others)) = self.names.split_first() {
            writeln!(f, "{name}   {rule}{}", self.references.join("; "))?;
            list(f, "the same as", others)?;
        }
        writeln!(f, "\nparameters")?;
        for convention in &self.conventions {
            let values: Vec<_> = convention
                .values
                .iter()
                .map(|(symbol, value)| format!("{symbol} = {}", short(*value)))
                .collect();
            writeln!(f, "  {}\n      {}", convention.name, values.join("   "))?;
        }
        let stable = if self.a_stable { "unconditionally stable" } else { "not unconditionally stable" };
        writeln!(
            f,
            "\norder {}   ρ∞ = {}   {stable} (linear motion)",
            self.order,
            cell(Some(self.rho_inf), 1.0)
        )?;
        writeln!(f, "\n  {:>6} {:>10} {:>12} {:>10}", "T/Δt", "ρ", "damping ξ", "PE %")?;
        for Accuracy { steps_per_period, spectral_radius, damping_ratio, period_error } in &self.accuracy {
            let (damping, period) = (cell(*damping_ratio, 1.0), cell(*period_error, 100.0));
            writeln!(f, "  {steps_per_period:>6} {spectral_radius:>10.6} {damping:>12} {period:>10}")?;
        }
        list(f, "conserves", &self.conserves)?;
        list(f, "a dof constrained by contact", &[&self.constrained.text])?;
        list(f, "remarks", &self.remarks)?;
        let elsewhere: Vec<_> =
            self.elsewhere.iter().map(|fact| format!("{}: {}", fact.code, fact.note)).collect();
        list(f, "elsewhere", &elsewhere)
    }
}

/// A line of the [`Catalogue`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CatalogueRow {
    /// Name in a case file.
    pub kind: &'static str,
    /// The displayed parameters, in words.
    pub parameters: String,
    /// The resulting scheme, in the α family.
    pub scheme: Option<Scheme>,
    /// Order on smooth motion.
    pub order: u8,
    /// Spectral radius at infinity.
    pub rho_inf: f64,
    /// Accuracy at ten steps per period.
    pub accuracy: Accuracy,
    /// Steps for which a constrained dof rings; none: for ever.
    pub constrained_steps: Option<u32>,
}

/// Typical members of every kind, in a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Catalogue {
    /// In the order of the catalogue.
    pub rows: Vec<CatalogueRow>,
    /// Those with their own contact law.
    pub nonsmooth: Vec<NonsmoothExplanation>,
}

/// The catalogue as a table.
///
/// ```
/// let hu = carom_time::explain_all().rows.into_iter().find(|row| row.kind == "hu");
/// assert_eq!(hu.map(|row| (row.order, row.rho_inf, row.constrained_steps)), Some((1, 0.0, Some(2))));
/// ```
pub fn explain_all() -> Catalogue {
    let mut table = Catalogue { rows: Vec::new(), nonsmooth: Vec::new() };
    let shown = KINDS.iter().flat_map(|kind| kind.members.iter().map(move |member| (kind, member)));
    for (kind, member) in shown.filter(|(_, member)| member.shown) {
        match kind.named(member).integrator(ForceRule::AverageForces).map(|made| made.explain()) {
            Ok(Explained::Stages(scheme)) => table.rows.extend(row(kind.name, member.parameters, *scheme)),
            Ok(Explained::Nonsmooth(scheme)) => table.nonsmooth.push(scheme),
            Err(_) => {}
        }
    }
    table
}

fn row(kind: &'static str, parameters: &[(&str, f64)], explanation: Explanation) -> Option<CatalogueRow> {
    // Raw parameters have their own columns.
    let shown = if parameters.len() > 2 { &[] } else { parameters };
    let words: Vec<_> = shown.iter().map(|(key, value)| format!("{key} {value}")).collect();
    Some(CatalogueRow {
        kind,
        parameters: words.join(", "),
        scheme: explanation.scheme,
        order: explanation.order,
        rho_inf: explanation.rho_inf,
        accuracy: explanation.accuracy.into_iter().find(|a| a.steps_per_period == 10)?,
        constrained_steps: explanation.constrained.steps,
    })
}

impl Display for Catalogue {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let heads = ["α_m", "α_f", "β", "γ", "order", "ρ∞", "ξ(T/10)", "PE(T/10)", "constrained"];
        write!(f, "{:<18}{:<24}", "kind", "parameters")?;
        heads.iter().try_for_each(|head| write!(f, "{head:>10}"))?;
        writeln!(f)?;
        for row in &self.rows {
            write!(f, "{:<18}{:<24}", row.kind, row.parameters)?;
            match row.scheme {
                Some(Scheme { alpha_m, alpha_f, beta, gamma, .. }) => {
                    write!(f, "{alpha_m:>10.4}{alpha_f:>10.4}{beta:>10.4}{gamma:>10.4}")?;
                }
                None => write!(f, "{:>10}{:>10}{:>10}{:>10}", "–", "–", "–", "–")?,
            }
            let (xi, pe) = (cell(row.accuracy.damping_ratio, 1.0), cell(row.accuracy.period_error, 100.0));
            let constrained = row.constrained_steps.map_or("∞".to_owned(), |steps| steps.to_string());
            writeln!(
                f,
                "{:>10}{:>10.3}{xi:>10}{:>10}{constrained:>10}",
                row.order,
                row.rho_inf,
                format!("{pe} %")
            )?;
        }
        writeln!(
            f,
            "\nwith a contact law of their own{:>51}{:>10}{:>10}{:>10}",
            "order", "ρ∞", "ξ(T/10)", "PE(T/10)"
        )?;
        for explanation in &self.nonsmooth {
            let words: Vec<_> =
                explanation.parameters.iter().map(|(key, value)| format!("{key} {value:.3}")).collect();
            let rho = explanation.rho_inf.map_or("ωΔt ≤ 2".to_owned(), |rho| format!("{rho:.3}"));
            let tenth = explanation.accuracy.iter().find(|row| row.steps_per_period == 10);
            let (xi, pe) = tenth.map_or((None, None), |row| (row.damping_ratio, row.period_error));
            write!(f, "{:<32}{:<42}{:>8}{rho:>10}", explanation.kind, words.join(", "), explanation.order)?;
            writeln!(f, "{:>10}{:>10}", cell(xi, 1.0), format!("{} %", cell(pe, 100.0)))?;
        }
        write!(
            f,
            "\nIndex s + 1 − α. ξ, PE: damping and lengthening of a period of ten steps. constrained: steps a dof constrained by contact rings above 1 % of v₀/Δt."
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explain;

    /// All but statics, which integrates nothing.
    #[test]
    fn every_kind_is_shown() {
        let table = explain_all();
        let shown = KINDS.iter().flat_map(|kind| kind.members).filter(|member| member.shown);
        assert_eq!(table.rows.len() + table.nonsmooth.len(), shown.count());
        let names =
            || table.rows.iter().map(|row| row.kind).chain(table.nonsmooth.iter().map(|row| row.kind));
        assert!(KINDS.iter().all(|kind| kind.name == crate::STATIC || names().any(|name| name == kind.name)));
    }

    #[test]
    fn the_text_says_what_matters() {
        let hu = explain(&Scheme::hu()).to_string();
        for part in [
            "order 1",
            "ρ∞ = 0 ",
            "clean after 2 steps",
            "asserts γ ≤ 1",
            "Hu 1997",
            "α_m = −1 would make it second order",
        ] {
            assert!(hu.contains(part), "no {part:?} in\n{hu}");
        }
        let hht = explain(&Scheme::hht(0.05).unwrap()).to_string();
        assert!(hht.contains("α = -0.05") && hht.contains("α_f = 0.95"), "{hht}");
        let trapezoidal = explain(&Scheme::newmark(0.25, 0.5).unwrap());
        assert_eq!(trapezoidal.constrained.steps, None);
        assert!(trapezoidal.to_string().contains("grows by 4 v₀/Δt per step"));
    }
}
