//! The reference of a study, from the records of its runs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;

use super::arm::{Arm, history_every, step};
use super::manifest::StudyManifest;
use super::reference::{Level, Reference};
use super::trajectory::Trajectory;
use crate::metrics;
use crate::{Reason, RecordError, Run};

/// Relative difference of two times that is round-off.
const SAME: f64 = 1e-6;

/// Impact law of the contact nodes, as a part of the description of a reference: while contact
/// nodes have mass, the law belongs to the mathematical problem.
fn begins(arm: &Arm) -> &'static str {
    let mut projects = arm.facts.contacts.iter().map(|contact| contact.projects);
    match projects.next() {
        Some(first) if projects.any(|other| other != first) => "",
        Some(true) => "; impacts of nodes are inelastic (velocities are projected)",
        Some(false) => "; velocities of nodes are not changed where contact begins",
        None => "",
    }
}

impl StudyManifest {
    /// The bodies of the probes, by their names.
    fn bodies_of_probes(&self) -> BTreeMap<String, String> {
        let probes = self.arms.first().and_then(|arm| arm.case.get("probes")?.as_array());
        let text = |probe: &Value, key: &str| Some(probe.get(key)?.as_str()?.to_owned());
        let pair = |probe: &Value| text(probe, "name").zip(text(probe, "body"));
        probes.into_iter().flatten().filter_map(pair).collect()
    }

    /// Indices of the arms of the reference, the finest last: those of a computed reference, or at
    /// most three: the named arm after those arms that differ from it only in a longer step and a
    /// mesh that is no finer.
    fn reference_arms(&self) -> Vec<usize> {
        let is_named = |arm: &&Arm| self.reference.as_ref() == Some(&arm.name);
        let Some(named) = self.arms.iter().find(is_named) else { return Vec::new() };
        let size = |arm: &Arm| step(arm, "time.step").unwrap_or_default();
        let others = |arm: &Arm| -> BTreeSet<String> {
            arm.sets_without_step().filter(|set| !set.starts_with("refine=")).cloned().collect()
        };
        let is_level = |arm: &Arm| {
            if named.role.fine {
                return arm.role.fine && !arm.role.check;
            }
            let is_coarser = size(arm) > size(named) && arm.facts.refine <= named.facts.refine;
            let is_alike = !arm.role.fine && arm.case_path == named.case_path && others(arm) == others(named);
            arm.name == named.name || is_coarser && is_alike
        };
        let mut found: Vec<usize> = (0..self.arms.len()).filter(|i| is_level(&self.arms[*i])).collect();
        found.sort_by(|a, b| size(&self.arms[*b]).total_cmp(&size(&self.arms[*a])));
        let most = if named.role.fine { found.len() } else { 3 };
        found.split_off(found.len().saturating_sub(most))
    }

    /// Whether arms have rows between those of a run of the reference.
    fn interpolates(&self, finest: &Arm) -> bool {
        let row = |arm: &Arm| Some(history_every(arm) * step(arm, "time.step")?);
        let is_between = |arm: &Arm| {
            let rows = row(arm).zip(row(finest)).map(|(own, known)| own / known);
            rows.is_none_or(|rows| (rows - rows.round()).abs() > SAME * rows)
        };
        let has_phases = self.ensemble.as_ref().is_some_and(|ensemble| ensemble.phases > 1);
        has_phases || self.arms.iter().filter(|arm| !arm.role.fine).any(is_between)
    }

    /// The time to average over, if it is given; or else why there is none.
    fn window(&self, none: &str) -> Result<f64, Reason> {
        let end = self.arms.first().map_or(f64::INFINITY, |arm| arm.facts.end);
        let window = self.window.ok_or_else(|| Reason::from(none.to_owned()))?;
        if window < 0.5 * end {
            return Ok(window);
        }
        let why =
            format!("the `window` to average over, {window}, is not shorter than half of the runs, {end}");
        Err(why.into())
    }

    /// Quantities in which a run of the reference is compared.
    fn trajectory(&self, run: &Run, striker: Option<&str>) -> Trajectory {
        let metrics = metrics::of_run_beside(run, &self.overlays);
        Trajectory::of(run, &metrics).with_center_of(striker)
    }

    /// The reference that arms are compared with.
    ///
    /// # Errors
    /// Input/output or system error.
    pub(super) fn reference(&self, directory: &Path) -> Result<Option<Reference>, RecordError> {
        if self.reference.as_deref() == Some("exact") {
            let Some(facts) = self.arms.first().map(|arm| &arm.facts) else { return Ok(None) };
            let mut exact = Reference::of_formulas(&facts.exact, &facts.contacts, facts.end);
            exact.differs =
                self.arms.iter().any(|arm| arm.facts.exact != facts.exact || arm.facts.end != facts.end);
            let window = self.window("[exact] needs `window`, the time to average over");
            return Ok(Some(exact.grouped(&self.bodies_of_probes(), &window)));
        }
        let mut window = self.window("the reference has no contact");
        let arms = self.reference_arms();
        let mut levels = Vec::new();
        let mut averaged = Vec::new();
        // All runs are compared in one body: of two that are equally fast, round-off decides.
        let mut striker: Option<String> = None;
        for &i in &arms {
            let mut members = Vec::new();
            let mut phases = Vec::new();
            for run in self.runs_of(i) {
                let phase = self.run(run).role.member.map_or(0.0, |of| of.member.phase);
                if let Some(run) = self.finished(directory, self.run(run))? {
                    striker = striker.or_else(|| metrics::striker(&run).map(str::to_owned));
                    if members.is_empty() && Some(&i) == arms.last() {
                        averaged = metrics::of_averages(&run, self.window);
                        if self.window.is_none() {
                            window = metrics::window(&run.history);
                        }
                    }
                    members.push(self.trajectory(&run, striker.as_deref()));
                    if !phases.contains(&phase) {
                        phases.push(phase);
                    }
                } else if run == i {
                    return Ok(None);
                }
            }
            let arm = &self.arms[i];
            let step = step(arm, "time.step").unwrap_or_default();
            levels.push(Level { step, mesh: arm.facts.refine, phases: phases.len(), members });
        }
        let Some(last) = arms.last() else { return Ok(None) };
        let mut checks = Vec::new();
        for arm in self.arms.iter().filter(|arm| arm.role.check) {
            let Some(run) = self.finished(directory, arm)? else { return Ok(None) };
            checks.push(self.trajectory(&run, striker.as_deref()));
        }
        let mut reference = Reference::of_levels(String::new(), levels);
        reference.runs.checks = checks;
        reference.runs.is_interpolated = self.interpolates(&self.arms[*last]);
        reference.averaged = averaged;
        let mut reference = reference.grouped(&self.bodies_of_probes(), &window);
        let count = match arms.len() {
            1 => "a single run, whose error is not known".to_owned(),
            n if reference.refines_mesh() => format!("the finest of {n} levels of step and mesh"),
            n => format!("the finest of {n} steps on the given mesh"),
        };
        let members = || reference.runs.all.iter().map(|level| level.members.len());
        let ensemble = match (members().min().unwrap_or(1), members().max().unwrap_or(1)) {
            (1, 1) => String::new(),
            (least, most) if least == most => format!(", {most} members each"),
            (least, most) => format!(", {least} to {most} members each"),
        };
        let law = begins(&self.arms[*last]);
        reference.what = format!("\"{}\", {count}{ensemble}{law}", self.arms[*last].name);
        Ok(Some(reference))
    }
}
