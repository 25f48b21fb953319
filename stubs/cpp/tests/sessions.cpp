// Runs the scripts of level `session` against the session.
#include <map>
#include <set>
#include <stdexcept>

#include "fc_runtime/session.hpp"
#include "support/check.hpp"
#include "support/script.hpp"
#include "support/toy.hpp"

namespace {

using fc_runtime::AckPolicy;
using fc_runtime::FrameId;
using fc_runtime::Instant;
using fc_runtime::Meaning;
using fc_runtime::Session;
using fc_runtime::Sum;
using std::chrono::milliseconds;
using tests::Failure;
using tests::json;

const fc_runtime::Protocol& protocol() {
  static const fc_runtime::Protocol toy = tests::toy_protocol();
  return toy;
}

/// Returns the protocol with the id length of the script.
const fc_runtime::Protocol& protocol(const json& given) {
  static const fc_runtime::Protocol of_short_ids = tests::toy_protocol_of_short_ids();
  return given.value("id_bits", 32) == 16 ? of_short_ids : protocol();
}

struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Run {
 public:
  explicit Run(const json& given)
      : limits_(limits(given)),
        ack_(policy(given.value("ack", json::object()), {milliseconds(2000), 3})),
        call_{milliseconds(given.value("call_timeout", 3000)), 0},
        session_(protocol(given), limits_, ack_, given.at("first_id")) {
    const std::size_t most = std::max({limits_.in_flight, limits_.queued_reports, std::size_t{64}});
    if (given.contains("remembers") && given["remembers"] != most) throw Broken("remembers");
  }

  void steps(const json& steps, std::uint32_t round, const std::string& place) {
    int number = 0;
    for (const json& step : steps) {
      const std::string here = place + " " + std::to_string(++number);
      one(step, round, here);
      if (const Failure failure = got_.check(step.value("expect", json::array()))) {
        throw Broken(here + ": " + *failure);
      }
      then(step.value("then", json::object()), here);
    }
  }

 private:
  struct Request {
    std::string name;
    FrameId frame;
    bool open = true;
  };
  struct Arrived {
    FrameId frame;
    std::optional<Sum> digest;
  };

  static fc_runtime::Limits limits(const json& given) {
    fc_runtime::Limits limits = protocol().defaults.limits;
    limits.in_flight = given.value("in_flight", std::size_t{64});
    limits.queued_reports = given.value("queued_reports", std::size_t{16});
    return limits;
  }
  static AckPolicy policy(const json& said, AckPolicy usual) {
    return {milliseconds(said.value("timeout", usual.timeout.count())),
            said.value("retries", usual.retries)};
  }

  void one(const json& step, std::uint32_t round, const std::string& here) {
    if (step.contains("call")) {
      open(step["call"], protocol().command_kind, call_);
    } else if (step.contains("report")) {
      open(step["report"], protocol().report_kind, ack_);
    } else if (step.contains("receive")) {
      receive(step["receive"], round);
    } else if (step.contains("advance")) {
      now_ += milliseconds(step["advance"].get<std::int64_t>());
      due();
    } else if (step.contains("lose")) {
      lose(step["lose"].value("keeps", json::array()));
    } else if (step.contains("reconnect")) {
      session_.reconnected();
    } else if (step.contains("handed_on")) {
      const Arrived& arrived = arrived_.at(step["handed_on"]);
      session_.handed_on(arrived.frame, arrived.digest, now_);
    } else if (step.contains("cancel")) {
      const FrameId frame = requests_[find(step["cancel"])].frame;
      if (const auto token = session_.cancel(frame)) got_.push({{"ended", end(*token, frame)}});
    } else if (step.contains("repeat")) {
      const auto times = step["repeat"].at("times").get<std::uint32_t>();
      for (std::uint32_t at = 0; at < times; ++at) {
        steps(step["repeat"].at("steps"), at, here + ", round " + std::to_string(at + 1));
      }
    } else {
      throw Broken("a session cannot do that: " + step.dump());
    }
  }

  void open(const json& said, std::uint8_t kind, AckPolicy usual) {
    const auto code = said.at("code").get<std::uint16_t>();
    const auto frame = session_.open(kind, code, policy(said, usual), now_, requests_.size());
    if (!frame) {
      got_.push({{"busy", said.at("as")}});
      return;
    }
    if (*frame != FrameId{false, kind, code, frame->id}) throw Broken("another frame");
    if (!ids_.insert(frame->id).second) throw Broken("an id is in flight twice");
    requests_.push_back({said.at("as"), *frame});
    got_.push({{"sends", {{"as", said.at("as")}, {"id", frame->id}}}});
  }

  void receive(const json& said, std::uint32_t round) {
    FrameId frame;
    if (said.contains("answer_to")) {
      frame = requests_[find(said["answer_to"])].frame;
      frame.response = true;
    }
    if (said.contains("kind")) {
      const std::string kind = said["kind"];
      frame.kind = kind == "command"  ? protocol().command_kind
                   : kind == "report" ? protocol().report_kind
                                      : protocol().stream_kind;
    }
    if (said.contains("code")) frame.code = said["code"];
    if (said.contains("id")) frame.id = said["id"].get<std::uint32_t>() + round;
    std::optional<Sum> digest;
    if (said.contains("data")) {
      const std::string data = said["data"];
      digest = digest_of(fc_runtime::DigestAlgorithm::Md5, data);
    }
    if (said.contains("as")) arrived_[said["as"]] = {frame, digest};
    const auto incoming = session_.receive(frame, digest, now_);
    switch (incoming.meaning) {
      case Meaning::Answer:
        got_.push({{"answer", end(incoming.token, frame)}});
        break;
      case Meaning::Late:
        got_.push("late");
        break;
      case Meaning::Command:
        got_.push("command");
        break;
      case Meaning::Report:
        got_.push("report");
        break;
      case Meaning::Repeated:
        got_.push("repeated");
        break;
      case Meaning::Stream:
        got_.push("stream");
        break;
    }
  }

  void due() {
    // No more can be due at once, however far the clock has advanced.
    for (std::size_t most = requests_.size() * 2 + 1; most > 0; --most) {
      const auto due = session_.due(now_);
      if (!due) return;
      if (!due->again) {
        got_.push({{"expired", end(due->token, due->frame)}});
        continue;
      }
      const Request& request = requests_.at(due->token);
      if (request.frame != due->frame || !request.open) throw Broken("sent again as another");
      got_.push({{"again", {{"as", request.name}, {"id", due->frame.id}}}});
    }
    throw Broken("what is due does not come to an end");
  }

  void lose(const json& keeps) {
    std::set<std::size_t> kept;
    for (const json& name : keeps) kept.insert(find(name));
    const auto ended =
        session_.end_if([&](FrameId, fc_runtime::Token token) { return kept.count(token) == 0; });
    for (const auto& [frame, token] : ended) got_.push({{"ended", end(token, frame)}});
  }

  /// Notes the end of a request. Each ends exactly once, with its own frame.
  std::string end(fc_runtime::Token token, FrameId frame) {
    Request& request = requests_.at(token);
    frame.response = false;
    if (request.frame != frame || !request.open) throw Broken(request.name + " has ended wrongly");
    request.open = false;
    ids_.erase(frame.id);
    return request.name;
  }

  void then(const json& then, const std::string& here) const {
    const std::size_t in_flight = session_.in_flight();
    if (in_flight != ids_.size() ||
        (then.contains("in_flight") && then["in_flight"] != in_flight)) {
      throw Broken(here + ": " + std::to_string(in_flight) + " are in flight");
    }
    json due;
    if (const auto at = session_.next_due()) {
      due = std::max<std::int64_t>(std::chrono::duration_cast<milliseconds>(*at - now_).count(), 0);
    }
    if (then.contains("next_due") && then["next_due"] != due) {
      throw Broken(here + ": the next is due in " + due.dump());
    }
    if (then.contains("next_due_by") && (due.is_null() || due > then["next_due_by"])) {
      throw Broken(here + ": the next is due only in " + due.dump());
    }
  }

  /// Returns the last request with this name.
  [[nodiscard]] std::size_t find(const std::string& name) const {
    for (std::size_t at = requests_.size(); at > 0; --at) {
      if (requests_[at - 1].name == name) return at - 1;
    }
    throw Broken("there is no request " + name);
  }

  fc_runtime::Limits limits_;
  AckPolicy ack_;
  AckPolicy call_;
  Session session_;
  Instant now_ = Instant() + std::chrono::hours(1);
  std::vector<Request> requests_;
  /// Ids in flight.
  std::set<std::uint32_t> ids_;
  std::map<std::string, Arrived> arrived_;
  tests::Got got_;
};

Failure run(const json& script) {
  try {
    Run(script.at("given")).steps(script.at("steps"), 0, "step");
  } catch (const std::exception& broken) {
    return broken.what();
  }
  return std::nullopt;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  tests::Tally tally;
  tests::hold(tally, arguments[1], "session", run);
  return tally.outcome("scripts of sessions", 60);
}
