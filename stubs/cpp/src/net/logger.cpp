#include "logger.hpp"

#include <cxxabi.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <typeinfo>

#include "clock.hpp"

namespace fc_runtime {

std::string_view name(LogLevel level) noexcept {
  switch (level) {
    case LogLevel::Warning:
      return "warning";
    case LogLevel::Error:
      return "error";
  }
  return "";
}

namespace detail {

namespace {

/// Most lines of one cause within `kWindow`.
constexpr int kLines = 5;
constexpr std::chrono::minutes kWindow{1};

struct Free {
  void operator()(char* text) const { std::free(text); }
};

}  // namespace

std::string thrown_type() {
  const std::type_info* type = abi::__cxa_current_exception_type();
  if (type == nullptr) return "an exception of another language";
  const std::unique_ptr<char, Free> readable(
      abi::__cxa_demangle(type->name(), nullptr, nullptr, nullptr));
  return readable ? readable.get() : type->name();
}

Logger::Logger(Log log, std::string_view protocol) : log_(std::move(log)), protocol_(protocol) {}

std::optional<std::uint64_t> Logger::admit(std::string_view cause) {
  const Instant now = clock_now();
  const std::lock_guard held(mutex_);
  auto found = causes_.find(cause);
  if (found == causes_.end()) found = causes_.emplace(cause, Cause{now, 0, 0}).first;
  Cause& lines = found->second;
  if (now - lines.since >= kWindow) {
    lines.since = now;
    lines.lines = 0;
  }
  if (lines.lines == kLines) {
    ++lines.held;
    return std::nullopt;
  }
  ++lines.lines;
  return std::exchange(lines.held, 0);
}

void Logger::write(LogLevel level, std::string_view cause, const std::string& text) {
  if (!log_ && level != LogLevel::Error) return;
  const auto held = admit(cause);
  if (!held) return;
  std::string line = protocol_ + ": " + text;
  if (*held > 0) line += " (held " + std::to_string(*held) + ")";
  if (!log_) {
    std::fprintf(stderr, "%s\n", line.c_str());
    return;
  }
  try {
    log_(level, line);
  } catch (...) {
    // Errors of the log cannot be logged.
  }
}

void Logger::write_thrown(std::string_view what) noexcept {
  try {
    write(LogLevel::Error, what, std::string(what) + " threw `" + thrown_type() + "`");
  } catch (...) {
    // There is no memory for a line.
  }
}

std::string command_name(const Protocol& protocol, std::uint16_t code) {
  if (const OperationInfo* known = protocol.find(OperationKind::Command, code)) {
    return "`" + std::string(known->name) + "`";
  }
  char text[8];
  std::snprintf(text, sizeof text, "0x%04X", unsigned{code});
  return text;
}

}  // namespace detail

}  // namespace fc_runtime
