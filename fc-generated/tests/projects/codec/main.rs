use fc_generated::RequestEnvelope;
use fc_generated::prelude::*;
use fc_generated::runtime::{Decoder, Encoder, FrameId, read_enveloped};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut bytes = Vec::new();
    let request = FrameId {
        response: false,
        kind: Fc::COMMAND,
        code: GetRobotSnRequest::CODE,
        id: 1,
    };
    let envelope = RequestEnvelope {
        cmd_time: Some(1_700_000_000_000),
    };
    Encoder::<Fc>::new().message(&mut bytes, request, &envelope, &GetRobotSnRequest::new())?;

    let mut decoder = Decoder::<Fc>::new();
    decoder.push(&bytes);
    while let Some(frame) = decoder.next()? {
        let allowance = Fc::DEFAULTS.limits.json();
        let read = read_enveloped::<RequestEnvelope, GetRobotSnRequest>(frame.body(), allowance)?;
        println!("0x{:04X} {:?}", frame.id().code, read.body?);
    }
    Ok(())
}
