//! Scenarios from damaged and endless recordings.

use crate::decode::sampled;
use crate::support::small;
use fc_reflect::Reflector;
use fc_workshop::capture::Ports;
use fc_workshop::decode::{self, Format, Record, Source};
use fc_workshop::replay::Recorded;
use std::time::{Duration, Instant};

/// Adds the example of an operation to a scenario, with this message id and time.
fn add<'m>(
    recorded: &mut Recorded<'m>,
    reflector: &'m Reflector<'m>,
    name: &str,
    id: u32,
    time: Duration,
) {
    let model = reflector.model();
    let bytes = sampled(model, name, id);
    let source = Source {
        input: bytes.as_slice(),
        format: Some(Format::Binary),
        ports: Ports::new(model, &[]),
    };
    let read = decode::read(reflector, source, &mut |record| {
        recorded.add(&Record {
            time: Some(time),
            flow: record.flow,
            offset: record.offset,
            length: record.length,
            bytes: record.bytes.clone(),
            id: record.id,
            kind: record.kind,
            operation: record.operation,
            header: Vec::new(),
            frame: record.frame.clone(),
            message: None,
            error: None,
            request: None,
        });
        Ok(())
    });
    read.unwrap();
}

#[test]
fn waits_between_impossible_times_fit_the_clock() {
    let model = small();
    let reflector = Reflector::new(&model);
    let mut recorded = Recorded::new(&model);
    add(&mut recorded, &reflector, "set_light", 1, Duration::ZERO);
    add(&mut recorded, &reflector, "dimmed", 1, Duration::ZERO);
    add(&mut recorded, &reflector, "dimmed", 2, Duration::MAX);
    let scenario = recorded.finish().unwrap();
    let now = Instant::now();
    assert!(now.checked_add(scenario.within).is_some());
    let reports = scenario.rules[0].action.reports.as_deref().unwrap();
    assert_eq!(reports.len(), 2);
    let last = reports
        .iter()
        .try_fold(now, |due, report| due.checked_add(report.after));
    assert!(last.is_some());
}

#[test]
fn an_endless_recording_is_too_long() {
    let model = small();
    let reflector = Reflector::new(&model);
    let mut recorded = Recorded::new(&model);
    add(&mut recorded, &reflector, "set_light", 1, Duration::ZERO);
    for id in 0..100_000 {
        add(&mut recorded, &reflector, "dimmed", id, Duration::ZERO);
    }
    assert_eq!(recorded.finish(), None);
}
