//! The figure that compares time integrators by a point for every arm: error against cost.

use carom_record::Status;
use carom_record::study::ranking::Ranked;
use carom_record::study::{Row, Study};

use crate::ordered::grouped;
use crate::plot::{COLORS, Curve, Drawn, Pane, Plot};
use crate::text::said_if;

/// Errors that are drawn as this one if they are smaller: round-off has no place on an axis of
/// logarithms.
const SMALL: f64 = 1e-12;
/// An uncertainty that is shown.
const SMALL_UNCERTAINTY: f64 = 1e-6;

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

/// The points that no other one surpasses, from left to right; of equal points, all.
fn front(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut last = (f64::NEG_INFINITY, f64::INFINITY);
    sorted.retain(|point| {
        let on = point.1 < last.1 || *point == last;
        if on {
            last = *point;
        }
        on
    });
    sorted
}

/// Error against cost, as ranked: one curve with markers per method, through the points of its
/// ranked arms; the Pareto front; and the recommended arm. None for a study without a goal.
pub(super) fn plot(study: &Study) -> Option<Plot> {
    let ranking = study.ranking.as_ref()?;
    let uncertainty = ranking.measure.as_ref().ok()?.uncertainty;
    let ranked = |arm: &usize| ranking.levels.iter().flatten().find(|ranked| ranked.arm == *arm);
    let chosen = study.recommended();
    let mut curves = Vec::new();
    let mut all_points = Vec::new();
    for (name, arms) in methods(study) {
        let style = arms.first().map_or(0, |arm| style_of(study, *arm));
        let of_method: Vec<&Ranked> =
            arms.iter().filter_map(ranked).filter(|ranked| ranked.cost > 0.0).collect();
        if of_method.is_empty() {
            continue;
        }
        let points: Vec<(f64, f64)> = of_method.iter().map(|r| (r.cost, r.error.max(SMALL))).collect();
        let (x, y) = points.iter().copied().unzip();
        let ring = of_method.iter().position(|ranked| chosen == Some(ranked.arm));
        all_points.extend(points);
        curves.push(Curve {
            label: name.to_owned(),
            style,
            x,
            y,
            intervals: of_method.iter().map(|ranked| ranked.interval).collect(),
            drawn: Drawn::Marked,
            chosen: ring.is_some(),
            ring,
            ..Curve::default()
        });
    }
    if curves.is_empty() {
        return None;
    }
    let front = front(&all_points);
    let marks = [
        said_if(front.len() > 1, " Broad line: Pareto front."),
        said_if(curves.iter().any(|curve| curve.chosen), " Ring: recommended arm."),
    ];
    let pane = Pane {
        curves,
        front,
        y_label: "relative error".into(),
        floor: (uncertainty > SMALL_UNCERTAINTY)
            .then(|| (uncertainty, "uncertainty of the errors".to_owned())),
        ..Pane::default()
    };
    Some(Plot {
        name: "error-cost".into(),
        caption: format!(
            "Work and precision: error ({}) with its interval against the counted cost, in evaluations of the internal \
             forces. One point per arm, one curve per method.{}",
            ranking.goal.word(),
            marks.concat()
        ),
        x_label: "counted cost".into(),
        log: [true, true],
        across: 1,
        panes: vec![pane],
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::front;

    /// By hand: (2, 2) is surpassed by (1, 1); (3, 0.5) is cheaper than (4, 0.5).
    #[test]
    fn the_front_is_not_surpassed() {
        let points = [(2.0, 2.0), (1.0, 1.0), (4.0, 0.5), (3.0, 0.5), (9.0, 0.1)];
        assert_eq!(front(&points), [points[1], points[3], points[4]]);
        // Equal points are both on it; one that is as good in one coordinate only is not.
        let ties = [(1.0, 2.0), (1.0, 2.0), (1.0, 3.0), (2.0, 2.0), (2.0, 1.0)];
        assert_eq!(front(&ties), [ties[0], ties[1], ties[4]]);
    }
}
