//! Damping ratio and period of a column that oscillates freely about zero.

use carom_record::metrics::given::Given;
use carom_record::metrics::oscillation::{damping_ratio, period};
use carom_record::{Column, History};

fn history(of: fn(f64) -> f64) -> History {
    let times: Vec<f64> = (0..=90).map(|n| 0.1 * f64::from(n)).collect();
    let name = |name: &str| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    };
    History::new(["time", "c"].map(name).to_vec(), vec![times.clone(), times.into_iter().map(of).collect()])
}

/// e^{−0.6t} cos 2t has ξ = 0.3 and T = π, also with a second term that decays in the first
/// half. Columns with a parabola or a second frequency have neither.
#[test]
fn damping_of_a_decaying_cosine() {
    let of = |history: &History| {
        let given = Given::of(history).with_column("c");
        (damping_ratio(&given), period(&given))
    };
    let (damping, period) = of(&history(|t| (-0.6 * t).exp() * (2.0 * t).cos() + 5.0 * (-15.0 * t).exp()));
    assert!((damping.unwrap() - 0.3).abs() < 1e-9);
    assert!((period.unwrap() - std::f64::consts::PI).abs() < 1e-9);
    assert!(of(&history(|t| (2.0 * t).cos())).0.unwrap().abs() < 1e-12);
    for other in [history(|t| 1.0 + t * t), history(|t| t.sin() + 0.1 * (7.0 * t).sin()), history(|_| 0.0)] {
        assert_eq!(of(&other), (None, None));
    }
}
