// Writes typed fields as JSON text; for generated code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "fc_runtime/error.hpp"
#include "fc_runtime/json.hpp"

namespace fc_runtime {

/// Returns the shortest decimal that parses to the same number, with a point or an exponent.
/// Otherwise returns `inf` or `nan` with its sign.
[[nodiscard]] std::string float_text(double value);
/// Returns the same for a `float`, which takes fewer digits.
[[nodiscard]] std::string float_text(float value);

/// Appends JSON to a text. Keeps only the first error.
class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) {}

  void raw(char c) { out_.push_back(c); }
  void raw(std::string_view text) { out_.append(text); }
  void string(std::string_view text);
  void boolean(bool value) { raw(value ? std::string_view("true") : std::string_view("false")); }
  template <class Integer>
  void integer(Integer value) {
    if constexpr (std::is_signed_v<Integer>) {
      signed_integer(value);
    } else {
      unsigned_integer(value);
    }
  }
  void float64(double value);
  void float32(float value);
  void base64(std::string_view bytes);
  void json(const Json& value) { raw(value.text()); }
  /// Writes the unknown keys after the known ones. `first` is `true` if there are no known keys.
  void extra(const Extra& extra, bool first);

  void fail(BodyErrorKind kind, std::string_view detail);
  /// Prepends a key or index to the path of the error.
  void in_key(std::string_view key);
  void in_item(std::size_t index);
  [[nodiscard]] bool has_failed() const { return failed_; }
  [[nodiscard]] BodyError take_error() { return std::move(error_); }

 private:
  void signed_integer(std::int64_t value);
  void unsigned_integer(std::uint64_t value);

  std::string& out_;
  bool failed_ = false;
  BodyError error_;
};

}  // namespace fc_runtime
