//! The unit of what an expectation asks for, from those of its quantities.

use carom_record::metrics::Metric;
use carom_record::question::{Form, Quantity, Question};
use carom_record::{Expression, Run, Sign, metrics};

/// The unit of an expression; none where a number in it may have one. A number is no unit, `""`.
pub(crate) fn unit(run: &Run, what: &str) -> Option<String> {
    let all = metrics_of(run);
    let of_metric = |name: &str| all.iter().find(|m| m.name == name).map(|m| m.unit.clone());
    let of_column = |name: &str| run.column(name).map(|_| run.history.unit(name).to_owned());
    // A difference from a formula of t.
    if let Some((_, column)) = what.split_once(" − (").and_then(|(column, _)| column.rsplit_once('|')) {
        return of_column(column);
    }
    let of_quantity = |quantity: &Quantity| match quantity {
        Quantity::Metric(name, _) => of_metric(name),
        Quantity::Reduced(Form::TimeOfMin | Form::TimeOfMax, _) => Some(run.history.unit("time").to_owned()),
        Quantity::Reduced(_, series) => combined(&series.columns, &|asked| of_column(&asked.column)),
    };
    of_metric(what).or_else(|| combined(&Question::parse(what).ok()?, &of_quantity))
}

/// The metrics of a run, those of its rebound and of its measured data included.
pub(crate) fn metrics_of(run: &Run) -> Vec<Metric> {
    let mut all = metrics::of_run(run);
    all.extend(metrics::overlays(run).iter().flat_map(|data| metrics::of_measured(&run.history, data)));
    all
}

/// The unit of an expression in quantities of these units.
fn combined<Q>(expression: &Expression<Q>, of: &dyn Fn(&Q) -> Option<String>) -> Option<String> {
    match expression {
        Expression::Number(_) => None,
        Expression::Quantity(quantity) => of(quantity),
        Expression::Binary(sign, sides) => {
            let [left, right] = [combined(&sides[0], of)?, combined(&sides[1], of)?];
            match sign {
                Sign::Plus | Sign::Minus => (left == right).then_some(left),
                Sign::Over if left == right => Some(String::new()),
                Sign::Over | Sign::Times if right.is_empty() => Some(left),
                Sign::Times if left.is_empty() => Some(right),
                Sign::Over | Sign::Times => None,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_sums_and_ratios() {
        let unit = |text: &str| {
            let of = |quantity: &Quantity| match quantity {
                Quantity::Metric(..) => None,
                Quantity::Reduced(_, series) => combined(&series.columns, &|asked| {
                    Some(if asked.column.starts_with('u') { "m" } else { "N" }.to_owned())
                }),
            };
            combined(&Question::parse(text).unwrap(), &of)
        };
        assert_eq!(unit("last ux - at 1 uy").as_deref(), Some("m"));
        assert_eq!(unit("( last ux - at 6 ux ) / ( last uy - at 6 uy )").as_deref(), Some(""));
        assert_eq!(unit("max [ ux - uy ]").as_deref(), Some("m"));
        // Two may be two seconds.
        for text in ["last ux / 2", "last ux - last f", "-1 * last f", "last ux * last f"] {
            assert_eq!(unit(text), None, "{text}");
        }
    }
}
