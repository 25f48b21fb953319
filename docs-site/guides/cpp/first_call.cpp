// The first call, from both ends: a robot that has two commands so far, and an app that calls one
// and takes a report.
#include <algorithm>
#include <chrono>
#include <fc/client.hpp>
#include <fc/robot.hpp>
#include <future>
#include <iostream>
#include <memory>
#include <variant>

namespace {

// #region robot
class MyRobot : public fc::PartialRobot {
 public:
  fc_runtime::Replied<fc::GetRobotSnResponse> get_robot_sn(
      const fc_runtime::Context& /*context*/, const fc::GetRobotSnRequest& /*request*/) override {
    fc::GetRobotSnResponse response;
    response.data.robot_sn = "100132007654321";
    response.data.robot_model = "Indoor";
    return response;
  }

  // 这里没有充电桩。There is no dock here.
  fc_runtime::Replied<fc::StartRechargeResponse> start_recharge(
      const fc_runtime::Context& /*context*/,
      const fc::StartRechargeRequest& /*request*/) override {
    return fc::refusal(fc::ResultCode::InvalidParameter);
  }
};
// #endregion robot

// #region report
std::ptrdiff_t report(const fc_runtime::Server& server) {
  fc::RechargeProgress report;
  report.data.recharge_status = fc::RechargeStatus::AtUndockPoint;
  report.data.error_status = fc::RechargeError::Ok;
  // 等到每个 app 应答，或重发次数用完。
  // Waits until every app has acknowledged it, or the repetitions are used up.
  const auto ended = fc::Reporter(server).recharge_progress(report);
  if (!ended) return 0;
  return std::count_if(ended->begin(), ended->end(), [](const fc_runtime::AckOutcome& outcome) {
    return outcome.kind == fc_runtime::AckOutcomeKind::Acknowledged;
  });
}
// #endregion report

// #region app
bool app(const fc::Client& client) {
  const auto answer = client.get_robot_sn({});
  if (!answer) {
    std::cerr << "app: " << answer.error() << '\n';
    return false;
  }
  std::cout << "app: the robot is " << answer->data.robot_sn << '\n';
  return true;
}
// #endregion app

// #region listen
bool listen(const fc::Reports& reports) {
  while (const auto report = reports.next(std::chrono::seconds(10))) {
    if (const auto* progress = std::get_if<fc::RechargeProgress>(&*report)) {
      std::cout << "app: recharging is at " << progress->data.recharge_status << '\n';
      return true;
    }
  }
  return false;
}
// #endregion listen

}  // namespace

int main() {
  // #region serve
  fc_runtime::ServerConfig config;
  config.address = "127.0.0.1";
  // 0：由系统分配。不写就是协议规定的端口。
  // 0 is any that is free; without it, the ports of the protocol.
  config.command_port = std::uint16_t{0};
  config.data_port = std::uint16_t{0};
  const auto service = fc::service(std::make_shared<MyRobot>());
  const auto server = fc_runtime::Server::bind(fc::protocol(), service, config);
  if (!server) {
    std::cerr << to_string(server.error()) << '\n';
    return 1;
  }
  // #endregion serve

  // #region connect
  fc_runtime::ClientConfig robot;
  robot.host = "127.0.0.1";
  robot.command_port = server->command_port();
  const auto client = fc::Client::connect(robot);
  if (!client) {
    std::cerr << to_string(client.error()) << '\n';
    return 1;
  }
  // #endregion connect

  if (!app(*client)) return 1;
  const fc::Reports reports = client->reports();
  auto acknowledged = std::async(std::launch::async, [&server] { return report(*server); });
  if (!listen(reports)) return 1;
  std::cout << "robot: " << acknowledged.get() << " app has acknowledged\n";
  return 0;
}
