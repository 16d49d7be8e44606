//! Runs of a study are compared in the same quantities, over the same time, at their own rows.

use std::sync::atomic::AtomicBool;

use carom_record::study::Study;
use carom_study::{Plan, start};

use crate::common;

/// Two equal bars collide in the middle: neither is faster. The centre of the left one moves with
/// 0.1 up to contact at t = 0.5, then turns with the constant force of a bar wave, ρc v A, which
/// lasts 2L/c = 0.4 with c = 5.
const COLLISION: &str = r#"
dimension = 1
[[material]]
name = "m"
law = "linear-elastic"
density = 1.0
young = 25.0
poisson = 0.0
[[body]]
name = "left"
material = "m"
element = "L2"
mesh = { shape = "interval", min = -1.0, max = 0.0, cells = 20 }
velocity = [0.1]
[[body]]
name = "right"
material = "m"
element = "L2"
mesh = { shape = "interval", min = 0.1, max = 1.1, cells = 20 }
velocity = [-0.1]
[[contact]]
name = "joint"
secondary = "left.right"
primary = "right.left"
[time]
end = 1.2
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
energy_guard = false
[output]
fields_every = 0
[exact]
"left.center_x" = "-0.5 + if(t < 0.5, 0.1*t, if(t < 0.9, 0.1*t - 0.25*(t - 0.5)^2, 0.05 - 0.1*(t - 0.9)))"
"#;

fn run(case: &str, study: &str) -> Study {
    let (folder, path) =
        common::raw_folder(&[("case.toml", case)], &format!("case = \"case.toml\"\n{study}"));
    let plan = Plan::read(&path).unwrap_or_else(|e| panic!("{e}"));
    start(&plan, &folder.path().join("out"), 2, &mut |_| (), &AtomicBool::new(false)).unwrap().study
}

const ARMS: &str = r#"
design = "matched-step"
steps = [0.02]
goal = "trajectory"
[[arm]]
name = "CH 0.1"
set = { "time.scheme" = { kind = "chung-hulbert", rho_inf = 0.1 } }
[[arm]]
name = "CH 0.6"
set = { "time.scheme" = { kind = "chung-hulbert", rho_inf = 0.6 } }
[[arm]]
name = "trapezoidal"
set = { "time.scheme" = { kind = "newmark", beta = 0.25, gamma = 0.5 } }
[[arm]]
name = "TR-BDF2"
set = { "time.scheme" = { kind = "tr-bdf2" } }
[[arm]]
name = "BDF2"
set = { "time.scheme" = { kind = "bdf2" } }
"#;

/// Which of two equally fast bodies is the striker is round-off: all arms are ranked all the same,
/// beside exact formulas and a computed reference.
#[test]
fn no_arm_vanishes_where_two_bodies_are_equally_fast() {
    for reference in ["exact", "fine"] {
        let study = run(COLLISION, &format!("reference = \"{reference}\"\nwindow = 0.1\n{ARMS}"));
        let ranking = study.ranking.as_ref().unwrap();
        let ranked = ranking.levels.iter().flatten().count();
        assert_eq!((ranked, ranking.apart.len()), (5, 0), "{reference}");
        let words = &ranking.measure.as_ref().unwrap().words;
        assert!(words.contains("centre of left"), "{words}");
    }
}

/// A wall that strikes a bar at rest is prescribed, and has no error: the bar is compared. In the
/// frame of the wall as much energy is lost in contact, of a quarter of the kinetic energy. (With
/// schemes that carry forces on, the work of the wall is that of other forces for a while.)
#[test]
fn a_wall_that_moves_is_no_striker() {
    let wall = |motion: &str, velocity: &str| {
        let case = COLLISION.split("[[body]]\nname = \"right\"").next().unwrap();
        let rest = COLLISION.split("[time]").nth(1).unwrap().split("[exact]").next().unwrap();
        let case = case.replace("velocity = [0.1]", velocity);
        format!(
            "{case}\n[[contact]]\nname = \"wall\"\nsecondary = \"left.right\"\nprimary = {{ plane = {{ point = [0.05], normal = [-1.0] }}{motion} }}\n[time]{rest}"
        )
    };
    let of = |case: &str| {
        let conserving =
            "[[arm]]\nname = \"EM\"\nset = { \"time.scheme\" = { kind = \"energy-momentum\" } }\n";
        let study = run(case, &format!("reference = \"fine\"\n{ARMS}{conserving}"));
        let words = study.ranking.as_ref().unwrap().measure.as_ref().unwrap().words.clone();
        assert!(words.contains("centre of left"), "{words}");
        study.rows[5].value("energy_error").unwrap()
    };
    let moving = of(&wall(", motion = { x = \"-0.1*t\" }", "velocity = [0.0]"));
    let still = of(&wall("", "velocity = [0.1]"));
    assert!((4.0 * moving / still - 1.0).abs() < 0.1 && still > 1e-3, "{moving:?} {still:?}");
}

/// In free fall all these schemes are exact at every row, and so is the centre of the body.
#[test]
fn what_is_drawn_between_rows_is_no_error() {
    let case = COLLISION.split("[[body]]\nname = \"right\"").next().unwrap();
    let case = format!(
        "{case}gravity = [-9.81]\n[time]\nend = 1.0\nstep = 0.1\nscheme = {{ kind = \"hu\" }}\n[output]\nfields_every = 0\n[exact]\n\"left.center_x\" = \"-0.5 + 0.1*t - 0.5*9.81*t^2\"\n"
    );
    let study = run(&case, &format!("reference = \"exact\"\nwindow = 0.1\n{}", ARMS.replace("0.02", "0.1")));
    for ranked in study.ranking.unwrap().levels.iter().flatten().filter(|ranked| ranked.arm < 4) {
        assert!(ranked.error < 1e-6, "{ranked:?}");
    }
}

/// Load steps of a bar that is pulled: the reference of static arms is static, without a check of
/// another scheme, and an exact answer is known.
#[test]
fn static_arms_have_a_static_reference() {
    let case = COLLISION.split("[[body]]\nname = \"right\"").next().unwrap();
    let case = format!(
        "{}\n[[support]]\non = [\"left.left\"]\nfix = [\"x\"]\n[[load]]\non = [\"left.right\"]\ntraction = [\"t\"]\n[[probe]]\nname = \"end\"\nbody = \"left\"\nat = [0.0]\nrecord = [\"ux\"]\n[time]\nend = 1.0\nstep = 0.1\nscheme = {{ kind = \"static\" }}\n[output]\nfields_every = 0\n",
        case.replace("velocity = [0.1]", "")
    );
    let arms = "design = \"matched-step\"\nsteps = [0.1]\ngoal = \"trajectory\"\nreference = \"fine\"\n[[arm]]\nname = \"static\"\n";
    let study = run(&case, arms);
    let names: Vec<&str> = study.manifest.arms.iter().map(|arm| arm.name.as_str()).collect();
    assert!(names.iter().all(|name| !name.contains("check of the scheme")), "{names:?}");
    // The displacement is linear in the load.
    let ranked = study.ranking.unwrap().levels[0][0].clone();
    assert!(ranked.error < 1e-9, "{ranked:?}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let first = |study: &str| {
        let found =
            common::raw_folder(&[("case.toml", COLLISION)], &format!("case = \"case.toml\"\n{study}"));
        common::wrong(found).swap_remove(0)
    };
    let two = |more: &str| {
        format!(
            "design = \"matched-step\"\nsteps = [0.02]\ngoal = \"trajectory\"\nreference = \"fine\"\n[[arm]]\nname = \"a\"\n[[arm]]\nname = \"b\"\n{more}"
        )
    };
    let found = first(&two("set = { \"time.end\" = 0.6 }\n"));
    assert!(found.what.contains("\"b, Δt 2e-2\" ends at 0.6") && found.line == 8, "{found:?}");
    let found = first(&two("set = { \"time.step\" = 0.01 }\n"));
    assert!(found.what.contains("the step of \"b\" would be ignored") && found.line == 10, "{found:?}");
    let found = first(&two("[fine]\nset = { \"time.step\" = 0.01 }\n"));
    assert!(found.what.contains("[fine] cannot set") && found.line == 11, "{found:?}");
    let found = first(&two("[fine]\nset = { \"time.end\" = 0.6 }\n"));
    assert!(found.what.contains("ends at 0.6"), "{found:?}");
}

#[test]
fn an_exact_reference_has_what_its_goal_compares() {
    let first = |exact: &str, study: &str| {
        let case = format!("{}[exact]\n{exact}\n", COLLISION.split("[exact]").next().unwrap());
        let study = format!(
            "case = \"case.toml\"\ngoal = \"force\"\nreference = \"exact\"\n{study}\n[[arm]]\nname = \"a\"\n"
        );
        common::wrong(common::raw_folder(&[("case.toml", &case)], &study)).swap_remove(0)
    };
    let found = first("contact_force_x = \"t\"", "window = 0.1");
    assert!(found.what.contains("[exact] has no `contact_impulse_x`") && found.line == 3, "{found:?}");
    let found = first("contact_force_x = \"t\"\ncontact_impulse_x = \"t^2/2\"", "");
    assert!(found.what.contains("needs `window`"), "{found:?}");
}

#[test]
fn a_claim_about_a_metric_that_does_not_exist_is_refused() {
    let claim = "[[claim]]\ntext = \"x\"\ncompare = 'energy_lsot of \"a\" < 0.1'\n";
    let study = format!("case = \"case.toml\"\n[[arm]]\nname = \"a\"\n{claim}");
    let found = common::wrong(common::raw_folder(&[("case.toml", COLLISION)], &study)).swap_remove(0);
    assert!(found.what.contains("did you mean `energy_lost`?") && found.line == 6, "{found:?}");
}
