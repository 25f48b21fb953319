#include <cstdint>
#include <cstdlib>
#include <fc/client.hpp>
#include <iostream>

int main(int count, char** arguments) {
  fc_runtime::ClientConfig config;
  config.host = "127.0.0.1";
  if (count > 1) config.command_port = static_cast<std::uint16_t>(std::atoi(arguments[1]));
  const auto client = fc::Client::connect(config);
  if (!client) {
    std::cerr << to_string(client.error()) << '\n';
    return 1;
  }
  const auto answer = client->get_robot_sn({});
  if (!answer) {
    std::cerr << answer.error() << '\n';
    return 1;
  }
  std::cout << answer->data.robot_sn << '\n';
}
