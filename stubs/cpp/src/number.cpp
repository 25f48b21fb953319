// Numbers: exact integers in any notation, and the nearest floats.
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "fc_runtime/reader.hpp"

namespace fc_runtime {

namespace {

/// The kind of a number in any notation, without its sign. Exact, unlike a conversion over a
/// double.
enum class Amount { Integer, TooLarge, Fraction };

Amount amount_of(std::string_view number, std::uint64_t& magnitude) {
  magnitude = 0;
  if (!number.empty() && number.front() == '-') number.remove_prefix(1);
  std::int64_t power = 0;
  if (const auto e = number.find_first_of("eE"); e != std::string_view::npos) {
    std::string_view exponent = number.substr(e + 1);
    number = number.substr(0, e);
    const bool negative = exponent.front() == '-';
    if (exponent.front() == '+' || negative) exponent.remove_prefix(1);
    // Beyond this exponent, only the order of magnitude matters.
    constexpr std::int64_t kFar = 1'000'000'000'000;
    for (const char digit : exponent) {
      power = power >= kFar ? kFar : power * 10 + (digit - '0');
    }
    if (negative) power = -power;
  }
  std::string_view whole = number;
  std::string_view part;
  if (const auto point = number.find('.'); point != std::string_view::npos) {
    whole = number.substr(0, point);
    part = number.substr(point + 1);
  }
  const std::size_t all = whole.size() + part.size();
  const auto digit_at = [&](std::size_t index) {
    return index < whole.size() ? whole[index] : part[index - whole.size()];
  };
  std::size_t significant = all;
  while (significant > 0 && digit_at(significant - 1) == '0') --significant;
  if (significant == 0) return Amount::Integer;
  power += static_cast<std::int64_t>(all - significant) - static_cast<std::int64_t>(part.size());
  if (power < 0) return Amount::Fraction;
  const auto times_ten_plus = [&magnitude](unsigned digit) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    if (magnitude > (kMost - digit) / 10U) return false;
    magnitude = magnitude * 10U + digit;
    return true;
  };
  for (std::size_t index = 0; index < significant; ++index) {
    if (!times_ten_plus(static_cast<unsigned>(digit_at(index) - '0'))) return Amount::TooLarge;
  }
  for (; power > 0; --power) {
    if (!times_ten_plus(0)) return Amount::TooLarge;
  }
  return Amount::Integer;
}

}  // namespace

bool Reader::skip_digits() {
  const std::size_t start = at_;
  while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
  return at_ > start || bad_json("a digit is expected here");
}

bool Reader::skip_number() {
  if (at_ < text_.size() && text_[at_] == '-') ++at_;
  const std::size_t start = at_;
  if (!skip_digits()) return false;
  if (at_ - start > 1 && text_[start] == '0') {
    at_ = start;
    return bad_json("a number must not start with `0`");
  }
  if (at_ < text_.size() && text_[at_] == '.') {
    ++at_;
    if (!skip_digits()) return false;
  }
  if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
    ++at_;
    if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
    if (!skip_digits()) return false;
  }
  return true;
}

bool Reader::whole_number(bool& negative, std::uint64_t& magnitude, bool& too_large) {
  const char first = peek();
  if (first != '-' && !is_digit(first)) return unexpected("an integer");
  const std::size_t start = at_;
  negative = first == '-';
  // Eighteen digits always fit, and most numbers have no more.
  std::size_t at = at_ + (negative ? 1U : 0U);
  const std::size_t digits = at;
  magnitude = 0;
  while (at < text_.size() && is_digit(text_[at]) && at - digits < 18) {
    magnitude = magnitude * 10U + static_cast<std::uint64_t>(text_[at] - '0');
    ++at;
  }
  const char behind = at < text_.size() ? text_[at] : '\0';
  const bool is_simple = at > digits && !is_digit(behind) && behind != '.' && behind != 'e' &&
                         behind != 'E' && !(text_[digits] == '0' && at - digits > 1);
  too_large = false;
  if (is_simple) {
    at_ = at;
    return true;
  }
  if (!skip_number()) return false;
  switch (amount_of(since(start), magnitude)) {
    case Amount::Fraction:
      return fail(BodyErrorKind::WrongType, start, "send an integer");
    case Amount::TooLarge:
      too_large = true;
      return true;
    case Amount::Integer:
      return true;
  }
  return true;
}

bool Reader::signed_integer(std::int64_t least, std::int64_t most, std::int64_t& out) {
  bool negative = false;
  bool too_large = false;
  std::uint64_t magnitude = 0;
  peek();
  const std::size_t start = at_;
  if (!whole_number(negative, magnitude, too_large)) return false;
  const std::uint64_t lowest = ~static_cast<std::uint64_t>(least) + 1U;
  const std::uint64_t limit = negative ? lowest : static_cast<std::uint64_t>(most);
  if (too_large || magnitude > limit) {
    return fail(BodyErrorKind::OutOfRange, start,
                "the number must be from " + std::to_string(least) + " to " + std::to_string(most));
  }
  out = static_cast<std::int64_t>(negative ? ~magnitude + 1U : magnitude);
  return true;
}

bool Reader::unsigned_integer(std::uint64_t most, std::uint64_t& out) {
  bool negative = false;
  bool too_large = false;
  peek();
  const std::size_t start = at_;
  if (!whole_number(negative, out, too_large)) return false;
  if (too_large || out > most || (negative && out != 0)) {
    return fail(BodyErrorKind::OutOfRange, start,
                "the number must be from 0 to " + std::to_string(most));
  }
  return true;
}

namespace {

/// Reads the nearest float. `from_chars` gives no value for a number outside the range of the type.
template <class Float>
bool nearest(std::string_view number, Float& out) {
  const auto read = std::from_chars(number.data(), number.data() + number.size(), out);
  if (read.ec == std::errc()) return std::isfinite(out);
  if (read.ec != std::errc::result_out_of_range) return false;
  // A number that is too small becomes zero; one that is too large is refused. The order of
  // magnitude tells them apart.
  std::int64_t order = 0;
  bool significant = false;
  std::size_t index = !number.empty() && number.front() == '-' ? 1 : 0;
  bool behind_point = false;
  for (; index < number.size() && number[index] != 'e' && number[index] != 'E'; ++index) {
    if (number[index] == '.') {
      behind_point = true;
      continue;
    }
    significant = significant || number[index] != '0';
    if (significant && !behind_point) ++order;
    if (!significant && behind_point) --order;
  }
  if (index < number.size()) {
    const bool below_one = number[index + 1] == '-';
    std::int64_t exponent = 0;
    for (++index; index < number.size(); ++index) {
      if (is_digit(number[index]) && exponent < 1'000'000'000) {
        exponent = exponent * 10 + (number[index] - '0');
      }
    }
    order += below_one ? -exponent : exponent;
  }
  if (order > 0) return false;
  out = number.front() == '-' ? Float{-0.0F} : Float{0};
  return true;
}

}  // namespace

bool Reader::float64(double& out) {
  const char first = peek();
  if (first != '-' && !is_digit(first)) return unexpected("a number");
  const std::size_t start = at_;
  if (!skip_number()) return false;
  return nearest(since(start), out) ||
         fail(BodyErrorKind::OutOfRange, start, "the number is too large for the field's type");
}

bool Reader::float32(float& out) {
  const char first = peek();
  if (first != '-' && !is_digit(first)) return unexpected("a number");
  const std::size_t start = at_;
  if (!skip_number()) return false;
  return nearest(since(start), out) ||
         fail(BodyErrorKind::OutOfRange, start, "the number is too large for the field's type");
}

}  // namespace fc_runtime
