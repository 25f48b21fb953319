#include "settings.hpp"

#include <asio/ip/address.hpp>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace fc_runtime::detail {

namespace {

using std::chrono::milliseconds;

/// Largest allowed nesting. Each level takes a part of the stack.
constexpr std::size_t kDeepest = 1024;
/// Longest keepalive time that operating systems accept.
constexpr milliseconds kLongestKeepalive = std::chrono::seconds(32767);

/// Collects the first error in the settings of one type.
class Check {
 public:
  explicit Check(std::string_view of) : of_(of) {}

  void require(bool holds, std::string_view name, const std::string& found,
               const std::string& expected) {
    if (holds || fault_) return;
    fault_ = "`" + std::string(of_) + "::" + std::string(name) + "` is " + found + ", expected " +
             expected;
  }
  void time(std::string_view name, std::optional<milliseconds> value) {
    if (!value) return;
    require(value->count() >= 0, name, shown(*value), "a time from 0");
  }
  void keepalive(std::optional<milliseconds> value) {
    if (!value) return;
    require(value->count() >= 0 && *value <= kLongestKeepalive, "keepalive", shown(*value),
            "a time from 0 to 32767 s");
  }
  template <class Number>
  void least(std::string_view name, Number value, Number least) {
    require(value >= least, name, std::to_string(value), "at least " + std::to_string(least));
  }
  void limits(const std::optional<Limits>& limits) {
    if (!limits) return;
    least("limits.frame_bytes", limits->frame_bytes, std::uint32_t{1});
    least("limits.inflated_bytes", limits->inflated_bytes, std::uint32_t{1});
    least("limits.inflate_ratio", limits->inflate_ratio, std::uint32_t{1});
    least("limits.json_depth", limits->json_depth, std::size_t{1});
    require(limits->json_depth <= kDeepest, "limits.json_depth", std::to_string(limits->json_depth),
            "at most " + std::to_string(kDeepest));
    least("limits.json_values", limits->json_values, std::size_t{1});
    least("limits.in_flight", limits->in_flight, std::size_t{1});
    least("limits.connections", limits->connections, std::size_t{1});
  }
  void gzip(const std::optional<Gzip>& gzip) {
    if (!gzip) return;
    require(gzip->level >= 1 && gzip->level <= 9, "gzip.level", std::to_string(gzip->level),
            "1 to 9");
  }

  [[nodiscard]] std::optional<std::string> fault() && { return std::move(fault_); }

 private:
  static std::string shown(milliseconds value) { return std::to_string(value.count()) + " ms"; }

  std::string_view of_;
  std::optional<std::string> fault_;
};

}  // namespace

std::optional<std::string> fault_of(const ClientConfig& config) {
  Check check("ClientConfig");
  if (const auto& host = config.host) {
    // The system takes an empty host for any address.
    const bool is_blank = host->find_first_not_of(" \t\r\n") == std::string::npos;
    check.require(!is_blank && host->find('\0') == std::string::npos, "host", "\"" + *host + "\"",
                  "a name or address");
  }
  if (config.command_port) check.least("command_port", *config.command_port, std::uint16_t{1});
  if (config.data_port) check.least("data_port", *config.data_port, std::uint16_t{1});
  check.time("connect_timeout", config.connect_timeout);
  check.time("call_timeout", config.call_timeout);
  if (config.reconnect) {
    check.time("reconnect.first", config.reconnect->first);
    check.time("reconnect.longest", config.reconnect->longest);
  }
  check.keepalive(config.keepalive);
  check.time("stall_timeout", config.stall_timeout);
  check.limits(config.limits);
  check.gzip(config.gzip);
  return std::move(check).fault();
}

std::optional<std::string> fault_of(const ServerConfig& config) {
  Check check("ServerConfig");
  std::error_code error;
  static_cast<void>(asio::ip::make_address(config.address, error));
  check.require(!error, "address", "\"" + config.address + "\"", "an IP address");
  check.time("handler_timeout", config.handler_timeout);
  check.least("handler_threads", config.handler_threads, std::size_t{1});
  check.least("abandoned_handlers", config.abandoned_handlers, std::size_t{1});
  check.time("max_age", config.max_age);
  check.limits(config.limits);
  check.least("connections_per_address", config.connections_per_address, std::size_t{1});
  check.gzip(config.gzip);
  check.time("header_timeout", config.header_timeout);
  check.time("stall_timeout", config.stall_timeout);
  check.time("idle_timeout", config.idle_timeout);
  check.keepalive(config.keepalive);
  return std::move(check).fault();
}

}  // namespace fc_runtime::detail
