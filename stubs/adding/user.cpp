// An app and a robot that use what `noise.yaml` adds.
#include <chrono>
#include <memory>
#include <optional>
#include <variant>

#include "fc/client.hpp"
#include "fc/robot.hpp"

namespace {

class Ear : public fc::PartialRobot {
 public:
  fc_runtime::Replied<fc::MeasureNoiseResponse> measure_noise(
      const fc_runtime::Context& /*context*/, const fc::MeasureNoiseRequest& request) override {
    fc::NoiseBand band;
    band.hertz = 1000;
    band.level = request.seconds;
    fc::MeasureNoiseResponse response;
    response.bands.push_back(band);
    return response;
  }
};

std::optional<double> first_level(const fc::Client& client) {
  fc::MeasureNoiseRequest request;
  request.seconds = 3;
  const auto answer = client.measure_noise(request);
  return answer && !answer->bands.empty() ? answer->bands[0].level : std::nullopt;
}

std::optional<std::uint32_t> heard(const fc::Client& client) {
  const fc::Reports reports = client.reports();
  while (const auto report = reports.next(std::chrono::minutes(1))) {
    if (const auto* noise = std::get_if<fc::NoiseChanged>(&*report)) return noise->loudest.hertz;
  }
  return std::nullopt;
}

bool tell(const fc::Reporter& reporter) {
  fc::NoiseChanged report;
  report.loudest.hertz = 1000;
  return reporter.noise_changed(report).has_value();
}

}  // namespace

bool use(const fc::Client& client, const fc::Reporter& reporter);
bool use(const fc::Client& client, const fc::Reporter& reporter) {
  static_cast<void>(fc::service(std::make_shared<Ear>()));
  return first_level(client) && heard(client) && tell(reporter);
}
