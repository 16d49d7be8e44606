//! The names of a scheme, found from its parameters: in a case file, and in other codes. Facts
//! about other codes are from their sources and manuals.
use serde::Serialize;

use crate::name::Name;
use crate::scheme::Scheme;

/// How another code names the scheme, or deviates from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Elsewhere {
    /// The code.
    pub code: &'static str,
    /// What it does.
    pub note: &'static str,
}

/// The known published names of these four parameters, most specific first. Each candidate is built
/// through the catalogue and compared.
pub(crate) fn names(of: &Scheme) -> Vec<Name> {
    let Scheme { alpha_m, alpha_f, beta, gamma, .. } = *of;
    let candidates: [(&'static str, &[(&'static str, f64)]); 7] = [
        ("hu", &[]),
        ("newmark", &[("beta", beta), ("gamma", gamma)]),
        ("newmark", &[("rho_inf", (3.0 - 2.0 * gamma) / (1.0 + 2.0 * gamma))]),
        ("chung-hulbert", &[("rho_inf", alpha_f / (1.0 - alpha_f))]),
        ("wbz", &[("rho_inf", (1.0 + alpha_m) / (1.0 - alpha_m))]),
        ("hht", &[("alpha", alpha_f)]),
        (
            "generalized-alpha",
            &[("alpha_m", alpha_m), ("alpha_f", alpha_f), ("beta", beta), ("gamma", gamma)],
        ),
    ];
    let same = |made: &Scheme| {
        let pairs =
            [(made.alpha_m, alpha_m), (made.alpha_f, alpha_f), (made.beta, beta), (made.gamma, gamma)];
        pairs.iter().all(|(a, b)| (a - b).abs() <= 1e-12)
    };
    let made = candidates.into_iter().filter_map(|(kind, parameters)| {
        // ρ∞ from a quotient may leave [0, 1] by round-off.
        let clean = |x: f64| if (x - x.round()).abs() < 1e-14 { x.round() + 0.0 } else { x };
        let parameters = parameters.iter().map(|&(key, value)| (key, clean(value))).collect();
        let name = Name { kind, parameters, forces: of.forces };
        name.integrator().ok()?.alpha().filter(same)?;
        Some(name)
    });
    made.collect()
}

/// Notes on other codes for a scheme with these names.
pub(crate) fn elsewhere(of: &Scheme, names: &[Name]) -> Vec<Elsewhere> {
    let is = |kind: &str| names.iter().any(|name| name.kind == kind);
    let averaged = of.alpha_m != 0.0 || of.alpha_f != 0.0;
    let steep = of.gamma > 1.0;
    let newmark = is("newmark");
    let hht = is("hht") && averaged;
    let wbz = is("wbz") && averaged;
    let chung_hulbert = is("chung-hulbert");
    let outside_drake = newmark && (of.gamma < 0.5 || steep || of.beta > 0.5);
    let facts = [
        (
            averaged,
            "MFEM",
            "index n + α; forces of the averaged state, evaluated at t + Δt; ρ∞ is limited to [0, 1] without a message; its HHT α lies in [2/3, 1]",
        ),
        (averaged, "PETSc", "index n + α; forces of the averaged state"),
        (
            averaged,
            "FEBio",
            "index n + α; ρ∞ = −1 selects the Euler scheme, −2 (the default) uses the other parameters as given",
        ),
        (
            averaged,
            "SciML",
            "index n + 1 − α; forces of the averaged state; a_n is recomputed from the balance equation, which loses one order",
        ),
        (averaged, "Gridap", "index n + 1 − α; forces of the averaged state"),
        (hht, "Chrono", "its α is −alpha, in [−1/3, 0]; forces are averaged"),
        (hht, "CalculiX; Abaqus, transient fidelity", "default α = −0.05, here alpha = 0.05: ρ∞ = 0.905"),
        (hht, "CalculiX impact example", "α = −0.3, here alpha = 0.3: ρ∞ = 0.54"),
        (hht, "Code_Aster", "default α = −0.1, here alpha = 0.1: ρ∞ = 0.818"),
        (hht, "Flexcom", "default α = −0.25, here alpha = 0.25: ρ∞ = 0.60"),
        (wbz, "Bossak −0.3, as often written", "that number is α_m; here rho_inf = 0.54"),
        (chung_hulbert, "suanPan", "default ρ∞ = 0.5; 0.5 to 0.8 recommended"),
        (chung_hulbert, "Flexcom", "default ρ∞ = 0.4"),
        (chung_hulbert, "Moreira, Carvalho, Sanches", "ρ∞ = 0.6 and 0.1"),
        (newmark && !steep, "PolyFEM, FEBio, LS-DYNA implicit", "default γ = ½, β = ¼: ρ∞ = 1"),
        (
            newmark && !steep,
            "LS-DYNA",
            "γ = 0.6, β = 0.38 recommended for quasi-static problems: ρ∞ = 0.858, order 1",
        ),
        (newmark, "PolyFEM", "reads β from the key gamma and γ from the key beta"),
        (outside_drake, "Drake", "rejects it: requires ½ ≤ γ ≤ 1 and β ≤ ½"),
        (steep, "SciML", "rejects it: asserts γ ≤ 1"),
        (steep, "Gridap", "limits γ to 1 with a warning, which gives another method"),
    ];
    facts.into_iter().filter(|fact| fact.0).map(|(_, code, note)| Elsewhere { code, note }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scheme_is_recognised_by_its_parameters() {
        let words = |scheme: Scheme| names(&scheme).iter().map(ToString::to_string).collect::<Vec<_>>();
        assert_eq!(
            words(Scheme::chung_hulbert(0.1).unwrap())[0],
            "{ kind = \"chung-hulbert\", rho_inf = 0.1 }"
        );
        assert_eq!(words(Scheme::hht(0.05).unwrap())[0], "{ kind = \"hht\", alpha = 0.05 }");
        let hu = words(Scheme::hu());
        assert_eq!(hu[0], "{ kind = \"hu\" }");
        assert_eq!(hu[2], "{ kind = \"newmark\", rho_inf = 0 }");
        let trapezoidal = words(Scheme::newmark(0.25, 0.5).unwrap());
        assert_eq!(trapezoidal.len(), 5, "{trapezoidal:?}");
        for (build, kind) in [(Scheme::wbz as fn(f64) -> _, "wbz"), (Scheme::chung_hulbert, "chung-hulbert")]
        {
            for percent in 0..=100 {
                let rho_inf = f64::from(percent) / 100.0;
                let found = names(&build(rho_inf).unwrap());
                let got = found.iter().find(|name| name.kind == kind).unwrap().parameters["rho_inf"];
                assert!((got - rho_inf).abs() < 1e-14);
            }
        }
    }

    /// ρ∞ and order of other codes' defaults, as stated in the notes.
    #[test]
    fn the_notes_numbers_are_those_of_the_analysis() {
        let table = [
            (Scheme::newmark(0.38, 0.6), 0.858, 1),
            (Scheme::hht(0.05), 0.905, 2),
            (Scheme::hht(0.1), 0.818, 2),
            (Scheme::hht(0.25), 0.6, 2),
            (Scheme::hht(0.3), 0.54, 2),
            (Scheme::generalized_alpha(-0.3, 0.0, 0.25 * 1.69, 0.8), 0.54, 2),
        ];
        for (scheme, rho_inf, order) in table {
            let scheme = scheme.unwrap();
            let got = scheme.spectral_radius_at_infinity();
            assert!((got - rho_inf).abs() < 2e-3, "{scheme:?}: {got}");
            assert_eq!(scheme.order(), order);
        }
    }
}
