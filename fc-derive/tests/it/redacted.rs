//! The output of `#[derive(RedactedDebug)]`.

use fc_derive::{Message, RedactedDebug};
use fc_runtime::Message as _;

#[derive(Clone, RedactedDebug, PartialEq, Message)]
#[fc(example = r#"{"user":"a","password":"b","type":"c"}"#)]
struct Login {
    #[fc(length = 1..=9)]
    user: String,
    #[fc(length = 1..=9, sensitive)]
    password: String,
    #[fc(sensitive)]
    r#type: String,
}

#[test]
fn sensitive_fields_are_not_printed() {
    assert_eq!(
        format!("{:?}", Login::example()),
        r#"Login { user: "a", password: <redacted>, type: <redacted> }"#
    );
}
