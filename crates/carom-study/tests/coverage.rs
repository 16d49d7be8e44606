//! Do the stated uncertainties contain the truth? Twenty computed references of bars whose exact
//! solution is known, five problems with four schemes each. Every reference has three levels of
//! mesh and step, and five phases of the steps. Printed are value, stated 95 % half-width, actual
//! error and their ratio for every quantity; then how many bands contain the exact value, and the
//! median ratio: with the default impact law, without one, and with both as members of the
//! ensemble. With the default at least 95 of 100 bands must contain it, all bands in at least 19
//! of 20 set-ups, and the median half-width must be at most three times the actual error.
//!
//!     cargo test --release -p carom-study --test coverage -- --ignored --nocapture

#![allow(clippy::print_stdout)]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_record::study::reference::Reference;
use carom_study::Plan;

/// A problem with its exact values: metric, value.
struct Problem {
    name: &'static str,
    case: &'static str,
    /// Its contact, which begins with and without a projection of velocities.
    contact: &'static str,
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
    let a = 0.2_f64;
    let v = 0.1;
    let c = 2.0 - (-4.0_f64).exp();
    let force = |s: f64| v * (-1.0 + (2.0 * a * s + c) * (-a * s).exp());
    let mut low = 1.0;
    let mut high = 20.0;
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
            contact: "wall",
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
            contact: "wall",
            sets: "\"time.end\" = 3.0, \"time.step\" = 6.666666666666667e-3, \"body.bar.mesh.cells\" = 50",
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
            contact: "joint",
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
            contact: "joint",
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
            contact: "joint",
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

/// The impact law of the reference: the projection of velocities where contact begins, none, or
/// both as members of its ensemble.
const LAWS: [[&str; 2]; 3] = [["project", ""], ["none", ""], ["project", "none"]];

/// How many values there are and how many bands contain them, of values and of whole set-ups, and
/// half-widths over actual errors.
#[derive(Default)]
struct Count {
    values: i32,
    contained: i32,
    set_ups: i32,
    whole: i32,
    ratios: Vec<f64>,
}

impl Count {
    /// Compares a reference with the exact values, and prints the rows.
    fn add(&mut self, problem: &Problem, scheme: &str, reference: &Reference) {
        let mut all = true;
        for &(metric, exact) in &problem.truth {
            self.values += 1;
            let estimate = match reference.estimate(metric) {
                Ok(estimate) => estimate,
                Err(why) => {
                    println!("{:17} {scheme:17} {metric:16} {exact:10.5}  {why}", problem.name);
                    // A quantity without a band is not contained in one.
                    all = false;
                    continue;
                }
            };
            let error = (estimate.value - exact).abs();
            let inside = error <= estimate.uncertainty;
            self.contained += i32::from(inside);
            all &= inside;
            // Of a value without an error the ratio is infinite, and counts as that.
            self.ratios.push(if error > 0.0 { estimate.uncertainty / error } else { f64::INFINITY });
            println!(
                "{:17} {scheme:17} {metric:16} {exact:10.5} {:10.5} {:9.2e} {error:9.2e} {:6.2}{}",
                problem.name,
                estimate.value,
                estimate.uncertainty,
                estimate.uncertainty / error,
                if inside { "" } else { "  outside" }
            );
        }
        self.set_ups += 1;
        self.whole += i32::from(all);
    }

    /// Prints what the bands contain. Whether that is less than is required.
    fn fails(&mut self) -> bool {
        self.ratios.sort_by(f64::total_cmp);
        let median = self.ratios[self.ratios.len() / 2];
        let Self { values, contained, set_ups, whole, .. } = *self;
        println!(
            "{contained} of {values} bands contain the exact value; all bands of a set-up: {whole} of {set_ups}"
        );
        println!("median of half-width / actual error: {median:.2}\n");
        let few = |part: i32, all: i32| f64::from(part) < 0.95 * f64::from(all);
        few(contained, values) || few(whole, set_ups) || median > 3.0
    }
}

/// The computed reference of a problem.
fn reference(
    problem: &Problem,
    kind: &str,
    [law, other]: [&str; 2],
    folder: &Path,
) -> Result<Reference, String> {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let persistency = format!("\"contact.{}.persistency\"", problem.contact);
    let sets = if other.is_empty() {
        String::new()
    } else {
        format!("sets = [{{ {persistency} = \"{other}\" }}]\n")
    };
    let study = format!(
        "case = '{}'\ngoal = \"trajectory\"\nreference = \"fine\"\nset = {{ \"output.fields_every\" = 0, \
         \"time.energy_guard\" = false, {persistency} = \"{law}\"{} }}\n[fine]\nrefine = 1\nmesh = [1, 2, 4]\nset = {{ \"time.scheme\" = {kind} }}\n\
         [ensemble]\nphases = 5\n{sets}[[arm]]\nname = \"arm\"\nset = {{ \"time.scheme\" = {kind} }}\n",
        cases.join(problem.case).display(),
        if problem.sets.is_empty() { String::new() } else { format!(", {}", problem.sets) }
    );
    let file = folder.join("study.toml");
    std::fs::write(&file, study).map_err(|error| error.to_string())?;
    let plan = Plan::read(&file).map_err(|error| error.to_string())?;
    let out = folder.join("out");
    let done = carom_study::start(&plan, &out, 2, &mut |_| (), &AtomicBool::new(false));
    let done = done.map_err(|error| error.to_string())?;
    std::fs::remove_dir_all(&out).map_err(|error| error.to_string())?;
    done.study.reference.ok_or_else(|| "no reference".to_owned())
}

#[test]
#[ignore = "sixty studies with three levels and five phases each"]
fn stated_uncertainties_contain_the_truth() {
    let folder = tempfile::tempdir().unwrap();
    let mut fails = Vec::new();
    for law in LAWS {
        let other = if law[1].is_empty() { String::new() } else { format!(" and {}", law[1]) };
        println!("persistency: {}{other}", law[0]);
        println!(
            "{:17} {:17} {:16} {:>10} {:>10} {:>9} {:>9} {:>6}",
            "problem", "scheme", "quantity", "exact", "reference", "±", "error", "±/error"
        );
        let mut count = Count::default();
        for problem in problems() {
            for (scheme, kind) in SCHEMES {
                let reference = reference(&problem, kind, law, folder.path());
                let reference = reference.unwrap_or_else(|why| panic!("{}, {scheme}: {why}", problem.name));
                count.add(&problem, scheme, &reference);
            }
        }
        fails.push(count.fails());
    }
    // The others show what the impact law changes.
    assert!(!fails[0]);
}
