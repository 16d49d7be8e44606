//! Messages about contacts and rigid obstacles, by parts of them.

use super::messages::{compare, shown};
use super::{BARS, IMPACT, resolved};

/// (overrides of the impact, what the message contains)
const CONTACTS: &[(&[&str], &[&str])] = &[
    // a frozen contact point
    (&["contact.strike.xi=froze"], &["`xi` cannot be \"froze\"", "did you mean `frozen`?"]),
    (&["contact.strike.xi=frozen"], &["cannot be used with this detection", "xi = \"closest\""]),
    (
        &["preset=paper", "contact.strike.xi=frozen", "contact.strike.enforcement=penalty"],
        &["xi = \"frozen\" cannot be used with a penalty"],
    ),
    (
        &["preset=paper", "contact.strike.xi=frozen", "time.scheme={ kind = \"bathe\", rho_inf = 0.5 }"],
        &["xi = \"frozen\" cannot be used with scheme `bathe`"],
    ),
    (
        &["preset=paper", "contact.strike.xi=frozen", "contact.strike.law=predictor"],
        &["xi = \"frozen\" cannot be used with law = \"predictor\""],
    ),
    (
        &[
            "preset=paper",
            "contact.strike.xi=frozen",
            "contact.strike.primary={ circle = { center = [0.0, -1.0], radius = 1.0 } }",
        ],
        &["xi = \"frozen\" cannot be used with a rigid obstacle", "leave xi out"],
    ),
    // contacts between bodies
    (&["contact.strike.self=false"], &["`self` needs `between`"]),
    (
        &["contact=[{ name = \"strike\", between = [\"cylinder\", \"prsm\"] }]"],
        &["there is no body `prsm`", "did you mean `prism.skin`?"],
    ),
    // contact without mass
    (&["material.rubber.density=0"], &["no node in contact `strike` has mass", "persistency = \"none\""]),
    // invalid combinations
    (
        &["contact.strike.law=predictor", "time.scheme.kind=bathe"],
        &["scheme `bathe` has no predictor to project", "several stages"],
    ),
    (
        &["contact.strike.law=predictor", "contact.strike.enforcement=penalty"],
        &["law = \"predictor\" cannot be used with a penalty"],
    ),
    (
        &["contact.strike.law=predictor", "contact.strike.enforcement=augmented"],
        &["law = \"predictor\" cannot be used with an augmented Lagrangian", "masses alone"],
    ),
    (
        &["contact.strike.law=predictor", "contact.strike.persistency=project"],
        &["persistency = \"project\" cannot be used here", "nothing to project"],
    ),
    (
        &["contact.strike.stiffness=3.0"],
        &["`stiffness` is given without springs", "only \"penalty\" and \"augmented\" have a stiffness"],
    ),
    // schemes with their own contact law
    (
        &["contact.strike.restitution=0.5"],
        &["chung-hulbert has no restitution, but e = 0.5 is given", "moreau-jean"],
    ),
    (
        &[
            "time.scheme={ kind = \"energy-momentum\" }",
            "contact.strike.restitution=0.5",
            "contact.strike.persistency=none",
        ],
        &["`strike` cannot have restitution = 0.5 with energy-momentum", "persistency = \"project\""],
    ),
    (
        &[
            "time.scheme={ kind = \"energy-momentum\" }",
            "contact.strike.restitution=0.5",
            "contact.strike.enforcement=penalty",
        ],
        &[
            "`strike` cannot have restitution = 0.5",
            "springs return the energy",
            "enforcement = \"multiplier\"",
        ],
    ),
    (
        &[
            "time.scheme={ kind = \"energy-momentum\" }",
            "contact.strike.restitution=0.5",
            "contact.strike.law=predictor",
        ],
        &["`strike` cannot have restitution = 0.5", "law = \"position\""],
    ),
    (
        &["time.scheme={ kind = \"energy-momentum\" }", "contact.strike.restitution=1.5"],
        &["`restitution` must be a number in [0, 1]"],
    ),
    (
        &["contact.strike.law=velocity"],
        &["law = \"velocity\" constrains velocities", "the unknowns of chung-hulbert"],
    ),
    (&["time.scheme={ kind = \"moreau-jean\", theta = 0.4 }"], &["`theta` must be a number in [0.5, 1]"]),
    (
        &["time.scheme={ kind = \"moreau-jean\", theta = 1.0 }", "contact.strike.law=position"],
        &[
            "law = \"position\" constrains positions",
            "the unknowns of moreau-jean are velocities and impulses",
        ],
    ),
    (
        &["time.scheme={ kind = \"moreau-jean\", theta = 1.0 }", "contact.strike.persistency=project"],
        &["persistency = \"project\" cannot be used with this scheme", "leave it out"],
    ),
    (
        &["time.scheme={ kind = \"central-difference\" }"],
        &[
            "central-difference needs a lumped mass, but that of body `cylinder` is consistent",
            "mass = \"lumped\"",
        ],
    ),
    (
        &[
            "time.scheme={ kind = \"paoli-schatzman\" }",
            "material.rubber.density=0",
            "contact.strike.persistency=none",
        ],
        &["body `cylinder` has no mass, and paoli-schatzman divides by it"],
    ),
    (
        &[
            "time.scheme={ kind = \"moreau-jean\", theta = 1.0 }",
            "support=[{ on = [\"prism.bottom\"], move = { y = \"0.1*t\" } }]",
        ],
        &["moving supports are not available with moreau-jean", "chung-hulbert"],
    ),
    (
        &[
            "time.scheme={ kind = \"moreau-jean\", theta = 1.0 }",
            "contact.strike.primary={ plane = { point = [0, 0], normal = [0, 1] }, motion = { y = \"t\" } }",
        ],
        &["moving obstacles are not available with moreau-jean", "chung-hulbert"],
    ),
    (
        &["time.scheme={ kind = \"moreau-jean\", theta = 1.0 }", "contact.strike.enforcement=penalty"],
        &["enforcement = \"penalty\" cannot be used with this scheme"],
    ),
    (
        &["time.scheme={ kind = \"moreau-jean\", theta = 1.0 }", "contact.strike.enforcement=augmented"],
        &["enforcement = \"augmented\" cannot be used with this scheme"],
    ),
    (
        &["time.scheme={ kind = \"moreau-jean\", theta = 1.0 }", "body.prism.mass=redistributed"],
        &["body `prism` has nodes without mass, and moreau-jean divides by it"],
    ),
];

#[test]
fn wrong_contacts() {
    compare(CONTACTS);
}

#[test]
fn wrong_obstacles() {
    let plane = "plane = { point = [-1.0], normal = [2] }";
    let cases: &[(&str, &[&str])] = &[
        (
            "{ }",
            &[
                "exactly one shape; this one has none",
                "`plane`, `circle`, `sphere`, `cylinder`, `polyline` or `surface`",
            ],
        ),
        ("{ PLANE, circle = { center = [0.0], radius = 1.0 } }", &["this one has plane, circle"]),
        ("{ circle = { center = [0.0], radius = 1.0 } }", &["a circle needs dimension = 2"]),
        ("{ PLANE, mass = 1.0, motion = { x = 0.0 } }", &["both `motion` and `mass`"]),
        ("{ PLANE, velocity = [1.0] }", &["`velocity` needs `mass`"]),
        ("{ PLANE, mass = 0.0 }", &["`mass` must be a number > 0, not 0"]),
        ("{ PLANE, motion = {} }", &["the motion is empty"]),
        ("{ PLANE, motion = { y = 0.0 } }", &["there is no motion `y` in dimension 1"]),
        ("{ PLANE, motion = { rotate = 1.0 } }", &["`rotate` and `about` belong together", "add `about"]),
        ("{ PLANE, motion = { x = \"X\" } }", &["X"]),
        ("{ PLANE, moton = { x = 0.0 } }", &["unknown key `moton`", "did you mean `motion`?"]),
    ];
    for (primary, parts) in cases {
        let primary = primary.replace("PLANE", plane);
        let text = BARS.replacen(&format!("{{ {plane} }}"), &primary, 1);
        assert_ne!(&text, BARS);
        let message = resolved(&text, &[]).map_or_else(|_| shown(&text, &[]), |_| String::new());
        for part in *parts {
            assert!(message.contains(part), "{primary}: {part:?} not in\n{message}");
        }
    }
}

#[test]
fn pairs_are_contacts_once() {
    let twice = "\n[[contact]]\nname = \"again\"\nsecondary = \"prism.top\"\nprimary = \"cylinder.arc\"\n";
    let message = shown(&format!("{IMPACT}{twice}"), &[]);
    assert!(message.contains("this pair of sides is already a contact"), "{message}");
}

/// What has no friction says so, and never computes without.
#[test]
fn friction_is_refused_where_it_is_not_built() {
    let with = "[[contact]]\nmu = 0.3";
    let cases: &[(&str, &str)] = &[
        ("contact.strike.law=\"predictor\"", "with law = \"predictor\""),
        ("contact.strike.detection=\"trajectory\"", "with this contact point"),
        ("body.cylinder.mass=\"redistributed\"", "with redistributed mass"),
        (
            "contact.strike.primary={ circle = { center = [0.0, -1.0], radius = 1.0 }, mass = 1.0 }",
            "against an obstacle with a mass",
        ),
    ];
    let text = IMPACT.replacen("[[contact]]", with, 1);
    assert!(resolved(&text, &[]).is_ok());
    for (set, what) in cases {
        let message = shown(&text, &[*set]);
        assert!(message.contains(&format!("mu = 0.3 cannot be used {what}")), "{set}:\n{message}");
    }
}

/// Coefficients that contradict each other, also as formulas; zero is none.
#[test]
fn coefficients_of_friction_are_judged_by_their_values() {
    let with = |keys: &str| IMPACT.replacen("[[contact]]", &format!("[[contact]]\n{keys}"), 1);
    let cases: &[(&str, &str)] = &[
        ("mu = 0.3\nmu_dynamic = 0.4", "mu_dynamic = 0.4 is larger than mu = 0.3"),
        ("mu = \"0.3\"\nmu_dynamic = 0.4", "mu_dynamic = 0.4 is larger than mu = 0.3"),
        ("mu = 0\nmu_dynamic = 0.1", "mu_dynamic = 0.1 is larger than mu = 0"),
        ("mu = \"-0.1\"", "`mu` must be a number ≥ 0, not -0.1"),
        ("mu_dynamic = 0.1", "`mu_dynamic` is given without `mu`"),
        ("mu = 0.3\nmu_dynamic = 0.1\ndecay = 0", "`decay` must be a number > 0, not 0"),
    ];
    for (keys, message) in cases {
        let shown = shown(&with(keys), &[]);
        assert!(shown.contains(message), "{keys}:\n{shown}");
    }
    let refused = shown(&with("mu = \"0.3 + 0*t\""), &["contact.strike.law=\"predictor\""]);
    assert!(refused.contains("mu = \"0.3 + 0*t\" cannot be used"), "{refused}");
    for zero in ["mu = 0", "mu = \"0\"", "mu = 0\nshear = 1.0", "mu = 0\nmu_dynamic = 0"] {
        assert!(resolved(&with(zero), &["contact.strike.detection=\"trajectory\""]).is_ok(), "{zero}");
    }
}
