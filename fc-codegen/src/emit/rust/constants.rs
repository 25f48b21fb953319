//! Constants in Rust: table rows and sample values.

use super::literal::literal;
use crate::package::digits::grouped;
use crate::package::expr::{Expr, Record};
use crate::package::items::Spelled;
use crate::package::name::free;
use fc_spec::model::Field;

/// The maximum width of a value on one line, in columns.
const WIDTH: usize = 72;

/// The maximum width of a list on one line inside a struct with several lines.
const LIST_WIDTH: usize = 50;

/// The maximum width of named fields on one line, as in rustfmt.
const FIELDS_WIDTH: usize = 18;

/// The scope of a constant, which decides the form of its structs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum ConstantScope {
    /// In the package that defines the types: a literal with all fields.
    Package,
    /// In a program that uses the package: `new` and setters, because the structs may gain fields.
    Program,
}

/// Returns a constant, laid out as rustfmt would from column `used`.
pub fn spelled(expr: &Expr<'_>, scope: ConstantScope, used: usize) -> String {
    Spelling::of(expr, scope).laid_out(used)
}

/// Returns a struct, laid out as rustfmt would from column `used`.
pub fn spelled_record(record: &Record<'_>, scope: ConstantScope, used: usize) -> String {
    Spelling::record(record, scope).laid_out(used)
}

/// Values with the names of their fields.
type Fields = Vec<(String, Spelling)>;

/// A constant before layout.
enum Spelling {
    /// One token or a short call.
    Atom(String),
    /// A prefix and a suffix around another constant: `Some(`, `)`.
    Around(String, Box<Spelling>, &'static str),
    /// `vec![…]`.
    List(Vec<Spelling>, ConstantScope),
    /// `Name { field: value }`.
    Literal(String, Fields),
    /// Required fields, then optional fields: `Name::new(a).with_b(b)`.
    ///
    /// Several required fields give `Name::new(NameFields { a, c })`.
    Made(String, Fields, Fields),
}

impl Spelling {
    fn of(expr: &Expr<'_>, scope: ConstantScope) -> Self {
        Self::Atom(match expr {
            Expr::Bool(value) => value.to_string(),
            Expr::Int(value) => grouped(*value),
            Expr::Float(value) => format!("{value:?}"),
            Expr::Text(text) if text.is_empty() => "String::new()".to_owned(),
            Expr::Text(text) => format!("{}.to_owned()", literal(text)),
            Expr::Bytes(bytes) => format!("Bytes64(b\"{}\".to_vec())", bytes.escape_ascii()),
            Expr::Json(text) => match scope {
                ConstantScope::Package => format!(
                    "Json::new({}).unwrap_or_else(|_| Json::null())",
                    literal(text)
                ),
                ConstantScope::Program => format!("serde_json::json!({text}).into()"),
            },
            Expr::Value(item, value) => format!("{}::{}", item.ty.name, value.name),
            Expr::Unlisted(item, value) => {
                let open = format!("{}::from(", item.ty.name);
                return Self::Around(open, Box::new(Self::of(value, scope)), ")");
            }
            Expr::Id(ty, value) => {
                let value = Box::new(Self::of(value, scope));
                return Self::Around(format!("{ty}("), value, ")");
            }
            Expr::Choice(item, variant, record) => {
                let open = format!("{}::{}(", item.ty.name, variant.name);
                return Self::Around(open, Box::new(Self::record(record, scope)), ")");
            }
            Expr::List(items) => {
                let items = items.iter().map(|item| Self::of(item, scope));
                return Self::List(items.collect(), scope);
            }
            Expr::Record(record) => return Self::record(record, scope),
        })
    }

    fn record(record: &Record<'_>, scope: ConstantScope) -> Self {
        let name = record.item.ty.name.to_string();
        let members = record.members.iter();
        match scope {
            ConstantScope::Package => {
                let fields = members.map(|(field, value)| {
                    let value = match value {
                        Some(value) if field.optional => {
                            let value = Box::new(Self::of(value, scope));
                            Self::Around("Some(".to_owned(), value, ")")
                        }
                        Some(value) => Self::of(value, scope),
                        None => Self::Atom("None".to_owned()),
                    };
                    (field.name.to_string(), value)
                });
                let extra = Self::Atom("Extra::new()".to_owned());
                let extra = (extra_name(record.item.fields()), extra);
                Self::Literal(name, fields.chain([extra]).collect())
            }
            ConstantScope::Program => {
                let by_name = record.item.has_field_type();
                let (mut required, mut optional) = (Vec::new(), Vec::new());
                for (field, value) in members {
                    let Some(value) = value else { continue };
                    let value = match value {
                        // `new` and setters take a literal; a field does not.
                        Expr::Text(text) if field.optional || !by_name => Self::Atom(literal(text)),
                        value => Self::of(value, scope),
                    };
                    if field.optional {
                        let name = field.name.trim_start_matches("r#");
                        optional.push((name.to_owned(), value));
                    } else {
                        required.push((field.name.to_string(), value));
                    }
                }
                Self::Made(name, required, optional)
            }
        }
    }

    /// Returns the constant on one line; `None` if it always takes several.
    fn flat(&self) -> Option<String> {
        let joined = |items: &mut dyn Iterator<Item = &Self>| -> Option<String> {
            let items: Option<Vec<String>> = items.map(Self::flat).collect();
            Some(items?.join(", "))
        };
        match self {
            Self::Atom(text) => Some(text.clone()),
            Self::Around(open, inner, close) => Some([open, &*inner.flat()?, close].concat()),
            Self::List(items, scope) => {
                if items.is_empty() && *scope == ConstantScope::Package {
                    return Some("Vec::new()".to_owned());
                }
                let text = joined(&mut items.iter())?;
                let fits = *scope == ConstantScope::Program || text.len() <= LIST_WIDTH;
                fits.then(|| format!("vec![{text}]"))
            }
            Self::Literal(..) => None,
            Self::Made(name, required, optional) => {
                let mut out = format!("{name}::new({})", given(name, required)?);
                for (field, value) in optional {
                    out.extend([".with_", field, "(", &value.flat()?, ")"]);
                }
                Some(out)
            }
        }
    }

    /// Returns the constant on one line if it is short enough, otherwise on several.
    fn laid_out(&self, used: usize) -> String {
        let flat = self.flat();
        if let Some(flat) = flat.filter(|flat| used + flat.len() <= WIDTH || self.is_atom()) {
            return flat;
        }
        match self {
            Self::Atom(text) => text.clone(),
            Self::Around(open, inner, close) => {
                [open, &*inner.laid_out(used + open.len()), close].concat()
            }
            Self::List(items, ConstantScope::Package) if items.len() == 1 => {
                let only: String = items.iter().map(|item| item.laid_out(used)).collect();
                format!("vec![{only}]")
            }
            Self::List(items, _) => {
                let mut inside = String::new();
                for item in items {
                    inside.extend([&item.laid_out(used + 4), ",\n"]);
                }
                ["vec![\n", &indented(&inside), "]"].concat()
            }
            Self::Literal(name, fields) => {
                let mut inside = String::new();
                for (field, value) in fields {
                    inside.extend([field, ": ", &value.laid_out(used + 4), ",\n"]);
                }
                [name, " {\n", &indented(&inside), "}"].concat()
            }
            Self::Made(name, required, optional) => made(name, required, optional, used),
        }
    }

    fn is_atom(&self) -> bool {
        matches!(self, Self::Atom(_))
    }
}

/// Returns the argument of `new` on one line; `None` if rustfmt takes several.
fn given(name: &str, required: &Fields) -> Option<String> {
    match required.as_slice() {
        [] => Some(String::new()),
        [(_, only)] => only.flat(),
        several => {
            let fields: Option<Vec<_>> = several
                .iter()
                .map(|(field, value)| Some(format!("{field}: {}", value.flat()?)))
                .collect();
            let fields = fields?.join(", ");
            (fields.len() <= FIELDS_WIDTH).then(|| format!("{name}Fields {{ {fields} }}"))
        }
    }
}

/// Lays out a struct on several lines, as rustfmt does for a chain of calls.
fn made(name: &str, required: &Fields, optional: &Fields, used: usize) -> String {
    let mut out = format!("{name}::new(");
    let short = given(name, required).filter(|it| used + out.len() + it.len() < WIDTH);
    let is_short = short.is_some();
    match (short, required.as_slice()) {
        (Some(given), _) => out.push_str(&given),
        (None, [(_, only)]) => {
            let value = only.laid_out(used + 4);
            out.extend(["\n", &*indented(&format!("{value},\n"))]);
        }
        (None, several) => {
            let mut inside = String::new();
            for (field, value) in several {
                let value = value.laid_out(used + field.len() + 6);
                inside.extend([field, ": ", &value, ",\n"]);
            }
            out.extend([name, "Fields {\n", &indented(&inside), "}"]);
        }
    }
    out.push(')');
    let mut setters = String::new();
    for (field, value) in optional {
        let value = value.laid_out(used + field.len() + 12);
        setters.extend(["\n.with_", field, "(", &value, ")"]);
    }
    out.push_str(&if is_short {
        indented(&setters)
    } else {
        setters
    });
    out.trim_end().to_owned()
}

/// Indents every line by one level.
pub fn indented(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        if !line.is_empty() {
            out.push_str("    ");
        }
        out.push_str(line);
        out.push('\n');
    }
    out
}

/// Returns the name of the field that keeps unknown keys.
pub fn extra_name(fields: &[Spelled<'_, Field>]) -> String {
    free(&["extra", "extra_keys", "unknown_keys"], |name| {
        fields.iter().any(|field| field.name == name)
    })
}
