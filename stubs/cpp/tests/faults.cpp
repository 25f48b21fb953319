// Of several errors in one body, the one in `faults.json` is reported, with its path.
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/check.hpp"
#include "support/transcode.hpp"

namespace {

using nlohmann::json;

const fc_runtime::OperationInfo* operation(const std::string& name) {
  for (const auto& known : fc::protocol().operations) {
    if (known.name == name) return &known;
  }
  return nullptr;
}

void check(tests::Tally& tally, const json& fault) {
  const std::string name = fault.at("name");
  const auto* of = operation(fault.at("operation"));
  tally.check(of != nullptr, name + " is of no operation");
  if (of == nullptr) return;
  const bool is_request = fault.at("message") == "request";
  const std::string text = fault.at("text");
  const auto read = tests::transcode(*of, is_request, text);
  const std::string wanted = fault.at("error");
  const std::string found = read ? *read : std::string(read.error().name());
  tally.check(!read && found == wanted, name + ": wanted " + wanted + ", found " + found);
  if (read || !fault.contains("path")) return;
  const std::string place = fault.at("path");
  const std::string& path = read.error().path;
  tally.check(path == place, name + ": wanted at `" + place + "`, found at `" + path + "`");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::ifstream file(arguments[1]);
  const json faults = json::parse(file).at("faults");
  tests::Tally tally;
  for (const json& fault : faults) {
    check(tally, fault);
    tally.end_case("faults");
  }
  return tally.outcome("faults and their places", 40);
}
