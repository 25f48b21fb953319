// Patterns match as specified in `conformance/patterns.json`, in all languages.
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "fc_runtime/value.hpp"
#include "support/check.hpp"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::ifstream file(arguments[1]);
  const auto table = nlohmann::json::parse(file);
  tests::Tally tally;
  for (const auto& pattern : table) {
    if (pattern.value("refused", false)) continue;
    const std::string portable = pattern.at("portable");
    for (const auto& [key, expected] : {std::pair{"matches", true}, {"refuses", false}}) {
      for (const std::string text : pattern.at(key)) {
        const bool found = fc_runtime::detail::matches(text, portable);
        tally.check(found == expected, portable + " on " + nlohmann::json(text).dump());
        tally.end_case("patterns");
      }
    }
  }
  // Long texts are no problem.
  const std::string text(1'000'000, 'a');
  tally.check(fc_runtime::detail::matches(text, "(?:a|b)*"), "a long text");
  tally.check(!fc_runtime::detail::matches(text, "(?:a+)+b"),
              "a pattern that takes long elsewhere");
  tally.end_case("");
  return tally.outcome("patterns", 100);
}
