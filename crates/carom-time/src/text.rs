//! Explanations as text for a terminal, and the table over the catalogue.
use std::fmt::{Display, Formatter, Result};

use serde::Serialize;

use crate::explain::{Accuracy, Explanation, Overshoot};
use crate::explained::Explained;
use crate::layout::{accuracy_table, cell, write_wrapped};
use crate::name::short;
use crate::nonsmooth_text::NonsmoothExplanation;
use crate::scheme::{ForceRule, Scheme};
use crate::schemes::KINDS;

fn list<T: Display>(f: &mut Formatter, title: &str, items: &[T]) -> Result {
    if items.is_empty() {
        return Ok(());
    }
    writeln!(f, "\n{title}")?;
    items.iter().try_for_each(|item| write_wrapped(f, &item.to_string()))
}

impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter) -> Result {
        if let Some((name, others)) = self.names.split_first() {
            writeln!(f, "{name}   {}", self.references.join("; "))?;
            if !others.is_empty() {
                writeln!(f, "\nidentical to")?;
            }
            others.iter().try_for_each(|other| writeln!(f, "  {other}"))?;
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
        if let Some(scheme) = self.scheme.filter(|scheme| scheme.alpha_f != 0.0) {
            let averaged = match scheme.forces {
                ForceRule::AverageForces => "the forces",
                ForceRule::AverageState => "the state at which forces are evaluated",
            };
            writeln!(f, "  α_f averages {averaged}")?;
        }
        let stable = if self.a_stable { "unconditionally stable" } else { "not unconditionally stable" };
        writeln!(
            f,
            "\norder {}   ρ∞ = {}   {stable} in linear motion",
            self.order,
            cell(Some(self.rho_inf), 1.0)
        )?;
        accuracy_table(f, &self.accuracy)?;
        let Overshoot { displacement, velocity } = self.overshoot;
        let largest = [displacement, velocity].map(|value| cell(Some(value), 1.0));
        let overshoot = format!(
            "a mode of Ω = 10 released from rest reaches {} u₀ and {} ω u₀ within ten steps",
            largest[0], largest[1]
        );
        list(f, "overshoot", &[overshoot])?;
        list(f, "conservation", &self.conserves)?;
        list(f, "a dof constrained by contact", &[&self.constrained.text])?;
        list(f, "remarks", &self.remarks)?;
        let elsewhere: Vec<_> =
            self.elsewhere.iter().map(|fact| format!("{}: {}", fact.code, fact.note)).collect();
        list(f, "in other codes", &elsewhere)
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
    /// Steps for which the transient of a constrained dof lasts; none: it does not end.
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
        match kind.named(member).integrator().map(|made| made.explain()) {
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

/// Headings of [`at_ten_steps`].
const ACCURACY: &str = "     order        ρ∞   ξ(T/10)  PE(T/10)";

const NOTES: &str = "\
α_m, α_f: weights of the terms at the start of the step (index n + 1 − α)
ρ∞: spectral radius at infinite frequency; ωΔt ≤ 2: explicit, conditionally stable with this limit
ξ(T/10), PE(T/10): damping ratio and period error of a mode with ten steps per period
constrained: number of steps until the transient of a dof stopped by contact at the speed v₀ is below
1 % of v₀/Δt; ∞: it does not decay";

/// Order, ρ∞, damping ratio and period error of a scheme, as columns.
fn at_ten_steps(order: u8, rho_inf: &str, accuracy: Option<&Accuracy>) -> String {
    let (xi, pe) = accuracy.map_or((None, None), |row| (row.damping_ratio, row.period_error));
    let pe = format!("{} %", cell(pe, 100.0));
    format!("{order:>10}{rho_inf:>10}{:>10}{pe:>10}", cell(xi, 1.0))
}

impl Display for Catalogue {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{:<18}{:<24}", "kind", "parameters")?;
        writeln!(f, "{:>10}{:>10}{:>10}{:>10}{ACCURACY}{:>13}", "α_m", "α_f", "β", "γ", "constrained")?;
        for row in &self.rows {
            write!(f, "{:<18}{:<24}", row.kind, row.parameters)?;
            match row.scheme {
                Some(Scheme { alpha_m, alpha_f, beta, gamma, .. }) => {
                    write!(f, "{alpha_m:>10.4}{alpha_f:>10.4}{beta:>10.4}{gamma:>10.4}")?;
                }
                None => write!(f, "{:>10}{:>10}{:>10}{:>10}", "–", "–", "–", "–")?,
            }
            let constrained = row.constrained_steps.map_or("∞".to_owned(), |steps| steps.to_string());
            let rho = format!("{:.3}", row.rho_inf);
            writeln!(f, "{}{constrained:>13}", at_ten_steps(row.order, &rho, Some(&row.accuracy)))?;
        }
        writeln!(f, "\nschemes with their own contact law\n")?;
        writeln!(f, "{:<32}{:<50}{ACCURACY}", "kind", "parameters")?;
        for explanation in &self.nonsmooth {
            let words: Vec<_> = explanation
                .parameters
                .iter()
                .map(|(key, value)| format!("{key} {}", short(*value)))
                .collect();
            let rho = explanation.rho_inf.map_or("ωΔt ≤ 2".to_owned(), |rho| format!("{rho:.3}"));
            let tenth = explanation.accuracy.iter().find(|row| row.steps_per_period == 10);
            let accuracy = at_ten_steps(explanation.order, &rho, tenth);
            writeln!(f, "{:<32}{:<50}{accuracy}", explanation.kind, words.join(", "))?;
        }
        write!(f, "\n{NOTES}")
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
        let words =
            |scheme: &Scheme| explain(scheme).to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        let hu = words(&Scheme::hu());
        for part in [
            "order 1",
            "ρ∞ = 0 ",
            "ends after 2 steps",
            "asserts γ ≤ 1",
            "Hu 1997",
            "α_m = −1 would make it second order",
        ] {
            assert!(hu.contains(part), "no {part:?} in\n{hu}");
        }
        let hht = words(&Scheme::hht(0.05).unwrap());
        assert!(hht.contains("α = -0.05") && hht.contains("α_f = 0.95"), "{hht}");
        let trapezoidal = Scheme::newmark(0.25, 0.5).unwrap();
        assert_eq!(explain(&trapezoidal).constrained.steps, None);
        assert!(words(&trapezoidal).contains("grows by 4 v₀/Δt per step"));
    }
}
