//! Reads an input from its beginning to its end.

use super::hex::HexText;
use super::input::Unpacker;
use super::{Decoder, Format, Record};
use crate::capture::{self, CaptureError, Event, Flow, Ports, Seen};
use crate::error::InputError;
use fc_reflect::Reflector;
use fc_spec::text;
use std::io::{self, Cursor, ErrorKind, Read};
use thiserror::Error;

/// The bytes that are read at a time.
const CHUNK: usize = 64 << 10;

/// The first bytes of an input, which show its format.
const BEGINNING: u64 = 64;

/// The reason why reading an input ended early.
#[derive(Debug, Error)]
pub enum DecodeError {
    /// The input cannot be read.
    #[error("cannot read the input: {0}")]
    Read(io::Error),
    /// The input does not have its format.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The receiver of the records has failed.
    #[error(transparent)]
    Sink(io::Error),
}

/// An input and the way to read it.
#[derive(Debug)]
pub struct Source<R> {
    /// The bytes, which can be endless.
    pub input: R,
    /// The format. Without one, the beginning of the input decides.
    pub format: Option<Format>,
    /// The ports of the connections in captures.
    pub ports: Ports,
}

/// Describes all frames of an input. Memory is bounded.
///
/// # Errors
/// The reason why reading ended early. `sink` has received the records before it.
pub fn read<'m, R: Read + Send>(
    reflector: &Reflector<'m>,
    source: Source<R>,
    sink: &mut dyn FnMut(&Record<'m>) -> io::Result<()>,
) -> Result<(), DecodeError> {
    let Source {
        mut input,
        format,
        ports,
    } = source;
    let mut beginning = Vec::new();
    let read = (&mut input).take(BEGINNING).read_to_end(&mut beginning);
    read.map_err(DecodeError::Read)?;
    let format = format.unwrap_or_else(|| Format::detect(reflector.model(), &beginning));
    let input = Cursor::new(beginning).chain(input);
    let mut decoder = Decoder::new(reflector);
    match format {
        Format::Hex => {
            let unpacker = Unpacker::Hex(HexText::default());
            read_bytes(&mut decoder, unpacker, input, sink)
        }
        Format::Binary => read_bytes(&mut decoder, Unpacker::Binary, input, sink),
        Format::Base64 => read_bytes(&mut decoder, Unpacker::Base64(Vec::new()), input, sink),
        Format::Capture => {
            let read = capture::read_file(input, &ports, &mut receiver(&mut decoder, sink));
            captured(read, &ports)
        }
        Format::Tcpdump => {
            let read = capture::read_text(input, &ports, &mut receiver(&mut decoder, sink));
            captured(read, &ports)
        }
        Format::Recording => read_recording(&mut decoder, input, sink),
    }
}

#[cfg(feature = "record")]
fn read_recording<'m>(
    decoder: &mut Decoder<'_, 'm>,
    input: impl Read,
    sink: &mut dyn FnMut(&Record<'m>) -> io::Result<()>,
) -> Result<(), DecodeError> {
    use crate::capture::mcap::{ReadError, read};
    let read = read(input, &mut |flow, time, bytes| {
        decoder.push(flow, time, bytes, sink)?;
        // The recording has the frames one by one.
        decoder.skip(flow, 0, sink)
    });
    let error = match read {
        Ok(()) => return Ok(()),
        Err(ReadError::Input(error)) => return Err(DecodeError::Read(error)),
        Err(ReadError::Receiver(error)) => return Err(DecodeError::Sink(error)),
        Err(ReadError::Cut) => text!(
            "录制文件不完整；前面的帧已显示",
            "the recording ends early; the frames before its end are shown"
        ),
        Err(ReadError::Compressed(name)) => text!(
            "录制文件用 {name} 压缩；请先用 `mcap decompress` 解压",
            "the recording is compressed with {name}; unpack it with `mcap decompress`",
            name = name
        ),
        Err(ReadError::Damaged(_)) => text!(
            "录制文件已损坏；请用 `mcap recover` 修复",
            "the recording is damaged; repair it with `mcap recover`"
        ),
    };
    Err(InputError(error).into())
}

#[cfg(not(feature = "record"))]
fn read_recording<'m>(
    _decoder: &mut Decoder<'_, 'm>,
    _input: impl Read,
    _sink: &mut dyn FnMut(&Record<'m>) -> io::Result<()>,
) -> Result<(), DecodeError> {
    Err(InputError(text!(
        "这个 fcproto 不能读 MCAP；用 --features record 安装",
        "this fcproto cannot read MCAP; install it with --features record"
    ))
    .into())
}

fn read_bytes<'m>(
    decoder: &mut Decoder<'_, 'm>,
    mut unpacker: Unpacker,
    mut input: impl Read,
    sink: &mut dyn FnMut(&Record<'m>) -> io::Result<()>,
) -> Result<(), DecodeError> {
    let mut chunk = vec![0; CHUNK];
    let mut bytes = Vec::new();
    loop {
        let filled = some(&mut input, &mut chunk)?;
        let result = if filled == 0 {
            unpacker.finish(&mut bytes)
        } else {
            unpacker.push(chunk.get(..filled).unwrap_or_default(), &mut bytes)
        };
        // The bytes before an error are shown.
        let pushed = decoder.push(None, None, &bytes, sink);
        pushed.map_err(DecodeError::Sink)?;
        bytes.clear();
        if filled == 0 || result.is_err() {
            decoder.finish(sink).map_err(DecodeError::Sink)?;
            return Ok(result?);
        }
    }
}

/// Reads some bytes, or 0 at the end of the input.
fn some(input: &mut impl Read, chunk: &mut [u8]) -> Result<usize, DecodeError> {
    loop {
        match input.read(chunk) {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            read => return read.map_err(DecodeError::Read),
        }
    }
}

/// Returns the receiver of the flows of a capture.
fn receiver<'d, 'm>(
    decoder: &'d mut Decoder<'_, 'm>,
    sink: &'d mut dyn FnMut(&Record<'m>) -> io::Result<()>,
) -> impl FnMut(Flow, Event<'_>) -> io::Result<()> + 'd {
    |flow, event| match event {
        Event::Bytes(time, bytes) => decoder.push(Some(flow), Some(time), bytes, sink),
        Event::Missing(count) => decoder.skip(Some(flow), count, sink),
        Event::End => decoder.close(Some(flow), sink),
    }
}

fn captured(read: Result<Seen, CaptureError>, ports: &Ports) -> Result<(), DecodeError> {
    let error = match read {
        Ok(Seen { wanted: 0, others }) if others > 0 => {
            let ports = ports.listed();
            text!(
                "抓包中没有端口 {ports} 的连接；用 --port 指定其他端口",
                "the capture has no connection on ports {ports}; name another one with --port",
                ports = ports
            )
        }
        Ok(_) => return Ok(()),
        Err(CaptureError::Receiver(error)) => return Err(DecodeError::Sink(error)),
        Err(CaptureError::Read(error)) => return Err(DecodeError::Read(error)),
        Err(CaptureError::Cut) => text!(
            "抓包文件在一个包的中间结束；前面的帧已显示",
            "the capture ends inside a packet; the frames before it are shown"
        ),
        Err(CaptureError::TooLarge) => text!(
            "抓包文件中有一块过大；请用 tshark 重新保存",
            "a block of the capture is too large; save the capture again with tshark"
        ),
        Err(CaptureError::Damaged) => text!(
            "输入不是完好的 pcap 或 pcapng；用 --input 指定格式",
            "the input is not intact pcap or pcapng; name its format with --input"
        ),
    };
    Err(InputError(error).into())
}
