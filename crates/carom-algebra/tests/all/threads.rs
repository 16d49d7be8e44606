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
