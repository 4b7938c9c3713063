//! Element lengths where the user gives none: fine where the line lands on the bed, coarse elsewhere.
//!
//! Wanted length at s: on the swept touchdown zone a multiple of the decay length √(T/k); elsewhere a share of the line, no longer
//! than a fifth of the transverse wave that the motion sends along it, a part of the radius of curvature and, near the surface of a
//! sea, a part of its waves. Measured on the built-in case: with 2.8 decay lengths on the zone and 4 times coarser elements
//! elsewhere, the end tension is good to 0.05 %. A line that snaps gets elements of nearly one length.

use nalgebra::Vector3;

/// A place on the line where the wanted element length is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Arc length from the anchor [m].
    pub s: f64,
    /// Wanted element length there [m].
    pub size: f64,
}

/// What the grading knows of the line in one position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Arc length from the anchor [m].
    pub s: f64,
    /// Effective tension [N].
    pub tension: f64,
    /// Slope r' [-].
    pub slope: Vector3<f64>,
    /// Height z [m].
    pub height: f64,
    /// Whether the bed (or, for a floating line, the surface) carries the line here.
    pub carried: bool,
}

/// Rules of the grading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Unstretched length [m].
    pub length: f64,
    /// Refinement: 1 for a tolerance of 1e-3, larger for finer meshes.
    pub refinement: f64,
    /// Stiffness of what carries the line [Pa].
    pub stiffness: f64,
    /// Mass that moves sideways [kg/m].
    pub mass: f64,
    /// Bending stiffness [N·m²].
    pub ei: f64,
    /// Period of the motion or of the waves, the shorter [s]; 0: unknown or none.
    pub period: f64,
    /// Wave number of the sea [1/m]; 0: none.
    pub wave_number: f64,
    /// The motion is so fast that the line goes slack and snaps.
    pub snaps: bool,
    /// The line is slack: its bights go where it moves, and are narrower than any element.
    pub slack: bool,
    /// Shortest element [m].
    pub shortest: f64,
}

/// Elements per line where it hangs free, at refinement 1.
const HANGING: f64 = 15.0;
/// Elements per line where it is carried, at refinement 1.
const CARRIED: f64 = 7.0;
/// Elements per line that snaps, at refinement 1: what runs along it after a snap is as sharp everywhere.
const SNAPPING: f64 = 55.0;
/// Elements per slack line, at refinement 1.
const SLACK: f64 = 18.0;
/// Decay lengths per element on the touchdown zone, at refinement 1.
const DECAY_LENGTHS: f64 = 2.8;
/// Elements per transverse wave length.
const PER_WAVE: f64 = 5.0;
/// Longest element at the surface of waves, times their wave number; it may grow as e^(-kz/2).
const IN_WAVES: f64 = 0.8;
/// Largest ratio of neighbouring element lengths.
const GROWTH: f64 = 2.5;

/// Wanted element lengths along the line, from samples of the line in several positions of its fairlead.
pub fn stations(rules: &Rules, positions: &[Vec<Sample>]) -> Vec<Station> {
    let count = positions.first().map_or(0, Vec::len);
    if rules.slack && !rules.snaps {
        let share = rules.length / (SLACK * rules.refinement);
        let here = |sample: &Sample| Station { s: sample.s, size: share.min(sea_size(rules, sample)) };
        return positions.first().into_iter().flatten().map(here).collect();
    }
    let zone = touchdown_zone(rules, positions);
    let mut stations: Vec<Station> = (0..count)
        .map(|i| {
            let here = positions.iter().map(|samples| &samples[i]);
            let size = here.map(|sample| free_size(rules, sample)).fold(rules.length, f64::min);
            Station { s: positions[0][i].s, size }
        })
        .collect();
    for (i, station) in stations.iter_mut().enumerate() {
        if let Some((from, to, tension)) = zone
            && station.s >= from
            && station.s <= to
        {
            station.size = station.size.min(DECAY_LENGTHS * decay_length(rules, tension) / rules.refinement);
        }
        let turn = positions.iter().map(|samples| curvature(samples, i)).fold(0.0, f64::max);
        station.size = station.size.min(0.35 / turn.max(1e-30) / rules.refinement.sqrt()).max(rules.shortest);
    }
    limit_growth(&mut stations);
    stations
}

/// √(T/k), or the bending length (4 EI/k)^¼ where that is longer.
fn decay_length(rules: &Rules, tension: f64) -> f64 {
    (tension / rules.stiffness).sqrt().max((4.0 * rules.ei / rules.stiffness).powf(0.25))
}

fn free_size(rules: &Rules, sample: &Sample) -> f64 {
    let count = match (rules.snaps, sample.carried) {
        (true, _) => SNAPPING,
        (false, true) => CARRIED,
        (false, false) => HANGING,
    };
    let share = rules.length / (rules.refinement * count);
    let wave = (sample.tension.max(0.0) / rules.mass).sqrt() * rules.period / (PER_WAVE * rules.refinement.sqrt());
    let sea = sea_size(rules, sample);
    if rules.period > 0.0 && !sample.carried { share.min(wave).min(sea) } else { share.min(sea) }
}

/// Longest element in waves [m].
fn sea_size(rules: &Rules, sample: &Sample) -> f64 {
    let k = rules.wave_number;
    if k > 0.0 { IN_WAVES / (k * rules.refinement.sqrt()) * (-0.5 * k * sample.height.min(0.0)).exp() } else { f64::INFINITY }
}

/// From where to where the point of touchdown moves, with a margin of three decay lengths, and the least tension there.
fn touchdown_zone(rules: &Rules, positions: &[Vec<Sample>]) -> Option<(f64, f64, f64)> {
    let mut zone: Option<(f64, f64, f64)> = None;
    for samples in positions {
        for pair in samples.windows(2) {
            if pair[0].carried != pair[1].carried {
                let tension = pair[0].tension.min(pair[1].tension);
                let margin = 3.0 * decay_length(rules, tension);
                let (from, to) = (pair[0].s - margin, pair[1].s + margin);
                zone = Some(match zone {
                    None => (from, to, tension),
                    Some(old) => (old.0.min(from), old.1.max(to), old.2.min(tension)),
                });
            }
        }
    }
    zone
}

/// Turn of the tangent per length at a sample [1/m]. Two samples at one place are the two sides of a kink, which is none.
fn curvature(samples: &[Sample], i: usize) -> f64 {
    let here = &samples[i];
    let beside = |k: usize| Some(&samples[k.min(samples.len() - 1)]).filter(|other| other.s != here.s).unwrap_or(here);
    let (a, b) = (beside(i.saturating_sub(1)), beside(i + 1));
    if b.s <= a.s { 0.0 } else { a.slope.normalize().metric_distance(&b.slope.normalize()) / (b.s - a.s) }
}

/// A size may grow along the line by no more than GROWTH per element.
fn limit_growth(stations: &mut [Station]) {
    let rate = (GROWTH - 1.0) / GROWTH;
    for i in 1..stations.len() {
        let limit = stations[i - 1].size + rate * (stations[i].s - stations[i - 1].s);
        stations[i].size = stations[i].size.min(limit);
    }
    for i in (1..stations.len()).rev() {
        let limit = stations[i].size + rate * (stations[i].s - stations[i - 1].s);
        stations[i - 1].size = stations[i - 1].size.min(limit);
    }
}

/// Element lengths of a section between two arc lengths, following the wanted lengths, at least `least` of them.
pub fn divide(stations: &[Station], from: f64, to: f64, least: usize) -> Vec<f64> {
    // Number of elements up to each station: the integral of 1/size.
    const PIECES: usize = 400;
    let width = (to - from) / PIECES as f64;
    let mut passed = vec![0.0; PIECES + 1];
    for k in 0..PIECES {
        passed[k + 1] = passed[k] + width / size_at(stations, from + (k as f64 + 0.5) * width);
    }
    let total = passed[PIECES];
    let count = (total - 0.1).ceil().max(least as f64) as usize;
    let mut nodes = vec![from];
    for i in 1..count {
        let goal = total * i as f64 / count as f64;
        let k = passed.partition_point(|x| *x < goal).clamp(1, PIECES);
        let share = (goal - passed[k - 1]) / (passed[k] - passed[k - 1]);
        nodes.push(from + (k as f64 - 1.0 + share) * width);
    }
    nodes.push(to);
    nodes.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn size_at(stations: &[Station], s: f64) -> f64 {
    let after = stations.partition_point(|station| station.s < s);
    match (after.checked_sub(1).map(|i| stations[i]), stations.get(after)) {
        (Some(a), Some(b)) if b.s > a.s => a.size + (b.size - a.size) * (s - a.s) / (b.s - a.s),
        (Some(a), _) => a.size,
        (None, Some(b)) => b.size,
        (None, None) => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform wanted length: equal elements; a tenfold finer middle: the sum is the section and neighbours differ by less than 3.
    #[test]
    fn elements_follow_the_wanted_lengths() {
        let flat = [Station { s: 0.0, size: 10.0 }, Station { s: 100.0, size: 10.0 }];
        let lengths = divide(&flat, 0.0, 100.0, 1);
        assert_eq!(lengths.len(), 10);
        assert!(lengths.iter().all(|l| (l - 10.0).abs() < 1e-9));
        let mut graded: Vec<Station> =
            (0..=100).map(|k| Station { s: k as f64, size: if (40..60).contains(&k) { 1.0 } else { 20.0 } }).collect();
        limit_growth(&mut graded);
        let lengths = divide(&graded, 0.0, 100.0, 1);
        assert!((lengths.iter().sum::<f64>() - 100.0).abs() < 1e-9);
        assert!(lengths.windows(2).all(|pair| (pair[0] / pair[1]).max(pair[1] / pair[0]) < 3.0), "{lengths:?}");
        assert!(lengths.iter().cloned().fold(f64::INFINITY, f64::min) < 1.2);
    }
}
