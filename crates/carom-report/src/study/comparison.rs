//! The figure that compares time integrators by a point for every arm: error against cost.

use carom_record::Status;
use carom_record::study::{Row, Study};

use crate::ordered::grouped;
use crate::plot::{COLORS, Curve, Drawn, Pane, Plot};
use crate::text::said_if;

/// Errors that are drawn as this one if they are smaller: one method that conserves energy up to
/// round-off would compress all others.
const SMALL: f64 = 1e-6;

/// The figures of a study with a goal; none for a study without.
pub(super) fn plots(study: &Study) -> Vec<Plot> {
    if study.manifest.goal.is_none() {
        return Vec::new();
    }
    error_cost(study).into_iter().collect()
}

/// The style of an arm in all figures: that of its method, where there are methods.
pub(super) fn style_of(study: &Study, arm: usize) -> usize {
    let method = study.manifest.arms.get(arm).and_then(|arm| arm.role.method.as_deref());
    let known = method.and_then(|method| study.manifest.methods().iter().position(|name| *name == method));
    known.unwrap_or(arm % (5 * COLORS))
}

/// Methods with their finished arms, the coarsest first, without the arms of the reference.
pub(super) fn methods(study: &Study) -> Vec<(&str, Vec<usize>)> {
    let finished = |(i, row): (usize, &Row)| {
        let arm = &study.manifest.arms[i];
        let reference = arm.role.fine || study.manifest.reference.as_ref() == Some(&arm.name);
        (!reference && row.status == Some(Status::Finished)).then_some((arm.method(), i))
    };
    grouped(study.rows.iter().enumerate().filter_map(finished))
}

/// An arm with its point.
type Point = (usize, (f64, f64));

/// A figure with one curve with markers per method, through the points of its arms, and another one
/// of the arms that created much energy; the Pareto front; and the recommended arm.
fn scatter(
    study: &Study,
    plot: Plot,
    y_label: &str,
    point: impl Fn(usize) -> Option<(f64, f64)>,
    interval: impl Fn(usize) -> Option<[f64; 2]>,
) -> Option<Plot> {
    let shown = |arm: &usize| Some((*arm, point(*arm).filter(|p| p.0 > 0.0 && p.1 > 0.0)?));
    let chosen = study.recommended();
    let mut curves = Vec::new();
    let mut sound_points = Vec::new();
    for (name, arms) in methods(study) {
        let style = arms.first().map_or(0, |arm| style_of(study, *arm));
        let (unsound, sound): (Vec<usize>, Vec<usize>) =
            arms.into_iter().partition(|arm| study.rows[*arm].is_unsound());
        for (arms, apart) in [(sound, false), (unsound, true)] {
            let points: Vec<Point> = arms.iter().filter_map(shown).collect();
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|(_, point)| *point).unzip();
            let intervals = points.iter().filter_map(|(arm, _)| interval(*arm)).collect();
            let ring = points.iter().position(|(arm, _)| !apart && chosen == Some(*arm));
            let label = if apart { format!("{name}, creates energy") } else { name.to_owned() };
            if !apart {
                sound_points.extend(points);
            }
            if !x.is_empty() {
                let drawn = Drawn::Marked;
                let chosen = ring.is_some();
                curves.push(Curve {
                    label,
                    style,
                    x,
                    y,
                    intervals,
                    drawn,
                    apart,
                    chosen,
                    ring,
                    ..Curve::default()
                });
            }
        }
    }
    if curves.is_empty() {
        return None;
    }
    let front: Vec<(f64, f64)> = front(&sound_points).into_iter().map(|(_, point)| point).collect();
    let is_grey = curves.iter().any(|curve| curve.apart);
    let marks = [
        said_if(front.len() > 1, " Broad line: Pareto front."),
        said_if(curves.iter().any(|curve| curve.chosen), " Ring: recommended arm."),
        said_if(is_grey, " Grey: arms that created energy; they do not affect the axes."),
    ];
    let caption = format!("{} One point per arm, one curve per method.{}", plot.caption, marks.concat());
    let pane = Pane {
        curves,
        front,
        y_label: y_label.to_owned(),
        ..plot.panes.into_iter().next().unwrap_or_default()
    };
    Some(Plot { caption, log: [true, true], across: 1, panes: vec![pane], ..plot })
}

/// The points that no other one surpasses, from left to right; of equal points, all.
fn front(points: &[Point]) -> Vec<Point> {
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

/// Error against cost, as ranked.
fn error_cost(study: &Study) -> Option<Plot> {
    let ranking = study.ranking.as_ref()?;
    let measure = ranking.measure.as_ref().ok()?;
    let floor = Some((measure.uncertainty, "uncertainty of the errors".to_owned()));
    let plot = Plot {
        name: "error-cost".into(),
        caption: format!(
            "Work and precision: error ({}) with its interval against the counted cost, in evaluations of the internal forces.",
            ranking.goal.word()
        ),
        x_label: "counted cost".into(),
        panes: vec![Pane { floor: floor.filter(|(least, _)| *least > SMALL), ..Pane::default() }],
        ..Plot::default()
    };
    let ranked = |arm: usize| ranking.levels.iter().flatten().find(|ranked| ranked.arm == arm);
    let point = |arm: usize| Some((ranked(arm)?.cost, ranked(arm)?.error.max(SMALL)));
    scatter(study, plot, "relative error", point, |arm| Some(ranked(arm)?.interval))
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
