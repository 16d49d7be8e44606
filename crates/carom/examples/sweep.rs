//! A bar strikes a rigid wall at three speeds, in memory; exact: ρ c v = 30 v for 2L/c = 0.667
//! (`cargo run --release -p carom --example sweep`).

use carom::case::{Document, read};

const BAR: &str = r#"
title = "Bar on a wall"
dimension = 1
material = [{ name = "steel", law = "linear-elastic", density = 1.0, young = 900.0, poisson = 0.0 }]
support = []
contact = [{ name = "wall", secondary = "bar.left", primary = { plane = { point = [0.0], normal = [1.0] } } }]
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.1, max = 10.1, cells = 200 }
velocity = [-1.0]
[time]
end = 1.5
step = 1e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.6 }
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("speed  impulse / (2 m v)  duration  rebound");
    for speed in [5.0, 10.0, 20.0] {
        let document = Document::parse("bar", BAR, &[format!("body.bar.velocity=[-{speed}]")])?;
        let case = read(&document).map_err(|problems| document.diagnose_all(&problems))?;
        let mut run = carom::simulation(&case, 1).map_err(|problems| document.diagnose_all(&problems))?;
        let mut touching = 0.0;
        while !run.finished() {
            run.advance(&mut carom::GridReport::default())?;
            touching += if run.state().contact_forces[0][0] > 0.0 { run.dt() } else { 0.0 };
        }
        let (impulse, mass) = (run.state().ledger.impulse[0], 10.0);
        let rebound = impulse / mass - speed;
        println!("{speed:5}  {:17.4}  {touching:8.3}  {rebound:7.3}", impulse / (2.0 * mass * speed));
    }
    Ok(())
}
