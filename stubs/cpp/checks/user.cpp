// A program that uses the meter. If it does not follow a change of the spec, it does not compile.
#include "meter/client.hpp"
#include "meter/robot.hpp"

namespace {

class Mine : public meter::Robot {
 public:
  fc_runtime::Replied<meter::ReadPowerResponse> read_power(
      const fc_runtime::Context& /*context*/, const meter::ReadPowerRequest& /*request*/) override {
    meter::ReadPowerResponse response;
    response.watts = 1.5;
    response.closed = true;
    return response;
  }
  fc_runtime::Replied<meter::SetTariffResponse> set_tariff(
      const fc_runtime::Context& /*context*/, const meter::SetTariffRequest& request) override {
    if (request.band == meter::Band::Night) return refusal(meter::SetTariffError::Locked);
    return meter::SetTariffResponse{};
  }
  fc_runtime::Replied<meter::CloseSwitchResponse> close_switch(
      const fc_runtime::Context& /*context*/,
      const meter::CloseSwitchRequest& /*request*/) override {
    meter::CloseSwitchResponse response;
    response.job = std::uint32_t{7};
    return response;
  }
  fc_runtime::Replied<meter::WatchLoadResponse> watch_load(
      const fc_runtime::Context& /*context*/, const meter::WatchLoadRequest& /*request*/) override {
    return meter::WatchLoadResponse{};
  }
};

double use(const meter::Client& client) {
  meter::SetTariffRequest request;
  request.band = meter::Band::Day;
  request.price = std::uint32_t{3};
  request.note = "x";
  if (!client.set_tariff(request)) return 0;
  auto following = client.follow<meter::SwitchMoved>(meter::CloseSwitchRequest{});
  if (following) static_cast<void>(following->next(std::chrono::milliseconds(1)));
  const auto power = client.read_power({});
  return power ? power->watts.value() : 0;
}

}  // namespace

int main() {
  static_cast<void>(meter::service(std::make_shared<Mine>()));
  return use(meter::Client::connect_lazy()) > 0 ? 0 : 1;
}
