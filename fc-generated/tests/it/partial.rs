//! A partial robot and the example robot refuse the commands that they do not carry out, as not implemented.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    deprecated,
    missing_docs,
    reason = "tests; what is withdrawn has to work all the same"
)]

use fc_generated::{Client, ExampleRobot, Fc, PartialRobot, RobotService, for_each_command};
use fc_runtime::{
    CallError, ClientConfig, Command, Effect, Message, Protocol, Refusal, Server, ServerConfig,
    ServerHandle, Service,
};
use std::net::Ipv4Addr;

/// A robot without any command.
struct Empty;

impl PartialRobot for Empty {}

/// The outcome of a call with the spec's example.
struct Outcome {
    name: &'static str,
    effect: Effect,
    refusal: Option<Refusal>,
}

macro_rules! call_all {
    ($($method:ident $request:ident $response:ident;)*) => {
        async fn call_all(client: &Client) -> Vec<Outcome> {
            vec![$(
                Outcome {
                    name: <fc_generated::$request as Command>::NAME,
                    effect: <fc_generated::$request as Command>::EFFECT,
                    refusal: match client.$method(&Message::example()).await {
                        Ok(_) => None,
                        Err(CallError::Refused(refusal)) => Some(refusal),
                        Err(error) => panic!("{}: {error}", stringify!($method)),
                    },
                },
            )*]
        }
    };
}
for_each_command!(call_all);

/// Starts a robot with this service. Returns a connected app and the robot's handle.
async fn connected(service: impl Service<Fc>) -> (Client, ServerHandle<Fc>) {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, service).await.unwrap();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(server.command_addr().port());
    let handle = server.handle();
    tokio::spawn(server.run());
    (Client::connect(config).await.unwrap(), handle)
}

/// Returns `true` if the robot refuses the command as not implemented.
fn is_not_implemented(refusal: &Refusal) -> bool {
    refusal.code == Fc::RESULTS.protocol.code && refusal.text.ends_with(": not implemented")
}

#[tokio::test]
async fn omitted_and_unknown_commands_are_distinguished() {
    let (client, robot) = connected(RobotService::new(Empty)).await;
    let outcomes = call_all(&client).await;
    for outcome in &outcomes {
        let refusal = outcome.refusal.as_ref();
        assert!(refusal.is_some_and(is_not_implemented), "{}", outcome.name);
    }
    let calls = u64::try_from(outcomes.len()).unwrap();
    assert_eq!(robot.counters().calls_not_implemented, calls);

    let unknown = client.connection().call_raw(u16::MAX, b"{}").await.unwrap();
    let text = unknown.envelope.result_msg.unwrap();
    assert_eq!(text, Fc::RESULTS.protocol.text);
    assert_eq!(robot.counters().calls_not_implemented, calls);
}

/// A robot without motion must not report the success of a motion command.
#[tokio::test]
async fn the_example_robot_refuses_motion() {
    let (client, _robot) = connected(RobotService::new(ExampleRobot::default())).await;
    for Outcome {
        name,
        effect,
        refusal,
    } in call_all(&client).await
    {
        match effect {
            Effect::Read | Effect::Config => assert_eq!(refusal, None, "{name}"),
            Effect::Motion | Effect::Unknown => {
                assert!(refusal.as_ref().is_some_and(is_not_implemented), "{name}");
            }
        }
    }
}

#[tokio::test]
async fn the_example_robot_pretends_if_told_to() {
    let robot = ExampleRobot {
        pretend_motion: true,
    };
    let (client, _robot) = connected(RobotService::new(robot)).await;
    for outcome in call_all(&client).await {
        assert_eq!(outcome.refusal, None, "{}", outcome.name);
    }
}
