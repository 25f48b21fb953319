//! The terminal of a view: pictures and keys.

use super::{View, Wish};
use crate::proxy;
use crate::run::Interrupt;
use ratatui::crossterm::event::{self, Event, KeyEvent, KeyEventKind};
use std::cell::RefCell;
use std::io;
use std::thread;
use std::time::Duration;
use tokio::sync::mpsc::{Receiver, channel};
use tokio::time::{MissedTickBehavior, interval};

/// The time between two pictures. More of them would take the processor from the traffic.
const PICTURE: Duration = Duration::from_millis(100);

/// Keys that wait.
const KEYS: usize = 64;

/// Shows a view until a person leaves it or a signal comes. The terminal is as before afterwards.
///
/// # Errors
/// The terminal cannot be used.
pub async fn show(view: &RefCell<View<'_>>, interrupt: &mut Interrupt) -> io::Result<()> {
    let mut terminal = ratatui::try_init()?;
    let _restored = Restored;
    let mut keys = keys();
    let mut ticks = interval(PICTURE);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        terminal.draw(|frame| view.borrow().draw(frame))?;
        tokio::select! {
            () = interrupt.next() => return Ok(()),
            _ = ticks.tick() => {}
            // The last key is an error. After it, none comes.
            Some(key) = keys.recv() => {
                if view.borrow_mut().press(key?) == Wish::Leave {
                    return Ok(());
                }
            }
        }
    }
}

/// Returns the sink of a proxy that fills a view.
pub fn sink<'m>(view: &RefCell<View<'m>>) -> impl FnMut(proxy::Event<'_, 'm>) -> io::Result<()> {
    |event| {
        view.borrow_mut().add(&event);
        Ok(())
    }
}

/// Restores the terminal when it is dropped, also if an error of the proxy ends the view.
struct Restored;

impl Drop for Restored {
    fn drop(&mut self) {
        ratatui::restore();
    }
}

/// Reads keys on another thread, because reading blocks. The thread ends with the receiver, or with the program.
fn keys() -> Receiver<io::Result<KeyEvent>> {
    let (sender, receiver) = channel(KEYS);
    thread::spawn(move || {
        loop {
            let key = match event::read() {
                Ok(Event::Key(key)) if key.kind != KeyEventKind::Release => Ok(key),
                Ok(_) => continue,
                Err(error) => Err(error),
            };
            let is_last = key.is_err();
            if sender.blocking_send(key).is_err() || is_last {
                return;
            }
        }
    });
    receiver
}
