// Calls every command of the odd protocol over TCP, and checks the types whose names had to change.
#include <cstdio>
#include <limits>
#include <sstream>
#include <type_traits>

#include "odd_line/client.hpp"
#include "odd_line/robot.hpp"
#include "odd_line/tables.hpp"

namespace {

int failed = 0;

void check(bool holds, const char* what) {
  if (holds) return;
  ++failed;
  std::fprintf(stderr, "does not hold: %s\n", what);
}

int call_all() {
  fc_runtime::ServerConfig robot;
  robot.address = "127.0.0.1";
  robot.command_port = std::uint16_t{0};
  robot.data_port = std::uint16_t{0};
  // The odd protocol limits handlers to one millisecond, which is too short on a busy machine.
  robot.handler_timeout = std::chrono::seconds(60);
  const auto server = fc_runtime::Server::bind(
      odd_line::protocol(), odd_line::service(std::make_shared<odd_line::ExampleRobot>(true)),
      robot);
  fc_runtime::ClientConfig app;
  app.host = "127.0.0.1";
  app.command_port = server->command_port();
  app.call_timeout = std::chrono::seconds(60);
  const auto client = odd_line::Client::connect(app);
  int commands = 0;
  odd_line::for_each_command([&](const auto& any) {
    using Request = std::decay_t<decltype(any)>;
    using Response = typename fc_runtime::Command<Request>::Response;
    ++commands;
    const auto answer = client->connection().call(fc_runtime::example<Request>());
    check(answer && *answer == fc_runtime::example<Response>(), fc_runtime::Command<Request>::name);
    if (!answer) std::fprintf(stderr, "  %s\n", fc_runtime::to_string(answer.error()).c_str());
  });
  check(bool(client->list({})), "a method called like a type");
  return commands;
}

/// The facts of operations as data.
void facts() {
  const auto& known = odd_line::protocol();
  const auto* drive = known.find(fc_runtime::OperationKind::Command,
                                 fc_runtime::Command<odd_line::DriveRequest>::code);
  check(drive && drive->preconditions && !drive->preconditions->any_state, "conditions");
  const auto& states = drive->preconditions->states;
  check(states.size() == 1 && states[0].type == "Going" && states[0].values.size() == 2, "states");
  check(drive->preconditions->after.size() == 1, "a command that comes first");
  const auto* went =
      known.find(fc_runtime::OperationKind::Report, fc_runtime::Report<odd_line::Went>::code);
  check(went && went->cadence && went->cadence->kind == fc_runtime::CadenceKind::OnChange &&
            went->cadence->field == "going",
        "the time of a report");
}

/// The streams of both sides, through their methods.
void streams() {
  fc_runtime::ServerConfig robot;
  robot.address = "127.0.0.1";
  robot.command_port = std::uint16_t{0};
  robot.data_port = std::uint16_t{0};
  const auto server = *fc_runtime::Server::bind(
      odd_line::protocol(), odd_line::service(std::make_shared<odd_line::ExampleRobot>()), robot);
  fc_runtime::ClientConfig app;
  app.host = "127.0.0.1";
  app.command_port = server.command_port();
  app.data_port = server.data_port();
  const auto client = *odd_line::Client::connect(app);
  const odd_line::Streams streams(client.data());
  const auto lists = streams.subscribe_lists();
  check(bool(streams.data().connected()), "the data port");
  const auto wait = std::chrono::seconds(60);
  check(!server.next_stream(std::chrono::seconds(0)), "nothing yet");
  check(bool(streams.send_print(3, "bytes")), "the app sends");
  const auto print = server.next_stream(wait);
  check(print && print->frame.data == "bytes", "the robot receives");
  const odd_line::Streamer streamer(server);
  check(bool(streamer.send_lists(std::nullopt, 4, fc_runtime::example<odd_line::Lists>())),
        "the robot sends");
  const auto item = lists.next(wait);
  check(item && item->id == 4 && item->content.str == "a", "the app receives its type");
}

void said() {
  using Going = odd_line::Going::Value;
  auto request = fc_runtime::example<odd_line::DriveRequest>();
  request.going.reset();
  check(request.going_or_default() == Going::Name, "what is absent has its default");
  std::ostringstream printed;
  printed << request;
  check(printed.str().find("it's") == std::string::npos, "a secret is not printed");
  check(fc_runtime::to_json(request)->find("it's") != std::string::npos, "but sent");
  // Groups that use types of each other.
  const auto here =
      fc_runtime::from_json<odd_line::Here>(R"({"there":[{"either":{"far":1},"going":"z"}]})");
  check(here && std::get<odd_line::Far>(here->there.at(0).either).far == 1, "the second of two");
  check(here && here->there.at(0).going.wire() == "z", "any text is kept");
  odd_line::DriveRequest asked;
  asked.mood = Going::Mro;
  check(bool(fc_runtime::check_conditions(asked)), "a field is missing that is asked for");
  using Drive = fc_runtime::Command<odd_line::DriveRequest>;
  check(Drive::is_accepted_in(Going::Mro) && !Drive::is_accepted_in(Going::Name), "states");
  check(normally_follows(Going::Name, Going::Mro), "an order");
  check(odd_line::list().at(0).near == 1, "a table called like a type");
  // Names of macros, and the limits of integers.
  const auto ends = fc_runtime::example<odd_line::UnixResponse>();
  check(ends.lowest == std::numeric_limits<std::int64_t>::min(), "the lowest");
  check(ends.highest == std::numeric_limits<std::uint64_t>::max(), "the highest");
  check(odd_line::unix_().at(0).high == odd_line::High::Highest, "a row of both");
  check(odd_line::unix_().at(0).linux_ == "?\?/", "a trigraph");
  odd_line::UnixRequest unset;
  check(!fc_runtime::to_json(unset) && unset.minor_or_default() == 1, "nothing is set");
  unset = fc_runtime::example<odd_line::UnixRequest>();
  check(unset.stdin_ == "what?\?/" && fc_runtime::to_json(unset), "all is set");
}

}  // namespace

int main() {
  check(call_all() > 70, "there are commands");
  facts();
  streams();
  said();
  return failed == 0 ? 0 : 1;
}
