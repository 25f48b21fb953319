// The data port of a robot, on the thread of its server.
#pragma once

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "admission.hpp"
#include "fc_runtime/pace.hpp"
#include "fc_runtime/server.hpp"
#include "link.hpp"

namespace fc_runtime::detail {

/// Takes the outcome of sending a stream.
using StreamSent = std::function<void(Result<std::size_t, PushError>)>;

/// The data connections of a robot.
class DataPort {
  /// An outgoing frame to several connections.
  struct Sending {
    std::size_t open = 0;
    std::size_t taken = 0;
    StreamSent sent;
  };
  struct Waiting {
    std::shared_ptr<const std::string> frame;
    std::shared_ptr<Sending> sending;
    Instant until;
  };

 public:
  /// A data connection.
  struct Peer {
    std::string address;
    std::shared_ptr<Link> link;
    Decoder decoder;
    /// The command connections that were open at the same address in the meantime.
    std::vector<ConnectionId> owners;
    std::deque<std::shared_ptr<const std::string>> queue;
    std::deque<Waiting> waiting;
    bool is_heard = false;
    bool is_draining = false;
    Instant last_read;
    Instant last_written;
    Pace pace = {};
  };

  DataPort(asio::io_context& io, const Protocol& protocol, const RobotSettings& settings,
           ServerCounters& counters);

  /// Called when the port may hold more memory than before.
  std::function<void()> on_held;

  /// Adds a connection of an app. There must be room for it.
  void connect(ConnectionId id, const std::string& address, std::shared_ptr<Link> link,
               const std::vector<ConnectionId>& commands_from_there);
  /// The current connections.
  [[nodiscard]] Crowd<Peer> crowd(std::size_t per_address) const {
    return {peers_, per_address, settings_.limits.connections};
  }
  [[nodiscard]] bool is_empty() const { return peers_.empty(); }
  /// Bytes that the port holds for apps.
  [[nodiscard]] std::size_t held() const;
  /// Returns the connection that holds most, and its bytes.
  [[nodiscard]] std::optional<std::pair<ConnectionId, std::size_t>> largest() const;
  void end(ConnectionId id);
  /// Ends a connection and drops its received frames.
  void evict(ConnectionId id);
  /// Notes a command connection from an address.
  void saw(ConnectionId command, const std::string& address);
  void send(std::optional<ConnectionId> to, std::uint16_t code, std::uint32_t id,
            const std::string& data, StreamSent sent);
  /// Ends all connections after the queued frames are sent.
  void drain();
  void close();

  // For any thread.
  [[nodiscard]] std::optional<AppStream> next(std::chrono::milliseconds wait,
                                              const std::function<void()>& resume);
  // Continues when there is room again. For the thread of the server.
  void resume();

 private:
  void received(ConnectionId id, std::string_view bytes);
  void take_frames(ConnectionId id, Peer& peer);
  /// Sends a frame of a stream.
  void write(Peer& peer, const std::string& frame);
  /// Counts that a connection must rest after useless work.
  void pace(bool must_rest);
  /// Stops reading a connection until the end of its rest. Returns `false` if it need not rest.
  [[nodiscard]] bool rest(Peer& peer);
  void go_on(ConnectionId id);
  [[nodiscard]] std::size_t held_by(ConnectionId id, const Peer& peer) const;
  void settle(const std::shared_ptr<Sending>& sending, bool taken);
  void watch();

  const Protocol* protocol_;
  RobotSettings settings_;
  Encoder encoder_;
  ServerCounters* counters_;
  asio::steady_timer watching_;
  asio::steady_timer pacing_;
  bool is_watching_ = false;
  std::map<ConnectionId, Peer> peers_;

  mutable std::mutex mutex_;
  std::condition_variable came_;
  bool is_wanted_ = false;
  bool is_over_ = false;
  std::deque<AppStream> inbox_;
};

}  // namespace fc_runtime::detail
