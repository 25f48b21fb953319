// The keys that stand beside a message's own in one object.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fc_runtime/message.hpp"
#include "fc_runtime/protocol.hpp"

namespace fc_runtime {

/// What the keys of an envelope say.
struct Envelope {
  /// When the message was made, in milliseconds since 1970-01-01T00:00:00Z.
  std::optional<std::int64_t> time_ms;
  /// The result code of a response.
  std::optional<std::int64_t> code;
  /// The text beside it. Never rely on it.
  std::optional<std::string> text;
};

/// Reads the keys of an envelope on the way through a body.
class EnvelopeReader : public Beside {
 public:
  explicit EnvelopeReader(const std::vector<EnvelopeKey>& keys)
      : keys_(&keys), seen_(keys.size()) {}

  [[nodiscard]] bool read(std::string_view key, Reader& reader, bool& taken) override;
  /// What is missing at the end, or out of its range.
  [[nodiscard]] std::optional<BodyError> finish() const;
  [[nodiscard]] const Envelope& envelope() const { return envelope_; }

 private:
  const std::vector<EnvelopeKey>* keys_;
  std::vector<bool> seen_;
  Envelope envelope_;
};

/// Reads the keys of an envelope, and skips all others.
[[nodiscard]] Result<Envelope, BodyError> read_envelope(const std::vector<EnvelopeKey>& keys,
                                                        std::string_view text,
                                                        const Allowance& allowance);

/// What is wrong with a body of a type, if anything is: with its envelope, or else with its own keys.
[[nodiscard]] std::optional<BodyError> check_enveloped(const TypeInfo& type,
                                                       const std::vector<EnvelopeKey>& keys,
                                                       std::string_view text,
                                                       const Allowance& allowance);

/// Starts an object with the keys of an envelope, and leaves it open. Says whether none came.
[[nodiscard]] bool begin_enveloped(const std::vector<EnvelopeKey>& keys, const Envelope& envelope,
                                   Writer& writer);

/// An object with the keys of an envelope alone.
[[nodiscard]] std::string write_envelope(const std::vector<EnvelopeKey>& keys,
                                         const Envelope& envelope);

/// Milliseconds since 1970-01-01T00:00:00Z.
[[nodiscard]] std::int64_t unix_ms();

namespace detail {

/// Writes an envelope and the members of a message as one object.
[[nodiscard]] bool write_enveloped(const std::vector<EnvelopeKey>& keys, const Envelope& envelope,
                                   const void* message, void (*members)(Writer&, const void*, bool),
                                   std::string& out, BodyError& error);

template <class T>
void write_members_of(Writer& writer, const void* message, bool first) {
  Codec<T>::write_members(writer, *static_cast<const T*>(message), first);
}

}  // namespace detail

/// An envelope, and the message beside it or what is wrong with that: a refusal that carries nothing
/// but an envelope is still understood.
template <class T>
struct Enveloped {
  /// The keys of the envelope.
  Envelope envelope;
  /// The message's own keys.
  Result<T, BodyError> body;
};

/// Reads the keys of an envelope and of a message in any order. Unknown keys go to the message.
template <class T>
Result<Enveloped<T>, BodyError> read_enveloped(const std::vector<EnvelopeKey>& keys,
                                               std::string_view text,
                                               const Allowance& allowance = {}) {
  EnvelopeReader beside(keys);
  T message;
  BodyError error;
  if (detail::read_object(text, allowance, detail::read_into<T>, &message, &beside, error)) {
    if (auto missing = beside.finish()) return *std::move(missing);
    return Enveloped<T>{beside.envelope(), std::move(message)};
  }
  auto envelope = read_envelope(keys, text, allowance);
  if (!envelope) return std::move(envelope).error();
  return Enveloped<T>{*std::move(envelope), std::move(error)};
}

/// Writes the keys of an envelope and of a message as one object, if the message keeps its own
/// constraints.
template <class T>
Result<std::string, BodyError> write_enveloped(const std::vector<EnvelopeKey>& keys,
                                               const Envelope& envelope, const T& message) {
  std::string text;
  BodyError error;
  if (!detail::write_enveloped(keys, envelope, &message, detail::write_members_of<T>, text,
                               error)) {
    return error;
  }
  return text;
}

}  // namespace fc_runtime
