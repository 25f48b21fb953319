//! Rules: their codes, effects, mirrors and texts.

use fc_spec::model::Lang;
use serde::Serialize;

/// A kind of change, and its greatest possible effects.
#[derive(Debug)]
pub struct Rule {
    /// Number. The code is `FC07` and this number. 0 is for differences without a rule, 65 to 67 are for waivers, all others
    /// for changes. A new rule takes the next number, in any section.
    pub number: u8,
    /// The name, such as `port-number-changed`.
    pub name: &'static str,
    /// The messages that it can break.
    pub wire: Wire,
    /// The languages whose programs can stop compiling.
    pub source: &'static [Language],
    /// `true` if programs can behave differently although they read all messages.
    pub behaviour: bool,
    /// `true` if a value can be wrong without an error.
    pub silent: bool,
    /// `true` if no release may have it, even if no message breaks.
    pub is_error: bool,
    /// The subject of its findings.
    pub about: About,
    /// The numbers of the rules that find the opposite change.
    pub mirror: &'static [u8],
    /// The reason why no rule finds the opposite change, in English and in Chinese; empty if one does.
    pub no_mirror: [&'static str; 2],
    /// A short title of the change, in English and in Chinese.
    pub title: [&'static str; 2],
    /// The explanation and the advice, in English and in Chinese.
    pub text: [&'static str; 2],
}

/// The subject of a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// A change that matters to a program or a peer.
    Change,
    /// A change of texts, examples and notes, or one without a rule.
    Text,
    /// A waiver.
    Waiver,
}

/// The messages that a change breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// None.
    Fine,
    /// Messages from old senders at new receivers.
    OldSender,
    /// Messages from new senders at old receivers.
    NewSender,
    /// Messages in both directions.
    Both,
}

impl Wire {
    /// Returns the value for whether messages from old and from new senders break.
    #[must_use]
    pub fn of(old_sender: bool, new_sender: bool) -> Self {
        match (old_sender, new_sender) {
            (false, false) => Self::Fine,
            (true, false) => Self::OldSender,
            (false, true) => Self::NewSender,
            (true, true) => Self::Both,
        }
    }

    /// Returns `true` if messages from old senders break.
    #[must_use]
    pub fn breaks_old_sender(self) -> bool {
        matches!(self, Self::OldSender | Self::Both)
    }

    /// Returns `true` if messages from new senders break.
    #[must_use]
    pub fn breaks_new_sender(self) -> bool {
        matches!(self, Self::NewSender | Self::Both)
    }
}

/// A language whose programs use a generated package.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// Rust.
    Rust,
    /// Kotlin.
    Kotlin,
    /// Compiled Java and Kotlin code that runs with another version of the package.
    JvmBinary,
    /// C++.
    Cpp,
    /// Python, as type checkers see it.
    Python,
    /// TypeScript.
    Typescript,
}

impl Language {
    /// Returns the display name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rust => "Rust",
            Self::Kotlin => "Kotlin",
            Self::JvmBinary => "JVM binaries",
            Self::Cpp => "C++",
            Self::Python => "Python",
            Self::Typescript => "TypeScript",
        }
    }
}

/// Returns the number of a code: 25 for `FC0725`.
#[allow(
    clippy::panic,
    reason = "it is only used for constants, so the compiler reports it"
)]
pub(crate) const fn number(code: &str) -> u8 {
    match code.as_bytes() {
        [
            b'F',
            b'C',
            b'0',
            b'7',
            tens @ b'0'..=b'9',
            ones @ b'0'..=b'9',
        ] => (*tens - b'0') * 10 + (*ones - b'0'),
        _ => panic!("a code is FC07 and two digits"),
    }
}

/// Returns the code with a number: `FC0725` for 25.
fn code(number: u8) -> String {
    format!("FC07{number:02}")
}

/// Returns the English or the Chinese string.
pub(crate) fn pick(lang: Lang, [en, zh]: [&str; 2]) -> &str {
    lang.pick(zh, en)
}

impl Rule {
    /// Returns the code, such as `FC0701`.
    #[must_use]
    pub fn code(&self) -> String {
        code(self.number)
    }

    /// Returns the short title.
    #[must_use]
    pub fn title_in(&self, lang: Lang) -> &'static str {
        pick(lang, self.title)
    }

    /// Returns the explanation with the effects and the rule for the opposite change, as Markdown.
    #[must_use]
    pub fn explain(&self, lang: Lang) -> String {
        format!("{}\n\n{}\n", pick(lang, self.text), self.marks(lang))
    }

    /// Returns the greatest possible effects as a list.
    fn marks(&self, lang: Lang) -> String {
        let wire = match self.wire {
            Wire::Fine => ["nothing breaks", "不影响"],
            Wire::OldSender => [
                "messages from old senders break at new receivers",
                "旧发送方的报文，新接收方无法正确处理",
            ],
            Wire::NewSender => [
                "messages from new senders break at old receivers",
                "新发送方的报文，旧接收方无法正确处理",
            ],
            Wire::Both => ["breaks in both directions", "两个方向都不兼容"],
        };
        let names: Vec<_> = self.source.iter().map(|it| it.name()).collect();
        let source = match names.as_slice() {
            [] => pick(lang, ["nothing breaks", "不影响"]).to_owned(),
            names => names.join(", "),
        };
        let yes = |is: bool| pick(lang, if is { ["yes", "是"] } else { ["no", "否"] });
        let mirror = if self.mirror.is_empty() {
            pick(lang, self.no_mirror).to_owned()
        } else {
            let codes: Vec<_> = self.mirror.iter().copied().map(code).collect();
            codes.join(", ")
        };
        let lines = [
            (["Wire", "报文"], pick(lang, wire)),
            (["Source", "源代码"], &source),
            (["Behaviour", "行为"], yes(self.behaviour)),
            (["Silent", "无报错"], yes(self.silent)),
            (["Opposite change", "反向变更"], &mirror),
        ];
        let colon = pick(lang, [": ", "："]);
        let lines = lines.map(|(label, value)| format!("- {}{colon}{value}", pick(lang, label)));
        lines.join("\n")
    }
}
