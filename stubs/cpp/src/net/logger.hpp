// The log of a client or server, and calls of user functions.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fc_runtime/log.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/protocol.hpp"

namespace fc_runtime::detail {

/// Returns the type of the current exception, such as `std::out_of_range`. Its text is not logged,
/// because it may quote data from a peer.
[[nodiscard]] std::string thrown_type();

/// Writes lines to a log. Any thread may use it.
class Logger {
 public:
  /// Without a log, errors go to the standard error, and other lines are dropped.
  Logger(Log log, std::string_view protocol);

  /// Writes a line. One cause writes at most five lines a minute, so that it cannot flood the log.
  void write(LogLevel level, std::string_view cause, const std::string& text);

  /// Calls a user function. An exception ends neither the thread nor the connection. It is logged
  /// as thrown by `what`.
  template <class Function, class... Arguments>
  void call(std::string_view what, const Function& function, Arguments&&... arguments) noexcept {
    try {
      function(std::forward<Arguments>(arguments)...);
    } catch (...) {
      write_thrown(what);
    }
  }
  /// Logs the current exception as thrown by `what`.
  void write_thrown(std::string_view what) noexcept;

 private:
  /// The lines of one cause.
  struct Cause {
    std::chrono::steady_clock::time_point since;
    int lines = 0;
    std::uint64_t held = 0;
  };

  /// Returns the number of lines skipped before this one, or nothing if this one is skipped too.
  [[nodiscard]] std::optional<std::uint64_t> admit(std::string_view cause);

  Log log_;
  std::string protocol_;
  std::mutex mutex_;
  std::map<std::string, Cause, std::less<>> causes_;
};

/// Returns the name of a command in the spec, or its code in hexadecimal.
[[nodiscard]] std::string command_name(const Protocol& protocol, std::uint16_t code);

}  // namespace fc_runtime::detail
