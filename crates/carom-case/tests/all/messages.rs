//! Messages: some compared word by word, the others by parts of them.

use super::{BARS, IMPACT, resolved};
use carom_case::{Document, read};

pub(super) fn shown(text: &str, sets: &[&str]) -> String {
    let found = resolved(text, sets).expect_err("the case is wrong");
    found.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n")
}

#[test]
fn word_by_word() {
    assert_eq!(
        shown(&IMPACT.replace("density", "densty"), &[]),
        "a/case.toml:11:1: unknown key `densty` in [[material]]
  densty = 0.25
  ^^^^^^
why: the keys of [[material]] are: name, law, density, lambda, mu, young, poisson, c10, c01, c20, c30, bulk, plastic
try: did you mean `density`?"
    );
    assert_eq!(
        shown(&IMPACT.replace("\"prism.top\"", "\"prism.topp\""), &[]),
        "a/case.toml:39:11: body `prism` has no side `topp`
  primary = \"prism.topp\"
            ^^^^^^^^^^^^
why: its mesh has the sides: prism.bottom, prism.right, prism.top, prism.left
try: did you mean `prism.top`?"
    );
    assert_eq!(
        shown(IMPACT, &["time.scheme.rho_inf=1.2"]),
        "--set:1:21: `rho_inf` must be a number in [0, 1], not 1.2
  time.scheme.rho_inf=1.2
                      ^^^
why: Spectral radius at infinite frequency: 0 removes the highest frequencies within a few steps, 1 does not damp them.
try: write for example `rho_inf = 1`"
    );
}

/// (overrides of the impact, what the message contains)
const IMPACTS: &[(&[&str], &[&str])] = &[
    // plastic flow
    (
        &["material.rubber.plastic={ yield = 1.0 }"],
        &["the law \"neo-hookean\" does not yield", "write `law = \"hencky\"`"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ hardening = 1.0 }"],
        &["`plastic` has no yield stress", "add `yield`, or a `table`"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ yield = 1.0, hardening = -2.0 }"],
        &["softens to zero", "at a plastic strain of about 0.500", "0.0 is perfect plasticity"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ yield = -1.0 }"],
        &["`yield` must be a number > 0, not -1"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ yield = 1.0, table = [[0.0, 1.0]] }"],
        &["`table` and `yield` are given", "leave out `yield`, or `table`"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ table = [[0.0, 2.0], [0.1, 1.0]] }"],
        &["the yield stress falls from 2 to 1 at a plastic strain of 0.1", "stay constant there"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ table = [[0.0, 1.0], [0.0, 2.0]] }"],
        &["the plastic strain 0 of the table follows 0", "each once"],
    ),
    (
        &["material.rubber.law=\"hencky\"", "material.rubber.plastic={ table = [[0.1, 1.0]] }"],
        &["begins at a plastic strain of 0.1", "begin with the yield stress at 0.0"],
    ),
    (
        &[
            "material.rubber.law=\"hencky\"",
            "material.rubber.plastic={ yield = 1.0 }",
            "body.cylinder.element=\"T3\"",
        ],
        &["the element T3 locks where the material `rubber` flows", "use element = \"T6\""],
    ),
    // types and ranges
    (&["material.rubber.density=heavy"], &["`density` must be a number ≥ 0, not the string \"heavy\""]),
    (
        &["material.rubber.density=-0.25"],
        &["must be a number ≥ 0, not -0.25", "did you mean `density = 0.25`?"],
    ),
    (
        &["material.rubber.density=\"2 kg\""],
        &[
            "not the string \"2 kg\"",
            "write the number alone, in mass/length³ of the case, whose length is in m",
        ],
    ),
    (&["time.end=nan"], &["`end` is NaN", "all numbers of a case must be finite"]),
    (&["body.cylinder.gravity=[0.0, -inf]"], &["`gravity` is -inf"]),
    (
        &["body.cylinder.gravity=[0.0]"],
        &["must be a list of 2 numbers or formulas in quotes, not a list of 1 values"],
    ),
    (&["body.cylinder.gravity=[0.0, \"-9.81*Y\"]"], &["it is a formula in the variables t"]),
    (&["body.cylinder.gravity=[0.0, 0.0, -9.81]"], &["a list of 3 values"]),
    (&["body.cylinder.mesh.radius=0"], &["`radius` must be a number > 0, not 0"]),
    (&["body.cylinder.mesh.size=0.0"], &["`size` must be a number > 0, not 0"]),
    (
        &["body.cylinder.mesh.size=0.6"],
        &["`size` = 0.6 is larger than the radius, 0.5", "give size ≤ 0.5, for example size = 0.1"],
    ),
    (
        &["body.prism.mesh={ shape = \"rectangle\", min = [0.1, -0.5], max = [0.3, 0.0], size = 0.6 }"],
        &["`size` = 0.6 is larger than the longer side, 0.5"],
    ),
    (&["body.prism.mesh.cells=[8, 0]"], &["must be a whole number ≥ 1, not the integer 0"]),
    (&["body.prism.mesh.cells=[8, 4.0]"], &["must be a list of 2 whole numbers ≥ 1, not the number 4.0"]),
    (
        &["refine=1.3"],
        &[
            "`refine` = 1.3 makes body[1].mesh.cells = [8, 4] into [10.4, 5.2]",
            "`refine = 1.25` or `refine = 1.5`",
        ],
    ),
    (&["body.prism.mesh.max=[1.0, -0.5]"], &["`max` = -0.5 is not greater than `min` = -0.5"]),
    (&["thickness=0"], &["`thickness` must be a number > 0"]),
    (&["material.rubber.mu=0"], &["`mu` must be a number > 0"]),
    (&["material.rubber.lambda=-10"], &["Λ = -10, μ = 15 are not positive definite", "lambda must be > -10"]),
    (&["material.rubber.young=3.0"], &["not a valid pair: lambda, mu, young"]),
    (
        &["material.rubber.poisson=0.5"],
        &["0.49 for `lambda = 735`", "must be a number in (-1, 0.5), not 0.5", "`poisson = 0.49`"],
    ),
    (&["material.rubber.poisson=0.3"], &["not a valid pair", "0.3 for `lambda = 22.5`"]),
    (&["body.cylinder.element=T7"], &["`element` cannot be \"T7\"", "T10"]),
    (&["body.cylinder.element=Q8"], &["Allowed values: T3, T6, T10, Q4, Q9\n", "did you mean `Q4`?"]),
    (
        &["probe=[{ name = \"A\", body = \"cylinder\", point = [0.0, 0.5] }]"],
        &["unknown key `point` in [[probe]]", "did you mean `at`?"],
    ),
    (
        &["probe=[{ name = \"A\", body = \"cylinder\" }]"],
        &["[[probe]] needs `at`", "why: `at` is required. Reference position of the point."],
    ),
    (&["contact.strike.friction={ mu = 0.3 }"], &["unknown key `friction`", "did you mean `mu`?"]),
    (&["body.cylinder.element=L2"], &["the element L2 has dimension 1", "use T3, T6, T10, Q4 or Q9"]),
    (&["dimension=4"], &["dimension 4 is not supported", "use dimension = 1, 2 or 3"]),
    (&["dimension=two"], &["`dimension` must be a whole number"]),
    (&["newton.max_iterations=0"], &["whole number ≥ 1"]),
    (&["time.energy_guard=true"], &["a number > 0, or false, not `true`"]),
    // schemes
    (&["time.scheme.kind=chung-hulber"], &["did you mean `chung-hulbert`?"]),
    (
        &["time.scheme={ kind = \"bathe\", rho_inf = 1.5 }"],
        &["`rho_inf` must be a number in [0, 1]", "write for example `rho_inf = 1`"],
    ),
    (&["contact.strike.restitution=1.5"], &["chung-hulbert has no restitution", "leave restitution out"]),
    (
        &["contact.strike.restitution=1.5", "time.scheme={ kind = \"moreau-jean\", theta = 0.5 }"],
        &["write for example `restitution = 1`"],
    ),
    (
        &[
            "material.rubber={ name = \"rubber\", law = \"neo-hookean\", density = 1, young = 1, poisson = -1 }",
        ],
        &["write for example `poisson = -0.99`"],
    ),
    (&["body.prism.mesh.cells=[-16, 16]"], &["did you mean 16?"]),
    (
        &["time.scheme={ kind = \"hu\", rho_inf = 0.5 }"],
        &["unknown key `rho_inf` in scheme \"hu\"", "scheme \"wbz\""],
    ),
    (
        &["time.scheme={ kind = \"newmark\", beta = 0.25 }"],
        &["requires `beta` and `gamma`, or `rho_inf`; `gamma` is missing", "kind = \"newmark\", rho_inf"],
    ),
    (&["time.scheme={ kind = \"hht\", alpha = -0.1 }"], &["did you mean `alpha = 0.1`?"]),
    (&["time.scheme=hu"], &["`scheme` must be a table { kind = \"…\", … }, not the string \"hu\""]),
    // steps
    (
        &["time.step=7e-3"],
        &["is not a multiple of the step", "end / step = 107.142857", "end = 0.749 or end = 0.756"],
    ),
    (&["time.step=1.0"], &["the step 1 is longer than the run"]),
    (&["time.step=7.5e-13"], &["too many steps"]),
    (&["output.at_times=[0.1, 0.8]"], &["the time 0.8 is outside the run"]),
    // names
    (&["body.cylinder.material=ruber"], &["there is no material `ruber`", "did you mean `rubber`?"]),
    (&["body.prism.name=cylinder"], &["two tables [[body]] are named `cylinder`"]),
    (&["probe.A.name=a.b"], &["\"a.b\" is not a valid name", "`name = \"a_b\"`"]),
    (&["probe.A.body=cylindr"], &["there is no body `cylindr`", "did you mean `cylinder`?"]),
    (&["contact.strike.secondary=prism.left"], &["both sides of `strike` belong to the body `prism`"]),
    (&["contact.strike.secondary=cylinder"], &["`cylinder` is not a side", "cylinder.arc, cylinder.axis"]),
    (
        &["contact.strike.secondary=cylindr.arc"],
        &["there is no body `cylindr`", "did you mean `cylinder.arc`?"],
    ),
    (&["body.cylindr.element=T6"], &["no `body` is named `cylindr`", "did you mean `body.cylinder`?"]),
    (&["expect=[{ what = \"min A.ux\", at_most = 0 }]"], &["no column `A.ux`", "did you mean `A.uy`?"]),
    (&["expect=[{ what = \"at 0.9 A.uy\", at_most = 0 }]"], &["the time 0.9 is outside the run"]),
    (
        &["expect=[{ what = \"contact_end\", after = 0.2, at_most = 0 }]"],
        &["`after` cannot be used with a metric"],
    ),
    (&["expect=[{ what = \"lowest A.uy\", at_most = 0 }]"], &["is not a valid quantity"]),
    (
        &["expect=[{ what = \"restitutoin\", at_most = 1 }]"],
        &["there is no metric `restitutoin`", "`restitution`?"],
    ),
    (
        &["expect=[{ what = \"rms [ A.uy - A.uz ]\", at_most = 0 }]"],
        &["no column `A.uz`", "did you mean `A.uy`?"],
    ),
    (&["expect=[{ what = \"A.uy\", at_most = 0 }]"], &["no metric `A.uy`", "write for example `last A.uy`"]),
    (&["expect=[{ what = \"last A.uy of 'x'\", at_most = 0 }]"], &["no arm \"x\"", "only a study has arms"]),
    (
        &["expect=[{ what = \"A.uy\", formula = \"2*sun(t)\", tolerance = 0 }]"],
        &["no function `sun`", "did you mean `sin`"],
    ),
    (&["expect=[{ what = \"last A.uy\", formula = \"t\", tolerance = 0 }]"], &["is not a valid quantity"]),
    (&["expect=[{ what = \"last A.uy\", norm = \"rms\", at_most = 0 }]"], &["`norm` without `formula`"]),
    (
        &["expect=[{ what = \"order\", of = \"last A.uy\", against = \"time.step\", at_least = 2 }]"],
        &["one run has no order of convergence", "of a study"],
    ),
    (
        &["expect=[{ what = \"last A.uy\", against = \"time.step\", at_most = 0 }]"],
        &["`against` without what = \"order\""],
    ),
    (&["expect=[{ what = \"min A.uy\", slow = 1, at_most = 0 }]"], &["`slow`", "true or false"]),
    (
        &["expect=[{ what = \"A.uy\", formula = \"exact\", tolerance = 0 }]"],
        &["no exact formula for `A.uy`", "[exact]"],
    ),
    (&["exact={ \"A.uz\" = \"t\" }"], &["no column `A.uz`", "did you mean `A.uy`?"]),
    (&["exact={ \"A.uy\" = \"s\" }"], &["no variable `s`"]),
    (&["expect=[{ what = \"min A.uy\", value = 0 }]"], &["needs exactly one bound", "it has value"]),
    // loads, motions and their formulas
    (
        &["load=[{ on = [\"prism.top\"], pressure = \"2*sun(t)\" }]"],
        &[
            "--set:1:43: the formula of `pressure`: there is no function `sun`\n",
            "why: it is a formula in the variables X, Y, t\ntry: did you mean `sin`?",
            "\n  load=",
            "^^^\n",
        ],
    ),
    (&["load=[{ on = [\"prism.top\"], traction = [\"X +\", 1] }]"], &["the formula ends where a number"]),
    (
        &["load=[{ on = [\"prism.top\"], traction = [\"Z\", 1] }]"],
        &["no variable `Z`\n", "try: the variables are X, Y, t"],
    ),
    (
        &["load=[{ on = [\"prism.top\"], traction = [1.0] }]"],
        &["`traction` must be a list of 2 numbers or formulas"],
    ),
    (
        &["load=[{ on = [\"prism.topp\"], pressure = 1 }]"],
        &["body `prism` has no side `topp`", "`prism.top`?"],
    ),
    (
        &["load=[{ body = \"prisma\", body_force = [0, 1] }]"],
        &["there is no body `prisma`", "did you mean `prism`?"],
    ),
    (
        &["load=[{ on = [\"prism.top\"] }]"],
        &["needs exactly one force and its place; it has no force and on"],
    ),
    (&["load=[{ body = \"prism\", pressure = 1 }]"], &["it has pressure and body"]),
    (
        &["load=[{ on = [\"prism.top\"], pressure = 1, table = \"no.csv\" }]"],
        &["the table \"no.csv\" cannot be used"],
    ),
    (&["support=[{ on = [\"prism.bottom\"] }]"], &["the support has neither `fix` nor `move`"]),
    (
        &["support=[{ on = [\"prism.bottom\"], fix = [\"y\"], move = { y = \"t\" } }]"],
        &["the direction y is both fixed and moved"],
    ),
    (&["body.prism.velocity=[\"t\", 0]"], &["no variable `t`\n", "try: the variables are X, Y"]),
    (&["body.prism.velocity={ angular = 1.0 }"], &["the rotation has no centre", "add `about = [x, y]`"]),
    (
        &["body.prism.velocity=[1, 0]", "time.scheme={ kind = \"static\" }"],
        &["the scheme \"static\" has no velocities"],
    ),
    (&["time.scheme={ kind = \"static\", rho_inf = 1 }"], &["unknown key `rho_inf` in scheme \"static\""]),
    // manufactured solutions
    (
        &["manufactured.y=[\"X\", \"Y + sin(\"]"],
        &[
            "the formula of `y`",
            "`support` cannot be used with [manufactured]",
            "`contact` cannot be used with [manufactured]",
        ],
    ),
    (&["manufactured.y=[\"X\"]"], &["`y` must be a list of 2 numbers or formulas"]),
    (&["expect=[{ what = \"last error_l2\", at_most = 0 }]"], &["no column `error_l2`"]),
    // later versions
    (&["plane=axisymmetric"], &["`plane = \"axisymmetric\"` is not supported yet"]),
    (&["contact.strike.passes=2"], &["`passes` is not supported yet"]),
    (
        &["contact.strike.method=mortar", "time.scheme={ kind = \"moreau-jean\", theta = 0.5 }"],
        &["method = \"mortar\" cannot be used with scheme `moreau-jean`"],
    ),
    (
        &["contact.strike.method=mortar", "time.fallback=velocity"],
        &["fallback = \"velocity\" cannot be used with method = \"mortar\""],
    ),
    (&["time.step={ initial = 1e-3 }"], &["`step` must be a number > 0, not a table", "A later version"]),
    (&["body.prism.mesh={ file = \"a.msh\", surface = \"prism\" }"], &["the mesh \"a.msh\" cannot be read"]),
    // shapes
    (
        &["body.prism.mesh={ shape = \"ring\", inner = 1.0, outer = 1.0, center = [0, 0], size = 1 }"],
        &["`outer` = 1 is not"],
    ),
    (
        &["body.prism.mesh={ shape = \"polygon\", points = [[0, 0], [1, 1]], size = 1 }"],
        &["at least 3 points"],
    ),
    (
        &["body.prism.mesh={ shape = \"polygon\", points = [[0, 0], [1, 1], [2]], size = 1 }"],
        &["`points` must be"],
    ),
    (
        &["body.prism.mesh={ shape = \"polygon\", points = [[0, 0], [1, 1], [1, 0], [0, 1]], size = 1 }"],
        &["side1 and side3 of the polygon cross", "list its corners in order"],
    ),
    (
        &["body.cylinder.mesh.refine=[{ near = [0.0, 0.0], size = 0.1 }]"],
        &["unknown key `refine`", "is a key of the case, mesh of shape \"polygon\""],
    ),
    (&["body.cylinder.place={ turn = 30 }"], &["unknown key `turn` in place", "rotate, about, shift"]),
    // keys of other tables
    (&["time.tolerance=1e-9"], &["unknown key `tolerance` in [time]", "is a key of [newton]"]),
    // memory
    (
        &["body.prism.mesh.cells=[10000000000, 1]"],
        &["too large for the memory: 1.200e11 nodes in 2.000e10 cells"],
    ),
    (&["body.prism.mesh.cells=[9223372036854775807, 9223372036854775807]"], &["too large for the memory"]),
    (&["body.cylinder.mesh.size=1e-300"], &["the mesh of `cylinder` is too large"]),
    // overrides themselves
    (&["time.step"], &["there is no `=`"]),
    (&["=3"], &["this is not a valid key"]),
    (&["title.sub=3"], &["`title` has no key `sub`", "`title` is the string"]),
    (&["time.scheme={ kind = "], &["--set:1:", "this is not TOML"]),
    (&["tim.step=1e-3"], &["unknown key `tim`", "did you mean"]),
];

/// Compares parts of the messages of overrides of the impact.
pub(super) fn compare(cases: &[(&[&str], &[&str])]) {
    for (sets, parts) in cases {
        let message = shown(IMPACT, sets);
        for part in *parts {
            assert!(message.contains(part), "{sets:?}: {part:?} not in\n{message}");
        }
        assert!(message.lines().all(|line| !line.ends_with(": ")), "{message}");
    }
}

#[test]
fn wrong_impacts() {
    compare(IMPACTS);
}

#[test]
fn wrong_bars() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("fix = [\"x\"]", "fix = [\"x\", \"y\"]", &["there is no direction y"]),
        ("\"sigma_xx\"]", "\"sigma_yy\"]", &["there is no quantity sigma_yy"]),
        ("[\"ux\", ", "[\"sigma_xx\", ", &["sigma_xx is recorded twice"]),
        ("normal = [2]", "normal = [0]", &["the normal is zero"]),
        (
            "shape = \"interval\", min = 0,",
            "shape = \"disc\", min = 0,",
            &["the shape \"disc\" has dimension 2"],
        ),
        ("poisson = 0.3", "poisson = 0.5", &["`poisson` must be a number in (-1, 0.5), not 0.5"]),
        ("[[support]]", "[support]", &["write its header in double brackets: [[support]]"]),
        (
            "secondary = \"left.left\"",
            "secondary = \"left.top\"",
            &["body `left` has no side `top`", "left.left, left.right"],
        ),
        (
            "primary = { plane = { point = [-1.0], normal = [2] } }",
            "detection = \"trajectory\"\nxi = \"frozen\"\nprimary = \"right.left\"",
            &["xi = \"frozen\" cannot be used in dimension 1", "the primary side is a point"],
        ),
    ];
    for (from, to, parts) in cases {
        let text = BARS.replacen(from, to, 1);
        assert_ne!(&text, BARS);
        let message = resolved(&text, &[]).map_or_else(|_| shown(&text, &[]), |_| String::new());
        for part in *parts {
            assert!(message.contains(part), "{to}: {part:?} not in\n{message}");
        }
    }
}

#[test]
fn all_problems_in_one_pass() {
    let message = shown(
        &IMPACT
            .replace("density", "densty")
            .replace("prism.top\"", "prism.topp\"")
            .replace("end = 0.75", "end = -1"),
        &["time.scheme.rho_inf=2"],
    );
    for part in ["densty", "topp", "`end` must be", "`rho_inf` must be"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    // In the order of the file, overrides last.
    let lines: Vec<_> =
        message.lines().filter(|l| l.starts_with("a/case") || l.starts_with("--set")).collect();
    assert_eq!(lines.len(), 4);
    assert!(lines[3].starts_with("--set"));
}

#[test]
fn examples_name_what_the_case_has() {
    let case = r#"
title = "t"
dimension = 2
[[body]]
name = "ball"
material = "steel"
element = "T6"
mesh = { shape = "disc", radius = 1.0, center = [0.0, 0.0], size = 0.2 }
[[contact]]
name = "c"
primary = 3
[[support]]
on = "floor"
"#;
    let document = Document::parse("case", case, &[]).unwrap();
    let message = document.diagnose_all(&read(&document).unwrap_err()).to_string();
    assert!(
        message.contains("primary = \"ball.arc\"") && message.contains("on = [\"ball.arc\"]"),
        "{message}"
    );
    assert!(!message.contains("prism.") && !message.contains("cylinder."), "{message}");
}

/// What to write instead of a number with a unit, in quotes or without.
#[test]
fn numbers_with_units() {
    let unquoted = |line: &str| shown(&IMPACT.replace("step = ", &format!("{line}\nstep0 = ")), &[]);
    let of_line = unquoted("step = 2e-4 s");
    assert!(
        of_line.contains("write `step = 2e-4`: the number alone, in s, the unit of time of the case"),
        "{of_line}"
    );
    assert!(unquoted("step = 20 ms  # short").contains("write `step = 0.02`: the number alone, in s"));
    let quoted = |set: &str| shown(IMPACT, &[set]);
    assert!(quoted("time.end=\"100 ms\"").contains("write `end = 0.1`: the number alone, in s"));
    let in_ms = ["units={ time = \"ms\" }", "time.end=\"100 ms\""];
    assert!(shown(IMPACT, &in_ms).contains("write `end = 100`: the number alone, in ms"));
}

/// The same input is no advice.
#[test]
fn examples_have_the_dimension_of_the_case() {
    let space = "dimension = 3\n[[body]]\nname = \"box\"\ngravity = [0.0, -9.81]\nvelocity = { angular = 3.0 }\nplace = { rotate = 4.0 }\n";
    let text = shown(space, &[]);
    for words in [
        "write for example `gravity = [0.0, -9.81, 0.0]`",
        "write for example `rotate = { axis = [0.0, 0.0, 1.0], angle =",
        "write for example `angular = [0.0, 0.0, 2.0]`",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn tables_without_names() {
    let text = shown(IMPACT, &["support.a.fix=[\"x\"]"]);
    assert!(text.contains("no table of `support` has a `name`"), "{text}");
    assert!(text.contains("replace the list as a whole: --set support=[…]"), "{text}");
}

/// The option that is too much, not the table in the file.
#[test]
fn a_third_elastic_constant() {
    let text = shown(IMPACT, &["material.rubber.young=3"]);
    assert!(text.contains("--set:1:") && text.contains("lambda, mu, young"), "{text}");
}

#[test]
fn a_file_with_a_similar_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("slope.toml"), "").unwrap();
    let of = |name: &str| Document::open(&folder.path().join(name), &[]).unwrap_err().to_string();
    assert!(of("slop.toml").contains("slope.toml?"), "{}", of("slop.toml"));
    assert!(of("ball.toml").contains("check the path"));
}

/// A load step has no velocities that a projection could need.
#[test]
fn contact_without_mass_in_statics() {
    let massless = [
        "material.rubber.density=0",
        "body.cylinder.velocity=[0.0, 0.0]",
        "time.scheme={ kind = \"static\" }",
    ];
    let found = resolved(IMPACT, &massless).err().unwrap_or_default();
    let text: String = found.iter().map(ToString::to_string).collect();
    assert!(!text.contains("has mass"), "{text}");
}
