#include "fc_runtime/envelope.hpp"

#include <chrono>

#include "fc_runtime/codec.hpp"

namespace fc_runtime {

namespace {

/// Reads the value of an envelope key and checks its constraints.
template <class T>
bool read_part(Reader& reader, const EnvelopeKey& key, std::optional<T>& out) {
  reader.peek();
  const std::size_t start = reader.offset();
  if (key.is_optional) {
    if (!detail::read_value(reader, key.field, out)) return false;
  } else if (!detail::read_value(reader, key.field, out.emplace())) {
    return false;
  }
  detail::Breach breach;
  return detail::keeps(key.field, out, breach) || reader.fail(breach.kind, start, breach.detail);
}

/// Reads the additional keys of an object and skips all others.
bool read_beside_alone(Reader& reader, void* /*message*/, Beside* beside) {
  if (!reader.begin_object()) return false;
  while (!reader.end_object()) {
    std::string_view key;
    bool taken = false;
    if (!reader.key(key) || !beside->read(key, reader, taken)) return false;
    if (!taken && (!reader.count(1) || !reader.skip())) return false;
    if (!reader.end_value()) return false;
  }
  return true;
}

}  // namespace

bool EnvelopeReader::read(std::string_view key, Reader& reader, bool& taken) {
  for (std::size_t index = 0; index < keys_->size(); ++index) {
    const EnvelopeKey& known = (*keys_)[index];
    if (!known.field.is_called(key)) continue;
    taken = true;
    const std::string_view name = known.field.name_of(key);
    bool good = reader.count(1);
    if (good && seen_[index]) {
      good = reader.fail_here(BodyErrorKind::DuplicateKey, "the key came before; send it once");
    }
    seen_[index] = true;
    if (good && known.role == EnvelopeRole::Time) {
      good = read_part(reader, known, envelope_.time_ms);
    } else if (good && known.role == EnvelopeRole::ResultCode) {
      good = read_part(reader, known, envelope_.code);
    } else if (good) {
      good = read_part(reader, known, envelope_.text);
    }
    return good || reader.in_key(name);
  }
  return true;
}

std::optional<BodyError> EnvelopeReader::finish() const {
  for (std::size_t index = 0; index < keys_->size(); ++index) {
    const EnvelopeKey& key = (*keys_)[index];
    if (seen_[index] || key.is_optional) continue;
    return BodyError{BodyErrorKind::MissingField, std::string(key.field.key()), 0,
                     "the key is required; send it"};
  }
  return std::nullopt;
}

Result<Envelope, BodyError> read_envelope(const std::vector<EnvelopeKey>& keys,
                                          std::string_view text, const Allowance& allowance) {
  EnvelopeReader beside(keys);
  BodyError error;
  if (!detail::read_object(text, allowance, read_beside_alone, nullptr, &beside, error)) {
    return error;
  }
  if (auto missing = beside.finish()) return *std::move(missing);
  return beside.envelope();
}

bool begin_enveloped(const std::vector<EnvelopeKey>& keys, const Envelope& envelope,
                     Writer& writer) {
  writer.raw('{');
  detail::WriteMembers members(writer, true);
  for (const EnvelopeKey& key : keys) {
    switch (key.role) {
      case EnvelopeRole::Time:
        members(key.field, envelope.time_ms);
        break;
      case EnvelopeRole::ResultCode:
        members(key.field, envelope.code);
        break;
      case EnvelopeRole::ResultText:
        members(key.field, envelope.text);
        break;
    }
  }
  return members.first();
}

std::optional<BodyError> check_enveloped(const TypeInfo& type, const std::vector<EnvelopeKey>& keys,
                                         std::string_view text, const Allowance& allowance) {
  EnvelopeReader beside(keys);
  auto error = type.check(text, allowance, &beside);
  if (!error) return beside.finish();
  auto envelope = read_envelope(keys, text, allowance);
  return envelope ? error : std::move(envelope).error();
}

std::string write_envelope(const std::vector<EnvelopeKey>& keys, const Envelope& envelope) {
  std::string text;
  Writer writer(text);
  static_cast<void>(begin_enveloped(keys, envelope, writer));
  writer.raw('}');
  return text;
}

std::int64_t unix_ms() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
}

namespace detail {

bool write_enveloped(const std::vector<EnvelopeKey>& keys, const Envelope& envelope,
                     const void* message, void (*members)(Writer&, const void*, bool),
                     std::string& out, BodyError& error) {
  Writer writer(out);
  const bool first = begin_enveloped(keys, envelope, writer);
  members(writer, message, first);
  writer.raw('}');
  if (!writer.has_failed()) return true;
  error = writer.take_error();
  return false;
}

}  // namespace detail

}  // namespace fc_runtime
