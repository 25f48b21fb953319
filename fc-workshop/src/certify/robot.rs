//! The trials of a robot.

use super::checks::CHECKS;
use super::line::{Evidence, Line, Step, Stop, deviates, example};
use super::{Outcome, Settings, Trial, requests};
use fc_reflect::{FrameId, Packing, Reflector};
use fc_spec::model::{Effect, Kind, Model, Operation, Side, Text, Value};
use fc_spec::text;

/// A device and the commands that may be sent to it.
pub(super) struct Stage<'r, 'm> {
    pub(super) reflector: &'r Reflector<'m>,
    pub(super) address: &'r str,
    /// The commands that may be sent.
    pub(super) commands: Vec<&'m Operation>,
    /// The command of the trials that need any.
    pub(super) probe: Option<&'m Operation>,
}

impl<'m> Stage<'_, 'm> {
    pub(super) fn model(&self) -> &'m Model {
        self.reflector.model()
    }

    /// Connects to the device.
    pub(super) async fn connect<'e>(&'e self, evidence: &'e mut Evidence) -> Step<Line<'e, 'm>> {
        Line::connect(self.reflector, self.address, evidence).await
    }

    /// Returns the example of the probe.
    pub(super) fn probe(&self, id: u32) -> Step<(FrameId, Value)> {
        let example = self.probe.and_then(|it| example(self.reflector, it, id));
        example.ok_or_else(|| {
            Stop::Skip(text!(
                "没有可以发送的指令；用 --allow 允许更多",
                "there is no command that may be sent; allow more with --allow"
            ))
        })
    }

    /// Returns the frame of the probe.
    pub(super) fn frame(&self, id: u32) -> Step<(FrameId, Vec<u8>)> {
        let (id, message) = self.probe(id)?;
        Ok((id, self.plain(id, &message)?))
    }

    /// Returns the frame of a message.
    pub(super) fn plain(&self, id: FrameId, message: &Value) -> Step<Vec<u8>> {
        self.seal(id, message.to_string().as_bytes(), Packing::Plain)
    }

    /// Returns the frame of a request.
    pub(super) fn seal(&self, id: FrameId, data: &[u8], packing: Packing) -> Step<Vec<u8>> {
        let sealed = self.reflector.seal(id, data, packing);
        sealed.map_err(|error| {
            Stop::Skip(text!(
                "请求放不进一帧：{error}",
                "the request does not fit into a frame: {error}"
            ))
        })
    }

    /// Sends the probe and waits for its response.
    pub(super) async fn ask(&self, line: &mut Line<'_, 'm>, id: u32) -> Step {
        let (id, frame) = self.frame(id)?;
        line.send(&frame).await;
        line.response(id).await.map(|_| ())
    }

    /// Checks that a new app is served.
    pub(super) async fn serves(&self) -> Step {
        let mut evidence = Evidence::default();
        let served = async {
            let mut line = self.connect(&mut evidence).await?;
            self.ask(&mut line, 1).await
        };
        match served.await {
            Err(Stop::Deviation(reason)) => deviates(text!(
                "之后新的 app 得不到服务：{reason}",
                "after it, a new app is not served: {reason}",
                reason = reason
            )),
            other => other,
        }
    }
}

/// Runs the trials of a robot. `told` receives each trial at its end. Returns `None` if `end` is ready before.
pub async fn robot(
    reflector: &Reflector<'_>,
    settings: &Settings,
    told: &mut dyn FnMut(&Trial),
    end: impl Future<Output = ()>,
) -> Option<Vec<Trial>> {
    let mut run = Run {
        only: &settings.only,
        told,
        trials: Vec::new(),
    };
    tokio::select! {
        () = all(reflector, settings, &mut run) => Some(run.trials),
        () = end => None,
    }
}

async fn all(reflector: &Reflector<'_>, settings: &Settings, run: &mut Run<'_>) {
    let model = reflector.model();
    let is_command = |operation: &&Operation| {
        operation.kind() == Kind::Command
            && operation.sender == Side::App
            && operation.code.value.is_some()
    };
    let is_allowed = |command: &&Operation| settings.permission.check(Some(command)).is_ok();
    let commands = model.operations.iter().filter(is_command);
    let mut stage = Stage {
        reflector,
        address: &settings.address,
        commands: commands.clone().filter(is_allowed).collect(),
        probe: None,
    };
    for command in commands {
        let name = format!("call.{}", command.name);
        let demand = text!(
            "`{name}` 的示例请求得到合乎规范的响应",
            "the example request of `{name}` gets a response that fits the spec",
            name = &command.name
        );
        if !is_allowed(&command) {
            let effect = command.effect().unwrap_or(Effect::Unknown).name();
            let reason = text!(
                "影响为 `{effect}`，没有允许",
                "its effect is `{effect}`, which is not allowed"
            );
            run.end(name, demand, Outcome::Skipped(reason));
            continue;
        }
        let mut evidence = Evidence::default();
        let called = requests::call(&stage, command, &mut evidence).await;
        if called.as_ref().is_ok_and(|is_success| *is_success) && stage.probe.is_none() {
            stage.probe = Some(command);
        }
        let outcome = evidence.outcome(called.map(|_| ()));
        run.end(name, demand, outcome);
    }
    for check in CHECKS {
        if !run.wants(check.name) {
            continue;
        }
        let mut evidence = Evidence::default();
        let result = (check.run)(&stage, &mut evidence).await;
        let demand = text!("{zh}", "{en}", zh = check.zh, en = check.en);
        let outcome = evidence.outcome(result);
        run.end(check.name.to_owned(), demand, outcome);
    }
}

/// The trials so far.
struct Run<'t> {
    only: &'t [String],
    told: &'t mut dyn FnMut(&Trial),
    trials: Vec<Trial>,
}

impl Run<'_> {
    /// Returns `true` if a trial is wanted.
    fn wants(&self, name: &str) -> bool {
        let starts = |only: &String| {
            let rest = name.strip_prefix(only.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        self.only.is_empty() || self.only.iter().any(starts)
    }

    fn end(&mut self, name: String, demand: Text, outcome: Outcome) {
        if !self.wants(&name) {
            return;
        }
        let trial = Trial {
            name,
            demand,
            outcome,
        };
        (self.told)(&trial);
        self.trials.push(trial);
    }
}
