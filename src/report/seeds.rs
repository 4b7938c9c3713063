//! One summary over the seeds of a sea: maxima by seed, and the most probable maximum from the maxima of all of them

use crate::report::extremes::{Maxima, Weibull};
use crate::report::record::Record;
use crate::report::statistics::{self, Extreme, Figures, SectionDamage};
use crate::scene::types::Scene;
use serde::Serialize;

/// What is kept of the run of one seed.
#[derive(Debug, Clone)]
pub struct Seed {
    /// The seed.
    pub seed: u64,
    /// From when to when the rows count [s].
    pub stretch: [f64; 2],
    /// Per line, the fairlead and the anchor: figures, and the maxima between mean up-crossings.
    pub lines: Vec<[(Figures, Maxima); 2]>,
    /// Per line, the damage at the ends of its sections.
    pub damage: Vec<Vec<SectionDamage>>,
    /// What the run had to say, beyond what the scene had.
    pub warnings: Vec<String>,
}

impl Seed {
    /// Of a run that is over; `None` where it came to no row that counts.
    pub fn of(seed: u64, record: &Record) -> Option<Seed> {
        let of = statistics::of(record)?;
        Some(Seed {
            seed,
            stretch: [of.from, of.to],
            lines: of.lines.into_iter().map(|ends| ends.map(|end| (end.figures, end.maxima))).collect(),
            damage: record.lines.iter().map(|line| statistics::damage(record, line)).collect(),
            warnings: record.warnings().into_iter().skip(record.scene_warnings.len()).collect(),
        })
    }
}

/// A seed whose run ended early.
#[derive(Debug, Clone, Serialize)]
pub struct Unfinished {
    /// The seed.
    pub seed: u64,
    /// Why.
    pub error: String,
}

/// `summary.json` of several seeds.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    program: &'static str,
    title: &'a str,
    scene: &'a str,
    /// Whether all seeds that were asked for reached their duration.
    completed: bool,
    /// The seeds that did, in the order asked for.
    seeds: Vec<u64>,
    /// Those that did not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unfinished: Vec<Unfinished>,
    /// Those that were not begun.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_begun: Vec<u64>,
    duration: f64,
    /// From when to when the rows of each seed count [s].
    from: Option<f64>,
    to: Option<f64>,
    /// Per line of the scene.
    pub lines: Vec<Line<'a>>,
    warnings: Vec<String>,
}

/// One line over the seeds.
#[derive(Debug, Serialize)]
pub struct Line<'a> {
    /// Its name.
    pub name: &'a str,
    /// At the fairlead.
    pub tension: Option<End>,
    /// At the anchor.
    pub anchor_tension: Option<End>,
    /// Damage of all seeds together.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fatigue: Vec<SectionDamage>,
}

/// The tension of one end of a line over the seeds.
#[derive(Debug, Serialize)]
pub struct End {
    /// Mean of all rows of all seeds [N].
    mean: f64,
    /// Their standard deviation [N].
    std: f64,
    /// Their skewness.
    skewness: f64,
    /// The largest value of each seed [N], in the order of `seeds`.
    pub max_by_seed: Vec<f64>,
    /// Mean of these [N].
    pub mean_of_max: f64,
    /// Their standard deviation [N], divided by one less than their number; 0 of one seed.
    pub std_of_max: f64,
    /// The largest of all [N].
    pub max: f64,
    /// Its seed.
    pub max_seed: u64,
    /// Its time [s].
    max_time: f64,
    /// The most probable maximum of 3 h from the maxima of all seeds.
    #[serde(flatten)]
    pub extreme: Extreme,
}

/// What was asked for, and how it went.
pub struct Asked<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Name of its file.
    pub file: &'a str,
    /// Warnings of the scene.
    pub warnings: &'a [String],
    /// Seeds whose runs ended early.
    pub unfinished: Vec<Unfinished>,
    /// Seeds that were not begun.
    pub not_begun: Vec<u64>,
}

/// The summary over the seeds that are done.
pub fn summary<'a>(asked: Asked<'a>, done: &[Seed]) -> Summary<'a> {
    let lines = asked.scene.lines.iter().enumerate().map(|(line, of)| Line {
        name: &of.name,
        tension: end(done, line, 0),
        anchor_tension: end(done, line, 1),
        fatigue: fatigue(asked.scene, done, line),
    });
    let of_seeds = done.iter().flat_map(|of| of.warnings.iter().map(|warning| format!("seed {}: {warning}", of.seed)));
    Summary {
        program: concat!("moorline ", env!("CARGO_PKG_VERSION")),
        title: &asked.scene.title,
        scene: asked.file,
        completed: asked.unfinished.is_empty() && asked.not_begun.is_empty(),
        seeds: done.iter().map(|of| of.seed).collect(),
        duration: asked.scene.run.duration,
        from: done.first().map(|of| of.stretch[0]),
        to: done.first().map(|of| of.stretch[1]),
        lines: lines.collect(),
        warnings: asked.warnings.iter().cloned().chain(of_seeds).collect(),
        unfinished: asked.unfinished,
        not_begun: asked.not_begun,
    }
}

/// One end of a line; `None` where no seed is done.
fn end(done: &[Seed], line: usize, end: usize) -> Option<End> {
    let figures = || done.iter().map(|of| &of.lines[line][end].0);
    let number = done.len() as f64;
    let average = |value: &dyn Fn(&Figures) -> f64| figures().map(value).sum::<f64>() / number;
    // All seeds have as many rows.
    let mean = average(&|of| of.mean);
    let variance = average(&|of| of.std.powi(2) + (of.mean - mean).powi(2));
    let third = average(&|of| {
        let aside = of.mean - mean;
        of.skewness * of.std.powi(3) + 3.0 * aside * of.std.powi(2) + aside.powi(3)
    });
    let mean_of_max = average(&|of| of.max);
    let spread = average(&|of| (of.max - mean_of_max).powi(2));
    let largest = done.iter().rev().max_by(|a, b| a.lines[line][end].0.max.total_cmp(&b.lines[line][end].0.max))?;
    let maxima = Maxima::together(done.iter().map(|of| &of.lines[line][end].1));
    Some(End {
        mean,
        std: variance.sqrt(),
        skewness: if variance > 0.0 { third / variance.powf(1.5) } else { 0.0 },
        max_by_seed: figures().map(|of| of.max).collect(),
        mean_of_max,
        std_of_max: if number > 1.0 { (spread * number / (number - 1.0)).sqrt() } else { 0.0 },
        max: largest.lines[line][end].0.max,
        max_seed: largest.seed,
        max_time: largest.lines[line][end].0.max_time,
        extreme: Extreme::of(mean, &maxima, &Weibull::fit(&maxima.above)),
    })
}

/// The damage of all seeds at the ends of a line's sections.
fn fatigue(scene: &Scene, done: &[Seed], line: usize) -> Vec<SectionDamage> {
    let places = done.first().map_or(0, |of| of.damage[line].len());
    let place = |place: usize| {
        let all = || done.iter().map(|of| &of.damage[line][place]);
        let first = all().next()?;
        let m = scene.line_types.get(&first.line_type)?.fatigue?.m;
        let cycles: f64 = all().map(|of| of.cycles).sum();
        let powers: f64 = all().map(|of| of.cycles * of.equivalent_range.powf(m)).sum();
        let sum = SectionDamage {
            duration: all().map(|of| of.duration).sum(),
            cycles,
            largest_range: all().map(|of| of.largest_range).fold(0.0, f64::max),
            equivalent_range: if cycles > 0.0 { (powers / cycles).powf(m.recip()) } else { 0.0 },
            damage: all().map(|of| of.damage).sum(),
            damage_per_year: all().map(|of| of.damage_per_year).sum::<f64>() / done.len() as f64,
            ..first.clone()
        };
        Some(sum)
    };
    (0..places).filter_map(place).collect()
}
