// The envelope: keys in the same object as those of the message.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fc_runtime/message.hpp"
#include "fc_runtime/protocol.hpp"

namespace fc_runtime {

/// The values of an envelope.
struct Envelope {
  /// Creation time of the message, in milliseconds since 1970-01-01T00:00:00Z.
  std::optional<std::int64_t> time_ms;
  /// The result code of a response.
  std::optional<std::int64_t> code;
  /// The result text. Never rely on it.
  std::optional<std::string> text;
};

/// Reads the envelope keys while a body is read.
class EnvelopeReader : public Beside {
 public:
  explicit EnvelopeReader(const std::vector<EnvelopeKey>& keys)
      : keys_(&keys), seen_(keys.size()) {}

  [[nodiscard]] bool read(std::string_view key, Reader& reader, bool& taken) override;
  /// Returns the error if a key is missing or its value is out of range.
  [[nodiscard]] std::optional<BodyError> finish() const;
  [[nodiscard]] const Envelope& envelope() const { return envelope_; }

 private:
  const std::vector<EnvelopeKey>* keys_;
  std::vector<bool> seen_;
  Envelope envelope_;
};

/// Reads the envelope keys and skips all others.
[[nodiscard]] Result<Envelope, BodyError> read_envelope(const std::vector<EnvelopeKey>& keys,
                                                        std::string_view text,
                                                        const Allowance& allowance);

/// Checks a body of a type. Returns the error of the envelope, or else of the message.
[[nodiscard]] std::optional<BodyError> check_enveloped(const TypeInfo& type,
                                                       const std::vector<EnvelopeKey>& keys,
                                                       std::string_view text,
                                                       const Allowance& allowance);

/// Opens an object and writes the envelope keys. Returns `true` if there were none.
[[nodiscard]] bool begin_enveloped(const std::vector<EnvelopeKey>& keys, const Envelope& envelope,
                                   Writer& writer);

/// Returns an object with the envelope keys alone.
[[nodiscard]] std::string write_envelope(const std::vector<EnvelopeKey>& keys,
                                         const Envelope& envelope);

/// Returns the current time in milliseconds since 1970-01-01T00:00:00Z.
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

/// An envelope and its message, or the error of the message. A refusal with nothing but an envelope
/// is thus understood.
template <class T>
struct Enveloped {
  /// The values of the envelope.
  Envelope envelope;
  /// The message.
  Result<T, BodyError> body;
};

/// Reads the keys of an envelope and of a message in any order. The message keeps unknown keys.
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

/// Writes an envelope and a message as one object, if the message satisfies its constraints.
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
