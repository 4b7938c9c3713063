//! When a run writes: the times of `timeseries.csv` rows and of `nodes.csv` snapshots.

use crate::scene::types::Run;

/// Most snapshots that a run keeps of the line's shape, the first and the last aside.
const SNAPSHOTS: usize = 300;

/// The output times of a run: every `output_step` from its start, and the end of the run even where it is no multiple.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    start: f64,
    duration: f64,
    step: f64,
    whole_steps: usize,
}

impl Schedule {
    /// The schedule of the scene's `run`; durations are ≥ 0 and output steps > 0 there.
    pub fn new(run: &Run) -> Schedule {
        // A duration that is a multiple up to rounding ends with that multiple, not with a sliver of a step.
        let whole_steps = (run.duration / run.output_step * (1.0 + 1.0e-12) + 1.0e-9).floor() as usize;
        Schedule { start: run.start, duration: run.duration, step: run.output_step, whole_steps }
    }

    /// Number of rows, the one at the start included.
    pub fn rows(&self) -> usize {
        let ends_between_multiples = self.duration - self.multiple(self.whole_steps) > 1.0e-9 * self.step.max(self.duration);
        self.whole_steps + 1 + usize::from(ends_between_multiples)
    }

    /// Time of row `row` [s], rows counted from 0.
    pub fn time(&self, row: usize) -> f64 {
        self.start + if row > self.whole_steps { self.duration } else { self.multiple(row) }
    }

    /// Every how many rows a snapshot of the nodes is kept.
    pub fn rows_per_snapshot(&self) -> usize {
        self.whole_steps.div_ceil(SNAPSHOTS).max(1)
    }

    /// Interval of the snapshots [s].
    pub fn snapshot_step(&self) -> f64 {
        self.multiple(self.rows_per_snapshot())
    }

    /// `row` output steps [s]: the decimal number the user means, 0.3 rather than 0.30000000000000004.
    fn multiple(&self, row: usize) -> f64 {
        let product = row as f64 * self.step;
        let decimal = (product * 1.0e9).round() / 1.0e9;
        if (decimal - product).abs() <= 4.0 * f64::EPSILON * product { decimal } else { product }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schedule(duration: f64, output_step: f64) -> Schedule {
        Schedule::new(&Run { duration, start: 0.0, output_step, transient: None })
    }

    #[test]
    fn rows_stand_at_the_decimal_multiples_and_at_the_end() {
        let built_in = schedule(120.0, 0.1);
        assert_eq!(built_in.rows(), 1201);
        assert_eq!(built_in.time(3), 0.3);
        assert_eq!(built_in.time(1200), 120.0);
        let uneven = schedule(1.0, 0.3);
        let times: Vec<f64> = (0..uneven.rows()).map(|row| uneven.time(row)).collect();
        assert_eq!(times, [0.0, 0.3, 0.6, 0.9, 1.0]);
        let thirds = schedule(1.0, 1.0 / 3.0);
        assert_eq!(thirds.rows(), 4);
        assert_eq!(thirds.time(1), 1.0 / 3.0);
    }

    #[test]
    fn a_run_without_duration_has_one_row() {
        assert_eq!(schedule(0.0, 0.1).rows(), 1);
        assert_eq!(schedule(0.0, 0.1).rows_per_snapshot(), 1);
    }

    #[test]
    fn a_run_shorter_than_its_output_step_has_two_rows() {
        assert_eq!(schedule(0.04, 0.1).rows(), 2);
        assert_eq!(schedule(0.04, 0.1).time(1), 0.04);
    }

    #[test]
    fn snapshots_are_a_multiple_of_the_output_step_and_at_most_300() {
        assert_eq!(schedule(120.0, 0.1).rows_per_snapshot(), 4);
        assert_eq!(schedule(120.0, 0.1).snapshot_step(), 0.4);
        assert_eq!(schedule(10.0, 0.1).rows_per_snapshot(), 1);
        assert!(schedule(10_800.0, 0.1).rows() / schedule(10_800.0, 0.1).rows_per_snapshot() <= SNAPSHOTS);
    }
}
