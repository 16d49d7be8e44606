//! A run in memory is the run in a directory.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use carom_record::{Run, Source};
use carom_run::case::Function;
use carom_run::recording::{run, run_in_memory};

use super::common::case;

const DISC: &str = r#"
dimension = 2
plane = "strain"
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
contact = [{ name = "floor", secondary = "disc.arc", primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } } }]
probe = [{ name = "top", body = "disc", at = [0.0, 1.01], record = ["uy", "sigma_yy"] }]
expect = [{ what = "restitution", at_least = 0.5 }]
[[body]]
name = "disc"
material = "rubber"
element = "T6"
mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.51], size = 0.4 }
velocity = [0.0, -2.0]
[time]
end = 0.3
step = 5e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
[output]
fields_every = 10
"#;

#[test]
fn a_record_in_memory_is_that_of_a_directory() {
    let case = case(DISC, &[""; 0]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let go = AtomicBool::new(false);
    run(&case, Source::default(), &path, 1, &mut |_| (), &go).unwrap();
    let (_, record) = run_in_memory(&case, Source::default(), 1, &mut |_| (), &go).unwrap();
    let read = Run::open(&path).unwrap();
    let memory = &record.run;
    assert_eq!(memory.history.columns, read.history.columns);
    for (one, other) in memory.history.values.iter().zip(&read.history.values) {
        assert!(one.iter().map(|x| x.to_bits()).eq(other.iter().map(|x| x.to_bits())));
    }
    assert!(!memory.contact.is_empty());
    assert_eq!((&memory.contact, &memory.log), (&read.contact, &read.log));
    assert_eq!(memory.manifest.expectations, read.manifest.expectations);
    assert_eq!(memory.manifest.expectations.len(), 1);
    assert_eq!(memory.manifest.counters, read.manifest.counters);
    assert_eq!(memory.fields, read.fields);
    for (entry, fields) in memory.fields.iter().zip(&record.fields) {
        assert_eq!(*fields, read.field(entry).unwrap());
    }
}

/// 3 t per component, with its derivatives.
#[derive(Debug)]
struct Ramp;

impl Function for Ramp {
    fn values(&self, points: &[f64], width: usize) -> Vec<f64> {
        points.chunks_exact(width).map(|point| 3.0 * point[width - 1]).collect()
    }

    fn with_derivatives(&self, points: &[f64], width: usize) -> Vec<[f64; 3]> {
        self.values(points, width).into_iter().map(|u| [u, 3.0, 0.0]).collect()
    }
}

/// A function and the formula that it computes: loads on sides and in bodies, and a moving support.
#[test]
fn functions_of_a_program_are_formulas() {
    let block = |value: &str| {
        let text = format!(
            r#"
            dimension = 2
            plane = "strain"
            material = [{{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }}]
            support = [{{ on = ["block.bottom"], fix = ["y"], move = {{ x = "{value}" }} }}]
            load = [
                {{ on = ["block.top"], traction = [0, "{value}"] }},
                {{ on = ["block.left"], pressure = "{value}" }},
                {{ body = "block", body_force = ["{value}", 0] }},
            ]
            [[body]]
            name = "block"
            material = "rubber"
            element = "T6"
            mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.5], cells = [3, 2] }}
            velocity = [3.0, 0.0]
            [time]
            end = 0.05
            step = 5e-3
            scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }}
            "#
        );
        case(&text, &[""; 0])
    };
    let go = AtomicBool::new(false);
    let mut given = block("@ramp");
    let refused = run_in_memory(&given, Source::default(), 1, &mut |_| (), &go).unwrap_err().to_string();
    assert!(refused.contains("the function `ramp` is not given"), "{refused}");
    given.functions.0.insert("ramp".to_owned(), Arc::new(Ramp));
    let history = |case| run_in_memory(case, Source::default(), 1, &mut |_| (), &go).unwrap().1.run.history;
    let (function, formula) = (history(&given), history(&block("3*t")));
    assert!(formula.column("strain").unwrap().last().unwrap() > &1e-6);
    assert_eq!(function.values, formula.values);
}
