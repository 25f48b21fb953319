// The log of clients and servers.
#pragma once

#include <functional>
#include <string_view>

namespace fc_runtime {

/// The severity of a line of the log.
enum class LogLevel {
  Warning,  ///< A peer misbehaves, or a limit has been reached.
  Error,    ///< The program itself has a bug, such as a handler that throws.
};

/// The name of a level, such as `error`.
[[nodiscard]] std::string_view name(LogLevel level) noexcept;

/// Receives each line of a log, from any thread and from several at once. A line has names and
/// numbers, never the contents of a body. Exceptions of this function are ignored.
using Log = std::function<void(LogLevel level, std::string_view line)>;

}  // namespace fc_runtime
