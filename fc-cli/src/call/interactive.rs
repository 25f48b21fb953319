//! `fcproto call --interactive`: calls line by line.

use std::io::{self, IsTerminal as _};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use clap::parser::ValueSource;
use clap::{Args as _, FromArgMatches as _};
use fc_reflect::{Frame, Reflector};
use fc_spec::model::{Kind, Model, Operation};
use fc_workshop::call::{Call, CallError, Ending, Event};
use fc_workshop::client::{Client, ClientError};
use fc_workshop::complete::complete;
use fc_workshop::request::Request;
use fc_workshop::run::{Interrupt, block_on};
use rustyline::completion::Completer;
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::MemHistory;
use rustyline::validate::Validator;
use rustyline::{Config, Context, Editor, ExternalPrinter, Helper};

use super::{Options, show, status};
use crate::help::usage;
use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::{print, progress};

/// A wait without an end, for reports.
const ALWAYS: Duration = Duration::from_secs(u64::MAX >> 32);

/// Options that count for all lines.
const OF_THE_RUN: [&str; 3] = ["to", "format", "interactive"];

/// Reads calls until the end of the input. Returns the status of the last call that was no success.
pub fn run(reflector: &Reflector<'_>, options: &Options) -> Result<Status, Failure> {
    progress::done();
    let prompt = Prompt::start(reflector.model())?;
    let talk = Talk {
        reflector,
        options,
        prompt,
        client: None,
    };
    block_on(talk.run())?
}

/// The line editor. It blocks a separate thread.
struct Prompt {
    /// Asks for the next line.
    ask: mpsc::Sender<()>,
    lines: tokio::sync::mpsc::Receiver<String>,
    /// Prints while a line is edited.
    printer: Option<Box<dyn ExternalPrinter + Send>>,
}

impl Prompt {
    fn start(model: &Model) -> Result<Self, Failure> {
        let config = Config::builder().auto_add_history(true).build();
        let mut editor = Editor::with_history(config, MemHistory::new())?;
        editor.set_helper(Some(Words(model.clone())));
        let mut printer: Option<Box<dyn ExternalPrinter + Send>> = None;
        if io::stdin().is_terminal() && io::stdout().is_terminal() {
            printer = Some(Box::new(editor.create_external_printer()?));
        }
        let (ask, asked) = mpsc::channel();
        let (sender, lines) = tokio::sync::mpsc::channel(1);
        thread::Builder::new().spawn(move || {
            while asked.recv().is_ok() {
                let line = match editor.readline("> ") {
                    Ok(line) => line,
                    // Ctrl-C gives up the line.
                    Err(ReadlineError::Interrupted) => String::new(),
                    Err(_) => return,
                };
                if sender.blocking_send(line).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self {
            ask,
            lines,
            printer,
        })
    }

    fn show(&mut self, text: String) -> Result<(), Failure> {
        match &mut self.printer {
            Some(printer) => Ok(printer.print(text)?),
            None => Ok(print::result(&text)?),
        }
    }
}

/// A conversation with a robot.
struct Talk<'r, 'm> {
    reflector: &'m Reflector<'m>,
    options: &'r Options,
    prompt: Prompt,
    /// The connection to the command port, while there is one.
    client: Option<Client<'m>>,
}

impl<'m> Talk<'_, 'm> {
    async fn run(mut self) -> Result<Status, Failure> {
        let mut status = Status::Fine;
        let mut interrupt = Interrupt::new()?;
        while self.prompt.ask.send(()).is_ok() {
            let line = tokio::select! {
                line = self.line() => line?,
                () = interrupt.next() => None,
            };
            let Some(line) = line else { break };
            let sent = tokio::select! {
                sent = self.send(&line) => sent,
                () = interrupt.next() => break,
            };
            let one = sent.unwrap_or_else(|failure| {
                print::failure(failure.as_ref());
                Status::Failed
            });
            if one != Status::Fine {
                status = one;
            }
        }
        Ok(status)
    }

    /// Waits for the next line, and shows the reports that arrive before.
    async fn line(&mut self) -> Result<Option<String>, Failure> {
        loop {
            let report = tokio::select! {
                line = self.prompt.lines.recv() => return Ok(line),
                report = next_report(self.client.as_mut()) => report,
            };
            match report {
                Ok(frame) => {
                    if let Some(operation) = frame.operation {
                        let transcript = self.options.transcript();
                        let text = transcript.pushed(self.reflector, operation, &frame);
                        self.prompt.show(text)?;
                    }
                }
                // The next line connects again.
                Err(_) => self.client = None,
            }
        }
    }

    /// Runs a line.
    async fn send(&mut self, line: &str) -> Result<Status, Failure> {
        let words = shell_words::split(line)
            .map_err(|_| said!("引号没有成对", "a quotation mark is not closed"))?;
        if words.is_empty() {
            return Ok(Status::Fine);
        }
        let command = Options::augment_args(clap::Command::new("call").no_binary_name(true));
        let matches = match command.try_get_matches_from(words) {
            Ok(matches) => matches,
            Err(error) => {
                let text = usage::described(&error);
                print::message(&text.unwrap_or_else(|| error.to_string()))?;
                return Ok(Status::Failed);
            }
        };
        let is_given = |id: &&&str| matches.value_source(id) == Some(ValueSource::CommandLine);
        if let Some(id) = OF_THE_RUN.iter().find(is_given) {
            return Err(said!(
                "`--{id}` 只能写在启动 `fcproto call` 的命令行里",
                "`--{id}` belongs on the command line that starts `fcproto call`"
            )
            .into());
        }
        let line = Options::from_arg_matches(&matches)?;
        if line.json.as_deref() == Some("@-") {
            return Err(said!(
                "标准输入已用来读取指令；请把 JSON 写入文件，用 `--json @文件`",
                "the standard input has the calls; write the JSON into a file and use `--json @FILE`"
            )
            .into());
        }
        if line.list {
            let list = self.options.transcript().operations(self.reflector.model());
            print::result(&list)?;
            return Ok(Status::Fine);
        }
        let request = line.request(self.reflector, line.allow.max(self.options.allow))?;
        let outer = self.options.call(self.reflector);
        let call = Call {
            repeat: line.repeat,
            timeout: line.timeout.map_or(outer.timeout, Duration::from_millis),
            follow: line.follow.map(Duration::from_secs),
            ..outer
        };
        status(self.call(&call, &request).await)
    }

    /// Sends a request. Commands share one connection.
    async fn call(
        &mut self,
        call: &Call<'_, 'm>,
        request: &Request<'m>,
    ) -> Result<Ending, CallError> {
        let (reflector, transcript) = (self.reflector, self.options.transcript());
        let sink = &mut |event: Event<'_, '_>| show(reflector, transcript, &event);
        let is_stream = |operation: &Operation| operation.kind() == Kind::Stream;
        if request.operation.is_some_and(is_stream) {
            return call.run(request, sink).await;
        }
        let mut client = match self.client.take() {
            Some(client) => client,
            None => call.connect(request).await?,
        };
        let sent = call.send(&mut client, request, sink).await;
        if !sent.as_ref().is_err_and(CallError::is_lost) {
            self.client = Some(client);
        }
        sent
    }
}

/// Waits for a report. Without a connection, it waits forever.
async fn next_report<'m>(client: Option<&mut Client<'m>>) -> Result<Frame<'m>, ClientError> {
    match client {
        Some(client) => client.report(ALWAYS).await,
        None => std::future::pending().await,
    }
}

/// Completes the words of a line by the spec.
struct Words(Model);

impl Completer for Words {
    type Candidate = String;

    fn complete(
        &self,
        line: &str,
        position: usize,
        _: &Context<'_>,
    ) -> rustyline::Result<(usize, Vec<String>)> {
        let line = line.get(..position).unwrap_or_default();
        let start = line.rfind(' ').map_or(0, |space| space + 1);
        let (before, word) = line.split_at(start);
        let before: Vec<&str> = before.split_whitespace().collect();
        Ok((start, complete(&self.0, &before, word)))
    }
}

impl Helper for Words {}
impl Highlighter for Words {}
impl Hinter for Words {
    type Hint = String;
}
impl Validator for Words {}
