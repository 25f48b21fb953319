// The names of errors equal those in `errors.json`, which all implementations share.
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "fc_runtime/call.hpp"
#include "fc_runtime/error.hpp"
#include "support/check.hpp"

namespace {

using fc_runtime::BodyErrorKind;
using fc_runtime::CallErrorKind;
using fc_runtime::FrameErrorKind;
using Names = std::set<std::string>;

/// Returns the names of the values of an enum, up to `last`.
template <class Kind>
Names names(Kind last) {
  Names names;
  for (int kind = 0; kind <= static_cast<int>(last); ++kind) {
    names.insert(std::string(name(static_cast<Kind>(kind))));
  }
  return names;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::ifstream file(arguments[1]);
  const auto table = nlohmann::json::parse(file);
  tests::Tally tally;
  for (const auto& [where, given] :
       {std::pair<std::string, Names>{"frame", names(FrameErrorKind::InflatesTooMuch)},
        {"body", names(BodyErrorKind::BadBase64)},
        {"call", names(CallErrorKind::Frame)}}) {
    Names listed;
    for (const auto& error : table.at("errors")) {
      if (error.at("where") != where) continue;
      const std::string name = error.at("name");
      listed.insert(name);
      tally.check(given.count(name) == 1, "no error has the name " + name);
      // Other implementations need not have a limit that is specific to this one.
      tally.end_case(error.value("own_limit", false) ? "" : where + "_errors");
    }
    tally.check(given == listed, "the names of errors of a " + where);
  }
  return tally.outcome("names of errors", 30);
}
