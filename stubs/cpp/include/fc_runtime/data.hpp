// The connection of an app to the data port: frames of raw bytes in both directions.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fc_runtime/call.hpp"
#include "fc_runtime/client_core.hpp"
#include "fc_runtime/message.hpp"

namespace fc_runtime {

/// A frame of raw bytes.
struct StreamFrame {
  /// The code of the stream.
  std::uint16_t code = 0;
  /// Message id of the request that the bytes belong to.
  std::uint32_t id = 0;
  /// The bytes, decompressed.
  std::string data;
};

/// The kind of a failed receive or send.
enum class DataErrorKind {
  NotConnected,  ///< No connection in time; nothing was sent.
  Closed,        ///< The connection is over.
  Lost,          ///< The connection was lost. Frames in transit may have arrived.
  Frame,         ///< A received frame is broken, or the data does not fit into a frame.
  Invalid,       ///< The content of a frame is not the JSON that the spec defines.
  Timeout,       ///< Nothing came in time.
};

/// The name of a kind, the same in every language.
[[nodiscard]] std::string_view name(DataErrorKind kind) noexcept;

/// The error of a failed receive or send.
struct DataError {
  /// The kind of the error.
  DataErrorKind kind = DataErrorKind::Lost;
  /// The reason of the loss.
  std::optional<Loss> loss;
  /// The error of the frame.
  std::optional<FrameError> frame;
  /// The error of the content, for `Invalid`.
  std::optional<BodyError> body;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const DataError& error);

namespace detail {
class DataImpl;
struct Subscribed;
}  // namespace detail

/// The frames of one stream, from the subscription on. The queue holds a few frames, and drops the
/// oldest when it is full. Keeps the data connection open.
class Subscription {
 public:
  Subscription(std::shared_ptr<detail::DataImpl> impl,
               std::shared_ptr<detail::Subscribed> subscribed);

  /// Returns the next frame. The error `Closed` is final; after any other, the next call continues
  /// with the next frame.
  [[nodiscard]] Result<StreamFrame, DataError> next(std::chrono::milliseconds wait) const;
  /// Number of dropped frames so far.
  [[nodiscard]] std::uint64_t missed() const;

 private:
  std::shared_ptr<detail::DataImpl> impl_;
  std::shared_ptr<detail::Subscribed> subscribed_;
};

/// A frame of a stream, read as a message.
template <class Content>
struct StreamItem {
  /// Message id of the request that the frame belongs to.
  std::uint32_t id = 0;
  /// The content of the frame.
  Content content;
};

/// The frames of one stream, like `Subscription`, each read as a message.
template <class Content>
class ContentSubscription {
 public:
  ContentSubscription(Subscription frames, const Allowance& allowance)
      : frames_(std::move(frames)), allowance_(allowance) {}

  /// Returns the next frame. The error `Closed` is final; after any other, the next call continues
  /// with the next frame.
  [[nodiscard]] Result<StreamItem<Content>, DataError> next(std::chrono::milliseconds wait) const {
    const auto frame = frames_.next(wait);
    if (!frame) return frame.error();
    auto content = from_json<Content>(frame->data, allowance_);
    if (!content) return DataError{DataErrorKind::Invalid, {}, {}, std::move(content).error()};
    return StreamItem<Content>{frame->id, *std::move(content)};
  }
  /// Number of dropped frames so far.
  [[nodiscard]] std::uint64_t missed() const { return frames_.missed(); }

 private:
  Subscription frames_;
  Allowance allowance_;
};

/// A connection to the data port of a robot. It follows the command connection: the client connects
/// it in the background, reconnects it after a loss of either, and closes it with the command
/// connection.
///
/// Only a few frames are queued. While the app does not take them, the client stops reading from
/// the robot. Keeps the command connection open.
class DataConnection {
 public:
  explicit DataConnection(std::shared_ptr<detail::DataImpl> impl);

  /// Waits until the connection is up, at most for the call timeout. A robot sends requested data
  /// to the data connections that are open then. Wait for this one before you send the request.
  [[nodiscard]] Result<Done, DataError> connected() const;
  /// Returns the frames with one code. `next` then skips them. With subscriptions, frames with
  /// other codes are dropped until the first call of `next`.
  [[nodiscard]] Subscription subscribe(std::uint16_t code) const;
  /// Returns the frames with one code, each read as a message.
  template <class Content>
  [[nodiscard]] ContentSubscription<Content> subscribe_json(std::uint16_t code) const {
    return {subscribe(code), allowance()};
  }
  /// Returns the next frame. The error `Closed` is final; after any other, the next call continues
  /// with the next frame.
  [[nodiscard]] Result<StreamFrame, DataError> next(std::chrono::milliseconds wait) const;
  /// Sends a frame, and waits until the socket has accepted it.
  [[nodiscard]] Result<Done, DataError> send(std::uint16_t code, std::uint32_t id,
                                             std::string_view data) const;
  /// Sends a message as the content of a frame.
  template <class Content>
  [[nodiscard]] Result<Done, DataError> send_json(std::uint16_t code, std::uint32_t id,
                                                  const Content& content) const {
    auto text = to_json(content);
    if (!text) return DataError{DataErrorKind::Invalid, {}, {}, std::move(text).error()};
    return send(code, id, *text);
  }

  /// Returns the current state.
  [[nodiscard]] ConnectionState state() const;
  /// Returns an iterator over the states.
  [[nodiscard]] ConnectionStates states() const;
  /// The limits for reading the content of a frame.
  [[nodiscard]] Allowance allowance() const;

 private:
  std::shared_ptr<detail::DataImpl> impl_;
};

}  // namespace fc_runtime
