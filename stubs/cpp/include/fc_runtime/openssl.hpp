// TLS by OpenSSL 3. No other header needs OpenSSL: a program that includes this one links
// `OpenSSL::SSL` itself.
#pragma once

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fc_runtime/secure_channel.hpp"

namespace fc_runtime {

/// A secure channel with a session of OpenSSL, which reads and writes memory.
class OpensslChannel final : public SecureChannel {
 public:
  /// Creates the channel of a client whose peer must have a certificate for `host`, or of a robot.
  /// Throws `std::runtime_error` if OpenSSL fails.
  OpensslChannel(SSL_CTX* context, const std::optional<std::string>& host)
      : session_(SSL_new(context), SSL_free) {
    BIO* received = BIO_new(BIO_s_mem());
    BIO* sealed = BIO_new(BIO_s_mem());
    if (!session_ || received == nullptr || sealed == nullptr) {
      BIO_free(received);
      BIO_free(sealed);
      throw std::runtime_error("OpenSSL cannot create a session");
    }
    // The session owns both.
    SSL_set_bio(session_.get(), received, sealed);
    if (!host) {
      SSL_set_accept_state(session_.get());
      return;
    }
    SSL_set_connect_state(session_.get());
    SSL_set_verify(session_.get(), SSL_VERIFY_PEER, nullptr);
    X509_VERIFY_PARAM* demands = SSL_get0_param(session_.get());
    if (X509_VERIFY_PARAM_set1_ip_asc(demands, host->c_str()) == 1) return;
    ERR_clear_error();
    if (X509_VERIFY_PARAM_set1_host(demands, host->c_str(), host->size()) != 1 ||
        SSL_set_tlsext_host_name(session_.get(), host->c_str()) != 1) {
      throw std::runtime_error("OpenSSL does not accept the host " + *host);
    }
  }

  [[nodiscard]] std::optional<std::string> receive(std::string_view bytes,
                                                   Output& output) override {
    ERR_clear_error();
    if (!bytes.empty()) {
      BIO_write(SSL_get_rbio(session_.get()), bytes.data(), static_cast<int>(bytes.size()));
    }
    auto fault = open(output);
    take_sealed(output);
    return fault;
  }

  [[nodiscard]] std::optional<std::string> send(std::string_view bytes, Output& output) override {
    ERR_clear_error();
    std::size_t written = 0;
    const int done = SSL_write_ex(session_.get(), bytes.data(), bytes.size(), &written);
    take_sealed(output);
    if (done == 1) return std::nullopt;
    return reason();
  }

  void finish(Output& output) override {
    ERR_clear_error();
    SSL_shutdown(session_.get());
    take_sealed(output);
  }

  [[nodiscard]] bool is_ready() const override { return SSL_is_init_finished(session_.get()) == 1; }

 private:
  /// Continues the handshake, and decrypts all complete records.
  [[nodiscard]] std::optional<std::string> open(Output& output) {
    if (!is_ready()) {
      const int done = SSL_do_handshake(session_.get());
      if (done != 1) return fault_of(done);
    }
    std::array<char, 16384> part{};
    for (;;) {
      std::size_t count = 0;
      const int done = SSL_read_ex(session_.get(), part.data(), part.size(), &count);
      if (done != 1) return fault_of(done);
      output.opened.append(part.data(), count);
    }
  }

  void take_sealed(Output& output) {
    BIO* sealed = SSL_get_wbio(session_.get());
    const std::size_t before = output.sealed.size();
    const std::size_t count = BIO_ctrl_pending(sealed);
    if (count == 0) return;
    output.sealed.resize(before + count);
    BIO_read(sealed, output.sealed.data() + before, static_cast<int>(count));
  }

  /// Returns nothing if the session needs more bytes, or the peer has said goodbye.
  [[nodiscard]] std::optional<std::string> fault_of(int done) const {
    const int error = SSL_get_error(session_.get(), done);
    if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_ZERO_RETURN) return std::nullopt;
    return reason();
  }

  [[nodiscard]] std::string reason() const {
    const long verified = SSL_get_verify_result(session_.get());
    if (verified != X509_V_OK) return X509_verify_cert_error_string(verified);
    const char* known = ERR_reason_error_string(ERR_peek_error());
    return known == nullptr ? "unknown error of OpenSSL" : known;
  }

  std::unique_ptr<SSL, decltype(&SSL_free)> session_;
};

namespace detail {

/// Returns a share of a context.
inline std::shared_ptr<SSL_CTX> shared(SSL_CTX* context) {
  SSL_CTX_up_ref(context);
  return {context, SSL_CTX_free};
}

}  // namespace detail

/// Returns channels for `ClientConfig::channel`. The robot must have a certificate for its host, from
/// an authority that the context trusts.
inline ClientChannel openssl_client(SSL_CTX* context) {
  return [context = detail::shared(context)](const std::string& host) {
    return std::make_unique<OpensslChannel>(context.get(), host);
  };
}

/// Returns channels for `ServerConfig::channel`. The context has the certificate of the robot. With
/// `SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT`, apps need a certificate too.
inline ServerChannel openssl_server(SSL_CTX* context) {
  return [context = detail::shared(context)] {
    return std::make_unique<OpensslChannel>(context.get(), std::nullopt);
  };
}

}  // namespace fc_runtime
