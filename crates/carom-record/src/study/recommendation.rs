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
    /// Number of the recommended arm.
    pub arm: usize,
    /// Methods (arms in a study without methods) that are not distinguished from the recommended
    /// one.
    pub alike: Vec<String>,
    /// Penetration of the recommended arm in words, if its contact is enforced by a penalty.
    pub penetration: Option<String>,
    /// Reasons for the recommendation.
    pub reasons: Vec<String>,
    /// Confidence in the recommendation.
    pub confidence: Confidence,
    /// Reasons for the confidence.
    pub confidence_reasons: Vec<String>,
}

/// The recommendation, or the reasons why there is none.
pub(super) fn recommended(
    goal: Goal,
    manifest: &StudyManifest,
    measure: &Measure,
    all: &[Vec<Ranked>],
    rows: &[Row],
    reference: Option<&Reference>,
) -> Result<Verdict, Vec<String>> {
    // An arm that created much energy is not recommended, nor evidence for its method.
    let sound = |level: &Vec<Ranked>| level.iter().filter(|r| r.sound).cloned().collect();
    let mut levels: Vec<Vec<Ranked>> = all.iter().map(sound).collect();
    levels.retain(|level| !level.is_empty());
    let field = Field { goal, manifest, measure, rows, levels };
    let best = field.best().ok_or_else(|| vec![field.nothing(all)])?;
    let against = field.against(&best);
    if !against.is_empty() {
        return Err(against);
    }
    let mut reasons = field.for_it(&best);
    if goal != Goal::Cost {
        reasons.extend(field.passed_by(all, &best));
        reasons.push(match field.first_at(best.method) {
            count if count == field.levels.len() => {
                "no method is distinguishably better at any level".to_owned()
            }
            count => {
                format!("at {count} of {} levels no method is distinguishably better", field.levels.len())
            }
        });
        reasons.extend(best.cost_beside());
        let accuracy = manifest.accuracy();
        reasons.push(format!("this is the coarsest level at which its error is at most {accuracy}"));
    }
    let penetration = penetration(manifest, best.chosen.arm, rows);
    reasons.extend(penetration.iter().map(|depth| format!("its contact is a penalty: {depth}")));
    for other in best.alike() {
        let depth = field.chosen(other).and_then(|arm| self::penetration(manifest, arm.arm, rows));
        reasons.extend(depth.map(|depth| {
            format!("the contact of {other}, which is not distinguished, is a penalty: {depth}")
        }));
    }
    if !measure.left_out.is_empty() {
        let left_out = measure.left_out.join(", ");
        reasons.push(format!("not established by the reference, and left out: {left_out}"));
    }
    let evidence = Evidence {
        decided_by: field.decided_by(&best),
        first_at: if goal == Goal::Cost { field.levels.len() } else { field.first_at(best.method) },
        sharing: field.sharing(&best),
        mesh: reference.map_or_else(|| ensemble_refines(manifest), Reference::refines_mesh),
        reference: reference.is_some(),
        ensemble: field.levels.iter().flatten().all(|r| r.members > 1),
    };
    let (mut confidence, mut confidence_reasons) =
        confidence(goal, manifest, measure, &field.levels, &evidence);
    let matched_step = manifest.design.as_ref().filter(|design| design.kind == Kind::MatchedStep);
    if let Some(design) = matched_step.filter(|_| manifest.by_cost(&manifest.arms[best.chosen.arm])) {
        confidence = confidence.min(Confidence::Medium);
        confidence_reasons.push(format!(
            "it is compared at the cost of {}, the other methods at their common step",
            design.cost_of
        ));
    }
    let alike = best.alike().map(str::to_owned).collect();
    Ok(Verdict { arm: best.chosen.arm, alike, penetration, reasons, confidence, confidence_reasons })
}

/// Input of a recommendation, with the sound arms of each level that has any, the coarsest first.
struct Field<'a> {
    goal: Goal,
    manifest: &'a StudyManifest,
    measure: &'a Measure,
    rows: &'a [Row],
    levels: Vec<Vec<Ranked>>,
}

/// The method that would be recommended.
struct Best<'a> {
    method: &'a str,
    /// Arm of the method that would be recommended.
    chosen: &'a Ranked,
    /// All methods in order of their mean place or cost.
    methods: Vec<&'a str>,
    /// Methods with the same mean place or cost, itself included.
    tied: Vec<&'a str>,
    /// Tied methods among which cost decides, with their measured costs.
    equals: Vec<(&'a str, Option<f64>)>,
}

impl<'a> Best<'a> {
    /// Other methods that are tied with the best one.
    fn alike(&self) -> impl Iterator<Item = &'a str> {
        self.tied.iter().copied().filter(|method| *method != self.method)
    }

    fn cost(&self) -> Option<f64> {
        self.equals.iter().find(|(method, _)| *method == self.method)?.1
    }

    /// The cheapest of the other methods among which cost decides, with its cost.
    fn next(&self) -> Option<(&'a str, f64)> {
        let others = self.equals.iter().filter(|(method, _)| *method != self.method);
        others.filter_map(|(m, cost)| Some((*m, (*cost)?))).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Compares the cost with that of the methods tied with the best one, in words.
    fn cost_beside(&self) -> Option<String> {
        let (next, other) = self.next()?;
        let own = self.cost()?;
        let words = if other > (1.0 + EQUAL_COST) * own {
            "cheapest of the methods tied with it over all levels"
        } else {
            "of the methods tied with it over all levels none is cheaper by more than 10 %"
        };
        Some(format!("{words}: {} s of processor time; {next}: {} s", short(own), short(other)))
    }
}

impl Field<'_> {
    fn name(&self, ranked: &Ranked) -> &str {
        self.manifest.arms[ranked.arm].method()
    }

    /// The arms of a method, the coarsest level first.
    fn arms(&self, method: &str) -> impl Iterator<Item = &Ranked> {
        self.levels.iter().filter_map(move |level| level.iter().find(|r| self.name(r) == method))
    }

    fn cost(&self, ranked: &Ranked) -> f64 {
        self.rows[ranked.arm].value("cpu_time").unwrap_or(f64::INFINITY)
    }

    /// Quantity of an arm that the goal minimises: its cost in seconds, or its error.
    fn minimised(&self, ranked: &Ranked) -> f64 {
        if self.goal == Goal::Cost { self.cost(ranked) } else { ranked.error }
    }

    /// Mean place of a method, that without an arm at a level being behind all others; for the goal
    /// of least cost, the cost of its cheapest arm.
    fn order(&self, method: &str) -> f64 {
        if self.goal == Goal::Cost {
            return self.arms(method).map(|r| self.cost(r)).fold(f64::INFINITY, f64::min);
        }
        let last = self.manifest.arms.len() + 1;
        let place =
            |level: &Vec<Ranked>| level.iter().find(|r| self.name(r) == method).map_or(last, |r| r.place);
        self.levels.iter().map(place).sum::<usize>() as f64 / self.levels.len() as f64
    }

    /// Error at the finest level.
    fn finest(&self, method: &str) -> f64 {
        self.arms(method).last().map_or(f64::INFINITY, |r| r.error)
    }

    fn is_accurate(&self, ranked: &Ranked) -> bool {
        ranked.has_accuracy(self.manifest.accuracy())
    }

    /// The arm of a method that would be recommended: the cheapest, or the coarsest accurate one;
    /// without an accurate one, the most accurate.
    fn chosen(&self, method: &str) -> Option<&Ranked> {
        if self.goal == Goal::Cost {
            return self.arms(method).min_by(|a, b| self.cost(a).total_cmp(&self.cost(b)));
        }
        let accurate = self.arms(method).find(|r| self.is_accurate(r));
        accurate.or_else(|| self.arms(method).min_by(|a, b| a.error.total_cmp(&b.error)))
    }

    fn best(&self) -> Option<Best<'_>> {
        let mut methods: Vec<&str> = Vec::new();
        for ranked in self.levels.iter().flatten() {
            if !methods.contains(&self.name(ranked)) {
                methods.push(self.name(ranked));
            }
        }
        let by_error = |a: &&str, b: &&str| self.finest(a).total_cmp(&self.finest(b));
        methods.sort_by(|a, b| self.order(a).total_cmp(&self.order(b)).then(by_error(a, b)));
        let least = self.order(methods.first()?);
        let most = if self.goal == Goal::Cost { (1.0 + EQUAL_COST) * least } else { least };
        let mut tied: Vec<&str> = methods.iter().copied().filter(|m| self.order(m) <= most).collect();
        if self.goal == Goal::Cost {
            // Of those that cost the same, the more accurate one goes first.
            tied.sort_by(by_error);
        }
        // Among equals, one that is accurate enough goes before a cheaper one that is not.
        let is_fit =
            |m: &&str| self.goal == Goal::Cost || self.chosen(m).is_some_and(|r| self.is_accurate(r));
        let (fit, unfit): (Vec<&str>, Vec<&str>) = tied.iter().copied().partition(is_fit);
        let equals = if fit.is_empty() { unfit } else { fit };
        let equals: Vec<_> = equals.into_iter().map(|method| (method, self.measured(method))).collect();
        let method = equals[cheapest(equals.iter().map(|(_, cost)| *cost))].0;
        Some(Best { method, chosen: self.chosen(method)?, methods, tied, equals })
    }

    /// Measured cost of a method; what was matched by counting is not told apart by it.
    fn measured(&self, method: &str) -> Option<f64> {
        let design = self.manifest.design.as_ref();
        let is_matched = self.goal != Goal::Cost && design.is_some_and(|d| d.kind == Kind::MatchedCost);
        let time = self.rows.get(self.chosen(method)?.arm)?.value("cpu_time");
        time.filter(|time| *time > 0.0 && !is_matched)
    }

    /// Why no arm can be recommended.
    fn nothing(&self, all: &[Vec<Ranked>]) -> String {
        let any_unsound = all.iter().flatten().any(|r| !r.sound);
        let without = if any_unsound { "no arm that did not create energy" } else { "no arm" };
        match self.goal {
            Goal::Cost => format!("{without} has the required accuracy, {}", self.manifest.accuracy()),
            _ => format!("{without} has a value for: {}", self.measure.words),
        }
    }

    /// Why the best arm is not recommended; nothing if it is.
    fn against(&self, best: &Best) -> Vec<String> {
        let mut against = Vec::new();
        if !self.measure.passed_over.is_empty() {
            let names: Vec<&str> = self.measure.passed_over.iter().map(|(name, _)| name.as_str()).collect();
            against.push(format!(
                "the reference does not establish {}, the measure of this goal; the arms are ranked by a proxy, {}",
                names.join(" or "),
                self.measure.name
            ));
        }
        if self.goal != Goal::Cost && !self.is_accurate(best.chosen) {
            against.push(inaccurate(self.manifest, &self.levels, best.method, best.chosen));
        }
        if against.is_empty() {
            return against;
        }
        for level in &self.levels {
            let first: Vec<&Ranked> = level.iter().filter(|r| r.place == 1).collect();
            let place = if first.len() > 1 { "shares the first place" } else { "ranks first" };
            for r in first {
                against.extend(penetration(self.manifest, r.arm, self.rows).map(|depth| {
                    let arm = &self.manifest.arms[r.arm].name;
                    format!("{arm} {place}; its contact is a penalty: {depth}")
                }));
            }
        }
        against
    }

    fn is_first(&self, method: &str, level: &[Ranked]) -> bool {
        level.iter().any(|r| r.place == 1 && self.name(r) == method)
    }

    /// Number of levels at which a method has the first place.
    fn first_at(&self, method: &str) -> usize {
        self.levels.iter().filter(|level| self.is_first(method, level)).count()
    }

    /// Methods that have a worse mean place than the best one but share the first place with it,
    /// with the number of levels at which they do.
    fn sharing(&self, best: &Best) -> Vec<(String, usize)> {
        if self.goal == Goal::Cost {
            return Vec::new();
        }
        let shares = |method: &str| {
            let both =
                |level: &&Vec<Ranked>| self.is_first(best.method, level) && self.is_first(method, level);
            (method.to_owned(), self.levels.iter().filter(both).count())
        };
        let others = best.methods.iter().filter(|m| !best.tied.contains(m));
        others.map(|m| shares(m)).filter(|(_, levels)| *levels > 0).collect()
    }

    /// The value of the recommended arm, and the best of the other methods.
    fn for_it(&self, best: &Best) -> Vec<String> {
        let Measure { words, uncertainty, .. } = self.measure;
        let by_cost = self.goal == Goal::Cost;
        let unit = if by_cost { " s" } else { "" };
        let mut reasons = vec![format!("{words}: {}{unit}", short(self.minimised(best.chosen)))];
        let level = |r: &Ranked| self.manifest.arms[r.arm].role.level;
        let comparable = |r: &&Ranked| by_cost || level(r) == level(best.chosen);
        let others = self.levels.iter().flatten().filter(comparable).filter(|r| self.name(r) != best.method);
        let next = others.min_by(|a, b| self.minimised(a).total_cmp(&self.minimised(b)));
        reasons.extend(next.map(|next| {
            let which = if by_cost {
                "cheapest of the other methods"
            } else {
                "best of the other methods at the same level"
            };
            let is_below = !by_cost && next.error.max(best.chosen.error) <= *uncertainty;
            let below = format!("; both are below the uncertainty of the errors, {}", short(*uncertainty));
            let below = if is_below { &below } else { "" };
            format!("{which}, {}: {}{unit}{below}", self.name(next), short(self.minimised(next)))
        }));
        reasons
    }

    /// Why a method with a smaller error at the level of the recommended arm has a worse mean
    /// place: what it did at another level.
    fn passed_by(&self, all: &[Vec<Ranked>], best: &Best) -> Vec<String> {
        let own = self.manifest.arms[best.chosen.arm].role.level;
        let of = |method: &str, level: usize| all[level].iter().find(|r| self.name(r) == method);
        let why_not = |method: &&str| {
            let here = of(method, own).filter(|r| r.sound && r.error < best.chosen.error)?;
            let (worst, place) = (0..all.len())
                .filter(|other| *other != own && !all[*other].is_empty())
                .map(|other| (of(method, other), of(method, other).map_or(usize::MAX, |r| r.place)))
                .max_by_key(|(ranked, place)| (ranked.is_none_or(|r| !r.sound), *place))?;
            let why = match worst {
                None => "it has no value at another level".to_owned(),
                Some(r) if !r.sound => format!("{} created energy", self.manifest.arms[r.arm].name),
                Some(r) => format!("{} is only in place {place}", self.manifest.arms[r.arm].name),
            };
            Some(format!("{method} has a smaller error at this level, {}, but {why}", short(here.error)))
        };
        best.methods.iter().filter(|m| !best.tied.contains(m)).filter_map(why_not).collect()
    }

    fn decided_by(&self, best: &Best) -> DecidedBy {
        let is_dearer = |(_, other): (&str, f64)| Some(other / best.cost()? > 1.0 + EQUAL_COST);
        if best.alike().next().is_none() {
            return DecidedBy::Error;
        }
        if best.equals.len() == 1 {
            return DecidedBy::Accuracy;
        }
        if self.goal != Goal::Cost && best.next().and_then(is_dearer) == Some(true) {
            return DecidedBy::Cost;
        }
        // A method that costs more than 10 % more is distinguished by that.
        let is_same = |(method, cost): &&(&str, Option<f64>)| {
            *method != best.method && !cost.zip(best.cost()).is_some_and(|(other, own)| cheaper(own, other))
        };
        let same = best.equals.iter().filter(is_same);
        DecidedBy::Nothing(same.map(|(method, _)| (*method).to_owned()).collect())
    }
}

/// Why a method without the required accuracy is not recommended: no arm has it, or only arms of
/// methods with worse places have.
fn inaccurate(manifest: &StudyManifest, levels: &[Vec<Ranked>], method: &str, chosen: &Ranked) -> String {
    let accuracy = manifest.accuracy();
    let name = |r: &Ranked| &manifest.arms[r.arm].name;
    let least = levels.iter().flatten().min_by(|a, b| a.error.total_cmp(&b.error));
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
fn cheapest(costs: impl Iterator<Item = Option<f64>> + Clone) -> usize {
    let least = costs.clone().flatten().fold(f64::INFINITY, f64::min);
    let mut costs = costs;
    costs.position(|c| c.is_some_and(|c| c <= (1.0 + EQUAL_COST) * least)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1.05 is equal to 1, 1.2 is not; unknown costs are ignored.
    #[test]
    fn the_cheapest_within_a_tenth_is_taken_in_order() {
        let cheapest = |costs: &[Option<f64>]| cheapest(costs.iter().copied());
        assert_eq!(cheapest(&[Some(9.9), Some(1.05), Some(1.0)]), 1);
        assert_eq!(cheapest(&[Some(1.2), None, Some(1.0)]), 2);
        assert_eq!((cheapest(&[None, None]), cheapest(&[Some(3.0)])), (0, 0));
    }
}
