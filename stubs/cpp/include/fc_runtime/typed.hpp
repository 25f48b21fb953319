// Bodies of calls and reports as typed messages; for generated code.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fc_runtime/call.hpp"
#include "fc_runtime/envelope.hpp"
#include "fc_runtime/operation.hpp"
#include "fc_runtime/protocol.hpp"

namespace fc_runtime {

/// The outcome of a call.
template <class Response>
using Called = Result<Response, CallError>;

/// The outcome of a handler.
template <class Response>
using Replied = Result<Response, Refusal>;

/// A response that cannot be sent: it breaks the spec, or does not fit into a frame. `serve` throws
/// it to the server, which responds to the app and calls `ServerConfig::on_handler_error`.
class UnsendableResponse : public std::exception {
 public:
  explicit UnsendableResponse(const BodyError& error) : text_(to_string(error)) {}
  explicit UnsendableResponse(const FrameError& error) : text_(to_string(error)) {}

  /// The name and path of the error. Quotes no value.
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// The context of a request, for its handler.
struct Context {
  /// The connection of the request.
  std::uint64_t connection = 0;
  /// The command code of the request.
  std::uint16_t code = 0;
  /// The message id of the request.
  std::uint32_t id = 0;
  /// Creation time of the request, in milliseconds since 1970. Unset if the envelope has none.
  std::optional<std::int64_t> time_ms;
  /// Set when the app stops waiting for the response. See `is_abandoned`.
  std::shared_ptr<const std::atomic<bool>> abandoned;
  /// Limits for reading the request.
  Allowance allowance;
  /// Greatest age of a request that is still handled.
  std::optional<std::chrono::milliseconds> max_age;
  /// The IP address of the app.
  std::string address;

  /// Returns `true` once the app has stopped waiting for the response. Check it in long handlers.
  [[nodiscard]] bool is_abandoned() const { return abandoned && abandoned->load(); }
};

namespace detail {

/// Returns the refusal in a response, if any.
[[nodiscard]] std::optional<CallError> refusal_of(const Protocol& protocol,
                                                  const Envelope& envelope);
[[nodiscard]] CallError invalid(CallErrorKind kind, BodyError error);
/// Returns the refusal if a message is too old.
[[nodiscard]] std::optional<Refusal> expired(const Protocol& protocol,
                                             std::optional<std::chrono::milliseconds> max_age,
                                             const Envelope& envelope);
[[nodiscard]] Refusal invalid_request(const Protocol& protocol, const BodyError& error);
[[nodiscard]] Envelope envelope_of(const ResultText& result);

}  // namespace detail

/// The outcome of an untyped handler: an object with the keys of the response alone, or a refusal.
using RawReplied = Result<Json, Refusal>;
/// Handles an untyped command. `text` is the complete, unread text, including the envelope.
using RawHandle = std::function<RawReplied(const Context& context, std::string_view text)>;

/// Handles an untyped command and writes the response. Throws `UnsendableResponse`.
[[nodiscard]] Result<std::string, Refusal> serve_raw(const Protocol& protocol, Context context,
                                                     std::string_view text,
                                                     const RawHandle& handle);

/// The refusal of a command whose handler has failed.
[[nodiscard]] Refusal handler_failed(const Protocol& protocol);
/// The refusal of a command that the spec does not define.
[[nodiscard]] Refusal unknown_command(const Protocol& protocol);
/// The refusal of a command that the spec defines and this robot does not implement.
[[nodiscard]] Refusal not_implemented(const Protocol& protocol);

/// Returns the body of a request or report, with the current time.
template <class T>
Result<std::string, CallError> write_request(const Protocol& protocol, const T& message) {
  const Envelope envelope{unix_ms(), std::nullopt, std::nullopt};
  auto text = write_enveloped(protocol.request_envelope, envelope, message);
  if (!text) return detail::invalid(CallErrorKind::InvalidRequest, std::move(text).error());
  return *std::move(text);
}

/// Reads a response.
template <class T>
Result<T, CallError> read_response(const Protocol& protocol, std::string_view text,
                                   const Allowance& allowance) {
  auto read = read_enveloped<T>(protocol.response_envelope, text, allowance);
  if (!read) return detail::invalid(CallErrorKind::InvalidResponse, std::move(read).error());
  if (auto refused = detail::refusal_of(protocol, read->envelope)) return *std::move(refused);
  if (!read->body) {
    return detail::invalid(CallErrorKind::InvalidResponse, std::move(read->body).error());
  }
  return *std::move(read->body);
}

/// Reads a report.
template <class T>
Result<T, BodyError> read_report(const Protocol& protocol, std::string_view text,
                                 const Allowance& allowance) {
  auto read = read_enveloped<T>(protocol.request_envelope, text, allowance);
  if (!read) return std::move(read).error();
  return std::move(read->body);
}

/// Returns the declared error of a command that a call failed with, or nothing for any other error.
template <class Request>
std::optional<typename Command<Request>::Error> declared(const CallError& error) {
  if (!error.refusal) return std::nullopt;
  for (const auto known : Command<Request>::errors) {
    if (static_cast<std::int64_t>(known) == error.refusal->code) return known;
  }
  return std::nullopt;
}

/// Reads a request, runs its handler, and writes the response. `handle` takes the context and the
/// request, and returns a `Result` of the response or a `Refusal`. Throws `UnsendableResponse`.
template <class Request, class Response, class Handle>
Result<std::string, Refusal> serve(const Protocol& protocol, Context context, std::string_view text,
                                   const Handle& handle) {
  auto read = read_enveloped<Request>(protocol.request_envelope, text, context.allowance);
  if (!read) return detail::invalid_request(protocol, read.error());
  if (auto old = detail::expired(protocol, context.max_age, read->envelope)) return *std::move(old);
  if (!read->body) return detail::invalid_request(protocol, read->body.error());
  context.time_ms = read->envelope.time_ms;
  Result<Response, Refusal> answered = handle(std::as_const(context), std::as_const(*read->body));
  if (!answered) return std::move(answered).error();
  auto written = write_enveloped(protocol.response_envelope,
                                 detail::envelope_of(protocol.results.success), *answered);
  if (!written) throw UnsendableResponse(written.error());
  return *std::move(written);
}

}  // namespace fc_runtime
