//! The iterations that are kept to explain a rejection.

use carom_mechanics::{Iteration, Trace};

#[test]
fn the_last_iterations_are_kept() {
    let mut trace = Trace::default();
    for number in 0..30 {
        trace.shorten(if number == 29 { 0.5 } else { 1.0 });
        trace.push(Iteration { number, ..Iteration::default() }, &[f64::from(number)]);
    }
    let kept: Vec<(u32, f64)> = trace.iterations().map(|i| (i.number, i.length)).collect();
    assert_eq!((kept[0], kept[11]), ((18, 1.0), (29, 0.5)));
    assert_eq!(trace.positions(), [29.0]);
    trace.blame(&[1.0, -9.0, 3.0], &[0, 2]);
    assert_eq!(trace.worst(), Some(2));
    trace.clear();
    assert!(trace.iterations().next().is_none() && trace.positions().is_empty());
}
