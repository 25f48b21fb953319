//! The cases whose instructions are counted.

use fc_bench_cases::{messages, synthetic};
use fc_codegen::emit;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_generated::{ExampleRobot, Fc, GetStationRequest, RequestEnvelope, ResponseEnvelope, RobotService};
use fc_runtime::{
    Command as _, Decoder, Encoder, FrameId, Message, Protocol, RequestEnvelope as _, Server, ServerConfig,
    read_enveloped,
};
use fc_spec::diagnostic::Faults;
use fc_spec::{load, syntax};
use std::hint::black_box;
use std::net::Ipv4Addr;
use std::path::Path;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

/// A case: some work that is repeated and counted.
pub struct Case {
    /// Name on the command line and in the budget.
    pub name: &'static str,
    /// Name of a unit.
    pub unit: &'static str,
    /// Number of runs. The count is the difference between this number of runs and twice as many. If it is 1, the
    /// count is the difference between no run and one.
    pub times: usize,
    /// Number of units in each run.
    pub units: usize,
}

/// All cases.
pub const CASES: &[Case] = &[
    Case { name: "decode_small", unit: "frame", times: 2000, units: 1 },
    Case { name: "decode_medium", unit: "frame", times: 40, units: 1 },
    Case { name: "encode_small", unit: "frame", times: 2000, units: 1 },
    Case { name: "encode_medium", unit: "frame", times: 40, units: 1 },
    Case { name: "dispatch", unit: "request", times: 40, units: DISPATCHED },
    Case { name: "generate", unit: "run over sixty commands", times: 1, units: 1 },
    Case { name: "stubs", unit: "run over sixty commands", times: 1, units: 1 },
];

/// Requests in each run of `dispatch`.
const DISPATCHED: usize = 100;
/// Number of commands in the spec for the generator. The spec is synthetic, so that changes of the project's spec do
/// not affect the budget.
const GENERATED: usize = 60;

/// The products of every project.
const PRODUCTS: [Product; 4] = [Product::Rust, Product::Markdown, Product::Vectors, Product::Schema];
/// The packages of other languages.
const STUBS: [Product; 4] = [Product::TypeScript, Product::Python, Product::Kotlin, Product::Cpp];

/// Runs a case this number of times.
///
/// # Errors
/// If the case does not exist or fails.
pub fn run(case: &str, times: usize) -> Result<(), String> {
    match case {
        "decode_small" => decode(&messages::small(messages::STATION), times),
        "decode_medium" => decode(&messages::medium(), times),
        "encode_small" => encode(&messages::small(messages::STATION), times),
        "encode_medium" => encode(&messages::medium(), times),
        "dispatch" => return dispatch(times),
        "generate" => return generate(&PRODUCTS, times),
        "stubs" => return generate(&STUBS, times),
        other => return Err(format!("there is no case `{other}`")),
    }
    Ok(())
}

fn decode<M: Message>(message: &M, times: usize) {
    let mut frame = Vec::new();
    let encoded = Encoder::<Fc>::new().message(&mut frame, messages::station_id(), &messages::envelope(), message);
    assert!(encoded.is_ok(), "the message does not fit");
    let mut decoder = Decoder::<Fc>::new();
    for _ in 0..times {
        decoder.push(black_box(&frame));
        let frame = decoder.next().ok().flatten().map(|frame| {
            let allowance = Fc::DEFAULTS.limits.json();
            read_enveloped::<ResponseEnvelope, M>(frame.body(), allowance).map(|read| read.body.is_ok())
        });
        assert_eq!(frame, Some(Ok(true)), "the frame does not decode");
    }
}

fn encode<M: Message>(message: &M, times: usize) {
    let envelope = messages::envelope();
    let mut encoder = Encoder::<Fc>::new();
    let mut out = Vec::new();
    for _ in 0..times {
        out.clear();
        let encoded = encoder.message(&mut out, messages::station_id(), black_box(&envelope), black_box(message));
        assert!(encoded.is_ok(), "the message does not fit");
        black_box(&out);
    }
}

/// Sends requests through a server without sockets: framing, `match` on the code, typed reading, handler and response.
///
/// All requests ask for a station, so that the count does not depend on other examples of the spec.
fn dispatch(times: usize) -> Result<(), String> {
    let runtime =
        tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(|error| error.to_string())?;
    runtime.block_on(async {
        let config = ServerConfig::new().address(Ipv4Addr::LOCALHOST).command_port(0).data_port(0);
        let server = Server::bind(config, RobotService::new(ExampleRobot::default()))
            .await
            .map_err(|error| error.to_string())?;
        let (mut near, far) = tokio::io::duplex(1 << 20);
        server.handle().serve(far, (Ipv4Addr::LOCALHOST, 0).into()).ok_or("no room for a connection")?;
        let requests = requests()?;
        let mut decoder = Decoder::<Fc>::new();
        let mut input = vec![0; 1 << 16];
        for _ in 0..times {
            near.write_all(&requests).await.map_err(|error| error.to_string())?;
            let mut answers = 0;
            while answers < DISPATCHED {
                let read = near.read(&mut input).await.map_err(|error| error.to_string())?;
                decoder.push(input.get(..read).unwrap_or_default());
                while decoder.next().map_err(|error| error.to_string())?.is_some() {
                    answers += 1;
                }
            }
        }
        Ok(())
    })
}

/// Returns frames with requests for a station.
fn requests() -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    let mut encoder = Encoder::<Fc>::new();
    for id in (1..).take(DISPATCHED) {
        let id = FrameId { response: false, kind: Fc::COMMAND, code: GetStationRequest::CODE, id };
        let envelope = RequestEnvelope::at(messages::TIME);
        encoder.message(&mut out, id, &envelope, &messages::station_request()).map_err(|error| error.to_string())?;
    }
    Ok(out)
}

/// Generates products from a synthetic spec without writing them.
fn generate(products: &[Product], times: usize) -> Result<(), String> {
    let root = tempfile::tempdir().map_err(|error| error.to_string())?;
    synthetic::write_spec(root.path(), GENERATED).map_err(|error| error.to_string())?;
    for _ in 0..times {
        let mut faults = Faults::new();
        let sources = syntax::read_dir(root.path(), Path::new("spec"), &mut faults);
        let model = load::load(&sources, &mut faults).model().ok_or("the spec has faults")?;
        let made = emit::generate(&model, &Targets::of(products.iter().copied()));
        black_box(made.map_err(|error| error.to_string())?);
    }
    Ok(())
}
