#include "fc_runtime/typed.hpp"

#include "fc_runtime/session.hpp"

namespace fc_runtime {

Refusal handler_failed(const Protocol& protocol) {
  const ResultText& result = protocol.results.protocol;
  return {result.code, std::string(result.text) + ": the handler failed"};
}

Refusal unknown_command(const Protocol& protocol) { return Refusal(protocol.results.protocol); }

Result<std::string, Refusal> serve_raw(const Protocol& protocol, Context context,
                                       std::string_view text, const RawHandle& handle) {
  // For an unknown command, even the envelope may be unreadable.
  if (const auto envelope = read_envelope(protocol.request_envelope, text, context.allowance)) {
    if (auto old = detail::expired(protocol, context.max_age, *envelope)) return *std::move(old);
    context.time_ms = envelope->time_ms;
  }
  const RawReplied answered = handle(context, text);
  if (!answered) return answered.error();
  std::string whole =
      write_envelope(protocol.response_envelope, detail::envelope_of(protocol.results.success));
  const std::string& own = answered->text();
  if (own.front() != '{') {
    throw UnsendableResponse(BodyError{BodyErrorKind::NotAnObject, "", 0, "return an object"});
  }
  if (own == "{}") return whole;
  if (whole == "{}") return own;
  whole.back() = ',';
  return whole.append(own, 1, std::string::npos);
}

Refusal not_implemented(const Protocol& protocol) {
  const ResultText& result = protocol.results.protocol;
  Refusal refusal(result.code, std::string(result.text) + ": not implemented");
  refusal.is_not_implemented = true;
  return refusal;
}

namespace detail {

std::optional<CallError> refusal_of(const Protocol& protocol, const Envelope& envelope) {
  if (!envelope.code || *envelope.code == protocol.results.success.code) return std::nullopt;
  CallError error;
  error.kind = CallErrorKind::Refused;
  error.refusal = Refusal(*envelope.code, envelope.text.value_or(""));
  return error;
}

CallError invalid(CallErrorKind kind, BodyError body) {
  CallError error;
  error.kind = kind;
  error.body = std::move(body);
  return error;
}

std::optional<Refusal> expired(const Protocol& protocol,
                               std::optional<std::chrono::milliseconds> max_age,
                               const Envelope& envelope) {
  if (!max_age || !envelope.time_ms) return std::nullopt;
  // The app chooses the time, so no sum may overflow.
  if (*envelope.time_ms >= unix_ms() - bounded(*max_age).count()) return std::nullopt;
  return Refusal(protocol.results.expired);
}

Refusal invalid_request(const Protocol& protocol, const BodyError& error) {
  const ResultText& result = protocol.results.invalid;
  return {result.code, std::string(result.text) + ": " + to_string(error)};
}

Envelope envelope_of(const ResultText& result) {
  return {unix_ms(), result.code, std::string(result.text)};
}

}  // namespace detail

}  // namespace fc_runtime
