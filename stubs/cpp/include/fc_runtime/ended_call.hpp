// The end of a call, for metrics.
#pragma once

#include <chrono>
#include <functional>
#include <string_view>
#include <utility>

namespace fc_runtime {

/// A call that has ended.
struct EndedCall {
  /// Name of the command; `unknown` for all codes that the spec does not have.
  std::string_view operation;
  /// The result. At the client it is `success`, the name of the `CallError`, or `dropped` if the call
  /// was cancelled. At the robot it is `success`, `protocol`, `timeout`, `invalid`, `expired` or
  /// `refused`.
  std::string_view result;
  /// Time: at the client from the call to its end, at the robot from the request to its response.
  std::chrono::nanoseconds time{};
};

/// Receives the end of each call. Its texts are valid during the call of the hook.
using CallHook = std::function<void(const EndedCall& call)>;

namespace detail {

/// Tells the end of one call. Without a result, the call was dropped.
class CallEnd {
 public:
  explicit CallEnd(std::function<void(std::string_view)> tell) : tell_(std::move(tell)) {}
  CallEnd(const CallEnd&) = delete;
  CallEnd& operator=(const CallEnd&) = delete;
  ~CallEnd() { tell("dropped"); }

  void tell(std::string_view result) {
    if (const auto told = std::exchange(tell_, nullptr)) told(result);
  }

 private:
  std::function<void(std::string_view)> tell_;
};

}  // namespace detail

}  // namespace fc_runtime
