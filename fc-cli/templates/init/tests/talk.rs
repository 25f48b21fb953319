//! An app and the lamp exchange messages.

#[path = "../examples/robot.rs"]
mod robot;

use std::error::Error;
use std::net::Ipv4Addr;
use std::time::Duration;

use lamp_protocol::prelude::*;
use robot::MyLamp;
use tokio::sync::watch;

#[tokio::test(flavor = "current_thread")]
async fn set_light_changes_the_light_and_is_reported() -> Result<(), Box<dyn Error>> {
    let (light, watched) = watch::channel(LightChanged::new(LightChangedFields {
        brightness: 0,
        mood: Mood::Warm,
    }));
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, RobotService::new(MyLamp::new(light))).await?;
    let port = server.command_addr().port();
    let handle = server.handle();
    tokio::spawn(robot::report(Reporter::new(handle.clone()), watched));
    let serving = tokio::spawn(server.run());

    let client = Client::connect(ClientConfig::new().host("127.0.0.1").command_port(port)).await?;
    let mut reports = client.reports();
    let mut request = SetLightRequest::new(30);
    request.mood = Some(Mood::Cold);
    client.set_light(&request).await?;
    let Some(AnyReport::LightChanged(report)) = reports.recv().await.transpose()? else {
        return Err("unexpected report".into());
    };
    assert_eq!((report.brightness, &report.mood), (30, &Mood::Cold));
    let light = client.get_light(&GetLightRequest::new()).await?;
    assert_eq!((light.brightness, light.mood), (30, Mood::Cold));
    // The client does not send a value that breaks the spec.
    assert!(client.set_light(&SetLightRequest::new(101)).await.is_err());

    drop(client);
    handle.shutdown(Duration::from_secs(1)).await;
    serving.await?;
    Ok(())
}
