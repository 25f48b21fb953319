// The log of clients and servers.
#pragma once

#include <functional>
#include <string_view>

namespace fc_runtime {

/// The severity of a log line.
enum class LogLevel {
  Warning,  ///< A peer misbehaves, or a limit has been reached.
  Error,    ///< The program itself has a bug, such as a handler that throws.
};

/// The name of a level, such as `error`.
[[nodiscard]] std::string_view name(LogLevel level) noexcept;

/// Receives each log line, possibly from several threads at once. A line contains names and
/// numbers, but no contents of a body. Exceptions of this function are ignored.
using Log = std::function<void(LogLevel level, std::string_view line)>;

}  // namespace fc_runtime
