//! A mock against the client of this crate.

use crate::support::{small, small_with};
use fc_reflect::{Direction, Reflector};
use fc_spec::diagnostic::Faults;
use fc_spec::model::{Model, Value};
use fc_spec::source::Sources;
use fc_workshop::answer::{Outcome, Process, Progress};
use fc_workshop::arguments::json;
use fc_workshop::client::Client;
use fc_workshop::mock::{Mock, Settings};
use fc_workshop::run::block_on;
use fc_workshop::scenario::{Scenario, Verdict};
use std::time::Duration;

/// A test fails after this time, instead of hanging.
const PATIENCE: Duration = Duration::from_secs(60);

/// A process, a precondition and a stored value, added to the small spec.
fn lively(text: &str) -> String {
    let text = text.replace(
        "    request:\n      lvl:",
        "    kept: flash\n    sets_off: [dimmed]\n    request:\n      lvl:",
    );
    let text = text.replace(
        "  unknown_body:",
        "  get_light:\n    code: 0x0105\n    zh: 查询灯光\n    en: Get the light\n    effect: read\n    kept: flash\n    \
         accepted: { after: [set_light] }\n    source: { sections: [] }\n    response:\n      \
         lvl: { type: u8, example: 9, zh: 亮度, en: Level }\n  unknown_body:",
    );
    let text = text.replace(
        "      lux: { type: f64,",
        "      step: { type: Step, zh: 步骤, en: Step }\n      lux: { type: f64,",
    );
    let text = text.replace(
        "\nsections: {}\n",
        "\nsections: {}\n\nstores:\n  flash: { zh: 闪存, en: Flash }\n",
    );
    text.replace(
        "types:\n  Mood:",
        "types:\n  Step:\n    enum: u8\n    order: normal\n    zh: 步骤\n    en: Step\n    values:\n      \
         1: { name: begun, start: true, then: [fading, failed], zh: 开始, en: Begun }\n      \
         2: { name: fading, then: [dark, begun], zh: 渐暗, en: Fading }\n      \
         3: { name: dark, final: true, zh: 暗, en: Dark }\n      \
         4: { name: failed, final: true, error: true, zh: 失败, en: Failed }\n  Mood:",
    )
}

/// A client of a mock, with the texts of its responses.
struct App<'m> {
    reflector: &'m Reflector<'m>,
    client: Client<'m>,
}

impl<'m> App<'m> {
    async fn connect(reflector: &'m Reflector<'m>, mock: &Mock) -> Self {
        let address = mock.commands().to_string();
        let client = Client::connect(reflector, &address, PATIENCE).await;
        Self {
            reflector,
            client: client.unwrap(),
        }
    }

    /// Calls a command with this body. Returns the result code and the response.
    async fn call(&mut self, name: &str, body: &str) -> (i64, Value) {
        let model = self.reflector.model();
        let operation = model.operation(name).unwrap();
        let id = self.reflector.id(operation, Direction::Request, 0).unwrap();
        let data = body.as_bytes().into();
        let frame = self
            .client
            .call(id.kind, id.code, data, PATIENCE)
            .await
            .unwrap();
        let message = self
            .reflector
            .message(Some(operation), Direction::Response, &frame.data);
        let outcome = Outcome::of(model, &message.unwrap());
        let text = std::str::from_utf8(&frame.data).unwrap();
        (outcome.code.unwrap(), json(text).unwrap())
    }
}

fn scenario(model: &Model, text: &str) -> Option<Scenario> {
    let sources = Sources::from_texts([("s.yaml", text)]);
    let mut faults = Faults::new();
    let scenario = Scenario::read(&Reflector::new(model), &sources, &mut faults);
    assert!(scenario.is_some(), "{faults:?}");
    scenario
}

#[test]
fn invalid_requests_get_the_results_of_the_protocol() {
    let model = small();
    let reflector = Reflector::new(&model);
    let mock = Mock::start(model.clone(), Settings::default()).unwrap();
    block_on(async {
        let mut app = App::connect(&reflector, &mock).await;
        assert_eq!(app.call("set_light", r#"{"lvl":7}"#).await.0, 0);
        assert_eq!(app.call("set_light", r#"{"lvl":101}"#).await.0, 3);
        assert_eq!(app.call("set_light", "{").await.0, 3);
        let kind = model.frame.kinds.command.value;
        let unknown = app
            .client
            .call(kind, 0x0777, (*b"{}").into(), PATIENCE)
            .await
            .unwrap();
        assert!(unknown.data.starts_with(br#"{"at":"#));
        let message = reflector
            .message(None, Direction::Response, &unknown.data)
            .unwrap();
        assert_eq!(Outcome::of(&model, &message).code, Some(1));
    })
    .unwrap();
}

#[test]
fn a_process_runs_from_its_start_to_its_end() {
    let model = small_with(lively);
    let reflector = Reflector::new(&model);
    let settings = Settings {
        pace: Duration::from_millis(1),
        ..Settings::default()
    };
    let mock = Mock::start(model.clone(), settings).unwrap();
    block_on(async {
        let mut app = App::connect(&reflector, &mock).await;
        let (_, response) = app.call("set_light", r#"{"lvl":7}"#).await;
        let command = model.operation("set_light").unwrap();
        let process = Process {
            model: &model,
            command,
            request: Value::Null,
            response,
        };
        let mut steps = Vec::new();
        loop {
            let frame = app.client.report(PATIENCE).await.unwrap();
            let body = json(std::str::from_utf8(&frame.data).unwrap()).unwrap();
            steps.push(body.get("step").unwrap().to_string());
            match process.progress(frame.operation.unwrap(), &body).unwrap() {
                Progress::Running => {}
                end => break assert_eq!(end, Progress::Ended),
            }
        }
        assert_eq!(steps, ["1", "2", "3"]);
    })
    .unwrap();
}

#[test]
fn preconditions_refuse_and_values_are_kept() {
    let model = small_with(lively);
    let reflector = Reflector::new(&model);
    let mock = Mock::start(model.clone(), Settings::default()).unwrap();
    block_on(async {
        let mut app = App::connect(&reflector, &mock).await;
        let (code, response) = app.call("get_light", "{}").await;
        assert_eq!(code, 1);
        assert!(
            response.to_string().contains("send set_light first"),
            "{response}"
        );
        assert_eq!(app.call("set_light", r#"{"lvl":55}"#).await.0, 0);
        let (code, response) = app.call("get_light", "{}").await;
        assert_eq!(
            (code, response.get("lvl").unwrap().to_string()),
            (0, "55".to_owned())
        );
    })
    .unwrap();
}

#[test]
fn a_scenario_decides_responses_and_judges_the_app() {
    let model = small();
    let reflector = Reflector::new(&model);
    let text = "
on:
  - { request: set_light, with: { lvl: 1 }, refuse: timeout }
  - { request: set_light, times: 1, answer: { left: 42 }, reports: [{ report: dimmed, body: { lux: 3 } }] }
expect:
  - { request: set_light, with: { lvl: 2 } }
  - { acknowledged: dimmed }
never: [unknown_body]
";
    let start = || {
        let settings = Settings {
            scenario: scenario(&model, text),
            expect: true,
            ..Settings::default()
        };
        Mock::start(model.clone(), settings).unwrap()
    };
    let mock = start();
    block_on(async {
        let mut app = App::connect(&reflector, &mock).await;
        assert_eq!(app.call("set_light", r#"{"lvl":1}"#).await.0, 2);
        let (_, response) = app.call("set_light", r#"{"lvl":2}"#).await;
        assert_eq!(response.get("left").unwrap().to_string(), "42");
        // The second rule is used up.
        let (_, response) = app.call("set_light", r#"{"lvl":2}"#).await;
        assert_eq!(response.get("left").unwrap().to_string(), "5");
        loop {
            let report = app.client.report(PATIENCE).await.unwrap();
            if report.data.ends_with(br#""lux":3}"#) {
                break;
            }
        }
        // The acknowledgement is written while the next response is awaited.
        app.call("set_light", r#"{"lvl":1}"#).await;
    })
    .unwrap();
    assert_eq!(mock.verdict(), Some(Verdict::Met));

    let mock = start();
    block_on(async {
        let mut app = App::connect(&reflector, &mock).await;
        let operation = model.operation("unknown_body").unwrap();
        let id = reflector.id(operation, Direction::Request, 0).unwrap();
        // The mock ends before or after its response.
        let _ = app
            .client
            .call(id.kind, id.code, (*b"{}").into(), PATIENCE)
            .await;
    })
    .unwrap();
    assert_eq!(
        mock.verdict(),
        Some(Verdict::Forbidden("unknown_body".to_owned()))
    );
}
