//! Tests the features of the meter's protocol that the real one does not have. `tests/it/other_protocols.rs` runs this
//! in a crate that is generated from its spec.

#![allow(missing_docs, reason = "tests")]

use fc_generated::{
    Band, Client, CloseSwitchError, CloseSwitchRequest, CloseSwitchResponse, FrameHeader, Load,
    LoadFields, Meter, Operator, PartialRobot, Phase, ReadPowerRequest, ReadPowerResponse,
    Readings, Reporter, ResultCode, RobotService, SetTariffError, SetTariffRequest, StreamCode,
    Streamer, Streams, Switch, SwitchMoved, SwitchMovedFields, WatchLoadRequest, WatchLoadResponse,
};
use fc_runtime::digest::{Crc32, DigestAlgorithm as _};
use fc_runtime::{
    AcceptedIn as _, AcceptedStates, Allowance, Audience, Cadence, CallError, ClientConfig,
    Command as _, ConditionErrorKind, Context, DataError, DeclaredError as _, Followed, Handling,
    Header as _, Message as _, Preconditions, PreparedResponse, Protocol as _, PushError, Refusal,
    Request, Server, ServerConfig, ServerHandle, Service, States, StreamItem, read_enveloped,
};
use std::net::{Ipv4Addr, SocketAddr};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::task::JoinHandle;

struct Robot;

impl PartialRobot for Robot {
    async fn close_switch(
        &self,
        _: Context<Meter>,
        _: CloseSwitchRequest,
    ) -> Result<CloseSwitchResponse, Refusal> {
        Err(CloseSwitchError::Locked.into())
    }

    async fn read_power(
        &self,
        _: Context<Meter>,
        _: ReadPowerRequest,
    ) -> Result<ReadPowerResponse, Refusal> {
        Err(Refusal::new(99, "asleep"))
    }
}

async fn serve<S: Service<Meter>>(service: S) -> (SocketAddr, ServerHandle<Meter>, JoinHandle<()>) {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, service).await.unwrap();
    let (address, handle) = (server.command_addr(), server.handle());
    (address, handle, tokio::spawn(server.run()))
}

async fn client(address: SocketAddr) -> Client {
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(address.port())
        .call_timeout(Duration::from_secs(30));
    Client::connect(config).await.unwrap()
}

/// Returns the time in milliseconds, as in requests.
fn now() -> u128 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap().as_millis()
}

#[test]
fn the_header_is_that_of_the_spec() {
    assert_eq!((FrameHeader::LEN, FrameHeader::ID_MAX), (17, 0xFFFF));
    let mut header = FrameHeader::new(Meter::REQUEST_HEAD, Meter::COMMAND, 0x1001, 0x0405, 0);
    header.seal(17, 0, Crc32::digest(b"123456789"));
    let mut bytes = [0; 17];
    assert!(header.write(&mut bytes));
    let expected = [
        0x3E, 0x05, 0x04, 3, 0x26, 0x39, 0xF4, 0xCB, 0x01, 0x10, 17, 0, 0, 0, 0x71, 2, 1,
    ];
    assert_eq!(bytes, expected);
}

/// The methods of an enum follow the state rules of the spec, and add none.
#[test]
fn an_enum_knows_how_its_values_follow_each_other() {
    let all = |mark: fn(&Switch) -> bool| -> Vec<&str> {
        let marked = Switch::VALUES.iter().filter(|value| mark(value));
        marked.map(Switch::wire).collect()
    };
    assert_eq!(all(Switch::is_final), ["shut", "stuck"]);
    assert_eq!(all(Switch::is_error), ["stuck"]);
    assert_eq!(all(|next| next.may_follow(&Switch::Open)), ["moving"]);
    assert_eq!(
        all(|next| next.may_follow(&Switch::Closing)),
        ["shut", "stuck"]
    );
    assert_eq!(all(|next| next.may_follow(&Switch::Closed)), [""; 0]);
    // A newer meter may have another state in between.
    let unknown = Switch::from("locked");
    assert!(unknown.may_follow(&Switch::Closed) && Switch::Open.may_follow(&unknown));
    assert!(!unknown.is_final() && !unknown.is_error());

    assert!(Band::Night.normally_follows(&Band::Day) && Band::Day.normally_follows(&Band::Night));
    assert!(!Band::Day.normally_follows(&Band::Day));
    assert!(!Band::from(9).normally_follows(&Band::Day));
}

/// A sender can check its reports with `checked`. Received reports are not checked.
#[test]
fn a_message_knows_which_of_its_fields_are_asked_for() {
    let moved = |switch: Switch, by: u8| {
        SwitchMoved::new(SwitchMovedFields {
            switch,
            by,
            speed: 9,
        })
    };
    let fault = |report: SwitchMoved| {
        let error = report.checked().err();
        error.map(|error| (error.key(), error.kind(), error.to_string()))
    };
    let stuck = moved(Switch::Stuck, 2).with_amp(5);
    let missing = "`cause` is missing: it is sent when `switch` is \"stuck\"".to_owned();
    assert_eq!(
        fault(stuck.clone()),
        Some(("cause", ConditionErrorKind::Missing, missing))
    );
    assert_eq!(fault(stuck.with_cause("弧光")), None);
    let open = moved(Switch::Open, 0);
    assert_eq!(fault(open.clone()), None);
    let unasked =
        "`amp` is not asked for: it is sent unless `switch` is \"open\" and `by` is 0".to_owned();
    assert_eq!(
        fault(open.with_amp(5)),
        Some(("amp", ConditionErrorKind::Unasked, unasked))
    );
    // Only one of the two conditions holds.
    assert_eq!(fault(moved(Switch::Open, 1).with_amp(5)), None);
    assert_eq!(
        fault(moved(Switch::Open, 1)).map(|(key, kind, _)| (key, kind)),
        Some(("amp", ConditionErrorKind::Missing))
    );
    // The example meets all conditions.
    assert!(SwitchMoved::example().checked().is_ok());
}

/// A meter whose switch is in this state.
struct Switchgear(Switch);

impl PartialRobot for Switchgear {
    async fn close_switch(
        &self,
        _: Context<Meter>,
        _: CloseSwitchRequest,
    ) -> Result<CloseSwitchResponse, Refusal> {
        if !CloseSwitchRequest::accepted_in(&self.0) {
            return Err(CloseSwitchError::Locked.into());
        }
        Ok(CloseSwitchResponse::new())
    }
}

#[tokio::test]
async fn a_robot_refuses_a_command_in_the_wrong_state() {
    let refused = Some(CloseSwitchError::Locked);
    for (state, expected) in [
        (Switch::Open, None),
        (Switch::Closing, refused),
        (Switch::Closed, refused),
        (Switch::Stuck, None),
        // The spec does not accept the command in an unknown state.
        (Switch::from("locked"), refused),
    ] {
        let (address, handle, serving) = serve(RobotService::new(Switchgear(state.clone()))).await;
        let client = client(address).await;
        let answer = client.close_switch(&CloseSwitchRequest::new()).await;
        let error = answer
            .err()
            .map(|error| error.declared::<CloseSwitchRequest>());
        assert_eq!(error, expected.map(Some), "{state:?}");
        drop(client);
        handle.shutdown(Duration::ZERO).await;
        serving.await.unwrap();
    }
}

/// Tools read these from the descriptors, without the types.
#[test]
fn descriptor_has_conditions_and_cadence() {
    const STATES: &[States] = &[States {
        of: "Switch",
        values: &["\"open\"", "\"stuck\""],
    }];
    let of = |name: &str| {
        let mut operations = Meter::operations().iter();
        operations.find(|operation| operation.name == name).unwrap()
    };
    assert_eq!(
        of("close_switch").preconditions,
        Some(Preconditions {
            states: AcceptedStates::Only(STATES),
            after: &["read_power"],
        })
    );
    assert_eq!(of("read_power").preconditions, None);
    assert_eq!(
        of("switch_moved").cadence,
        Some(Cadence::OnChange("switch"))
    );
    let step = Cadence::Step {
        field: "data.price",
        by: 0.5,
    };
    assert_eq!(of("price_moved").cadence, Some(step));
    let every = Cadence::Every(Duration::from_secs(1));
    assert_eq!(of("power_read").cadence, Some(every));
    let within = Cadence::Within(Duration::from_millis(500));
    assert_eq!(of("tariff_set").cadence, Some(within));
    assert_eq!(of("power_lost").cadence, None);
}

/// A robot that closes its switch, and numbers each movement.
struct Closing(std::sync::atomic::AtomicU32);

impl PartialRobot for Closing {
    async fn close_switch(
        &self,
        _: Context<Meter>,
        _: CloseSwitchRequest,
    ) -> Result<CloseSwitchResponse, Refusal> {
        let job = self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        Ok(CloseSwitchResponse::new().with_job(job))
    }
}

/// The job number in the response and in the reports ties them together.
#[tokio::test]
async fn following_ends_at_the_final_state() {
    let (address, handle, serving) = serve(RobotService::new(Closing(5.into()))).await;
    let client = client(address).await;
    let reporter = Reporter::new(handle.clone());
    let request = CloseSwitchRequest::new();
    let mut first = client.close_switch(&request).follow().await.unwrap();
    let mut second = client.close_switch(&request).follow().await.unwrap();
    assert_eq!(
        (first.answer().job, second.answer().job),
        (Some(5), Some(6))
    );
    let moved = |state, job| {
        SwitchMoved::new(SwitchMovedFields {
            switch: state,
            by: 0,
            speed: 9,
        })
        .with_job(job)
    };
    for (state, job) in [
        (Switch::Open, 5),
        (Switch::Open, 6),
        (Switch::Closing, 5),
        (Switch::Stuck, 5),
        // This report skips a state.
        (Switch::Closed, 6),
    ] {
        reporter
            .switch_moved(Audience::All, &moved(state, job))
            .await
            .unwrap();
    }
    for next in [
        Followed::Going(moved(Switch::Open, 5)),
        Followed::Going(moved(Switch::Closing, 5)),
        Followed::Failed(moved(Switch::Stuck, 5)),
    ] {
        assert_eq!(first.recv().await, Some(Ok(next)));
    }
    assert_eq!(first.recv().await, None);
    assert_eq!(client.connection().counters().reports_out_of_order, 0);
    for next in [
        Followed::Going(moved(Switch::Open, 6)),
        Followed::Ended(moved(Switch::Closed, 6)),
    ] {
        assert_eq!(second.recv().await, Some(Ok(next)));
    }
    assert_eq!(second.recv().await, None);
    assert_eq!(client.connection().counters().reports_out_of_order, 1);
    drop((client, first, second));
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// The meter has other keys for results than the real protocol.
#[tokio::test]
async fn a_refusal_is_read_from_its_own_keys() {
    let (address, handle, serving) = serve(RobotService::new(Robot)).await;
    let client = client(address).await;
    let refused = client.read_power(&ReadPowerRequest::new()).await;
    let Err(CallError::Refused(refusal)) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!((refusal.code, &*refusal.text), (99, "asleep"));
    assert!(refusal.declared::<ReadPowerRequest>().is_none());
    let refused = client.set_tariff(&SetTariffRequest::new(Band::Day)).await;
    let Err(CallError::Refused(refusal)) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(
        refusal.code,
        Meter::RESULTS.protocol.code,
        "not implemented"
    );
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// An absent key stays absent, and `…_or_default` returns its default.
#[test]
fn an_absent_field_has_its_default() {
    assert_eq!(SetTariffRequest::DEFAULT_PRICE, 100);
    assert_eq!(SetTariffRequest::DEFAULT_NOTE, "无");
    let request = SetTariffRequest::new(Band::Day);
    assert_eq!(
        (request.price_or_default(), request.note_or_default()),
        (100, "无")
    );
    assert_eq!(
        (request.then_or_default(), request.keep_or_default()),
        (Band::Night, true)
    );
    assert_eq!(
        Phase::new(230.0).amp_or_default().to_bits(),
        0.0_f32.to_bits()
    );
    assert_eq!(request.price, None);
    let request = request
        .with_price(7)
        .with_note("夜间")
        .with_then(Band::Day)
        .with_keep(false);
    assert_eq!(
        (request.price_or_default(), request.note_or_default()),
        (7, "夜间")
    );
    assert_eq!(
        (request.then_or_default(), request.keep_or_default()),
        (Band::Day, false)
    );
}

/// Both sides use a declared error by its name, not its number. Any other result is none of the command's errors.
#[tokio::test]
async fn a_declared_error_has_a_name_on_both_sides() {
    let (address, handle, serving) = serve(RobotService::new(Robot)).await;
    let client = client(address).await;
    let request = CloseSwitchRequest::new().with_who(Operator::new("anna"));
    let refused = client.close_switch(&request).await;
    let error = refused.unwrap_err();
    assert_eq!(
        error.declared::<CloseSwitchRequest>(),
        Some(CloseSwitchError::Locked)
    );
    assert_eq!(
        error.declared::<SetTariffRequest>(),
        Some(SetTariffError::Locked)
    );
    let CallError::Refused(refusal) = error else {
        panic!("{error:?}");
    };
    assert_eq!(refusal, Refusal::from(ResultCode::Locked));
    let refused = client.set_tariff(&SetTariffRequest::new(Band::Day)).await;
    let error = refused.unwrap_err();
    assert_eq!(
        error.declared::<SetTariffRequest>(),
        None,
        "not implemented"
    );
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
    let declared: Vec<_> = SetTariffError::ALL
        .iter()
        .map(|it| it.result().code)
        .collect();
    assert_eq!(declared, [18, 20]);
    assert!(CallError::Timeout.declared::<SetTariffRequest>().is_none());
}

/// The robot detects a damaged frame by its CRC-32 and an old one by its time. Each gets the result for its error.
#[tokio::test]
async fn damage_and_age_are_found() {
    let (address, handle, serving) = serve(RobotService::new(Robot)).await;
    let mut socket = TcpStream::connect(address).await.unwrap();
    for (data, damage, result) in [
        (&br#"{"at":1}"#[..], 0, Meter::RESULTS.expired),
        (br#"{"at":1}"#, 1, Meter::RESULTS.protocol),
    ] {
        let mut header = FrameHeader::new(Meter::REQUEST_HEAD, Meter::COMMAND, 0x1001, 7, 0);
        let total = u32::try_from(FrameHeader::LEN + data.len()).unwrap();
        header.seal(total, 0, Crc32::digest(data));
        header.crc ^= damage;
        let mut frame = vec![0; FrameHeader::LEN];
        header.write(&mut frame);
        frame.extend_from_slice(data);
        socket.write_all(&frame).await.unwrap();
        let mut head = [0; FrameHeader::LEN];
        socket.read_exact(&mut head).await.unwrap();
        let header = FrameHeader::read(&head).unwrap();
        assert_eq!((header.head(), header.id()), (Meter::RESPONSE_HEAD, 7));
        let length = usize::try_from(header.total_length()).unwrap();
        let mut body = vec![0; length - FrameHeader::LEN];
        socket.read_exact(&mut body).await.unwrap();
        assert_eq!(header.digest(), Crc32::digest(&body));
        let read = read_enveloped::<<Meter as fc_runtime::Protocol>::Response, fc_runtime::Empty>(
            &body,
            fc_runtime::Allowance::DEFAULT,
        );
        let envelope = read.unwrap().envelope;
        assert_eq!(
            (i64::from(envelope.outcome), envelope.why.unwrap()),
            (result.code, result.text.to_owned())
        );
    }
    drop(socket);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// The value is a bool in code, and 1 or 0 on the wire. Another number is refused before a handler runs.
#[tokio::test]
async fn a_bool_travels_as_a_number() {
    let service = |request: Request<'_, Meter>| -> Handling {
        request.handle(|_, request: SetTariffRequest| async move {
            let code = match request.now {
                Some(true) => 101,
                Some(false) => 100,
                None => 99,
            };
            Err(Refusal::new(code, ""))
        })
    };
    let (address, handle, serving) = serve(service).await;
    let client = client(address).await;
    let request = SetTariffRequest::new(Band::Day);
    for (now, code) in [(Some(true), 101), (Some(false), 100), (None, 99)] {
        let mut request = request.clone();
        request.now = now;
        let refused = client.set_tariff(&request).await;
        let Err(CallError::Refused(refusal)) = refused else {
            panic!("{refused:?}");
        };
        assert_eq!(refusal.code, code, "{now:?}");
    }
    let wrong = Meter::RESULTS.invalid.code;
    for (sent, code) in [("1", 101), ("0.0", 100), ("true", 101), ("2", wrong)] {
        let body = format!(r#"{{"at":{},"band":1,"now":{sent}}}"#, now());
        let connection = client.connection();
        let answer = connection.call_raw(SetTariffRequest::CODE, body.as_bytes());
        let outcome = answer.await.unwrap().envelope.outcome;
        assert_eq!(i64::from(outcome), code, "{sent}");
    }
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

#[tokio::test]
async fn an_answer_has_its_bool_as_a_number() {
    let service = |request: Request<'_, Meter>| -> Handling {
        request.handle(|_, _: ReadPowerRequest| async { Ok(ReadPowerResponse::example()) })
    };
    let (address, handle, serving) = serve(service).await;
    let client = client(address).await;
    let answer = client.read_power(&ReadPowerRequest::new()).await.unwrap();
    assert!(answer.closed);
    let connection = client.connection();
    let body = format!(r#"{{"at":{}}}"#, now());
    let answer = connection.call_raw(ReadPowerRequest::CODE, body.as_bytes());
    let text = String::from_utf8(answer.await.unwrap().text).unwrap();
    assert!(text.contains(r#""closed":1"#), "{text}");
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// A prepared response keeps the CRC-32 of its body, and each response continues it over the envelope.
#[tokio::test]
async fn a_kept_answer_is_read_by_the_app() {
    let kept = PreparedResponse::new(&ReadPowerResponse::example()).unwrap();
    let service = move |request: Request<'_, Meter>| -> Handling {
        let kept = kept.clone();
        assert_eq!(request.code(), ReadPowerRequest::CODE);
        request.handle_prepared(|_, _: ReadPowerRequest| async move { Ok(kept) })
    };
    let (address, handle, serving) = serve(service).await;
    let client = client(address).await;
    for _ in 0..2 {
        let answer = client.read_power(&ReadPowerRequest::new()).await.unwrap();
        assert_eq!(answer, ReadPowerResponse::example());
    }
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// A stream that a command starts arrives on the data port under the command's code. Each stream is received as its
/// type.
#[tokio::test]
async fn streams_go_both_ways_as_their_types() {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let service = |request: Request<'_, Meter>| -> Handling {
        request.handle(|_, request: WatchLoadRequest| async move {
            assert!(request.send);
            Ok(WatchLoadResponse::new())
        })
    };
    let server = Server::bind(config, service).await.unwrap();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(server.command_addr().port())
        .data_port(server.data_addr().port())
        .call_timeout(Duration::from_secs(30));
    let handle = server.handle();
    let mut from_apps = handle.streams();
    let serving = tokio::spawn(server.run());
    let client = Client::connect(config).await.unwrap();
    let streams = Streams::new(client.data());
    let mut load = streams.subscribe_load();
    let mut waveform = streams.subscribe_waveform();
    assert_eq!(StreamCode::Load.wire(), WatchLoadRequest::CODE);
    client
        .watch_load(&WatchLoadRequest::new(true))
        .await
        .unwrap();

    streams.send_firmware(5, b"\x1F\x8B").await.unwrap();
    let firmware = from_apps.recv().await.unwrap();
    assert_eq!(StreamCode::from(firmware.frame.code), StreamCode::Firmware);
    assert_eq!(
        (firmware.frame.id, &*firmware.frame.data),
        (5, &b"\x1F\x8B"[..])
    );
    let readings = Readings::new(vec![1.5, 2.0]);
    streams.send_readings(6, &readings).await.unwrap();
    let received = from_apps.recv().await.unwrap().frame;
    assert_eq!(
        &*received.data, br#"{"days":[1.5,2.0]}"#,
        "without an envelope"
    );
    assert_eq!(received.read::<Readings>(Allowance::DEFAULT), Ok(readings));
    let none = streams.send_readings(7, &Readings::new(Vec::new())).await;
    assert!(matches!(&none, Err(error @ DataError::Invalid(_)) if error.name() == "bad_length"));

    let app = Audience::One(firmware.connection);
    let streamer = Streamer::new(handle.clone());
    let content = Load::new(LoadFields {
        watts: 2.5,
        band: Band::Day,
    });
    assert_eq!(streamer.send_load(app, 9, &content).await, Ok(1));
    assert_eq!(streamer.send_waveform(app, 10, &[0, 0xFF]).await, Ok(1));
    assert_eq!(load.recv().await, Ok(StreamItem { id: 9, content }));
    let wave = waveform.recv().await.unwrap();
    assert_eq!((wave.id, &*wave.content), (10, &[0, 0xFF][..]));
    let less = streamer
        .send_load(
            app,
            11,
            &Load::new(LoadFields {
                watts: -1.0,
                band: Band::Day,
            }),
        )
        .await;
    assert!(matches!(less, Err(PushError::Invalid(_))));
    assert_eq!(
        (load.missed(), waveform.missed(), streams.data().missed()),
        (0, 0, 0)
    );

    drop((streams, client));
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}
