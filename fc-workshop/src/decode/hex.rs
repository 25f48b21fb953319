//! Reads hexadecimal text, with or without positions and characters, as `xxd` and other tools print it.

use crate::dump::{columns, positioned};
use crate::error::InputError;
use fc_spec::text;

/// The maximum length of a line with a position. A longer line contains digits only.
const LONGEST: usize = 4096;

/// Turns hexadecimal text into bytes. It keeps at most one line.
#[derive(Debug, Default)]
pub struct HexText {
    line: Vec<u8>,
    /// The number of the line, from 1 when it is read.
    number: usize,
    /// `true` after the beginning of a line that is longer than the limit.
    is_long: bool,
    /// The first digit of a byte.
    half: Option<u8>,
}

impl HexText {
    /// Appends the bytes of the next part of the text to `out`.
    ///
    /// # Errors
    /// A character that is neither a digit nor a separator.
    pub fn push(&mut self, input: &[u8], out: &mut Vec<u8>) -> Result<(), InputError> {
        for part in input.split_inclusive(|byte| *byte == b'\n') {
            self.line.extend_from_slice(part);
            if part.ends_with(b"\n") {
                self.end_line(out)?;
            } else if self.line.len() > LONGEST {
                // The last characters can be the beginning of `0x`.
                let kept = self.line.split_off(self.line.len().saturating_sub(1));
                let line = std::mem::replace(&mut self.line, kept);
                self.digits(&line, out)?;
                self.is_long = true;
            }
        }
        Ok(())
    }

    /// Ends the text.
    ///
    /// # Errors
    /// Half a byte at the end.
    pub fn finish(&mut self, out: &mut Vec<u8>) -> Result<(), InputError> {
        self.end_line(out)?;
        if self.half.is_some() {
            return Err(InputError(text!(
                "最后一个字节只有一个十六进制数字；请补全输入",
                "the last byte has one hexadecimal digit; complete the input"
            )));
        }
        Ok(())
    }

    fn end_line(&mut self, out: &mut Vec<u8>) -> Result<(), InputError> {
        self.number += 1;
        let line = std::mem::take(&mut self.line);
        if std::mem::take(&mut self.is_long) {
            return self.digits(&line, out);
        }
        let trimmed = line.trim_ascii();
        if trimmed == b"*" {
            let number = self.number;
            return Err(InputError(text!(
                "第 {number} 行省略了重复的行；用 `hexdump -v` 重新输出",
                "line {number} stands for repeated lines; print them with `hexdump -v`"
            )));
        }
        match positioned(trimmed) {
            Some(rest) => self.digits(columns(rest), out),
            None => self.digits(trimmed, out),
        }
    }

    /// Reads digits with separators between them.
    fn digits(&mut self, text: &[u8], out: &mut Vec<u8>) -> Result<(), InputError> {
        let mut rest = text;
        while let Some((byte, after)) = rest.split_first() {
            rest = after;
            let digit = char::from(*byte)
                .to_digit(16)
                .and_then(|digit| u8::try_from(digit).ok());
            match (digit, self.half) {
                (Some(0), None) if matches!(after, [b'x' | b'X', ..]) => {
                    rest = after.get(1..).unwrap_or_default();
                }
                (Some(digit), None) => self.half = Some(digit),
                (Some(digit), Some(half)) => {
                    out.push(half << 4 | digit);
                    self.half = None;
                }
                (None, None) if *byte == b'\\' && matches!(after, [b'x', ..]) => {
                    rest = after.get(1..).unwrap_or_default();
                }
                (None, _) if byte.is_ascii_whitespace() || b",:;-\"'{}[]()".contains(byte) => {}
                (None, _) => {
                    let number = self.number.max(1);
                    let found = byte.escape_ascii().to_string();
                    return Err(InputError(text!(
                        "第 {number} 行的 `{found}` 不是十六进制数字；用 --input 指定格式",
                        "`{found}` in line {number} is not a hexadecimal digit; name the format with --input"
                    )));
                }
            }
        }
        Ok(())
    }
}
