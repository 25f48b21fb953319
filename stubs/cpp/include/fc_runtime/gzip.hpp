// Gzip members. The zlib state is reused from member to member.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace fc_runtime {

/// Compresses into gzip members.
class Deflater {
 public:
  /// `level` from 1 (fast) to 9 (small).
  explicit Deflater(int level);
  Deflater(Deflater&&) noexcept;
  Deflater& operator=(Deflater&&) noexcept;
  ~Deflater();

  /// Replaces `out` by `data` as a gzip member. Returns `false` if that is not shorter than `data`;
  /// the content of `out` is undefined then.
  [[nodiscard]] bool member(std::string_view data, std::string& out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The outcome of a decompression.
enum class Inflated {
  Whole,    ///< One intact member of the announced length.
  Damaged,  ///< Not one intact member.
  Length,   ///< Another length than announced.
};

/// Inflates gzip members.
class Inflater {
 public:
  Inflater();
  Inflater(Inflater&&) noexcept;
  Inflater& operator=(Inflater&&) noexcept;
  ~Inflater();

  /// Replaces `out` by the content of `member`, which must be exactly `plain` bytes long. Memory
  /// grows only with the actual output, up to `plain` bytes.
  [[nodiscard]] Inflated inflate(std::string_view member, std::size_t plain, std::string& out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fc_runtime
