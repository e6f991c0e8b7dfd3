//! A small random number generator: the same seed gives the same numbers on every machine and in every
//! version of the program, which no library promises for its default generator.

/// xoshiro256++ (Blackman and Vigna 2019), seeded by `splitmix64` as its authors advise.
#[derive(Clone, Debug)]
pub struct Random {
    state: [u64; 4],
}

/// One step of `splitmix64` (Steele, Lea and Flood 2014).
fn splitmix64(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Random {
    /// A generator from a seed. Any seed will do, consecutive ones included.
    pub fn new(seed: u64) -> Self {
        let mut state = seed;
        Self { state: std::array::from_fn(|_| splitmix64(&mut state)) }
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        let [a, b, c, d] = self.state;
        let result = a.wrapping_add(d).rotate_left(23).wrapping_add(a);
        let c = c ^ a;
        let d = d ^ b;
        self.state = [a ^ d, b ^ c, c ^ (self.state[1] << 17), d.rotate_left(45)];
        result
    }

    /// A uniform number in 0..1, with 53 random bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A uniform number in `0..count`; 0 if `count` is 0. The bias is below count / 2^64.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// A sample of the standard normal distribution: mean 0, standard deviation 1 (polar method,
    /// Marsaglia and Bray 1964).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let squared = u * u + v * v;
            if squared > 0.0 && squared < 1.0 {
                return u * (-2.0 * squared.ln() / squared).sqrt();
            }
        }
    }

    /// Shuffles a slice (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// The seed for one part of a task (a fold, say), so that the parts can run in any order.
pub fn seed_of_part(seed: u64, part: usize) -> u64 {
    let mut state = seed;
    let base = splitmix64(&mut state);
    let mut state = base ^ part as u64;
    splitmix64(&mut state)
}

#[cfg(test)]
mod tests {
    use crate::base::random::*;

    /// The reference implementation's first numbers from the state 1, 2, 3, 4.
    #[test]
    fn gives_the_numbers_of_the_reference_implementation() {
        let mut random = Random { state: [1, 2, 3, 4] };
        assert_eq!([random.bits(), random.bits(), random.bits()], [41_943_041, 58_720_359, 3_588_806_011_781_223]);
    }

    #[test]
    fn normal_deviates_have_the_moments_of_the_distribution() {
        let mut random = Random::new(11);
        let n = 100_000;
        let values: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let moment = |power: i32| values.iter().map(|value| value.powi(power)).sum::<f64>() / f64::from(n);
        // Four standard deviations of the sample moments of a normal distribution.
        let error = |variance: f64| 4.0 * (variance / f64::from(n)).sqrt();
        assert!(moment(1).abs() < error(1.0));
        assert!((moment(2) - 1.0).abs() < error(2.0));
        assert!((moment(4) - 3.0).abs() < error(96.0));
    }

    #[test]
    fn numbers_fill_their_range_evenly() {
        let mut random = Random::new(7);
        let mut counts = [0; 5];
        for _ in 0..50_000 {
            counts[random.below(5)] += 1;
        }
        // Five standard deviations of a binomial with n = 50000, p = 0.2.
        assert!(counts.iter().all(|&count: &i32| (count - 10_000).abs() < 450), "{counts:?}");
        assert_eq!(random.below(0), 0);
        let mut items: Vec<usize> = (0..100).collect();
        random.shuffle(&mut items);
        assert_ne!(items, (0..100).collect::<Vec<_>>());
        items.sort_unstable();
        assert_eq!(items, (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn parts_have_seeds_of_their_own() {
        let mut seeds: Vec<u64> = (0..4).flat_map(|seed| (0..100).map(move |part| seed_of_part(seed, part))).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 400);
    }
}
