// A simulated robot for testing apps. It responds to every command with the example in the spec,
// including commands that would move a real robot. It pushes every report once to each app. It
// sends the picture of a map over the data port to each app that requests one.
#include "fc/robot.hpp"

#include <pthread.h>

#include <condition_variable>
#include <csignal>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <type_traits>

#include "fc/client.hpp"
#include "support.hpp"

namespace {

constexpr const char* kUsage =
    "Responds to every command with the example in the spec. Nothing moves: this is for trying out "
    "apps.\n\n"
    "Usage: robot [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] [--delay "
    "MILLISECONDS]\n"
    "             [--gzip-from BYTES] [--picture-scale N]\n\n"
    "Without ports, those of the spec; 0 for any that is free. The first line says which:\n"
    "commands 127.0.0.1:PORT data 127.0.0.1:PORT\n"
    "The robot ends with Ctrl-C or SIGTERM: what it has begun is answered first. With --delay it "
    "takes so long over each command; with --gzip-from it compresses whatever has so many bytes; "
    "with --picture-scale the picture of a map is so many times as wide and high.\n";

/// Grace period for running handlers at shutdown.
constexpr std::chrono::seconds kGrace{5};

/// Returns a small map as a portable graymap: a room with a wall around it.
std::string picture(std::size_t scale) {
  const std::size_t width = 64 * scale;
  const std::size_t height = 48 * scale;
  std::string map = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
  for (std::size_t row = 0; row < height; ++row) {
    for (std::size_t column = 0; column < width; ++column) {
      const bool is_wall = row == 0 || row == height - 1 || column == 0 || column == width - 1;
      map.push_back(is_wall ? '\0' : '\xFE');
    }
  }
  return map;
}

/// Sends reports and pictures from its own thread.
class Attendant {
 public:
  Attendant(const fc_runtime::Server& server, std::string picture)
      : server_(&server), picture_(std::move(picture)) {
    thread_ = std::thread([this] { work(); });
  }
  ~Attendant() {
    {
      const std::lock_guard held(mutex_);
      is_over_ = true;
      changed_.notify_one();
    }
    thread_.join();
  }

  void asked(const fc_runtime::Context& context) {
    const std::lock_guard held(mutex_);
    asked_.push_back(context);
    changed_.notify_one();
  }

 private:
  void work() {
    std::set<fc_runtime::ConnectionId> known;
    for (;;) {
      std::unique_lock held(mutex_);
      changed_.wait(held, [this] { return is_over_ || !asked_.empty(); });
      if (is_over_) return;
      const fc_runtime::Context context = asked_.front();
      asked_.pop_front();
      held.unlock();
      if (known.insert(context.connection).second) push_all(context.connection);
      if (context.code == fc_runtime::Command<fc::GetMapImageRequest>::code) send_picture(context);
    }
  }

  /// Pushes every report with the example in the spec.
  void push_all(fc_runtime::ConnectionId app) const {
    fc::for_each_report([&](const auto& any) {
      using Message = std::decay_t<decltype(any)>;
      const auto done = [app](const std::vector<fc_runtime::AckOutcome>& ended) {
        for (const auto& outcome : ended) {
          std::printf("%s to %llu: %s\n", fc_runtime::Report<Message>::name,
                      static_cast<unsigned long long>(app),
                      std::string(name(outcome.kind)).c_str());
        }
        std::fflush(stdout);
      };
      const auto pushed = server_->push_async(fc_runtime::example<Message>(), done, app);
      if (!pushed) std::fprintf(stderr, "%s\n", to_string(pushed.error()).c_str());
    });
  }

  /// Sends a picture to the app that requested it, with the id of the request.
  void send_picture(const fc_runtime::Context& context) const {
    const auto sent = server_->send_stream(context.connection, context.code, context.id, picture_);
    if (!sent) {
      // The request may arrive before the data connection of the app.
      std::fprintf(stderr, "picture: %s\n", to_string(sent.error()).c_str());
    }
  }

  const fc_runtime::Server* server_;
  std::string picture_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<fc_runtime::Context> asked_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace

int main(int count, char** words) {
  const Args args = parse(count, words, kUsage);
  // Later threads inherit this mask and leave the signals to the main thread.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  fc_runtime::ServerConfig config;
  config.address = args.host;
  config.command_port = args.command_port;
  config.data_port = args.data_port;
  config.gzip = args.gzip;
  // The simulated robot has no motors, so all commands are allowed.
  const auto examples = fc::service(std::make_shared<fc::ExampleRobot>(true));
  std::mutex mutex;
  Attendant* attendant = nullptr;
  const auto service = [&](const fc_runtime::Context& context,
                           std::string_view text) -> fc_runtime::Handled {
    {
      const std::lock_guard held(mutex);
      if (attendant != nullptr) attendant->asked(context);
    }
    if (args.delay.count() > 0) std::this_thread::sleep_for(args.delay);
    return examples(context, text);
  };
  const auto server = fc_runtime::Server::bind(fc::protocol(), service, config);
  if (!server) {
    std::fprintf(stderr, "%s\n", to_string(server.error()).c_str());
    return 1;
  }
  Attendant attending(*server, picture(args.picture_scale));
  {
    const std::lock_guard held(mutex);
    attendant = &attending;
  }
  std::printf("commands %s:%u data %s:%u\n", server->address().c_str(), server->command_port(),
              server->address().c_str(), server->data_port());
  std::fflush(stdout);
  int signal = 0;
  sigwait(&signals, &signal);
  server->shutdown(kGrace);
  const std::lock_guard held(mutex);
  attendant = nullptr;
  return 0;
}
