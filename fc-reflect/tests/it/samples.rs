//! Messages and frames made from the examples of a spec, and responses to decoded requests.

use crate::support;
use crate::support::typed::{Typed, Verdict};
use fc_generated::Fc;
use fc_reflect::sample::{SAMPLE_ID, STREAM_BYTES};
use fc_reflect::{Decoded, Direction, FrameId, Node, Packing, Reflector, Value};
use fc_runtime::{Allowance, Empty, Protocol, ResponseEnvelope as _, read_enveloped};
use fc_spec::model::{EnvelopeRole, Kind, Model, Operation, ResultCode, ResultRole};

const PACKINGS: [Packing; 2] = [Packing::Plain, Packing::Gzip { level: 6 }];

/// The project's own model, and the models of other protocols.
fn models() -> Vec<Model> {
    let mut models = vec![support::specs::model()];
    models.extend(support::specs::others());
    models
}

/// Returns the operations that have a code, with each direction in which they send a frame.
fn sides(model: &Model) -> impl Iterator<Item = (&Operation, Direction)> {
    let coded = |operation: &&Operation| operation.code.value.is_some();
    let operations = model.operations.iter().filter(coded);
    operations.flat_map(|operation| {
        let directions = operation.directions().iter();
        directions.map(move |direction| (operation, *direction))
    })
}

/// Returns the sample frame of an operation, encoded and decoded.
fn sample<'m>(
    reflector: &Reflector<'m>,
    operation: &Operation,
    direction: Direction,
    packing: Packing,
) -> (Vec<u8>, Decoded<'m>) {
    let bytes = reflector.sample(operation, direction, SAMPLE_ID, packing);
    let bytes = bytes.expect("it has a code").expect("it is short");
    let decoded = reflector.decode(&bytes);
    let decoded = decoded.unwrap_or_else(|error| panic!("{} {error}", operation.name));
    (bytes, decoded)
}

#[test]
fn every_sample_reads_back() {
    for model in models() {
        let reflector = Reflector::new(&model);
        let mut count = 0;
        for (operation, direction) in sides(&model) {
            let place = format!("{} {}", operation.name, direction.name());
            let data = reflector.samples().data(operation, direction);
            for packing in PACKINGS {
                let (_, Decoded { frame, message }) =
                    sample(&reflector, operation, direction, packing);
                let id = reflector.id(operation, direction, SAMPLE_ID);
                assert_eq!(Some(frame.id), id, "{place}");
                assert_eq!(frame.data, data, "{place}");
                let found = frame.operation.map(|found| &found.name);
                assert_eq!(found, Some(&operation.name), "{place}");
                let Some(message) = message else {
                    assert_eq!(frame.data, STREAM_BYTES, "{place}");
                    continue;
                };
                let canonical = message.canonical().expect("it has been read");
                assert_eq!(canonical.as_bytes(), data, "{place}");
                let known = match operation.kind() {
                    Kind::Stream => 0,
                    Kind::Command | Kind::Report => reflector.samples().envelope(direction).len(),
                };
                assert_eq!(message.envelope.len(), known, "{place}");
            }
            count += 1;
        }
        assert!(count >= 5, "{}: {count}", model.protocol.id);
    }
}

/// Returns the value of the envelope field with this role.
fn under<'a>(envelope: &'a [Node<'_>], model: &Model, role: EnvelopeRole) -> Option<&'a Value<'a>> {
    let field = model
        .envelope
        .response
        .iter()
        .find(|field| field.role == role)?;
    let node = envelope.iter().find(|node| node.wire() == field.wire)?;
    Some(&node.value)
}

/// Returns the responses to a request: the example, and one for each result of the spec.
fn answers<'m>(
    model: &'m Model,
    reflector: &Reflector<'m>,
    operation: &Operation,
    packing: Packing,
) -> Vec<(Option<&'m ResultCode>, FrameId, Vec<u8>)> {
    let (_, request) = sample(reflector, operation, Direction::Request, packing);
    let says_how_it_went = model.envelope.result_code().is_some();
    let results = model.results.iter().filter(|_| says_how_it_went);
    let results = std::iter::once(None).chain(results.map(Some));
    let answer = |result| {
        let bytes = reflector.answer(&request.frame, result, packing);
        (
            result,
            request.frame.id,
            bytes.expect("it is answered").expect("it is short"),
        )
    };
    results.map(answer).collect()
}

fn answered(model: &Model) -> impl Iterator<Item = &Operation> {
    let responses = sides(model).filter(|(_, direction)| *direction == Direction::Response);
    responses.map(|(operation, _)| operation)
}

#[test]
fn answer_has_the_request_id_and_chosen_result() {
    for model in models() {
        let reflector = Reflector::new(&model);
        for operation in answered(&model) {
            let example = reflector.samples().data(operation, Direction::Response);
            for (result, request, bytes) in answers(&model, &reflector, operation, Packing::Plain) {
                let place = format!("{} {result:?}", operation.name);
                let frame = reflector.frame(&bytes).expect(&place);
                assert_eq!(frame.id, request.answer(), "{place}");
                let Some(result) = result else {
                    assert_eq!(frame.data, example, "{place}");
                    continue;
                };
                let message = reflector.message(frame.operation, frame.id.direction, &frame.data);
                let message = message.expect(&place);
                let found = under(&message.envelope, &model, EnvelopeRole::ResultCode);
                let is_it =
                    |found| matches!(found, &Value::Int(code) if code == result.code.into());
                assert!(found.is_some_and(is_it), "{place}: {found:?}");
                if result.role == Some(ResultRole::Success) {
                    let own = message.body.expect(&place);
                    assert_eq!(
                        own.is_empty(),
                        has_no_keys(&reflector, operation),
                        "{place}"
                    );
                    continue;
                }
                let found = under(&message.envelope, &model, EnvelopeRole::ResultText);
                let is_it = |found: &Value<'_>| matches!(found, Value::Text(text) if *text == result.text.zh);
                assert!(found.is_none_or(is_it), "{place}: {found:?}");
                assert!(message.body.is_err() || message.body.is_ok_and(|own| own.is_empty()));
            }
        }
    }
}

fn has_no_keys(reflector: &Reflector<'_>, operation: &Operation) -> bool {
    use fc_reflect::sample::Profile::Example;
    let body = reflector
        .samples()
        .body(operation, Direction::Response, Example);
    body.to_string() == "{}"
}

#[test]
fn generated_package_reads_samples_and_answers() {
    let model = support::specs::model();
    let reflector = Reflector::new(&model);
    let typed = Typed::new(&model);
    let taken = |bytes: &[u8], place: &str| match typed.verdict(bytes, Allowance::ANY) {
        Verdict::Taken { data, .. } => data,
        refused @ Verdict::Refused(..) => panic!("{place}: {refused:?}"),
    };
    for packing in PACKINGS {
        for (operation, direction) in sides(&model) {
            let (bytes, decoded) = sample(&reflector, operation, direction, packing);
            assert_eq!(
                taken(&bytes, &operation.name),
                decoded.frame.data,
                "{}",
                operation.name
            );
        }
        for operation in answered(&model) {
            for (result, _, bytes) in answers(&model, &reflector, operation, packing) {
                let data = reflector.frame(&bytes).expect("a frame").data;
                let is_whole = |result: &ResultCode| result.role == Some(ResultRole::Success);
                if result.is_none_or(is_whole) {
                    assert_eq!(taken(&bytes, &operation.name), data, "{}", operation.name);
                }
                // A refusal contains only an envelope.
                let read =
                    read_enveloped::<<Fc as Protocol>::Response, Empty>(&data, Allowance::ANY);
                let envelope = read.expect("an envelope").envelope;
                if let Some(result) = result {
                    assert_eq!(envelope.result_code(), Some(result.code));
                }
            }
        }
    }
}

#[test]
fn operation_without_response_has_no_answer() {
    let model = support::specs::small();
    let reflector = Reflector::new(&model);
    let result = model.results.last();
    let answer = |id: FrameId, result| {
        let bytes = reflector.seal(id, b"{}", Packing::Plain).expect("short");
        let frame = reflector.frame(&bytes).expect("a frame");
        let answer = reflector.answer(&frame, result, Packing::Plain)?;
        Some(reflector.frame(&answer.expect("short")).expect("a frame"))
    };
    let light = model.operation("set_light").expect("known");
    let light = reflector.id(light, Direction::Request, 7).expect("a code");
    assert!(answer(light, None).is_some());
    assert!(answer(light.answer(), result).is_none());
    let film = model.operation("film").expect("known");
    let film = reflector.id(film, Direction::Request, 7).expect("a code");
    assert!(answer(film, result).is_none());

    // A request with an unknown code can be refused, but has no sample response.
    let unknown = FrameId {
        code: 0xFFFF,
        ..light
    };
    assert!(answer(unknown, None).is_none());
    let refusal = answer(unknown, result).expect("a refusal");
    assert_eq!(refusal.id, unknown.answer());
    let text = String::from_utf8(refusal.data).expect("text");
    assert_eq!(text, r#"{"at":1700000000000,"rc":4,"say":"过期"}"#);

    let uncoded = fc_spec::model::Code {
        value: None,
        ..model.operation("set_light").expect("known").code.clone()
    };
    let mut model = model.clone();
    for operation in &mut model.operations {
        operation.code = uncoded.clone();
    }
    let reflector = Reflector::new(&model);
    let light = model.operation("set_light").expect("known");
    let frame = reflector.sample(light, Direction::Request, 7, Packing::Plain);
    assert!(frame.is_none());
    assert!(
        !reflector
            .samples()
            .data(light, Direction::Request)
            .is_empty()
    );
}

/// A response without a result code can only report success.
#[test]
fn protocol_without_results_has_no_refusal() {
    let silent = |model: &Model| model.envelope.result_code().is_none();
    for model in models().into_iter().filter(silent) {
        let reflector = Reflector::new(&model);
        let operation = answered(&model).next().expect("one is answered");
        let (_, request) = sample(&reflector, operation, Direction::Request, Packing::Plain);
        for result in &model.results {
            let answer = reflector.answer(&request.frame, Some(result), Packing::Plain);
            let is_success = result.role == Some(ResultRole::Success);
            assert_eq!(answer.is_some(), is_success, "{}", result.code);
        }
    }
}
