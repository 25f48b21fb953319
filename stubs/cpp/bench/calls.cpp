#include "calls.hpp"

#include <array>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "worker.hpp"

namespace bench {

const Peer* const peers[3] = {&raw, &ours, &theirs};

namespace {

struct Round {
  double seconds = 0;
  double rate = 0;
  double p50 = 0;
  double p99 = 0;
  double cpu = 0;
};

/// The server and the caller process of a peer.
class Pair {
 public:
  explicit Pair(const Peer& peer)
      : server_(0, std::string("serve ") + peer.name),
        caller_(1, std::string("call ") + peer.name + ' ' + server_.first()) {}

  /// Runs one round. Returns its time, and the CPU time of both processes.
  Round round(int in_flight, int calls) {
    server_.ask("begin");
    caller_.ask("begin");
    Round round;
    std::istringstream said(caller_.ask(std::to_string(in_flight) + ' ' + std::to_string(calls)));
    said >> round.seconds >> round.p50 >> round.p99;
    const double cpu = std::stod(caller_.ask("end")) + std::stod(server_.ask("end"));
    round.rate = calls / round.seconds;
    round.cpu = cpu / calls;
    return round;
  }

 private:
  Worker server_;
  Worker caller_;
};

struct Measured {
  const Peer* peer;
  std::unique_ptr<Pair> pair;
  int calls = 0;
  std::vector<Round> rounds;

  [[nodiscard]] double middle(double Round::*figure) const {
    std::vector<double> figures;
    for (const Round& round : rounds) figures.push_back(round.*figure);
    return median(std::move(figures));
  }
};

nlohmann::ordered_json scenario(std::vector<Measured>& all, int in_flight, Effort effort) {
  for (auto& one : all) {
    // Warms up, and doubles the calls of a round until it is long enough.
    one.calls = 64 * in_flight;
    while (one.pair->round(in_flight, one.calls).seconds < effort.seconds) one.calls *= 2;
    one.rounds.clear();
  }
  for (int round = 0; round < effort.rounds; ++round) {
    for (auto& one : all) one.rounds.push_back(one.pair->round(in_flight, one.calls));
  }
  auto found = nlohmann::ordered_json::array();
  for (const auto& one : all) {
    nlohmann::ordered_json figures{{"name", one.peer->name},
                                   {"rate", one.middle(&Round::rate)},
                                   {"p50", one.middle(&Round::p50)},
                                   {"p99", one.middle(&Round::p99)},
                                   {"cpu", one.middle(&Round::cpu)}};
    // A window of the baseline is not a call, so its latency means nothing.
    if (one.peer->windows && in_flight > 1) figures["p50"] = figures["p99"] = nullptr;
    found.push_back(std::move(figures));
  }
  return {{"in_flight", in_flight}, {"peers", std::move(found)}};
}

}  // namespace

nlohmann::ordered_json calls(Effort effort) {
  std::vector<Measured> all;
  for (const Peer* peer : peers) all.push_back({peer, std::make_unique<Pair>(*peer), 0, {}});
  auto found = nlohmann::ordered_json::array();
  for (const int in_flight : {1, 64}) found.push_back(scenario(all, in_flight, effort));
  return found;
}

}  // namespace bench
