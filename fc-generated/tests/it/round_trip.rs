//! Sends every operation that has a code over TCP, through both typed stubs. The spec drives the tests, so they cover
//! each new command once its stubs are generated.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    deprecated,
    missing_docs,
    reason = "tests; what is withdrawn has to work all the same"
)]

use fc_generated::descriptors::{COMMANDS, OPERATIONS};
use fc_generated::{
    AnyReport, Client, ExampleRobot, Fc, GetRobotSnRequest, Reporter, ResultCode, Robot,
    RobotService, for_each_command, for_each_report,
};
use fc_runtime::{
    AckOutcome, Acknowledgement, Audience, CallError, ClientConfig, Command, Context, Json,
    Message, Protocol, PushError, Refusal, Report, ResponseEnvelope as _, Server, ServerConfig,
    ServerHandle, Service,
};
use futures_util::StreamExt as _;
use std::any::Any;
use std::fmt::Debug;
use std::net::Ipv4Addr;
use std::sync::{Arc, Mutex};
use tokio::task::JoinHandle;

/// Answers every command with the spec's example, and keeps the last request.
#[derive(Clone, Default)]
struct Recorder(Arc<Mutex<Option<Box<dyn Any + Send>>>>);

impl Recorder {
    fn keep<T: Send + 'static>(&self, request: T) {
        *self.0.lock().unwrap() = Some(Box::new(request));
    }

    fn last<T: 'static>(&self) -> T {
        let last = self
            .0
            .lock()
            .unwrap()
            .take()
            .expect("a request has arrived");
        *last.downcast().expect("it has arrived as its own type")
    }
}

macro_rules! commands {
    ($($method:ident $request:ident $response:ident;)*) => {
        impl Robot for Recorder {
            $(
                async fn $method(
                    &self,
                    _: Context<Fc>,
                    request: fc_generated::$request,
                ) -> Result<fc_generated::$response, Refusal> {
                    self.keep(request);
                    Ok(Message::example())
                }
            )*
        }

        mod command {
            use super::*;

            $(
                #[tokio::test]
                async fn $method() {
                    let call = async |client: &Client, request: &fc_generated::$request| {
                        client.$method(request).await
                    };
                    super::call_and_compare(call).await;
                }
            )*
        }
    };
}
for_each_command!(commands);

/// Calls with the spec's example, and with an additional key that the spec does not know.
async fn call_and_compare<C>(call: impl AsyncFn(&Client, &C) -> Result<C::Response, CallError>)
where
    C: Command<Response: Debug + PartialEq> + Debug + PartialEq,
{
    let recorder = Recorder::default();
    let robot = Stub::start(RobotService::new(recorder.clone())).await;
    let client = robot.client().await;
    for text in [C::EXAMPLE.to_owned(), with_unknown_key(C::EXAMPLE)] {
        let request: C = read(&text);
        let response = call(&client, &request).await.expect("the robot answers");
        assert_eq!(response, C::Response::example());
        assert_eq!(recorder.last::<C>(), request);
    }
    robot.stop().await;
}

macro_rules! reports {
    ($($method:ident $report:ident $acknowledgement:ident;)*) => {
        mod report {
            use super::*;

            $(
                #[tokio::test]
                async fn $method() {
                    let push = async |reporter: &Reporter, report: &fc_generated::$report| {
                        reporter.$method(Audience::All, report).await
                    };
                    super::push_and_compare(push, AnyReport::$report).await;
                }
            )*
        }
    };
}
for_each_report!(reports);

/// Pushes the spec's example, and the same with an additional key that the spec does not know.
async fn push_and_compare<R: Report>(
    push: impl AsyncFn(&Reporter, &R) -> Result<Vec<Acknowledgement>, PushError>,
    wrap: impl Fn(R) -> AnyReport,
) {
    let robot = Stub::start(RobotService::new(ExampleRobot::default())).await;
    let client = robot.client().await;
    let mut reports = client.reports();
    let reporter = Reporter::new(robot.handle.clone());
    for text in [R::EXAMPLE.to_owned(), with_unknown_key(R::EXAMPLE)] {
        for as_stream in [false, true] {
            let acknowledgements = push(&reporter, &read(&text)).await.expect("it is sent");
            let outcomes: Vec<_> = acknowledgements.iter().map(|ack| &ack.outcome).collect();
            assert_eq!(outcomes, [&AckOutcome::Acknowledged]);
            let received = if as_stream {
                reports.next().await
            } else {
                reports.recv().await
            };
            let received = received.expect("it arrives").expect("it is readable");
            assert_eq!(received, wrap(read(&text)));
        }
    }
    robot.stop().await;
}

#[tokio::test]
async fn bytes_over_the_data_port_belong_to_a_request() {
    let robot = Stub::start(RobotService::new(ExampleRobot::default())).await;
    let mut from_apps = robot.handle.streams();
    let client = robot.client().await;
    let data = client.data();
    for operation in COMMANDS
        .iter()
        .filter(|operation| operation.code.is_some())
        .take(2)
    {
        let code = operation.code.unwrap();
        data.send(code, 7, b"from the app").await.unwrap();
        let received = from_apps.recv().await.expect("the bytes arrive");
        assert_eq!((received.frame.code, received.frame.id), (code, 7));
        assert_eq!(&*received.frame.data, b"from the app");

        let app = Audience::One(received.connection);
        robot
            .handle
            .send_stream(app, code, 7, b"from the robot")
            .await
            .unwrap();
        let received = data.recv().await.expect("the bytes arrive");
        assert_eq!((received.code, received.id), (code, 7));
        assert_eq!(&*received.data, b"from the robot");
    }
    robot.stop().await;
}

#[tokio::test]
async fn unknown_code_is_refused_and_connection_stays() {
    let robot = Stub::start(RobotService::new(ExampleRobot::default())).await;
    let client = robot.client().await;
    let free = (0..=u16::MAX)
        .find(|code| {
            OPERATIONS
                .iter()
                .all(|operation| operation.code != Some(*code))
        })
        .expect("some code is free");
    for code in [free, u16::MAX] {
        let response = client.connection().call_raw(code, b"{}").await.unwrap();
        assert_eq!(
            response.envelope.result_code(),
            Some(Fc::RESULTS.protocol.code),
            "0x{code:04X}"
        );
    }
    robot.stop().await;
}

#[tokio::test]
async fn a_handlers_refusal_reaches_the_caller() {
    let refuse = |request: fc_runtime::Request<'_, Fc>| request.refuse(&ResultCode::Expired.into());
    let robot = Stub::start(refuse).await;
    let client = robot.client().await;
    let Err(CallError::Refused(refusal)) = client.get_robot_sn(&GetRobotSnRequest::example()).await
    else {
        panic!("the robot refuses");
    };
    assert_eq!(ResultCode::from(refusal.code), ResultCode::Expired);
    assert_eq!(refusal.text, ResultCode::Expired.text());
    robot.stop().await;
}

/// A server at ports that the system chooses.
struct Stub {
    handle: ServerHandle<Fc>,
    config: ClientConfig,
    serving: JoinHandle<()>,
}

impl Stub {
    async fn start(service: impl Service<Fc>) -> Self {
        let config = ServerConfig::new()
            .address(Ipv4Addr::LOCALHOST)
            .command_port(0)
            .data_port(0);
        let server = Server::bind(config, service).await.unwrap();
        let config = ClientConfig::new()
            .host(server.command_addr().ip().to_string())
            .command_port(server.command_addr().port())
            .data_port(server.data_addr().port());
        Self {
            handle: server.handle(),
            config,
            serving: tokio::spawn(server.run()),
        }
    }

    /// Returns a client that has received a response, so the server knows its connection.
    async fn client(&self) -> Client {
        let client = Client::connect(self.config.clone()).await.unwrap();
        client.connection().call_raw(u16::MAX, b"{}").await.unwrap();
        client
    }

    async fn stop(self) {
        self.handle.shutdown(std::time::Duration::ZERO).await;
        self.serving.await.unwrap();
    }
}

fn read<M: Message>(text: &str) -> M {
    Json::new(text).unwrap().read_as().unwrap()
}

fn with_unknown_key(object: &str) -> String {
    let inner = object.trim_start_matches('{');
    let comma = if inner == "}" { "" } else { "," };
    format!(r#"{{"key of a later spec":[1,{{"a":null}}]{comma}{inner}"#)
}
