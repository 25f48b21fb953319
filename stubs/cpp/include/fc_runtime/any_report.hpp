// Reads a report whose code is known only at run time, as the type with this code.
#pragma once

#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "fc_runtime/operation.hpp"
#include "fc_runtime/reports.hpp"
#include "fc_runtime/typed.hpp"

namespace fc_runtime {

namespace detail {

/// Reads a report as `Message` if the codes match. Returns `true` if no other type needs a try.
template <class Message, class Any>
bool read_as(const Protocol& protocol, const RawReport& raw, std::optional<Any>& out) {
  if constexpr (!std::is_same_v<Message, RawReport>) {
    if (raw.code != Report<Message>::code) return false;
    auto report = read_report<Message>(protocol, raw.text, protocol.defaults.limits.json());
    if (report) out.emplace(*std::move(report));
    return true;
  }
  return false;
}

template <class... Each>
std::variant<Each...> any_report(const Protocol& protocol, RawReport raw,
                                 const std::variant<Each...>* /*which*/) {
  std::optional<std::variant<Each...>> typed;
  static_cast<void>((read_as<Each>(protocol, raw, typed) || ...));
  if (typed) return *std::move(typed);
  return std::variant<Each...>(std::move(raw));
}

}  // namespace detail

/// Reads a report as the type of `Any` with its code. Returns the unchanged `RawReport` if no type
/// has this code or the text does not read as that type. `Any` is a `std::variant` over reports and
/// `RawReport`.
template <class Any>
[[nodiscard]] Any any_report(const Protocol& protocol, RawReport raw) {
  return detail::any_report(protocol, std::move(raw), static_cast<const Any*>(nullptr));
}

}  // namespace fc_runtime
