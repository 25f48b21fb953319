// Regular expressions of the spec in the portable form of the generator: characters, classes,
// groups, `|`, and repetitions. Matching takes one pass and linear time, without recursion.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fc_runtime::detail {

/// A pattern that must match a text as a whole.
class Pattern {
 public:
  /// Characters from `first` to `last`.
  struct Range {
    char32_t first;
    char32_t last;
  };

  /// A step of the matching program.
  struct Step {
    enum class Kind : unsigned char {
      Class,  ///< Takes one character.
      Split,  ///< Goes on at both targets.
      Jump,   ///< Goes on at the first target.
      End,    ///< The whole pattern has matched.
    };

    Kind kind = Kind::Class;
    bool is_negated = false;
    std::ptrdiff_t first = 0;   ///< First target, relative to this step.
    std::ptrdiff_t second = 0;  ///< Second target, relative to this step.
    std::vector<Range> ranges;
  };

  /// Compiles a pattern. One that is not in the portable form matches nothing.
  explicit Pattern(std::string_view source);

  /// Returns `true` if the whole UTF-8 text matches.
  [[nodiscard]] bool matches(std::string_view text) const;

 private:
  std::vector<Step> steps_;
};

}  // namespace fc_runtime::detail
