// Scripts of `conformance/sessions` as data, and the comparison with their expectations.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "support/check.hpp"

namespace tests {

using nlohmann::json;

/// The description of a failure, if any.
using Failure = std::optional<std::string>;

/// The events of a peer in a step, in the format of the scripts.
class Got {
 public:
  void push(json event) { events_.push_back(std::move(event)); }

  [[nodiscard]] bool is_empty() const { return events_.empty(); }

  /// Compares with the expected events, in any order. Ids are compared only if expected.
  [[nodiscard]] Failure check(const json& expected) {
    std::vector<json> left;
    left.swap(events_);
    json missing = json::array();
    for (const json& event : expected) {
      std::size_t at = 0;
      while (at < left.size() && !is(left[at], event)) ++at;
      if (at < left.size()) {
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
      } else {
        missing.push_back(event);
      }
    }
    if (missing.empty() && left.empty()) return std::nullopt;
    return "expected and not got: " + missing.dump() +
           "; got and not expected: " + json(left).dump();
  }

 private:
  static bool is(json got, const json& expected) {
    for (const char* sent : {"sends", "again"}) {
      if (got.is_object() && got.contains(sent) && expected.is_object() &&
          expected.contains(sent) && !expected[sent].contains("id")) {
        got[sent].erase("id");
      }
    }
    return got == expected;
  }

  std::vector<json> events_;
};

/// Runs every script of a level. `run` returns the failure.
inline void hold(Tally& tally, const char* folder, const std::string& level,
                 const std::function<Failure(const json& script)>& run) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream stream(entry.path());
    const json file = json::parse(stream);
    if (file.at("level") != level) continue;
    for (const json& script : file.at("scripts")) {
      const Failure failure = run(script);
      tally.check(!failure, entry.path().filename().string() + ": " +
                                script.at("name").get<std::string>() + ": " + failure.value_or("") +
                                "\n  " + script.at("demands").get<std::string>());
      tally.end_case(level);
    }
  }
}

}  // namespace tests
