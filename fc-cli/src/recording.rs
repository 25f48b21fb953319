//! Recorded bytes: files or standard input, in one of several formats.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use fc_reflect::Reflector;
use fc_workshop::capture::Ports;
use fc_workshop::decode::{self, DecodeError, Record, Source};

use crate::lang::{both, in_lang, said};
use crate::outcome::{Failure, unreadable};

/// Options that name recorded bytes.
#[derive(Debug, clap::Args)]
pub struct Recording {
    #[arg(
        value_name = "FILE",
        help = both("输入文件，`-` 表示标准输入 [默认：标准输入]", "Files, with `-` for standard input [default: standard input]")
    )]
    files: Vec<PathBuf>,
    #[arg(
        long,
        value_name = "FORMAT",
        help = both("输入格式 [默认：自动识别]", "Format of the input [default: detected]")
    )]
    input: Option<Input>,
    #[arg(
        long = "port",
        value_name = "PORT",
        help = both("抓包中也读取这些端口的连接", "Also read connections on these ports of a capture")
    )]
    ports: Vec<u16>,
}

/// The format of the input.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Input {
    #[value(help = both("十六进制，也可以是 `xxd` 或 `hexdump -C` 的输出", "Hexadecimal, also as `xxd` or `hexdump -C` print it"))]
    Hex,
    #[value(help = both("原始字节", "The bytes themselves"))]
    Binary,
    #[value(help = both("base64", "Base64"))]
    Base64,
    #[value(help = both("pcap 或 pcapng 抓包", "A capture, pcap or pcapng"))]
    Capture,
    #[value(help = both("`tcpdump -x` 或 `tcpdump -X` 的文本", "The text of `tcpdump -x` or `tcpdump -X`"))]
    Tcpdump,
    #[cfg(feature = "record")]
    #[value(help = both("MCAP 录制文件", "A recording in MCAP"))]
    Mcap,
}

impl From<Input> for decode::Format {
    fn from(input: Input) -> Self {
        match input {
            Input::Hex => Self::Hex,
            Input::Binary => Self::Binary,
            Input::Base64 => Self::Base64,
            Input::Capture => Self::Capture,
            Input::Tcpdump => Self::Tcpdump,
            #[cfg(feature = "record")]
            Input::Mcap => Self::Recording,
        }
    }
}

/// The output for people or for programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OutputFormat {
    #[value(help = both("供人阅读", "For people"))]
    Text,
    #[value(help = both("每条一行 JSON", "One line of JSON each"))]
    Json,
}

impl Recording {
    /// Returns `true` if frames may arrive while a person waits for them.
    pub fn is_live(&self) -> bool {
        self.files.is_empty() || self.files.iter().any(|file| file.as_os_str() == "-")
    }

    /// Describes all frames. `sink` receives each record.
    pub fn read<'m>(
        &self,
        reflector: &Reflector<'m>,
        sink: &mut dyn FnMut(&Record<'m>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        crate::progress::done();
        let stdin = self.files.is_empty().then(|| Path::new("-"));
        for file in self.files.iter().map(PathBuf::as_path).chain(stdin) {
            let format = self.input.map(Into::into);
            read_file(reflector, file, format, &self.ports, sink)?;
        }
        Ok(())
    }
}

/// Describes all frames of a file, or of standard input for `-`. Captures are read on the ports of the spec and on
/// `more_ports`.
pub fn read_file<'m>(
    reflector: &Reflector<'m>,
    file: &Path,
    format: Option<decode::Format>,
    more_ports: &[u16],
    sink: &mut dyn FnMut(&Record<'m>) -> io::Result<()>,
) -> Result<(), Failure> {
    let input: Box<dyn Read + Send> = if file.as_os_str() == "-" {
        Box::new(io::stdin())
    } else {
        Box::new(File::open(file).map_err(unreadable(file))?)
    };
    let source = Source {
        input,
        format,
        ports: Ports::new(reflector.model(), more_ports),
    };
    decode::read(reflector, source, sink).map_err(|error| failure(file, error))
}

fn failure(file: &Path, error: DecodeError) -> Failure {
    match error {
        DecodeError::Read(error) => unreadable(file)(error),
        DecodeError::Input(error) => {
            let (file, error) = (file.display(), in_lang(error.text()));
            said!("`{file}`：{error}", "`{file}`: {error}").into()
        }
        DecodeError::Sink(error) => error.into(),
    }
}
