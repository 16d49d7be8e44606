//! The five numbers of a run that a reader wants first.

use carom_record::{Sizes, metrics};
use maud::{Markup, html};

use crate::asked::metrics_of;
use crate::labels::{amount, instant_label};
use crate::ordered::distinct;
use crate::recorded::Recorded;
use crate::scene::{Peak, Scene};
use crate::scientific::significant;
use crate::text::Label;

const COUNT: usize = 5;

/// A number with its name, and when or in terms of what it is.
struct Number {
    name: String,
    value: String,
    note: String,
}

impl Number {
    fn new(name: impl Into<String>, value: String, note: impl Into<String>) -> Self {
        Self { name: name.into(), value, note: note.into() }
    }
}

/// A time, with a prefix where an instant of this size has one.
fn duration(x: f64, unit: &str) -> String {
    if x < 1e-3 { amount(x, unit) } else { format!("{} {unit}", significant(x, 3)).trim_end().to_owned() }
}

/// Resultant, as a share of the forces at nodes, that is the round-off of forces that cancel.
const CANCELS: f64 = 1e-8;

/// Results of a run from which its headline numbers are chosen.
struct Facts<'a> {
    run: &'a Recorded,
    scene: Option<&'a Scene>,
    metrics: Vec<metrics::Metric>,
    sizes: Sizes,
}

/// The numbers fit for the run: of an impact, of bodies that are driven, of a static analysis, or
/// of a free motion.
pub(crate) fn headline(run: &Recorded, scene: Option<&Scene>) -> Markup {
    let facts = Facts { run, scene, metrics: metrics_of(run), sizes: Sizes::of(run) };
    let is_driven = run.is_driven();
    let impact = || {
        let energy = if is_driven { facts.work() } else { facts.energy_lost() };
        [facts.rebound(), facts.peak_force(), facts.mean_force(), facts.duration(), energy]
    };
    let outside = || [facts.largest_stress(), facts.peak_force(), facts.work(), facts.displacement()];
    let inside =
        || [facts.peak_force(), facts.work(), facts.friction(), facts.plastic(), facts.largest_stress()];
    let free = || [facts.largest_stress(), facts.displacement(), facts.kinetic(), facts.energy_lost()];
    let no_rebound = metrics::no_rebound(run);
    // A body that is driven strikes where it rebounds, and is pressed where it does not.
    let rebounds = metrics::Impact::first(run).is_ok_and(|impact| impact.separation > Some(0.0));
    let is_impact = !run.is_static() && run.has_contact() && (!is_driven || rebounds);
    let no_rebound = no_rebound.filter(|_| is_impact);
    let numbers: Vec<Option<Number>> = if run.is_static() {
        facts.reactions().into_iter().chain(outside()).collect()
    } else if is_impact {
        impact()
            .into_iter()
            .chain([facts.largest_stress(), facts.friction(), facts.plastic(), facts.displacement()])
            .collect()
    } else if is_driven {
        facts.reactions().into_iter().chain(inside()).chain([facts.displacement()]).collect()
    } else {
        free().into_iter().chain(facts.reactions()).collect()
    };
    // The reaction of an obstacle is its contact force.
    let all = numbers.into_iter().flatten();
    let numbers = all.fold(Vec::<Number>::new(), |mut kept, number| {
        if kept.iter().all(|other| (&other.value, &other.note) != (&number.value, &number.note)) {
            kept.push(number);
        }
        kept
    });
    let numbers = &numbers[..numbers.len().min(COUNT)];
    html! {
        @if !numbers.is_empty() {
            dl.numbers {
                @for number in numbers {
                    div {
                        dt { (Label(&number.name)) }
                        dd { (Label(&number.value)) }
                        dd.small { (Label(&number.note)) }
                    }
                }
            }
            @if let Some(why) = no_rebound { p.small { "No coefficient of restitution: " (why) "." } }
        }
    }
}

impl Facts<'_> {
    fn metric(&self, name: &str) -> Option<f64> {
        self.metrics.iter().find(|metric| metric.name == name)?.value
    }

    fn at(&self, row: usize) -> String {
        self.run
            .times()
            .get(row)
            .map_or_else(String::new, |time| format!("at {}", instant_label(self.run, *time)))
    }

    fn force(&self, x: f64) -> String {
        amount(x, self.run.history.unit("contact_force_x"))
    }

    fn energy(&self, x: f64) -> String {
        amount(x, self.run.history.unit("total"))
    }

    fn rebound(&self) -> Option<Number> {
        let value = self.metric("restitution")?;
        let striker = metrics::striker(self.run).unwrap_or_default();
        Some(Number::new(
            "Rebound",
            significant(value, 3),
            format!("coefficient of restitution of {striker}"),
        ))
    }

    /// The largest contact force; of an impact its mean over a short time, because that of single
    /// steps does not converge. None if the forces of all nodes cancel, as around a ring.
    fn peak_force(&self) -> Option<Number> {
        let forces = metrics::contact_force(self.run);
        let row = (0..forces.len()).max_by(|a, b| forces[*a].total_cmp(&forces[*b]))?;
        if forces[row] <= CANCELS * crate::noise::force_size(self.run) {
            return None;
        }
        let averaged = self.metric("peak_mean_force").filter(|_| metrics::no_rebound(self.run).is_none());
        Some(match averaged {
            Some(mean) => {
                Number::new("Largest contact force", self.force(mean), "mean over 1/16 of the contact")
            }
            None => Number::new("Largest contact force", self.force(forces[row]), self.at(row)),
        })
    }

    fn mean_force(&self) -> Option<Number> {
        let duration = self.metric("contact_duration")?;
        let axes = ["impulse_x", "impulse_y", "impulse_z"].into_iter();
        // None of contacts that do not count as one.
        let impulse = axes.filter_map(|name| self.metric(name)).reduce(f64::hypot)?.abs();
        Some(Number::new("Mean contact force", self.force(impulse / duration), "impulse over duration"))
    }

    fn duration(&self) -> Option<Number> {
        let value = self.metric("contact_duration")?;
        let note = self
            .metric("contact_start")
            .map_or_else(String::new, |t| format!("from {}", instant_label(self.run, t)));
        Some(Number::new("Contact duration", duration(value, self.run.time_unit()), note))
    }

    fn energy_lost(&self) -> Option<Number> {
        let value = self.metric("energy_lost")?;
        let percent = 100.0 * value.abs();
        let name = match value {
            _ if percent < 1e-6 => "Energy lost or created",
            _ if value < 0.0 => "Energy created",
            _ => "Energy lost",
        };
        let shown = if percent < 1e-6 { "< 10^{-6}".to_owned() } else { significant(percent, 2) };
        Some(Number::new(name, format!("{shown} %"), "of the largest kinetic + strain energy"))
    }

    /// The two largest reactions of supports and obstacles.
    fn reactions(&self) -> Vec<Option<Number>> {
        let history = &self.run.history;
        let names = history.columns.iter().filter_map(|column| column.name.strip_suffix(".reaction_x"));
        let mut found: Vec<(f64, usize, &str)> = Vec::new();
        for name in distinct(names) {
            let axes = ["x", "y", "z"].map(|axis| history.column(&format!("{name}.reaction_{axis}")));
            let size =
                |row: usize| axes.iter().flatten().fold(0.0, |sum, column| f64::hypot(sum, column[row]));
            if let Some(row) = (0..self.run.times().len()).max_by(|a, b| size(*a).total_cmp(&size(*b))) {
                found.push((size(row), row, name));
            }
        }
        let unit = history.unit("contact_force_x");
        found.retain(|(size, ..)| !self.sizes.is_round_off(*size, unit));
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let number = |(value, row, name): (f64, usize, &str)| {
            Some(Number::new(format!("Largest reaction, {name}"), self.force(value), self.at(row)))
        };
        found.into_iter().take(2).map(number).collect()
    }

    fn of_fields(&self, name: &str, peak: Option<&Peak>) -> Option<Number> {
        let Peak { value, time, unit } =
            peak.filter(|peak| !self.sizes.is_round_off(peak.value, &peak.unit))?;
        let frames = self.scene.map_or(0, |scene| scene.times.len());
        let at = instant_label(self.run, *time);
        Some(Number::new(name, amount(*value, unit), format!("at {at}, of {frames} frames")))
    }

    fn largest_stress(&self) -> Option<Number> {
        let mut number = self.of_fields("Largest von Mises stress", self.scene?.stress.as_ref())?;
        if self.run.case.yielding().next().is_some() {
            number.note.push_str(", of the quadrature points");
        }
        Some(number)
    }

    fn displacement(&self) -> Option<Number> {
        self.of_fields("Largest displacement", self.scene?.displacement.as_ref())
    }

    fn work(&self) -> Option<Number> {
        let work = self.run.column("external_work")?;
        let size = work.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        (size > 0.0)
            .then(|| Number::new("External work", self.energy(*work.last().unwrap_or(&0.0)), "at the end"))
    }

    fn friction(&self) -> Option<Number> {
        let work = *self.run.column("friction_work")?.last()?;
        let is_zero = work == 0.0 || self.sizes.is_round_off(work, self.run.history.unit("total"));
        (!is_zero).then(|| Number::new("Work of friction", self.energy(work), "at the end"))
    }

    fn plastic(&self) -> Option<Number> {
        let work = *self.run.column("plastic_work")?.last()?;
        (work != 0.0).then(|| Number::new("Work of plastic flow", self.energy(work), "at the end"))
    }

    fn kinetic(&self) -> Option<Number> {
        let kinetic = self.run.column("kinetic")?;
        let most = kinetic.iter().copied().filter(|x| x.is_finite()).fold(0.0, f64::max);
        let first = kinetic.first().copied().unwrap_or(0.0);
        (most > 0.0).then(|| {
            Number::new(
                "Largest kinetic energy",
                self.energy(most),
                format!("{} at first", self.energy(first)),
            )
        })
    }
}
