#include <grpcpp/grpcpp.h>

#include <stdexcept>
#include <string>

#include "bench.grpc.pb.h"
#include "fc/groups/types.hpp"
#include "fc/protocol.hpp"
#include "fc_runtime/envelope.hpp"
#include "peer.hpp"

namespace bench {

namespace {

/// Responds to queries of a station, with a new message for each call. gRPC recommends callbacks.
class GrpcRobot final : public Robot::CallbackService {
 public:
  grpc::ServerUnaryReactor* GetStation(grpc::CallbackServerContext* context,
                                       const StationRequest* request,
                                       StationResponse* response) override {
    const auto& success = fc::protocol().results.success;
    response->set_cmd_time(fc_runtime::unix_ms());
    response->set_result_code(static_cast<std::int32_t>(success.code));
    response->set_result_msg(std::string(success.text));
    response->set_station_name(kName);
    response->set_station_id(request->station_id());
    response->set_station_type(static_cast<std::int32_t>(fc::StationType::Navigation));
    response->set_x(0.5);
    response->set_y(0.6);
    response->set_yaw(0.2);
    auto* reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
  }
};

class GrpcAnswers : public Answering {
 public:
  GrpcAnswers() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort(std::string(kHost) + ":0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
    if (!server_) throw std::runtime_error("gRPC cannot listen");
  }
  [[nodiscard]] std::uint16_t port() const override { return static_cast<std::uint16_t>(port_); }

 private:
  GrpcRobot service_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

class GrpcAsks : public Asking {
 public:
  explicit GrpcAsks(std::uint16_t port)
      : stub_(Robot::NewStub(grpc::CreateChannel(std::string(kHost) + ":" + std::to_string(port),
                                                 grpc::InsecureChannelCredentials()))) {}
  bool call() override {
    grpc::ClientContext context;
    StationResponse response;
    return is_right(stub_->GetStation(&context, question(), &response), response);
  }
  void begin(std::function<void(bool)> done) override {
    struct Call {
      grpc::ClientContext context;
      StationRequest request = question();
      StationResponse response;
    };
    const auto call = std::make_shared<Call>();
    stub_->async()->GetStation(&call->context, &call->request, &call->response,
                               [call, done = std::move(done)](const grpc::Status& status) {
                                 done(is_right(status, call->response));
                               });
  }

 private:
  static StationRequest question() {
    StationRequest request;
    request.set_cmd_time(fc_runtime::unix_ms());
    request.set_station_id(kStation);
    return request;
  }
  static bool is_right(const grpc::Status& status, const StationResponse& response) {
    return status.ok() && response.station_id() == kStation && response.station_name() == kName;
  }

  std::unique_ptr<Robot::Stub> stub_;
};

}  // namespace

const Peer theirs{"grpc++", false,
                  []() -> std::unique_ptr<Answering> { return std::make_unique<GrpcAnswers>(); },
                  [](std::uint16_t port, int /*window*/) -> std::unique_ptr<Asking> {
                    return std::make_unique<GrpcAsks>(port);
                  }};

}  // namespace bench
