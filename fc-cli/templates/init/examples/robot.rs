//! The lamp: stores its light, and reports each change to every app.
//!
//! ```text
//! cargo run --example robot
//! ```

use std::error::Error;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use lamp_protocol::prelude::*;
use tokio::sync::watch;

/// A simulated lamp.
pub struct MyLamp {
    /// The light. Its receivers are notified of changes.
    light: watch::Sender<LightChanged>,
    /// Held during a change, so that changes do not overlap.
    changing: Mutex<()>,
}

impl MyLamp {
    /// Creates a lamp with this light.
    pub fn new(light: watch::Sender<LightChanged>) -> Self {
        Self {
            light,
            changing: Mutex::default(),
        }
    }
}

impl Robot for MyLamp {
    async fn get_light(
        &self,
        _context: Context<Lamp>,
        _request: GetLightRequest,
    ) -> Result<GetLightResponse, Refusal> {
        let light = self.light.borrow();
        Ok(GetLightResponse::new(GetLightResponseFields {
            brightness: light.brightness,
            mood: light.mood.clone(),
        }))
    }

    async fn set_light(
        &self,
        _context: Context<Lamp>,
        request: SetLightRequest,
    ) -> Result<SetLightResponse, Refusal> {
        let _changing = self.changing.lock().unwrap_or_else(PoisonError::into_inner);
        self.light.send_modify(|light| {
            light.brightness = request.brightness;
            if let Some(mood) = request.mood {
                light.mood = mood;
            }
        });
        Ok(SetLightResponse::new())
    }
}

/// Reports each change to every app, until the lamp is dropped.
pub async fn report(reporter: Reporter, mut light: watch::Receiver<LightChanged>) {
    while light.changed().await.is_ok() {
        let now = light.borrow_and_update().clone();
        if let Err(error) = reporter.light_changed(Audience::All, &now).await {
            eprintln!("cannot report: {error}");
        }
    }
}

#[allow(dead_code, reason = "the test does not call it")]
#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let (light, watched) = watch::channel(LightChanged::new(LightChangedFields {
        brightness: 0,
        mood: Mood::Warm,
    }));
    let server = Server::bind(ServerConfig::new(), RobotService::new(MyLamp::new(light))).await?;
    println!(
        "commands {} data {}",
        server.command_addr(),
        server.data_addr()
    );
    let handle = server.handle();
    tokio::spawn(report(Reporter::new(handle.clone()), watched));
    let serving = tokio::spawn(server.run());
    tokio::signal::ctrl_c().await?;
    handle.shutdown(Duration::from_secs(1)).await;
    serving.await?;
    Ok(())
}
