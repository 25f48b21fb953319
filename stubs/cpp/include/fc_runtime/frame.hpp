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

/// What the header of a frame says.
struct Header {
  /// Which message it belongs to.
  FrameId frame;
  /// How the data is packed.
  std::uint8_t encoding = 0;
  /// Length of the whole frame, header included, in bytes.
  std::uint32_t total_length = 0;
  /// Length of the data before compression, in bytes.
  std::uint32_t plain_length = 0;
  /// Digest of the data as sent.
  Sum digest = {};
};

/// A frame whose data lies in its decoder, until the decoder is asked for the next.
struct Frame {
  /// The header as received.
  Header header;
  /// The data, decompressed.
  std::string_view data;
};

/// Cuts a stream of bytes into frames.
///
/// Bytes come in with `push` in any split; `next` gives one frame after the other. What can be
/// refused is refused as soon as it is known: a wrong head with its first wrong byte, an impossible
/// length before the data has come. Memory grows with what has really arrived.
class Decoder {
 public:
  /// A decoder with the protocol's default limits, which verifies digests and does not search for
  /// lost frames. The protocol has to outlive it.
  explicit Decoder(const Protocol& protocol);

  /// Sets the longest frame, the longest data after decompression, and by how much it may grow.
  void set_limits(const Limits& limits) { limits_ = limits; }
  /// Whether to verify digests (the default).
  void set_verify_digest(bool verify) { verify_digest_ = verify; }
  /// Whether to search for the next frame after a wrong head or an impossible length, instead of
  /// failing for good (the default). While searching, only a frame that is right in every respect is
  /// taken for one; a search that has looked at several times the longest frame without success fails.
  void set_resync(bool resync) { resync_ = resync; }

  /// Appends received bytes.
  void push(std::string_view bytes);
  /// The next whole frame; none if it has not arrived yet. After a fatal error every further call
  /// gives it again; otherwise the frame has been skipped and the next call goes on behind it.
  [[nodiscard]] Result<std::optional<Frame>, FrameError> next();
  /// Why the stream may not end here: the fatal error, or that it would end inside a frame.
  [[nodiscard]] std::optional<FrameError> finish() const;
  /// Bytes received and not yet given out as frames.
  [[nodiscard]] std::size_t pending() const noexcept { return received_.size() - start_; }
  /// How long the frame that has begun to arrive claims to be, if that has come already.
  [[nodiscard]] std::optional<std::uint32_t> expected() const;
  /// Bytes passed over in search of a frame since the beginning.
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
  /// Bytes have been skipped, and no frame has been found since.
  bool searching_ = false;
  /// Bytes of frames that were tried in this search without success.
  std::uint64_t tried_ = 0;
  std::uint64_t skipped_ = 0;
  std::optional<FrameError> failed_;
};

/// When and how hard to compress what is sent. Level 1 suits lists; what does not become shorter is
/// sent plain.
struct Gzip {
  /// Least length of the data that is compressed, in bytes.
  std::size_t from_bytes = 1024;
  /// 1 (fast) to 9 (small).
  int level = 1;
};

/// Writes frames behind the end of a buffer.
class Encoder {
 public:
  /// Compresses nothing; frames may be as long as the protocol's default limit. The protocol has to
  /// outlive it.
  explicit Encoder(const Protocol& protocol);

  /// Compresses as `gzip` says, or not at all.
  void set_gzip(std::optional<Gzip> gzip);
  /// Longest frame to be written, header included, in bytes.
  void set_frame_bytes(std::uint32_t limit) { frame_bytes_ = limit; }

  /// Appends a frame with this data. If it is too long, `out` is as before.
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

/// Reads a header from the start of bytes that are long enough.
[[nodiscard]] Header read_header(const Protocol& protocol, std::string_view bytes);
/// The total length of the frame that starts the bytes, as soon as it has arrived.
[[nodiscard]] std::optional<std::uint32_t> peek_total_length(const HeaderLayout& layout,
                                                             std::string_view bytes);
/// Appends a header.
void write_header(const Protocol& protocol, const Header& header, std::string& out);

}  // namespace detail

}  // namespace fc_runtime
