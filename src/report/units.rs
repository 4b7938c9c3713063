//! The units in which people read forces, times and counts; files hold SI units alone.

/// The unit in which all forces of one table or page are shown, so that they compare at a glance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceUnit {
    /// Its symbol: N, kN or MN.
    pub symbol: &'static str,
    /// One of it in newtons.
    pub newtons: f64,
    /// Decimals that give the largest force at least four significant digits.
    pub decimals: usize,
}

impl ForceUnit {
    /// The unit for forces up to `largest` [N]: kN from 1 kN, MN from 10 MN.
    pub fn for_largest(largest: f64) -> ForceUnit {
        let size = if largest.is_finite() { largest.abs() } else { 0.0 };
        let (symbol, newtons) = match size {
            size if size >= 1.0e7 => ("MN", 1.0e6),
            size if size >= 1.0e3 => ("kN", 1.0e3),
            _ => ("N", 1.0),
        };
        let digits_before_the_point = (size / newtons).max(1.0).log10().floor() as usize + 1;
        ForceUnit { symbol, newtons, decimals: 5_usize.saturating_sub(digits_before_the_point).min(3) }
    }

    /// A force [N] as a number of this unit, without the symbol.
    pub fn number(&self, force: f64) -> String {
        let text = format!("{:.*}", self.decimals, force / self.newtons);
        // What rounds to zero has no sign.
        if text.bytes().all(|byte| b"-0.".contains(&byte)) { text.replace('-', "") } else { text }
    }

    /// A force [N] with the symbol.
    pub fn show(&self, force: f64) -> String {
        format!("{} {}", self.number(force), self.symbol)
    }
}

/// A time of the computer [s] with two to three digits: `850 µs`, `1.2 ms`, `3.4 s`, `12 min 5 s`.
pub fn wall_time(seconds: f64) -> String {
    let (value, symbol) = match seconds {
        s if s < 1.0e-3 => (s * 1.0e6, "µs"),
        s if s < 1.0 => (s * 1.0e3, "ms"),
        s if s < 60.0 => (s, "s"),
        s => return format!("{} min {:.0} s", (s / 60.0).floor(), (s % 60.0).floor()),
    };
    if value < 10.0 { format!("{value:.1} {symbol}") } else { format!("{value:.0} {symbol}") }
}

/// A time of the simulation [s] without needless zeros, to a microsecond.
pub fn sim_time(seconds: f64) -> String {
    let text = format!("{seconds:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_string() } else { text.to_string() }
}

/// A count with its noun: `1 step`, `2 steps`.
pub fn count(number: usize, noun: &str) -> String {
    if number == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_shown_in_the_unit_people_say() {
        assert_eq!(ForceUnit::for_largest(1_329_610.0).show(1_329_610.0), "1329.6 kN");
        assert_eq!(ForceUnit::for_largest(2.05e7).show(1.0e6), "1.000 MN");
        assert_eq!(ForceUnit::for_largest(66.7).show(-66.7), "-66.700 N");
        assert_eq!(ForceUnit::for_largest(1.0e6).number(-1.0e-9), "0.0");
        assert_eq!(ForceUnit::for_largest(f64::NAN).symbol, "N");
    }

    #[test]
    fn times_keep_the_digits_that_matter() {
        assert_eq!(wall_time(0.0521), "52 ms");
        assert_eq!(wall_time(0.00123), "1.2 ms");
        assert_eq!(wall_time(725.4), "12 min 5 s");
        assert_eq!(sim_time(37.400000000000006), "37.4");
        assert_eq!(sim_time(120.0), "120");
    }
}
