//! What any program needs: cancellable work, random numbers, units, wording, hashes, lists. Knows nothing of
//! plans.

pub mod file_name;
pub mod hash;
pub mod lists;
pub mod natural_order;
pub mod numbers;
pub mod random;
pub mod separated;
pub mod units;
pub mod wording;
pub mod work;
