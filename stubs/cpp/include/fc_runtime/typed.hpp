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

/// What a call comes to.
template <class Response>
using Called = Result<Response, CallError>;

/// What a handler answers with.
template <class Response>
using Replied = Result<Response, Refusal>;

/// A handler's response that cannot be sent: it breaks the spec, or does not fit into a frame. `serve`
/// throws it to the server, which answers the app and tells `ServerConfig::on_handler_error`.
class UnsendableResponse : public std::exception {
 public:
  explicit UnsendableResponse(const BodyError& error) : text_(to_string(error)) {}
  explicit UnsendableResponse(const FrameError& error) : text_(to_string(error)) {}

  /// The name of the error, and where it is. Quotes no value.
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// What a handler knows beside the request.
struct Context {
  /// The connection that the request came over.
  std::uint64_t connection = 0;
  /// Its command code.
  std::uint16_t code = 0;
  /// Its message id.
  std::uint32_t id = 0;
  /// When it was made, in milliseconds since 1970, if it says so.
  std::optional<std::int64_t> time_ms;
  /// Whether nobody waits for the answer any more: look at it where the work takes long.
  std::shared_ptr<const std::atomic<bool>> abandoned;
  /// What reading the request may cost.
  Allowance allowance;
  /// How old a request may be that is still served.
  std::optional<std::chrono::milliseconds> max_age;

  /// Whether nobody waits for the answer any more.
  [[nodiscard]] bool is_abandoned() const { return abandoned && abandoned->load(); }
};

namespace detail {

/// What a response says has gone wrong, if it says so.
[[nodiscard]] std::optional<CallError> refusal_of(const Protocol& protocol,
                                                  const Envelope& envelope);
[[nodiscard]] CallError invalid(CallErrorKind kind, BodyError error);
/// Whether a message is too old to be served, and if so the refusal.
[[nodiscard]] std::optional<Refusal> expired(const Protocol& protocol,
                                             std::optional<std::chrono::milliseconds> max_age,
                                             const Envelope& envelope);
[[nodiscard]] Refusal invalid_request(const Protocol& protocol, const BodyError& error);
[[nodiscard]] Envelope envelope_of(const ResultText& result);

}  // namespace detail

/// What a handler of commands without a type answers with: an object that has the keys of its own.
using RawReplied = Result<Json, Refusal>;
/// Handles a command without a type: the context, and its whole text, envelope included, unread.
using RawHandle = std::function<RawReplied(const Context& context, std::string_view text)>;

/// Has a command without a type handled, and writes the response. Throws `UnsendableResponse`.
[[nodiscard]] Result<std::string, Refusal> serve_raw(const Protocol& protocol, Context context,
                                                     std::string_view text,
                                                     const RawHandle& handle);

/// The answer to a command whose handler has failed.
[[nodiscard]] Refusal handler_failed(const Protocol& protocol);
/// A command that the spec does not know.
[[nodiscard]] Refusal unknown_command(const Protocol& protocol);
/// A command of the spec that this robot does not carry out.
[[nodiscard]] Refusal not_implemented(const Protocol& protocol);

/// The body of a request or report made now.
template <class T>
Result<std::string, CallError> write_request(const Protocol& protocol, const T& message) {
  const Envelope envelope{unix_ms(), std::nullopt, std::nullopt};
  auto text = write_enveloped(protocol.request_envelope, envelope, message);
  if (!text) return detail::invalid(CallErrorKind::InvalidRequest, std::move(text).error());
  return *std::move(text);
}

/// A response, or why there is none.
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

/// A report as a typed message.
template <class T>
Result<T, BodyError> read_report(const Protocol& protocol, std::string_view text,
                                 const Allowance& allowance) {
  auto read = read_enveloped<T>(protocol.request_envelope, text, allowance);
  if (!read) return std::move(read).error();
  return std::move(read->body);
}

/// Which of the errors that a command declares a call has failed with; none for any other.
template <class Request>
std::optional<typename Command<Request>::Error> declared(const CallError& error) {
  if (!error.refusal) return std::nullopt;
  for (const auto known : Command<Request>::errors) {
    if (static_cast<std::int64_t>(known) == error.refusal->code) return known;
  }
  return std::nullopt;
}

/// Reads a request, has it handled, and writes the response. `handle` takes the context and the
/// request, and gives a `Result` of the response or a `Refusal`. Throws `UnsendableResponse`.
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
