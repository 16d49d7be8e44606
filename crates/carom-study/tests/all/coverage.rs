//! Do the stated uncertainties contain the truth? Computed references of impacts whose exact
//! solution is known: a bar of every element thrown on a wall with an offset, under gravity, or on
//! a bar of larger impedance, strips in the plane and a bar in space; stiff blocks that slide to
//! rest, up an incline, and on a spring until they stick. Printed are value, stated
//! half-width, actual error and their ratio for every quantity, also for histories; then how many
//! intervals contain the exact value, and the median ratio. At least 95 of 100 intervals must
//! contain it, all of them in at least 8 of 10 set-ups, and the median half-width must be at most
//! three times the error.
//!
//!     cargo test --release -p carom-study --test all coverage -- --ignored --nocapture
//!
//! The studies are kept in the folder `CAROM_COVERAGE`, if it is given, and not computed again if
//! they are there.

#![allow(clippy::print_stdout)]

use std::f64::consts::PI;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use carom_record::Run;
use carom_record::metrics::Signal;
use carom_record::study::Study;
use carom_record::study::ranking::Confidence;
use carom_record::study::reference::{Estimate, Reference};
use carom_study::Plan;

/// Exact displacement or stress of a probe.
type History = Box<dyn Fn(f64) -> f64>;

/// An impact with its exact values.
struct Problem {
    name: String,
    case: String,
    metrics: Vec<(&'static str, f64)>,
    histories: Vec<(&'static str, History)>,
}

/// A bar with the wave speed `c` and the impedance `z`.
#[derive(Clone, Copy)]
struct Bar {
    element: &'static str,
    cells: usize,
    length: f64,
    density: f64,
    young: f64,
}

impl Bar {
    fn c(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    fn z(&self) -> f64 {
        (self.young * self.density).sqrt()
    }

    fn material(&self, name: &str) -> String {
        let Self { density, young, .. } = self;
        format!(
            "[[material]]\nname = \"{name}\"\nlaw = \"linear-elastic\"\ndensity = {density:?}\nyoung = {young:?}\npoisson = 0.0\n"
        )
    }

    fn body(&self, name: &str, from: f64, velocity: f64) -> String {
        let Self { element, cells, length, .. } = self;
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"{name}\"\nelement = \"{element}\"\nvelocity = [{velocity:?}]\n\
             mesh = {{ shape = \"interval\", min = {from:?}, max = {:?}, cells = {cells} }}\n",
            from + length
        )
    }
}

fn time(end: f64, step: f64) -> String {
    let end = (end / step).ceil() * step;
    format!(
        "[time]\nend = {end:?}\nstep = {step:?}\nscheme = {{ kind = \"chung-hulbert\", rho_inf = 0.5 }}\nenergy_guard = false\n\
         [output]\nfields_every = 0\n"
    )
}

/// Axes of the space in which an element is used.
fn dimension(element: &str) -> usize {
    match &element[..1] {
        "L" => 1,
        "T" => 2,
        _ => 3,
    }
}

/// A point on the axis of a bar, in any space.
fn on_axis(dimension: usize, x: f64) -> String {
    let across = "0.5, ".repeat(dimension - 1);
    format!("[{across}{x:?}]")
}

/// A bar thrown with the velocity v on a wall at the distance g: the end stays there for 2L/c,
/// under the force z v, and the bar leaves with v, without vibration. In the plane, a strip of the
/// width 1; in space, a bar of the cross-section 1.
fn thrown(bar: Bar, gap: f64, v: f64) -> Problem {
    let Bar { element, cells, length, .. } = bar;
    let start = gap / v;
    let crossing = length / bar.c();
    let end = start + 2.0 * crossing;
    let dimension = dimension(element);
    let axis = ["x", "y", "z"][dimension - 1];
    let secondary = ["bar.left", "bar.bottom", "bar.bottom"][dimension - 1];
    let head = ["dimension = 1\n", "dimension = 2\nplane = \"strain\"\n", "dimension = 3\n"][dimension - 1];
    let body = if dimension == 1 {
        bar.body("bar", gap, -v)
    } else {
        let shape = ["rectangle", "box"][dimension - 2];
        let low = ["0.0", "0.0, 0.0"][dimension - 2];
        let high = ["1.0", "1.0, 1.0"][dimension - 2];
        let across = ["2", "1, 1"][dimension - 2];
        format!(
            "[[body]]\nname = \"bar\"\nmaterial = \"bar\"\nelement = \"{element}\"\nvelocity = [{low}, {:?}]\n\
             mesh = {{ shape = \"{shape}\", min = [{low}, {gap:?}], max = [{high}, {:?}], cells = [{across}, {cells}] }}\n",
            -v,
            gap + length
        )
    };
    let wall = [
        "point = [0.0], normal = [1.0]",
        "point = [0.0, 0.0], normal = [0.0, 1.0]",
        "point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]",
    ][dimension - 1];
    let probes = format!(
        "[[probe]]\nname = \"far\"\nbody = \"bar\"\nat = {}\nrecord = [\"u{axis}\"]\n\
         [[probe]]\nname = \"mid\"\nbody = \"bar\"\nat = {}\nrecord = [\"sigma_{axis}{axis}\", \"det_f\"]\n",
        on_axis(dimension, gap + length),
        on_axis(dimension, gap + length / 2.0)
    );
    let case = [
        format!("title = \"thrown\"\n{head}"),
        bar.material("bar"),
        body,
        format!(
            "[[contact]]\nname = \"wall\"\nsecondary = \"{secondary}\"\nprimary = {{ plane = {{ {wall} }} }}\n"
        ),
        time(end + 1.5 * crossing, crossing / cells as f64),
        probes,
    ];
    let turn = start + crossing;
    let force = bar.z() * v;
    let far = move |t: f64| if t < turn { -v * t } else { v * (t - 2.0 * turn) };
    let pressed = (start + crossing / 2.0)..(start + 1.5 * crossing);
    let stress = move |t: f64| if pressed.contains(&t) { -force } else { 0.0 };
    Problem {
        name: format!("{element} on a wall, gap {gap}"),
        case: case.concat(),
        metrics: vec![
            ("contact_start", start),
            ("contact_end", end),
            ("contact_duration", end - start),
            (["impulse_x", "impulse_y", "impulse_z"][dimension - 1], 2.0 * force * crossing),
            ("peak_mean_force", force),
            ("restitution", 1.0),
            (["mid.sigma_xx:min", "mid.sigma_yy:min", "mid.sigma_zz:min"][dimension - 1], -force),
            (
                ["mid.sigma_xx:peak_mean", "mid.sigma_yy:peak_mean", "mid.sigma_zz:peak_mean"][dimension - 1],
                force,
            ),
            ("mid.det_f:max", 1.0),
        ],
        histories: vec![
            (["far.ux", "far.uy", "far.uz"][dimension - 1], Box::new(far)),
            (["mid.sigma_xx", "mid.sigma_yy", "mid.sigma_zz"][dimension - 1], Box::new(stress)),
        ],
    }
}

/// A free bar under a traction p at its left end from the start on. In the middle σ = −p from
/// L/2c to 3L/2c, and 0 until 5L/2c; the velocity is p/z, and then 2p/z. Nothing touches.
fn pushed(bar: Bar, p: f64) -> Problem {
    let Bar { element, cells, length, .. } = bar;
    let crossing = length / bar.c();
    let probe = "[[probe]]\nname = \"mid\"\nbody = \"bar\"\nrecord = [\"vx\", \"sigma_xx\", \"det_f\"]\n";
    let case = [
        "title = \"pushed\"\ndimension = 1\n".to_owned(),
        bar.material("bar"),
        bar.body("bar", 0.0, 0.0),
        format!("[[load]]\nname = \"push\"\non = [\"bar.left\"]\ntraction = [{p:?}]\n"),
        time(2.4 * crossing, crossing / cells as f64),
        format!("{probe}at = [{:?}]\n", 0.5 * length),
    ];
    let metrics = vec![
        ("mid.sigma_xx:min", -p),
        ("mid.vx:max", 2.0 * p / bar.z()),
        ("mid.det_f:max", 1.0),
        ("mid.det_f:min", 1.0 - p / bar.young),
    ];
    Problem { name: format!("{element} pushed"), case: case.concat(), metrics, histories: Vec::new() }
}

/// A bar strikes a longer one at rest of larger impedance: the force z₁z₂v/(z₁ + z₂) acts for
/// 2L₁/c₁; the striker leaves with v (z₁ − z₂)/(z₁ + z₂), without vibration.
fn struck(striker: Bar, target: Bar, gap: f64, v: f64) -> Problem {
    let start = gap / v;
    let crossing = striker.length / striker.c();
    let end = start + 2.0 * crossing;
    let sum = striker.z() + target.z();
    let force = striker.z() * target.z() * v / sum;
    let after = v * (striker.z() - target.z()) / sum;
    let given = 2.0 * force * crossing / (target.density * target.length);
    let case = [
        "title = \"struck\"\ndimension = 1\n".to_owned(),
        striker.material("striker"),
        target.material("target"),
        striker.body("striker", -gap - striker.length, v),
        target.body("target", 0.0, 0.0),
        "[[contact]]\nname = \"joint\"\nsecondary = \"striker.right\"\nprimary = \"target.left\"\n"
            .to_owned(),
        time(end + crossing, crossing / striker.cells as f64),
        format!(
            "[[probe]]\nname = \"far\"\nbody = \"striker\"\nat = [{:?}]\nrecord = [\"ux\"]\n",
            -gap - striker.length
        ),
    ];
    let turn = start + crossing;
    let far = move |t: f64| if t < turn { v * t } else { v * turn + after * (t - turn) };
    Problem {
        name: format!("{} on {}, gap {gap}", striker.element, target.element),
        case: case.concat(),
        metrics: vec![
            ("contact_start", start),
            ("contact_end", end),
            ("contact_duration", end - start),
            ("impulse_x", -2.0 * force * crossing),
            ("peak_mean_force", force),
            ("restitution", (given - after) / v),
        ],
        histories: vec![("far.ux", Box::new(far))],
    }
}

/// A bar under gravity, of cases/bar/bouncing.toml.
fn falling(element: &str, cells: usize) -> Problem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/bar/bouncing.toml");
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let text =
        text.split("[[expect]]").next().unwrap_or_default().replace("\"L2\"", &format!("\"{element}\""));
    let mut case = String::new();
    for line in text.lines() {
        let line = match line.split_once(" = ").map(|(key, _)| key.trim()) {
            Some("end") => "end = 3.0".to_owned(),
            Some("step") => "step = 6.666666666666667e-3".to_owned(),
            Some("mesh") => {
                format!("mesh = {{ shape = \"interval\", min = 5.0, max = 15.0, cells = {cells} }}")
            }
            _ => line.to_owned(),
        };
        case += &line;
        case.push('\n');
    }
    let metrics = vec![
        ("contact_start", 1.0),
        ("contact_end", 5.0 / 3.0),
        ("contact_duration", 2.0 / 3.0),
        ("impulse_x", 800.0 / 3.0),
        ("restitution", 1.0),
    ];
    Problem { name: format!("{element} under gravity"), case, metrics, histories: Vec::new() }
}

/// A block of the mass 1/5 on a rigid floor, so stiff that it moves as a whole.
struct Block {
    name: &'static str,
    element: &'static str,
    velocity: f64,
    gravity: [f64; 2],
    mu: f64,
    /// Stiffness of a spring at rest at its left end, without mass.
    spring: f64,
    end: f64,
}

impl Block {
    fn case(&self) -> String {
        let Self { element, velocity, gravity: [x, y], mu, spring, end, .. } = self;
        let material = |name: &str, density: f64, young: f64, poisson: f64| {
            format!(
                "[[material]]\nname = \"{name}\"\nlaw = \"linear-elastic\"\ndensity = {density:?}\nyoung = {young:?}\npoisson = {poisson:?}\n"
            )
        };
        let body = |name: &str, element: &str, from: f64, cells: u32, more: String| {
            format!(
                "[[body]]\nname = \"{name}\"\nmaterial = \"{name}\"\nelement = \"{element}\"\n\
                 mesh = {{ shape = \"rectangle\", min = [{from:?}, 0.0], max = [{:?}, 0.2], cells = [{cells}, 1] }}\n{more}",
                from + 1.0
            )
        };
        let moves = format!("velocity = [{velocity:?}, 0.0]\ngravity = [{x:?}, {y:?}]\n");
        let mut parts = vec![
            "title = \"block\"\ndimension = 2\n".to_owned(),
            material("block", 1.0, 1e8, 0.3),
            body("block", element, 0.0, 4, moves),
        ];
        if *spring > 0.0 {
            // The stiffness of the strip is E h/L with h/L = 1/5.
            parts.push(material("spring", 1e-6, 5.0 * spring, 0.0));
            parts.push(body(
                "spring",
                element,
                -1.0,
                1,
                format!("velocity = [\"{velocity:?}*(X + 1)\", \"0\"]\n"),
            ));
            parts.push(
                "[[support]]\nname = \"end\"\non = [\"spring.left\"]\nfix = [\"x\", \"y\"]\n\
                 [[tie]]\nname = \"joint\"\nsecondary = \"spring.right\"\nprimary = \"block.left\"\n"
                    .to_owned(),
            );
        }
        parts.push(format!(
            "[[contact]]\nname = \"floor\"\nsecondary = \"block.bottom\"\nmu = {mu:?}\n\
             primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}\n"
        ));
        parts.push(time(*end, 0.01));
        parts.concat()
    }

    /// The block as a problem, with its exact path after the last of these stops, from one velocity
    /// of zero to the next, until it sticks.
    fn problem(&self, metrics: Vec<(&'static str, f64)>, path: impl Fn(f64) -> f64 + 'static) -> Problem {
        Problem {
            name: format!("{}, {}", self.element, self.name),
            case: self.case(),
            metrics,
            histories: vec![("block.center_x", Box::new(move |t| 0.5 + path(t)))],
        }
    }
}

/// A block slides to rest: a = −μg, so that it stops after v/(μg) at v²/(2μg); friction takes all
/// of its energy.
fn to_rest(element: &'static str) -> Problem {
    let block = Block {
        name: "sliding to rest",
        element,
        velocity: 3.1,
        gravity: [0.0, -10.0],
        mu: 0.3,
        spring: 0.0,
        end: 1.2,
    };
    let stop = block.velocity / 3.0;
    let metrics = vec![
        ("friction_lost", 1.0),
        ("slip_distance", 1.5 * stop * stop),
        ("stick_share", (block.end - stop) / block.end),
    ];
    block.problem(metrics, move |t| 3.0 * t.min(stop) * (stop - 0.5 * t.min(stop)))
}

/// A block thrown up an incline with the deceleration g_x + μ g_y = 7 stops and stays, as 3 < 4.
fn up_the_incline(element: &'static str) -> Problem {
    let block = Block {
        name: "up an incline",
        element,
        velocity: 3.3,
        gravity: [-3.0, -8.0],
        mu: 0.5,
        spring: 0.0,
        end: 0.8,
    };
    let stop = block.velocity / 7.0;
    let metrics = vec![
        ("friction_lost", 4.0 / 7.0),
        ("slip_distance", 3.5 * stop * stop),
        ("stick_share", (block.end - stop) / block.end),
    ];
    block.problem(metrics, move |t| 7.0 * t.min(stop) * (stop - 0.5 * t.min(stop)))
}

/// A block on a spring with the velocity v: half swings about ∓f/k, f = μmg, each shorter by 2f/k,
/// until it stops where the spring cannot move it.
fn on_a_spring(element: &'static str) -> Problem {
    let block = Block {
        name: "on a spring until it sticks",
        element,
        velocity: 1.0,
        gravity: [0.0, -10.0],
        mu: 0.1,
        spring: 10.0,
        end: 2.0,
    };
    let omega = (block.spring / 0.2).sqrt();
    let off = block.mu * 0.2 * 10.0 / block.spring;
    let first = f64::hypot(1.0 / omega, off);
    let turn = (PI / 2.0 - (off / first).asin()) / omega;
    // Turning points: that of the first swing, then each 2 · off closer to the middle.
    let points: Vec<f64> =
        (0..4).map(|n| (first - off * f64::from(1 + 2 * n)) * (-1.0_f64).powi(n)).collect();
    let stop = turn + 3.0 * PI / omega;
    let way = points[0] + points.windows(2).map(|pair| (pair[0] - pair[1]).abs()).sum::<f64>();
    let metrics = vec![
        ("friction_lost", off * block.spring * way / 0.1),
        ("stick_share", (block.end - stop) / block.end),
    ];
    block.problem(metrics, move |t| {
        if t < turn {
            return first * (omega * t + (off / first).asin()).sin() - off;
        }
        let swing = (((t - turn) * omega / PI) as usize).min(2);
        let from = points[swing];
        let middle = off * from.signum();
        let phase = ((t - turn) * omega - PI * swing as f64).min(PI);
        middle + (from - middle) * phase.cos()
    })
}

fn problems() -> Vec<Problem> {
    let bar = |element, cells, length, density, young| Bar { element, cells, length, density, young };
    let mut all = Vec::new();
    for element in ["L2", "L3", "L4"] {
        all.push(thrown(bar(element, 33, 3.0, 2.0, 800.0), 0.37, 4.0));
        all.push(thrown(bar(element, 50, 10.0, 1.0, 900.0), 5.0, 10.0));
        all.push(thrown(bar(element, 24, 1.0, 1.0, 1.0), 0.05, 0.1));
        let striker = bar(element, 24, 2.0, 1.0, 1.0);
        all.push(struck(striker, bar(element, 72, 9.0, 4.0, 9.0), 0.021, 0.2));
        all.push(struck(striker, bar("L2", 90, 6.0, 1.0, 4.0), 0.013, 0.1));
        all.push(falling(element, 50));
        all.push(pushed(bar(element, 20, 2.0, 1.0, 4.0), 0.2));
    }
    for element in ["T6", "T10"] {
        all.push(thrown(bar(element, 20, 10.0, 1.0, 900.0), 3.7, 10.0));
    }
    all.push(thrown(bar("Hex8", 20, 10.0, 1.0, 900.0), 3.7, 10.0));
    for element in ["Q4", "T6"] {
        all.extend([to_rest(element), up_the_incline(element), on_a_spring(element)]);
    }
    all
}

/// The default design, and one with an ensemble on three meshes with a given scheme.
const DESIGNS: [(&str, &str); 3] = [
    ("default", ""),
    ("three phases", "[fine]\nrefine = 4\nmesh = [1, 2, 4]\n[ensemble]\nphases = 3\n"),
    (
        "three phases, trapezoidal",
        "[fine]\nrefine = 4\nmesh = [1, 2, 4]\nset = { \"time.scheme\" = { kind = \"newmark\", beta = 0.25, gamma = 0.5 } }\n\
         [ensemble]\nphases = 3\n",
    ),
];

/// An estimate compared with the exact value.
struct Compared {
    error: f64,
    uncertainty: f64,
    /// Order and spread of the estimate.
    parts: String,
}

/// How many intervals and whole set-ups contain the exact values, and half-widths over errors.
#[derive(Default)]
struct Count {
    values: i32,
    contained: i32,
    unknown: i32,
    set_ups: i32,
    whole: i32,
    ratios: Vec<f64>,
}

impl Count {
    /// Compares a reference with the exact values, and prints the rows.
    fn add(&mut self, problem: &Problem, reference: &Reference) {
        let mut all = true;
        let mut rows: Vec<(&str, Option<Compared>)> = Vec::new();
        for (metric, exact) in &problem.metrics {
            let of = |found: Estimate| Compared {
                error: (found.value - exact).abs(),
                uncertainty: found.uncertainty,
                parts: format!(
                    "order {:.2}, members ± {:.1e}",
                    found.order.unwrap_or(f64::NAN),
                    found.spread
                ),
            };
            rows.push((metric, reference.estimate(metric).ok().map(of)));
        }
        for (column, exact) in &problem.histories {
            let known = reference.known.iter().find(|known| known.group.columns.iter().any(|c| c == column));
            let of = || {
                let known = known?;
                let (times, values) = reference.column(column)?;
                let right: Vec<f64> = times.iter().map(|t| exact(*t)).collect();
                let own = Signal::of(times, vec![values]);
                let far = own.distance(&Signal::of(times, vec![&right]), known.windows[0])?;
                let uncertainty = known.uncertainty.as_ref().ok()?[0];
                Some(Compared { error: far.smooth / known.scale, uncertainty, parts: String::new() })
            };
            rows.push((column, of()));
        }
        for (what, found) in rows {
            let Some(Compared { error, uncertainty, parts }) = found else {
                println!("{:26} {what:17} not established", problem.name);
                self.unknown += 1;
                continue;
            };
            self.values += 1;
            let inside = error <= uncertainty;
            self.contained += i32::from(inside);
            all &= inside;
            // Of a value without an error the ratio is infinite, and counts as that.
            let ratio = if error > 0.0 { uncertainty / error } else { f64::INFINITY };
            self.ratios.push(ratio);
            let outside = if inside { "" } else { "  outside" };
            println!(
                "{:26} {what:17} {uncertainty:9.2e} {error:9.2e} {ratio:8.2}{outside}  {parts}",
                problem.name
            );
        }
        self.set_ups += 1;
        self.whole += i32::from(all);
    }

    /// Prints what the intervals contain.
    fn print(&mut self) {
        let median = self.median();
        let Self { values, contained, unknown, set_ups, whole, .. } = *self;
        println!(
            "{contained} of {values} intervals contain the exact value, all of them in {whole} of {set_ups}"
        );
        println!("median of half-width / actual error: {median:.2}; not established: {unknown}\n");
    }

    fn median(&mut self) -> f64 {
        self.ratios.sort_by(f64::total_cmp);
        self.ratios[self.ratios.len() / 2]
    }

    fn join(&mut self, other: Self) {
        self.values += other.values;
        self.contained += other.contained;
        self.unknown += other.unknown;
        self.set_ups += other.set_ups;
        self.whole += other.whole;
        self.ratios.extend(other.ratios);
    }
}

/// The computed reference of a problem.
fn reference(problem: &Problem, design: &str) -> Result<Reference, String> {
    let study = format!(
        "case = \"case.toml\"\ngoal = \"trajectory\"\nreference = \"fine\"\n{design}[[arm]]\nname = \"arm\"\n"
    );
    let done = Studied::of(problem, &study)?;
    done.study.reference.clone().ok_or_else(|| "no reference".to_owned())
}

/// A study of a problem, whose records are removed unless they are kept.
struct Studied {
    study: Study,
    folder: PathBuf,
    is_kept: bool,
}

impl Studied {
    fn of(problem: &Problem, study: &str) -> Result<Self, String> {
        let mut hasher = DefaultHasher::new();
        (&problem.case, study).hash(&mut hasher);
        let kept = std::env::var_os("CAROM_COVERAGE").map(PathBuf::from);
        let is_kept = kept.is_some();
        let folder =
            kept.unwrap_or_else(std::env::temp_dir).join(format!("coverage-{:016x}", hasher.finish()));
        let out = folder.join("out");
        let text = |error: &dyn std::fmt::Display| error.to_string();
        let file = folder.join("study.toml");
        let study = if out.join("verdict.json").is_file() {
            Study::open(&out, &mut |_, _| ()).map_err(|error| text(&error))?
        } else {
            let _ = std::fs::remove_dir_all(&folder);
            std::fs::create_dir_all(&folder).map_err(|error| text(&error))?;
            std::fs::write(folder.join("case.toml"), &problem.case).map_err(|error| text(&error))?;
            std::fs::write(&file, study).map_err(|error| text(&error))?;
            let plan = Plan::read(&file).map_err(|error| text(&error))?;
            let done = carom_study::start(&plan, &out, 2, &mut |_| (), &AtomicBool::new(false));
            done.map_err(|error| text(&error))?.study
        };
        Ok(Self { study, folder, is_kept })
    }
}

impl Drop for Studied {
    fn drop(&mut self) {
        if !self.is_kept {
            let _ = std::fs::remove_dir_all(&self.folder);
        }
    }
}

/// Methods of the trials of verdicts.
const METHODS: [(&str, &str); 7] = [
    ("Hu", "{ kind = \"hu\" }"),
    ("CH 0.1", "{ kind = \"chung-hulbert\", rho_inf = 0.1 }"),
    ("CH 0.6", "{ kind = \"chung-hulbert\", rho_inf = 0.6 }"),
    ("trapezoidal", "{ kind = \"newmark\", beta = 0.25, gamma = 0.5 }"),
    ("Bathe", "{ kind = \"bathe\", rho_inf = 0.5 }"),
    ("TR-BDF2", "{ kind = \"tr-bdf2\" }"),
    ("BDF2", "{ kind = \"bdf2\" }"),
];

/// Largest error of the members of an arm with respect to the exact history.
fn true_error(study: &Study, arm: usize, column: &str, exact: &History, window: f64) -> Option<f64> {
    let of = |run: usize| {
        let run = Run::open(&study.directory.join(&study.manifest.run(run).directory)).ok()?;
        let times = run.history.times();
        let right: Vec<f64> = times.iter().map(|t| exact(*t)).collect();
        let own = Signal::of(times, vec![run.history.column(column)?]);
        Some(own.distance(&Signal::of(times, vec![&right]), window)?.smooth)
    };
    study.manifest.runs_of(arm).into_iter().map(of).try_fold(0.0, |most: f64, error| Some(most.max(error?)))
}

/// Outcomes of trials of verdicts.
#[derive(Default)]
struct Trials {
    recommended: usize,
    right: usize,
    high: usize,
    wrong_high: usize,
    wrong_none: usize,
}

impl Trials {
    /// Compares the verdict of a study with the true errors of its arms.
    fn add(&mut self, what: &str, study: &Study, errors: &[(usize, f64)]) {
        let cost = |arm: usize| study.rows[arm].value("cost").unwrap_or(f64::INFINITY);
        let least = |arms: &mut dyn Iterator<Item = f64>| arms.fold(f64::INFINITY, f64::min);
        let Some(ranking) = &study.ranking else { return };
        let Ok(verdict) = &ranking.verdict else {
            let mut all: Vec<f64> = errors.iter().map(|(_, error)| *error).collect();
            all.sort_by(f64::total_cmp);
            let leads = all.len() > 1 && all[1] > 2.0 * all[0];
            self.wrong_none += usize::from(leads);
            println!("{what:40} none, the best leads by 2: {leads}; {:?}", ranking.verdict);
            return;
        };
        let own = errors.iter().find(|(arm, _)| *arm == verdict.arm).map_or(f64::NAN, |found| found.1);
        let mut affordable =
            errors.iter().filter(|(arm, _)| cost(*arm) <= 1.1 * cost(verdict.arm)).map(|(_, error)| *error);
        let share = own / least(&mut affordable);
        let right = share <= 1.5;
        let high = verdict.confidence == Confidence::High;
        self.recommended += 1;
        self.right += usize::from(right);
        self.high += usize::from(high);
        self.wrong_high += usize::from(high && !right);
        let name = &study.rows[verdict.arm].name;
        println!(
            "{what:40} {name:22} {:8} {share:6.3} times the best at its cost",
            verdict.confidence.word()
        );
    }
}

/// Verdicts for displacements and stresses of the problems, judged by the exact histories: with
/// steps in which a wave crosses one or two cells, and with steps four times as long.
#[test]
#[ignore = "forty-eight studies with ensembles and computed references: three minutes"]
fn recommendations_are_true() {
    let mut trials = Trials::default();
    for problem in problems().iter().filter(|problem| problem.name.starts_with('L')) {
        for (column, exact) in &problem.histories {
            for longer in [1.0, 4.0] {
                judge(problem, column, exact, longer, &mut trials);
            }
        }
    }
    let Trials { recommended, right, high, wrong_high, wrong_none } = trials;
    println!(
        "{right} of {recommended} recommendations are right; of high confidence: {high}, wrong {wrong_high}; wrong refusals: {wrong_none}"
    );
    assert!(10 * right >= 9 * recommended && high >= 4 && wrong_high == 0 && wrong_none == 0);
}

/// A trial with steps longer than those of the problem by a factor. The reference is always the
/// same.
fn judge(problem: &Problem, column: &str, exact: &History, longer: f64, trials: &mut Trials) {
    let goal = if column.contains("sigma") { "stress" } else { "trajectory" };
    let line = problem.case.lines().find(|line| line.starts_with("step = ")).unwrap();
    let step: f64 = line.trim_start_matches("step = ").parse().unwrap();
    let methods = METHODS
        .map(|(name, kind)| format!("[[arm]]\nname = \"{name}\"\nset = {{ \"time.scheme\" = {kind} }}\n"));
    let end = problem.case.lines().find_map(|line| line.strip_prefix("end = ")).unwrap();
    let end: f64 = end.parse().unwrap();
    let count = (end / step / longer).round();
    let steps = [(count / 2.0).round(), count].map(|count| format!("{:?}", end / count));
    let study = format!(
        "case = \"case.toml\"\ndesign = \"matched-step\"\nsteps = [{}]\ngoal = \"{goal}\"\nreference = \"fine\"\n\
         [fine]\nmesh = [1, 2, 4]\nrefine = {}\n[ensemble]\nphases = 3\n{}",
        steps.join(", "),
        4.0 * longer,
        methods.concat()
    );
    let studied = Studied::of(problem, &study).unwrap();
    let study = &studied.study;
    let reference = study.reference.as_ref().unwrap();
    let known = reference.known.iter().find(|known| known.group.columns.iter().any(|c| c == column));
    let window = known.and_then(|known| known.windows.first()).copied().unwrap_or_default();
    let ranked = study.ranking.as_ref().unwrap().levels.iter().flatten();
    let error = |arm: usize| Some((arm, true_error(study, arm, column, exact, window)?));
    let errors: Vec<_> = ranked.filter_map(|ranked| error(ranked.arm)).collect();
    trials.add(&format!("{}, {goal}, steps × {longer}", problem.name), study, &errors);
}

#[test]
#[ignore = "eighty-one studies with up to three levels and three phases each: four minutes"]
fn stated_uncertainties_contain_the_truth() {
    let mut total = Count::default();
    for (design, text) in DESIGNS {
        println!("{design}: ± stated, error, ratio");
        let mut count = Count::default();
        for problem in problems() {
            match reference(&problem, text) {
                Ok(reference) => count.add(&problem, &reference),
                Err(why) => panic!("{}: {why}", problem.name),
            }
        }
        count.print();
        total.join(count);
    }
    println!("all designs:");
    total.print();
    let share = |part: i32, all: i32| f64::from(part) / f64::from(all);
    assert!(share(total.contained, total.values) >= 0.95 && share(total.whole, total.set_ups) >= 0.8);
    assert!(total.median() <= 3.0);
}
