//! What any program needs: work that can be cancelled, random numbers, units, words, hashes. It knows
//! nothing of plans.

pub mod hash;
pub mod natural_order;
pub mod numbers;
pub mod random;
pub mod units;
pub mod wording;
pub mod work;
