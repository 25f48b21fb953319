//! Follows a command of the spec over TCP with the generated stubs, through all of its states.

use fc_generated::{
    AnyReport, Client, Fc, PartialRobot, RechargeError, RechargeProgress, RechargeStatus, Reporter,
    RobotService, StartRechargeRequest, StartRechargeResponse,
};
use fc_runtime::{
    AckOutcome, Audience, ClientConfig, Context, FollowError, Followed, Loss, Message, Refusal,
    Server, ServerConfig,
};
use std::net::Ipv4Addr;
use std::time::Duration;

struct Docking;

impl PartialRobot for Docking {
    async fn start_recharge(
        &self,
        _: Context<Fc>,
        _: StartRechargeRequest,
    ) -> Result<StartRechargeResponse, Refusal> {
        Ok(StartRechargeResponse::default())
    }
}

fn at(status: RechargeStatus, error: RechargeError) -> RechargeProgress {
    let mut report = RechargeProgress::example();
    report.data.recharge_status = status;
    report.data.error_status = error;
    report
}

#[tokio::test]
async fn recharging_is_followed_to_its_failure() {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::<Fc>::bind(config, RobotService::new(Docking))
        .await
        .unwrap();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(server.command_addr().port())
        .call_timeout(Duration::from_secs(30));
    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    let client = Client::connect(config).await.unwrap();
    let reporter = Reporter::new(handle.clone());

    let request = StartRechargeRequest::default();
    // A plain call still works.
    client.start_recharge(&request).await.unwrap();
    let mut others = client.reports();
    let mut following = client.start_recharge(&request).follow().await.unwrap();
    let mut second = client.start_recharge(&request).follow().await.unwrap();
    assert_eq!(following.answer(), &StartRechargeResponse::default());

    // All states in the order of the spec, then two earlier ones. The spec declares none of them as final.
    let (fine, failed) = (RechargeError::Ok, RechargeError::Failed);
    let mut reports: Vec<_> = RechargeStatus::VALUES
        .iter()
        .map(|it| (*it, fine))
        .collect();
    reports.extend([(RechargeStatus::Idle, fine), (RechargeStatus::Docked, fine)]);
    reports.push((RechargeStatus::Docked, failed));
    for (status, error) in reports {
        let report = at(status, error);
        let pushed = reporter.recharge_progress(Audience::All, &report).await;
        let outcomes: Vec<_> = pushed.unwrap().into_iter().map(|it| it.outcome).collect();
        assert_eq!(outcomes, [AckOutcome::Acknowledged]);
        let meant = if error == failed {
            Followed::Failed(report.clone())
        } else {
            Followed::Going(report.clone())
        };
        assert_eq!(following.recv().await, Some(Ok(meant.clone())));
        assert_eq!(second.recv().await, Some(Ok(meant)));
        let other = others.recv().await;
        assert_eq!(other, Some(Ok(AnyReport::RechargeProgress(report))));
    }
    assert_eq!(following.recv().await, None);
    // Docking does not normally follow idle, and each of the two followers counts that. The return to idle breaks no
    // rule of the spec.
    let counters = client.connection().counters();
    assert_eq!(counters.reports_out_of_order, 2);

    let mut closed = client.start_recharge(&request).follow().await.unwrap();
    client.connection().close();
    let error = FollowError::Closed(Loss::Here);
    assert_eq!(closed.recv().await, Some(Err(error)));
    assert_eq!(closed.recv().await, None);
    drop((client, others));
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}
