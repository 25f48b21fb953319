//! The results of the groups, as tables, targets and prose in Chinese and English.

pub mod packages;
mod section;
mod table;
mod target;
mod text;

pub use section::{terminal, without_targets};
pub use table::Table;
pub use target::{Target, table as targets_table};
pub use text::{Language, Text, t};

/// The results of one group.
#[derive(Clone, Debug)]
pub struct Section {
    /// Heading.
    pub title: Text,
    /// Explanation of the measurement and its figures.
    pub about: Text,
    /// Tables of the figures.
    pub tables: Vec<Table>,
    /// Targets of the figures.
    pub targets: Vec<Target>,
}

/// Returns the median, or `NaN` without values.
#[must_use]
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Returns `value / base` with two decimals.
#[must_use]
pub fn ratio(value: f64, base: f64) -> String {
    let ratio = value / base;
    if ratio.is_finite() { format!("{ratio:.2}") } else { "–".to_owned() }
}

/// Formats a number of seconds with three digits and a suitable unit.
#[must_use]
pub fn seconds(value: f64) -> String {
    let (value, unit) = match value {
        value if !value.is_finite() => return "–".to_owned(),
        value if value < 1e-6 => (value * 1e9, "ns"),
        value if value < 1e-3 => (value * 1e6, "µs"),
        value if value < 1.0 => (value * 1e3, "ms"),
        value => (value, "s"),
    };
    format!("{} {unit}", digits(value))
}

/// Returns a figure with at least three digits.
#[must_use]
pub fn digits(value: f64) -> String {
    match value {
        value if !value.is_finite() => "–".to_owned(),
        value if value >= 100.0 => format!("{value:.0}"),
        value if value >= 10.0 => format!("{value:.1}"),
        value => format!("{value:.2}"),
    }
}

/// Returns a whole number with commas between the thousands.
#[must_use]
pub fn thousands(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = format!("{value:.0}");
    let mut out = String::new();
    for (index, digit) in text.chars().enumerate() {
        if index > 0 && (text.len() - index).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}
