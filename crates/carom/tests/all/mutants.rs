//! Shipped cases with random damage: `carom check` accepts or refuses them, with a documented exit
//! code and without a panic, and `carom run` does the same in the same words.

use std::process::Stdio;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{IMPACT, Place, text};

macro_rules! case {
    ($name:literal) => {
        include_str!(concat!("../../../../cases/", $name, ".toml"))
    };
}

/// Cases with small models and without other files.
const CASES: [&str; 10] = [
    IMPACT,
    case!("bar/single"),
    case!("disc/offset"),
    case!("loads/tool"),
    case!("obstacle/hammer"),
    case!("friction/drum"),
    case!("corner/dent"),
    case!("space/top"),
    case!("static/lame"),
    case!("overlap/bars"),
];
/// What takes the place of a number or of a word.
const VALUES: [&str; 16] = [
    "0",
    "-1",
    "1e308",
    "-1e-308",
    "nan",
    "inf",
    "0.5",
    "7",
    "true",
    "\"\"",
    "[]",
    "[1.0, 2.0]",
    "{}",
    "\"x\"",
    "\"1/(x - x)\"",
    "9223372036854775808",
];
const MUTANTS: usize = 300;

/// Reproducible random numbers below a limit (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }
}

/// A case with one to three damages.
fn mutant(seed: usize) -> String {
    let mut random = Random(seed as u64);
    let mut lines: Vec<String> = CASES[random.below(CASES.len())].lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let (k, count) = (random.below(lines.len()), lines.len());
        let other = lines[random.below(lines.len())].clone();
        let line = &mut lines[k];
        let mut letters: Vec<char> = line.chars().collect();
        let at = random.below(letters.len());
        match random.below(8) {
            0 => line.clear(),
            1 => *line = format!("{line}\n{other}"),
            2 => *line = other,
            3 if !letters.is_empty() => {
                letters.remove(at);
                *line = letters.into_iter().collect();
            }
            4 => {
                letters.insert(at, ['"', '[', '}', '=', '.', '-', '\u{0}', 'é'][random.below(8)]);
                *line = letters.into_iter().collect();
            }
            5 if k + 1 < count => lines.swap(k, k + 1),
            6 => lines.truncate(k + 1),
            _ => {
                if let Some((key, _)) = line.split_once('=') {
                    *line = format!("{key}= {}", VALUES[random.below(VALUES.len())]);
                }
            }
        }
    }
    lines.join("\n")
}

/// Exit code and words of a run that ends before its first step; none of one that has begun, which
/// is ended.
fn started(place: &Place, name: &str) -> Option<(Option<i32>, String)> {
    let out = format!("run-of-{name}");
    let mut command = place.command(&["run", name, "--no-report", "--out", &out]);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let began = || place.0.join(&out).join("manifest.json").is_file();
    while !began() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    if began() {
        let _ = child.kill();
        child.wait().unwrap();
        return None;
    }
    let done = child.wait_with_output().unwrap();
    Some((done.status.code(), text(&done.stderr)))
}

#[test]
fn damaged_cases_are_checked_or_refused() {
    let place = Place::new("mutants");
    let (next, accepted) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= MUTANTS {
                return;
            }
            let name = format!("{seed}.toml");
            let damaged = mutant(seed);
            place.file(&name, &damaged);
            let done = place.carom(&["check", &name]);
            let (code, said) = (done.status.code(), text(&done.stderr));
            assert!(matches!(code, Some(0 | 2)) && !said.contains("panicked"), "{code:?}\n{said}\n{damaged}");
            assert_eq!(code == Some(2), said.contains("error"), "{said}\n{damaged}");
            let run = started(&place, &name);
            assert_eq!(run.unwrap_or((Some(0), said.clone())), (code, said), "{damaged}");
            accepted.fetch_add(usize::from(code == Some(0)), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let accepted = accepted.into_inner();
    // Some damages only change a comment or a number.
    assert!((MUTANTS / 10..MUTANTS / 2).contains(&accepted), "{accepted}");
}
