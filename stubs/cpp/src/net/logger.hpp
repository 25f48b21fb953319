// The log of a client or server, and calls of the program's own functions.
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

/// The type of the exception that is being handled, such as `std::out_of_range`. Its text is not
/// logged, because it may quote what a peer has sent.
[[nodiscard]] std::string thrown_type();

/// Writes lines to a log. Usable from any thread.
class Logger {
 public:
  /// Without a log, errors go to the standard error and nothing else is written.
  Logger(Log log, std::string_view protocol);

  /// Writes a line. One cause writes five lines a minute: a flood must not become a flood in the log.
  void write(LogLevel level, std::string_view cause, const std::string& text);

  /// Calls a function of the program. An exception ends neither the thread nor the connection: it is
  /// logged as one of `what`.
  template <class Function, class... Arguments>
  void call(std::string_view what, const Function& function, Arguments&&... arguments) noexcept {
    try {
      function(std::forward<Arguments>(arguments)...);
    } catch (...) {
      write_thrown(what);
    }
  }
  /// Logs the exception that is being handled as one of `what`.
  void write_thrown(std::string_view what) noexcept;

 private:
  /// The lines of one cause.
  struct Cause {
    std::chrono::steady_clock::time_point since;
    int lines = 0;
    std::uint64_t held = 0;
  };

  /// The number of lines left out before this one; empty if this one is left out too.
  [[nodiscard]] std::optional<std::uint64_t> admit(std::string_view cause);

  Log log_;
  std::string protocol_;
  std::mutex mutex_;
  std::map<std::string, Cause, std::less<>> causes_;
};

/// A command as the log names it: its name in the spec, or its code in hexadecimal.
[[nodiscard]] std::string command_name(const Protocol& protocol, std::uint16_t code);

}  // namespace fc_runtime::detail
