//! Numbers without pattern from a seed: the same on every machine.

/// A generator of 64 bits at a time (splitmix64; Steele, Lea & Flood 2014).
pub struct Numbers {
    state: u64,
}

impl Numbers {
    /// The numbers of one case of a sweep: those of another have nothing to do with them.
    pub fn of(seed: u64, index: u64) -> Self {
        let mut numbers = Self { state: seed ^ index.wrapping_mul(0xd1b5_4a32_d192_ed03) };
        numbers.state = numbers.bits() ^ index;
        numbers
    }

    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Between two numbers.
    pub fn between(&mut self, least: f64, most: f64) -> f64 {
        let share = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        least + (most - least) * share
    }

    /// Between two powers of ten, each decade as likely as the other.
    pub fn decades(&mut self, least: f64, most: f64) -> f64 {
        10_f64.powf(self.between(least, most))
    }

    /// A whole number, both ends included.
    pub fn count(&mut self, least: usize, most: usize) -> usize {
        least + usize::try_from(self.bits() % (most - least + 1) as u64).expect("a small number")
    }

    /// Whether something of a probability comes about.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    /// One of several.
    pub fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.count(0, choices.len() - 1)]
    }
}
