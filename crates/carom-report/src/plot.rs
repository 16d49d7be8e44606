//! Plots in panels. [`crate::tables`] writes the table beside each of them.
//!
//! Axes are linear or logarithmic; values that are not positive are omitted on a logarithmic axis.
//! Curves with the same label have the same style in all panels and one entry in the common legend.

use crate::axis::range;

mod curve;
mod direct;
mod draw;
mod frame;
mod layout;
mod legend;
mod scale;

pub(crate) use curve::{APART, COLORS, Curve, style};

/// A grey band behind the curves.
#[derive(Clone, Debug)]
pub(crate) struct Band {
    /// What it is, in tables.
    pub(crate) name: &'static str,
    pub(crate) x: Vec<f64>,
    pub(crate) low: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

/// One panel: axes and curves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pane {
    /// Name in tables, where it is not the title; no two panes of a figure have the same.
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) y_label: String,
    pub(crate) curves: Vec<Curve>,
    pub(crate) band: Option<Band>,
    /// Vertical lines with labels.
    pub(crate) marks: Vec<(f64, String)>,
    /// A horizontal line with a label.
    pub(crate) floor: Option<(f64, String)>,
    /// Range of the vertical axis, where it is not that of the curves.
    pub(crate) limits: Option<(f64, f64)>,
    /// The same of the horizontal axis.
    pub(crate) span: Option<(f64, f64)>,
    /// Points of the Pareto front, from left to right.
    pub(crate) front: Vec<(f64, f64)>,
}

/// A figure.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plot {
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) x_label: String,
    pub(crate) log: [bool; 2],
    /// Number of panes side by side.
    pub(crate) across: usize,
    /// Whether all panes share one vertical axis.
    pub(crate) same: bool,
    /// Whether labels stand beside the curves, instead of a legend below.
    pub(crate) direct: bool,
    /// Title of the figures that it is folded away with on the page; empty: it stands by itself.
    pub(crate) group: String,
    pub(crate) panes: Vec<Pane>,
}

impl Pane {
    /// Its name in tables.
    pub(crate) fn name(&self) -> &str {
        if self.name.is_empty() { &self.title } else { &self.name }
    }

    /// The curves that set the axes: those of unsound runs do only where there is no other.
    fn setting_axes(&self) -> impl Iterator<Item = &Curve> {
        let all_apart = self.curves.iter().all(|curve| curve.apart);
        self.curves.iter().filter(move |curve| all_apart || !curve.apart)
    }
}

impl Plot {
    fn shown<'a>(&self, values: impl Iterator<Item = &'a f64>, axis: usize) -> (f64, f64) {
        let log = self.log[axis];
        range(values.filter(|x| !log || **x > 0.0))
    }

    /// Panes share the horizontal axis, except those with a span of their own.
    fn x_range(&self, pane: &Pane) -> (f64, f64) {
        let all = self.panes.iter().filter(|pane| pane.span.is_none()).flat_map(Pane::setting_axes);
        pane.span.unwrap_or_else(|| self.shown(all.flat_map(|c| &c.x), 0))
    }

    fn y_range(&self, pane: &Pane) -> (f64, f64) {
        let of = |pane: &Pane| {
            let (from, to) = pane.span.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
            let within = |(x, _): &(&f64, &f64)| (from..=to).contains(*x);
            // The middle of the band only: where the reference is most uncertain, its edges would
            // compress the curves.
            let middle = |Band { x, low, high, .. }: &Band| {
                let middle: Vec<f64> = low.iter().zip(high).map(|(low, high)| 0.5 * (low + high)).collect();
                x.iter().zip(&middle).filter(within).map(|(_, y)| *y).collect::<Vec<_>>()
            };
            let middle: Vec<f64> = pane.band.iter().flat_map(middle).collect();
            let floor = pane.floor.as_ref().map(|f| f.0);
            let curves = pane.setting_axes().flat_map(|c| c.x.iter().zip(&c.y)).filter(within).map(|p| p.1);
            pane.limits.unwrap_or_else(|| self.shown(curves.chain(&middle).chain(&floor), 1))
        };
        if !self.same {
            return of(pane);
        }
        // Panes with unsound runs alone do not set the common axis, unless there are no others.
        let sets = |pane: &&Pane| pane.curves.iter().any(|curve| !curve.apart && !curve.points);
        let any = self.panes.iter().any(|pane| sets(&pane));
        self.panes
            .iter()
            .filter(|pane| !any || sets(pane))
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    /// Where the band of a pane is drawn: not where it is higher than the axis.
    pub(crate) fn shown_band(&self, pane: &Pane) -> Vec<bool> {
        let (from, to) = self.y_range(pane);
        let inside = |Band { low, high, .. }: &Band| {
            low.iter().zip(high).map(|(low, high)| high - low <= to - from).collect()
        };
        pane.band.as_ref().map_or_else(Vec::new, inside)
    }

    /// Whether an arrowhead stands for something outside the axes.
    pub(crate) fn has_arrowheads(&self) -> bool {
        self.svg().contains(curve::OUTSIDE)
    }

    /// A curve of each distinct label.
    pub(crate) fn legend(&self) -> Vec<&Curve> {
        let mut found: Vec<&Curve> = Vec::new();
        for curve in self.panes.iter().flat_map(|p| &p.curves).filter(|c| !c.label.is_empty() && !c.unlisted)
        {
            if !found.iter().any(|known| known.label == curve.label) {
                found.push(curve);
            }
        }
        found
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn plot() -> Plot {
        let curve = Curve {
            label: "Hu, \"a\"".into(),
            style: 9,
            x: vec![1e-3, 1e-2],
            y: vec![0.0, 2e-4],
            marked: true,
            ..Curve::default()
        };
        Plot {
            name: "error-cost".into(),
            x_label: "time t_{c} (s)".into(),
            log: [true, true],
            across: 2,
            panes: vec![Pane {
                title: "one".into(),
                y_label: "E".into(),
                curves: vec![curve],
                ..Pane::default()
            }],
            ..Plot::default()
        }
    }

    #[test]
    fn a_logarithmic_axis_omits_values_that_are_not_positive() {
        let svg = plot().svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        // One marker in the pane, one in the legend.
        assert_eq!(svg.matches("z\" fill=").count(), 2);
    }

    #[test]
    fn the_ring_is_around_one_point() {
        let mut plot = plot();
        plot.log = [false, false];
        let curve = &mut plot.panes[0].curves[0];
        (curve.chosen, curve.ring) = (true, Some(1));
        assert_eq!(plot.svg().matches("r=\"8\"").count(), 1);
    }

    #[test]
    fn forty_styles_differ() {
        assert_eq!((0..40).map(style).collect::<std::collections::HashSet<_>>().len(), 40);
    }

    #[test]
    fn an_unsound_run_is_grey_and_does_not_set_the_axes() {
        let mut plot = plot();
        plot.log = [false, false];
        let curve = |label: &str, apart: bool, high: f64| Curve {
            label: label.into(),
            style: 0,
            x: vec![0.0, 1.0],
            y: vec![0.0, high],
            apart,
            ..Curve::default()
        };
        let with = |plot: &Plot, curves: Vec<Curve>| {
            let panes = vec![Pane { curves, ..plot.panes[0].clone() }];
            Plot { panes, ..plot.clone() }
        };
        let fails = curve("fails", true, 50.0);
        let both = with(&plot, vec![curve("finishes", false, 1.0), fails.clone()]);
        assert_eq!((both.y_range(&both.panes[0]), both.legend().len()), ((0.0, 1.0), 2));
        assert!(both.svg().contains(&format!("stroke=\"{APART}\"")));
        let alone = with(&plot, vec![fails]);
        assert_eq!(alone.y_range(&alone.panes[0]), (0.0, 50.0));
    }

    /// An unsound curve that ends inside the axes has a cross; one that goes on above has none.
    #[test]
    fn a_cross_is_where_a_run_stops() {
        let mut plot = plot();
        (plot.log, plot.direct) = ([false, false], true);
        let curve = |label: &str, apart: bool, x: &[f64], y: &[f64]| Curve {
            label: label.into(),
            x: x.to_vec(),
            y: y.to_vec(),
            apart,
            ..Curve::default()
        };
        let sound = curve("sound", false, &[0.0, 10.0], &[0.0, 1.0]);
        let stops = curve("stops", true, &[0.0, 5.0], &[0.0, 0.5]);
        let leaves = curve("leaves", true, &[0.0, 5.0, 10.0], &[0.0, 0.5, 99.0]);
        for (unsound, crosses) in [(stops, 1), (leaves, 0)] {
            plot.panes[0].curves = vec![sound.clone(), unsound];
            assert_eq!(plot.svg().matches("l6 6m0 -6l-6 6").count(), crosses);
        }
    }

    /// The narrow picture has the lines of the broad one, and a legend in place of labels.
    #[test]
    fn the_narrow_picture_shows_the_lines_of_the_broad_one_again() {
        let mut plot = plot();
        (plot.log, plot.direct, plot.across) = ([false, false], true, 1);
        plot.panes[0].curves[0].marked = false;
        let (broad, narrow) = (plot.svg(), plot.narrow());
        assert!(
            broad.contains("<g id=\"error-cost-0-lines\"") && narrow.contains("href=\"#error-cost-0-lines\"")
        );
        assert!(narrow.starts_with("<svg class=\"chart\"") && narrow.contains("width=\"440\""), "{narrow}");
        // Frame, ticks and the piece of line of the legend; no curve.
        assert!(!narrow.contains("stroke-linejoin=\"round\"") && narrow.contains(">Hu, "), "{narrow}");
    }

    /// Three panes of a row, of which the first has the title of the vertical axis, are two of a
    /// row of the narrow picture and one of the next, whose first has it, too.
    #[test]
    fn the_title_of_a_row_moves_with_its_panes() {
        let mut plot = plot();
        (plot.across, plot.same) = (3, true);
        let pane = Pane { y_label: String::new(), ..plot.panes[0].clone() };
        plot.panes.extend([pane.clone(), pane]);
        let titles = |svg: &str| svg.matches("rotate(-90)").count();
        assert_eq!([titles(&plot.svg()), titles(&plot.narrow())], [1, 2]);
    }

    /// A point outside the axes is an arrowhead at the edge, and nothing lies outside the figure.
    #[test]
    fn points_outside_the_axes_are_at_their_edge() {
        let mut plot = plot();
        plot.log = [false, false];
        let apart = Curve { apart: true, x: vec![9.0], y: vec![1e-4], ..plot.panes[0].curves[0].clone() };
        plot.panes[0].curves.push(apart);
        let svg = plot.svg();
        let tips = svg.lines().filter(|line| line.contains(&format!("z\" fill=\"{APART}\"")));
        let tips: Vec<f64> = tips.filter_map(|line| line.split(['M', ' ']).nth(2)?.parse().ok()).collect();
        assert!(plot.has_arrowheads() && !self::plot().has_arrowheads());
        assert!(!tips.is_empty() && tips.iter().all(|x| (0.0..=720.0).contains(x)), "{tips:?} {svg}");
    }
}
