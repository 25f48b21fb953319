// The generated stubs over TCP, and the facts of messages.
#include <condition_variable>
#include <future>
#include <mutex>
#include <sstream>
#include <type_traits>

#include "fc/client.hpp"
#include "fc/robot.hpp"
#include "fc/tables.hpp"
#include "support/check.hpp"
#include "support/lines.hpp"

namespace {

using std::chrono::seconds;
using tests::Lines;
using tests::Tally;

constexpr seconds kPatience{20};

/// A robot that returns its serial number and drives to its dock.
class Docking : public fc::PartialRobot {
 public:
  fc_runtime::Replied<fc::GetRobotSnResponse> get_robot_sn(
      const fc_runtime::Context& context, const fc::GetRobotSnRequest& /*request*/) override {
    auto response = fc_runtime::example<fc::GetRobotSnResponse>();
    const bool is_known = context.time_ms && context.address == "127.0.0.1";
    response.data.robot_sn = is_known ? "100132001234568" : "100132001234569";
    return response;
  }
  fc_runtime::Replied<fc::StartRechargeResponse> start_recharge(
      const fc_runtime::Context& /*context*/,
      const fc::StartRechargeRequest& /*request*/) override {
    const std::lock_guard held(mutex_);
    if (is_busy_) return fc::refusal(fc::ResultCode::InvalidParameter);
    is_busy_ = true;
    return fc::StartRechargeResponse{};
  }

  fc_runtime::RawReplied pass_through(const fc_runtime::Context& context,
                                      std::string_view text) override {
    auto answer = fc_runtime::Json::parse(R"({"code":)" + std::to_string(context.code) +
                                          R"(,"bytes":)" + std::to_string(text.size()) + "}");
    return answer.value_or(fc_runtime::Json());
  }

 private:
  std::mutex mutex_;
  bool is_busy_ = false;
};

fc_runtime::ServerConfig free_ports() {
  fc_runtime::ServerConfig config;
  config.address = "127.0.0.1";
  config.command_port = std::uint16_t{0};
  config.data_port = std::uint16_t{0};
  return config;
}

fc_runtime::Server robot_of(std::shared_ptr<fc::Robot> robot) {
  return *fc_runtime::Server::bind(fc::protocol(), fc::service(std::move(robot)), free_ports());
}

fc::Client app_of(const fc_runtime::Server& server) {
  fc_runtime::ClientConfig config;
  config.host = "127.0.0.1";
  config.command_port = server.command_port();
  config.data_port = server.data_port();
  config.call_timeout = kPatience;
  return *fc::Client::connect(config);
}

fc::RechargeProgress progress(fc::RechargeStatus status, fc::RechargeError error) {
  auto report = fc_runtime::example<fc::RechargeProgress>();
  report.data.recharge_status = status;
  report.data.error_status = error;
  return report;
}

void partial(Tally& tally) {
  const auto server = robot_of(std::make_shared<Docking>());
  const auto client = app_of(server);
  const auto sn = client.get_robot_sn({});
  tally.check(sn && sn->data.robot_sn == "100132001234568", "a typed call");
  const auto missing = client.list_maps({});
  tally.check(!missing && missing.error().refusal &&
                  missing.error().refusal->text.find("not implemented") != std::string::npos,
              "what is left out is refused");
  const auto passed = client.connection().call_body(0x0250, R"({"any":1})");
  tally.check(passed && passed->find(R"("code":592,"bytes":9})") != std::string::npos,
              "a code that is passed through");
  const auto unknown = client.connection().call_body(0x0999, "{}");
  tally.check(unknown && unknown->find("2001") != std::string::npos, "any other code is unknown");
  const auto first = client.start_recharge({});
  const auto second = client.start_recharge({});
  tally.check(bool(first), "it sets off");
  tally.check(!second && second.error().refusal->code == 2003, "and is busy");
}

/// Calls every command of a robot that responds with examples, and of one that moves nothing.
void examples(Tally& tally) {
  const auto pretending = robot_of(std::make_shared<fc::ExampleRobot>(true));
  const auto client = app_of(pretending);
  int commands = 0;
  fc::for_each_command([&](const auto& any) {
    using Request = std::decay_t<decltype(any)>;
    using Response = typename fc_runtime::Command<Request>::Response;
    ++commands;
    const auto answer = client.connection().call(fc_runtime::example<Request>());
    tally.check(answer && *answer == fc_runtime::example<Response>(),
                fc_runtime::Command<Request>::name);
  });
  tally.check(commands >= 37, "there are commands");
  const auto honest = robot_of(std::make_shared<fc::ExampleRobot>());
  const auto careful = app_of(honest);
  tally.check(!careful.start_recharge({}), "nothing moves by an example");
  tally.check(bool(careful.get_robot_sn({})), "but it answers");
}

void reports(Tally& tally) {
  const auto server = robot_of(std::make_shared<Docking>());
  const auto client = app_of(server);
  const auto reports = client.reports();
  tally.check(bool(client.get_robot_sn({})), "it is connected");
  const fc::Reporter reporter(server);
  const auto sent = progress(fc::RechargeStatus::Docked, fc::RechargeError{});
  const auto pushed = reporter.recharge_progress(sent);
  tally.check(pushed && pushed->size() == 1 &&
                  pushed->front().kind == fc_runtime::AckOutcomeKind::Acknowledged,
              "a typed report is acknowledged");
  const auto came = reports.next(kPatience);
  const auto* typed = came ? std::get_if<fc::RechargeProgress>(&*came) : nullptr;
  tally.check(typed != nullptr && *typed == sent, "and comes as its type");
  static_cast<void>(server.push_body(0x7777, "{}"));
  const auto other = reports.next(kPatience);
  const auto* raw = other ? std::get_if<fc_runtime::RawReport>(&*other) : nullptr;
  tally.check(raw != nullptr && raw->code == 0x7777, "another code is kept unchanged");
}

void follow(Tally& tally) {
  using Kind = fc_runtime::Followed<fc::RechargeProgress>::Kind;
  const auto server = robot_of(std::make_shared<Docking>());
  const auto client = app_of(server);
  auto following = client.follow<fc::RechargeProgress>(fc::StartRechargeRequest{});
  tally.check(bool(following), "it sets off");
  const fc::Reporter reporter(server);
  const fc::RechargeError none{};
  for (const auto status : {fc::RechargeStatus::Navigating, fc::RechargeStatus::AtUndockPoint,
                            fc::RechargeStatus::Docked}) {
    tally.check(bool(reporter.recharge_progress(progress(status, none))), "it reports");
    const auto next = following->next(kPatience);
    tally.check(next && next->kind == Kind::Going && next->report->data.recharge_status == status,
                "it goes on");
  }
  // A report back at the first state is handed on and counted.
  static_cast<void>(reporter.recharge_progress(progress(fc::RechargeStatus::Navigating, none)));
  const auto back = following->next(kPatience);
  tally.check(
      back && back->kind == Kind::Going && client.connection().counters().reports_out_of_order == 1,
      "out of order");
  const auto failure = progress(fc::RechargeStatus::Navigating, fc::RechargeError::Failed);
  static_cast<void>(reporter.recharge_progress(failure));
  const auto failed = following->next(kPatience);
  tally.check(failed && failed->kind == Kind::Failed && failed->is_over(), "it fails");
  tally.check(!following->next(std::chrono::milliseconds(0)), "and is over");
  const auto refused = client.follow<fc::RechargeProgress>(fc::StartRechargeRequest{});
  tally.check(!refused && refused.error().name() == "refused", "a refusal is not followed");
}

/// A robot that responds without the required fields.
class Forgetful : public fc::PartialRobot {
 public:
  fc_runtime::Replied<fc::GetRobotSnResponse> get_robot_sn(
      const fc_runtime::Context& /*context*/, const fc::GetRobotSnRequest& /*request*/) override {
    return fc::GetRobotSnResponse{};
  }
};

/// An unset required field is not sent as 0 or "".
void required(Tally& tally) {
  const auto refused = [&tally](const auto& message, const std::string& path) {
    const auto text = fc_runtime::to_json(message);
    tally.check(!text && text.error().kind == fc_runtime::BodyErrorKind::MissingField &&
                    text.error().path == path,
                path + ": " + (text ? *text : to_string(text.error())));
  };
  refused(fc::GetRobotSnResponse{}, "data.robotSn");
  refused(fc::GetTaskHistoryRequest{}, "taskId");
  fc::RechargeProgress half;
  half.data.recharge_status = fc::RechargeStatus{};
  refused(half, "data.errorStatus");
  std::ostringstream printed;
  printed << fc::GetTaskHistoryRequest{};
  tally.check(printed.str() == "GetTaskHistoryRequest{taskId: (unset)}", printed.str());

  // A field that was set to 0 is sent.
  fc::GetTaskHistoryRequest request;
  tally.check(!request.task_id.is_set() && request.task_id == 0, "it reads as its type");
  request.task_id = 0;
  tally.check(fc_runtime::to_json(request).value_or("") == R"({"taskId":0})", "0 that is meant");
  tally.check(request != fc::GetTaskHistoryRequest{}, "which is not the same as none");
  const auto read = fc_runtime::from_json<fc::GetTaskHistoryRequest>(R"({"taskId":0})");
  tally.check(read && *read == request, "and is read so");
  fc_runtime::Required<std::string> text;
  tally.check(!text.is_set() && text.empty() && (text = "").is_set(),
              "a text that is meant to be empty");
  fc_runtime::Required<std::string> appended;
  appended.append("x");
  tally.check(appended.is_set(), "that is changed by its members");

  Lines lines;
  fc_runtime::ServerConfig config = free_ports();
  config.log = lines.log();
  const auto server =
      *fc_runtime::Server::bind(fc::protocol(), fc::service(std::make_shared<Forgetful>()), config);
  const auto client = app_of(server);
  const auto call = client.delete_station({});
  tally.check(!call && call.error().name() == "invalid_request", "a call is not sent");
  const auto answer = client.get_robot_sn({});
  tally.check(!answer && answer.error().refusal && answer.error().refusal->code == 2001,
              "a response is refused");
  tally.check(lines.has("the response to `get_robot_sn` cannot be sent: missing_field at "
                        "`data.robotSn`"),
              "and logged");
  const auto pushed = fc::Reporter(server).recharge_progress({});
  tally.check(!pushed && pushed.error().kind == fc_runtime::PushErrorKind::Invalid,
              "a report is not sent");
}

void messages(Tally& tally) {
  using fc::StationType;
  auto station = fc_runtime::example<fc::AddStationRequest>();
  station.station_type = StationType::Elevator;
  station.device_id = "lift";
  station.station_pos.reset();
  const auto missing = fc_runtime::check_conditions(station);
  tally.check(missing && missing->is_missing && missing->path == "stationPos", "a condition");
  station.station_type = StationType::Navigation;
  const auto unasked = fc_runtime::check_conditions(station);
  tally.check(unasked && !unasked->is_missing && unasked->path == "deviceId", "another");
  tally.check(is_known(StationType::Gate) && !is_known(static_cast<StationType>(77)), "is_known");
  std::ostringstream printed;
  printed << static_cast<StationType>(77) << " " << fc::CellLocation("behind") << " "
          << fc::CellLocation(fc::CellLocation::Value::Top);
  tally.check(printed.str() == "Unknown(77) Unknown(\"behind\") Top", printed.str());
  tally.check(normally_follows(fc::RechargeStatus::Docked, fc::RechargeStatus::AtUndockPoint) &&
                  !normally_follows(fc::RechargeStatus::Docked, fc::RechargeStatus::Idle),
              "what follows");
  tally.check(!fc::cell_layouts().empty() && fc::cell_layouts().front() != fc::CellLayout{},
              "a table has rows");
  // The example of each type can be read as the type and satisfies its conditions.
  for (const auto& operation : fc::protocol().operations) {
    for (const auto& type : {operation.request, operation.response}) {
      if (!type) continue;
      const auto again = type->transcode(type->example, {}, nullptr);
      tally.check(bool(again), std::string(type->name) + " has an example of another type");
    }
  }
}

}  // namespace

int main() {
  Tally tally;
  for (const auto test : {partial, examples, reports, follow, required, messages}) test(tally);
  return tally.outcome("things about stubs", 139);
}
