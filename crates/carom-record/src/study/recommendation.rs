//! The recommendation that follows from a ranking, with its confidence, or why there is none.
//!
//! Methods are ordered by their mean place over the levels. Of those that are not distinguished
//! from the best and have the required accuracy, the cheapest is recommended; processor times
//! within 10 % of the smallest count as equal, and so do all of a design of matched cost; the
//! smaller error then decides. Nothing is recommended if only a proxy for the measure of the goal
//! is established, or if none of them has the required accuracy.

pub use super::confidence::Confidence;
use super::confidence::{DecidedBy, Evidence, confidence};
use super::design::{Goal, Kind};
use super::digits::short;
use super::manifest::StudyManifest;
use super::measure::Measure;
use super::places::{EQUAL_COST, Ranked, cheaper};
use super::reference::Reference;
use super::row::Row;

/// The recommendation.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The recommended arm.
    pub arm: usize,
    /// Methods (arms in a study without methods) that are not distinguished from it.
    pub alike: Vec<String>,
    /// Its penetration if its contact is enforced by a penalty, in words.
    pub penetration: Option<String>,
    /// Reasons for the recommendation.
    pub reasons: Vec<String>,
    /// Confidence in it.
    pub confidence: Confidence,
    /// Reasons for the confidence.
    pub confidence_reasons: Vec<String>,
}

/// The recommendation, or the reasons why there is none.
pub(super) fn recommended(
    goal: Goal,
    manifest: &StudyManifest,
    measure: &Measure,
    levels: &[Vec<Ranked>],
    rows: &[Row],
    reference: Option<&Reference>,
) -> Result<Verdict, Vec<String>> {
    let name = |arm: usize| manifest.arms[arm].method();
    // An arm that created much energy is not recommended, nor evidence for its method.
    let sound = |ranked: &Vec<Ranked>| ranked.iter().filter(|r| r.sound).cloned().collect();
    let any_unsound = levels.iter().flatten().any(|r| !r.sound);
    let unfiltered = levels;
    let levels: Vec<Vec<Ranked>> = levels.iter().map(sound).collect();
    let full: Vec<&Vec<Ranked>> = levels.iter().filter(|l| !l.is_empty()).collect();
    let mut methods: Vec<&str> = Vec::new();
    for ranked in full.iter().flat_map(|l| l.iter()) {
        if !methods.contains(&name(ranked.arm)) {
            methods.push(name(ranked.arm));
        }
    }
    // A method without an arm at a level is placed after all others.
    let places = |method: &str| {
        let place = |l: &&Vec<Ranked>| {
            l.iter().find(|r| name(r.arm) == method).map_or(manifest.arms.len() + 1, |r| r.place)
        };
        full.iter().map(place).sum::<usize>() as f64 / full.len() as f64
    };
    let finest = |method: &str| {
        full.iter()
            .rev()
            .find_map(|l| l.iter().find(|r| name(r.arm) == method))
            .map_or(f64::INFINITY, |r| r.error)
    };
    let accuracy = manifest.accuracy();
    let cost = |r: &Ranked| rows[r.arm].value("cpu_time").unwrap_or(f64::INFINITY);
    // The cheapest arm of a method that has the accuracy, at any level.
    let least_cost = |method: &str| {
        let arms = full.iter().filter_map(|l| l.iter().find(|r| name(r.arm) == method));
        arms.map(cost).fold(f64::INFINITY, f64::min)
    };
    let order = |method: &str| if goal == Goal::Cost { least_cost(method) } else { places(method) };
    methods.sort_by(|a, b| order(a).total_cmp(&order(b)).then(finest(a).total_cmp(&finest(b))));
    let without = if any_unsound { "no arm that did not create energy" } else { "no arm" };
    let nothing = || match goal {
        Goal::Cost => vec![format!("{without} has the required accuracy, {accuracy}")],
        _ => vec![format!("{without} has a value for: {}", measure.words)],
    };
    let first = methods.first().ok_or_else(nothing)?;
    let most = if goal == Goal::Cost { (1.0 + EQUAL_COST) * order(first) } else { order(first) };
    let mut tied: Vec<&str> = methods.iter().copied().filter(|m| order(m) <= most).collect();
    if goal == Goal::Cost {
        // Of those that cost the same, the more accurate one goes first.
        tied.sort_by(|a, b| finest(a).total_cmp(&finest(b)));
    }
    // What the goal minimises.
    let minimised = |r: &Ranked| if goal == Goal::Cost { cost(r) } else { r.error };
    // The arm of a method that would be recommended.
    let arm_of = |method: &str| {
        let arms: Vec<&Ranked> =
            full.iter().filter_map(|l| l.iter().find(|r| name(r.arm) == method)).collect();
        match goal {
            Goal::Cost => arms.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).copied(),
            // Without an accurate one, the most accurate.
            _ => arms
                .iter()
                .find(|r| r.has_accuracy(accuracy))
                .or(arms.iter().min_by(|a, b| a.error.total_cmp(&b.error)))
                .copied(),
        }
    };
    // Among equals, one that is accurate enough goes before a cheaper one that is not.
    let accurate = |m: &&str| goal == Goal::Cost || arm_of(m).is_some_and(|r| r.has_accuracy(accuracy));
    let (fit, unfit): (Vec<&str>, Vec<&str>) = tied.iter().copied().partition(accurate);
    let field = if fit.is_empty() { &unfit } else { &fit };
    // What was matched by counting is not told apart by measured times.
    let is_matched =
        goal != Goal::Cost && manifest.design.as_ref().is_some_and(|d| d.kind == Kind::MatchedCost);
    let measured = |method: &str| {
        let time = rows.get(arm_of(method)?.arm)?.value("cpu_time");
        time.filter(|time| *time > 0.0 && !is_matched)
    };
    let costs: Vec<Option<f64>> = field.iter().map(|m| measured(m)).collect();
    let picked = cheapest(&costs);
    let best = field[picked];
    let alike_ones: Vec<String> = tied.iter().filter(|m| **m != best).map(|m| (*m).to_owned()).collect();
    let chosen = arm_of(best).ok_or_else(nothing)?;
    let mut against = Vec::new();
    if !measure.passed_over.is_empty() {
        let names: Vec<&str> = measure.passed_over.iter().map(|(name, _)| name.as_str()).collect();
        against.push(format!(
            "the reference does not establish {}, the measure of this goal; the arms are ranked by a proxy, {}",
            names.join(" or "),
            measure.name
        ));
    }
    if goal != Goal::Cost && !chosen.has_accuracy(accuracy) {
        against.push(inaccurate(manifest, &full, best, chosen));
    }
    if !against.is_empty() {
        for ranked in &full {
            let first = || ranked.iter().filter(|r| r.place == 1);
            let place = if first().count() > 1 { "shares the first place" } else { "ranks first" };
            for r in first() {
                against.extend(penetration(manifest, r.arm, rows).map(|depth| {
                    let arm = &manifest.arms[r.arm].name;
                    format!("{arm} {place}; its contact is a penalty: {depth}")
                }));
            }
        }
        return Err(against);
    }
    let is_first = |method: &str, l: &[Ranked]| l.iter().any(|r| r.place == 1 && name(r.arm) == method);
    let first_at = full.iter().filter(|l| is_first(best, l)).count();
    // Methods with a worse mean place that nevertheless share the first place at a level.
    let others = methods.iter().filter(|m| !tied.contains(m));
    let sharing = |method: &&str| full.iter().filter(|l| is_first(best, l) && is_first(method, l)).count();
    let sharing = others.map(|m| (*m, sharing(m))).filter(|(_, levels)| *levels > 0 && goal != Goal::Cost);
    let sharing: Vec<(&str, usize)> = sharing.collect();
    let unit = if goal == Goal::Cost { " s" } else { "" };
    let mut reasons = vec![format!("{}: {}{unit}", measure.words, short(minimised(chosen)))];
    let level = |arm: usize| manifest.arms[arm].role.level;
    let others = full
        .iter()
        .flat_map(|l| l.iter())
        .filter(|r| goal == Goal::Cost || level(r.arm) == level(chosen.arm))
        .filter(|r| name(r.arm) != best);
    if let Some(next) = others.min_by(|a, b| minimised(a).total_cmp(&minimised(b))) {
        let which = if goal == Goal::Cost {
            "cheapest of the other methods"
        } else {
            "best of the other methods at the same level"
        };
        reasons.push(format!(
            "{which}, {}: {}{unit}{}",
            name(next.arm),
            short(minimised(next)),
            if goal != Goal::Cost && next.error.max(chosen.error) <= measure.uncertainty {
                format!("; both are below the uncertainty of the errors, {}", short(measure.uncertainty))
            } else {
                String::new()
            }
        ));
    }
    if goal != Goal::Cost {
        reasons.extend(passed_by(manifest, unfiltered, &methods, &tied, chosen));
    }
    // The least cost is that of any level.
    let first_at = if goal == Goal::Cost { full.len() } else { first_at };
    if goal != Goal::Cost {
        reasons.push(match full.len() {
            all if all == first_at => "no method is distinguishably better at any level".to_owned(),
            all => format!("at {first_at} of {all} levels no method is distinguishably better"),
        });
    }
    let next = costs.iter().enumerate().filter(|(i, _)| *i != picked).filter_map(|(i, c)| Some((i, (*c)?)));
    let next = next.min_by(|a, b| a.1.total_cmp(&b.1));
    // Cost of the cheapest of the others, relative to that of the recommended one.
    let times = next.zip(costs[picked]).map(|((_, other), own)| other / own);
    if let Some(((i, other), own)) = next.zip(costs[picked]).filter(|_| goal != Goal::Cost) {
        let words = if other > (1.0 + EQUAL_COST) * own {
            "cheapest of the methods tied with it over all levels"
        } else {
            "of the methods tied with it over all levels none is cheaper by more than 10 %"
        };
        reasons.push(format!(
            "{words}: {} s of processor time; {}: {} s",
            short(own),
            field[i],
            short(other)
        ));
    }
    if goal != Goal::Cost {
        reasons.push(format!("this is the coarsest level at which its error is at most {accuracy}"));
    }
    let penetration = penetration(manifest, chosen.arm, rows);
    if let Some(depth) = &penetration {
        reasons.push(format!("its contact is a penalty: {depth}"));
    }
    for other in &alike_ones {
        let depth = arm_of(other).and_then(|arm| self::penetration(manifest, arm.arm, rows));
        reasons.extend(depth.map(|depth| {
            format!("the contact of {other}, which is not distinguished, is a penalty: {depth}")
        }));
    }
    if !measure.left_out.is_empty() {
        reasons
            .push(format!("not established by the reference, and left out: {}", measure.left_out.join(", ")));
    }
    let dearer = times.is_some_and(|times| times > 1.0 + EQUAL_COST) && goal != Goal::Cost;
    let decided_by = match (alike_ones.len(), field.len()) {
        (0, _) => DecidedBy::Error,
        (_, 1) => DecidedBy::Accuracy,
        _ if dearer => DecidedBy::Cost,
        _ => {
            // A method that costs more than 10 % more is distinguished by that.
            let costs_as_much = |other: Option<f64>| {
                !other.zip(costs[picked]).is_some_and(|(other, own)| cheaper(own, other))
            };
            let same = field.iter().zip(&costs).filter(|(m, cost)| **m != best && costs_as_much(**cost));
            DecidedBy::Nothing(same.map(|(method, _)| (*method).to_owned()).collect())
        }
    };
    let evidence = Evidence {
        mesh: reference.map_or_else(|| ensemble_refines(manifest), Reference::refines_mesh),
        reference: reference.is_some(),
        ensemble: full.iter().flat_map(|l| l.iter()).all(|r| r.members > 1),
    };
    let (mut confidence, mut confidence_reasons) =
        confidence(goal, manifest, measure, &full, first_at, decided_by, &sharing, &evidence);
    let arm = &manifest.arms[chosen.arm];
    if let Some(design) =
        manifest.design.as_ref().filter(|d| d.kind == Kind::MatchedStep && manifest.by_cost(arm))
    {
        confidence = confidence.min(Confidence::Medium);
        confidence_reasons.push(format!(
            "it is compared at the cost of {}, the other methods at their common step",
            design.cost_of
        ));
    }
    Ok(Verdict { arm: chosen.arm, alike: alike_ones, penetration, reasons, confidence, confidence_reasons })
}

/// Why a method with a smaller error at the level of the recommended arm has a worse mean place:
/// what it did at another level.
fn passed_by(
    manifest: &StudyManifest,
    levels: &[Vec<Ranked>],
    methods: &[&str],
    tied: &[&str],
    chosen: &Ranked,
) -> Vec<String> {
    let level = manifest.arms[chosen.arm].role.level;
    let of =
        |method: &str, level: usize| levels[level].iter().find(|r| manifest.arms[r.arm].method() == method);
    let why_not = |method: &&str| {
        let here = of(method, level).filter(|r| r.sound && r.error < chosen.error)?;
        let (worst, place) = (0..levels.len())
            .filter(|other| *other != level && !levels[*other].is_empty())
            .map(|other| (of(method, other), of(method, other).map_or(usize::MAX, |r| r.place)))
            .max_by_key(|(ranked, place)| (ranked.is_none_or(|r| !r.sound), *place))?;
        let why = match worst {
            None => "it has no value at another level".to_owned(),
            Some(r) if !r.sound => format!("{} created energy", manifest.arms[r.arm].name),
            Some(r) => format!("{} is only in place {place}", manifest.arms[r.arm].name),
        };
        Some(format!("{method} has a smaller error at this level, {}, but {why}", short(here.error)))
    };
    methods.iter().filter(|m| !tied.contains(m)).filter_map(why_not).collect()
}

/// Why a method without the required accuracy is not recommended: no arm has it, or only arms of
/// methods with worse places have.
fn inaccurate(manifest: &StudyManifest, levels: &[&Vec<Ranked>], method: &str, chosen: &Ranked) -> String {
    let accuracy = manifest.accuracy();
    let name = |r: &Ranked| &manifest.arms[r.arm].name;
    let least = levels.iter().flat_map(|l| l.iter()).min_by(|a, b| a.error.total_cmp(&b.error));
    let least = least.unwrap_or(chosen);
    if chosen.error <= accuracy {
        return format!(
            "the error of {}, {}, is that of the median of its members, one of which is off it by {}, \
             more than the required accuracy, {accuracy}",
            name(chosen),
            short(chosen.error),
            short(chosen.uncertainty)
        );
    }
    if least.error > accuracy {
        return format!(
            "no arm has the required accuracy, {accuracy}; the best one, {}, has an error of {}",
            name(least),
            short(least.error)
        );
    }
    format!(
        "the method with the best places, {method}, does not have the required accuracy, {accuracy}: its \
         smallest error is {}; {} has an error of {}",
        short(chosen.error),
        name(least),
        short(least.error)
    )
}

/// Whether the arms are repeated on finer meshes.
fn ensemble_refines(manifest: &StudyManifest) -> bool {
    manifest.ensemble.as_ref().is_some_and(|ensemble| ensemble.mesh.len() > 1)
}

/// Whether contact of an arm is enforced by a penalty.
fn is_penalty(manifest: &StudyManifest, arm: usize) -> bool {
    manifest.arms[arm].facts.contacts.iter().any(|contact| contact.is_penalty)
}

/// Penetration of an arm whose contact is enforced by a penalty. Nodes that are not constrained
/// penetrate without one too, so that its depth is given beside those of the other arms.
fn penetration(manifest: &StudyManifest, arm: usize, rows: &[Row]) -> Option<String> {
    if !is_penalty(manifest, arm) {
        return None;
    }
    let unit = &rows.get(arm)?.metrics.iter().find(|m| m.name == "penetration")?.unit;
    let depth = rows[arm].value("penetration")?;
    let role = |arm: usize| (manifest.arms[arm].role.level, manifest.arms[arm].role.fine);
    let others = (0..manifest.arms.len()).filter(|other| role(*other) == role(arm));
    let others = others.filter(|other| !is_penalty(manifest, *other));
    let depths: Vec<f64> = others.filter_map(|other| rows.get(other)?.value("penetration")).collect();
    let (low, high) = depths.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(*d), b.max(*d)));
    let beside = if depths.is_empty() {
        String::new()
    } else {
        format!(" (arms of its level without a penalty: {} to {})", short(low), short(high))
    };
    let depth = format!("{} {unit}", short(depth));
    Some(format!("the largest penetration is {}{beside}", depth.trim_end()))
}

/// Index of the first method whose cost is within 10 % of the smallest; 0 if no cost is known.
fn cheapest(costs: &[Option<f64>]) -> usize {
    let least = costs.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    costs.iter().position(|c| c.is_some_and(|c| c <= (1.0 + EQUAL_COST) * least)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1.05 is equal to 1, 1.2 is not; unknown costs are ignored.
    #[test]
    fn the_cheapest_within_a_tenth_is_taken_in_order() {
        assert_eq!(cheapest(&[Some(9.9), Some(1.05), Some(1.0)]), 1);
        assert_eq!(cheapest(&[Some(1.2), None, Some(1.0)]), 2);
        assert_eq!((cheapest(&[None, None]), cheapest(&[Some(3.0)])), (0, 0));
    }
}
