// What a generated protocol tells the runtime: its header, envelope, numbers and operations. The
// runtime itself contains no number of a protocol.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fc_runtime/digest.hpp"
#include "fc_runtime/field.hpp"
#include "fc_runtime/json.hpp"
#include "fc_runtime/message.hpp"
#include "fc_runtime/operation.hpp"

namespace fc_runtime {

/// What a field of the header is for.
enum class HeaderRole {
  Head,         ///< Bytes that open a frame.
  Kind,         ///< Kind of the data.
  Code,         ///< Command code.
  Id,           ///< Message id.
  Encoding,     ///< How the data is packed.
  TotalLength,  ///< Length of the frame, header included.
  PlainLength,  ///< Length of the data before compression.
  Digest,       ///< Digest of the data as sent.
  Fixed,        ///< Sent with a fixed value, and not looked at.
};

/// A field of the header.
struct HeaderField {
  /// What it is for.
  HeaderRole role = HeaderRole::Fixed;
  /// Its first byte.
  std::size_t offset = 0;
  /// Its number of bytes.
  std::size_t size = 0;
  /// What a fixed one is sent with.
  std::uint64_t value = 0;
};

/// The fixed bytes in front of the data of every frame.
struct HeaderLayout {
  /// Length in bytes.
  std::size_t length = 0;
  /// Whether integers have their most significant byte first.
  bool big_endian = true;
  /// Its fields.
  std::vector<HeaderField> fields;
  /// How the data is digested.
  DigestAlgorithm digest = DigestAlgorithm::None;

  /// The field with a role; null if the header has none.
  [[nodiscard]] const HeaderField* find(HeaderRole role) const noexcept;
  /// Largest message id.
  [[nodiscard]] std::uint32_t id_max() const noexcept;
};

/// What a key of an envelope holds.
enum class EnvelopeRole {
  Time,        ///< When the message was made, in milliseconds since 1970.
  ResultCode,  ///< The result code of a response.
  ResultText,  ///< The text beside it.
};

/// A key that is next to a message's own.
struct EnvelopeKey {
  /// What it holds.
  EnvelopeRole role = EnvelopeRole::Time;
  /// How it travels.
  Field field;
  /// Whether it may be absent.
  bool is_optional = true;
};

/// A result code and the text sent beside it.
struct ResultText {
  /// Code.
  std::int64_t code = 0;
  /// Text.
  std::string_view text;
};

/// Results that the runtime itself answers with.
struct Results {
  /// The call did what it should.
  ResultText success;
  /// Unknown command, reserved kind, wrong digest.
  ResultText protocol;
  /// No answer from the handler in time.
  ResultText timeout;
  /// A body that does not read or breaks a constraint.
  ResultText invalid;
  /// A message older than the configured age.
  ResultText expired;
};

/// How the acknowledgement of a report is awaited.
struct AckPolicy {
  /// How long to wait before the report is sent again.
  std::chrono::milliseconds timeout{2000};
  /// How often to send it again before giving up.
  std::uint32_t retries = 3;
};

/// Bounds of everything that grows with what a peer sends.
struct Limits {
  /// Longest frame, header included, in bytes.
  std::uint32_t frame_bytes = 16U << 20U;
  /// Longest data after decompression, in bytes.
  std::uint32_t inflated_bytes = 64U << 20U;
  /// Most bytes that one byte of compressed data may become, where more than `inflate_free` come
  /// out. For JSON only: a picture may well be blank.
  std::uint32_t inflate_ratio = 256;
  /// Deepest nesting of a JSON body.
  std::size_t json_depth = Allowance{}.depth;
  /// Most keys of objects and items of lists in a JSON body, those of all levels together.
  std::size_t json_values = Allowance{}.values;
  /// Most memory for the items of lists that are read from a JSON body, in bytes.
  std::size_t json_list_bytes = Allowance{}.list_bytes;
  /// Calls in flight on one connection.
  std::size_t in_flight = 64;
  /// Reports that wait for one receiver, or for one connection.
  std::size_t queued_reports = 64;
  /// Connections at one server, per port.
  std::size_t connections = 64;

  /// Data of so many bytes or fewer may have been compressed by any ratio.
  static constexpr std::uint32_t inflate_free = 1U << 20U;

  /// What reading one body may cost.
  [[nodiscard]] Allowance json() const noexcept {
    return {json_depth, json_values, json_list_bytes};
  }
};

/// Times and limits where the user sets none.
struct Defaults {
  /// How long a call waits for its response.
  std::chrono::milliseconds call_timeout{3000};
  /// How long a handler may take before the peer is told.
  std::chrono::milliseconds handler_timeout{2500};
  /// Oldest message that is still served; none for any age.
  std::optional<std::chrono::milliseconds> max_age;
  /// Acknowledgement of reports.
  AckPolicy ack;
  /// Bounds of everything that grows with what a peer sends.
  Limits limits;
};

/// What an operation is.
enum class OperationKind {
  Command,  ///< A request and its response.
  Report,   ///< A pushed message and its acknowledgement.
  Stream,   ///< Frames of raw bytes.
};

/// All that the runtime and tools need to know of an operation without its types.
struct OperationInfo {
  /// Name in the spec.
  std::string_view name;
  /// Command code; none while the spec has not given one.
  std::optional<std::uint16_t> code;
  /// What it is.
  OperationKind kind = OperationKind::Command;
  /// What a command does to the peer.
  Effect effect = Effect::Unknown;
  /// Chinese title.
  std::string_view zh;
  /// English title.
  std::string_view en;
  /// How a report is acknowledged; none for the protocol's default.
  std::optional<AckPolicy> ack;
  /// After how long another report of the kind comes, where the spec says so.
  std::optional<std::chrono::milliseconds> interval;
  /// Its request, or the body of a report; none for a stream.
  std::optional<TypeInfo> request;
  /// Its response, or the acknowledgement of a report.
  std::optional<TypeInfo> response;
};

/// A protocol: every number that the runtime needs.
struct Protocol {
  /// Short name.
  std::string_view name;
  /// Usual address of the robot.
  std::string_view host;
  /// TCP port of commands and reports.
  std::uint16_t command_port = 0;
  /// TCP port of streams.
  std::uint16_t data_port = 0;
  /// Frame header.
  HeaderLayout header;
  /// First bytes of a request.
  std::string_view request_head;
  /// First bytes of a response.
  std::string_view response_head;
  /// Kind of a frame of raw bytes.
  std::uint8_t stream_kind = 0;
  /// Kind of a command and of its response.
  std::uint8_t command_kind = 0;
  /// Kind of a report and of its acknowledgement.
  std::uint8_t report_kind = 0;
  /// Kinds that are refused by name.
  std::vector<std::uint8_t> reserved_kinds;
  /// Encoding of data sent as it is.
  std::uint8_t plain_encoding = 0;
  /// Encoding of data sent as one gzip member; none if nothing is compressed.
  std::optional<std::uint8_t> gzip_encoding;
  /// Quirk: a received plain length of 0 is accepted on a frame that is not compressed.
  bool zero_plain_length = false;
  /// Keys of requests and reports beside their own.
  std::vector<EnvelopeKey> request_envelope;
  /// Keys of responses and acknowledgements beside their own.
  std::vector<EnvelopeKey> response_envelope;
  /// Results that the runtime itself answers with.
  Results results;
  /// Times and limits where the user sets none.
  Defaults defaults;
  /// Every operation.
  std::vector<OperationInfo> operations;

  /// Whether responses carry a result code. If not, a response says that all went well.
  [[nodiscard]] bool has_result() const noexcept;
  /// The operation with a kind and code; null if there is none.
  [[nodiscard]] const OperationInfo* find(OperationKind kind, std::uint16_t code) const noexcept;
};

}  // namespace fc_runtime
