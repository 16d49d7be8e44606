//! Symbolic analysis of a pattern without memory for it.

use carom_algebra::symbolic::memory;
use faer::dyn_stack::StackReq;
use faer::sparse::FaerError;

#[test]
fn a_lack_of_memory_is_told_apart() {
    let error = memory(StackReq::new::<u8>(usize::MAX >> 2)).err();
    assert!(matches!(error, Some(FaerError::OutOfMemory)), "{error:?}");
}
