//! Quantities by which the bodies can be coloured: the recorded fields, component by component.

use carom_record::FieldSet;
use maud::{Markup, PreEscaped};
use serde_json::{Value, json};

use super::packed::Frame;
use crate::bands::{Bands, color_bands, positive_bands_of};
use crate::chart::open;
use crate::noise::floor;
use crate::recorded::Recorded;
use crate::sheet::{Legend, color_bar};

/// A stored number per node and frame: a component of an array of the field files.
pub(super) struct Channel {
    array: String,
    component: usize,
}

impl Channel {
    /// Values of the component at some points of a field file.
    pub(super) fn values(&self, fields: &FieldSet, nodes: &[usize]) -> Option<Vec<f32>> {
        let array = fields.array(&self.array)?;
        let value = |&node: &usize| array.values[array.components * node + self.component];
        Some(nodes.iter().map(|node| value(node) as f32).collect())
    }
}

/// How a quantity follows from the numbers of its channels.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// The number itself.
    Value,
    /// The length of the vector.
    Length,
    /// The mean of the components.
    Mean,
    /// Volume over initial volume, less one, from principal logarithmic strains.
    Dilation,
}

/// A quantity to choose.
pub(super) struct Quantity {
    pub(super) name: String,
    symbol: String,
    unit: String,
    rule: Rule,
    /// Numbers of its channels.
    channels: Vec<usize>,
    /// Axes across which a mirror image has the opposite sign.
    odd: [bool; 3],
    is_positive: bool,
    /// Values up to this one are round-off.
    floor: f64,
}

/// The channels that are stored, and the quantities that follow from them; the first is shown at
/// first.
pub(super) struct Choice<'a> {
    run: &'a Recorded,
    pub(super) channels: Vec<Channel>,
    pub(super) quantities: Vec<Quantity>,
}

const AXES: [&str; 3] = ["x", "y", "z"];
/// Components of the stress in the field files, as pairs of axes.
const STRESS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];

impl<'a> Choice<'a> {
    /// The fields of a run in at most so many channels; the displacement is stored in any case.
    pub(super) fn new(run: &'a Recorded, fields: &FieldSet, most: usize) -> Self {
        let dimension = run.case.dimension;
        let mut choice = Self { run, channels: Vec::new(), quantities: Vec::new() };
        let axes: Vec<usize> = (0..dimension).collect();
        let most = most.max(dimension + 1);
        choice.vector(fields, "displacement", "u", &axes, most);
        let pairs: &[usize] = [&[0][..], &[1, 0, 2, 3], &[0, 1, 2, 3, 4, 5]][dimension.clamp(1, 3) - 1];
        if dimension > 1 {
            choice.add(fields, "von_mises", &[0], most, |_| {
                ("von Mises stress".into(), "σ_{vM}".into(), [false; 3])
            });
        }
        choice.add(fields, "stress", pairs, most, |k| {
            let [i, j] = STRESS[k];
            let odd = [0, 1, 2].map(|d| (i == d) != (j == d));
            (format!("stress {}{}", AXES[i], AXES[j]), format!("σ_{{{}{}}}", AXES[i], AXES[j]), odd)
        });
        if !run.contact.is_empty() && dimension > 1 {
            choice.add(fields, "contact_pressure", &[0], most, |_| {
                ("contact pressure".into(), "p_{c}".into(), [false; 3])
            });
        }
        choice.vector(fields, "velocity", "v", &axes, most);
        if dimension > 1 {
            for (array, name, symbol) in [
                ("principal_log_strain", "logarithmic strain", "ε"),
                ("principal_stress", "principal stress", "σ"),
            ] {
                choice.add(fields, array, &[0, 1, 2], most, |k| {
                    (format!("{name} {}", k + 1), format!("{symbol}_{{{}}}", k + 1), [false; 3])
                });
            }
        }
        choice.derive("mean stress", "σ_{m}", Rule::Mean, "stress", &[0, 1, 2]);
        choice.derive("volume change", "J − 1", Rule::Dilation, "principal_log_strain", &[0, 1, 2]);
        let first = [["stress", "xx"], ["stress", "yy"], ["von", "Mises"]][dimension.clamp(1, 3) - 1];
        let is_first = |quantity: &Quantity| first.iter().all(|word| quantity.name.contains(word));
        choice.quantities.sort_by_key(|quantity| !is_first(quantity));
        choice
    }

    /// Adds the components of an array, if all of them fit.
    fn add(
        &mut self,
        fields: &FieldSet,
        array: &str,
        components: &[usize],
        most: usize,
        words: impl Fn(usize) -> (String, String, [bool; 3]),
    ) {
        let Some(found) = fields.array(array) else { return };
        if self.channels.len() + components.len() > most {
            return;
        }
        for &component in components.iter().filter(|component| **component < found.components) {
            let (name, symbol, odd) = words(component);
            self.quantities.push(Quantity {
                name,
                symbol,
                unit: found.unit.clone(),
                rule: Rule::Value,
                channels: vec![self.channels.len()],
                odd,
                is_positive: matches!(array, "von_mises" | "contact_pressure"),
                floor: floor(self.run, fields, array),
            });
            self.channels.push(Channel { array: array.to_owned(), component });
        }
    }

    /// Adds the components of a vector, and its length where it has several.
    fn vector(&mut self, fields: &FieldSet, array: &str, symbol: &str, axes: &[usize], most: usize) {
        self.add(fields, array, axes, most, |k| {
            let odd = [0, 1, 2].map(|d| d == k);
            (format!("{array} {}", AXES[k]), format!("{symbol}_{{{}}}", AXES[k]), odd)
        });
        if axes.len() > 1 {
            self.derive(array, &format!("|{symbol}|"), Rule::Length, array, axes);
        }
    }

    /// Adds a quantity of several components, if they are stored.
    fn derive(&mut self, name: &str, symbol: &str, rule: Rule, array: &str, components: &[usize]) {
        let channel = |k: &usize| self.channels.iter().position(|c| c.array == array && c.component == *k);
        let Some(channels) = components.iter().map(channel).collect::<Option<Vec<_>>>() else { return };
        let like = self.quantities.iter().find(|quantity| quantity.channels == [channels[0]]);
        let unit = if rule == Rule::Dilation {
            String::new()
        } else {
            like.map_or(String::new(), |q| q.unit.clone())
        };
        let is_positive = rule == Rule::Length;
        let floor = like.map_or(0.0, |quantity| quantity.floor);
        self.quantities.push(Quantity {
            name: name.to_owned(),
            symbol: symbol.to_owned(),
            unit,
            rule,
            channels,
            odd: [false; 3],
            is_positive,
            floor,
        });
    }
}

impl Quantity {
    fn value(&self, frame: &Frame, node: usize) -> f64 {
        let of = |channel: &usize| f64::from(frame.values[*channel][node]);
        let sum = |f: &dyn Fn(f64) -> f64| self.channels.iter().map(|channel| f(of(channel))).sum::<f64>();
        match self.rule {
            Rule::Value => of(&self.channels[0]),
            Rule::Length => sum(&|x| x * x).sqrt(),
            Rule::Mean => sum(&|x| x) / self.channels.len() as f64,
            Rule::Dilation => sum(&|x| x).exp_m1(),
        }
    }

    /// Colours of its values in all frames.
    fn bands(&self, frames: &[Frame]) -> (Bands, [bool; 2]) {
        let of_frame = |frame| (0..Frame::nodes(frame)).map(move |node| self.value(frame, node));
        // Few nodes of a body are in contact.
        let is_counted = |value: &f64| self.symbol != "p_{c}" || *value > 0.0;
        if self.is_positive {
            positive_bands_of(frames.iter().map(|frame| of_frame(frame).filter(is_counted)), self.floor)
        } else {
            color_bands(frames.iter().flat_map(of_frame), self.floor)
        }
    }

    /// Rule and colours of the quantity for the script, and its colour bar.
    pub(super) fn shown(&self, frames: &[Frame]) -> (Value, Markup) {
        let (bands, cut) = self.bands(frames);
        let colors: Vec<String> = (0..bands.count).map(|band| bands.color(band)).collect();
        let rule = match self.rule {
            Rule::Value => "value",
            Rule::Length => "length",
            Rule::Mean => "mean",
            Rule::Dilation => "dilation",
        };
        let data = json!({
            "rule": rule, "channels": self.channels, "odd": self.odd,
            "low": bands.low, "high": bands.high, "colors": colors,
        });
        let mut bar = open(&format!("Colour bar: {}", self.name), 106.0, 336.0);
        let legend = Legend { bands: &bands, cut, label: &self.symbol, unit: &self.unit };
        color_bar(&mut bar, &legend, 16.0, (14.0, 318.0));
        (data, PreEscaped(bar + "</svg>\n"))
    }
}
