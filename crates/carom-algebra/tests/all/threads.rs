//! A thread pool shared by a computation.

use carom_algebra::Threads;

#[test]
fn every_item_once_with_any_number() {
    for count in [0, 1, 2, 3] {
        let threads = Threads::new(count);
        assert_eq!(threads.count(), count.max(1));
        let mut items = vec![0; 77];
        threads.within(|| {
            threads.for_each_block(&mut items, 10, |first, block| {
                block.iter_mut().enumerate().for_each(|(i, item)| *item += first + i);
            });
        });
        assert!(items.iter().enumerate().all(|(i, item)| i == *item));
        assert_eq!(threads.join(|| 'a', || 'b'), ('a', 'b'));
    }
}

/// Sums of blocks have the same bits for any number of threads, and those of short vectors the bits
/// of one sum.
#[test]
fn sums_have_the_same_bits_with_any_number_of_threads() {
    let x: Vec<f64> = (0..100_003).map(|i| f64::from(i).sin() / 3.0).collect();
    let y: Vec<f64> = (0..100_003).map(|i| f64::from(i).cos() / 7.0).collect();
    let of = |threads: usize| Threads::new(threads).sums([&x, &y], |[x, y]| [x * y, x * x]);
    let one = of(1);
    assert_eq!((of(2), of(3)), (one, one));
    let exact: f64 = x.iter().map(|x| x * x).sum();
    assert!((one[1] - exact).abs() < 1e-12 * exact);
    let short = Threads::new(2).sums([&x[..1000]], |[x]| [x * x]);
    assert_eq!(short, carom_algebra::sums::sums([&x[..1000]], |[x]| [x * x]));
    let mut spiked = x.clone();
    spiked[77_777] = -5.0;
    assert_eq!(Threads::new(2).max_abs(&spiked), 5.0);
    spiked[99_999] = f64::NAN;
    assert!(Threads::new(2).max_abs(&spiked).is_infinite());
}
