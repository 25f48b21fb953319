//! The traffic of a proxy on a terminal.
//!
//! ```text
//! proxy ──► Event ──► View ──► Traffic          the last frames, counts and latencies
//! terminal ──► Key ──► View ──draw──► terminal
//! ```

mod draw;
mod terminal;
mod traffic;

pub use terminal::{show, sink};

use crate::decode::{self, Decoder, Record};
use crate::proxy::{Event, unreachable};
use fc_reflect::Reflector;
use fc_spec::model::{Lang, Model};
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::convert::Infallible;
use traffic::{Row, Traffic};

/// The bytes in a line of a frame's dump.
const DUMPED: usize = 16;

/// The rows that a page key moves.
const PAGE: usize = 20;

/// The state of the terminal.
pub struct View<'m> {
    model: &'m Model,
    lang: Lang,
    /// The addresses, for the first line.
    title: String,
    traffic: Traffic,
    filter: Filter,
    /// `true` while keys go into the filter.
    is_typing: bool,
    /// While paused, the number of the first row that is not shown.
    paused: Option<u64>,
    /// The number of the selected row. Without one, the last row is selected.
    selected: Option<u64>,
    opened: Option<Opened>,
    /// The last problem, such as a robot that accepts no connection.
    problem: Option<String>,
}

/// The choice of rows.
#[derive(Debug, Default)]
struct Filter {
    /// A part of the name, the code, the message id or the error.
    text: String,
    only_errors: bool,
}

/// A frame that is shown to the byte.
#[derive(Debug)]
struct Opened {
    lines: Vec<String>,
    /// The first line that is shown.
    top: usize,
}

/// The wish of the person after a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// To go on.
    Stay,
    /// To end the proxy.
    Leave,
}

impl Filter {
    fn wants(&self, row: &Row) -> bool {
        let has_error = row.error.is_some() || !row.faults.is_empty();
        let wanted = self.text.to_lowercase();
        (has_error || !self.only_errors)
            && (row.texts().iter()).any(|text| text.to_lowercase().contains(&wanted))
    }
}

impl<'m> View<'m> {
    /// Creates a view without traffic.
    #[must_use]
    pub fn new(model: &'m Model, lang: Lang, title: String) -> Self {
        Self {
            model,
            lang,
            title,
            traffic: Traffic::default(),
            filter: Filter::default(),
            is_typing: false,
            paused: None,
            selected: None,
            opened: None,
            problem: None,
        }
    }

    /// Adds an observation of the proxy.
    pub fn add(&mut self, event: &Event<'_, 'm>) {
        match event {
            Event::Record(record) => {
                self.problem = None;
                self.traffic.add(record, self.lang);
            }
            Event::Faults { flow, id, kinds } => self.traffic.add_faults(*flow, *id, kinds),
            Event::Unreachable(address, error) => {
                self.problem = Some(self.lang.text(&unreachable(address, error)).to_owned());
            }
        }
    }

    /// Takes a key.
    pub fn press(&mut self, key: KeyEvent) -> Wish {
        let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
        if is_control && key.code == KeyCode::Char('c') {
            return Wish::Leave;
        }
        if self.is_typing {
            self.type_filter(key.code);
        } else if self.opened.is_some() {
            self.read(key.code);
        } else {
            return self.choose(key.code);
        }
        Wish::Stay
    }

    fn type_filter(&mut self, key: KeyCode) {
        let text = &mut self.filter.text;
        match key {
            KeyCode::Char(character) => text.push(character),
            KeyCode::Backspace => drop(text.pop()),
            KeyCode::Esc => {
                text.clear();
                self.is_typing = false;
            }
            KeyCode::Enter => self.is_typing = false,
            _ => {}
        }
        self.selected = None;
    }

    fn read(&mut self, key: KeyCode) {
        let Some(opened) = &mut self.opened else {
            return;
        };
        let top = match key {
            KeyCode::Up | KeyCode::Char('k') => opened.top.saturating_sub(1),
            KeyCode::Down | KeyCode::Char('j') => opened.top.saturating_add(1),
            KeyCode::PageUp => opened.top.saturating_sub(PAGE),
            KeyCode::PageDown => opened.top.saturating_add(PAGE),
            KeyCode::Home => 0,
            KeyCode::End => opened.lines.len().saturating_sub(PAGE),
            KeyCode::Esc | KeyCode::Enter | KeyCode::Char('q') => {
                self.opened = None;
                return;
            }
            _ => return,
        };
        opened.top = top.min(opened.lines.len().saturating_sub(1));
    }

    fn choose(&mut self, key: KeyCode) -> Wish {
        match key {
            KeyCode::Char('q') => return Wish::Leave,
            KeyCode::Up | KeyCode::Char('k') => self.select(|at, _| at.saturating_sub(1)),
            KeyCode::Down | KeyCode::Char('j') => self.select(|at, _| at.saturating_add(1)),
            KeyCode::PageUp => self.select(|at, _| at.saturating_sub(PAGE)),
            KeyCode::PageDown => self.select(|at, _| at.saturating_add(PAGE)),
            KeyCode::Home => self.select(|_, _| 0),
            KeyCode::End => self.select(|_, last| last),
            KeyCode::Enter => self.open(),
            KeyCode::Char('/') => self.is_typing = true,
            KeyCode::Char('e') => self.filter.only_errors = !self.filter.only_errors,
            KeyCode::Char(' ' | 'p') => {
                self.paused = match self.paused {
                    Some(_) => None,
                    None => Some(self.traffic.count()),
                };
            }
            KeyCode::Esc => self.filter = Filter::default(),
            _ => {}
        }
        Wish::Stay
    }

    /// Returns the rows that are shown.
    fn rows(&self) -> Vec<&Row> {
        let end = self.paused.unwrap_or(u64::MAX);
        let rows = self.traffic.rows().take_while(|row| row.number < end);
        rows.filter(|row| self.filter.wants(row)).collect()
    }

    /// Returns the position of the selected row. If it has gone, the next one takes its place.
    fn position(&self, rows: &[&Row]) -> usize {
        let last = rows.len().saturating_sub(1);
        self.selected.map_or(last, |number| {
            rows.partition_point(|row| row.number < number).min(last)
        })
    }

    /// Selects another row by the positions of the selected and the last one.
    fn select(&mut self, to: impl FnOnce(usize, usize) -> usize) {
        let rows = self.rows();
        let last = rows.len().saturating_sub(1);
        let at = to(self.position(&rows), last).min(last);
        // The last row stays the last one when others come.
        self.selected = rows.get(at).filter(|_| at < last).map(|row| row.number);
    }

    fn open(&mut self) {
        let rows = self.rows();
        let Some(row) = rows.get(self.position(&rows)) else {
            return;
        };
        let lines = self.described(row);
        self.opened = Some(Opened { lines, top: 0 });
    }

    /// Describes a frame by the spec and shows its bytes.
    fn described(&self, row: &Row) -> Vec<String> {
        let reflector = Reflector::new(self.model);
        let mut decoder = Decoder::new(&reflector);
        let mut text = String::new();
        let mut sink = |record: &Record<'_>| {
            text.push_str(&decode::text(record, self.model, self.lang));
            Ok::<_, Infallible>(())
        };
        let Ok(()) = decoder.push(row.flow, row.time, &row.bytes, &mut sink);
        let Ok(()) = decoder.finish(&mut sink);
        text.push('\n');
        let dump = row.bytes.chunks(DUMPED).zip((0_usize..).step_by(DUMPED));
        let dump = dump.map(|(bytes, at)| format!("{at:06X}  {}", decode::hex(bytes)));
        text.lines().map(str::to_owned).chain(dump).collect()
    }
}
