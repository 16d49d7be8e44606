//! Comparison of an arm with the reference: deviations of columns, over all rows and in the smooth
//! phases before and after the first contact, and its delay.

use carom_record::study::Arm;
use carom_record::study::compared::{Compared, phase_orders};
use carom_record::study::reference::{Level, Reference, Trajectory};

fn sampled(n: u32, f: impl Fn(f64) -> f64) -> Trajectory {
    let times: Vec<f64> = (0..=n).map(|i| f64::from(i) / f64::from(n)).collect();
    let values = times.iter().map(|t| f(*t)).collect();
    Trajectory { times, columns: [("A.uy".to_owned(), values)].into(), ..Trajectory::default() }
}

/// Given errors, h² before t = 1/2 and h after it, with respect to three identical runs.
#[test]
fn orders_of_the_phases() {
    let exact = || sampled(64, |t| t);
    let levels = [4.0, 2.0, 1.0].map(|step| Level::single(step, exact()));
    let reference = Reference::of_levels("r".into(), levels.into());
    let arm = |h: f64| {
        Compared::of(
            &sampled(32, |t| t + if t < 0.5 { h * h } else { h }),
            &Arm::default(),
            &reference,
            Some((0.5, 0.5)),
        )
    };
    let coarse = arm(0.1);
    let fine = arm(0.05);
    let orders = phase_orders("m", "A.uy", &[(0.1, &coarse), (0.05, &fine)], &reference).unwrap();
    assert!((orders.smooth.unwrap() - 2.0).abs() < 1e-9 && (orders.across.unwrap() - 1.0).abs() < 1e-9);
}
