//! Open and closed enums with `#[derive(OpenEnum)]`.

use fc_derive::OpenEnum;
use fc_runtime::State as _;
use fc_runtime::json::to_vec;
use fc_runtime::{BodyError, FromJson, Json};

/// Open, of integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, OpenEnum)]
#[fc(repr = i16)]
enum Level {
    #[fc(value = -3)]
    Low,
    #[fc(value = 0x10)]
    High,
    #[fc(other)]
    Unknown(i16),
}

/// Closed, of integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = u64)]
enum Gate {
    #[fc(value = 0)]
    Shut,
    #[fc(value = 18446744073709551615)]
    Open,
}

/// Open, of strings.
#[derive(Clone, Debug, PartialEq, Eq, Hash, OpenEnum)]
#[fc(repr = str)]
enum Mode {
    #[fc(value = "on")]
    On,
    #[fc(value = "")]
    None,
    #[fc(other)]
    Other(String),
}

/// Open, of strings; every change there is.
#[derive(Clone, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str, order = "complete")]
enum Job {
    #[fc(value = "new", then(Done, Failed))]
    New,
    #[fc(value = "done", final)]
    Done,
    #[fc(value = "failed", then(New), error)]
    Failed,
    #[fc(other)]
    Unknown(String),
}

/// Closed, of integers; the normal order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = u8, order = "normal")]
enum Lamp {
    #[fc(value = 0, then(Warm))]
    Off,
    #[fc(value = 1, then(On))]
    Warm,
    #[fc(value = 2)]
    On,
}

/// The compiler knows it, too.
const ENDS: bool = Job::Done.is_final();

/// Closed, of strings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str)]
enum Channel {
    #[fc(value = "release")]
    Release,
    #[fc(value = "alpha")]
    Alpha,
}

/// The wire value of a closed enum is known to the compiler.
const RELEASE: &str = Channel::Release.wire();

fn read<T: FromJson>(text: &str) -> Result<T, BodyError> {
    Json::new(text)?.read_as()
}

#[test]
fn an_open_enum_keeps_unknown_values() {
    for (text, level) in [
        ("-3", Level::Low),
        ("16", Level::High),
        ("7", Level::Unknown(7)),
    ] {
        assert_eq!(read::<Level>(text), Ok(level));
        assert_eq!(to_vec(&level), text.as_bytes());
        assert_eq!(Level::from(level.wire()), level);
        assert_eq!(i16::from(level), level.wire());
    }
    assert_eq!(read::<Level>("40000").unwrap_err().name(), "out_of_range");
    assert_eq!(read::<Level>("\"7\"").unwrap_err().name(), "wrong_type");
    assert_eq!(Level::VALUES, [Level::Low, Level::High]);

    for (text, mode) in [
        ("\"on\"", Mode::On),
        ("\"\"", Mode::None),
        ("\"开\\n\"", Mode::Other("开\n".into())),
    ] {
        assert_eq!(read::<Mode>(text), Ok(mode.clone()));
        assert_eq!(to_vec(&mode), text.as_bytes());
        assert_eq!(Mode::from(mode.wire()), mode);
    }
    assert_eq!(read::<Mode>("\"\\u006fn\""), Ok(Mode::On));
    assert_eq!(Mode::VALUES, [Mode::On, Mode::None]);
}

#[test]
fn a_closed_enum_refuses_unknown_values() {
    assert_eq!(read::<Gate>("18446744073709551615"), Ok(Gate::Open));
    assert_eq!(Gate::try_from(0), Ok(Gate::Shut));
    assert_eq!(read::<Gate>("1").unwrap_err().name(), "unknown_value");
    assert_eq!(read::<Channel>("\"alpha\""), Ok(Channel::Alpha));
    let error = read::<Vec<Channel>>(r#"["alpha","beta"]"#).unwrap_err();
    assert_eq!(
        (error.name(), error.path(), error.offset()),
        ("unknown_value", "[1]", 9)
    );
    assert_eq!(RELEASE, "release");
}

#[test]
fn declared_successors_are_returned() {
    let unknown = Job::from("paused");
    for (previous, next, may) in [
        (Job::New, Job::Done, true),
        (Job::New, Job::Failed, true),
        (Job::New, Job::New, false),
        (Job::Failed, Job::New, true),
        (Job::Failed, Job::Done, false),
        (Job::Done, Job::New, false),
        (Job::Done, unknown.clone(), true),
        (unknown.clone(), Job::New, true),
        (unknown.clone(), unknown.clone(), true),
    ] {
        assert_eq!(next.may_follow(&previous), may, "{previous:?}, {next:?}");
    }
    let marks = |job: Job| (job.is_final(), job.is_error());
    assert_eq!(marks(Job::New), (false, false));
    assert_eq!(marks(Job::Done), (ENDS, false));
    assert_eq!(marks(Job::Failed), (false, true));
    assert_eq!(marks(unknown), (false, false));

    for (previous, next, does) in [
        (Lamp::Off, Lamp::Warm, true),
        (Lamp::Warm, Lamp::On, true),
        (Lamp::Off, Lamp::On, false),
        (Lamp::On, Lamp::Off, false),
    ] {
        assert_eq!(
            next.normally_follows(&previous),
            does,
            "{previous:?}, {next:?}"
        );
    }
}

/// A repeated state and a failure are always in order, as is any state without a rule.
#[test]
fn order_allows_all_but_contradictions() {
    let unknown = Job::from("paused");
    for (previous, next, is) in [
        (Job::New, Job::Done, true),
        (Job::New, Job::New, true),
        (Job::Done, Job::Failed, true),
        (Job::Done, Job::New, false),
        (Job::Failed, Job::Done, false),
        (Job::Done, unknown, true),
    ] {
        assert_eq!(next.is_in_order(&previous), is, "{previous:?}, {next:?}");
        assert_eq!(
            (next.is_end(), next.says_failed()),
            (next.is_final(), next.is_error())
        );
    }
    for (previous, next, is) in [
        (Lamp::Off, Lamp::Warm, true),
        (Lamp::Off, Lamp::Off, true),
        (Lamp::Off, Lamp::On, false),
        (Lamp::On, Lamp::Off, true),
    ] {
        assert_eq!(next.is_in_order(&previous), is, "{previous:?}, {next:?}");
        assert!(!next.is_end() && !next.says_failed());
    }
}
