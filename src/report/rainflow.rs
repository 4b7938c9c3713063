//! Rainflow cycles of a tension (ASTM E1049-85, 5.4.4), counted as the rows come, and the damage they do by a T–N curve
//!
//! N = k·R^-m cycles to failure, R being the range of a cycle (twice its amplitude) over the breaking load; damage adds up (Palmgren and
//! Miner). What stays open when the tension ends counts as half cycles.

/// A cycle of a tension, or half of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// From its smallest to its largest tension [N].
    pub range: f64,
    /// Middle of the two [N].
    pub mean: f64,
    /// 1, or 0.5 for half a cycle.
    pub count: f64,
}

/// Counts the cycles of a tension that is told value by value.
#[derive(Debug, Clone, Default)]
pub struct Rainflow {
    /// Turning points that are not yet part of a counted cycle, in time; the last one may still move on.
    open: Vec<f64>,
    counted: Vec<Cycle>,
}

impl Rainflow {
    /// The next value [N]; what is not finite is passed over.
    pub fn push(&mut self, value: f64) {
        if !value.is_finite() || self.open.last() == Some(&value) {
            return;
        }
        if let [.., before, last] = self.open[..]
            && (value > last) == (last > before)
        {
            // Still on the way up, or down.
            self.open.pop();
        } else {
            self.close();
        }
        self.open.push(value);
    }

    /// The cycles so far, those that are still open as half cycles. An open one reaches to the last value told.
    pub fn cycles(&self) -> Vec<Cycle> {
        let mut all = self.clone();
        all.close();
        let halves = all.open.windows(2).map(|pair| cycle(pair[0], pair[1], 0.5));
        all.counted.iter().copied().chain(halves).collect()
    }

    /// Counts what the last turning point closes: the range before the last, where it is no larger than the last.
    fn close(&mut self) {
        while let [.., a, b, c] = self.open[..]
            && (c - b).abs() >= (b - a).abs()
        {
            let last = self.open.len() - 1;
            if last == 2 {
                // The range begins where the tension began: half a cycle.
                self.counted.push(cycle(a, b, 0.5));
                self.open.remove(0);
            } else {
                self.counted.push(cycle(a, b, 1.0));
                self.open.drain(last - 2..last);
            }
        }
    }
}

fn cycle(a: f64, b: f64, count: f64) -> Cycle {
    Cycle { range: (b - a).abs(), mean: 0.5 * (a + b), count }
}

/// What cycles do to a line type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damage {
    /// Number of cycles, halves as halves.
    pub cycles: f64,
    /// Largest range [N]; 0 without cycles.
    pub largest_range: f64,
    /// Range that does the same damage with the same number of cycles [N]; 0 without cycles.
    pub equivalent_range: f64,
    /// Damage sum [-]: 1 is failure.
    pub damage: f64,
}

/// A T–N curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Exponent [-], > 0.
    pub m: f64,
    /// Cycles to failure at a range as large as the breaking load [-], > 0.
    pub k: f64,
    /// Breaking load that ranges are measured by [N], > 0.
    pub breaking_load: f64,
}

impl Curve {
    /// Cycles of a range [N] to failure: k·(range / breaking load)^-m.
    pub fn cycles_to_failure(&self, range: f64) -> f64 {
        self.k * (range / self.breaking_load).powf(-self.m)
    }

    /// Adds up what cycles do.
    pub fn damage(&self, cycles: &[Cycle]) -> Damage {
        let number: f64 = cycles.iter().map(|cycle| cycle.count).sum();
        let damage: f64 = cycles.iter().map(|cycle| cycle.count / self.cycles_to_failure(cycle.range)).sum();
        let largest_range = cycles.iter().map(|cycle| cycle.range).fold(0.0, f64::max);
        let equivalent_range =
            if number > 0.0 { self.breaking_load * (damage * self.k / number).powf(self.m.recip()) } else { 0.0 };
        Damage { cycles: number, largest_range, equivalent_range, damage }
    }
}
