//! Tables for the terminal and for Markdown.

use super::{Language, Text};

/// A table with a heading.
#[derive(Clone, Debug)]
pub struct Table {
    /// Heading.
    pub title: Text,
    /// Column headings.
    pub columns: Vec<Text>,
    /// Rows of cells. The first cell is the name of the row.
    pub rows: Vec<Vec<Text>>,
}

impl Table {
    /// Creates a table without rows.
    #[must_use]
    pub fn new(title: Text, columns: Vec<Text>) -> Self {
        Self { title, columns, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<Text>) {
        self.rows.push(cells);
    }

    /// Returns the table as Markdown. The cells are padded, so that it is also readable on a terminal.
    #[must_use]
    pub fn markdown(&self, language: Language) -> String {
        let get = |cells: &[Text]| cells.iter().map(|cell| cell.get(language).to_owned()).collect::<Vec<_>>();
        let columns = get(&self.columns);
        let rows: Vec<_> = self.rows.iter().map(|row| get(row)).collect();
        let widths: Vec<usize> = (0..columns.len())
            .map(|column| {
                let cells = rows.iter().filter_map(|row| row.get(column));
                cells.chain(columns.get(column)).map(|cell| width(cell)).max().unwrap_or(0).max(3)
            })
            .collect();
        // Names are aligned to the left, figures to the right.
        let rule: Vec<_> = widths
            .iter()
            .enumerate()
            .map(|(index, width)| if index == 0 { "-".repeat(*width) } else { "-".repeat(width - 1) + ":" })
            .collect();
        let lines = [columns, rule].into_iter().chain(rows);
        lines.map(|cells| line(&cells, &widths)).collect()
    }
}

fn line(cells: &[String], widths: &[usize]) -> String {
    let mut out = String::from("|");
    for (index, (cell, columns)) in cells.iter().zip(widths).enumerate() {
        let pad = " ".repeat(columns - width(cell).min(*columns));
        let cell = if index == 0 { format!(" {cell}{pad} |") } else { format!(" {pad}{cell} |") };
        out.push_str(&cell);
    }
    out.push('\n');
    out
}

/// Returns the width of a text in columns of a terminal. A Chinese character takes two.
fn width(text: &str) -> usize {
    text.chars().map(|letter| if letter >= '\u{2E80}' { 2 } else { 1 }).sum()
}
