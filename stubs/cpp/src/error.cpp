#include "fc_runtime/error.hpp"

#include <ostream>

namespace fc_runtime {

std::string_view name(BodyErrorKind kind) noexcept {
  switch (kind) {
    case BodyErrorKind::NotUtf8:
      return "not_utf8";
    case BodyErrorKind::BadJson:
      return "bad_json";
    case BodyErrorKind::NotAnObject:
      return "not_an_object";
    case BodyErrorKind::WrongType:
      return "wrong_type";
    case BodyErrorKind::MissingField:
      return "missing_field";
    case BodyErrorKind::DuplicateKey:
      return "duplicate_key";
    case BodyErrorKind::LoneSurrogate:
      return "lone_surrogate";
    case BodyErrorKind::OutOfRange:
      return "out_of_range";
    case BodyErrorKind::BadLength:
      return "bad_length";
    case BodyErrorKind::BadPattern:
      return "bad_pattern";
    case BodyErrorKind::UnknownValue:
      return "unknown_value";
    case BodyErrorKind::NoVariant:
      return "no_variant";
    case BodyErrorKind::TooDeep:
      return "too_deep";
    case BodyErrorKind::TooManyValues:
      return "too_many_values";
    case BodyErrorKind::ListsTooLarge:
      return "lists_too_large";
    case BodyErrorKind::BadBase64:
      return "bad_base64";
  }
  return "";
}

std::string to_string(const BodyError& error) {
  std::string text(error.name());
  if (!error.path.empty()) text += " at `" + error.path + "`";
  if (error.offset > 0) text += " (byte " + std::to_string(error.offset) + ")";
  if (!error.detail.empty()) text += ": " + error.detail;
  return text;
}

std::ostream& operator<<(std::ostream& out, const BodyError& error) {
  return out << to_string(error);
}

std::string_view name(FrameErrorKind kind) noexcept {
  switch (kind) {
    case FrameErrorKind::BadHead:
      return "bad_head";
    case FrameErrorKind::ShortFrame:
      return "short_frame";
    case FrameErrorKind::FrameTooLong:
      return "frame_too_long";
    case FrameErrorKind::Truncated:
      return "truncated";
    case FrameErrorKind::UnknownKind:
      return "unknown_kind";
    case FrameErrorKind::ReservedKind:
      return "reserved_kind";
    case FrameErrorKind::UnknownEncoding:
      return "unknown_encoding";
    case FrameErrorKind::BadDigest:
      return "bad_digest";
    case FrameErrorKind::BadGzip:
      return "bad_gzip";
    case FrameErrorKind::PlainLengthMismatch:
      return "plain_length_mismatch";
    case FrameErrorKind::InflatedTooLong:
      return "inflated_too_long";
    case FrameErrorKind::InflatesTooMuch:
      return "inflates_too_much";
  }
  return "";
}

std::string to_string(const FrameError& error) { return std::string(error.name()); }

std::ostream& operator<<(std::ostream& out, const FrameError& error) {
  return out << to_string(error);
}

}  // namespace fc_runtime
