//! A bar strikes a rigid wall at three speeds, in memory. Exact: the impulse is 2 m v, and contact
//! lasts 2L/c = 2/3 (`cargo run --release -p carom --example sweep`).

use carom::{Setup, case::Case};

const BAR: &str = r#"
title = "Bar on a wall"
dimension = 1
material = [{ name = "steel", law = "linear-elastic", density = 1.0, young = 900.0, poisson = 0.0 }]
contact = [{ name = "wall", secondary = "bar.left", primary = { plane = { point = [0.0], normal = [1.0] } } }]
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.1, max = 10.1, cells = 200 }
[time]
end = 1.5
step = 1e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.6 }
"#;

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("speed  impulse / (2 m v)  duration  rebound");
    for speed in [5.0, 10.0, 20.0] {
        let case = Case::from_text(BAR, &[&format!("body.bar.velocity=[-{speed}]")])?;
        let (mut run, mut duration) = (Setup::new(&case).start()?, 0.0);
        while !run.finished() {
            run.step()?;
            duration += if run.state().contact_forces[0][0] > 0.0 { run.dt() } else { 0.0 };
        }
        let (impulse, mass) = (run.state().impulse()[0], 10.0);
        let ratio = impulse / (2.0 * mass * speed);
        println!("{speed:5}  {ratio:17.4}  {duration:8.3}  {:7.3}", impulse / mass - speed);
        assert!((ratio - 1.0).abs() < 2e-3 && (duration - 2.0 / 3.0).abs() < 2e-3);
    }
    Ok(())
}
