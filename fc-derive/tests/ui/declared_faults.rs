//! Each variant of an enum of errors has a unique result code, a text, and nothing else.

use fc_derive::DeclaredError;

#[derive(Clone, Copy, Debug, DeclaredError)]
enum DriveError {
    #[fc(code = 2001)]
    Blocked,
    #[fc(text = "no")]
    Refused,
    #[fc(code = 2.5, text = "no")]
    Half,
    #[fc(code = 9223372036854775808, text = "no")]
    TooLarge,
    #[fc(code = 2002, text = "no")]
    Slow(u8),
    #[fc(code = 2002, text = "no", retry = true)]
    Again,
}

fn main() {}
