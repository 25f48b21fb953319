//! Shared code of the examples: the command line, the log, and a table with aligned columns.

#![allow(dead_code, reason = "each example uses a part of it")]

pub mod stop;

use fc_runtime::{ClientConfig, Gzip};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;
use tracing::level_filters::LevelFilter;
use tracing_subscriber::EnvFilter;
use unicode_width::UnicodeWidthStr;

/// Any error that ends an example.
pub type Fault = Box<dyn std::error::Error + Send + Sync>;

/// Runs an example with its command line. Exits with 2 if that is wrong, and with 1 after an error.
pub async fn main(usage: &str, run: impl AsyncFnOnce(Args) -> Result<(), Fault>) -> ExitCode {
    match Args::parse(usage) {
        Ok(Some(args)) => exit(run(args).await),
        Ok(None) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

/// Prints the error, if there is one, and returns the exit code.
pub fn exit(result: Result<(), Fault>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("{fault}");
            ExitCode::FAILURE
        }
    }
}

// #region log
/// 日志写到 stderr：级别由 `RUST_LOG` 决定，缺省为 info。
/// Writes the log to stderr. `RUST_LOG` sets the level, which is info by default.
pub fn log() -> Result<(), Fault> {
    let filter = EnvFilter::builder()
        .with_default_directive(LevelFilter::INFO.into())
        .from_env()?;
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .try_init()
}
// #endregion log

/// The options of the command line.
pub struct Args {
    /// Address of the robot.
    pub host: String,
    /// Port for commands. The default is the spec's port.
    pub command_port: Option<u16>,
    /// Port for streams. The default is the spec's port.
    pub data_port: Option<u16>,
    /// Port for metrics, on this machine only.
    pub metrics_port: u16,
    /// Folder with certificates.
    pub certificates: PathBuf,
    /// `true` if the robot ends once its app has left.
    pub once: bool,
    /// The time that the robot takes for each command.
    pub delay: Duration,
    /// Compression settings.
    pub gzip: Gzip,
    /// Factor for the width and height of the robot's picture.
    pub picture_scale: usize,
    /// Language of the output.
    pub lang: Lang,
}

/// A language of the spec.
#[derive(Clone, Copy)]
pub enum Lang {
    Zh,
    En,
}

impl Lang {
    /// Returns the language of the environment, from the POSIX variables.
    fn of_environment() -> Self {
        let mut values = ["LC_ALL", "LC_MESSAGES", "LANG"]
            .map(std::env::var)
            .into_iter();
        match values.find_map(|value| value.ok().filter(|value| !value.is_empty())) {
            Some(locale) if locale.starts_with("zh") => Self::Zh,
            _ => Self::En,
        }
    }

    /// Returns the value for this language.
    pub fn pick<T>(self, zh: T, en: T) -> T {
        match self {
            Self::Zh => zh,
            Self::En => en,
        }
    }
}

impl Args {
    /// Returns client settings with the robot's address and ports.
    pub fn client(&self) -> ClientConfig {
        let mut config = ClientConfig::new().host(&self.host).gzip(self.gzip);
        if let Some(port) = self.command_port {
            config = config.command_port(port);
        }
        if let Some(port) = self.data_port {
            config = config.data_port(port);
        }
        config
    }

    /// Reads the command line. Returns `None` if it asked for help, after printing `usage`.
    pub fn parse(usage: &str) -> Result<Option<Self>, String> {
        let mut args = Self {
            host: "127.0.0.1".to_owned(),
            command_port: None,
            data_port: None,
            metrics_port: 9656,
            certificates: PathBuf::from("."),
            once: false,
            delay: Duration::ZERO,
            gzip: Gzip::default(),
            picture_scale: 1,
            lang: Lang::of_environment(),
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            let port = |text: String| {
                text.parse()
                    .map_err(|_| format!("{text} is no port: give a number up to 65535"))
            };
            let number = |text: String| -> Result<u32, String> {
                text.parse().map_err(|_| format!("{text} is no number"))
            };
            match word.as_str() {
                "--host" => args.host = value()?,
                "--command-port" => args.command_port = Some(port(value()?)?),
                "--data-port" => args.data_port = Some(port(value()?)?),
                "--metrics-port" => args.metrics_port = port(value()?)?,
                "--certificates" => args.certificates = value()?.into(),
                "--once" => args.once = true,
                "--delay" => args.delay = Duration::from_millis(number(value()?)?.into()),
                "--gzip-from" => args.gzip.from_bytes = number(value()?)? as usize,
                "--picture-scale" => args.picture_scale = number(value()?)? as usize,
                "--lang" => {
                    args.lang = match value()?.as_str() {
                        "zh" => Lang::Zh,
                        "en" => Lang::En,
                        other => return Err(format!("{other} is neither zh nor en")),
                    }
                }
                "--help" | "-h" => {
                    println!("{usage}");
                    return Ok(None);
                }
                other => return Err(format!("{other} is no option\n\n{usage}")),
            }
        }
        Ok(Some(args))
    }
}

/// Rows of cells in aligned columns. A Chinese character takes two columns on a terminal.
#[derive(Default)]
pub struct Table(Vec<Vec<String>>);

impl Table {
    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [impl Into<String>; N]) {
        self.0.push(cells.into_iter().map(Into::into).collect());
    }
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut widths: Vec<usize> = Vec::new();
        for row in &self.0 {
            for (column, cell) in row.iter().enumerate() {
                let width = cell.width();
                match widths.get_mut(column) {
                    Some(widest) => *widest = width.max(*widest),
                    None => widths.push(width),
                }
            }
        }
        for row in &self.0 {
            let mut line = String::new();
            for (cell, width) in row.iter().zip(&widths) {
                let padding = width.saturating_sub(cell.width());
                write!(line, "{cell}{:padding$}  ", "")?;
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}
