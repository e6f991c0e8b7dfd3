//! FNV-1a, 64 bits (Fowler, Noll and Vo): the same in every version and on every machine. It tells things
//! apart; it does not guard against forgery.

/// Where a hash starts: the offset basis.
pub const START: u64 = 0xcbf2_9ce4_8422_2325;

/// Goes on with a hash. Two texts that differ in one byte never have the same: each step is invertible.
pub fn fnv1a(start: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(start, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
