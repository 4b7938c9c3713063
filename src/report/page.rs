//! `report.html`: one file that opens offline and asks nobody for anything. Facts and tables are written here, so that they are there
//! without JavaScript; the plots are drawn by the scripts in `page/` from the data of `page_data`.

use crate::report::page_data;
use crate::report::record::{LineRecord, Record, Statistics};
use crate::report::statistics_page;
use crate::report::units::{ForceUnit, count, sim_time, wall_time};
use crate::scene::types::Motion;
use std::fmt::Write;

const TEMPLATE: &str = include_str!("page/page.html");
const CSS: &str = include_str!("page/page.css");
const JS: &str = concat!(
    include_str!("page/data.js"),
    include_str!("page/plots.js"),
    include_str!("page/shape.js"),
    include_str!("page/random.js"),
    include_str!("page/page.js")
);
/// uPlot 1.6.32 (npm `uplot`, dist/uPlot.iife.min.js), unchanged: small, fast with 10⁵ points, and it needs nothing else.
const UPLOT_JS: &str = include_str!("page/uplot.js");
pub(super) const UPLOT_CSS: &str = include_str!("page/uplot.css");
const UPLOT_LICENCE: &str = include_str!("page/uplot.LICENSE");

/// The page of a run, finished or not.
pub fn html(record: &Record) -> String {
    let unit = record.force_unit();
    let page_data = page_data::json(record, unit);
    fill(TEMPLATE, |name| match name {
        "program" => escaped(concat!("moorline ", env!("CARGO_PKG_VERSION"))),
        "title" => escaped(if record.scene.title.is_empty() { &record.file } else { &record.scene.title }),
        "facts" => facts(record),
        "banner" => banner(record),
        "warnings" => warnings(&record.warnings()),
        "figures" => figures(record, unit),
        "thinning" => thinning(record, page_data.rows),
        "random" => statistics_page::section(record, unit, escaped),
        "summary" => summary(record, unit),
        "solver" => solver(record),
        "scene" => escaped(&serde_json::to_string_pretty(&record.scene).unwrap_or_default()),
        // In a script element only `<` could end it; in JSON it stands in strings alone.
        "data" => page_data.text.replace('<', "\\u003c"),
        "css" => CSS.to_string(),
        "js" => JS.to_string(),
        "uplot_css" => UPLOT_CSS.to_string(),
        "uplot_licence" => UPLOT_LICENCE.to_string(),
        // Its first line is a comment with an address; the licence stands in the style sheet.
        "uplot_js" => uplot(),
        _ => String::new(),
    })
}

/// The plot library, as it may stand in a page.
pub(super) fn uplot() -> String {
    UPLOT_JS.split_once("*/").map_or(UPLOT_JS, |(_, code)| code.trim()).to_string()
}

/// Replaces each `{{name}}` of a template once; what is put in is not looked at again.
pub(super) fn fill(template: &str, value: impl Fn(&str) -> String) -> String {
    let mut pieces = template.split("{{");
    let mut page = pieces.next().unwrap_or_default().to_string();
    for piece in pieces {
        match piece.split_once("}}") {
            Some((name, rest)) => {
                page += &value(name);
                page += rest;
            }
            None => page += piece,
        }
    }
    page
}

/// Text as it may stand between tags and in quoted attributes.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            other => safe.push(other),
        }
    }
    safe
}

/// The line under the title: file, lines, depth, motion, duration, scheme.
fn facts(record: &Record) -> String {
    let scene = &record.scene;
    let length: f64 = record.lines.iter().map(|line| line.length).sum();
    let motion = match &scene.motion {
        Motion::Fixed => "fixed fairleads".to_string(),
        Motion::Sinusoidal { period, .. } => format!("sinusoidal motion, period {period} s"),
        Motion::File { path } => format!("motion after {path}"),
    };
    let bodies = match (record.bodies.len(), record.points.len()) {
        (0, 0) => String::new(),
        (bodies, 0) => format!(", {}", if bodies == 1 { "1 body".to_string() } else { format!("{bodies} bodies") }),
        (bodies, points) => {
            format!(", {bodies} {}, {}", if bodies == 1 { "body" } else { "bodies" }, count(points, "free point"))
        }
    };
    let facts = [
        record.file.clone(),
        format!("{}, {length} m{bodies}", count(record.lines.len(), "line")),
        format!("{} m of water", scene.environment.depth),
        motion,
        format!("{} s", sim_time(scene.run.duration)),
        format!("{}, tolerance {}", scheme(record), scene.solver.tolerance),
    ];
    facts.iter().map(|fact| format!("<span>{}</span>", escaped(fact))).collect()
}

fn scheme(record: &Record) -> String {
    let name = serde_json::to_value(record.scene.solver.scheme).ok();
    name.as_ref().and_then(|name| name.as_str()).unwrap_or_default().to_string()
}

/// Says that the run ended early, where, and why.
fn banner(record: &Record) -> String {
    let Some(error) = &record.ended_by else { return String::new() };
    let headline = match record.end_time() {
        Some(end) => format!("The run ended at t = {} s of {} s.", sim_time(end), sim_time(record.scene.run.end())),
        None => "There is no static equilibrium to start from; the best state found is shown.".to_string(),
    };
    format!("<div class=\"banner\" role=\"alert\"><b>{}</b>{}</div>", escaped(&headline), escaped(&error.to_string()))
}

fn warnings(warnings: &[String]) -> String {
    if warnings.is_empty() {
        return String::new();
    }
    let items: String = warnings.iter().map(|warning| format!("<li>{}</li>", escaped(warning))).collect();
    format!("<ul class=\"warnings\">{items}</ul>")
}

/// The key figures: those of the line with the largest tension, and what the run cost.
fn figures(record: &Record, unit: ForceUnit) -> String {
    let tension = |line: &LineRecord| line.statistics(|row| row.tension);
    let worst =
        record.lines.iter().filter_map(|line| Some((line, tension(line)?))).max_by(|(_, a), (_, b)| a.max.total_cmp(&b.max));
    let mut html = String::new();
    let mut figure = |name: &str, value: &str, symbol: &str, remark: &str| {
        let [name, value, remark] = [name, value, remark].map(escaped);
        let _ = write!(html, "<div><dt>{name}</dt><dd>{value} <span>{symbol}</span></dd><small>{remark}</small></div>");
    };
    if let Some((line, tension)) = worst {
        let of_line = if record.lines.len() == 1 { "at the fairlead".to_string() } else { line.name.clone() };
        let ratio = |value: f64| {
            if tension.initial > 0.0 { format!(", {:.2} × static", value / tension.initial) } else { String::new() }
        };
        figure("Static tension", &unit.number(tension.initial), unit.symbol, &of_line);
        let at = |time: f64, value: f64| format!("at {} s{}", sim_time(time), ratio(value));
        figure("Largest tension", &unit.number(tension.max), unit.symbol, &at(tension.max_time, tension.max));
        figure("Smallest tension", &unit.number(tension.min), unit.symbol, &at(tension.min_time, tension.min));
        figure("Mean tension", &unit.number(tension.mean), unit.symbol, &format!("std. deviation {}", unit.number(tension.std)));
    }
    if record.times.is_empty() {
        return "<div><dt>Tension</dt><dd>not known</dd><small>there is no equilibrium</small></div>".to_string();
    }
    let solver_time = wall_time(record.solver_seconds);
    let (value, symbol) = solver_time.split_once(' ').unwrap_or((&solver_time, ""));
    let speed = record.times_real_time().map_or(String::new(), |factor| format!("{factor:.0} times real time"));
    figure("Solver time", value, symbol, &speed);
    html
}

/// Says so where the page holds fewer rows than the table.
fn thinning(record: &Record, shown: usize) -> String {
    let rows = record.times.len();
    if shown == rows {
        String::new()
    } else {
        format!("{shown} of {rows} rows are drawn; every peak of the tensions is among them.")
    }
}

/// A row per line and quantity: static, largest, smallest, mean, standard deviation.
fn summary(record: &Record, unit: ForceUnit) -> String {
    let mut rows = String::new();
    for (index, line) in record.lines.iter().enumerate() {
        let swatch = if record.lines.len() == 1 {
            String::new()
        } else {
            format!("<i class=\"swatch\" data-line=\"{index}\"></i>{} · ", escaped(&line.name))
        };
        let force = |value: f64| unit.number(value);
        let metres = |value: f64| format!("{value:.2}");
        rows += &row(&format!("{swatch}fairlead tension [{}]", unit.symbol), line.statistics(|row| row.tension), force);
        rows += &row(&format!("{swatch}anchor tension [{}]", unit.symbol), line.statistics(|row| row.anchor_tension), force);
        rows += &row(&format!("{swatch}length on the bed [m]"), line.statistics(|row| row.grounded_length), metres);
    }
    format!(
        "<div class=\"scroll\"><table><thead><tr><th></th><th>static</th><th>largest</th><th>smallest</th><th>mean</th>\
         <th>std. deviation</th></tr></thead><tbody>{rows}</tbody></table></div>"
    )
}

/// A row of the summary; `heading` is HTML.
fn row(heading: &str, statistics: Option<Statistics>, show: impl Fn(f64) -> String) -> String {
    let Some(of) = statistics else { return format!("<tr><td>{heading}</td><td colspan=\"5\">not known</td></tr>") };
    let at = |time: f64| format!("<small>at {} s</small>", sim_time(time));
    let [initial, max, min, mean, std] = [of.initial, of.max, of.min, of.mean, of.std].map(show);
    format!(
        "<tr><td>{heading}</td><td>{initial}</td><td>{max} {}</td><td>{min} {}</td><td>{mean}</td><td>{std}</td></tr>",
        at(of.max_time),
        at(of.min_time)
    )
}

/// The work of the solver and what it cost.
fn solver(record: &Record) -> String {
    let counters = record.counters();
    let per = |count: usize| if count > 0 { wall_time(record.line_seconds / count as f64) } else { "–".to_string() };
    let iterations: usize = record.lines.iter().filter_map(|line| line.statics).map(|statics| statics.iterations).sum();
    let pairs = [
        ("Scheme", scheme(record)),
        ("Elements", record.elements().to_string()),
        ("Time steps", counters.steps.to_string()),
        ("Rejected steps", counters.rejected_steps.to_string()),
        ("Newton iterations", counters.newton_iterations.to_string()),
        ("Factorisations", counters.factorisations.to_string()),
        ("Element iterations", counters.element_iterations.to_string()),
        ("Iterations in statics", iterations.to_string()),
        ("Time for statics", wall_time(record.statics_seconds)),
        ("Time for dynamics", wall_time(record.solver_seconds)),
        ("Per time step", per(counters.steps)),
        ("Per element iteration", per(counters.element_iterations)),
    ];
    let list: String =
        pairs.iter().map(|(name, value)| format!("<div><dt>{name}</dt><dd>{}</dd></div>", escaped(value))).collect();
    format!("<dl class=\"pairs\">{list}</dl>")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use crate::report::sample;
    use crate::scene::types::Scene;

    fn record(title: &str) -> Record {
        let mut scene: Scene =
            serde_json::from_str(include_str!("../../examples/lindahl-sjoberg.json")).expect("the built-in scene");
        scene.title = title.to_string();
        Record::new(&scene, "a<b>.json", Vec::new(), 0.4)
    }

    #[test]
    fn what_is_filled_in_is_not_filled_again() {
        let page = fill("<{{a}}|{{b}}>", |name| if name == "a" { "{{b}}".to_string() } else { "B".to_string() });
        assert_eq!(page, "<{{b}}|B>");
    }

    #[test]
    fn a_title_cannot_break_out_of_the_page() {
        let title = "</script><script>alert(1)</script><img src=x onerror='alert(2)'>{{js}}";
        let page = html(&record(title));
        assert!(!page.contains("<script>alert"), "the title became a script");
        assert!(!page.contains("<img"), "the title became an image");
        assert_eq!(page.matches("</script>").count(), 3, "data, plot library, page");
        assert!(page.contains("&lt;/script&gt;"), "the title is shown as it was written");
        assert!(page.contains("a&lt;b&gt;.json"));
    }

    #[test]
    fn the_page_asks_nobody_for_anything() {
        let page = html(&record("plain"));
        for address in ["http://", "https://", "src=", "@import", "fetch(", "url("] {
            assert!(!page.contains(address), "{address} in the page");
        }
        assert!(page.contains("Copyright (c) 2022 Leon Sorokin"), "the licence of the plot library");
    }

    #[test]
    fn a_run_that_ended_early_says_so_on_top() {
        let mut record = record("plain");
        assert!(!html(&record).contains("role=\"alert\""));
        record.add_row(37.4, &[sample::outputs(37.4, 1.0e6)], &[Vec::new()]);
        record.ended_by = Some(Error::Interrupted { time: 37.4 });
        let page = html(&record);
        assert!(page.contains("role=\"alert\"><b>The run ended at t = 37.4 s of 120 s.</b>stopped by the user"), "banner");
    }
}
