//! Templates: source text of a language that does not depend on the spec, with its comments in both languages.

use super::docs::Docs;
use super::source::Source;
use crate::package::joined::Joined;
use fc_spec::model::Lang;
use std::collections::HashMap;
use std::sync::LazyLock;

/// The mark of a comment's line in Chinese.
const ZH: &str = "zh: ";

/// The mark of a comment's line in English.
const EN: &str = "en: ";

/// The mark of a comment's line that does not depend on the language.
const ANY: &str = "doc: ";

/// Templates by their names, read on first use.
pub type Templates = LazyLock<HashMap<&'static str, &'static str>>;

/// Returns the templates of a file. Each is below a line with its name: `---- name`.
pub fn templates(text: &'static str) -> HashMap<&'static str, &'static str> {
    let all = text.split("---- ").filter_map(|it| it.split_once('\n'));
    all.map(|(name, text)| (name, text.trim_end())).collect()
}

impl Source {
    /// Writes a template of the language, and replaces `{{name}}` by its value.
    ///
    /// A comment has the lines above an item that begin with
    /// `zh: `, `en: ` or `doc: `. A line with both `zh: ` and `en: ` is one sentence in each language. A line that
    /// consists of an empty value is left out. A comment before an empty line is on the enclosing item, and one at the
    /// end is on the item that follows.
    pub fn template(&mut self, name: &str, values: &[(&str, &str)]) {
        self.written_template(name, values, "");
    }

    /// Writes the head of a file: a template that ends with a comment on the file.
    pub fn head(&mut self, name: &str, values: &[(&str, &str)]) {
        self.written_template(name, values, "\n\n");
    }

    fn written_template(&mut self, name: &str, values: &[(&str, &str)], end: &str) {
        let template = self.style().templates.get(name);
        let mut text = template.copied().unwrap_or_default().to_owned();
        for (name, value) in values {
            let mark = ["{{", name, "}}"].concat();
            if value.is_empty() {
                let lines = text.lines().filter(|line| line.trim() != mark);
                text = lines.joined("\n");
            }
            text = text.replace(&mark, value);
        }
        text.push_str(end);
        let mut comment: Vec<&str> = Vec::new();
        let mut columns = 0;
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            let content = line.trim_start();
            let goes_on = lines
                .peek()
                .is_some_and(|next| is_comment(next.trim_start()));
            let is_between = content.is_empty() && !comment.is_empty() && goes_on;
            if is_comment(content) || is_between {
                if comment.is_empty() {
                    columns = line.len() - content.len();
                }
                comment.push(content);
            } else if content.is_empty() {
                if !comment.is_empty() {
                    self.inner_docs(&docs_of(&comment));
                    comment.clear();
                }
                self.blank();
            } else {
                self.indented_docs(columns, &comment);
                comment.clear();
                self.line(line);
            }
        }
        self.indented_docs(columns, &comment);
    }

    /// Writes a comment in front of an item that is indented by this number of columns. Most items have none.
    fn indented_docs(&mut self, columns: usize, lines: &[&str]) {
        if lines.is_empty() {
            return;
        }
        let levels = columns / self.style().indent.len();
        self.deeper(levels, |out| out.docs(&docs_of(lines)));
    }
}

fn is_comment(line: &str) -> bool {
    [ZH, EN, ANY].iter().any(|mark| line.starts_with(mark))
}

/// Returns the comment with these lines. An empty line separates paragraphs.
fn docs_of(lines: &[&str]) -> Docs<'static> {
    let mut docs = Docs::default();
    for paragraph in lines.split(|line| line.is_empty()) {
        let both = paragraph
            .iter()
            .find_map(|it| it.strip_prefix(ZH)?.split_once(" en: "));
        if let Some((zh, en)) = both {
            docs.sentences([zh.to_owned(), en.to_owned()]);
            continue;
        }
        let with = |mark: &str| {
            let lines = paragraph.iter().filter_map(|it| it.strip_prefix(mark));
            lines.joined("\n")
        };
        match [ZH, EN].map(with) {
            [zh, en] if en.is_empty() => docs.raw_in(Lang::Zh, zh),
            [zh, en] if zh.is_empty() => docs.raw_in(Lang::En, en),
            pair => docs.raw_lines(pair),
        }
        docs.raw(with(ANY));
    }
    docs
}

#[cfg(test)]
mod tests {
    use crate::package::source::Source;
    use crate::package::source::tests::BRACES;
    use crate::package::style::Style;
    use crate::package::template::{Templates, templates};
    use fc_spec::model::{Lang, Languages};
    use std::sync::LazyLock;

    static STYLE: Style = Style {
        templates: &TEMPLATES,
        ..BRACES
    };

    static TEMPLATES: Templates = LazyLock::new(|| {
        templates(
            "\
---- classes
zh: 一。 en: One.
class {{name}}

{{nothing}}
class Two {

    zh: 二。
    en: Two
    en: lines.

    doc: Both.
    fun two()
}

---- other
",
        )
    });

    fn written(languages: Languages) -> String {
        let mut out = Source::new(&STYLE, languages);
        out.template("classes", &[("name", "One"), ("nothing", "")]);
        out.finish()
    }

    #[test]
    fn templates_have_comments_in_the_languages() {
        let both = "/** 一。One. */\nclass One\n\nclass Two {\n\n    /**\n     * 二。\n     * Two\n     * lines.\n     *\n     * Both.\n     */\n    fun two()\n}\n";
        assert_eq!(written(Languages::All), both);
        let zh = "/** 一。 */\nclass One\n\nclass Two {\n\n    /**\n     * 二。\n     *\n     * Both.\n     */\n    fun two()\n}\n";
        assert_eq!(written(Languages::Only(Lang::Zh)), zh);
    }
}
