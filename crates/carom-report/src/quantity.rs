//! What the bodies of an animation are coloured by: bands with their colour bar, and the choice
//! between several quantities.

use carom_record::FieldSet;
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

use crate::bands::Bands;
use crate::chart::open;
use crate::sheet::{Legend, color_bar};

/// A quantity that can be chosen.
pub(crate) struct Quantity<'a> {
    /// In words, in the list.
    pub(crate) name: &'static str,
    /// Its colours, symbol and unit.
    pub(crate) legend: Legend<'a>,
}

impl Quantity<'_> {
    /// Its bands for the scripts.
    pub(crate) fn data(&self) -> Value {
        let Bands { low, high, count } = self.legend.bands;
        let colors: Vec<String> = (0..*count).map(|b| self.legend.bands.color(b)).collect();
        json!({ "low": low, "high": high, "colors": colors })
    }
}

/// The colour bars of quantities: the first is shown.
pub(crate) fn bars(quantities: &[Quantity]) -> Markup {
    let bar = |quantity: &Quantity| {
        let mut out = open(&format!("Colour bar: {}", quantity.name), 106.0, 336.0);
        color_bar(&mut out, &quantity.legend, 16.0, (14.0, 318.0));
        PreEscaped(out + "</svg>\n")
    };
    html! {
        @for (k, quantity) in quantities.iter().enumerate() {
            div.bar hidden[k > 0] { (bar(quantity)) }
        }
    }
}

/// The list of quantities to choose from.
pub(crate) fn choice(quantities: &[Quantity]) -> Markup {
    html! {
        label {
            "colours "
            select.quantity autocomplete="off" {
                @for (k, quantity) in quantities.iter().enumerate() { option value=(k) { (quantity.name) } }
            }
        }
    }
}

/// The equivalent stress of von Mises, √(3/2 s:s), of each point, and the mean stress tr σ/3.
pub(crate) fn stresses(fields: &FieldSet) -> Option<[Vec<f64>; 2]> {
    let stress = fields.array("stress").filter(|a| a.components == 6)?;
    let points = stress.values.as_chunks::<6>().0;
    let mises = |[xx, yy, zz, xy, yz, xz]: &[f64; 6]| {
        let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
    };
    let mean = |s: &[f64; 6]| (s[0] + s[1] + s[2]) / 3.0;
    Some([points.iter().map(mises).collect(), points.iter().map(mean).collect()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_record::PointArray;

    /// By hand: tension 5; a pressure of 2 with a shear of 3.
    #[test]
    fn von_mises_of_simple_states() {
        let values = vec![5.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0, -2.0, -2.0, 0.0, 3.0, 0.0];
        let stress = PointArray { name: "stress".into(), unit: String::new(), components: 6, values };
        let fields = FieldSet { points: vec![[0.0; 3]; 2], blocks: Vec::new(), arrays: vec![stress] };
        let [mises, mean] = stresses(&fields).unwrap();
        assert_eq!((mises[0], mean[0]), (5.0, 5.0 / 3.0));
        assert!((mises[1] - 27f64.sqrt()).abs() < 1e-14 && mean[1] == -2.0);
    }
}
