// An app's connection to the data port: frames of raw bytes in both directions.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "fc_runtime/call.hpp"

namespace fc_runtime {

/// A frame of raw bytes.
struct StreamFrame {
  /// What the bytes belong to.
  std::uint16_t code = 0;
  /// Which request they answer or prepare.
  std::uint32_t id = 0;
  /// The bytes, decompressed.
  std::string data;
};

/// How receiving or sending a stream has failed.
enum class DataErrorKind {
  NotConnected,  ///< No connection in time; nothing was sent.
  Closed,        ///< The connection is over.
  Lost,          ///< The connection was lost: what was on its way may have arrived or not.
  Frame,         ///< A frame came broken, or what is to be sent does not fit into one.
  Timeout,       ///< Nothing came in time.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(DataErrorKind kind) noexcept;

/// Why a stream was not received or sent.
struct DataError {
  /// How it has failed.
  DataErrorKind kind = DataErrorKind::Lost;
  /// Why there is no connection.
  std::optional<Loss> loss;
  /// What is wrong with the frame.
  std::optional<FrameError> frame;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const DataError& error);

namespace detail {
class DataImpl;
struct Subscribed;
}  // namespace detail

/// The frames of one stream, from when it was made. A few of them wait; while nobody takes them, the
/// oldest makes way. Keeps the data connection open.
class Subscription {
 public:
  Subscription(std::shared_ptr<detail::DataImpl> impl,
               std::shared_ptr<detail::Subscribed> subscribed);

  /// The next frame. Unless the error is `Closed`, the next call goes on with the next frame.
  [[nodiscard]] Result<StreamFrame, DataError> next(std::chrono::milliseconds wait) const;
  /// How many frames have made way so far.
  [[nodiscard]] std::uint64_t missed() const;

 private:
  std::shared_ptr<detail::DataImpl> impl_;
  std::shared_ptr<detail::Subscribed> subscribed_;
};

/// A connection to a robot's data port. It is made in the background as soon as the command
/// connection is there, made again after a loss and whenever the command connection was, and ends
/// with it. Nothing is queued but a few frames: while the app does not take what has arrived, the
/// robot is not read. Keeps the command connection open.
class DataConnection {
 public:
  explicit DataConnection(std::shared_ptr<detail::DataImpl> impl);

  /// Waits until there is a connection, for no longer than the call timeout. A robot sends what it is
  /// asked for to the data connections that there are: wait for this one before asking.
  [[nodiscard]] Result<Done, DataError> connected() const;
  /// The frames of one code, which then do not come out of `next`. Where there are subscriptions and
  /// `next` has never been asked, frames of other codes are dropped.
  [[nodiscard]] Subscription subscribe(std::uint16_t code) const;
  /// The next frame. Unless the error is `Closed`, the next call goes on with the next frame.
  [[nodiscard]] Result<StreamFrame, DataError> next(std::chrono::milliseconds wait) const;
  /// Sends a frame, and waits until the socket has taken it.
  [[nodiscard]] Result<Done, DataError> send(std::uint16_t code, std::uint32_t id,
                                             std::string_view data) const;

 private:
  std::shared_ptr<detail::DataImpl> impl_;
};

}  // namespace fc_runtime
