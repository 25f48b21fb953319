//! Messages as tables: a line per value, with its unit and its description.

use fc_reflect::{About, Key, Node, Value, walk};
use fc_spec::model::{self, Lang};
use unicode_width::UnicodeWidthStr as _;

/// A line of a table.
type Row = [String; 3];

/// Returns the values of a message as an aligned table: path, value with its unit, description.
#[must_use]
pub fn table(nodes: &[Node<'_>], lang: Lang) -> String {
    let mut rows: Vec<Row> = Vec::new();
    walk(nodes, &mut |path, node| {
        if let Some(value) = shown(node, lang) {
            let text = node.text().map(|text| lang.text(text));
            let text = match (node.about, &node.key) {
                (About::Unknown, Key::Name(_)) => lang.pick("规范中没有", "not in the spec"),
                _ => text.unwrap_or_default(),
            };
            rows.push([path.to_owned(), value, text.to_owned()]);
        }
    });
    aligned(&rows)
}

/// Aligns the columns of a table by their width on a terminal.
#[must_use]
pub fn aligned<const COLUMNS: usize>(rows: &[[String; COLUMNS]]) -> String {
    let mut widths = [0; COLUMNS];
    for row in rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.width().max(*width);
        }
    }
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (width, cell) in widths.iter().zip(row) {
            line += cell;
            line += &" ".repeat(width.saturating_sub(cell.width()) + 2);
        }
        out += line.trim_end();
        out.push('\n');
    }
    out
}

/// Returns a value on one line. Objects and lists with items have their own lines instead.
fn shown(node: &Node<'_>, lang: Lang) -> Option<String> {
    let unit = match node.about {
        About::Field(field) => field.details().unit.as_deref(),
        About::Envelope(_) | About::Item | About::Unknown => None,
    };
    let value = match &node.value {
        Value::Absent => "-".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Int(value) => value.to_string(),
        Value::Float(value) => value.to_string(),
        Value::Text(text) => model::Value::String(text.clone()).to_string(),
        Value::Bytes(bytes) => {
            let count = bytes.len();
            lang.pick(format!("{count} 字节"), format!("{count} bytes"))
        }
        Value::Json(text) => text.replace(char::is_control, " "),
        Value::Enum { wire, named } => {
            let wire = model::Value::from(wire);
            match named {
                Some(value) => format!("{} ({wire}) {}", value.name, lang.text(&value.text)),
                None => wire.to_string(),
            }
        }
        Value::List(items) if items.is_empty() => "[]".to_owned(),
        Value::Object(keys) if keys.is_empty() => "{}".to_owned(),
        Value::List(_) | Value::Object(_) | Value::OneOf { .. } => return None,
    };
    Some(match unit {
        Some(unit) => format!("{value} {unit}"),
        None => value,
    })
}
