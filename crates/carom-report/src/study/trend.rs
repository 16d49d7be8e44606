//! Trends of a sweep: metrics against every key whose numbers differ between arms, each with a
//! fitted line and its 95 % confidence interval. Metrics and keys that are positive and span a
//! factor of three are fitted as a power. Arms that failed or created energy are left out.

use carom_record::metrics::Metric;
use carom_record::study::{Refinement, Study, count, refined_keys, scalar};
use maud::{Markup, html};

use super::collected::{cells_of, common_time, time_unit};
use super::curves::Keys;
use super::fit::Fit;
use super::settings::own_settings;
use crate::digits::three;
use crate::labels::{file_name, with_unit};
use crate::plot::{Band, Curve, Drawn, Pane, Plot};
use crate::text::{Label, said_if};

/// Fewest values of a key.
const LEAST: usize = 3;
/// Fewest values from which a line is fitted: through three, the interval of its slope is twelve
/// times the standard error.
const FITTED: usize = 4;
/// Panes of a figure.
const MOST: usize = 9;
/// Factor between the largest and the smallest number from which logarithms are used.
const WIDE: f64 = 3.0;
/// Metrics that are shown first, where they exist.
const FIRST: [&str; 7] = [
    "overlay_rms",
    "restitution",
    "contact_duration",
    "impulse_y",
    "impulse_x",
    "peak_mean_force",
    "energy_lost",
];
/// Keys whose values are times.
const TIMES: [&str; 2] = ["time.end", "time.step"];

/// A key whose numbers differ between arms, and the metrics that vary against it.
struct Sweep<'a> {
    key: String,
    /// The unit of the key, where it is known.
    unit: &'a str,
    groups: Vec<Refinement>,
    /// Words for the groups.
    labels: Vec<String>,
    /// Metrics, those of [`FIRST`] first, each with its trends in the groups.
    metrics: Vec<(&'a Metric, Vec<Trend>)>,
}

/// A metric against a key in a group of arms.
struct Trend {
    x: Vec<f64>,
    y: Vec<f64>,
    fit: Option<Fit>,
    /// Whether the fit is of the logarithms of both.
    power: bool,
}

fn spans(values: &[f64]) -> bool {
    let (low, high) = crate::axis::range(values);
    low > 0.0 && high / low >= WIDE
}

/// Values of a key and of a metric in the sound arms of a group.
fn points(study: &Study, group: &Refinement, metric: &str) -> (Vec<f64>, Vec<f64>) {
    let value = |(arm, x): (&usize, &f64)| {
        let row = &study.rows[*arm];
        Some((*x, row.value(metric).filter(|y| y.is_finite() && !row.is_unsound())?))
    };
    group.arms.iter().zip(&group.steps).filter_map(value).unzip()
}

/// Whether values differ by round-off only.
pub(super) fn is_constant(values: &[f64]) -> bool {
    let (low, high) = crate::axis::range(values);
    high - low <= 1e-9 * high.abs().max(low.abs())
}

/// Whether a metric is an instant or a duration, which is a whole number of steps: against the step
/// it shows nothing else.
fn is_whole_steps(study: &Study, key: &str, metric: &Metric) -> bool {
    key == "time.step" && !metric.unit.is_empty() && metric.unit == time_unit(study)
}

/// The trends of a metric in groups of arms; none if it does not vary. It is fitted as a power of
/// the key if both span the factor in every group that can be fitted.
fn trends(study: &Study, groups: &[Refinement], metric: &str) -> Option<Vec<Trend>> {
    let points: Vec<_> = groups.iter().map(|group| points(study, group, metric)).collect();
    let count: usize = points.iter().map(|(x, _)| x.len()).sum();
    // What differs between groups only does not vary against the key.
    if count < LEAST || points.iter().all(|(_, y)| is_constant(y)) {
        return None;
    }
    let power = points.iter().filter(|(x, _)| x.len() >= FITTED).all(|(x, y)| spans(x) && spans(y));
    let log = |values: &[f64]| values.iter().map(|value| value.ln()).collect::<Vec<_>>();
    let trend = |(x, y): (Vec<f64>, Vec<f64>)| {
        let fit = match () {
            () if x.len() < FITTED || is_constant(&y) => None,
            () if power => Fit::of(&log(&x), &log(&y)),
            () => Fit::of(&x, &y),
        };
        Trend { x, y, fit, power }
    };
    Some(points.into_iter().map(trend).collect())
}

impl Trend {
    /// The fitted line and its interval at points that are equidistant on an axis.
    fn line(&self, log: bool) -> Option<(Vec<f64>, Band)> {
        let fit = self.fit?;
        let (low, high) = crate::axis::range(&self.x);
        let places = (0..=40).map(|k| f64::from(k) / 40.0);
        let x = places.map(|s| if log { low * (high / low).powf(s) } else { low + s * (high - low) });
        let x: Vec<f64> = x.collect();
        let edge = |sign: f64| {
            let at = |x: &f64| {
                let (value, half) = fit.at(if self.power { x.ln() } else { *x });
                let y = value + sign * half;
                if self.power { y.exp() } else { y }
            };
            x.iter().map(at).collect::<Vec<f64>>()
        };
        let band = Band { name: "95 % interval of the fit", low: edge(-1.0), high: edge(1.0), x: x.clone() };
        Some((edge(0.0), band))
    }

    /// The slope with its interval, in units of the metric per unit of the key.
    fn words(&self, metric: &str, key: &str) -> Option<String> {
        let fit = self.fit?;
        let slope = three(fit.slope);
        let interval = three(fit.uncertainty);
        // An interval of round-off says nothing.
        let interval = if fit.uncertainty < 1e-6 * fit.slope.abs() { "0" } else { &interval };
        if self.power {
            return Some(format!("exponent {slope} ±\u{a0}{interval}"));
        }
        let metric = if metric == "1" { "" } else { metric };
        let per = said_if(!key.is_empty(), " per ");
        let unit = format!("{metric}{per}{key}");
        // The unit stays in one line.
        let unit = unit.trim_start().replace(' ', "\u{a0}");
        Some(format!("slope {slope} ±\u{a0}{interval} {unit}").trim_end().to_owned())
    }
}

/// The place of a metric among those that are shown first.
pub(super) fn rank(name: &str) -> usize {
    let base = name.split_once(':').map_or(name, |(base, _)| base);
    FIRST.iter().position(|first| *first == base).unwrap_or(FIRST.len())
}

/// A sweep for every key.
fn sweeps(study: &Study) -> impl Iterator<Item = Sweep<'_>> {
    let keys = refined_keys(&study.manifest, LEAST, scalar);
    keys.into_iter().map(|(key, groups)| Sweep::of(study, key, groups))
}

/// A figure for every key.
pub(super) fn plots(study: &Study) -> Vec<Plot> {
    sweeps(study).filter_map(|sweep| sweep.plot(study)).collect()
}

impl<'a> Sweep<'a> {
    fn of(study: &'a Study, key: String, groups: Vec<Refinement>) -> Self {
        let mut metrics = study.metrics();
        metrics.retain(|metric| !metric.is_work() && !is_whole_steps(study, &key, metric));
        metrics.sort_by_key(|metric| rank(&metric.name));
        let with_trends = |metric: &'a Metric| Some((metric, trends(study, &groups, &metric.name)?));
        Self {
            metrics: metrics.into_iter().filter_map(with_trends).collect(),
            unit: if TIMES.contains(&key.as_str()) { time_unit(study) } else { "" },
            labels: labels(study, &groups),
            key,
            groups,
        }
    }

    /// The key, or the inverse of a count, against which metrics are shown.
    fn against(&self) -> String {
        let inverse = said_if(count(&self.key).is_some(), "1/");
        format!("{inverse}{}", self.key)
    }

    /// The label of the key with its unit: its last part, and its inverse for a count.
    fn axis(&self) -> String {
        match self.key.rsplit_once('.').map_or(self.key.as_str(), |(_, last)| last) {
            last if count(&self.key).is_some() => format!("1/{last}"),
            "mu" => "μ".to_owned(),
            "rho_inf" => "ρ_{∞}".to_owned(),
            last => with_unit(last, self.unit),
        }
    }

    /// A metric in all groups; `log`: whether the horizontal axis is logarithmic.
    fn pane(&self, metric: &Metric, trends: &[Trend], log: bool) -> Pane {
        let single = trends.len() == 1;
        // The title differs between panes only by numbers.
        let name = metric.name.clone().into_owned();
        let y_label = with_unit(&name.replace('_', " "), &metric.unit);
        let mut pane = Pane { name, y_label, ..Pane::default() };
        for (style, trend) in trends.iter().enumerate() {
            let label = if single { "arms" } else { &self.labels[style] };
            if single {
                pane.title = trend.words(&metric.unit, self.unit).unwrap_or_default();
            }
            if let Some((y, band)) = trend.line(log) {
                let label = format!("fit of {label}");
                let x = band.x.clone();
                pane.curves.push(Curve { label, style, x, y, unlisted: true, ..Curve::default() });
                pane.band = single.then_some(band);
            }
            pane.curves.push(Curve {
                label: label.to_owned(),
                style,
                x: trend.x.clone(),
                y: trend.y.clone(),
                drawn: Drawn::Markers,
                unlisted: single,
                ..Curve::default()
            });
        }
        pane
    }

    fn plot(&self, study: &Study) -> Option<Plot> {
        let all: Vec<f64> = self.groups.iter().flat_map(|group| group.steps.iter().copied()).collect();
        let wide = spans(&all);
        let shown = self.metrics.iter().take(MOST);
        let panes: Vec<Pane> = shown.map(|(metric, trends)| self.pane(metric, trends, wide)).collect();
        if panes.is_empty() {
            return None;
        }
        let which = match self.metrics.len() {
            count if count > MOST => format!("{MOST} of the {count} metrics that vary"),
            _ => "Metrics".to_owned(),
        };
        let is_fitted = panes.iter().flat_map(|pane| &pane.curves).any(|curve| curve.drawn == Drawn::Line);
        let lines =
            said_if(is_fitted, " Lines: least squares, through four values or more; the title says of what.");
        let is_banded = is_fitted && self.groups.len() == 1;
        let grey = said_if(is_banded, " Grey: 95 % confidence interval of the line.");
        let mut arms = self.groups.iter().flat_map(|group| &group.arms);
        let is_left_out = arms.any(|arm| study.rows[*arm].is_unsound());
        let left_out = said_if(is_left_out, " Arms that failed or created energy are left out.");
        let only = only(study, &self.groups).map_or_else(String::new, |arms| format!(" Arms: {arms}."));
        Some(Plot {
            name: format!("trend-{}", file_name(&self.key)),
            caption: format!("{which} against `{}`.{only}{lines}{grey}{left_out}", self.against()),
            x_label: self.axis(),
            log: [wide, false],
            across: 3,
            panes,
            ..Plot::default()
        })
    }
}

/// The arms of a single group, which has no legend, if the study has others.
fn only(study: &Study, groups: &[Refinement]) -> Option<String> {
    let [group] = groups else { return None };
    let others = (0..study.manifest.arms.len()).any(|arm| !group.arms.contains(&arm));
    let names = group.arms.iter().map(|arm| study.manifest.arms[*arm].name.as_str());
    others.then(|| names.collect::<Vec<_>>().join("; "))
}

/// The method of each group, if it is of one, or its settings without those that all of them have.
fn labels(study: &Study, groups: &[Refinement]) -> Vec<String> {
    // Runs of the reference may have the settings of a method.
    let method = |group: &Refinement| {
        let mut methods = group.arms.iter().filter_map(|arm| study.manifest.arms[*arm].role.method.clone());
        let first = methods.next().filter(|_| groups.len() > 1)?;
        methods.all(|other| other == first).then_some(first)
    };
    let settings = groups.iter().flat_map(|group| &group.common);
    let keys = Keys::of(settings.map(String::as_str), common_time(study));
    let is_shared = |set: &&str| {
        groups.len() > 1 && groups.iter().all(|group| group.common.iter().any(|other| other == *set))
    };
    let own = |group: &Refinement| {
        let mut own = own_settings(study, &group.common);
        own.retain(|set| !is_shared(set));
        keys.label(&own.join(", "))
    };
    groups.iter().map(|group| method(group).unwrap_or_else(|| own(group))).collect()
}

/// Slopes and exponents with their intervals.
pub(super) fn section(study: &Study) -> Markup {
    let mut sweeps: Vec<Sweep> = sweeps(study).collect();
    sweeps.retain(|sweep| sweep.groups.iter().any(|group| group.arms.len() >= FITTED));
    html! {
        @if !sweeps.is_empty() {
            @for sweep in &sweeps {
                details {
                    summary { "Slopes and exponents in " code { (sweep.against()) } }
                    table.metrics {
                        thead { tr { th { "Metric" } th { "Unit" } th { "Arms" } th { "Slope or exponent" } } }
                        @for (metric, trends) in &sweep.metrics {
                            @for (trend, label) in trends.iter().zip(&sweep.labels) {
                                @if let Some(words) = trend.words(&metric.unit, sweep.unit) {
                                    tr {
                                        (cells_of(metric)) td { (Label(label)) } td { (Label(&words)) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
            p.small {
                "Exponent: of the power of the key, or of the inverse of a count, where metric and key are positive and span a factor of three in all \
                 groups of arms; slope: of a straight line. With the 95 % interval of least squares."
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use carom_record::study::systems::Systems;
    use carom_record::study::{Arm, Row, StudyManifest, StudySource};
    use carom_record::{Machine, Status};

    /// A study of arms with these changes, and with values of metrics.
    pub(crate) fn study(arms: &[(&str, Vec<(&'static str, f64)>)]) -> Study {
        let arm = |(sets, _): &(&str, _)| Arm {
            name: (*sets).to_owned(),
            sets: sets.split(", ").map(str::to_owned).collect(),
            steps: 1,
            ..Arm::default()
        };
        let manifest = StudyManifest {
            status: Status::Finished,
            title: String::new(),
            version: String::new(),
            input_hash: String::new(),
            created: String::new(),
            machine: Machine::current(),
            reference: None,
            design: None,
            goal: None,
            accuracy: None,
            window: None,
            arms: arms.iter().map(arm).collect(),
            ensemble: None,
            members: Vec::new(),
            overlays: Vec::new(),
            claims: Vec::new(),
            expects: Vec::new(),
            source: StudySource::default(),
        };
        let metric = |(name, value): &(&'static str, f64)| Metric {
            name: (*name).into(),
            value: Some(*value),
            unit: if *name == "contact_duration" { "ms".into() } else { String::new() },
            definition: "",
        };
        let rows = arms.iter().map(|(name, metrics)| Row {
            name: (*name).to_owned(),
            status: Some(Status::Finished),
            reason: None,
            metrics: metrics.iter().map(metric).collect(),
            expectations: Vec::new(),
            contact: true,
            warnings: Vec::new(),
        });
        Study {
            systems: Systems::default(),
            directory: std::path::PathBuf::new(),
            rows: rows.collect(),
            manifest,
            members: Vec::new(),
            verdicts: Vec::new(),
            expectations: Vec::new(),
            reference: None,
            compared: Vec::new(),
            phase_orders: Vec::new(),
            ranking: None,
            other_rankings: Vec::new(),
            checks: None,
        }
    }

    fn names(plot: &Plot) -> Vec<&str> {
        plot.panes.iter().map(Pane::name).collect()
    }

    /// Two groups have no slope in a title, and two metrics may have the same one. A duration is a
    /// whole number of steps, and is not shown against the step.
    #[test]
    fn panes_are_named_by_metrics() {
        let arm = |x: f64| {
            let metrics = [("restitution", 1.0 - x), ("energy_lost", 2.0 - x), ("impulse_y", x * x)];
            metrics.into_iter().chain([("contact_duration", x)]).collect::<Vec<_>>()
        };
        let steps = [1.0, 2.0, 4.0, 8.0];
        let keys = ["time.step=1, a.b=0", "time.step=2, a.b=0", "time.step=4, a.b=0", "time.step=8, a.b=0"];
        let one: Vec<_> = keys.iter().zip(steps).map(|(key, x)| (*key, arm(x))).collect();
        let more = ["time.step=1, a.b=7", "time.step=2, a.b=7", "time.step=4, a.b=7", "time.step=8, a.b=7"];
        let two: Vec<_> = more.iter().zip(steps).map(|(key, x)| (*key, arm(x))).collect();
        for arms in [one.clone(), [one, two].concat()] {
            let plots = plots(&study(&arms));
            assert_eq!(plots.len(), 1);
            assert_eq!(names(&plots[0]), ["restitution", "impulse_y", "energy_lost"]);
            // The exponent of x² is 2; of 1 − x, which has no logarithm, the slope is −1.
            let words = if arms.len() == 4 { ["slope −1 ±", "exponent 2 ±"] } else { ["", ""] };
            for (pane, words) in plots[0].panes.iter().zip(words) {
                assert!(pane.title.starts_with(words), "{}", pane.title);
            }
            let table = plots[0].csv();
            assert!(table.contains("\"impulse_y\",\"95 % interval of the fit, low\"") == (arms.len() == 4));
            assert_eq!(plots[0].x_label, "step (ms)");
        }
    }

    /// ρ∞ is not a time, may be zero, and a velocity may be negative; the components of an array
    /// are no number.
    #[test]
    fn keys_are_finite_numbers() {
        let keys = ["time.scheme.rho_inf=0", "time.scheme.rho_inf=0.5", "time.scheme.rho_inf=1"];
        let arms: Vec<_> =
            keys.iter().zip([1.0, 2.0, 4.0]).map(|(key, y)| (*key, vec![("contact_duration", y)])).collect();
        let plots_of = |arms: &[_]| plots(&study(arms));
        let plot = plots_of(&arms).swap_remove(0);
        assert_eq!(
            (plot.x_label.as_str(), plot.panes[0].curves[0].x.as_slice()),
            ("ρ_{∞}", &[1.0, 0.5, 0.0][..])
        );
        let keys = ["a.v=-2", "a.v=-1", "a.v=3"];
        let arms: Vec<_> = keys.iter().zip([1.0, 2.0, 4.0]).map(|(key, y)| (*key, vec![("r", y)])).collect();
        assert_eq!(plots_of(&arms)[0].panes[0].curves[0].x, [3.0, -1.0, -2.0]);
        let keys = ["a.v=[1, 0]", "a.v=[2, 0]", "a.v=[3, 0]"];
        let arms: Vec<_> = keys.iter().zip([1.0, 2.0, 4.0]).map(|(key, y)| (*key, vec![("r", y)])).collect();
        assert!(plots_of(&arms).is_empty());
    }

    /// A metric that spans the factor in one group only is a line in both, in figure and table;
    /// arms that created energy do not count.
    #[test]
    fn figure_and_table_fit_the_same() {
        let arm = |y: f64, created: f64| vec![("r", y), ("energy_created", created)];
        let arms = vec![
            ("h=1, g=0", arm(1.0, 0.0)),
            ("h=2, g=0", arm(2.0, 0.0)),
            ("h=4, g=0", arm(4.0, 0.0)),
            ("h=8, g=0", arm(8.0, 0.0)),
            ("h=1, g=1", arm(1.0, 0.0)),
            ("h=2, g=1", arm(1.2, 0.0)),
            ("h=4, g=1", arm(1.6, 0.0)),
            ("h=8, g=1", arm(2.4, 0.0)),
            ("h=16, g=1", arm(9.0, 1.0)),
        ];
        let study = study(&arms);
        let table = section(&study).into_string();
        assert!(
            table.contains("slope 1 ±") && table.contains("slope 0.2 ±") && !table.contains("exponent "),
            "{table}"
        );
        let plot = plots(&study).swap_remove(0);
        let fit = &plot.panes[0].curves[0];
        let middle = fit.x.iter().zip(&fit.y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(middle < 1e-9 && plot.panes[0].curves[3].x == [8.0, 4.0, 2.0, 1.0], "{:?}", plot.panes[0]);
    }

    /// A metric that differs between groups only is no trend; arms are said to be left out where
    /// some are.
    #[test]
    fn a_trend_varies_against_its_key() {
        let arm =
            |start: f64, r: f64, created: f64| vec![("start", start), ("r", r), ("energy_created", created)];
        let mut arms = vec![
            ("k=1, g=0", arm(1.0, 1.0, 0.0)),
            ("k=2, g=0", arm(1.0, 2.0, 0.0)),
            ("k=3, g=0", arm(1.0, 4.0, 0.0)),
            ("k=1, g=1", arm(2.0, 1.0, 0.0)),
            ("k=2, g=1", arm(2.0, 2.0, 0.0)),
            ("k=3, g=1", arm(2.0, 4.0, 0.0)),
        ];
        let plot_of = |arms: &[_]| plots(&study(arms)).swap_remove(0);
        let plot = plot_of(&arms);
        assert_eq!(names(&plot), ["r"]);
        assert!(!plot.caption.contains("left out"), "{}", plot.caption);
        arms[5].1[2].1 = 1.0;
        assert!(plot_of(&arms).caption.contains("left out"));
    }

    #[test]
    fn the_caption_says_what_is_left_out() {
        const NAMES: [&str; 10] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"];
        let arm = |y: f64| NAMES.map(|name| (name, y)).to_vec();
        let arms = [("k=1", arm(1.0)), ("k=2", arm(2.0)), ("k=3", arm(2.5)), ("k=3.5", arm(2.75))];
        // Through three values no line is fitted.
        let three = self::study(&arms[..3]);
        assert!(section(&three).into_string().is_empty());
        let plot = plots(&three).swap_remove(0);
        assert_eq!(plot.panes[0].curves.len(), 1);
        let study = study(&arms);
        let plot = plots(&study).swap_remove(0);
        assert_eq!(plot.panes.len(), 9);
        assert!(plot.caption.starts_with("9 of the 10 metrics that vary against `k`"), "{}", plot.caption);
        assert_eq!(section(&study).into_string().matches("slope ").count(), 10);
    }
}
