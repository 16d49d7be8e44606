//! `carom check` refuses what `carom run` refuses before its first step, in the same words.

use crate::common::{IMPACT, Place, SQUARE, text};

/// Two blocks in contact, the upper one on the lower one.
const BLOCKS: &str = r#"
dimension = 2
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.3
[[body]]
name = "low"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [2, 2] }
[[body]]
name = "high"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 1.0], max = [1.0, 2.0], cells = [2, 2] }
[[support]]
name = "ground"
on = ["low.bottom"]
fix = ["x", "y"]
[[support]]
name = "ram"
on = ["high.top"]
fix = ["x"]
move = { y = "-0.01*t" }
[[contact]]
name = "joint"
secondary = "high.bottom"
primary = "low.top"
[time]
end = 1.0
step = 0.5
scheme = { kind = "static" }
"#;

#[test]
fn check_and_run_refuse_the_same() {
    let place = Place::new("refused");
    place.file("impact.toml", IMPACT).file("blocks.toml", BLOCKS).file("square.msh", SQUARE);
    for (case, sets, words) in [
        ("blocks", &["support.ram.move.y=\"0.01 - t\""][..], "a support would jump at the start"),
        (
            "blocks",
            &[
                "contact.joint.primary={ plane = { point = [0, 0], normal = [0, 1] }, motion = { y = \"t + 0.1\" } }",
            ],
            "the obstacle of contact \"joint\" would jump at the start",
        ),
        (
            "blocks",
            &[
                "contact.joint.primary={ plane = { point = [0, 0], normal = [0, 1] }, motion = { rotate = \"t + 5\", about = [0, 0] } }",
            ],
            "its angle is not zero at t = 0",
        ),
        ("blocks", &["support.ram.move.y=\"1/t\""], "has no value at t = 0"),
        ("blocks", &["body.high.place.shift=[0.0, -0.1]"], "overlap at the start by 0.1 m"),
        // All nodes of both sides are held: the overlap cannot be closed.
        (
            "blocks",
            &[
                "body.high.place.shift=[0.0, -0.1]",
                "contact.joint.overlap=\"relax\"",
                "support.ground.on=[\"low.bottom\", \"low.top\"]",
                "support.ram.on=[\"high.top\", \"high.bottom\"]",
            ],
            "cannot be relaxed",
        ),
        ("blocks", &["body.high.position=[\"X\", \"-Y\"]"], "the initial position inverts a cell"),
        (
            "blocks",
            &["contact=[]", "support=[{ on = [\"low.bottom\"], fix = [\"x\", \"y\"] }]"],
            "has no equilibrium",
        ),
        ("blocks", &["initial.from=nowhere"], "the final state of the run"),
        (
            "impact",
            &[
                "time.scheme={ kind = \"central-difference\" }",
                "body.cylinder.mass=lumped",
                "body.prism.mass=lumped",
            ],
            "is too long for central-difference",
        ),
        (
            "impact",
            &["body.prism.mesh={ file = \"square.msh\", surface = \"1\" }"],
            "no physical surface \"1\"",
        ),
    ] {
        let file = format!("{case}.toml");
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        let of = |command: &str| {
            let done = place.carom(&[&[command, &file], &sets[..]].concat());
            (done.status.code(), text(&done.stderr))
        };
        let (code, said) = of("check");
        assert!(code == Some(2) && said.contains(words), "{code:?} {sets:?}\n{said}");
        assert_eq!(of("run"), (code, said), "{sets:?}");
        assert!(!place.0.join("runs").exists());
    }
}
