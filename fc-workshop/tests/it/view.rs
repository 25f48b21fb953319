//! The view of a proxy's traffic.

use crate::support::small;
use fc_reflect::{Direction, Packing, Reflector};
use fc_spec::model::{Lang, Model};
use fc_workshop::capture::Flow;
use fc_workshop::decode::Decoder;
use fc_workshop::proxy::Event;
use fc_workshop::view::{View, Wish};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::io;
use std::time::Duration;

/// The lines of a wide terminal.
fn lines(view: &View<'_>) -> Vec<String> {
    lines_of(view, 110)
}

/// The lines of a terminal with this number of columns.
fn lines_of(view: &View<'_>, columns: u16) -> Vec<String> {
    let mut terminal = Terminal::new(TestBackend::new(columns, 12)).unwrap();
    terminal.draw(|frame| view.draw(frame)).unwrap();
    let shown = terminal.backend().to_string();
    let lines = shown.lines().map(|line| line.trim_matches('"').trim_end());
    lines.map(str::to_owned).collect()
}

fn press(view: &mut View<'_>, keys: &[KeyCode]) {
    for key in keys {
        let wish = view.press(KeyEvent::new(*key, KeyModifiers::NONE));
        assert_eq!(wish, Wish::Stay, "{key:?}");
    }
}

/// Adds a call that takes 2 ms. The response can be damaged.
fn call<'m>(view: &mut View<'m>, model: &'m Model, id: u32, is_damaged: bool) {
    let reflector = Reflector::new(model);
    let operation = model.operation("set_light").unwrap();
    let frame = |direction| {
        let frame = reflector.sample(operation, direction, id, Packing::Plain);
        frame.unwrap().unwrap()
    };
    let mut response = frame(Direction::Response);
    if is_damaged {
        *response.last_mut().unwrap() ^= 1;
    }
    let flow = Flow {
        from: "127.0.0.1:40000".parse().unwrap(),
        to: "127.0.0.1:5656".parse().unwrap(),
    };
    let mut decoder = Decoder::new(&reflector);
    let sink = &mut |record: &_| {
        view.add(&Event::Record(record));
        Ok::<_, io::Error>(())
    };
    let time = Duration::from_secs(u64::from(id));
    let request = frame(Direction::Request);
    decoder
        .push(Some(flow), Some(time), &request, sink)
        .unwrap();
    let time = time + Duration::from_millis(2);
    decoder
        .push(Some(flow.reversed()), Some(time), &response, sink)
        .unwrap();
}

fn view(model: &Model) -> View<'_> {
    View::new(model, Lang::En, "commands 127.0.0.1:1".to_owned())
}

#[test]
fn frames_are_rows_with_counts_and_latencies() {
    let model = small();
    let mut view = view(&model);
    call(&mut view, &model, 7, false);
    call(&mut view, &model, 8, true);
    let shown = lines(&view);
    assert_eq!(shown[0], "commands 127.0.0.1:1");
    assert!(
        shown[1].starts_with("calls 2 · reports 0 · errors 1 · responses 2.0 ms"),
        "{shown:#?}"
    );
    let response = &shown[4];
    for part in ["00:00:07.002000", "←", "set_light", "response", "2.0"] {
        assert!(response.contains(part), "{part}: {shown:#?}");
    }
    assert!(shown[6].contains("bad_digest"), "{shown:#?}");
    // A narrow terminal has no room for message ids and lengths.
    let narrow = lines_of(&view, 80);
    assert!(
        shown[2].contains("Bytes") && !narrow[2].contains("Bytes"),
        "{narrow:#?}"
    );
    assert!(narrow[6].contains("set_light") && narrow[6].contains("bad_digest"));
}

#[test]
fn a_filter_and_a_pause_choose_the_rows() {
    let model = small();
    let mut view = view(&model);
    call(&mut view, &model, 7, false);
    call(&mut view, &model, 8, true);
    press(&mut view, &[KeyCode::Char('e')]);
    let shown = lines(&view);
    assert!(
        shown[3].contains("bad_digest") && shown[4].is_empty(),
        "{shown:#?}"
    );
    press(
        &mut view,
        &[
            KeyCode::Esc,
            KeyCode::Char('/'),
            KeyCode::Char('7'),
            KeyCode::Enter,
        ],
    );
    let shown = lines(&view);
    assert!(
        shown[1].ends_with("/7") && shown[4].contains("response"),
        "{shown:#?}"
    );
    assert!(shown[5].is_empty(), "{shown:#?}");
    press(&mut view, &[KeyCode::Esc, KeyCode::Char(' ')]);
    call(&mut view, &model, 9, false);
    let shown = lines(&view);
    assert!(
        shown[1].contains("calls 3") && shown[1].ends_with("paused"),
        "{shown:#?}"
    );
    assert!(shown[7].is_empty(), "{shown:#?}");
    press(&mut view, &[KeyCode::Char(' ')]);
    assert!(lines(&view)[7].contains("set_light"));
}

#[test]
fn a_frame_opens_to_the_byte() {
    let model = small();
    let mut view = view(&model);
    call(&mut view, &model, 7, false);
    press(&mut view, &[KeyCode::Home, KeyCode::Enter]);
    let shown = lines(&view).join("\n");
    assert!(
        shown.contains("set_light request") && shown.contains("0..3 "),
        "{shown}"
    );
    press(&mut view, &[KeyCode::End, KeyCode::PageDown]);
    let shown = lines(&view);
    assert!(shown[2].starts_with("000130  3A 31"), "{shown:#?}");
    press(&mut view, &[KeyCode::Esc]);
    assert!(lines(&view)[2].contains("Operation"));
    let leave = view.press(KeyEvent::new(KeyCode::Char('q'), KeyModifiers::NONE));
    assert_eq!(leave, Wish::Leave);
}
