//! The part of the page that tells of a random sea and of fatigue: tables, and the numbers behind its three diagrams

use crate::report::record::Record;
use crate::report::statistics::{self, EndStatistics, OUTPUTS, SectionDamage, Statistics};
use crate::report::units::{ForceUnit, sim_time};
use crate::report::welch::Spectrum;
use serde::Serialize;
use std::fmt::Write;

/// Most points of a curve: what a screen can show.
const POINTS: usize = 300;
/// The largest maxima are all shown; of the others so many.
const LARGEST: usize = 60;
/// Mean periods before and after the largest tension, and the shortest such time [s]: a line that rings has short periods.
const PERIODS: f64 = 4.0;
const SHORTEST: f64 = 20.0;
/// Share of the variance that the diagram of the spectrum shows.
const SHOWN: f64 = 0.998;
/// The ends of a line.
pub const ENDS: [&str; 2] = ["fairlead", "anchor"];

/// What the page draws of one end of a line.
#[derive(Debug, Serialize)]
pub struct End {
    /// The line, by its number.
    line: usize,
    end: &'static str,
    mean: f64,
    /// Density [N²/Hz] over frequencies from 0, `step` [Hz] apart.
    step: f64,
    density: Vec<f64>,
    /// Maxima [N], rising, and the share of all maxima that exceeds each.
    maxima: Vec<f64>,
    exceedance: Vec<f64>,
    /// Scale [N], shape, threshold [N above the mean], offset, most probable maximum [N] and its interval.
    law: Option<[f64; 7]>,
    /// Whether the maxima follow the law.
    follows: bool,
    /// Times [s] and tensions [N] about the largest.
    event: [Vec<f64>; 2],
}

/// The numbers behind the diagrams; none where the run has no statistics.
pub fn data(record: &Record) -> Vec<End> {
    let Some(statistics) = statistics::of(record) else { return Vec::new() };
    let lines = statistics.lines.iter().enumerate();
    lines.flat_map(|(line, ends)| (0..2).map(|end| of_end(record, line, end, &ends[end])).collect::<Vec<_>>()).collect()
}

fn of_end(record: &Record, line: usize, end: usize, of: &EndStatistics) -> End {
    let figures = &of.figures;
    let (step, density) = of.spectrum.as_ref().map_or((1.0, Vec::new()), shown);
    let (maxima, exceedance) = exceedance(&of.maxima.above, figures.mean);
    let extreme = &figures.extreme;
    let law = || {
        let (law, [low, high]) = (extreme.weibull?, extreme.interval_90?);
        Some([law.scale, law.shape, law.threshold, law.offset, extreme.most_probable_maximum?, low, high].map(short))
    };
    let reach = (PERIODS * figures.mean_period.unwrap_or(0.0)).max(SHORTEST);
    let near = |time: f64| record.times.partition_point(|row| *row < time);
    let rows = near(figures.max_time - reach)..near(figures.max_time + reach).min(record.times.len());
    let every = rows.len().div_ceil(POINTS).max(1);
    // The largest is among the rows that are left.
    let offset = (near(figures.max_time) - rows.start) % every;
    let rows: Vec<usize> = rows.skip(offset).step_by(every).collect();
    End {
        line,
        end: ENDS[end],
        mean: short(figures.mean),
        step,
        density,
        maxima,
        exceedance,
        law: law(),
        follows: of.law.is_ok_and(|law| law.follows),
        event: [
            rows.iter().map(|row| short(record.times[*row])).collect(),
            rows.iter().map(|row| short(OUTPUTS[end](&record.lines[line].rows[*row]))).collect(),
        ],
    }
}

/// The part of a spectrum that holds nearly all of the variance, in few rows: step [Hz] and density.
fn shown(spectrum: &Spectrum) -> (f64, Vec<f64>) {
    let rows = (spectrum.rows_with(SHOWN) + 2).min(spectrum.density.len());
    let every = rows.div_ceil(POINTS);
    let mean = |part: &[f64]| short(part.iter().sum::<f64>() / part.len() as f64);
    (spectrum.step * every as f64, spectrum.density[..rows].chunks(every).map(mean).collect())
}

/// Maxima [N] and the share that exceeds each, k - 1/2 of n for the k-th largest; all of the largest, and of the others every so many.
fn exceedance(above: &[f64], mean: f64) -> (Vec<f64>, Vec<f64>) {
    let mut sorted = above.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let number = sorted.len();
    let every = number.div_ceil(POINTS).max(1);
    let kept = (0..number).filter(|rank| *rank < LARGEST || rank % every == 0);
    let mut points: Vec<(f64, f64)> =
        kept.map(|rank| (short(mean + sorted[rank]), short((rank as f64 + 0.5) / number as f64))).collect();
    points.reverse();
    points.into_iter().unzip()
}

/// To six digits, so that the page stays small.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The section of the page; nothing where the run has neither statistics nor cycles. `escaped` makes names fit to stand in HTML.
pub fn section(record: &Record, unit: ForceUnit, escaped: impl Fn(&str) -> String) -> String {
    let statistics = statistics::of(record);
    let damage: Vec<(usize, SectionDamage)> = (0..record.lines.len())
        .flat_map(|line| statistics::damage(record, &record.lines[line]).into_iter().map(move |of| (line, of)))
        .collect();
    if statistics.is_none() && damage.is_empty() {
        return String::new();
    }
    let name = |line: usize| {
        let name = escaped(&record.lines[line].name);
        if record.lines.len() == 1 { String::new() } else { format!("<i class=\"swatch\" data-line=\"{line}\"></i>{name} · ") }
    };
    let mut html = String::from("<section id=\"random-section\">");
    if let Some(statistics) = &statistics {
        html += "<div class=\"head\"><h2>Statistics</h2><div class=\"controls noprint\"><select id=\"end\" aria-label=\"Line and \
                 end\"></select></div></div>";
        table(&mut html, statistics, unit, &name);
        html += "<figure><figcaption><b>Worst event</b> <span id=\"event-text\"></span></figcaption><div id=\"event\" \
                 class=\"plot\"></div></figure><figure><figcaption><b>Spectrum</b></figcaption><div id=\"spectrum\" \
                 class=\"plot\"></div></figure><figure><figcaption><b>Exceedance of maxima</b> <span id=\"maxima-text\"></span>\
                 </figcaption><div id=\"maxima\" class=\"plot\"></div></figure>";
    }
    if !damage.is_empty() {
        fatigue(&mut html, &damage, unit, &name, &escaped);
    }
    html + "</section>"
}

/// A row per line and end.
fn table(html: &mut String, statistics: &Statistics, unit: ForceUnit, name: &dyn Fn(usize) -> String) {
    let head = ["mean", "std. deviation", "skewness", "largest", "most probable of 3 h", "peak period"];
    let head: String = head.iter().map(|word| format!("<th>{word}</th>")).collect();
    let _ = write!(html, "<div class=\"scroll\"><table><thead><tr><th></th>{head}</tr></thead><tbody>");
    for (line, ends) in statistics.lines.iter().enumerate() {
        for (end, of) in ENDS.iter().zip(ends) {
            let figures = &of.figures;
            let [mean, std, max] = [figures.mean, figures.std, figures.max].map(|value| unit.number(value));
            let extreme = &figures.extreme;
            let most = match (extreme.most_probable_maximum, extreme.interval_90) {
                (Some(value), Some([low, high])) => {
                    format!("{} <small>{} to {}</small>", unit.number(value), unit.number(low), unit.number(high))
                }
                _ => "–".to_owned(),
            };
            let period = figures.peak_period.map_or("–".to_owned(), |period| format!("{period:.1} s"));
            let _ = write!(
                html,
                "<tr><td>{}{end} [{}]</td><td>{mean}</td><td>{std}</td><td>{:.2}</td><td>{max} <small>at {} s</small></td>\
                 <td>{most}</td><td>{period}</td></tr>",
                name(line),
                unit.symbol,
                figures.skewness,
                sim_time(figures.max_time),
            );
        }
    }
    let _ = write!(
        html,
        "</tbody></table></div><p class=\"hint\">From {} s to {} s. {}; in small print: with 90 % probability, as far as the fit is \
         uncertain.</p>",
        sim_time(statistics.from),
        sim_time(statistics.to),
        statistics::METHOD,
    );
}

/// A row per section end with a T–N curve.
fn fatigue(
    html: &mut String,
    damage: &[(usize, SectionDamage)],
    unit: ForceUnit,
    name: &dyn Fn(usize) -> String,
    escaped: &dyn Fn(&str) -> String,
) {
    let head = ["at s", "cycles", "largest range", "equivalent range", "damage", "damage in a year of this"];
    let head: String = head.iter().map(|word| format!("<th>{word}</th>")).collect();
    let _ = write!(html, "<h2>Fatigue</h2><div class=\"scroll\"><table><thead><tr><th></th>{head}</tr></thead><tbody>");
    for (line, of) in damage {
        let [largest, equivalent] = [of.largest_range, of.equivalent_range].map(|range| unit.show(range));
        let _ = write!(
            html,
            "<tr><td>{}{}</td><td>{:.1} m</td><td>{:.1}</td><td>{largest}</td><td>{equivalent}</td><td>{:.3e}</td><td>{:.3e}</td></tr>",
            name(*line),
            escaped(&of.line_type),
            of.s,
            of.cycles,
            of.damage,
            of.damage_per_year,
        );
    }
    *html += "</tbody></table></div><p class=\"hint\">Rainflow cycles (ASTM E1049) of the tension at both ends of each section, halves \
              as halves; N = k·R<sup>−m</sup>, R being range over breaking load. No safety factor is in these figures.</p>";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exceedance_keeps_the_largest_and_stays_small() {
        let above: Vec<f64> = (0..20_000).map(|k| ((k * 7919) % 20_000) as f64).collect();
        let (maxima, shares) = exceedance(&above, 1000.0);
        assert!(maxima.len() < POINTS + LARGEST + 1, "{}", maxima.len());
        assert!(maxima.is_sorted() && shares.iter().rev().is_sorted());
        assert_eq!((maxima[maxima.len() - 1], shares[shares.len() - 1]), (20_999.0, 2.5e-5));
        assert_eq!(exceedance(&[], 0.0), (vec![], vec![]));
    }

    #[test]
    fn a_spectrum_is_shown_with_its_variance_in_few_rows() {
        let density = (0..4097).map(|k| (-(k as f64 - 900.0).powi(2) / 2.0e4).exp()).collect();
        let spectrum = Spectrum { step: 0.001, density, segments: 1 };
        let (step, density) = shown(&spectrum);
        assert!(density.len() <= POINTS);
        let variance = step * density.iter().sum::<f64>();
        assert!((variance / spectrum.variance() - 1.0).abs() < 0.01, "{variance}");
    }
}
