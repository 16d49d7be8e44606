//! What is said of ties that cannot be made.

use carom_run::Setup;
use carom_run::case::{Document, Problem, read};

use super::common::case;
use super::ties::{LOWER_TO_UPPER, UPPER_TO_LOWER, blocks};

/// The problems of a case, with their places in its text.
fn problems(text: &str) -> Vec<(String, Problem)> {
    let document = Document::parse("case.toml", text, &[]).unwrap();
    let found = match read(&document) {
        Err(problems) => problems.to_vec(),
        Ok(case) => Setup::new(&case).build().err().map_or_else(Vec::new, |found| found.to_vec()),
    };
    found.into_iter().map(|problem| (document.diagnose(&problem).to_string(), problem)).collect()
}

/// Every mistake says where, what, why and what to try.
#[test]
fn messages_name_place_cause_and_cure() {
    let text = blocks(UPPER_TO_LOWER);
    let wide = text.replace("min = [0.0, 0.5], max = [1.0, 1.0]", "min = [0.0, 0.5], max = [1.5, 1.0]");
    let high = text.replace("min = [0.0, 0.5], max = [1.0, 1.0]", "min = [0.0, 0.51], max = [1.0, 1.0]");
    let far = text.replace("min = [0.0, 0.5], max = [1.0, 1.0]", "min = [2.0, 0.5], max = [3.0, 1.0]");
    let faster = text.replacen("angular = 2.0", "angular = 1.0", 1);
    let elsewhere = text.replacen("[\"1.1*X\", \"Y\"]", "[\"1.1*X\", \"Y + 0.1\"]", 1);
    let held = format!("{text}[[support]]\non = [\"upper.left\"]\nfix = [\"x\"]\n");
    let light =
        text.replace("name = \"upper\"\nmaterial = \"rubber\"", "name = \"upper\"\nmaterial = \"air\"");
    let light = format!(
        "{light}[[material]]\nname = \"air\"\nlaw = \"neo-hookean\"\ndensity = 0.0\nlambda = 1.0\nmu = 1.0\n"
    );
    let back = LOWER_TO_UPPER.replace("joint", "back").replace("upper.bottom", "upper.skin");
    let around = format!("{text}{back}");
    let cases: [(&str, &str, &str, [&str; 3]); 11] = [
        (
            "wide and on average",
            &wide.replace("primary = \"lower.top\"", "primary = \"lower.top\"\nmethod = \"mortar\""),
            "secondary = \"upper.bottom\"",
            ["has no partner on lower.top", "beside the primary side", "`method = \"points\"` with"],
        ),
        (
            "the far side",
            &text.replace("\"upper.bottom\"", "\"upper.top\""),
            "secondary = \"upper.top\"",
            ["away from lower.top", "moment", "name the two sides that touch"],
        ),
        (
            "wide",
            &wide,
            "secondary = \"upper.bottom\"",
            ["has no partner on lower.top", "beside the primary side, 2.500e-1", "overhang = \"free\""],
        ),
        (
            "high",
            &high,
            "secondary = \"upper.bottom\"",
            ["1.000e-2 away from lower.top", "moment", "`adjust = 1.01e-2`"],
        ),
        (
            "far",
            &format!("{far}\n")
                .replace("primary = \"lower.top\"", "primary = \"lower.top\"\noverhang = \"free\""),
            "secondary = \"upper.bottom\"",
            [
                "tie `joint` has no nodes",
                "no node of upper.bottom lies on lower.top",
                "`place` one of the bodies",
            ],
        ),
        (
            "faster",
            &faster,
            "velocity = {",
            [
                "the initial velocity differs across tie `joint`",
                "on the secondary side",
                "give both bodies the same",
            ],
        ),
        (
            "elsewhere",
            &elsewhere,
            "position = [",
            [
                "the initial position differs across tie `joint`",
                "on the primary side",
                "give both bodies the same",
            ],
        ),
        (
            "held",
            &held,
            "secondary = \"upper.bottom\"",
            ["tie `joint` and a support both hold", "no support moves or holds", "the same support"],
        ),
        (
            "light",
            &light,
            "secondary = \"upper.bottom\"",
            ["joins bodies with and without mass", "has no mass", "density > 0"],
        ),
        (
            "same",
            &text.replace("\"lower.top\"", "\"upper.bottom\""),
            "primary = \"upper.bottom\"",
            ["both sides of the tie are the same", "cannot move with itself", "another side"],
        ),
        (
            "none",
            &text.replace("\"lower.top\"", "\"lower.tip\""),
            "primary = \"lower.tip\"",
            ["no side `tip`", "the sides", "lower.top"],
        ),
    ];
    for (name, text, place, words) in cases {
        let found = problems(text);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        let (shown, problem) = &found[0];
        assert!(shown.contains(place), "{name}: {shown}");
        let [what, why, help] = words;
        assert!(problem.what.contains(what), "{name}: {problem:?}");
        assert!(problem.why.contains(why), "{name}: {problem:?}");
        assert!(problem.help.contains(help), "{name}: {problem:?}");
    }
    // A key of a tie is set by its name.
    assert_eq!(case(&high, &["tie.joint.adjust=0.011"]).ties[0].adjust, Some(0.011));
    // A side that overhangs may stay free there; one that is apart may be closed.
    for (text, key) in [(&wide, "overhang = \"free\""), (&high, "adjust = 0.011")] {
        let mended = text.replace("primary = \"lower.top\"", &format!("primary = \"lower.top\"\n{key}"));
        assert!(problems(&mended).is_empty(), "{key}: {:?}", problems(&mended));
    }
    let found = problems(&around);
    assert!(found.iter().any(|(_, problem)| problem.what.contains("depend on itself")), "{found:?}");
}
