//! 台灯：保存亮度，亮度变化时向每个 app 上报。
//!
//! ```text
//! cargo run --example robot
//! ```

use std::error::Error;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use lamp_protocol::prelude::*;
use tokio::sync::watch;

/// 一盏示例台灯。
pub struct MyLamp {
    /// 当前的灯光；订阅者会收到变化。
    light: watch::Sender<LightChanged>,
    /// 同一时间只处理一次修改。
    changing: Mutex<()>,
}

impl MyLamp {
    /// 创建一盏台灯，灯光由参数给出。
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

/// 向每个 app 上报每次变化，直到台灯关闭。
pub async fn report(reporter: Reporter, mut light: watch::Receiver<LightChanged>) {
    while light.changed().await.is_ok() {
        let now = light.borrow_and_update().clone();
        if let Err(error) = reporter.light_changed(Audience::All, &now).await {
            eprintln!("上报失败：{error}");
        }
    }
}

#[allow(dead_code, reason = "测试不使用它")]
#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let (light, watched) = watch::channel(LightChanged::new(LightChangedFields {
        brightness: 0,
        mood: Mood::Warm,
    }));
    let server = Server::bind(ServerConfig::new(), RobotService::new(MyLamp::new(light))).await?;
    println!(
        "指令端口 {}，数据端口 {}",
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
