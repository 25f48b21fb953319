//! 遥控器：调亮台灯，等待台灯上报。
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
        "当前亮度 {} %，色调 {:?}",
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
            println!("台灯上报：亮度 {} %，色调 {:?}", light.brightness, light.mood);
            break;
        }
    }
    Ok(())
}
