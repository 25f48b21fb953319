//! Parses generated sources with braces into nested declarations. It covers the output of the generator, not the whole
//! language.

/// A declaration and its members.
pub struct Node {
    /// The text before the braces, on one line and without comments. Literals keep their quotes and lose their
    /// punctuation.
    pub head: String,
    /// The declarations in the braces; `None` without braces.
    pub body: Option<Vec<Node>>,
}

impl Node {
    /// Returns the declarations in the braces.
    pub fn children(&self) -> &[Self] {
        self.body.as_deref().unwrap_or_default()
    }
}

/// The syntax of a language, as far as the parser needs it.
pub struct Syntax {
    /// A line break ends a declaration.
    pub ends_at_line: bool,
    /// Tells if commas end the declarations in the braces after this head.
    pub is_list: fn(&str) -> bool,
    /// `'` quotes strings, and `/` encloses regular expressions.
    pub is_script: bool,
}

/// Parses a file.
pub fn tree(text: &str, syntax: &Syntax) -> Vec<Node> {
    let mut reader = Reader {
        chars: plain(text, syntax).chars().collect(),
        at: 0,
        syntax,
    };
    reader.block(false)
}

/// Removes comments and the punctuation inside literals.
fn plain(text: &str, syntax: &Syntax) -> String {
    let chars: Vec<char> = text.chars().collect();
    let starts = |at: usize, what: &str| {
        let mut rest = chars.iter().skip(at);
        what.chars().all(|c| rest.next() == Some(&c))
    };
    let find = |from: usize, what: &str| (from..chars.len()).find(|at| starts(*at, what));
    let mut out = String::new();
    let mut at = 0;
    while let Some(&c) = chars.get(at) {
        let before = out.trim_end().chars().next_back();
        let is_word = out.chars().next_back().is_some_and(char::is_alphanumeric);
        let is_quote = match c {
            '"' | '`' => true,
            '\'' => syntax.is_script || starts(at + 1, "\\") || starts(at + 2, "'"),
            '/' => syntax.is_script && before.is_none_or(|c| "(,=:[".contains(c)),
            _ => false,
        };
        let mut literal = |from: usize, end: Option<usize>, close: usize| {
            let end = end.unwrap_or(chars.len());
            let inner = chars.iter().take(end).skip(from);
            out.push('"');
            out.extend(inner.map(|c| {
                if "{}()[]<>;,'\"\\\n".contains(*c) {
                    '_'
                } else {
                    *c
                }
            }));
            out.push('"');
            end + close
        };
        at = if starts(at, "//") {
            find(at, "\n").unwrap_or(chars.len())
        } else if starts(at, "/*") {
            find(at + 2, "*/").map_or(chars.len(), |end| end + 2)
        } else if starts(at, "\"\"\"") {
            literal(at + 3, find(at + 3, "\"\"\""), 3)
        } else if !is_word && (starts(at, "r#\"") || starts(at, "r\"")) {
            let close = if starts(at, "r#") { "\"#" } else { "\"" };
            let from = at + 1 + close.len();
            literal(from, find(from, close), close.len())
        } else if !is_word && starts(at, "R\"") {
            let open = find(at, "(").unwrap_or(chars.len());
            let mark: String = chars.iter().take(open).skip(at + 2).collect();
            let close = format!("){mark}\"");
            literal(open + 1, find(open + 1, &close), close.len())
        } else if is_quote {
            literal(at + 1, Some(closed(&chars, at + 1, c)), 1)
        } else {
            out.push(c);
            at + 1
        };
    }
    out
}

/// Returns the end of a literal with backslash escapes.
fn closed(chars: &[char], from: usize, close: char) -> usize {
    let mut at = from;
    loop {
        match chars.get(at) {
            Some('\\') => at += 2,
            Some(&c) if c != close => at += 1,
            _ => return at,
        }
    }
}

struct Reader<'s> {
    chars: Vec<char>,
    at: usize,
    syntax: &'s Syntax,
}

impl Reader<'_> {
    /// Parses declarations up to the closing brace or the end.
    fn block(&mut self, is_list: bool) -> Vec<Node> {
        let mut nodes = Vec::new();
        let mut head = String::new();
        let mut depth = 0_usize;
        while let Some(&c) = self.chars.get(self.at) {
            self.at += 1;
            match c {
                '{' if depth == 0 => {
                    let body = self.block((self.syntax.is_list)(&head));
                    push(&mut nodes, &mut head, Some(body));
                }
                '}' if depth == 0 => break,
                '(' | '[' | '{' => {
                    depth += 1;
                    head.push(c);
                }
                ')' | ']' | '}' => {
                    depth = depth.saturating_sub(1);
                    head.push(c);
                }
                ';' if depth == 0 => push(&mut nodes, &mut head, None),
                ',' if depth == 0 && is_list => push(&mut nodes, &mut head, None),
                '\n' if depth == 0 && self.syntax.ends_at_line && !self.goes_on(&head) => {
                    push(&mut nodes, &mut head, None);
                }
                c => head.push(c),
            }
        }
        push(&mut nodes, &mut head, None);
        nodes
    }

    /// Tells if a declaration continues on the next line.
    fn goes_on(&self, head: &str) -> bool {
        let rest: String = self.chars.iter().skip(self.at).take(200).collect();
        let rest = rest.trim_start();
        head.trim_end().ends_with(['=', ':', ',', '<', '|', '&'])
            || rest.starts_with(['|', '&', '>', '.', '?', ':', ')'])
            || rest.starts_with("extends ")
    }
}

fn push(nodes: &mut Vec<Node>, head: &mut String, body: Option<Vec<Node>>) {
    let words: Vec<&str> = head.split_whitespace().collect();
    if !words.is_empty() || body.is_some() {
        let head = words.join(" ").replace("( ", "(").replace(", )", ")");
        nodes.push(Node { head, body });
    }
    head.clear();
}

/// Splits a string at the first `end` outside of all brackets.
pub fn cut<'t>(text: &'t str, end: &str) -> (&'t str, &'t str) {
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        if depth == 0 && text[at..].starts_with(end) {
            return (&text[..at], &text[at + end.len()..]);
        }
        match c {
            '(' | '[' | '<' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            '>' if !text[..at].ends_with('-') && !text[..at].ends_with('=') => {
                depth = depth.saturating_sub(1);
            }
            _ => {}
        }
    }
    (text, "")
}

/// Splits a list at the commas outside of all brackets.
pub fn parts(text: &str) -> Vec<&str> {
    let mut rest = text;
    let mut found = Vec::new();
    while !rest.trim().is_empty() {
        let (part, more) = cut(rest, ",");
        found.push(part.trim());
        rest = more;
    }
    found
}

/// Returns the first word of a string.
pub fn word(text: &str) -> &str {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '#' || c == '$';
    text.split(|c| !is_part(c)).next().unwrap_or_default()
}
