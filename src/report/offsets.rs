//! Force, moment and tensions over the offset of a body: a table and a page.

use crate::report::page::{UPLOT_CSS, escaped, fill, uplot};
use nalgebra::Vector3;
use std::fmt::Write;

const TEMPLATE: &str = include_str!("page/offsets.html");

/// Offset, force [N] and moment [N·m] about the reference point, tension at each fairlead [N].
pub type Row = (f64, [Vector3<f64>; 2], Vec<f64>);

/// What the mooring does to a body that is held aside.
pub struct Curve {
    /// Title of the scene.
    pub title: String,
    /// Name of the body.
    pub body: String,
    /// Which way it is held: `x`, …, `yaw`.
    pub way: &'static str,
    /// Unit of the offset.
    pub unit: &'static str,
    /// Names of the lines.
    pub lines: Vec<String>,
    /// Offset, force [N] and moment [N·m] about the reference point, tension at each fairlead [N].
    pub rows: Vec<Row>,
}

/// The table: `offset`, six loads, and the tension of each line.
pub fn csv(curve: &Curve) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let loads = ["force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"];
    let head = std::iter::once(format!("offset_{}", curve.unit)).chain(loads.map(String::from));
    // In memory: this does not fail.
    let _ = writer.write_record(head.chain(curve.lines.iter().map(|line| format!("{line}.tension"))));
    for (offset, loads, tensions) in &curve.rows {
        let numbers = std::iter::once(offset).chain(loads.iter().flatten()).chain(tensions);
        let _ = writer.write_record(numbers.map(|number| format!("{number:?}")));
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The page: three plots that open offline.
pub fn html(curve: &Curve) -> String {
    let column = |of: &dyn Fn(&Row) -> f64| -> Vec<f64> { curve.rows.iter().map(of).collect() };
    let mut plots = Vec::new();
    let x = column(&|row| row.0);
    for (number, (name, unit)) in [("force", "kN"), ("moment", "kN m")].into_iter().enumerate() {
        let series: Vec<_> = ["x", "y", "z"]
            .into_iter()
            .enumerate()
            .map(|(axis, label)| serde_json::json!({"label": format!("{name} {label}"), "v": column(&|row| row.1[number][axis] / 1.0e3)}))
            .collect();
        plots.push(serde_json::json!({"title": format!("{} of the mooring [{unit}]", name), "series": series}));
    }
    let tensions: Vec<_> = curve
        .lines
        .iter()
        .enumerate()
        .map(|(line, name)| serde_json::json!({"label": name, "v": column(&|row| row.2[line] / 1.0e3)}))
        .collect();
    plots.push(serde_json::json!({"title": "tension at the fairleads [kN]", "series": tensions}));
    let data =
        serde_json::json!({"x": x, "axis": format!("offset in {} [{}]", curve.way, curve.unit), "plots": plots}).to_string();
    let mut title = curve.title.clone();
    let _ = write!(title, "{}offsets of {} in {}", if title.is_empty() { "" } else { ": " }, curve.body, curve.way);
    fill(TEMPLATE, |name| match name {
        "title" => escaped(&title),
        "program" => escaped(concat!("moorline ", env!("CARGO_PKG_VERSION"))),
        "data" => data.replace('<', "\\u003c"),
        "uplot_css" => UPLOT_CSS.to_string(),
        "uplot_js" => uplot(),
        _ => String::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_a_row_for_each_offset_and_the_page_no_address() {
        let rows = vec![(-1.0, [Vector3::x(), Vector3::z()], vec![5.0e5]), (1.0, [-Vector3::x(), -Vector3::z()], vec![6.0e5])];
        let (title, body, lines) = ("a <b> & c".to_string(), "ship".to_string(), vec!["bow, port".to_string()]);
        let curve = Curve { title, body, way: "x", unit: "m", lines, rows };
        let table = csv(&curve);
        assert!(
            table.starts_with("offset_m,force_x,") && table.contains("\"bow, port.tension\"") && table.lines().count() == 3,
            "{table}"
        );
        let page = html(&curve);
        assert!(
            page.contains("a &lt;b&gt; &amp; c") && !page.contains("http://") && !page.contains("https://"),
            "{}",
            &page[..200]
        );
    }
}
