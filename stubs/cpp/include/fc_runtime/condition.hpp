// Checks that each conditional field is present exactly if its condition holds. For codec.hpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "fc_runtime/field.hpp"
#include "fc_runtime/message.hpp"
#include "fc_runtime/value.hpp"

namespace fc_runtime {

namespace detail {

template <class T>
void ask_conditions(const T& value, std::optional<ConditionError>& found) {
  if constexpr (IsRequired<T>::value) {
    // A value without fields.
  } else if constexpr (IsOptional<T>::value) {
    if (value.has_value()) ask_conditions(*value, found);
  } else if constexpr (IsList<T>::value) {
    if constexpr (std::is_class_v<typename T::value_type>) {
      for (std::size_t index = 0; index < value.size() && !found; ++index) {
        ask_conditions(value[index], found);
        if (!found) continue;
        const bool dotted = !found->path.empty() && found->path.front() != '[';
        found->path.insert(0, "[" + std::to_string(index) + "]" + (dotted ? "." : ""));
      }
    }
  } else if constexpr (IsChoice<T>::value) {
    std::visit([&found](const auto& variant) { ask_conditions(variant, found); }, value);
  } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> &&
                       !std::is_same_v<T, Json> && !is_enum<T> && !is_id<T>) {
    found = Codec<T>::conditions(value);
  }
}

}  // namespace detail

/// Checks the conditions of the fields of a message, including nested messages.
class Conditions {
 public:
  template <class T>
  void operator()(const Field& field, const T& member) {
    if (found_) return;
    detail::ask_conditions(member, found_);
    if (!found_) return;
    const bool dotted = !found_->path.empty() && found_->path.front() != '[';
    found_->path.insert(0, std::string(field.key()) + (dotted ? "." : ""));
  }

  /// Checks that a field is present exactly if `holds` is true.
  template <class T>
  void asks(std::string_view key, const std::optional<T>& member, bool holds,
            std::string_view condition) {
    if (found_ || member.has_value() == holds) return;
    found_ = ConditionError{std::string(key), holds, std::string(condition)};
  }

  [[nodiscard]] std::optional<ConditionError> found() && { return std::move(found_); }

 private:
  std::optional<ConditionError> found_;
};

}  // namespace fc_runtime
