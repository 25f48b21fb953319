//! Draws a view.

use super::traffic::{Row, Sender};
use super::{Opened, View};
use crate::decode::milliseconds;
use fc_spec::model::Lang;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Row as TableRow, Table};
use std::time::Duration;

/// The columns of a terminal with room for message ids and lengths.
const WIDE: u16 = 100;

const GOOD: Style = Style::new().fg(Color::Green);
const BAD: Style = Style::new().fg(Color::Red);
const QUIET: Style = Style::new().add_modifier(Modifier::DIM);
const CHOSEN: Style = Style::new().add_modifier(Modifier::REVERSED);
const HEADING: Style = Style::new().add_modifier(Modifier::BOLD);

impl View<'_> {
    /// Draws the whole terminal.
    pub fn draw(&self, frame: &mut Frame<'_>) {
        let parts = [
            Constraint::Length(1),
            Constraint::Length(1),
            Constraint::Min(1),
            Constraint::Length(1),
        ];
        let [title, summary, middle, keys] = Layout::vertical(parts).areas(frame.area());
        frame.render_widget(Line::styled(&*self.title, HEADING), title);
        frame.render_widget(self.summary(), summary);
        match &self.opened {
            Some(opened) => draw_opened(opened, frame, middle),
            None => self.draw_rows(frame, middle),
        }
        frame.render_widget(Line::styled(self.keys(), QUIET), keys);
    }

    fn summary(&self) -> Line<'_> {
        if let Some(problem) = &self.problem {
            return Line::styled(&**problem, BAD);
        }
        let traffic = &self.traffic;
        let (calls, reports, errors) = (traffic.calls, traffic.reports, traffic.errors);
        let lang = self.lang;
        let mut parts = vec![match lang {
            Lang::Zh => format!("调用 {calls} · 上报 {reports} · 错误 {errors}"),
            Lang::En => format!("calls {calls} · reports {reports} · errors {errors}"),
        }];
        if let Some([median, high]) = traffic.latencies() {
            let (median, high) = (written(median), written(high));
            parts.push(match lang {
                Lang::Zh => format!("响应 {median} ms，95% 在 {high} ms 内"),
                Lang::En => format!("responses {median} ms, 95 % within {high} ms"),
            });
        }
        if self.filter.only_errors {
            parts.push(lang.pick("仅错误", "errors only").to_owned());
        }
        if self.paused.is_some() {
            parts.push(lang.pick("已暂停", "paused").to_owned());
        }
        if self.is_typing || !self.filter.text.is_empty() {
            let cursor = if self.is_typing { "_" } else { "" };
            parts.push(format!("/{}{cursor}", self.filter.text));
        }
        let style = if errors > 0 { BAD } else { GOOD };
        Line::styled(parts.join(" · "), style)
    }

    fn keys(&self) -> &'static str {
        let lang = self.lang;
        if self.is_typing {
            lang.pick(
                "输入要找的文字 · Enter 保留 · Esc 清除",
                "Type a text · Enter keeps it · Esc clears it",
            )
        } else if self.opened.is_some() {
            lang.pick("↑↓ 滚动 · Esc 返回", "↑↓ scroll · Esc back")
        } else {
            lang.pick(
                "↑↓ 选择 · Enter 打开 · End 最新 · / 过滤 · e 仅错误 · 空格 暂停 · q 退出",
                "↑↓ select · Enter open · End latest · / filter · e errors · Space pause · q quit",
            )
        }
    }

    fn draw_rows(&self, frame: &mut Frame<'_>, area: Rect) {
        let rows = self.rows();
        let selected = self.position(&rows);
        let lang = self.lang;
        let is_wide = area.width >= WIDE;
        let columns = [
            (lang.pick("时间", "Time"), Constraint::Length(15), true),
            ("", Constraint::Length(1), true),
            (lang.pick("接口", "Operation"), Constraint::Fill(3), true),
            (lang.pick("类型", "Kind"), Constraint::Length(15), true),
            (lang.pick("消息号", "Id"), Constraint::Length(10), is_wide),
            (lang.pick("字节", "Bytes"), Constraint::Length(8), is_wide),
            ("ms", Constraint::Length(8), true),
            (lang.pick("错误", "Error"), Constraint::Fill(2), true),
        ];
        let fits = columns.map(|(_, _, fits)| fits);
        let columns = columns.into_iter().filter(|(_, _, fits)| *fits);
        let (heading, widths): (Vec<_>, Vec<_>) =
            columns.map(|(name, width, _)| (name, width)).unzip();
        let heading = TableRow::new(heading);
        // The heading takes one line.
        let height = usize::from(area.height.saturating_sub(1)).max(1);
        let top = (selected + 1).saturating_sub(height);
        let shown = rows.iter().enumerate().skip(top).take(height);
        let shown = shown.map(|(at, row)| {
            let style = if row.problems().is_empty() {
                Style::new()
            } else {
                BAD
            };
            let chosen = if at == selected { CHOSEN } else { Style::new() };
            let cells = cells(row).into_iter().zip(fits);
            let cells = cells.filter_map(|(cell, fits)| fits.then_some(cell));
            TableRow::new(cells).style(style.patch(chosen))
        });
        let table = Table::new(shown, widths).header(heading.style(HEADING));
        frame.render_widget(table, area);
    }
}

/// Returns the cells of a row.
fn cells(row: &Row) -> [String; 8] {
    let arrow = match row.sender {
        Some(Sender::App) => "→",
        Some(Sender::Robot) => "←",
        None => " ",
    };
    let name = if row.name.is_empty() {
        row.code()
    } else {
        row.name.clone()
    };
    [
        row.clock(),
        arrow.to_owned(),
        name,
        row.kind.to_owned(),
        row.message_id(),
        row.length.to_string(),
        row.elapsed.map_or_else(String::new, written),
        row.problems(),
    ]
}

fn draw_opened(opened: &Opened, frame: &mut Frame<'_>, area: Rect) {
    let lines = opened.lines.iter().skip(opened.top);
    let lines = lines.take(usize::from(area.height));
    let lines: Vec<Line<'_>> = lines.map(|line| Line::raw(&**line)).collect();
    frame.render_widget(Paragraph::new(lines), area);
}

/// Returns a duration in milliseconds.
fn written(duration: Duration) -> String {
    format!("{:.1}", milliseconds(duration))
}
