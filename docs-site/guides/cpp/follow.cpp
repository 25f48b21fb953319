// An app that sends its robot to the dock and follows it there.
#include <chrono>
#include <fc/client.hpp>
#include <fc/robot.hpp>
#include <future>
#include <iostream>
#include <memory>
#include <utility>

namespace {

// #region follow
void recharge(const fc::Client& client) {
  auto following = client.follow<fc::RechargeProgress>(fc::StartRechargeRequest{});
  if (!following) {
    std::cout << "not begun: " << following.error().name() << '\n';
    return;
  }
  using Kind = fc_runtime::Followed<fc::RechargeProgress>::Kind;
  while (const auto next = following->next(std::chrono::minutes(5))) {
    switch (next->kind) {
      case Kind::Going:
        std::cout << "on its way: " << next->report->data.recharge_status << '\n';
        break;
      case Kind::Ended:
        std::cout << "it charges\n";
        break;
      case Kind::Failed:
        std::cout << "it cannot: " << next->report->data.error_status << '\n';
        break;
      case Kind::Missed:
      case Kind::Interrupted:
      case Kind::Resumed:
        // 其间的上报可能不会再来：去查询。
        // What was reported meanwhile may never come: ask.
        if (const auto status = client.get_recharge_status({})) {
          std::cout << status->data.recharge_status << '\n';
        }
        break;
      case Kind::Closed:
        std::cout << "no connection any more: " << to_string(next->why) << '\n';
        break;
    }
  }
}
// #endregion follow

/// A robot that sets off when it is asked to.
class DockingRobot : public fc::PartialRobot {
 public:
  fc_runtime::Replied<fc::StartRechargeResponse> start_recharge(
      const fc_runtime::Context& /*context*/,
      const fc::StartRechargeRequest& /*request*/) override {
    asked_.set_value();
    return fc::StartRechargeResponse{};
  }

  void wait() { asked_.get_future().wait(); }

 private:
  std::promise<void> asked_;
};

/// It says how far it has come, and in the end that it cannot go on.
void drive(const fc_runtime::Server& server) {
  using Status = fc::RechargeStatus;
  using Error = fc::RechargeError;
  for (const auto& [status, error] :
       {std::pair(Status::Navigating, Error::Ok), std::pair(Status::AtUndockPoint, Error::Ok),
        std::pair(Status::AtUndockPoint, Error::Failed)}) {
    fc::RechargeProgress report;
    report.data.recharge_status = status;
    report.data.error_status = error;
    const auto ended = fc::Reporter(server).recharge_progress(report);
    if (!ended) std::cerr << to_string(ended.error()) << '\n';
  }
}

}  // namespace

int main() {
  fc_runtime::ServerConfig config;
  config.address = "127.0.0.1";
  config.command_port = std::uint16_t{0};
  config.data_port = std::uint16_t{0};
  const auto robot = std::make_shared<DockingRobot>();
  const auto server = fc_runtime::Server::bind(fc::protocol(), fc::service(robot), config);
  if (!server) {
    std::cerr << to_string(server.error()) << '\n';
    return 1;
  }
  fc_runtime::ClientConfig there;
  there.host = "127.0.0.1";
  there.command_port = server->command_port();
  const auto client = fc::Client::connect(there);
  if (!client) {
    std::cerr << to_string(client.error()) << '\n';
    return 1;
  }
  const auto following = std::async(std::launch::async, [&client] { recharge(*client); });
  robot->wait();
  drive(*server);
  following.wait();
  return 0;
}
