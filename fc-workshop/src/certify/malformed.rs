//! Frames with errors.

use super::line::{Evidence, Next, Step, Stop, deviates, gzip};
use super::requests::refused;
use super::robot::Stage;
use crate::facts;
use fc_reflect::{FrameId, Packing};
use fc_spec::model::{HeaderRole, ResultRole};
use fc_spec::text;

pub(super) async fn bad_head(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (_, mut bytes) = stage.frame(1)?;
    let head = stage.model().frame.field(HeaderRole::Head);
    let head = head.ok_or_else(|| lacks(HeaderRole::Head))?;
    if let Some(byte) = bytes.get_mut(head.offset) {
        *byte ^= 0xFF;
    }
    ends(stage, evidence, &bytes).await
}

/// Sends a frame whose header has another length. `u64::MAX` is the largest that fits.
pub(super) async fn wrong_length(
    stage: &Stage<'_, '_>,
    evidence: &mut Evidence,
    length: u64,
) -> Step {
    let (_, mut bytes) = stage.frame(1)?;
    let overwritten = length.min(u64::from(u32::MAX));
    let role = HeaderRole::TotalLength;
    stage.reflector.overwrite(&mut bytes, role, overwritten);
    ends(stage, evidence, &bytes).await
}

/// Sends bytes after which the next frame cannot be found. The device must close the connection, and serve others.
async fn ends(stage: &Stage<'_, '_>, evidence: &mut Evidence, bytes: &[u8]) -> Step {
    let mut line = stage.connect(evidence).await?;
    line.send(bytes).await;
    let wait = facts::call_timeout(stage.model());
    loop {
        match line.next(wait).await? {
            Next::Closed => break,
            Next::Frame(_) => {}
            Next::Silence => {
                return deviates(text!(
                    "设备没有断开连接",
                    "the device has not closed the connection"
                ));
            }
        }
    }
    stage.serves().await
}

fn lacks(role: HeaderRole) -> Stop {
    let role = role.name();
    Stop::Skip(text!("帧头没有 `{role}`", "the header has no `{role}`"))
}

pub(super) async fn unknown_kind(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let kinds = &stage.model().frame.kinds;
    if stage.model().frame.field(HeaderRole::Kind).is_none() {
        return Err(lacks(HeaderRole::Kind));
    }
    let (id, message) = stage.probe(1)?;
    let unknown = (0..=u8::MAX).find(|kind| kinds.with_value(*kind).is_none());
    let kind = unknown.ok_or_else(|| lacks(HeaderRole::Kind))?;
    let bytes = stage.plain(FrameId { kind, ..id }, &message)?;
    let mut line = stage.connect(evidence).await?;
    line.send(&bytes).await;
    // The refusal has the unknown kind, too, so only the connection is checked.
    line.tolerate_errors();
    stage.ask(&mut line, 2).await
}

pub(super) async fn bad_digest(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    if stage.model().frame.field(HeaderRole::Digest).is_none() {
        return Err(lacks(HeaderRole::Digest));
    }
    let (id, mut bytes) = stage.frame(1)?;
    let role = HeaderRole::Digest;
    stage.reflector.overwrite(&mut bytes, role, 0xBAD);
    refused(stage, evidence, id, &bytes, ResultRole::Protocol).await
}

/// Returns the frame of data that claims to be compressed, with this length after decompression.
fn packed(stage: &Stage<'_, '_>, data: &[u8], plain_length: u64) -> Step<(FrameId, Vec<u8>)> {
    let gzip = gzip(stage.model())?;
    let (id, _) = stage.probe(1)?;
    let mut bytes = stage.seal(id, data, Packing::Plain)?;
    let value = u64::from(gzip.value);
    stage
        .reflector
        .overwrite(&mut bytes, HeaderRole::Encoding, value);
    let role = HeaderRole::PlainLength;
    stage.reflector.overwrite(&mut bytes, role, plain_length);
    Ok((id, bytes))
}

pub(super) async fn bad_gzip(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, bytes) = packed(stage, b"not compressed", 100)?;
    refused(stage, evidence, id, &bytes, ResultRole::Protocol).await
}

pub(super) async fn gzip_bomb(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let limit = stage.model().limits.inflated_bytes;
    let (_, bytes) = packed(stage, b"not compressed", u64::from(limit) + 1)?;
    endured(stage, evidence, &bytes).await
}

pub(super) async fn deep_nesting(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, _) = stage.probe(1)?;
    let most = usize::try_from(stage.model().limits.frame_bytes).unwrap_or(usize::MAX);
    let depth = 100_000.min(most / 16).max(1000);
    let data = ["{\"a\":", &"[".repeat(depth), &"]".repeat(depth), "}"].concat();
    let bytes = stage.seal(id, data.as_bytes(), Packing::Plain)?;
    endured(stage, evidence, &bytes).await
}

/// Sends a frame that the device may refuse or answer by closing the connection. It must serve others.
async fn endured(stage: &Stage<'_, '_>, evidence: &mut Evidence, bytes: &[u8]) -> Step {
    let mut line = stage.connect(evidence).await?;
    line.send(bytes).await;
    let wait = facts::call_timeout(stage.model());
    if let Next::Silence = line.next(wait).await? {
        return deviates(text!(
            "设备既不响应，也不断开连接",
            "the device neither responds nor closes the connection"
        ));
    }
    stage.serves().await
}

pub(super) async fn unfinished(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (_, bytes) = stage.frame(1)?;
    let mut line = stage.connect(evidence).await?;
    let half = bytes.get(..bytes.len() / 2).unwrap_or(&bytes);
    line.send(half).await;
    stage.serves().await
}
