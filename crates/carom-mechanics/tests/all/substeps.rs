//! Progress through the bisected parts of a step.

use carom_mechanics::substeps::Progress;

#[test]
fn progress_returns_to_the_longest_step() {
    let mut progress = Progress { level: 0, done: 0 };
    progress.bisect();
    progress.bisect();
    assert_eq!((progress.done(), progress.next()), (0.0, 0.25));
    progress.advance();
    assert_eq!(progress, Progress { level: 2, done: 1 });
    progress.advance();
    assert_eq!(progress, Progress { level: 1, done: 1 });
    progress.advance();
    assert_eq!(progress, Progress { level: 0, done: 1 });
}
