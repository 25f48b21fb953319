//! Faults as text: `KIND[=VALUE][:SELECTOR]…`, such as `delay=200:get_level:10%`.

use super::{Fault, FaultKind, When};
use crate::error::InputError;
use fc_spec::model::Model;
use fc_spec::text;
use std::num::NonZeroU32;
use std::time::Duration;

/// The kinds, with their placeholders.
const KINDS: &str = "delay=MS, drop-acknowledgement, duplicate-response, wrong-id, cut, bad-digest, slow=BYTES, \
                     unknown-key, unknown-value, compress";

/// The longest delay in milliseconds.
const LONGEST: u64 = 3_600_000;

impl Fault {
    /// Reads a fault. Operations have the names of the model.
    ///
    /// # Errors
    /// [`InputError`] for an unknown kind, operation or selector.
    pub fn read(model: &Model, text: &str) -> Result<Self, InputError> {
        let mut parts = text.split(':');
        let mut fault = Self {
            kind: kind(parts.next().unwrap_or_default())?,
            code: None,
            when: When::Always,
        };
        for part in parts {
            if let Some(when) = when(part)? {
                fault.when = when;
            } else {
                fault.code = Some(code(model, part)?);
            }
        }
        Ok(fault)
    }
}

fn kind(text: &str) -> Result<FaultKind, InputError> {
    let (name, value) = match text.split_once('=') {
        Some((name, value)) => (name, Some(value)),
        None => (text, None),
    };
    let delay = |value: u64| Duration::from_millis(value.min(LONGEST));
    let found = match (name, value) {
        ("delay", Some(value)) => value.parse().ok().map(|ms| FaultKind::Delay(delay(ms))),
        ("slow", Some(value)) => value.parse().ok().map(FaultKind::Slow),
        (_, None) => FaultKind::PLAIN
            .into_iter()
            .find(|kind| kind.name() == name),
        _ => None,
    };
    found.ok_or_else(|| {
        InputError(text!(
            "没有故障 `{text}`；可用的有：{KINDS}",
            "there is no fault `{text}`; the faults are {KINDS}"
        ))
    })
}

/// Reads a selector of frames by their number. Returns `None` for another selector.
fn when(part: &str) -> Result<Option<When>, InputError> {
    let wrong = || {
        InputError(text!(
            "`{part}` 不是选择条件；例如 `10%`、`every=5`、`only=3`、`after=3`",
            "`{part}` selects no frames; write for example `10%`, `every=5`, `only=3` or `after=3`"
        ))
    };
    if let Some(percent) = part.strip_suffix('%') {
        let percent = percent.parse().ok().filter(|percent| *percent <= 100);
        return percent.map(When::Chance).ok_or_else(wrong).map(Some);
    }
    let Some((name, number)) = part.split_once('=') else {
        return Ok(None);
    };
    let nonzero = number.parse::<NonZeroU32>().ok();
    let when = match name {
        "every" => nonzero.map(When::Every),
        "only" => nonzero.map(When::Only),
        "after" => number.parse().ok().map(When::After),
        _ => None,
    };
    when.ok_or_else(wrong).map(Some)
}

fn code(model: &Model, part: &str) -> Result<u16, InputError> {
    let hex = part.strip_prefix("0x").or_else(|| part.strip_prefix("0X"));
    if let Some(code) = hex.and_then(|hex| u16::from_str_radix(hex, 16).ok()) {
        return Ok(code);
    }
    let operation = model.operation(part);
    operation.and_then(|it| it.code.value).ok_or_else(|| {
        InputError(text!(
            "没有带功能码的接口 `{part}`；`fcproto codes` 列出全部接口",
            "there is no operation `{part}` with a code; `fcproto codes` lists them"
        ))
    })
}
