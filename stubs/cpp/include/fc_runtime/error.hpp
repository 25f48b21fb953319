// What can be wrong with a frame or a body, by the names that all languages share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>

namespace fc_runtime {

/// What is wrong with a body.
enum class BodyErrorKind {
  NotUtf8,        ///< The bytes are not UTF-8.
  BadJson,        ///< The text is not JSON (RFC 8259).
  NotAnObject,    ///< The body is JSON, but not an object.
  WrongType,      ///< A value of another kind than the field's.
  MissingField,   ///< A required key is missing.
  DuplicateKey,   ///< A known key comes twice in its object.
  LoneSurrogate,  ///< Half of a surrogate pair stands alone in a string or key that is read.
  OutOfRange,     ///< A number outside its range, or an enum value that its field does not take.
  BadLength,      ///< A string, list or run of bytes of a length outside its constraint.
  BadPattern,     ///< A string that does not match its pattern.
  UnknownValue,   ///< A value that a closed enum does not have.
  NoVariant,      ///< An object with the required keys of no variant of a choice.
  TooDeep,        ///< Nested deeper than the limit.
  TooManyValues,  ///< More keys and items than the limit.
  ListsTooLarge,  ///< The items of lists take more memory than the limit.
  BadBase64,      ///< A string that is not base64 (RFC 4648, standard alphabet, padded).
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(BodyErrorKind kind) noexcept;

/// A body that cannot be read, or that breaks its constraints.
struct BodyError {
  /// What is wrong.
  BodyErrorKind kind = BodyErrorKind::BadJson;
  /// Where in the body, such as `data.stations[3].x`; empty for the body itself.
  std::string path;
  /// Bytes of the text before the fault; 0 for a message that was never text.
  std::size_t offset = 0;
  /// What was found and what is wanted.
  std::string detail;

  /// The kind's name.
  [[nodiscard]] std::string_view name() const noexcept { return fc_runtime::name(kind); }
};

/// The error as one line.
[[nodiscard]] std::string to_string(const BodyError& error);
std::ostream& operator<<(std::ostream& out, const BodyError& error);

/// What is wrong with a frame.
enum class FrameErrorKind {
  BadHead,              ///< No frame begins here; the connection is of no more use.
  ShortFrame,           ///< The total length is shorter than the header; likewise.
  FrameTooLong,         ///< The total length exceeds the limit; likewise.
  Truncated,            ///< The bytes end inside a frame.
  UnknownKind,          ///< Unknown kind.
  ReservedKind,         ///< Reserved kind, always refused.
  UnknownEncoding,      ///< Unknown encoding.
  BadDigest,            ///< The digest does not match the data.
  BadGzip,              ///< The data is not one complete gzip member.
  PlainLengthMismatch,  ///< The length before compression does not match the data.
  InflatedTooLong,      ///< Exceeds the limit after decompression.
  InflatesTooMuch,      ///< Grows by more than the limit allows when decompressed.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(FrameErrorKind kind) noexcept;

/// What ties a frame to another: an answer has those of its request.
struct FrameId {
  /// Whether it has the head of responses.
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

/// A frame that cannot be read or written.
struct FrameError {
  /// What is wrong.
  FrameErrorKind kind = FrameErrorKind::BadHead;
  /// Which frame, where its header could be trusted.
  FrameId frame;

  /// The kind's name.
  [[nodiscard]] std::string_view name() const noexcept { return fc_runtime::name(kind); }
  /// Whether nothing behind it can be read: where the next frame begins is not known.
  [[nodiscard]] bool is_fatal() const noexcept {
    return kind == FrameErrorKind::BadHead || kind == FrameErrorKind::ShortFrame ||
           kind == FrameErrorKind::FrameTooLong || kind == FrameErrorKind::Truncated;
  }
};

/// The error as one line.
[[nodiscard]] std::string to_string(const FrameError& error);
std::ostream& operator<<(std::ostream& out, const FrameError& error);

}  // namespace fc_runtime
