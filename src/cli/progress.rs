//! The progress bar: simulated time, tension now, time left. Drawn on standard error, and only where that is a terminal.

use crate::report::units::{ForceUnit, sim_time};
use crate::solve::simulation::Outputs;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A progress bar over the rows of a run; it goes away when dropped.
pub struct Progress {
    bar: ProgressBar,
    end: String,
    /// One of many runs that share a bar: it only adds its rows.
    part: bool,
}

impl Progress {
    /// A bar for `rows` rows to the simulated time `end`; none is drawn where `quiet`.
    pub fn new(rows: usize, end: f64, quiet: bool) -> Progress {
        Progress { bar: bar(rows.saturating_sub(1), quiet), end: sim_time(end), part: false }
    }

    /// One bar for many seeds of so many rows each.
    pub fn of_seeds(seeds: usize, rows: usize, quiet: bool) -> Progress {
        let progress = Progress { bar: bar(seeds * rows.saturating_sub(1), quiet), end: String::new(), part: false };
        progress.show_seeds(0, seeds);
        progress
    }

    /// The part of one of the seeds in it.
    pub fn part(&self) -> Progress {
        Progress { bar: self.bar.clone(), end: String::new(), part: true }
    }

    /// Shows how many seeds are done.
    pub fn show_seeds(&self, done: usize, of: usize) {
        self.bar.set_message(format!("{done} of {of} seeds"));
    }

    /// Shows that a row is written: its time [s] and the largest of the lines' tensions.
    pub fn show(&self, row: usize, time: f64, lines: &[Outputs]) {
        if self.bar.is_hidden() {
            return;
        }
        if self.part {
            return if row > 0 {
                self.bar.inc(1)
            };
        }
        let tension = lines.iter().map(|line| line.tension).fold(0.0, f64::max);
        let unit = ForceUnit::for_largest(tension);
        self.bar.set_message(format!("{} of {} s, tension {}", sim_time(time), self.end, unit.show(tension)));
        self.bar.set_position(row as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if !self.part {
            self.bar.finish_and_clear();
        }
    }
}

fn bar(length: usize, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(length as u64), target);
    if let Ok(style) = ProgressStyle::with_template("  {bar:36.cyan/dim} {msg}, {eta} left") {
        bar.set_style(style.progress_chars("━╸─"));
    }
    bar
}
