// The frame codec: bytes to frames and back, without I/O.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fc_runtime/digest.hpp"
#include "fc_runtime/error.hpp"
#include "fc_runtime/gzip.hpp"
#include "fc_runtime/protocol.hpp"
#include "fc_runtime/result.hpp"

namespace fc_runtime {

/// The fields of a frame header.
struct Header {
  /// The head, kind, command code and message id.
  FrameId frame;
  /// The encoding of the data, such as gzip.
  std::uint8_t encoding = 0;
  /// Length of the whole frame, header included, in bytes.
  std::uint32_t total_length = 0;
  /// Length of the data before compression, in bytes.
  std::uint32_t plain_length = 0;
  /// Digest of the data as sent.
  Sum digest = {};
};

/// A frame. The decoder owns its data until the next call of `next`.
struct Frame {
  /// The header as received.
  Header header;
  /// The data, decompressed.
  std::string_view data;
};

/// Splits a stream of bytes into frames.
///
/// `push` takes bytes in any split; `next` returns one frame after the other. The decoder refuses
/// invalid input early: a wrong head at its first wrong byte, an impossible length before the data
/// has arrived. Memory grows only with bytes that have arrived.
class Decoder {
 public:
  /// Creates a decoder with the default limits of the protocol. It verifies digests and does not
  /// resync. The protocol must outlive the decoder.
  explicit Decoder(const Protocol& protocol);

  /// Sets the longest frame, the longest decompressed data, and the largest compression ratio.
  void set_limits(const Limits& limits) { limits_ = limits; }
  /// Turns the verification of digests on (the default) or off.
  void set_verify_digest(bool verify) { verify_digest_ = verify; }
  /// Makes the decoder search for the next frame after a wrong head or an impossible length. By
  /// default, such an error is final.
  ///
  /// A search accepts only a frame without any error. It fails after several times the longest
  /// frame.
  void set_resync(bool resync) { resync_ = resync; }

  /// Appends received bytes.
  void push(std::string_view bytes);
  /// Returns the next complete frame, or nothing if it has not arrived yet. A fatal error is
  /// returned by every further call. After any other error, the next call continues with the next
  /// frame.
  [[nodiscard]] Result<std::optional<Frame>, FrameError> next();
  /// Returns the error if the stream must not end here: the fatal error, or `Truncated` inside a
  /// frame.
  [[nodiscard]] std::optional<FrameError> finish() const;
  /// Number of received bytes that were not returned as frames yet.
  [[nodiscard]] std::size_t pending() const noexcept { return received_.size() - start_; }
  /// The announced length of the current frame, in bytes, once it has arrived.
  [[nodiscard]] std::optional<std::uint32_t> expected() const;
  /// Number of bytes skipped by searches so far.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
  /// Memory held for buffers, in bytes.
  [[nodiscard]] std::size_t capacity() const noexcept {
    return received_.capacity() + inflated_.capacity();
  }

 private:
  [[nodiscard]] std::string_view unread() const {
    return std::string_view(received_).substr(start_);
  }
  [[nodiscard]] bool may_open(std::string_view bytes) const;
  [[nodiscard]] Result<std::optional<Header>, FrameError> locate() const;
  [[nodiscard]] std::optional<FrameError> check(const Header& header, std::string_view data);
  [[nodiscard]] bool give_up(const Header& header);
  void search();
  void release();

  const Protocol* protocol_;
  Limits limits_;
  bool verify_digest_ = true;
  bool resync_ = false;
  std::string received_;
  std::size_t start_ = 0;
  std::string inflated_;
  std::optional<Inflater> inflater_;
  /// `true` if bytes were skipped and no frame has been found since.
  bool searching_ = false;
  /// Bytes of frames that this search has tried without success.
  std::uint64_t tried_ = 0;
  std::uint64_t skipped_ = 0;
  std::optional<FrameError> failed_;
};

/// Threshold and level of the compression of sent frames. Level 1 suits lists. Data that does not
/// shrink is sent uncompressed.
struct Gzip {
  /// Least length of data to compress, in bytes.
  std::size_t from_bytes = 1024;
  /// 1 (fast) to 9 (small).
  int level = 1;
};

/// Appends frames to a buffer.
class Encoder {
 public:
  /// Creates an encoder without compression and with the default frame limit of the protocol. The
  /// protocol must outlive the encoder.
  explicit Encoder(const Protocol& protocol);

  /// Sets the compression; unset turns it off.
  void set_gzip(std::optional<Gzip> gzip);
  /// Sets the longest frame to write, including the header, in bytes.
  void set_frame_bytes(std::uint32_t limit) { frame_bytes_ = limit; }

  /// Appends a frame with this data. Leaves `out` unchanged if the frame would be too long.
  [[nodiscard]] Result<Done, FrameError> append(std::string& out, FrameId id,
                                                std::string_view data);

 private:
  const Protocol* protocol_;
  std::uint32_t frame_bytes_;
  std::optional<Gzip> gzip_;
  std::optional<Deflater> deflater_;
  std::string packed_;
};

namespace detail {

/// Reads a header from the start of `bytes`, which must be long enough.
[[nodiscard]] Header read_header(const Protocol& protocol, std::string_view bytes);
/// Returns the total length of the first frame, once that field has arrived.
[[nodiscard]] std::optional<std::uint32_t> peek_total_length(const HeaderLayout& layout,
                                                             std::string_view bytes);
/// Appends a header.
void write_header(const Protocol& protocol, const Header& header, std::string& out);

}  // namespace detail

}  // namespace fc_runtime
