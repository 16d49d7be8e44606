//! The uncertainty of a value under refinement, from runs whose steps and cells shrink together.

use carom_record::study::convergence::converged;

/// f = 1 + h^p at h = 4, 2, 1 and at 3, 2, 1: the order is p; the uncertainty is 1.25 times the
/// error of the order 2/3.
#[test]
fn orders_are_recovered() {
    for sizes in [[4.0, 2.0, 1.0], [3.0, 2.0, 1.0], [2.0, 1.5, 1.0]] {
        for p in [1.0, 1.5, 2.0] {
            let values = sizes.map(|h: f64| 1.0 + 0.01 * h.powf(p));
            let found = converged(&sizes, &values).unwrap();
            assert!((found.order.unwrap() - p).abs() < 1e-6, "{found:?}");
            let of_a_jump = (values[1] - values[2]) / (sizes[1].powf(2.0 / 3.0) - 1.0);
            assert!((found.uncertainty - 1.25 * of_a_jump).abs() < 1e-8, "{found:?}");
        }
    }
}

/// By hand: the order 1/2 of 2, √2 and 1 puts the limit 1 below; an order of 3 is not believed,
/// and values that do not converge have three times their range.
#[test]
fn irregular_convergence_is_wider() {
    let h = [4.0, 2.0, 1.0];
    let slow = converged(&h, &h.map(|h: f64| h.sqrt())).unwrap();
    assert!((slow.uncertainty - 1.25).abs() < 1e-9, "{slow:?}");
    let fast = converged(&h, &h.map(|h: f64| h.powi(3) / 64.0)).unwrap();
    assert!((fast.uncertainty - 1.25 * 63.0 / 64.0).abs() < 1e-12, "{fast:?}");
    // Whether the two finest values are equal or almost so makes no difference.
    for last in [1.0, 1.0 + 1e-15, 1.0 - 1e-15, 1.0 - 1e-8] {
        assert!((converged(&h, &[1.2, 1.0, last]).unwrap().uncertainty - 0.25).abs() < 1e-7, "{last}");
    }
    assert_eq!(converged(&h, &[1.4, 1.2, 1.4]).unwrap().order, None);
    assert!((converged(&h, &[1.4, 1.2, 1.4]).unwrap().uncertainty - 0.6).abs() < 1e-12);
    assert!((converged(&[2.0, 1.0], &[1.1, 1.0]).unwrap().uncertainty - 0.3).abs() < 1e-12);
    assert_eq!(converged(&h, &[1.0; 3]).unwrap().uncertainty, 0.0);
    assert!(converged(&[1.0], &[1.0]).is_err());
}
