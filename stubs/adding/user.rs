//! An app and a robot that use what `noise.yaml` adds.

use fc_generated::{
    AnyReport, Client, Fc, MeasureNoiseRequest, MeasureNoiseResponse, NoiseBand, NoiseChanged,
    PartialRobot, Reporter, RobotService,
};
use fc_runtime::{Audience, Context, Refusal, Service};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

struct Ear;

impl PartialRobot for Ear {
    async fn measure_noise(
        &self,
        _: Context<Fc>,
        request: MeasureNoiseRequest,
    ) -> Result<MeasureNoiseResponse, Refusal> {
        let band = NoiseBand::new(1000).with_level(f64::from(request.seconds));
        Ok(MeasureNoiseResponse::new(vec![band]))
    }
}

pub async fn first_level(client: &Client) -> Outcome<Option<f64>> {
    let answer = client.measure_noise(&MeasureNoiseRequest::new(3)).await?;
    Ok(answer.bands.first().and_then(|band: &NoiseBand| band.level))
}

pub async fn heard(client: &Client) -> Outcome<Option<u32>> {
    let mut reports = client.reports();
    while let Some(report) = reports.recv().await {
        if let AnyReport::NoiseChanged(report) = report? {
            return Ok(Some(report.loudest.hertz));
        }
    }
    Ok(None)
}

pub async fn tell(reporter: &Reporter) -> Outcome<usize> {
    let report = NoiseChanged::new(NoiseBand::new(1000));
    Ok(reporter.noise_changed(Audience::All, &report).await?.len())
}

pub fn robot() -> impl Service<Fc> {
    RobotService::new(Ear)
}
