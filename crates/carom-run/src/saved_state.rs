//! A state in a file of its own, from which a case continues: `[initial] from = "state.bin"`.
//!
//! ```text
//! "CAROMSTA" | state (postcard) | blake3 of all before (32 bytes)
//! ```

use std::path::Path;

use carom_mechanics::State;

const MAGIC: &[u8; 8] = b"CAROMSTA";
const HASH: usize = 32;

/// The bytes of a file.
///
/// # Errors
/// If the state cannot be encoded.
pub(crate) fn encoded(state: &State) -> Result<Vec<u8>, String> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(postcard::to_stdvec(state).map_err(|e| e.to_string())?);
    bytes.extend(blake3::hash(&bytes).as_bytes());
    Ok(bytes)
}

/// The state of a file.
///
/// # Errors
/// Why it is not one.
pub(crate) fn read(path: &Path) -> Result<State, String> {
    let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
    let body = bytes.len().checked_sub(HASH).filter(|_| bytes.starts_with(MAGIC));
    let body = body.ok_or_else(|| "it is not a state written by `carom reduce`".to_owned())?;
    if blake3::hash(&bytes[..body]).as_bytes()[..] != bytes[body..] {
        return Err("its checksum is wrong".to_owned());
    }
    postcard::from_bytes(&bytes[MAGIC.len()..body])
        .map_err(|_| "it was written by another version of Carom".to_owned())
}
