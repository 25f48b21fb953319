// Errors of frames and bodies. All languages share their names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>

namespace fc_runtime {

/// The kind of an error in a body.
enum class BodyErrorKind {
  NotUtf8,        ///< The bytes are not UTF-8.
  BadJson,        ///< The text is not JSON (RFC 8259).
  NotAnObject,    ///< The body is JSON, but not an object.
  WrongType,      ///< A value has another JSON type than its field.
  MissingField,   ///< A required key is missing.
  DuplicateKey,   ///< A known key occurs twice in its object.
  LoneSurrogate,  ///< A string or key contains an unpaired surrogate.
  OutOfRange,     ///< A number is out of range, or the field excludes the enum value.
  BadLength,      ///< The length of a string, list or byte array is out of range.
  BadPattern,     ///< A string does not match its pattern.
  UnknownValue,   ///< A closed enum does not have this value.
  NoVariant,      ///< An object has the required keys of no variant of its choice.
  TooDeep,        ///< Nested deeper than the limit.
  TooManyValues,  ///< More keys and items than the limit.
  ListsTooLarge,  ///< The items of lists take more memory than the limit.
  BadBase64,      ///< A string is not base64 (RFC 4648, standard alphabet, padded).
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(BodyErrorKind kind) noexcept;

/// The error of a body that cannot be read, or that breaks its constraints.
struct BodyError {
  /// The kind of the error.
  BodyErrorKind kind = BodyErrorKind::BadJson;
  /// The path to the error, such as `data.stations[3].x`. Empty for the body itself.
  std::string path;
  /// The offset of the error in the text, in bytes. 0 for a message that was never text.
  std::size_t offset = 0;
  /// The value that was found and the one that was expected.
  std::string detail;

  /// The kind's name.
  [[nodiscard]] std::string_view name() const noexcept { return fc_runtime::name(kind); }
};

/// The error as one line.
[[nodiscard]] std::string to_string(const BodyError& error);
std::ostream& operator<<(std::ostream& out, const BodyError& error);

/// The kind of an error in a frame.
enum class FrameErrorKind {
  BadHead,              ///< No frame begins here. The connection is unusable.
  ShortFrame,           ///< The total length is less than the header. The connection is unusable.
  FrameTooLong,         ///< The total length exceeds the limit. The connection is unusable.
  Truncated,            ///< The bytes end inside a frame.
  UnknownKind,          ///< Unknown kind.
  ReservedKind,         ///< Reserved kind, always refused.
  UnknownEncoding,      ///< Unknown encoding.
  BadDigest,            ///< The digest does not match the data.
  BadGzip,              ///< The data is not one complete gzip member.
  PlainLengthMismatch,  ///< The length before compression does not match the data.
  InflatedTooLong,      ///< The decompressed data exceeds the limit.
  InflatesTooMuch,      ///< The compression ratio exceeds the limit.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(FrameErrorKind kind) noexcept;

/// The fields that match a response or acknowledgement with its request or report.
struct FrameId {
  /// `true` for a frame with the head of responses.
  bool response = false;
  /// Kind of the data.
  std::uint8_t kind = 0;
  /// Command code.
  std::uint16_t code = 0;
  /// Message id.
  std::uint32_t id = 0;

  friend bool operator==(const FrameId& left, const FrameId& right) noexcept {
    return left.response == right.response && left.kind == right.kind && left.code == right.code &&
           left.id == right.id;
  }
  friend bool operator!=(const FrameId& left, const FrameId& right) noexcept {
    return !(left == right);
  }
};

/// The error of a frame that cannot be read or written.
struct FrameError {
  /// The kind of the error.
  FrameErrorKind kind = FrameErrorKind::BadHead;
  /// The frame, if its header is trustworthy.
  FrameId frame;

  /// The kind's name.
  [[nodiscard]] std::string_view name() const noexcept { return fc_runtime::name(kind); }
  /// Returns `true` if nothing after the error can be read. The start of the next frame is unknown
  /// then.
  [[nodiscard]] bool is_fatal() const noexcept {
    return kind == FrameErrorKind::BadHead || kind == FrameErrorKind::ShortFrame ||
           kind == FrameErrorKind::FrameTooLong || kind == FrameErrorKind::Truncated;
  }
};

/// The error as one line.
[[nodiscard]] std::string to_string(const FrameError& error);
std::ostream& operator<<(std::ostream& out, const FrameError& error);

}  // namespace fc_runtime
