//! Figures that compare time integrators by a point for every arm: error against cost, and
//! roughness against dissipation.

use carom_record::Status;
use carom_record::study::compared::{established, is_trajectory};
use carom_record::study::design::Goal;
use carom_record::study::ranking::standing;
use carom_record::study::{Row, Study};

use crate::ordered::grouped;
use crate::plot::{COLORS, Curve, Pane, Plot};
use crate::text::said_if;

/// The figures of a study with a goal; none for a study without.
pub(crate) fn plots(study: &Study) -> Vec<Plot> {
    if study.manifest.goal.is_none() {
        return Vec::new();
    }
    [error_cost(study), roughness_dissipation(study)].into_iter().flatten().collect()
}

/// The style of an arm in all figures: that of its method, where there are methods.
pub(crate) fn style_of(study: &Study, arm: usize) -> usize {
    let method = study.manifest.arms.get(arm).and_then(|arm| arm.role.method.as_deref());
    let known = method.and_then(|method| study.manifest.methods().iter().position(|name| *name == method));
    // In figures of equally many arms, each has the colours of the others.
    let is_grid = study.manifest.arms.iter().all(|arm| !arm.role.fine && arm.case_path.is_none());
    known.unwrap_or_else(|| arm % if is_grid { each(study.rows.len()) } else { COLORS })
}

/// Curves in one figure; more arms need more figures.
const MOST: usize = 8;

/// The number of arms in a figure: the largest that divides them evenly, as nine of a sweep of
/// three by three; else eleven are six and five, not eight and three.
pub(crate) fn each(arms: usize) -> usize {
    let least = arms.div_ceil(arms.div_ceil(MOST).max(1)).max(1);
    (least.div_ceil(2)..=least).rev().find(|each| arms.is_multiple_of(*each)).unwrap_or(least)
}

/// Methods with their finished arms, the coarsest first, without the arms of the reference.
pub(crate) fn methods(study: &Study) -> Vec<(&str, Vec<usize>)> {
    let finished = |(i, row): (usize, &Row)| {
        let arm = &study.manifest.arms[i];
        let reference = arm.role.fine || study.manifest.reference.as_ref() == Some(&arm.name);
        (!reference && row.status == Some(Status::Finished)).then_some((arm.method(), i))
    };
    grouped(study.rows.iter().enumerate().filter_map(finished))
}

/// Up to this number of methods all have broad lines; of more, only those that matter.
const BROAD: usize = 7;

/// A pane with one curve with markers per method, through the points of its arms, and another one
/// of the arms that created much energy; the Pareto front; and the recommended arm.
fn scatter(study: &Study, point: impl Fn(usize) -> Option<(f64, f64)>) -> Pane {
    let shown = |arm: &usize| Some((*arm, point(*arm).filter(|p| p.0 > 0.0 && p.1 > 0.0)?));
    let methods = methods(study);
    let points: Vec<(usize, (f64, f64))> = methods
        .iter()
        .flat_map(|(_, arms)| arms)
        .filter(|arm| !study.rows[**arm].is_unsound())
        .filter_map(shown)
        .collect();
    let front = front(&points);
    let chosen = study.recommended();
    let few = methods.len() <= BROAD;
    let mut curves = Vec::new();
    for (name, arms) in methods {
        let style = arms.first().map_or(0, |arm| style_of(study, *arm));
        let matters = arms.iter().any(|arm| chosen == Some(*arm) || front.iter().any(|(on, _)| on == arm));
        let (unsound, sound): (Vec<usize>, Vec<usize>) =
            arms.into_iter().partition(|arm| study.rows[*arm].is_unsound());
        let quiet = !few && !matters;
        for (arms, apart) in [(sound, false), (unsound, true)] {
            let is_chosen = |arm: &usize| !apart && chosen == Some(*arm);
            let points: Vec<(usize, (f64, f64))> = arms.iter().filter_map(shown).collect();
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|(_, point)| *point).unzip();
            let label = if apart { format!("{name}, creates energy") } else { name.to_owned() };
            if !x.is_empty() {
                curves.push(Curve {
                    label,
                    style,
                    x,
                    y,
                    marked: true,
                    apart,
                    quiet,
                    chosen: arms.iter().any(is_chosen),
                    ring: points.iter().position(|(arm, _)| is_chosen(arm)),
                    ..Curve::default()
                });
            }
        }
    }
    Pane { curves, front: front.into_iter().map(|(_, point)| point).collect(), ..Pane::default() }
}

/// The points that no other one surpasses, from left to right; of equal points, all.
fn front(points: &[(usize, (f64, f64))]) -> Vec<(usize, (f64, f64))> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.1.0.total_cmp(&b.1.0).then(a.1.1.total_cmp(&b.1.1)));
    let mut last = (f64::NEG_INFINITY, f64::INFINITY);
    sorted.retain(|(_, point)| {
        let on = point.1 < last.1 || *point == last;
        if on {
            last = *point;
        }
        on
    });
    sorted
}

/// The figure of some panes, whose caption begins with what is compared, and ends with what is said
/// of it and of grey curves; none without panes.
fn figure((name, x_label): (&str, &str), panes: Vec<Pane>, (compared, said): (&str, String)) -> Option<Plot> {
    let any = |is: fn(&Curve) -> bool| panes.iter().flat_map(|pane| &pane.curves).any(is);
    let marks = [
        said_if(panes.iter().any(|pane| pane.front.len() > 1), " Broad line: Pareto front."),
        said_if(any(|curve| curve.ring.is_some()), " Ring: recommended arm."),
        said_if(any(|curve| curve.quiet), " Thin: methods that are neither on the front nor recommended."),
    ];
    let (marks, is_grey) = (marks.concat(), any(|curve| curve.apart));
    let mut plot = Plot {
        name: name.into(),
        caption: format!("{compared}: one point per arm, one curve per method.{marks} {said}"),
        x_label: x_label.into(),
        log: [true, true],
        across: 1,
        direct: true,
        panes,
        ..Plot::default()
    };
    if is_grey {
        let outside = ", and an arrowhead at the edge stands for one that lies outside";
        let outside = said_if(plot.has_arrowheads(), outside);
        plot.caption += " Grey: arms that created more energy than the default guard allows; they do not affect \
             the axes";
        plot.caption += outside;
        plot.caption += ".";
    }
    (!plot.panes.is_empty()).then_some(plot)
}

/// What is said of arms with a zero where one has no point in a logarithmic pane for it.
fn omitted(points: impl IntoIterator<Item = Option<(f64, f64)>>) -> &'static str {
    let is_omitted = points.into_iter().flatten().any(|(x, y)| x == 0.0 || y == 0.0);
    said_if(is_omitted, " Arms with a zero are omitted (logarithmic axes).")
}

/// Error of an arm in the ranking.
fn ranked(study: &Study, arm: usize) -> Option<f64> {
    let ranking = study.ranking.as_ref()?;
    ranking.levels.iter().flatten().find(|r| r.arm == arm).map(|r| r.error)
}

fn error_cost(study: &Study) -> Option<Plot> {
    let ranking = study.ranking.as_ref()?;
    let cost = |arm: usize| study.rows[arm].value("cpu_time");
    let mut panes = Vec::new();
    let mut points = Vec::new();
    let arms: Vec<usize> = methods(study).into_iter().flat_map(|(_, arms)| arms).collect();
    if let Some(reference) = &study.reference {
        let columns = established(reference, is_trajectory);
        let error = |arm: usize| Some((cost(arm)?, study.compared.get(arm)?.as_ref()?.mean(&columns)?));
        let pane = scatter(study, error);
        points.extend(arms.iter().map(|arm| error(*arm)));
        let squares =
            columns.iter().filter_map(|c| reference.uncertainty(c).established()).map(|u| u.1 * u.1);
        let uncertainty = (squares.sum::<f64>() / columns.len().max(1) as f64).sqrt();
        let floor = (uncertainty > 0.0).then(|| (uncertainty, "uncertainty of the errors".to_owned()));
        let (title, y_label) = ("displacements".into(), "deviation / range".into());
        panes.push(Pane { title, y_label, floor, ..pane });
    }
    if let Ok(measure) = &ranking.measure
        && !matches!(ranking.goal, Goal::Trajectory | Goal::Cost)
    {
        let error = |arm: usize| Some((cost(arm)?, ranked(study, arm)?));
        let pane = scatter(study, error);
        points.extend(arms.iter().map(|arm| error(*arm)));
        let floor = (measure.uncertainty > 0.0)
            .then(|| (measure.uncertainty, "uncertainty of the errors".to_owned()));
        let title = format!("goal: {}", measure.name.replace('_', " "));
        panes.push(Pane { floor, title, y_label: "relative error".into(), ..pane });
    }
    panes.retain(|p| !p.curves.is_empty());
    let omitted = omitted(points);
    let said = format!("Cost: processor time of the time steps without output.{omitted}");
    figure(("error-cost", "processor time (s)"), panes, ("Error against cost", said))
}

/// Smaller drifts of the energy are drawn as this one.
const LEAST_DRIFT: f64 = 1e-6;

fn roughness_dissipation(study: &Study) -> Option<Plot> {
    // One method that conserves energy up to round-off would compress all others.
    let lost = |arm: usize| Some(study.rows[arm].value("energy_drift")?.max(LEAST_DRIFT));
    let right = standing(study.reference.as_ref(), "force_variation").established();
    let right = right.map(|v| v.0).filter(|v| *v > 0.0);
    let variation = |arm: usize| {
        let value = study.rows[arm].value("force_variation")?;
        // Without an established reference the scale is twice the peak mean force: one rise and one
        // fall.
        Some(value / right.or_else(|| Some(2.0 * study.rows[arm].value("peak_mean_force")?))?)
    };
    let high = |arm: usize| study.rows[arm].value("force_high_frequency");
    let over = if right.is_some() { "TV / TV of the reference" } else { "TV / (2 × peak mean force)" };
    let of_variation = |arm: usize| Some((lost(arm)?, variation(arm)?));
    let of_power = |arm: usize| Some((lost(arm)?, high(arm)?));
    let arms = methods(study).into_iter().flat_map(|(_, arms)| arms);
    let omitted = omitted(arms.flat_map(|arm| [of_variation(arm), of_power(arm)]));
    let varied = scatter(study, of_variation);
    let high = scatter(study, of_power);
    let titled =
        |title: &str, y_label: &str, pane| Pane { title: title.into(), y_label: y_label.into(), ..pane };
    let mut panes = vec![
        titled("total variation of the contact force", over, varied),
        titled("power above 16 cycles per contact", "share of power", high),
    ];
    // A pane of a few methods compares nothing.
    let all = methods(study).len();
    let known = |pane: &Pane| {
        let sound: Vec<_> = pane.curves.iter().filter(|curve| !curve.apart).collect();
        !sound.is_empty() && 2 * sound.len() >= all
    };
    let count = panes.len();
    panes.retain(known);
    let left_out =
        said_if(panes.len() < count, " A measure that fewer than half of the methods have is not drawn.");
    let conserving = study.rows.iter().any(|row| row.value("energy_drift").is_some_and(|d| d < LEAST_DRIFT));
    let least = said_if(conserving, " A drift below 10^{−6} is drawn there.");
    let said = format!(
        "Numerical damping reduces roughness at the cost of energy; methods at the lower left are smooth \
         without loss of energy. TV: total variation during the first contact.{omitted}{least}{left_out}"
    );
    figure(
        ("roughness-dissipation", "energy drift / largest energy"),
        panes,
        ("Roughness of the contact force against energy drift", said),
    )
}

#[cfg(test)]
mod tests {
    use super::front;

    /// By hand: (2, 2) is surpassed by (1, 1); (3, 0.5) is cheaper than (4, 0.5).
    #[test]
    fn the_front_is_not_surpassed() {
        let points = [(0, (2.0, 2.0)), (1, (1.0, 1.0)), (2, (4.0, 0.5)), (3, (3.0, 0.5)), (4, (9.0, 0.1))];
        assert_eq!(front(&points).iter().map(|point| point.0).collect::<Vec<_>>(), [1, 3, 4]);
        // Equal points are both on it; one that is as good in one coordinate only is not.
        let ties = [(0, (1.0, 2.0)), (1, (1.0, 2.0)), (2, (1.0, 3.0)), (3, (2.0, 2.0)), (4, (2.0, 1.0))];
        assert_eq!(front(&ties).iter().map(|point| point.0).collect::<Vec<_>>(), [0, 1, 4]);
    }
}
