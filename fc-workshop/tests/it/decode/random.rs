//! Random inputs in every format.

use crate::support::{Numbers, small};
use fc_reflect::{Direction, Packing, Reflector};
use fc_workshop::capture::Ports;
use fc_workshop::decode::{self, Format, Source};

/// Short inputs of parts of frames and noise. `FC_FRAMES` is their number.
#[test]
fn random_streams_do_not_panic() {
    let count = std::env::var("FC_FRAMES").ok();
    let count = count.map_or(2_000, |count| count.parse().expect("a number"));
    let model = small();
    let reflector = Reflector::new(&model);
    let operation = model.operation("dimmed").unwrap();
    let frame = reflector.sample(operation, Direction::Request, 7, Packing::Plain);
    let frame = frame.unwrap().unwrap();
    let mut numbers = Numbers(3);
    let formats = [
        None,
        Some(Format::Binary),
        Some(Format::Hex),
        Some(Format::Base64),
        Some(Format::Capture),
        Some(Format::Tcpdump),
    ];
    for number in 0..count {
        let mut input = Vec::new();
        for _ in 0..numbers.below(6) {
            if numbers.below(2) == 0 {
                let from = numbers.below(frame.len());
                input.extend(&frame[from..from + numbers.below(frame.len() - from + 1)]);
            } else {
                let count = numbers.below(40);
                input.extend((0..count).map(|_| numbers.next().to_le_bytes()[0]));
            }
        }
        let format = formats[number % formats.len()];
        let source = Source {
            input: &*input,
            format,
            ports: Ports::new(&model, &[]),
        };
        let mut covered = 0;
        let result = decode::read(&reflector, source, &mut |record| {
            covered += record.length;
            let _ = (
                decode::json(record),
                decode::text(record, &model, fc_spec::model::Lang::Zh),
            );
            Ok(())
        });
        if format == Some(Format::Binary) {
            result.unwrap();
            assert_eq!(covered, input.len() as u64, "{input:x?}");
        }
    }
}
