//! What a designer takes home from a random sea: of every line and end, the figures of the tension, its spectrum, and the most probable
//! maximum of three hours; and the damage of the cycles of those sections that have a T–N curve.

use crate::report::extremes::{Maxima, NoFit, STORM, Weibull};
use crate::report::rainflow::Damage;
use crate::report::record::{LineRecord, Record, SectionEnd};
use crate::report::welch::{self, Spectrum};
use crate::scene::bodies::{BodyMotion, PointMotion};
use crate::scene::types::{Motion, Scene};
use crate::sea::drawing;
use crate::solve::simulation::Outputs;
use serde::Serialize;

/// A year [s].
const YEAR: f64 = 365.25 * 86_400.0;
/// How the most probable maximum is found, in words for those who read it.
pub const METHOD: &str = "Weibull law, fitted by maximum likelihood to the highest maxima between mean up-crossings; the most probable \
                          maximum is what one maximum in as many as 3 h hold exceeds; the interval is that of the fit";

/// What is added where the law is not that of the maxima.
const UNFIT: &str = "The maxima do not follow the law well: judge by the diagram of their exceedance";

/// The statistics of a run.
#[derive(Debug, Clone)]
pub struct Statistics {
    /// From when the rows count [s].
    pub from: f64,
    /// Time of the last row that counts [s].
    pub to: f64,
    /// Per line, in the order of the scene, the fairlead and the anchor.
    pub lines: Vec<[EndStatistics; 2]>,
}

/// What the tension at one end of a line amounts to.
#[derive(Debug, Clone)]
pub struct EndStatistics {
    /// The figures.
    pub figures: Figures,
    /// The spectrum; `None` of a run of a few rows.
    pub spectrum: Option<Spectrum>,
    /// The maxima between mean up-crossings.
    pub maxima: Maxima,
    /// The law fitted to them.
    pub law: Result<Weibull, NoFit>,
}

/// The figures of a tension; those of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// Mean [N].
    pub mean: f64,
    /// Standard deviation [N].
    pub std: f64,
    /// Skewness [-]: 0 where highs are like lows, positive where highs reach farther.
    pub skewness: f64,
    /// Largest value [N].
    pub max: f64,
    /// Its time [s].
    pub max_time: f64,
    /// Mean time between up-crossings of the mean [s].
    pub mean_period: Option<f64>,
    /// Period of the largest density of the spectrum [s].
    pub peak_period: Option<f64>,
    /// The most probable maximum.
    #[serde(flatten)]
    pub extreme: Extreme,
}

/// The most probable maximum of 3 h, and what it is made from; those of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Extreme {
    /// Number of maxima between mean up-crossings.
    pub maxima: usize,
    /// The most probable maximum of 3 h [N]; none where no law fits.
    pub most_probable_maximum: Option<f64>,
    /// Where it lies with 90 % probability, as far as the fit is uncertain [N].
    pub interval_90: Option<[f64; 2]>,
    /// The law of the maxima above the mean.
    pub weibull: Option<Law>,
    /// How it was found, or why it was not.
    pub method: String,
}

/// A Weibull law; that of `summary.json`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Law {
    /// Shape [-]: 2 for a Gaussian process, less where extremes reach farther.
    pub shape: f64,
    /// Its standard error.
    pub shape_error: f64,
    /// Scale [N].
    pub scale: f64,
    /// Its standard error [N].
    pub scale_error: f64,
    /// The maxima above this one [N above the mean] are fitted.
    pub threshold: f64,
    /// Which share of all maxima these are.
    pub share: f64,
    /// Of all maxima, the share exp(offset - (x/scale)^shape) is larger than x [N above the mean], from the threshold on.
    pub offset: f64,
}

impl Extreme {
    /// The most probable maximum of maxima about a mean [N], by the law that was fitted to them.
    pub fn of(mean: f64, maxima: &Maxima, law: &Result<Weibull, NoFit>) -> Extreme {
        let none = Extreme {
            maxima: maxima.above.len(),
            most_probable_maximum: None,
            interval_90: None,
            weibull: None,
            method: String::new(),
        };
        match (law, maxima.period()) {
            (Ok(law), Some(period)) => {
                let most_probable = law.most_probable(STORM / period);
                Extreme {
                    most_probable_maximum: Some(mean + most_probable.value),
                    interval_90: Some(most_probable.interval.map(|above| mean + above)),
                    weibull: Some(Law {
                        shape: law.shape,
                        shape_error: law.shape_error,
                        scale: law.scale,
                        scale_error: law.scale_error,
                        threshold: law.threshold,
                        share: law.share,
                        offset: law.offset,
                    }),
                    method: if law.follows { METHOD.to_owned() } else { format!("{METHOD}. {}", UNFIT) },
                    ..none
                }
            }
            (Err(reason), _) => Extreme { method: format!("none: {reason}"), ..none },
            (_, None) => Extreme { method: format!("none: {}", NoFit::Few(0)), ..none },
        }
    }
}

/// The damage at one end of a section; that of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SectionDamage {
    /// The section, counted from the fairlead.
    pub section: usize,
    /// Its line type.
    pub line_type: String,
    /// Where along the line [m from the fairlead].
    pub s: f64,
    /// Time over which cycles were counted [s].
    pub duration: f64,
    /// Number of cycles, halves as halves.
    pub cycles: f64,
    /// Largest range [N].
    pub largest_range: f64,
    /// Range that does the same damage with the same number of cycles [N].
    pub equivalent_range: f64,
    /// Damage sum [-]: 1 is failure.
    pub damage: f64,
    /// Damage sum of a year that is all like the run [-].
    pub damage_per_year: f64,
}

impl SectionDamage {
    /// What cycles counted over some time [s] do at an end of a section.
    pub fn of(end: &SectionEnd, damage: Damage, duration: f64) -> SectionDamage {
        SectionDamage {
            section: end.section,
            line_type: end.line_type.clone(),
            s: end.s,
            duration,
            cycles: damage.cycles,
            largest_range: damage.largest_range,
            equivalent_range: damage.equivalent_range,
            damage: damage.damage,
            damage_per_year: if duration > 0.0 { damage.damage * YEAR / duration } else { 0.0 },
        }
    }
}

/// The damage of a line so far, at both ends of every section whose type has a T–N curve; empty before the first cycle can be counted.
pub fn damage(record: &Record, line: &LineRecord) -> Vec<SectionDamage> {
    let duration = record.end_time().map_or(0.0, |end| end - record.statistics_from);
    let counted = line.fatigue.iter().filter(|_| duration > 0.0);
    counted.map(|end| SectionDamage::of(end, end.curve.damage(&end.rainflow.cycles()), duration)).collect()
}

/// Whether what moves the lines is irregular, so that statistics mean something: a random sea, several waves, or a motion from a file.
fn irregular(scene: &Scene) -> bool {
    let seas = drawing::seas(&scene.environment);
    let sea = seas.len() > 1 || seas.iter().any(|sea| sea.random || sea.waves.len() > 1);
    let bodies = scene.bodies.iter().any(|body| matches!(body.motion, BodyMotion::File { .. }));
    let points = scene.points.iter().any(|point| matches!(point.motion, PointMotion::File { .. }));
    sea || bodies || points || matches!(scene.motion, Motion::File { .. })
}

/// Rows that count, a constant step apart, and that step [s].
pub fn rows_that_count(record: &Record) -> (std::ops::Range<usize>, f64) {
    let step = record.scene.run.output_step;
    let times = &record.times;
    let from = times.partition_point(|time| *time < record.statistics_from);
    // The end of a run may lie between the multiples of the step.
    let odd = times.len() > from + 1 && times[times.len() - 1] - times[times.len() - 2] < 0.999 * step;
    (from..times.len() - usize::from(odd), step)
}

/// The statistics of a run under an irregular sea or motion; `None` of other runs, and before there are rows that count.
pub fn of(record: &Record) -> Option<Statistics> {
    let (rows, step) = rows_that_count(record);
    if !irregular(&record.scene) || rows.len() < 2 {
        return None;
    }
    let times = &record.times[rows.clone()];
    let values = |line: &LineRecord| OUTPUTS.map(|output| line.rows[rows.clone()].iter().map(output).collect::<Vec<f64>>());
    let mut lines: Vec<[EndStatistics; 2]> =
        record.lines.iter().map(|line| values(line).map(|values| end_statistics(&values, times, step))).collect();
    // One resolution for all, so that spectra stand side by side.
    let periods = lines.iter().flatten().filter_map(|end| end.maxima.period());
    let period = periods.reduce(f64::max).unwrap_or(f64::INFINITY);
    for (line, ends) in record.lines.iter().zip(&mut lines) {
        for (end, values) in ends.iter_mut().zip(values(line)) {
            end.spectrum = welch::spectrum(&values, step, period);
            end.figures.peak_period = end.spectrum.as_ref().and_then(Spectrum::peak).map(f64::recip);
        }
    }
    Some(Statistics { from: times[0], to: times[times.len() - 1], lines })
}

/// The tensions that have statistics: at the fairlead and at the anchor.
pub const OUTPUTS: [fn(&Outputs) -> f64; 2] = [|row| row.tension, |row| row.anchor_tension];

/// The statistics of values `step` [s] apart, at times [s]; without the spectrum.
fn end_statistics(values: &[f64], times: &[f64], step: f64) -> EndStatistics {
    let number = values.len() as f64;
    let mean = values.iter().sum::<f64>() / number;
    let moment = |power: i32| values.iter().map(|value| (value - mean).powi(power)).sum::<f64>() / number;
    let variance = moment(2);
    let skewness = if variance > 0.0 { moment(3) / variance.powf(1.5) } else { 0.0 };
    // The first of equals.
    let larger = |most: (usize, f64), (row, value): (usize, &f64)| if *value > most.1 { (row, *value) } else { most };
    let largest = values.iter().enumerate().fold((0, f64::MIN), larger);
    let maxima = Maxima::of(values, step, mean);
    let law = Weibull::fit(&maxima.above);
    let figures = Figures {
        mean,
        std: variance.sqrt(),
        skewness,
        max: largest.1,
        max_time: times[largest.0],
        mean_period: maxima.period(),
        peak_period: None,
        extreme: Extreme::of(mean, &maxima, &law),
    };
    EndStatistics { figures, spectrum: None, maxima, law }
}
