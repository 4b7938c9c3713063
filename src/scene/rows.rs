//! Rows of numbers of a CSV file with named columns, the first of them time, which rises or, where rows make profiles, does not fall.
//!
//! A first line with the names is allowed, and so are empty lines and comments after `#`.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

use crate::error::Error;

/// A row: its line in the file, from 1, and its numbers.
pub(super) type Row<const N: usize> = (usize, [f64; N]);

/// Refuses a value in a line of a file.
pub(super) fn refuse<T>(file: &str, line: usize, value: impl Into<String>, allowed: impl Into<String>) -> Result<T, Error> {
    Err(Error::Value { file: file.into(), place: format!("line {line}"), value: value.into(), allowed: allowed.into() })
}

/// The rows of a text; `units` says what the columns are in, `what` what the rows are of.
pub(super) fn read<const N: usize>(
    text: &str,
    file: &str,
    columns: [&str; N],
    units: &str,
    what: &str,
) -> Result<Vec<Row<N>>, Error> {
    let rows = read_profiles(text, file, columns, units, what)?;
    if let Some(pair) = rows.windows(2).find(|pair| !(pair[1].1[0] > pair[0].1[0])) {
        let allowed = format!("times must rise, and the row before has t = {}", pair[0].1[0]);
        return refuse(file, pair[1].0, format!("t = {}", pair[1].1[0]), allowed);
    }
    Ok(rows)
}

/// The same where several rows may have one time.
pub(super) fn read_profiles<const N: usize>(
    text: &str,
    file: &str,
    columns: [&str; N],
    units: &str,
    what: &str,
) -> Result<Vec<Row<N>>, Error> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let names = columns.join(",");
    let mut rows: Vec<Row<N>> = Vec::new();
    let mut first = true;
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        let number = index + 1;
        let fields: Vec<&str> = content.split(',').map(|field| field.trim().trim_matches('"').trim()).collect();
        if fields.len() != N {
            let found = format!("a line of {} columns", fields.len());
            return refuse(file, number, found, format!("it must be {N} columns {names}"));
        }
        let heading = std::mem::take(&mut first) && fields[0].parse::<f64>().is_err();
        if heading {
            let known = |(field, name): (&&str, &&str)| {
                field.eq_ignore_ascii_case(name) || (*name == "t" && field.eq_ignore_ascii_case("time"))
            };
            match fields.iter().zip(&columns).position(|pair| !known(pair)) {
                Some(wrong) => {
                    let allowed = format!("the columns must be {names} in this order, in {units}");
                    return refuse(file, number, format!("column {} \"{}\"", wrong + 1, fields[wrong]), allowed);
                }
                None => continue,
            }
        }
        let mut row = [0.0; N];
        for ((value, field), name) in row.iter_mut().zip(&fields).zip(columns) {
            match field.parse::<f64>() {
                Ok(read) if read.abs() <= 1.0e15 => *value = read,
                _ => return refuse(file, number, format!("{name} = \"{field}\""), "it must be a finite number"),
            }
        }
        rows.push((number, row));
    }
    if rows.len() < 2 {
        let found = format!("a file of {} rows", rows.len());
        return refuse(file, text.lines().count().max(1), found, format!("{what} needs at least 2 rows {names}"));
    }
    Ok(rows)
}
