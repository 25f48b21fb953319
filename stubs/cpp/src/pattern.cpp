#include "pattern.hpp"

#include <algorithm>
#include <optional>

namespace fc_runtime::detail {

namespace {

/// Most steps of a program. The generator refuses patterns that need more.
constexpr std::size_t kMostSteps = 100'000;

/// Returns the code points of UTF-8 text.
std::u32string code_points(std::string_view text) {
  std::u32string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length = first < 0x80U ? 1 : first < 0xE0U ? 2 : first < 0xF0U ? 3 : 4;
    char32_t point = length == 1 ? first : first & (0x7FU >> length);
    for (std::size_t index = 1; index < length && at + index < text.size(); ++index) {
      point = point << 6U | (static_cast<unsigned char>(text[at + index]) & 0x3FU);
    }
    out.push_back(point);
    at += length;
  }
  return out;
}

using Steps = std::vector<Pattern::Step>;
using Kind = Pattern::Step::Kind;

Pattern::Step jump(Kind kind, std::size_t first, std::size_t second = 0) {
  return {kind, false, static_cast<std::ptrdiff_t>(first), static_cast<std::ptrdiff_t>(second), {}};
}

void append(Steps& out, const Steps& part) { out.insert(out.end(), part.begin(), part.end()); }

/// Returns the steps of `part?`, or of `part*` if it repeats.
Steps optional(const Steps& part, bool repeats) {
  Steps out{jump(Kind::Split, 1, part.size() + (repeats ? 2 : 1))};
  append(out, part);
  if (repeats) {
    Pattern::Step back = jump(Kind::Jump, 0);
    back.first = -static_cast<std::ptrdiff_t>(part.size() + 1);
    out.push_back(back);
  }
  return out;
}

/// A recursive descent over the source. Jumps are relative, so parts can be copied and moved.
class Parser {
 public:
  explicit Parser(std::string_view source) : source_(code_points(source)) {}

  /// Returns the whole program, or nothing for a source that is not a portable pattern.
  std::optional<Steps> program() {
    Steps steps = alternatives();
    if (!good_ || at_ != source_.size()) return std::nullopt;
    steps.push_back(jump(Kind::End, 0));
    return steps;
  }

 private:
  [[nodiscard]] bool has(char32_t character) const {
    return at_ < source_.size() && source_[at_] == character;
  }

  bool take(char32_t character) {
    if (!has(character)) return false;
    ++at_;
    return true;
  }

  char32_t next() {
    if (at_ < source_.size()) return source_[at_++];
    good_ = false;
    return 0;
  }

  Steps alternatives() {
    Steps out = sequence();
    while (good_ && take('|')) {
      const Steps other = sequence();
      Steps both{jump(Kind::Split, 1, out.size() + 2)};
      append(both, out);
      both.push_back(jump(Kind::Jump, other.size() + 1));
      append(both, other);
      out = std::move(both);
    }
    return out;
  }

  Steps sequence() {
    Steps out;
    while (good_ && at_ < source_.size() && !has('|') && !has(')')) append(out, repeated(item()));
    good_ = good_ && out.size() <= kMostSteps;
    return out;
  }

  Steps item() {
    if (take('(')) {
      good_ = take('?') && take(':');
      Steps out = alternatives();
      good_ = good_ && take(')');
      return out;
    }
    Pattern::Step one;
    if (take('[')) {
      one.is_negated = take('^');
      while (good_ && !take(']')) one.ranges.push_back(range());
    } else {
      const char32_t point = character();
      one.ranges.push_back({point, point});
    }
    return {std::move(one)};
  }

  Pattern::Range range() {
    const char32_t first = character();
    return {first, take('-') ? character() : first};
  }

  /// Reads a character, escaped or not.
  char32_t character() {
    if (!take('\\')) return next();
    switch (const char32_t escaped = next()) {
      case 'n':
        return '\n';
      case 'r':
        return '\r';
      case 't':
        return '\t';
      case 'x': {
        const char32_t high = digit();
        return high << 4U | digit();
      }
      default:
        return escaped;
    }
  }

  char32_t digit() {
    const char32_t found = next();
    if (found >= '0' && found <= '9') return found - '0';
    if (found >= 'A' && found <= 'F') return found - 'A' + 10;
    good_ = false;
    return 0;
  }

  std::size_t number() {
    std::size_t value = 0;
    while (at_ < source_.size() && source_[at_] >= '0' && source_[at_] <= '9') {
      value = std::min(value * 10 + (next() - '0'), kMostSteps);
    }
    return value;
  }

  Steps repeated(const Steps& part) {
    std::size_t least = 0;
    std::optional<std::size_t> most;
    if (take('+')) {
      least = 1;
    } else if (take('?')) {
      most = 1;
    } else if (take('{')) {
      least = number();
      if (!take(',')) {
        most = least;
      } else if (!has('}')) {
        most = number();
      }
      good_ = good_ && take('}');
    } else if (!take('*')) {
      return part;
    }
    good_ = good_ &&
            std::max(least, most.value_or(0)) * std::max<std::size_t>(part.size(), 1) <= kMostSteps;
    Steps out;
    if (!good_) return out;
    for (std::size_t index = 0; index < least; ++index) append(out, part);
    if (!most) append(out, optional(part, true));
    const Steps rest = most ? optional(part, false) : Steps{};
    for (std::size_t index = least; most && index < *most; ++index) append(out, rest);
    return out;
  }

  std::u32string source_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// The steps that the text has reached. Jumps are followed at once.
class Reached {
 public:
  explicit Reached(const Steps& steps) : steps_(&steps), is_in_(steps.size()) {}

  void add(std::size_t index) {
    open_.push_back(index);
    while (!open_.empty()) {
      const std::size_t at = open_.back();
      open_.pop_back();
      if (is_in_[at]) continue;
      is_in_[at] = true;
      all_.push_back(at);
      const Pattern::Step& step = (*steps_)[at];
      if (step.kind == Kind::Split) open_.push_back(to(at, step.second));
      if (step.kind == Kind::Split || step.kind == Kind::Jump) open_.push_back(to(at, step.first));
    }
  }

  void clear() {
    for (const std::size_t at : all_) is_in_[at] = false;
    all_.clear();
  }

  [[nodiscard]] bool has(std::size_t index) const { return is_in_[index]; }
  [[nodiscard]] const std::vector<std::size_t>& all() const { return all_; }

 private:
  static std::size_t to(std::size_t at, std::ptrdiff_t by) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + by);
  }

  const Steps* steps_;
  std::vector<bool> is_in_;
  std::vector<std::size_t> all_;
  std::vector<std::size_t> open_;
};

bool takes(const Pattern::Step& step, char32_t point) {
  if (step.kind != Kind::Class) return false;
  const auto holds = [=](const Pattern::Range& range) {
    return range.first <= point && point <= range.last;
  };
  return std::any_of(step.ranges.begin(), step.ranges.end(), holds) != step.is_negated;
}

}  // namespace

Pattern::Pattern(std::string_view source) {
  if (auto steps = Parser(source).program()) steps_ = *std::move(steps);
}

bool Pattern::matches(std::string_view text) const {
  if (steps_.empty()) return false;
  Reached now(steps_);
  Reached next(steps_);
  now.add(0);
  for (const char32_t point : code_points(text)) {
    next.clear();
    for (const std::size_t at : now.all()) {
      if (takes(steps_[at], point)) next.add(at + 1);
    }
    std::swap(now, next);
    if (now.all().empty()) return false;
  }
  return now.has(steps_.size() - 1);
}

}  // namespace fc_runtime::detail
