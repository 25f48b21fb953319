// The connection of an app to the data port, on the thread of its command connection.
#pragma once

#include <asio/steady_timer.hpp>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "connection.hpp"
#include "dialler.hpp"
#include "fc_runtime/data.hpp"
#include "link.hpp"

namespace fc_runtime::detail {

/// The queue of one subscription. The lock of the connection protects it.
struct Subscribed {
  std::uint16_t code = 0;
  std::deque<Result<StreamFrame, DataError>> inbox;
  std::uint64_t missed = 0;
};

/// The implementation of a data connection.
class DataImpl : public Companion, public std::enable_shared_from_this<DataImpl> {
 public:
  explicit DataImpl(ConnectionImpl& commands);

  // Functions for any thread.
  [[nodiscard]] Result<Done, DataError> wait_for_connection();
  [[nodiscard]] Result<StreamFrame, DataError> next(std::chrono::milliseconds wait);
  [[nodiscard]] Result<Done, DataError> send(std::uint16_t code, std::uint32_t id,
                                             std::string_view data);
  [[nodiscard]] std::shared_ptr<Subscribed> subscribe(std::uint16_t code);
  [[nodiscard]] Result<StreamFrame, DataError> next_of(Subscribed& subscribed,
                                                       std::chrono::milliseconds wait);
  [[nodiscard]] std::uint64_t missed_by(const Subscribed& subscribed);
  [[nodiscard]] const Life& life() const { return life_; }
  [[nodiscard]] Allowance allowance() const { return commands_->limits().json(); }
  void post_close();
  void post_start();

  // Functions for the thread of the command connection.
  void commands_connected() override;
  void commands_closed(const Loss& why) override { close(why); }

 private:
  /// An outgoing frame. The lock protects it.
  struct Sending {
    std::string bytes;
    bool is_begun = false;
    bool is_given_up = false;
    std::optional<Result<Done, DataError>> ended;
  };

  void dial();
  void up(std::shared_ptr<Link> link);
  void down(const Loss& why, bool for_good);
  void close(const Loss& why);
  void received(std::string_view bytes);
  void take_frames();
  void give(std::uint16_t code, const Result<StreamFrame, DataError>& frame);
  static void queue(Subscribed& subscribed, const Result<StreamFrame, DataError>& frame);
  void send_next();
  void watch();
  [[nodiscard]] bool is_over() const;
  [[nodiscard]] DataError none() const;

  ConnectionImpl* commands_;
  Dialler dialler_;
  asio::steady_timer watching_;
  std::shared_ptr<Link> link_;
  std::optional<Decoder> decoder_;
  Instant last_read_;
  Instant last_written_;
  std::size_t unwritten_ = 0;
  bool is_heard_ = false;
  bool is_closed_ = false;

  std::mutex mutex_;
  std::condition_variable changed_;
  Encoder encoder_;
  Life life_;
  std::deque<Result<StreamFrame, DataError>> inbox_;
  std::vector<std::weak_ptr<Subscribed>> subscriptions_;
  /// `true` if a caller takes frames of any code.
  bool is_asked_ = false;
  std::deque<std::shared_ptr<Sending>> sending_;
  /// `true` if something was sent over this connection.
  bool has_sent_ = false;
  /// The loss of sent frames that the sender does not know yet.
  std::optional<Loss> untold_loss_;
};

/// Opens a data connection. Destroying it closes it and releases the command connection.
[[nodiscard]] std::shared_ptr<DataImpl> open_data(ConnectionImpl& commands,
                                                  std::shared_ptr<void> handle);

}  // namespace fc_runtime::detail
