//! Sudden faults of a wire.

use super::model::{Shared, lock};
use super::random::Random;
use std::time::Duration;

/// Does something to one of the last wires, if it is there and sound.
pub fn storm(model: &Shared, random: &mut Random) {
    let mut model = lock(model);
    let wires = &model.wires;
    let Some(wire) = wires
        .len()
        .checked_sub(1 + random.below(3))
        .and_then(|at| wires.get(at))
        .filter(|wire| wire.is_sound())
    else {
        return;
    };
    let what = match random.below(16) {
        which @ 0..3 => {
            wire.swallow(which);
            ["requests swallowed", "answers swallowed", "all swallowed"][which]
        }
        3..5 => {
            wire.reset();
            "connections broken"
        }
        5..7 => {
            wire.half_close(true);
            "half-closes by the app"
        }
        7 => {
            wire.half_close(false);
            "half-closes by the robot"
        }
        which @ 8..11 => {
            let up = which < 10;
            let what = wire.garble(up, random);
            model.log.push(what.into());
            if up {
                "garbage to the robot"
            } else {
                "garbage to the app"
            }
        }
        11 => {
            wire.stop_inside(true);
            "apps that stop inside a frame"
        }
        12 => {
            wire.stop_inside(false);
            "robots that stop inside a frame"
        }
        13 => {
            wire.pause(false, Duration::from_secs(1) + random.ms(30_000));
            "robots that say nothing for long"
        }
        14 => {
            wire.fill(true);
            "robots that do not read"
        }
        _ => {
            wire.fill(false);
            "apps that do not read"
        }
    };
    model.event(what);
}
