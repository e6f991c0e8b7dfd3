//! FNV-1a, 64 bits (Fowler, Noll and Vo): the same in every version and on every machine. For telling
//! things apart; not cryptographically secure. SHA-256 where others compare it.

use sha2::{Digest as _, Sha256};

/// The initial hash: FNV's offset basis.
pub const START: u64 = 0xcbf2_9ce4_8422_2325;

/// Continues a hash with more bytes. Texts that differ in one byte never collide: each step is
/// invertible.
pub fn fnv1a(start: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(start, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// SHA-256 in hexadecimal digits, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
