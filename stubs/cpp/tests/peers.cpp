// Runs the scripts of level `peer` against a whole client and a whole robot. The test plays the
// other end with frames and controls the clock.
#include <cstdint>
#include <map>
#include <stdexcept>

#include "fc_runtime/client_core.hpp"
#include "fc_runtime/robot_core.hpp"
#include "fc_runtime/typed.hpp"
#include "support/check.hpp"
#include "support/script.hpp"
#include "support/toy_messages.hpp"

namespace {

using fc_runtime::ClientCore;
using fc_runtime::FrameId;
using fc_runtime::Instant;
using fc_runtime::Loss;
using fc_runtime::LossKind;
using fc_runtime::RobotCore;
using std::chrono::milliseconds;
using tests::Failure;
using tests::Got;
using tests::json;

const fc_runtime::Protocol& protocol() {
  static const fc_runtime::Protocol toy = tests::toy_with_messages();
  return toy;
}

struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const std::map<std::string, std::int64_t> kResults = {
    {"success", 1001}, {"protocol", 2001}, {"timeout", 2002}, {"invalid", 2003}, {"expired", 2004}};

fc_runtime::Limits limits(const json& given) {
  fc_runtime::Limits limits = protocol().defaults.limits;
  limits.in_flight = given.value("in_flight", std::size_t{64});
  limits.queued_reports = given.value("queued_reports", std::size_t{16});
  return limits;
}

/// The other end of the connection.
class Wire {
 public:
  void connect() { decoder_ = fc_runtime::Decoder(protocol()); }

  /// Sends a request to the peer under test, with its number in the body to recognize it.
  std::size_t request(const json& open) {
    requests_.push_back({open.at("as"), open.at("code"), std::nullopt});
    return requests_.size() - 1;
  }
  [[nodiscard]] const std::string& name_of(std::size_t number) const {
    return requests_.at(number).name;
  }
  [[nodiscard]] std::size_t number_of(const std::string& name) const {
    for (std::size_t at = requests_.size(); at > 0; --at) {
      if (requests_[at - 1].name == name) return at - 1;
    }
    throw Broken("there is no request " + name);
  }

  /// Returns the bytes of an incoming frame.
  std::string frame(const json& said) {
    FrameId frame;
    if (said.contains("answer_to")) {
      frame = requests_[number_of(said["answer_to"])].frame.value();
      frame.response = true;
    }
    if (said.contains("kind")) {
      const std::string kind = said["kind"];
      frame.kind = kind == "command"  ? protocol().command_kind
                   : kind == "report" ? protocol().report_kind
                                      : protocol().stream_kind;
    }
    if (said.contains("code")) frame.code = said["code"];
    if (said.contains("id")) frame.id = said["id"];
    json body = {{"metres", 1}};
    if (frame.code == tests::kEcho) body = {{"text", ""}};
    if (frame.response)
      body = {{"resultCode", kResults.at(said.value("result", "success"))}, {"text", ""}};
    if (said.value("broken", false)) body = {{"text", 1}, {"metres", ""}};
    if (said.contains("data")) body["data"] = said["data"];
    if (said.contains("as")) arrived_.push_back({said["as"], frame, body});
    std::string bytes;
    if (!fc_runtime::Encoder(protocol()).append(bytes, frame, body.dump())) throw Broken("frame");
    return bytes;
  }

  /// Returns the name of the last received frame with this code, id and body.
  [[nodiscard]] std::string arrived(std::uint16_t code, std::uint32_t id,
                                    const json& body = nullptr) const {
    for (std::size_t at = arrived_.size(); at > 0; --at) {
      const auto& one = arrived_[at - 1];
      if (one.frame.code == code && one.frame.id == id && (body.is_null() || body == one.body)) {
        return one.name;
      }
    }
    throw Broken("nothing has arrived with id " + std::to_string(id));
  }

  /// Reads the bytes that the peer under test has sent.
  void sent(const std::string& bytes, Got& got) {
    decoder_.push(bytes);
    for (;;) {
      const auto next = decoder_.next();
      if (!next) throw Broken("what is sent is no frame");
      if (!*next) return;
      got.push(event((*next)->header.frame, json::parse((*next)->data)));
    }
  }

 private:
  struct Request {
    std::string name;
    std::uint16_t code = 0;
    std::optional<FrameId> frame;
  };
  struct Arrived {
    std::string name;
    FrameId frame;
    json body;
  };

  json event(FrameId frame, const json& body) {
    if (frame.response) {
      for (const auto& [name, code] : kResults) {
        if (body.at("resultCode") != code) continue;
        return {{"answers", {{"to", arrived(frame.code, frame.id)}, {"result", name}}}};
      }
      throw Broken("an unknown result");
    }
    const std::size_t number = body.contains("metres")
                                   ? body["metres"].get<std::size_t>()
                                   : std::stoul(body.at("text").get<std::string>());
    Request& request = requests_.at(number);
    const json sent = {{"as", request.name}, {"id", frame.id}};
    if (request.frame && *request.frame == frame) return {{"again", sent}};
    const std::uint8_t kind =
        request.code == tests::kMoved ? protocol().report_kind : protocol().command_kind;
    if (request.frame || frame.code != request.code || frame.kind != kind) {
      throw Broken(request.name + " is sent as another");
    }
    request.frame = frame;
    return {{"sends", sent}};
  }

  fc_runtime::Decoder decoder_{protocol()};
  std::vector<Request> requests_;
  std::vector<Arrived> arrived_;
};

/// A client under test.
class App {
 public:
  explicit App(const json& given, Instant now) : core_(protocol(), settings(given)) {
    connect(now);
    static_cast<void>(core_.life().next(seen_, milliseconds(0)));
    for (int at = given.value("receivers", 1); at > 0; --at) {
      receivers_.push_back(core_.receivers().enter(std::nullopt));
    }
  }

  void act(const json& step, Instant now) {
    if (step.contains("call")) {
      call(step["call"], now);
    } else if (step.contains("cancel")) {
      core_.cancel(calls_.at(wire_.number_of(step["cancel"])));
    } else if (step.contains("receive")) {
      if (core_.received(wire_.frame(step["receive"]), now)) throw Broken("it has hung up");
    } else if (step.contains("lose")) {
      up_ = false;
      core_.lost(core_.ended());
    } else if (step.contains("reconnect")) {
      connect(now);
    } else if (step.contains("take")) {
      if (receivers_.empty()) throw Broken("nobody receives");
      if (const auto report = receivers_.front()->try_next()) {
        got_.push(
            {{"hands_on", wire_.arrived(report->code, report->id, json::parse(report->text))}});
      }
    } else if (step.contains("close")) {
      core_.close({LossKind::Here, {}, {}});
      if (std::exchange(up_, false)) got_.push("closes");
    } else if (!step.contains("advance")) {
      throw Broken("an app cannot do that: " + step.dump());
    }
  }

  Got& look(Instant now) {
    if (core_.advance(now)) throw Broken("it has hung up");
    core_.settle();
    const std::string out = core_.take_out();
    if (up_) wire_.sent(out, got_);
    while (const auto state = core_.life().next(seen_, milliseconds(0))) {
      got_.push(state->status == fc_runtime::ConnectionStatus::Connected    ? "connected"
                : state->status == fc_runtime::ConnectionStatus::Connecting ? "connecting"
                                                                            : "closed");
    }
    return got_;
  }

  [[nodiscard]] std::optional<std::size_t> in_flight() const { return core_.in_flight(); }
  [[nodiscard]] std::optional<Instant> next_due(Instant now) { return core_.next_due(now); }

 private:
  static fc_runtime::ClientSettings settings(const json& given) {
    fc_runtime::ClientSettings settings;
    settings.limits = limits(given);
    settings.call_timeout = milliseconds(given.value("call_timeout", 3000));
    settings.queued_bytes = settings.limits.inflated_bytes;
    settings.first_id = given.at("first_id");
    return settings;
  }

  void connect(Instant /*now*/) {
    up_ = true;
    wire_.connect();
    core_.connected();
  }

  void call(const json& open, Instant now) {
    const std::size_t number = wire_.request(open);
    const std::uint16_t code = open.at("code");
    const bool reads = code == tests::kEcho;
    fc_runtime::CallOptions options;
    options.repeat = open.value("repeat", reads);
    if (open.contains("timeout")) options.timeout = milliseconds(open["timeout"].get<int>());
    const auto body =
        reads ? write_request(protocol(), tests::Echo{std::to_string(number), {}})
              : write_request(protocol(), tests::Go{static_cast<std::int32_t>(number), {}});
    const auto done = [this, number, reads](const fc_runtime::Answer& answer) {
      got_.push({{"ends", {{"as", wire_.name_of(number)}, {"with", outcome(answer, reads)}}}});
    };
    calls_[number] = core_.call(code, *body, options, done, now);
  }

  static std::string outcome(const fc_runtime::Answer& answer, bool reads) {
    if (!answer) return std::string(answer.error().name());
    const auto name = [](const auto& read) {
      return read ? "success" : std::string(read.error().name());
    };
    return reads ? name(fc_runtime::read_response<tests::Echo>(protocol(), *answer, {}))
                 : name(fc_runtime::read_response<tests::Nothing>(protocol(), *answer, {}));
  }

  ClientCore core_;
  Wire wire_;
  Got got_;
  bool up_ = false;
  std::uint64_t seen_ = 0;
  std::map<std::size_t, std::uint64_t> calls_;
  std::vector<std::shared_ptr<fc_runtime::ReportQueue>> receivers_;
};

/// A robot under test.
class Robot {
 public:
  explicit Robot(const json& given, Instant now)
      : core_(protocol(), settings(given),
              [this](fc_runtime::Request request) { begun_.push_back(std::move(request)); }) {
    connect(now);
  }

  void act(const json& step, Instant now) {
    if (step.contains("report")) {
      const std::size_t number = wire_.request(step["report"]);
      const auto body = write_request(protocol(), tests::Go{static_cast<std::int32_t>(number), {}});
      core_.push(
          tests::kMoved, *body, std::nullopt,
          [this, number](const std::vector<fc_runtime::AckOutcome>& ended) {
            const std::string with(ended.empty() ? "nobody" : name(ended.front().kind));
            got_.push({{"ends", {{"as", wire_.name_of(number)}, {"with", with}}}});
          },
          now);
    } else if (step.contains("receive")) {
      core_.received(id_, wire_.frame(step["receive"]), now);
    } else if (step.contains("lose")) {
      core_.closed(std::exchange(id_, 0));
    } else if (step.contains("reconnect")) {
      connect(now);
    } else if (step.contains("finish")) {
      const json& said = step["finish"];
      const std::uint64_t handler = at_work_.at(said.at("handler_of"));
      fc_runtime::Handled handled = fc_runtime::handler_failed(protocol());
      if (!said.contains("fails")) {
        handled = fc_runtime::Refusal(kResults.at(said.at("result")), "so");
        if (said["result"] == "success") handled = std::string(R"({"resultCode":1001,"text":""})");
      }
      core_.finish(handler, handled, now);
    } else if (step.contains("shutdown")) {
      core_.shutdown(milliseconds(step["shutdown"].at("grace").get<int>()), now);
      shutting_ = true;
    } else if (!step.contains("advance")) {
      throw Broken("a robot cannot do that: " + step.dump());
    }
  }

  Got& look(Instant now) {
    core_.advance(now);
    // Handled requests may be responded to, and responses make room for more.
    for (int round = 0; round < 3; ++round) {
      begin(now);
      core_.settle();
      if (id_ == 0) continue;
      const std::string out = core_.take_out(id_);
      core_.set_unwritten(id_, out.size(), now);
      wire_.sent(out, got_);
      core_.set_unwritten(id_, 0, now);
      if (core_.is_done(id_)) {
        got_.push("closes");
        core_.closed(std::exchange(id_, 0));
      }
    }
    if (shutting_ && core_.is_over()) {
      got_.push("over");
      shutting_ = false;
    }
    return got_;
  }

  [[nodiscard]] static std::optional<std::size_t> in_flight() { return std::nullopt; }
  [[nodiscard]] std::optional<Instant> next_due(Instant /*now*/) { return core_.next_due(); }

 private:
  static fc_runtime::RobotSettings settings(const json& given) {
    fc_runtime::RobotSettings settings;
    settings.limits = limits(given);
    settings.handler_timeout = milliseconds(given.value("handler_timeout", 2000));
    settings.queued_bytes = settings.limits.inflated_bytes;
    settings.first_id = given.at("first_id");
    return settings;
  }

  void connect(Instant now) {
    wire_.connect();
    id_ = core_.connect(now).value();
  }

  /// Starts handlers of read requests. They wait until the script ends them.
  void begin(Instant now) {
    std::vector<fc_runtime::Request> begun;
    begun.swap(begun_);
    for (const auto& request : begun) {
      if (request.settled->exchange(true)) continue;
      bool is_read = false;
      const auto handle = [&is_read](const fc_runtime::Context&, const auto&) {
        is_read = true;
        return fc_runtime::Result<tests::Nothing, fc_runtime::Refusal>(fc_runtime::Refusal());
      };
      const auto handled = request.frame.code == tests::kEcho
                               ? fc_runtime::serve<tests::Echo, tests::Nothing>(
                                     protocol(), {}, *request.text.lock(), handle)
                               : fc_runtime::serve<tests::Go, tests::Nothing>(
                                     protocol(), {}, *request.text.lock(), handle);
      if (!is_read) {
        core_.finish(request.handler, handled, now);
        continue;
      }
      const std::string name = wire_.arrived(request.frame.code, request.frame.id);
      at_work_[name] = request.handler;
      got_.push({{"handles", name}});
    }
  }

  RobotCore core_;
  Wire wire_;
  Got got_;
  fc_runtime::ConnectionId id_ = 0;
  std::vector<fc_runtime::Request> begun_;
  std::map<std::string, std::uint64_t> at_work_;
  bool shutting_ = false;
};

template <class Peer>
Failure steps(const json& script) {
  Instant now = Instant() + std::chrono::hours(1);
  Peer peer(script.at("given"), now);
  peer.look(now);
  int number = 0;
  for (const json& step : script.at("steps")) {
    const std::string here = "step " + std::to_string(++number) + ": ";
    try {
      const auto due = peer.next_due(now);
      now += milliseconds(step.value("advance", std::int64_t{0}));
      const bool is_woken = due && *due <= now;
      peer.act(step, now);
      Got& got = peer.look(now);
      // A driver sleeps until something is due.
      if (step.contains("advance") && !got.is_empty() && !is_woken) return here + "nobody woke it";
      if (const Failure failure = got.check(step.value("expect", json::array()))) {
        return here + *failure;
      }
      const json then = step.value("then", json::object());
      if (then.contains("in_flight") && peer.in_flight() != then["in_flight"]) {
        return here + "another number is in flight";
      }
    } catch (const std::exception& broken) {
      return here + broken.what();
    }
  }
  return std::nullopt;
}

Failure run(const json& script) {
  return script.at("given").at("side") == "app" ? steps<App>(script) : steps<Robot>(script);
}

/// A case without a script. An app that was silent for long is not slow when it finally gets a
/// report. It times out if it does not read the report.
void patience(tests::Tally& tally) {
  fc_runtime::RobotSettings settings;
  settings.limits = protocol().defaults.limits;
  settings.queued_bytes = 1000;
  settings.stall_timeout = milliseconds(30'000);
  RobotCore core(protocol(), settings, [](const fc_runtime::Request&) {});
  Instant now = Instant() + std::chrono::hours(1);
  const auto id = core.connect(now).value();
  now += std::chrono::hours(1);
  core.push(tests::kMoved, *write_request(protocol(), tests::Go{1, {}}), std::nullopt, nullptr,
            now);
  core.advance(now);
  tally.check(!core.is_done(id), "a silent app is not slow");
  core.set_unwritten(id, core.take_out(id).size(), now);
  core.advance(now + milliseconds(29'999));
  tally.check(!core.is_done(id), "nor is it yet");
  core.advance(now + milliseconds(30'000));
  tally.check(core.is_done(id) && core.counters().connections_timed_out == 1, "now it is");
}

/// A frame that arrives more slowly than `least_rate` ends its connection, and a faster one does not.
void rates(tests::Tally& tally) {
  std::string frame;
  static_cast<void>(fc_runtime::Encoder(protocol())
                        .append(frame, {false, 1, tests::kEcho, 1}, std::string(100'000, ' ')));
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{2000}}) {
    fc_runtime::RobotSettings settings;
    settings.limits = protocol().defaults.limits;
    settings.stall_timeout = milliseconds(1000);
    settings.least_rate = 1000;
    RobotCore core(protocol(), settings, [](const fc_runtime::Request&) {});
    Instant now = Instant() + std::chrono::hours(1);
    const auto id = core.connect(now).value();
    std::string_view rest = frame;
    core.received(id, rest.substr(0, 100), now);
    rest.remove_prefix(100);
    for (int turn = 0; turn < 4; ++turn) {
      now += milliseconds(900);
      core.received(id, rest.substr(0, bytes), now);
      rest.remove_prefix(bytes);
      core.advance(now);
    }
    tally.check(core.is_done(id) == (bytes == 1), std::to_string(bytes) + " bytes in 0.9 s");
  }
}

/// Useless frames cost a millisecond each after the first 256: the robot does not read for so long.
void pace(tests::Tally& tally) {
  fc_runtime::RobotSettings settings;
  settings.limits = protocol().defaults.limits;
  RobotCore core(protocol(), settings, [](const fc_runtime::Request&) {});
  const Instant now = Instant() + std::chrono::hours(1);
  const auto id = core.connect(now).value();
  std::string unknown;
  static_cast<void>(fc_runtime::Encoder(protocol()).append(unknown, {false, 1, 999, 1}, "{}"));
  const auto flood = [&](int frames, Instant at) {
    for (int frame = 0; frame < frames; ++frame) core.received(id, unknown, at);
  };
  flood(256, now);
  tally.check(core.wants_bytes(id) && core.counters().connections_paced == 0, "256 are free");
  flood(1, now);
  tally.check(!core.wants_bytes(id) && core.counters().connections_paced == 1, "it rests");
  flood(1, now);
  tally.check(core.counters().calls_protocol == 257, "the next frame has to wait");
  tally.check(core.next_due() == now + milliseconds(1), "for a millisecond");
  core.advance(now + milliseconds(1));
  tally.check(core.counters().calls_protocol == 258, "now it is answered");
  flood(1, now + milliseconds(1000));
  tally.check(core.wants_bytes(id) && core.counters().bad_frames == 0, "after a while all is free");
}

/// Each response is counted by its result.
void results(tests::Tally& tally) {
  fc_runtime::RobotSettings settings;
  settings.limits = protocol().defaults.limits;
  settings.limits.in_flight = 2;
  std::vector<std::uint64_t> begun;
  RobotCore core(protocol(), settings, [&](const fc_runtime::Request& request) {
    begun.push_back(request.handler);
    request.settled->store(true);
  });
  const Instant now = Instant() + std::chrono::hours(1);
  const auto id = core.connect(now).value();
  std::string command;
  static_cast<void>(
      fc_runtime::Encoder(protocol()).append(command, {false, 1, tests::kEcho, 1}, "{}"));
  const auto& results = protocol().results;
  const std::vector<fc_runtime::Handled> ends = {
      fc_runtime::Handled(std::string("{}")),  fc_runtime::Refusal(results.invalid),
      fc_runtime::Refusal(results.expired),    fc_runtime::Refusal(7, "no"),
      fc_runtime::not_implemented(protocol()), fc_runtime::Refusal(results.timeout)};
  for (const auto& end : ends) {
    core.received(id, command, now);
    core.finish(begun.back(), end, now);
  }
  core.received(id, command + command + command, now);
  core.advance(now + settings.handler_timeout);
  const auto& counters = core.counters();
  tally.check(counters.calls_succeeded == 1 && counters.calls_refused == 1, "refused by a handler");
  tally.check(counters.calls_invalid == 1 && counters.calls_expired == 1, "invalid and expired");
  tally.check(counters.calls_protocol == 1 && counters.calls_not_implemented == 1,
              "not implemented");
  tally.check(counters.calls_timed_out == 3 && counters.handlers_abandoned == 2, "too slow");
  tally.check(counters.in_flight_reached > 0, "the third waits");
}

/// The robot stops reading from an app that sends requests and does not read responses.
void back_pressure(tests::Tally& tally) {
  fc_runtime::RobotSettings settings;
  settings.limits = protocol().defaults.limits;
  std::vector<std::uint64_t> begun;
  RobotCore core(protocol(), settings,
                 [&](const fc_runtime::Request& request) { begun.push_back(request.handler); });
  const Instant now = Instant() + std::chrono::hours(1);
  const auto id = core.connect(now).value();
  const std::string body = R"({"text":")" + std::string(64U << 10U, 'x') + "\"}";
  fc_runtime::Encoder encoder(protocol());
  std::size_t handled = 0;
  for (std::uint32_t at = 0; at < 1000 && core.wants_bytes(id); ++at) {
    std::string bytes;
    tally.check(bool(encoder.append(bytes, {false, 1, tests::kEcho, at}, body)), "a request");
    core.received(id, bytes, now);
    for (const std::uint64_t handler : std::exchange(begun, {})) {
      core.finish(handler, body, now);
      ++handled;
    }
  }
  tally.check(!core.wants_bytes(id) && handled == 4, "its responses wait");
  tally.check(core.held(id) < std::size_t{512} << 10U, "and no more than those are held");
  static_cast<void>(core.take_out(id));
  core.set_unwritten(id, 0, now);
  tally.check(core.wants_bytes(id) && core.held(id) == 0, "once they are read, it is read again");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  tests::Tally tally;
  tests::hold(tally, arguments[1], "peer", run);
  patience(tally);
  rates(tally);
  pace(tally);
  results(tally);
  back_pressure(tally);
  return tally.outcome("scripts of peers", 50);
}
