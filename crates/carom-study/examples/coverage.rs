//! Do the stated uncertainties contain the truth? Twenty computed references of bars whose exact
//! solution is known, five problems with four schemes each. Every reference has three levels of
//! mesh and step, and five phases of the steps. Printed are value, stated 95 % half-width, actual
//! error and their ratio for every quantity; then how many bands contain the exact value, and the
//! median ratio. Exits with 1 if fewer than 95 of 100 bands contain it, if all bands do so in fewer
//! than 19 of 20 set-ups, or if the median half-width is more than three times the actual error.
//!
//!     cargo run --release -p carom-study --example coverage

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use carom_study::Plan;

/// A problem with its exact values: metric, value.
struct Problem {
    name: &'static str,
    case: &'static str,
    /// Changes of the case.
    sets: &'static str,
    truth: Vec<(&'static str, f64)>,
}

const SCHEMES: [(&str, &str); 4] = [
    ("Chung-Hulbert 0.5", "{ kind = \"chung-hulbert\", rho_inf = 0.5 }"),
    ("Chung-Hulbert 0.1", "{ kind = \"chung-hulbert\", rho_inf = 0.1 }"),
    ("Bathe", "{ kind = \"bathe\", rho_inf = 0.5 }"),
    ("trapezoidal", "{ kind = \"newmark\", beta = 0.25, gamma = 0.5 }"),
];

/// The bar on a spring without mass, of cases/bar/spring.toml: Z = 1, k = 0.2, v₀ = 0.1, a = k/Z.
/// After the reflection from the free end at t = 20, F = Z v₀ [−1 + (2 a s + 2 − e⁻⁴) e^(−a s)]
/// with s = t − 20, until F = 0. Returns the end of contact, the impulse and the largest force.
fn spring() -> [f64; 3] {
    let (a, v) = (0.2_f64, 0.1);
    let c = 2.0 - (-4.0_f64).exp();
    let force = |s: f64| v * (-1.0 + (2.0 * a * s + c) * (-a * s).exp());
    let (mut low, mut high) = (1.0, 20.0);
    for _ in 0..80 {
        let middle = f64::midpoint(low, high);
        if force(middle) > 0.0 { low = middle } else { high = middle }
    }
    let s = low;
    // ∫ of both branches in closed form.
    let first = v * (20.0 - (1.0 - (-4.0_f64).exp()) / a);
    let tail = 1.0 - (-a * s).exp();
    let second = v * (-s + 2.0 / a * (tail - a * s * (-a * s).exp()) + c / a * tail);
    // It grows on for a while: F′ = 0 where 2 a s = 2 − c.
    let top = force((2.0 - c) / (2.0 * a)).max(v * (1.0 - (-4.0_f64).exp()));
    [20.0 + s, first + second, top]
}

fn problems() -> Vec<Problem> {
    let [end, impulse, top] = spring();
    vec![
        Problem {
            name: "bar on a wall",
            case: "invariance/phase.toml",
            sets: "\"refine\" = 1, \"time.phase\" = 0.0, \"time.step\" = 6.666666666666667e-3",
            truth: vec![
                ("contact_start", 1.0 / 3.0),
                ("contact_end", 1.0),
                ("contact_duration", 2.0 / 3.0),
                ("impulse_x", 60.0),
                ("peak_mean_force", 90.0),
                ("peak_force", 90.0),
                ("force_variation", 180.0),
                ("restitution", 1.0),
            ],
        },
        Problem {
            name: "bar with gravity",
            case: "bar/bouncing.toml",
            sets: "\"time.end\" = 3.0, \"time.step\" = 6.666666666666667e-3, \"body.bar.mesh.cells\" = 50, \"contact.wall.persistency\" = \"project\"",
            truth: vec![
                ("contact_start", 1.0),
                ("contact_end", 5.0 / 3.0),
                ("contact_duration", 2.0 / 3.0),
                ("impulse_x", 800.0 / 3.0),
                ("restitution", 1.0),
            ],
        },
        Problem {
            name: "two bars",
            case: "bar/two-bars.toml",
            sets: "",
            truth: vec![
                ("contact_end", 20.0),
                ("contact_duration", 20.0),
                ("impulse_x", -8.0),
                ("peak_mean_force", 0.4),
                ("peak_force", 0.4),
                ("restitution", 1.0),
            ],
        },
        Problem {
            name: "unequal bars",
            case: "bar/unequal-bars.toml",
            sets: "",
            truth: vec![
                ("contact_end", 20.0),
                ("contact_duration", 20.0),
                ("impulse_x", -8.0 / 3.0),
                ("peak_mean_force", 2.0 / 15.0),
                ("peak_force", 2.0 / 15.0),
            ],
        },
        Problem {
            name: "bar on a spring",
            case: "bar/spring.toml",
            sets: "\"time.end\" = 32.0, \"body.bar.mesh.cells\" = 100",
            truth: vec![
                ("contact_end", end),
                ("contact_duration", end),
                ("impulse_x", -impulse),
                ("peak_force", top),
                ("force_variation", 2.0 * top),
            ],
        },
    ]
}

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let place = std::env::temp_dir().join(format!("carom-coverage-{}", std::process::id()));
    let (mut values, mut contained, mut set_ups, mut whole) = (0, 0, 0, 0);
    let mut ratios = Vec::new();
    println!(
        "{:17} {:17} {:16} {:>10} {:>10} {:>9} {:>9} {:>6}",
        "problem", "scheme", "quantity", "exact", "reference", "±", "error", "±/error"
    );
    for problem in problems() {
        for (scheme, kind) in SCHEMES {
            let name = format!("{}-{scheme}", problem.name).replace([' ', '.'], "-");
            let study = format!(
                "case = '{}'\ngoal = \"trajectory\"\nreference = \"fine\"\nset = {{ \"output.fields_every\" = 0, \
                 \"time.energy_guard\" = false, {} }}\n[fine]\nrefine = 1\nmesh = [1, 2, 4]\nset = {{ \"time.scheme\" = {kind} }}\n\
                 [ensemble]\nphases = 5\n[[arm]]\nname = \"arm\"\nset = {{ \"time.scheme\" = {kind} }}\n",
                root.join(problem.case).display(),
                problem.sets
            );
            let file = place.join(format!("{name}.toml"));
            let made = std::fs::create_dir_all(&place).and_then(|()| std::fs::write(&file, study));
            if let Err(error) = made {
                eprintln!("{}: {error}", file.display());
                return ExitCode::from(4);
            }
            let plan = match Plan::read(&file) {
                Ok(plan) => plan,
                Err(error) => {
                    eprintln!("{name}: {error}");
                    return ExitCode::from(2);
                }
            };
            let done = carom_study::start(&plan, &place.join(&name), 2, &mut |_| (), &AtomicBool::new(false));
            let Some(reference) = done.ok().and_then(|outcome| outcome.study.reference) else {
                eprintln!("{name}: no reference");
                return ExitCode::from(3);
            };
            let mut all = true;
            for &(metric, exact) in &problem.truth {
                let estimate = match reference.estimate(metric) {
                    Ok(estimate) => estimate,
                    Err(why) => {
                        println!("{:17} {scheme:17} {metric:16} {exact:10.5}  {why}", problem.name);
                        // A quantity without a band is not contained in one.
                        values += 1;
                        all = false;
                        continue;
                    }
                };
                let error = (estimate.value - exact).abs();
                let inside = error <= estimate.uncertainty;
                values += 1;
                contained += i32::from(inside);
                all &= inside;
                if error > 0.0 {
                    ratios.push(estimate.uncertainty / error);
                }
                println!(
                    "{:17} {scheme:17} {metric:16} {exact:10.5} {:10.5} {:9.2e} {error:9.2e} {:6.2}{}",
                    problem.name,
                    estimate.value,
                    estimate.uncertainty,
                    estimate.uncertainty / error,
                    if inside { "" } else { "  outside" }
                );
            }
            set_ups += 1;
            whole += i32::from(all);
        }
    }
    // What is left behind is in the system's folder for temporary files.
    let _ = std::fs::remove_dir_all(&place);
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    println!(
        "{contained} of {values} bands contain the exact value; all bands of a set-up: {whole} of {set_ups}"
    );
    println!("median of half-width / actual error: {median:.2}");
    let misses =
        f64::from(contained) < 0.95 * f64::from(values) || f64::from(whole) < 0.95 * f64::from(set_ups);
    ExitCode::from(u8::from(misses || median > 3.0))
}
