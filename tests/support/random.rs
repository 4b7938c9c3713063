//! Random numbers of the tests.

/// A small generator, so that the scenes are the same everywhere (xorshift, Marsaglia 2003).
pub struct Random(u64);

impl Random {
    /// Every seed has its own row of numbers.
    pub fn new(seed: u64) -> Random {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        (0..5).for_each(|_| {
            random.share();
        });
        random
    }

    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Evenly distributed in the logarithm.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Each component within a size.
    pub fn triple(&mut self, size: f64) -> [f64; 3] {
        [(); 3].map(|()| size * self.between(-1.0, 1.0))
    }
}
