//! The log of the hour in printed and in compared form.

use std::fmt;
use std::time::Duration;

/// A line of the log, or an event between them.
pub struct Line {
    pub at: Duration,
    pub who: &'static str,
    pub text: String,
}

impl Line {
    pub fn is_event(&self) -> bool {
        self.who.is_empty()
    }

    /// To the minute, and without what depends on chance: waits between attempts are up to a quarter
    /// shorter, which moves counts and message ids, and ports are free ones.
    pub fn brief(&self) -> String {
        let minutes = self.at.as_secs() / 60;
        let time = format!("{}:{:02}", minutes / 60, minutes % 60);
        if self.is_event() {
            return format!("\n{time} {}", self.text);
        }
        let mut before = "";
        let words = self.text.split(' ').map(|word| {
            match (std::mem::replace(&mut before, word), word.split_once('=')) {
                ("id", _) => "NN;",
                (_, Some(("msg_id", _))) => "msg_id=NN",
                (_, Some(("failed", n))) if n.len() > 1 => "failed=NN",
                (_, Some(("command" | "data", _))) => {
                    word.split_once(':').map_or(word, |(word, _)| word)
                }
                _ => word,
            }
        });
        let text: Vec<_> = words.collect();
        format!("{time} {:5} {}", self.who, text.join(" "))
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (seconds, millis) = (self.at.as_secs(), self.at.subsec_millis());
        let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
        let (who, text) = (self.who, &self.text);
        if self.is_event() {
            writeln!(f)?;
        }
        write!(
            f,
            "{hours}:{minutes:02}:{seconds:02}.{millis:03} {who:5} {text}"
        )
    }
}
