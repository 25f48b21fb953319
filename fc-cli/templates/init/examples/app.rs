//! The remote: makes the lamp brighter and waits for its report.
//!
//! ```text
//! cargo run --example app
//! ```

use std::error::Error;

use lamp_protocol::prelude::*;

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let client = Client::connect(ClientConfig::new()).await?;
    let mut reports = client.reports();
    let light = client.get_light(&GetLightRequest::new()).await?;
    println!(
        "the light is at {} % and {:?}",
        light.brightness, light.mood
    );

    let brightness = if light.brightness > 90 {
        10
    } else {
        light.brightness + 10
    };
    client.set_light(&SetLightRequest::new(brightness)).await?;
    while let Some(report) = reports.recv().await {
        if let AnyReport::LightChanged(light) = report? {
            println!("the lamp reports {} % and {:?}", light.brightness, light.mood);
            break;
        }
    }
    Ok(())
}
