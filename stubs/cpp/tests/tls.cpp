// Clients and robots over TLS by OpenSSL.
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <memory>
#include <stdexcept>
#include <thread>

#include "fc_runtime/client.hpp"
#include "fc_runtime/openssl.hpp"
#include "fc_runtime/server.hpp"
#include "support/check.hpp"
#include "support/lines.hpp"
#include "support/raw.hpp"
#include "support/toy_messages.hpp"

namespace {

using fc_runtime::ClientConfig;
using fc_runtime::Connection;
using fc_runtime::Context;
using fc_runtime::Handled;
using fc_runtime::LossKind;
using fc_runtime::Refusal;
using fc_runtime::Result;
using fc_runtime::Server;
using fc_runtime::ServerConfig;
using std::chrono::milliseconds;
using std::chrono::seconds;
using tests::Echo;
using tests::Lines;
using tests::Tally;

/// Time after which a test has failed. No passing test waits so long.
constexpr seconds kPatience{20};

const fc_runtime::Protocol& protocol() {
  static const fc_runtime::Protocol toy = tests::toy_with_messages();
  return toy;
}

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

/// A key with its certificate for 127.0.0.1, which is trusted as an authority too.
class Identity {
 public:
  Identity() : key_(EVP_EC_gen("P-256"), EVP_PKEY_free), certificate_(X509_new(), X509_free) {
    X509* certificate = certificate_.get();
    X509_set_version(certificate, 2);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate), 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate), -3600);
    X509_gmtime_adj(X509_getm_notAfter(certificate), 3600);
    X509_set_pubkey(certificate, key_.get());
    X509_NAME* name = X509_get_subject_name(certificate);
    // Chains are found by their names, so each identity has its own.
    static int number = 0;
    const std::string text = "identity " + std::to_string(++number);
    X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(text.c_str()), -1, -1, 0);
    X509_set_issuer_name(certificate, name);
    const Owned<X509_EXTENSION> names(
        X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "IP:127.0.0.1"),
        X509_EXTENSION_free);
    X509_add_ext(certificate, names.get(), -1);
    if (X509_sign(certificate, key_.get(), EVP_sha256()) == 0) throw std::runtime_error("OpenSSL");
  }

  /// Gives this key to a context.
  void present(SSL_CTX* context) const {
    SSL_CTX_use_certificate(context, certificate_.get());
    SSL_CTX_use_PrivateKey(context, key_.get());
  }
  /// Lets a context trust this certificate.
  void trust(SSL_CTX* context) const {
    X509_STORE_add_cert(SSL_CTX_get_cert_store(context), certificate_.get());
  }

 private:
  Owned<EVP_PKEY> key_;
  Owned<X509> certificate_;
};

const Identity& robot_key() {
  static const Identity identity;
  return identity;
}

const Identity& app_key() {
  static const Identity identity;
  return identity;
}

/// Returns a context with a key, if any, that trusts another one.
Owned<SSL_CTX> context(const Identity* own, const Identity& trusted) {
  Owned<SSL_CTX> context(SSL_CTX_new(TLS_method()), SSL_CTX_free);
  if (own != nullptr) own->present(context.get());
  trusted.trust(context.get());
  return context;
}

fc_runtime::ServerChannel of_robot(bool needs_certificate = false, int version = 0) {
  const auto made = context(&robot_key(), app_key());
  if (needs_certificate) {
    SSL_CTX_set_verify(made.get(), SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  }
  SSL_CTX_set_max_proto_version(made.get(), version);
  return fc_runtime::openssl_server(made.get());
}

fc_runtime::ClientChannel of_app(const Identity* own = &app_key(),
                                 const Identity& trusted = robot_key()) {
  return fc_runtime::openssl_client(context(own, trusted).get());
}

Server robot(ServerConfig config) {
  config.address = "127.0.0.1";
  config.command_port = std::uint16_t{0};
  config.data_port = std::uint16_t{0};
  const auto service = [](const Context& context, std::string_view text) -> Handled {
    if (context.code != tests::kEcho) return fc_runtime::unknown_command(protocol());
    return fc_runtime::serve<Echo, Echo>(
        protocol(), context, text,
        [](const Context&, const Echo& request) -> Result<Echo, Refusal> { return request; });
  };
  return *Server::bind(protocol(), service, config);
}

ClientConfig to(std::uint16_t command_port, std::uint16_t data_port = 1) {
  ClientConfig config;
  config.host = "127.0.0.1";
  config.command_port = command_port;
  config.data_port = data_port;
  config.call_timeout = kPatience;
  config.reconnect = std::nullopt;
  config.channel = of_app();
  return config;
}

/// Forwards one connection in small pieces.
void dribble(const tests::Socket& from, const tests::Socket& to) {
  for (;;) {
    const std::string bytes = from.receive();
    if (bytes.empty()) break;
    for (std::size_t at = 0, size = 1; at < bytes.size(); at += size, size = size % 700 + 13) {
      to.send(std::string_view(bytes).substr(at, size));
    }
  }
  to.finish();
}

void both_sides(Tally& tally) {
  ServerConfig config;
  config.channel = of_robot(true);
  const auto server = robot(config);
  const auto app = *Connection::connect(protocol(), to(server.command_port(), server.data_port()));
  for (const std::size_t length : {1U, 20'000U, 2'000'000U}) {
    const std::string text(length, 'x');
    const auto echo = app.call(Echo{text, {}});
    tally.check(echo && echo->text == text, "an echo of " + std::to_string(length) + " bytes");
  }
  auto reports = app.reports();
  const auto outcomes = server.push_body(300, R"({"cmdTime":1})");
  tally.check(outcomes.has_value() && outcomes->size() == 1, "a report is answered");

  const auto data = app.data();
  tally.check(data.connected().has_value(), "the data port too");
  static_cast<void>(server.next_stream(milliseconds(0)));
  std::string bytes(3'000'000, '\0');
  for (std::size_t at = 0; at < bytes.size(); ++at) bytes[at] = static_cast<char>(at * 7 / 3);
  tally.check(data.send(5, 7, bytes).has_value(), "a stream to the robot");
  const auto came = server.next_stream(kPatience);
  tally.check(came && came->frame.data == bytes, "which arrives");
  tally.check(server.send_stream(came->connection, 6, 8, bytes).value_or(0) == 1, "and back");
  const auto frame = data.next(kPatience);
  tally.check(frame && frame->data == bytes, "which arrives as well");
  tally.check(server.counters().handshakes_failed == 0, "no handshake failed");

  server.shutdown(kPatience);
  const auto why = app.closed(kPatience);
  tally.check(why && why->kind == LossKind::Closed, "the robot says goodbye");
}

void in_pieces(Tally& tally) {
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    ServerConfig config;
    config.channel = of_robot(false, version);
    const auto server = robot(config);
    const tests::Listener listener;
    std::thread between([&] {
      const auto near = listener.accept();
      const auto far = tests::dial(server.command_port());
      std::thread back([&] { dribble(far, near); });
      dribble(near, far);
      back.join();
    });
    {
      const auto app = Connection::connect(protocol(), to(listener.port()));
      const std::string text(60'000, 'y');
      const auto echo =
          app ? app->call(Echo{text, {}}) : Result<Echo, fc_runtime::CallError>(Echo{});
      tally.check(echo && echo->text == text, "small pieces of version " + std::to_string(version));
    }
    between.join();
  }
}

void refused(Tally& tally) {
  Lines lines;
  ServerConfig config;
  config.channel = of_robot();
  config.log = lines.log();
  const auto server = robot(config);
  ClientConfig strange = to(server.command_port());
  strange.channel = of_app(nullptr, app_key());
  const auto untrusted = Connection::connect(protocol(), strange);
  tally.check(!untrusted && untrusted.error().kind == LossKind::Unreachable &&
                  untrusted.error().detail.find("self-signed") != std::string::npos,
              "a robot with a strange certificate");
  ClientConfig renamed = to(server.command_port());
  renamed.host = "localhost";
  const auto misnamed = Connection::connect(protocol(), renamed);
  tally.check(!misnamed && misnamed.error().detail.find("mismatch") != std::string::npos,
              "a robot whose certificate has another name");
  tally.check(lines.has("the handshake with 127.0.0.1 failed: "), "is a line of the log");

  // An app without TLS.
  const auto plain = tests::dial(server.command_port());
  plain.send(std::string(100, '\xFC'));
  while (!plain.receive().empty()) {
  }
  // An app that stops in its handshake.
  { const auto silent = tests::dial(server.command_port()); }
  const auto app = *Connection::connect(protocol(), to(server.command_port()));
  tally.check(app.call(Echo{"a", {}}).has_value(), "others are served");
  tally.check(server.counters().handshakes_failed >= 3, "they are counted");
}

void without_certificate(Tally& tally) {
  Lines lines;
  ServerConfig config;
  config.channel = of_robot(true);
  config.log = lines.log();
  const auto server = robot(config);
  ClientConfig nobody = to(server.command_port());
  nobody.channel = of_app(nullptr);
  // With TLS 1.3, the app learns it only after its own handshake.
  const auto app = Connection::connect_lazy(protocol(), nobody);
  tally.check(!app.call(Echo{"a", {}}), "an app without a certificate");
  tally.check(lines.has("the handshake with 127.0.0.1 failed: "), "its line");
  tally.check(server.counters().calls_succeeded == 0, "nothing is answered");
}

void slow(Tally& tally) {
  ServerConfig config;
  config.channel = of_robot();
  config.header_timeout = milliseconds(30);
  Lines lines;
  config.log = lines.log();
  const auto server = robot(config);
  const auto silent = tests::dial(server.command_port());
  tally.check(silent.receive().empty(), "a silent app is closed");
  tally.check(lines.has("the handshake took too long"), "with its reason");

  const tests::Listener listener;
  ClientConfig impatient = to(listener.port());
  impatient.connect_timeout = milliseconds(30);
  const auto app = Connection::connect(protocol(), impatient);
  tally.check(!app && app.error().kind == LossKind::ConnectTimeout, "a silent robot");
}

void no_channel(Tally& tally) {
  ServerConfig config;
  config.channel = [] { return std::unique_ptr<fc_runtime::SecureChannel>(); };
  const auto server = robot(config);
  const auto app = tests::dial(server.command_port());
  tally.check(app.receive().empty(), "a robot without a channel closes");
  ClientConfig client = to(server.command_port());
  client.channel = [](const std::string&) -> std::unique_ptr<fc_runtime::SecureChannel> {
    throw std::runtime_error("no key");
  };
  const auto failed = Connection::connect(protocol(), client);
  tally.check(!failed && failed.error().detail == "no key", "an app without a channel");
}

}  // namespace

int main() {
  Tally tally;
  both_sides(tally);
  in_pieces(tally);
  refused(tally);
  without_certificate(tally);
  slow(tally);
  no_channel(tally);
  return tally.outcome("checks of TLS hold", 20);
}
