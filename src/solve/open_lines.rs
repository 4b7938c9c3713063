//! Which lines of a network a stage still looks at.
//!
//! The end of a line that moves needs more iterations than a line far from it. A line is done when what its increments leave is below the
//! tolerance, as of a line alone, and so is what those of the bodies and points leave that it hangs on. From then on its elements are not looked
//! at. What it has moved by since they were, all of it, is counted, and must stay below the same bounds, or they are looked at again: so
//! nothing is left unseen at the end of a stage that would not be left of a line alone.

use crate::algebra::real::MOST_LANES;
use crate::rod::state::{COMPONENTS, Field};
use crate::rod::system::{Links, System};
use nalgebra::Vector3;

/// What increments are measured against.
pub struct Sizes {
    /// Weight of an increment in u [-].
    pub c_u: f64,
    /// Length that scales positions [m].
    pub length: f64,
    /// How much more an increment of bodies and points counts.
    pub emphasis: f64,
    /// Scaled increment that counts as converged.
    pub tolerance: f64,
}

/// What a stage knows of lines, and of bodies and points (masters).
pub struct OpenLines {
    links: Links,
    /// Masters of each line, and lines of each master.
    masters_of: Vec<Vec<usize>>,
    lines_of: Vec<Vec<usize>>,
    /// Whether the elements of each line are looked at.
    open: Vec<bool>,
    /// Of each line, by how much it has moved since, scaled; and the same of its masters.
    unseen: Vec<f64>,
    carried: Vec<f64>,
    /// Of each master, its last increment, scaled.
    last: Vec<f64>,
    /// Whether a stage showed how each line contracts, and each master.
    seen: Vec<bool>,
    /// Forces on hanging ends [N].
    forces: Vec<Vector3<f64>>,
    /// Nodes of lines that are looked at, first and behind the last.
    runs: Vec<(usize, usize)>,
    /// No line is done before all are.
    pub lasting: bool,
}

/// What is left to do.
pub enum Left {
    /// Nothing.
    Nothing,
    /// Bodies and points are not as close yet to where they will be as they must be, all else is.
    Masters,
    /// Lines are not yet where they will be.
    Lines,
}

/// What an iteration that contracts like `rate` leaves of an error, if its last increment was of a size.
pub fn left(size: f64, rate: f64) -> f64 {
    size * (rate / (1.0 - rate).max(0.1)).min(1.0)
}

impl OpenLines {
    /// Room for a network.
    pub fn new(links: &Links) -> OpenLines {
        let (lines, masters) = (links.ranges.len(), links.masters.len());
        let (mut masters_of, mut lines_of) = (vec![Vec::new(); lines], vec![Vec::new(); masters]);
        for link in &links.links {
            masters_of[link.line].push(link.master);
            lines_of[link.master].push(link.line);
        }
        OpenLines {
            links: links.clone(),
            masters_of,
            lines_of,
            open: vec![true; lines],
            unseen: vec![f64::INFINITY; lines],
            carried: vec![f64::INFINITY; lines],
            last: vec![f64::INFINITY; masters],
            seen: vec![false; lines + masters],
            forces: vec![Vector3::zeros(); links.links.len()],
            runs: Vec::with_capacity(lines),
            lasting: false,
        }
    }

    /// Before a stage: nothing is known.
    pub fn begin(&mut self) {
        self.open.fill(true);
        self.seen.fill(false);
        self.unseen.fill(f64::INFINITY);
        self.carried.fill(f64::INFINITY);
        self.last.fill(f64::INFINITY);
        self.run();
    }

    /// Lets all lines be looked at in the next iteration.
    pub fn reopen(&mut self) {
        self.open.fill(true);
        self.run();
    }

    /// Puts the lines that are looked at together to runs. Between two of them are nodes enough for a batch of elements to end in; a shorter line
    /// between is looked at too.
    fn run(&mut self) {
        let gap = |from: usize, to: usize| to - from < MOST_LANES;
        let mut end: Option<usize> = None;
        for line in 0..self.open.len() {
            if self.open[line] {
                if let Some(last) = end.filter(|last| gap(self.links.ranges[*last].1, self.links.ranges[line].0)) {
                    self.open[last..line].fill(true);
                }
                end = Some(line);
            }
        }
        self.runs.clear();
        for (line, &(first, last)) in self.links.ranges.iter().enumerate().filter(|(line, _)| self.open[*line]) {
            match self.runs.last_mut().filter(|_| line > 0 && self.open[line - 1]) {
                Some(run) => run.1 = last,
                None => self.runs.push((first, last)),
            }
        }
    }

    /// Number of lines.
    pub fn count(&self) -> usize {
        self.open.len()
    }

    /// Nodes of bodies and points.
    pub fn masters(&self) -> &[usize] {
        &self.links.masters
    }

    /// Whether lines may have been factored at different times.
    pub fn may_differ(&self) -> bool {
        self.links.timeless
    }

    /// Number of lines, and of bodies and points.
    pub fn parts(&self) -> usize {
        self.open.len() + self.last.len()
    }

    /// Nodes of lines that are looked at, first and behind the last, in order.
    pub fn runs(&self) -> &[(usize, usize)] {
        &self.runs
    }

    /// The lines that are looked at, each with its first node and the one behind its last.
    pub fn lines(&self) -> Vec<(usize, usize)> {
        self.links.ranges.iter().zip(&self.open).filter(|(_, open)| **open).map(|(range, _)| *range).collect()
    }

    /// At the end of a stage: lets what is known of the contraction of lines and masters grow by a factor where the stage did not show it, so that a line
    /// whose factor grows old unseen is looked at twice.
    pub fn grow_old(&self, by: f64, rates: &mut [f64]) {
        for (rate, _) in rates.iter_mut().zip(&self.seen).filter(|(rate, seen)| !**seen && **rate < 1.0) {
            *rate = (by * *rate).min(0.99);
        }
    }

    /// Forces on hanging ends, to be brought up to date after an increment [N].
    pub fn forces_mut(&mut self) -> &mut [Vector3<f64>] {
        &mut self.forces
    }

    /// Takes note of the forces on the ends of lines that have been looked at, and lets the others have those that are known of them.
    pub fn take_over(&mut self, residual: &mut Field) {
        for (_, (first, end)) in self.open.iter().zip(&self.links.ranges).filter(|(open, _)| !**open) {
            (0..COMPONENTS).for_each(|c| residual.component_mut(c)[*first..*end].fill(0.0));
        }
        for (link, force) in self.links.links.iter().zip(&mut self.forces) {
            if self.open[link.line] {
                *force = residual.position(link.node);
            } else {
                residual.set_position(link.node, force);
            }
        }
    }

    /// Elements of lines that are not looked at.
    pub fn spared(&self) -> usize {
        self.links.elements.iter().zip(&self.open).filter(|(_, open)| !**open).map(|(elements, _)| elements).sum()
    }

    /// Takes note of an increment, and decides which lines the next iteration looks at. `rates`: how each line, then each master contracts.
    pub fn judge(&mut self, line: &dyn System, increment: &Field, sizes: &Sizes, rates: &mut [f64]) -> Left {
        let scales = [sizes.c_u / sizes.length, sizes.c_u];
        let (of_lines, of_masters) = rates.split_at_mut(self.open.len());
        let contract = |rate: &mut f64, now: f64, before: f64| {
            if before.is_finite() {
                *rate = (now / before).max(0.3 * *rate).min(1.0);
            }
        };
        let (mut masters, mut lines, mut all) = (true, true, true);
        for (number, (last, rate)) in self.last.iter_mut().zip(&mut *of_masters).enumerate() {
            let node = self.links.masters[number];
            let loose = line.loose(increment, number) * scales[0] * sizes.emphasis;
            let as_node = increment.largest_entry(node, node + 1, scales);
            let now = loose.max(as_node);
            if self.lines_of[number].iter().all(|line| self.open[*line]) {
                contract(rate, now, *last);
                self.seen[self.open.len() + number] |= last.is_finite();
            }
            *last = now;
            masters &= left(now, *rate) < sizes.tolerance;
            lines &= left(as_node, *rate) < sizes.tolerance;
        }
        for (number, rate) in of_lines.iter_mut().enumerate() {
            let (first, end) = self.links.ranges[number];
            let now = increment.largest_entry(first, end, scales);
            if self.open[number] {
                contract(rate, now, self.unseen[number]);
                self.seen[number] |= self.unseen[number].is_finite();
                (self.unseen[number], self.carried[number]) = (0.0, 0.0);
            }
            self.unseen[number] += now;
            let on = &self.masters_of[number];
            self.carried[number] += on.iter().map(|master| self.last[*master]).fold(0.0, f64::max);
            let slowest = on.iter().map(|master| of_masters[*master]).fold(0.0, f64::max);
            let own = left(self.unseen[number], *rate) < sizes.tolerance;
            let done = own && left(self.carried[number], slowest) < sizes.tolerance;
            self.open[number] = !done || self.lasting;
            (lines, all) = (lines && own, all && done);
        }
        self.run();
        if all && masters {
            Left::Nothing
        } else if lines {
            Left::Masters
        } else {
            Left::Lines
        }
    }
}
