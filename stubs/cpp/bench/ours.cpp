#include <stdexcept>

#include "fc/client.hpp"
#include "fc/robot.hpp"
#include "peer.hpp"

namespace bench {

namespace {

/// Responds to queries of a station, with a new message for each call.
class FcRobot : public fc::PartialRobot {
 public:
  fc_runtime::Replied<fc::GetStationResponse> get_station(
      const fc_runtime::Context& /*context*/, const fc::GetStationRequest& request) override {
    fc::GetStationResponse response;
    response.data.station_name = kName;
    response.data.station_id = request.data.station_id;
    response.data.station_type = fc::StationType::Navigation;
    response.data.x = 0.5;
    response.data.y = 0.6;
    response.data.yaw = 0.2;
    return response;
  }
};

template <class T, class Error>
T demand(fc_runtime::Result<T, Error> result, const char* what) {
  if (!result) throw std::runtime_error(what);
  return *std::move(result);
}

class FcAnswers : public Answering {
 public:
  [[nodiscard]] std::uint16_t port() const override { return server_.command_port(); }

 private:
  static fc_runtime::Server bound() {
    fc_runtime::ServerConfig config;
    config.address = kHost;
    config.command_port = std::uint16_t{0};
    config.data_port = std::uint16_t{0};
    return demand(
        fc_runtime::Server::bind(fc::protocol(), fc::service(std::make_shared<FcRobot>()), config),
        "the robot cannot listen");
  }

  fc_runtime::Server server_ = bound();
};

class FcAsks : public Asking {
 public:
  explicit FcAsks(std::uint16_t port) : client_(connected(port)) {
    request_.data.station_id = kStation;
  }
  bool call() override { return is_right(client_.get_station(request_)); }
  void begin(std::function<void(bool)> done) override {
    static_cast<void>(client_.connection().call_async(
        request_, [done = std::move(done)](const auto& answer) { done(is_right(answer)); }));
  }

 private:
  static fc::Client connected(std::uint16_t port) {
    fc_runtime::ClientConfig config;
    config.host = kHost;
    config.command_port = port;
    return demand(fc::Client::connect(config), "the app cannot connect");
  }
  static bool is_right(const fc_runtime::Called<fc::GetStationResponse>& answer) {
    return answer && answer->data.station_id == kStation && answer->data.station_name == kName;
  }

  fc::Client client_;
  fc::GetStationRequest request_;
};

}  // namespace

const Peer ours{"fc", false,
                []() -> std::unique_ptr<Answering> { return std::make_unique<FcAnswers>(); },
                [](std::uint16_t port, int /*window*/) -> std::unique_ptr<Asking> {
                  return std::make_unique<FcAsks>(port);
                }};

}  // namespace bench
