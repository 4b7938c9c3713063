//! Numbers in the columns of Fortran: how `F11.5`, `1PE12.5`, `I3` are written, and how such columns are read.
//!
//! A number stands in its columns or, where they are off, wherever it stands in the order of the line. An exponent may begin with
//! E, D or just its sign.

/// Columns of one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Columns {
    /// Characters before them.
    pub before: usize,
    /// How many.
    pub width: usize,
}

/// `count` columns of `width`, each after a gap, from a column on.
pub fn repeated(before: usize, gap: usize, width: usize, count: usize) -> Vec<Columns> {
    (0..count).map(|k| Columns { before: before + gap + k * (gap + width), width }).collect()
}

/// A number as it stands in a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The text; empty columns are a zero.
    pub text: String,
    /// Column of its first character, from 1.
    pub column: usize,
}

/// What the columns of a line hold.
pub enum Cut {
    /// Numbers, all in their columns.
    InColumns(Vec<Found>),
    /// The first words of the line, one for each number or fewer.
    Words(Vec<Found>),
}

/// Takes a line apart: by columns if these hold whole numbers, else by words.
pub fn cut(line: &str, columns: &[Columns]) -> Cut {
    let characters: Vec<char> = line.chars().collect();
    let words: Vec<Found> = words(&characters).take(columns.len()).collect();
    let whole = columns.iter().all(|at| !cuts(&characters, at.before) && !cuts(&characters, at.before + at.width));
    let fields: Vec<Found> = columns.iter().map(|at| field(&characters, at)).collect();
    let numbers = fields.iter().all(|found| found.text.is_empty() || number(&found.text).is_some());
    let blanks = fields.iter().any(|found| found.text.is_empty());
    let in_words = words.len() == columns.len() && words.iter().all(|word| number(&word.text).is_some());
    // Empty columns are zeros, unless the line has a number for every column: then it is the columns that are off. Numbers that fill
    // their columns touch, and then no word is a number.
    let off = in_words && (blanks || !whole);
    if numbers && !off { Cut::InColumns(fields) } else { Cut::Words(words) }
}

/// Whether a number goes across the border before character `at`.
fn cuts(characters: &[char], at: usize) -> bool {
    let part = |c: Option<&char>| c.is_some_and(|c| c.is_ascii_digit() || *c == '.');
    at > 0 && part(characters.get(at - 1)) && part(characters.get(at))
}

fn field(characters: &[char], at: &Columns) -> Found {
    let end = characters.len().min(at.before + at.width);
    let taken: &[char] = characters.get(at.before..end).unwrap_or_default();
    let blank = taken.iter().take_while(|c| c.is_whitespace()).count();
    Found { text: taken.iter().collect::<String>().trim().to_string(), column: at.before + 1 + blank % taken.len().max(1) }
}

fn words(characters: &[char]) -> impl Iterator<Item = Found> {
    let separates = |c: &char| c.is_whitespace() || *c == ',' || *c == ';';
    let mut at = 0;
    std::iter::from_fn(move || {
        at += characters[at..].iter().take_while(|c| separates(c)).count();
        let length = characters[at..].iter().take_while(|c| !separates(c)).count();
        let found = Found { text: characters[at..at + length].iter().collect(), column: at + 1 };
        at += length;
        (length > 0).then_some(found)
    })
}

/// The first word of a line that is not blank.
pub fn first_word(line: &str) -> Option<String> {
    words(&line.chars().collect::<Vec<char>>()).next().map(|found| found.text)
}

/// A Fortran number, and whether it has a decimal point.
pub fn number(text: &str) -> Option<(f64, bool)> {
    let bare = text.strip_prefix(['+', '-']).unwrap_or(text);
    let mantissa = bare.chars().take_while(|c| c.is_ascii_digit() || *c == '.').count();
    let (digits, rest) = bare.split_at(mantissa);
    if digits.matches('.').count() > 1 || !digits.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let exponent = rest.strip_prefix(['e', 'E', 'd', 'D', 'q', 'Q']).unwrap_or(rest);
    let power = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    let has_sign = power.len() < exponent.len();
    let good = rest.is_empty()
        || (!power.is_empty() && power.chars().all(|c| c.is_ascii_digit()) && (has_sign || exponent.len() < rest.len()));
    if !good {
        return None;
    }
    let exponent = if rest.is_empty() { "0" } else { exponent.strip_prefix('+').unwrap_or(exponent) };
    let sign = if text.starts_with('-') { "-" } else { "" };
    Some((format!("{sign}{digits}e{exponent}").parse().ok()?, digits.contains('.')))
}

/// What `Fw.d` makes of digits without a decimal point: the last d of them stand behind it.
pub fn implied(value: f64, decimals: i32) -> f64 {
    value / 10f64.powi(decimals)
}

/// `Fw.d`, where the columns hold the number to that many decimals; else the form that keeps most of it in the same columns.
pub fn fixed(value: f64, width: usize, decimals: usize) -> String {
    let plain = format!("{value:width$.decimals$}");
    let lost = plain.trim().parse::<f64>().map_or(f64::INFINITY, |read| (read - value).abs());
    if plain.len() <= width && lost <= 1e-9 * value.abs() {
        return plain;
    }
    let fewer = (0..=width).rev().map(|decimals| format!("{value:.decimals$}"));
    let scaled = (0..=width).rev().map(|digits| exponential(value, digits));
    let fits = |text: &String| text.len() <= width && text.contains('.');
    let mut candidates: Vec<String> = [fewer.clone().find(fits), scaled.clone().find(fits)].into_iter().flatten().collect();
    let whole = format!("{value:.0}.");
    candidates.extend([plain.clone(), whole].into_iter().filter(|text| text.len() <= width));
    let error = |text: &String| text.trim().parse::<f64>().map_or(f64::INFINITY, |read| (read - value).abs());
    let best = candidates.into_iter().min_by(|a, b| error(a).total_cmp(&error(b)));
    best.map_or_else(|| "*".repeat(width), |text| format!("{:>width$}", shortest(&text)))
}

/// A decimal number without the zeros at its end, but with one digit behind the point.
fn shortest(text: &str) -> &str {
    if text.contains('E') || !text.contains('.') || text.ends_with('.') {
        return text;
    }
    let bare = text.trim_end_matches('0');
    if bare.ends_with('.') { &text[..bare.len() + 1] } else { bare }
}

/// `Fw.d` and nothing else, for numbers of a state; with fewer decimals where the number is too long for its columns.
pub fn rounded(value: f64, width: usize, decimals: usize) -> String {
    let of = |decimals: usize| format!("{:>width$}", tidy(format!("{value:.decimals$}")));
    (1..=decimals).rev().map(of).find(|text| text.len() <= width).unwrap_or_else(|| fixed(value, width, decimals))
}

/// Minus zero is zero.
fn tidy(text: String) -> String {
    if text.starts_with('-') && !text.contains(|c: char| ('1'..='9').contains(&c)) { text[1..].to_string() } else { text }
}

/// `1PEw.d`.
pub fn scaled(value: f64, width: usize, decimals: usize) -> String {
    format!("{:>width$}", exponential(value, decimals))
}

/// One digit, a point, `decimals` digits, E, a sign and two digits: as Fortran writes it. Nothing is smaller than 1e-99.
fn exponential(value: f64, decimals: usize) -> String {
    let value = if value.abs() < 1e-99 { 0.0 } else { value };
    let text = format!("{value:.decimals$e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, digits) = match power.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', power),
    };
    format!("{mantissa}E{sign}{digits:0>2}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fortran_numbers_are_read_in_all_their_forms() {
        let good = [
            ("1.32931E+06", 1.32931e6),
            ("-.29216", -0.29216),
            ("5.51090D+10", 5.5109e10),
            ("1.5d3", 1500.0),
            ("1.25-3", 1.25e-3),
            ("1.25+3", 1250.0),
            ("+7.", 7.0),
            ("41", 41.0),
            ("0.E0", 0.0),
        ];
        for (text, value) in good {
            assert_eq!(number(text).map(|found| found.0), Some(value), "{text}");
        }
        for bad in ["", "-", ".", "1.2.3", "3o.0", "1E", "1E+", "E5", "NaN", "1,5", "0x1", "***", "1.0E5.0", "--1", "1e5e5"] {
            assert_eq!(number(bad), None, "{bad}");
        }
    }

    #[test]
    fn numbers_are_written_as_fortran_writes_them() {
        assert_eq!(scaled(1329306.36, 12, 5), " 1.32931E+06");
        assert_eq!(scaled(0.0, 12, 5), " 0.00000E+00");
        assert_eq!(scaled(-1.0e-7, 12, 5), "-1.00000E-07");
        assert_eq!(scaled(9.999999e10, 11, 5), "1.00000E+11");
        assert_eq!(rounded(-13.027857, 11, 5), "  -13.02786");
        assert_eq!(rounded(-0.000001, 11, 5), "    0.00000");
        assert_eq!(rounded(-123456.7891234, 11, 5), "-123456.789");
    }

    /// A number that the columns of its format do not hold is written in the form that loses least there.
    #[test]
    fn columns_hold_as_much_of_a_number_as_they_can() {
        for (value, width, decimals, text) in [
            (30.0, 7, 1, "   30.0"),
            (-120.0, 10, 2, "   -120.00"),
            (12.345678, 7, 1, "12.3457"),
            (4.123e-5, 10, 5, "0.00004123"),
            (1000.0, 9, 5, "   1000.0"),
            (1.0e8, 7, 1, "1.0E+08"),
            (0.1, 9, 5, "  0.10000"),
        ] {
            assert_eq!(fixed(value, width, decimals), text);
            let read = number(text.trim()).map_or(f64::NAN, |found| found.0);
            assert!((read - value).abs() <= 5e-6 * value.abs(), "{text}");
        }
    }

    #[test]
    fn columns_come_before_words_and_words_before_nothing() {
        let three = repeated(0, 1, 11, 3);
        let texts = |line: &str| match cut(line, &three) {
            Cut::InColumns(found) => (true, found.into_iter().map(|f| f.text).collect::<Vec<_>>()),
            Cut::Words(found) => (false, found.into_iter().map(|f| f.text).collect()),
        };
        let in_columns = |texts: [&str; 3]| (true, texts.map(String::from).to_vec());
        assert_eq!(texts("    27.11070   -13.02786      .00000       x, y"), in_columns(["27.11070", "-13.02786", ".00000"]));
        assert_eq!(texts("    27.11070   -13.02786             x, y and z"), in_columns(["27.11070", "-13.02786", ""]));
        assert_eq!(texts("27.1,-13.0 0.5 position"), (false, vec!["27.1".into(), "-13.0".into(), "0.5".into()]));
        let touching = repeated(0, 0, 12, 2);
        let Cut::InColumns(found) = cut("-1.23456E+11-7.65432E+10", &touching) else { panic!("these stand in their columns") };
        assert_eq!((found[1].text.as_str(), found[1].column), ("-7.65432E+10", 13));
        let Cut::InColumns(found) = cut("  -40.00007.46285888", &repeated(0, 0, 10, 2)) else {
            panic!("these fill their columns")
        };
        assert_eq!(found[1].text, "7.46285888");
        let Cut::Words(found) = cut(" 10000 NODE", &repeated(0, 1, 3, 1)) else {
            panic!("the number is longer than its columns")
        };
        assert_eq!(found[0].text, "10000");
    }
}
