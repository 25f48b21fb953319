// The protocol as data: header, envelope, numbers and operations. Generated code defines it; the
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

/// The role of a field of the header.
enum class HeaderRole {
  Head,         ///< First bytes of a frame.
  Kind,         ///< Kind of the data.
  Code,         ///< Command code.
  Id,           ///< Message id.
  Encoding,     ///< Encoding of the data.
  TotalLength,  ///< Length of the frame, including the header.
  PlainLength,  ///< Length of the data before compression.
  Digest,       ///< Digest of the data as sent.
  Fixed,        ///< Sent with a fixed value, ignored when received.
};

/// A field of the header.
struct HeaderField {
  /// The role of the field.
  HeaderRole role = HeaderRole::Fixed;
  /// The offset of the field, in bytes.
  std::size_t offset = 0;
  /// The size of the field, in bytes.
  std::size_t size = 0;
  /// The value of a fixed field.
  std::uint64_t value = 0;
};

/// The fixed bytes in front of the data of every frame.
struct HeaderLayout {
  /// Length in bytes.
  std::size_t length = 0;
  /// `true` for integers with the most significant byte first.
  bool big_endian = true;
  /// The fields of the header.
  std::vector<HeaderField> fields;
  /// The digest of the data.
  DigestAlgorithm digest = DigestAlgorithm::None;

  /// Returns the field with a role, or null if the header has none.
  [[nodiscard]] const HeaderField* find(HeaderRole role) const noexcept;
  /// Returns the largest message id.
  [[nodiscard]] std::uint32_t id_max() const noexcept;
};

/// The role of a key of an envelope.
enum class EnvelopeRole {
  Time,        ///< Creation time of the message, in milliseconds since 1970.
  ResultCode,  ///< The result code of a response.
  ResultText,  ///< The result text of a response.
};

/// An envelope key, in the same object as the keys of the message.
struct EnvelopeKey {
  /// The role of the key.
  EnvelopeRole role = EnvelopeRole::Time;
  /// The wire format of the value.
  Field field;
  /// `true` if the key may be absent.
  bool is_optional = true;
};

/// A result code and its text.
struct ResultText {
  /// The result code.
  std::int64_t code = 0;
  /// The text for people.
  std::string_view text;
};

/// The results that the runtime itself responds with.
struct Results {
  /// The call succeeded.
  ResultText success;
  /// Unknown command, reserved kind, wrong digest.
  ResultText protocol;
  /// The handler did not finish in time.
  ResultText timeout;
  /// The body cannot be read or breaks a constraint.
  ResultText invalid;
  /// The message is older than the configured age.
  ResultText expired;
};

/// Timeout and retries for the acknowledgement of a report.
struct AckPolicy {
  /// Wait before the report is sent again.
  std::chrono::milliseconds timeout{2000};
  /// Number of times that the report is sent again.
  std::uint32_t retries = 3;
};

/// Limits of everything that grows with the data from a peer.
struct Limits {
  /// Longest frame, including the header, in bytes.
  std::uint32_t frame_bytes = 16U << 20U;
  /// Longest decompressed data, in bytes.
  std::uint32_t inflated_bytes = 64U << 20U;
  /// Largest compression ratio of data above `inflate_free` bytes. Applies to JSON only: a picture
  /// may be blank.
  std::uint32_t inflate_ratio = 256;
  /// Deepest nesting of a JSON body.
  std::size_t json_depth = Allowance{}.depth;
  /// Most keys of objects and items of lists in a JSON body, over all levels.
  std::size_t json_values = Allowance{}.values;
  /// Most memory for the items of lists in a JSON body, in bytes.
  std::size_t json_list_bytes = Allowance{}.list_bytes;
  /// Most calls in flight on one connection.
  std::size_t in_flight = 64;
  /// Most reports that wait for one receiver, or for one connection.
  std::size_t queued_reports = 64;
  /// Most connections to one server, per port.
  std::size_t connections = 64;

  /// The compression ratio is not limited up to this length of the data, in bytes.
  static constexpr std::uint32_t inflate_free = 1U << 20U;

  /// Returns the limits for reading one body.
  [[nodiscard]] Allowance json() const noexcept {
    return {json_depth, json_values, json_list_bytes};
  }
};

/// Default times and limits.
struct Defaults {
  /// Longest wait of a call for its response.
  std::chrono::milliseconds call_timeout{3000};
  /// Longest time of a handler, after which the peer gets a timeout.
  std::chrono::milliseconds handler_timeout{2500};
  /// Greatest age of a message that is still handled. Unset: any age.
  std::optional<std::chrono::milliseconds> max_age;
  /// Acknowledgement of reports.
  AckPolicy ack;
  /// Limits of everything that grows with the data from a peer.
  Limits limits;
};

/// The kind of an operation.
enum class OperationKind {
  Command,  ///< A request and its response.
  Report,   ///< A pushed message and its acknowledgement.
  Stream,   ///< Frames of raw bytes.
};

/// Some values of an enum.
struct AcceptedStates {
  /// The name of the enum in the spec.
  std::string_view type;
  /// The names of its values in code.
  std::vector<std::string_view> values;
};

/// The conditions under which the robot accepts a command.
struct Preconditions {
  /// `true` if it is accepted in any state.
  bool any_state = false;
  /// The states that accept it: each of these enums must have one of these values. Empty if the spec
  /// does not specify them.
  std::vector<AcceptedStates> states;
  /// Names of the commands that come first.
  std::vector<std::string_view> after;
};

/// The kind of a cadence.
enum class CadenceKind {
  OnChange,  ///< At each change of the field.
  Step,      ///< At each step of the field, a number.
  Every,     ///< At regular intervals.
  Within,    ///< Within a time after a command that sets it off.
};

/// The time at which a report is sent.
struct Cadence {
  /// The kind of the cadence.
  CadenceKind kind = CadenceKind::OnChange;
  /// The path of the field, with wire keys from the body on, joined by dots.
  std::string_view field;
  /// The size of a step.
  double step = 0;
  /// The interval, or the longest time after the command.
  std::chrono::milliseconds time{0};
};

/// The untyped facts of an operation, for the runtime and tools.
struct OperationInfo {
  /// Name in the spec.
  std::string_view name;
  /// Command code. Unset while the spec does not assign one.
  std::optional<std::uint16_t> code;
  /// The kind of the operation.
  OperationKind kind = OperationKind::Command;
  /// The effect of a command on the peer.
  Effect effect = Effect::Unknown;
  /// Chinese title.
  std::string_view zh;
  /// English title.
  std::string_view en;
  /// The acknowledgement policy of a report. Unset: the default of the protocol.
  std::optional<AckPolicy> ack;
  /// The conditions of a command, if the spec specifies any.
  std::optional<Preconditions> preconditions;
  /// The time at which a report is sent, if the spec specifies it.
  std::optional<Cadence> cadence;
  /// The request, or the body of a report. Unset for a stream.
  std::optional<TypeInfo> request;
  /// The response, or the acknowledgement of a report.
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
  /// Kinds that the receiver refuses as reserved.
  std::vector<std::uint8_t> reserved_kinds;
  /// Encoding of uncompressed data.
  std::uint8_t plain_encoding = 0;
  /// Encoding of data as one gzip member. Unset: no compression.
  std::optional<std::uint8_t> gzip_encoding;
  /// Quirk: accepts a received plain length of 0 on an uncompressed frame.
  bool zero_plain_length = false;
  /// Envelope keys of requests and reports.
  std::vector<EnvelopeKey> request_envelope;
  /// Envelope keys of responses and acknowledgements.
  std::vector<EnvelopeKey> response_envelope;
  /// The results that the runtime itself responds with.
  Results results;
  /// Default times and limits.
  Defaults defaults;
  /// Every operation.
  std::vector<OperationInfo> operations;

  /// Returns `true` if responses carry a result code. Otherwise every response means success.
  [[nodiscard]] bool has_result() const noexcept;
  /// Returns the operation with a kind and code, or null.
  [[nodiscard]] const OperationInfo* find(OperationKind kind, std::uint16_t code) const noexcept;
};

}  // namespace fc_runtime
