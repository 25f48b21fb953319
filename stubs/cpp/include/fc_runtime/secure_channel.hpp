// The interface of a secure channel, such as TLS, between a connection and its socket.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace fc_runtime {

/// Encrypts and decrypts the bytes of one connection. It does no I/O. Only the thread of the
/// connection uses it. No function may throw.
///
/// `openssl.hpp` implements it with OpenSSL.
class SecureChannel {
 public:
  /// The results of a step.
  struct Output {
    /// Bytes for the socket.
    std::string sealed;
    /// Decrypted bytes for the connection.
    std::string opened;
  };

  virtual ~SecureChannel() = default;

  /// Takes bytes from the socket, and continues the handshake. The first call has no bytes. Returns
  /// the reason if the channel is broken; `output` may have an alert then.
  [[nodiscard]] virtual std::optional<std::string> receive(std::string_view bytes,
                                                           Output& output) = 0;
  /// Encrypts bytes. Called only after the handshake. Returns the reason if the channel is broken.
  [[nodiscard]] virtual std::optional<std::string> send(std::string_view bytes, Output& output) = 0;
  /// Says goodbye to the peer. The last call.
  virtual void finish(Output& output) = 0;
  /// `true` once the handshake is complete.
  [[nodiscard]] virtual bool is_ready() const = 0;
};

/// Creates the channel of a connection to a robot. `host` is that of the settings.
using ClientChannel = std::function<std::unique_ptr<SecureChannel>(const std::string& host)>;

/// Creates the channel of a connection that a robot has accepted.
using ServerChannel = std::function<std::unique_ptr<SecureChannel>()>;

}  // namespace fc_runtime
