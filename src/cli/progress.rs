//! The progress bar: simulated time, tension now, time left. Drawn on standard error, and only where that is a terminal.

use crate::report::units::{ForceUnit, sim_time};
use crate::solve::simulation::Outputs;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A progress bar over the rows of a run; it goes away when dropped.
pub struct Progress {
    bar: ProgressBar,
    end: String,
}

impl Progress {
    /// A bar for `rows` rows to the simulated time `end`; none is drawn where `quiet`.
    pub fn new(rows: usize, end: f64, quiet: bool) -> Progress {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(rows.saturating_sub(1) as u64), target);
        if let Ok(style) = ProgressStyle::with_template("  {bar:36.cyan/dim} {msg}, {eta} left") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        Progress { bar, end: sim_time(end) }
    }

    /// Shows that a row is written: its time [s] and the largest of the lines' tensions.
    pub fn show(&self, row: usize, time: f64, lines: &[Outputs]) {
        if self.bar.is_hidden() {
            return;
        }
        let tension = lines.iter().map(|line| line.tension).fold(0.0, f64::max);
        let unit = ForceUnit::for_largest(tension);
        self.bar.set_message(format!("{} of {} s, tension {}", sim_time(time), self.end, unit.show(tension)));
        self.bar.set_position(row as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
