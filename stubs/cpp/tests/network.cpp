// Clients and robots over TCP: with each other, and with peers that misbehave.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "fc_runtime/client.hpp"
#include "fc_runtime/server.hpp"
#include "support/check.hpp"
#include "support/lines.hpp"
#include "support/raw.hpp"
#include "support/toy_messages.hpp"

namespace {

using fc_runtime::CallErrorKind;
using fc_runtime::CallOptions;
using fc_runtime::ClientConfig;
using fc_runtime::Connection;
using fc_runtime::ConnectionStatus;
using fc_runtime::Context;
using fc_runtime::FrameId;
using fc_runtime::Handled;
using fc_runtime::LossKind;
using fc_runtime::Refusal;
using fc_runtime::Result;
using fc_runtime::Server;
using fc_runtime::ServerConfig;
using std::chrono::milliseconds;
using std::chrono::seconds;
using tests::Echo;
using tests::Frames;
using tests::Go;
using tests::Lines;
using tests::Nothing;
using tests::Tally;

/// Time after which a test has failed. No passing test waits so long.
constexpr seconds kPatience{20};

const fc_runtime::Protocol& protocol() {
  static const fc_runtime::Protocol toy = tests::toy_with_messages();
  return toy;
}

/// A command that the protocol does not define and the robot handles.
constexpr std::uint16_t kRaw = 901;

/// A gate at which handlers wait.
class Door {
 public:
  void open() {
    const std::lock_guard held(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock held(mutex_);
    ++waiting_;
    changed_.notify_all();
    changed_.wait_for(held, kPatience, [this] { return is_open_; });
  }
  /// Waits until `count` handlers have arrived at the door.
  bool has(int count) {
    std::unique_lock held(mutex_);
    return changed_.wait_for(held, kPatience, [&] { return waiting_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
  int waiting_ = 0;
};

/// Echoes requests. Commands that move wait at the door, except those that go nowhere.
fc_runtime::Service service(Door* door = nullptr) {
  return [door](const Context& context, std::string_view text) -> Handled {
    if (context.code == tests::kEcho) {
      return fc_runtime::serve<Echo, Echo>(
          protocol(), context, text,
          [](const Context&, const Echo& request) -> Result<Echo, Refusal> { return request; });
    }
    if (context.code == kRaw) {
      return fc_runtime::serve_raw(
          protocol(), context, text,
          [](const Context&, std::string_view whole) -> fc_runtime::RawReplied {
            return fc_runtime::Json::parse(
                       whole.find("secret") == std::string_view::npos ? R"({"heard":1.50})" : "[]")
                .value_or(fc_runtime::Json());
          });
    }
    if (context.code != tests::kGo) return fc_runtime::unknown_command(protocol());
    return fc_runtime::serve<Go, Nothing>(
        protocol(), context, text,
        [door](const Context&, const Go& request) -> Result<Nothing, Refusal> {
          if (request.metres == 0) return Refusal(1234, "nowhere to go");
          if (door != nullptr) door->pass();
          return Nothing{};
        });
  };
}

ServerConfig free_ports() {
  ServerConfig config;
  config.address = "127.0.0.1";
  config.command_port = std::uint16_t{0};
  config.data_port = std::uint16_t{0};
  return config;
}

ClientConfig to(std::uint16_t command_port, std::uint16_t data_port = 1) {
  ClientConfig config;
  config.host = "127.0.0.1";
  config.command_port = command_port;
  config.data_port = data_port;
  config.call_timeout = kPatience;
  config.reconnect = fc_runtime::Backoff{milliseconds(1), milliseconds(20), std::nullopt};
  return config;
}

Connection connected(const Server& server) {
  return *Connection::connect(protocol(), to(server.command_port(), server.data_port()));
}

void calls(Tally& tally) {
  const auto server = *Server::bind(protocol(), service(), free_ports());
  const Connection app = connected(server);
  const auto echo = app.call(Echo{"你好", {}});
  tally.check(echo && echo->text == "你好", "a call is answered");
  const auto refused = app.call(Go{0, {}});
  tally.check(!refused && refused.error().kind == CallErrorKind::Refused &&
                  refused.error().refusal->code == 1234,
              "a refusal has its code");
  const auto not_text = app.call(Echo{"\xFF", {}});
  tally.check(!not_text && not_text.error().name() == "invalid_request", "not UTF-8");
  const auto raw = app.call_body(kRaw, "{");
  tally.check(raw && raw->find("\"heard\":1.50}") != std::string::npos &&
                  raw->find("1001") != std::string::npos,
              "a command without a type");
  const auto list = app.call_body(kRaw, R"({"secret":1})");
  tally.check(list && list->find("2001") != std::string::npos, "whose answer is no object");
  const auto unknown = app.call_body(900, "{}");
  tally.check(unknown && unknown->find("2001") != std::string::npos, "an unknown command");

  // Many calls at once from several threads. Each gets its own response.
  std::atomic<int> right{0};
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 8; ++caller) {
    callers.emplace_back([&, caller] {
      for (int at = 0; at < 50; ++at) {
        const std::string text = std::to_string(caller) + "-" + std::to_string(at);
        const auto answer = app.call(Echo{text, {}});
        if (answer && answer->text == text) ++right;
      }
    });
  }
  for (auto& caller : callers) caller.join();
  tally.check(right == 400, "each caller has its own answers");

  // Callbacks run on the thread of the connection and must not wait there.
  std::promise<std::string> inner;
  app.call_async(Echo{"a", {}}, [&](const Result<Echo, fc_runtime::CallError>&) {
    const auto waits = app.call(Echo{"b", {}});
    inner.set_value(waits ? "success" : std::string(waits.error().name()));
  });
  tally.check(inner.get_future().get() == "busy", "a callback does not wait for itself");
  // A callback may hold the last copy of a connection, which then ends on its own thread.
  std::promise<void> over;
  auto last = std::make_shared<Connection>(connected(server));
  const auto* held = last.get();
  held->call_async(Echo{"a", {}}, [last, &over](const auto&) mutable {
    last.reset();
    over.set_value();
  });
  last.reset();
  over.get_future().get();

  tally.check(!app.closed(milliseconds(0)), "it is open");
  app.close();
  const auto why = app.closed(kPatience);
  tally.check(why && why->kind == LossKind::Here, "the end has a cause");
  const auto closed = app.call(Echo{"c", {}});
  tally.check(!closed && closed.error().name() == "closed", "after the end");
}

/// Collects what the hook for metrics gets.
class Ended {
 public:
  fc_runtime::CallHook hook() {
    return [this](const fc_runtime::EndedCall& call) {
      const std::lock_guard held(mutex_);
      words_.push_back(std::string(call.operation) + " " + std::string(call.result));
      if (call.time.count() < 0) words_.push_back("a negative time");
      changed_.notify_all();
    };
  }
  /// Returns the calls, once there are `count`.
  std::vector<std::string> words(std::size_t count) {
    std::unique_lock held(mutex_);
    changed_.wait_for(held, kPatience, [&] { return words_.size() >= count; });
    return words_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> words_;
};

void metrics(Tally& tally) {
  Ended at_app;
  Ended at_robot;
  Door door;
  ServerConfig robot = free_ports();
  robot.on_call = at_robot.hook();
  const auto server = *Server::bind(protocol(), service(&door), robot);
  ClientConfig config = to(server.command_port());
  config.on_call = at_app.hook();
  const auto app = *Connection::connect(protocol(), config);
  const std::string echo(protocol().find(fc_runtime::OperationKind::Command, tests::kEcho)->name);
  const std::string go(protocol().find(fc_runtime::OperationKind::Command, tests::kGo)->name);
  static_cast<void>(app.call(Echo{"a", {}}));
  static_cast<void>(app.call(Go{0, {}}));
  static_cast<void>(app.call(Echo{"\xFF", {}}));
  static_cast<void>(app.call_body(900, "{}"));
  std::promise<void> answered;
  app.call_async(Echo{"b", {}}, [&](const auto&) { answered.set_value(); });
  answered.get_future().get();
  app.call_body_async(tests::kEcho, "{}", [](const fc_runtime::Answer&) {});
  static_cast<void>(at_app.words(6));
  const auto dropped = app.call_async(Go{1, {}}, [](const auto&) {});
  tally.check(door.has(1), "a call is at work");
  dropped.cancel();
  static_cast<void>(at_app.words(7));
  door.open();
  app.close();
  static_cast<void>(app.closed(kPatience));
  static_cast<void>(app.call(Echo{"c", {}}));
  const std::vector<std::string> told = {
      echo + " success", go + " refused",   echo + " invalid_request", "unknown success",
      echo + " success", echo + " success", go + " dropped",           echo + " closed"};
  tally.check(at_app.words(8) == told, "the app knows the end of each call");
  const std::vector<std::string> seen = {echo + " success", go + " refused", "unknown protocol",
                                         echo + " success", echo + " invalid"};
  auto found = at_robot.words(5);
  found.resize(5);
  tally.check(found == seen, "the robot knows it, too");

  Lines lines;
  ServerConfig careless = free_ports();
  careless.on_call = [](const fc_runtime::EndedCall&) { throw std::runtime_error("secret"); };
  careless.log = lines.log();
  const auto failing = *Server::bind(protocol(), service(), careless);
  ClientConfig client = to(failing.command_port());
  client.on_call = careless.on_call;
  client.log = lines.log();
  const auto other = *Connection::connect(protocol(), client);
  tally.check(other.call(Echo{"a", {}}).has_value(), "a hook that throws harms nothing");
  tally.check(lines.has("`on_call` threw `std::runtime_error`") && !lines.has_now("secret"),
              "and is logged");
}

void compressed(Tally& tally) {
  ServerConfig robot = free_ports();
  robot.gzip = fc_runtime::Gzip{};
  const auto server = *Server::bind(protocol(), service(), robot);
  ClientConfig config = to(server.command_port());
  config.gzip = fc_runtime::Gzip{};
  const auto app = *Connection::connect(protocol(), config);
  const std::string text(1U << 20U, 'x');
  const auto echo = app.call(Echo{text, {}});
  tally.check(echo && echo->text == text, "a long text comes back");
  tally.check(app.counters().bytes_out < text.size() / 10, "it was compressed");
  tally.check(app.counters().bytes_in < text.size() / 10, "and so was the answer");
}

void reports(Tally& tally) {
  const auto server = *Server::bind(protocol(), service(), free_ports());
  const Connection app = connected(server);
  const auto queue = app.reports();
  tally.check(bool(app.call(Echo{"", {}})), "it is connected");
  for (int metres = 1; metres <= 5; ++metres) {
    const auto pushed = server.push(Go{metres, {}});
    tally.check(pushed && pushed->size() == 1 &&
                    pushed->front().kind == fc_runtime::AckOutcomeKind::Acknowledged,
                "a report is acknowledged");
    const auto report = queue->next(kPatience);
    const auto read = fc_runtime::read_report<Go>(protocol(), report ? report->text : "", {});
    tally.check(read && read->metres == metres, "and handed on");
  }
  const auto nobody = server.push(Go{1, {}}, 999);
  tally.check(!nobody && name(nobody.error().kind) == "no_connection", "nobody there");
}

void streams(Tally& tally) {
  const auto server = *Server::bind(protocol(), service(), free_ports());
  const Connection app = connected(server);
  tally.check(bool(app.call(Echo{"", {}})), "it is connected");
  const auto data = app.data();
  tally.check(bool(data.connected()), "the data port");
  // Frames are dropped until the first call of `next_stream`.
  tally.check(!server.next_stream(milliseconds(0)), "nothing yet");
  for (std::uint32_t at = 0; at < 50; ++at) {
    tally.check(bool(data.send(7, at, "hello")), "the app sends");
    if (at % 10 < 9) continue;
    // Ten frames do not fit: the server stops reading from the app in the meantime.
    for (std::uint32_t left = 10; left > 0; --left) {
      const auto stream = server.next_stream(kPatience);
      tally.check(stream && stream->frame.code == 7 && stream->frame.id == at + 1 - left &&
                      stream->frame.data == "hello",
                  "the robot gets it");
    }
  }
  std::string picture(5U << 20U, '\0');
  for (std::size_t at = 0; at < picture.size(); ++at) picture[at] = static_cast<char>(at * 7);
  const auto to_app = server.connections().front();
  std::thread sending([&] {
    for (std::uint32_t at = 0; at < 6; ++at) {
      const auto sent = server.send_stream(to_app, 9, at, picture);
      tally.check(sent && *sent == 1, "the robot sends");
    }
  });
  bool right = true;
  for (std::uint32_t at = 0; at < 6; ++at) {
    const auto frame = data.next(kPatience);
    right = right && frame && frame->id == at && frame->data == picture;
  }
  sending.join();
  tally.check(right, "pictures arrive whole and in order");
  const auto none = data.next(milliseconds(0));
  tally.check(!none && name(none.error().kind) == "timeout", "and then nothing");
  const Connection other = connected(server);
  tally.check(bool(other.call(Echo{"", {}})), "another app from there");
  const auto whose = server.send_stream(to_app, 9, 1, "?");
  tally.check(!whose && name(whose.error().kind) == "ambiguous", "whose it is cannot be told");
}

/// Each subscription receives the latest frames with its code.
void subscriptions(Tally& tally) {
  const auto server = *Server::bind(protocol(), service(), free_ports());
  const Connection app = connected(server);
  tally.check(bool(app.call(Echo{"", {}})), "it is connected");
  const auto data = app.data();
  tally.check(bool(data.connected()), "the data port");
  // The app is connected before the robot has accepted. A received frame shows that it has.
  tally.check(!server.next_stream(milliseconds(0)), "nothing yet");
  tally.check(data.send(7, 0, "hello") && server.next_stream(kPatience), "the robot gets it");
  const auto pictures = data.subscribe(9);
  const auto last = data.subscribe(10);
  const auto to_app = server.connections().front();
  const auto send = [&](std::uint16_t code, std::uint32_t id) {
    const auto sent = server.send_stream(to_app, code, id, "frame");
    tally.check(sent && *sent == 1, "the robot sends");
  };
  for (std::uint32_t at = 0; at < 6; ++at) send(9, at);
  // Frames without a subscription do not block the others.
  for (std::uint32_t at = 0; at < 6; ++at) send(11, at);
  send(10, 1);
  const auto end = last.next(kPatience);
  tally.check(end && end->code == 10 && last.missed() == 0, "the other code");
  tally.check(pictures.missed() == 2, "the oldest have made way");
  for (std::uint32_t at = 2; at < 6; ++at) {
    const auto frame = pictures.next(kPatience);
    tally.check(frame && frame->code == 9 && frame->id == at, "the latest are there, in order");
  }
  const auto none = pictures.next(milliseconds(0));
  tally.check(!none && name(none.error().kind) == "timeout", "and then nothing");
  // Frames without a subscription go to `next`.
  tally.check(!data.next(milliseconds(0)), "the others were dropped");
  send(11, 7);
  const auto other = data.next(kPatience);
  tally.check(other && other->code == 11 && other->id == 7, "what is left is there");
  app.close();
  const auto over = pictures.next(kPatience);
  const auto closed = over ? over : pictures.next(kPatience);
  tally.check(!closed && name(closed.error().kind) == "closed", "a subscription ends");
}

/// Streams whose content is a message, and the states of the data connection.
void stream_contents(Tally& tally) {
  const auto server = *Server::bind(protocol(), service(), free_ports());
  const Connection app = connected(server);
  tally.check(bool(app.call(Echo{"", {}})), "it is connected");
  const auto data = app.data();
  auto states = data.states();
  const auto moves = data.subscribe_json<Go>(9);
  tally.check(bool(data.connected()), "the data port");
  tally.check(data.state().status == fc_runtime::ConnectionStatus::Connected, "its state");
  tally.check(!server.next_stream(milliseconds(0)), "nothing yet");
  tally.check(data.send_json(7, 1, Go{5, {}}) && !data.send_json(7, 2, Go{}),
              "a message is checked before it is sent");
  const auto at_robot = server.next_stream(kPatience);
  tally.check(at_robot && at_robot->frame.data == R"({"metres":5})", "the robot gets it as JSON");
  const auto unset = server.send_stream_json(std::nullopt, 9, 1, Go{});
  tally.check(!unset && unset.error().body && unset.error().body->path == "metres",
              "the robot checks it too");
  tally.check(server.send_stream_json(std::nullopt, 9, 2, Go{6, {}}) &&
                  server.send_stream(std::nullopt, 9, 3, R"({"metres":"far"})") &&
                  server.send_stream_json(std::nullopt, 9, 4, Go{7, {}}),
              "the robot sends");
  const auto first = moves.next(kPatience);
  tally.check(first && first->id == 2 && first->content.metres == 6, "a frame is read");
  const auto wrong = moves.next(kPatience);
  tally.check(!wrong && name(wrong.error().kind) == "invalid_content" &&
                  to_string(wrong.error()).find("wrong_type at `metres`") != std::string::npos,
              "a frame that does not read is an error");
  const auto next = moves.next(kPatience);
  tally.check(next && next->content.metres == 7 && moves.missed() == 0, "the next one is read");
  app.close();
  auto last = states.next(kPatience);
  while (last && last->status != fc_runtime::ConnectionStatus::Closed) {
    last = states.next(kPatience);
  }
  tally.check(last && last->connects == 1 && last->why.kind == fc_runtime::LossKind::Here,
              "the last state has the reason");
}

/// Allowed networks and commands.
void allowed(Tally& tally) {
  ServerConfig config = free_ports();
  config.allow = {{"10.0.0.0/8", {}}};
  const auto closed = *Server::bind(protocol(), service(), config);
  const auto none = Connection::connect_lazy(protocol(), to(closed.command_port()));
  CallOptions patient;
  patient.timeout = kPatience;
  auto states = none.states();
  while (closed.counters().connections_forbidden == 0) {
    if (!states.next(kPatience)) break;
  }
  tally.check(closed.counters().connections_forbidden > 0, "nobody comes from here");
  config.allow = {{"127.0.0.0/8", {fc_runtime::Effect::Motion}},
                  {"127.0.0.1", {fc_runtime::Effect::Read}}};
  const auto open = *Server::bind(protocol(), service(), config);
  const Connection app = connected(open);
  tally.check(bool(app.call(Echo{"hello", {}})), "the smallest network holds: reads are allowed");
  const auto moved = app.call(Go{1, {}});
  tally.check(!moved && moved.error().refusal && moved.error().refusal->code == 2001,
              "a motion is not");
  tally.check(open.counters().calls_forbidden == 1 && open.counters().calls_succeeded == 1 &&
                  open.counters().calls_protocol == 1,
              "and has no handler");
  for (const char* wrong : {"10.0.0.0/33", "ten", "10.0.0.0/", "10.0.0.0/8x", "::/129"}) {
    config.allow = {{wrong, {}}};
    tally.check(!Server::bind(protocol(), service(), config), wrong);
  }
}

/// A robot that goes down during a call and comes back.
void losses(Tally& tally) {
  const tests::Listener robot;
  ClientConfig config = to(robot.port());
  config.first_id = 500;
  const auto app = Connection::connect_lazy(protocol(), config);
  auto read = std::async(std::launch::async, [&] { return app.call(Echo{"read", {}}); });
  Frames first(robot.accept(), protocol());
  const auto asked = first.receive();
  tally.check(asked && asked->first == FrameId{false, 1, tests::kEcho, 500}, "the read is sent");
  auto motion = std::async(std::launch::async, [&] { return app.call(Go{1, {}}); });
  const auto moved = first.receive();
  tally.check(moved && moved->first.code == tests::kGo, "the motion is sent");
  first.socket().reset();
  const auto lost = motion.get();
  tally.check(!lost && lost.error().name() == "lost", "the motion is lost");
  Frames second(robot.accept(), protocol());
  const auto again = second.receive();
  tally.check(again && asked && again->first == asked->first, "the read is sent again");
  second.send({true, 1, tests::kEcho, 500}, R"({"resultCode":1001,"text":"read"})");
  const auto answer = read.get();
  tally.check(answer && answer->text == "read", "and answered");
  // Invalid bytes end the connection, and the client reconnects.
  second.socket().send("HTTP/1.1 200 OK\r\n\r\n");
  Frames third(robot.accept(), protocol());
  auto states = app.states();
  auto state = app.state();
  while (state.connects < 3) state = states.next(kPatience).value_or(state);
  tally.check(state.connects == 3, "a third connection");
  // A response of the wrong type, a broken one, one nested without end, and a correct one.
  for (const char* broken :
       {R"({"resultCode":1001})", "[1]", "", R"({"resultCode":"x","text":1})"}) {
    auto call = std::async(std::launch::async, [&] { return app.call(Echo{"x", {}}); });
    const auto request = third.receive();
    third.send({true, 1, tests::kEcho, request->first.id}, broken);
    const auto outcome = call.get();
    tally.check(!outcome && outcome.error().name() == "invalid_response", broken);
  }
  auto deep = std::async(std::launch::async, [&] { return app.call(Echo{"x", {}}); });
  third.send({true, 1, tests::kEcho, third.receive()->first.id},
             R"({"resultCode":1001,"deep":)" + std::string(100'000, '['));
  const auto too_deep = deep.get();
  tally.check(!too_deep && too_deep.error().body->name() == "too_deep", "100,000 brackets");
  auto broken = std::async(std::launch::async, [&] { return app.call(Echo{"x", {}}); });
  const auto request = third.receive();
  std::string bytes;
  tally.check(bool(fc_runtime::Encoder(protocol())
                       .append(bytes, {true, 1, tests::kEcho, request->first.id}, "{}")),
              "a frame");
  bytes.back() = '!';
  third.socket().send(bytes);
  const auto outcome = broken.get();
  tally.check(!outcome && outcome.error().name() == "frame" &&
                  outcome.error().frame->name() == "bad_digest",
              "a broken frame");
  // The robot stops in the middle of a frame.
  const auto cancelled = app.call_async(
      Echo{"x", {}}, [&](const auto&) { tally.check(false, "a cancelled call is not told of"); });
  tally.check(bool(third.receive()), "a call is sent");
  cancelled.cancel();
  while (app.in_flight() > 0) std::this_thread::yield();
  app.close();
  tally.check(!third.receive(), "the app hangs up");
}

void stalls(Tally& tally) {
  const tests::Listener robot;
  ClientConfig config = to(robot.port());
  config.stall_timeout = milliseconds(100);
  config.reconnect.reset();
  const auto app = Connection::connect_lazy(protocol(), config);
  Frames peer(robot.accept(), protocol());
  auto call = std::async(std::launch::async, [&] { return app.call(Go{1, {}}); });
  tally.check(bool(peer.receive()), "a call");
  peer.socket().send("\xEE\xAA\x01");
  const auto outcome = call.get();
  tally.check(!outcome && outcome.error().name() == "lost" &&
                  outcome.error().loss->kind == LossKind::Stalled,
              "a frame that does not go on");
  const auto unreachable = Connection::connect(protocol(), to(1));
  tally.check(!unreachable && unreachable.error().kind == LossKind::Unreachable, "nobody there");
}

/// Misbehaving apps.
void hostile(Tally& tally) {
  ServerConfig config = free_ports();
  config.header_timeout = milliseconds(100);
  const auto server = *Server::bind(protocol(), service(), config);
  const Connection good = connected(server);

  Frames garbage(tests::dial(server.command_port()), protocol());
  garbage.send({false, 1, tests::kEcho, 1}, R"({"text":"before"})");
  garbage.socket().send("garbage");
  const auto before = garbage.receive();
  tally.check(before && before->second.find("before") != std::string::npos,
              "what came before garbage is answered");
  tally.check(!garbage.receive(), "then it is closed");

  Frames brackets(tests::dial(server.command_port()), protocol());
  brackets.send({false, 1, tests::kEcho, 1}, std::string(100'000, '['));
  const auto refused = brackets.receive();
  tally.check(refused && refused->second.find("2003") != std::string::npos, "brackets are refused");
  std::string damaged;
  tally.check(
      bool(fc_runtime::Encoder(protocol()).append(damaged, {false, 1, tests::kEcho, 2}, "{}")),
      "a frame");
  damaged.back() = '!';
  brackets.socket().send(damaged);
  const auto answered = brackets.receive();
  tally.check(answered && answered->second.find("2001") != std::string::npos, "a damaged frame");
  brackets.send({false, 1, tests::kEcho, 3}, R"({"text":"still"})");
  brackets.socket().finish();
  const auto still = brackets.receive();
  tally.check(still && still->second.find("still") != std::string::npos,
              "who has closed his half is answered");
  tally.check(!brackets.receive(), "and then closed");

  const tests::Socket slow = tests::dial(server.command_port());
  slow.send("\xFC");
  tally.check(slow.receive().empty(), "a header that does not come");
  for (int at = 0; at < 20; ++at) tests::dial(server.command_port()).reset();
  const auto echo = good.call(Echo{"fine", {}});
  tally.check(echo && echo->text == "fine", "others go on");

  std::vector<Frames> many;
  for (int at = 0; at < 7; ++at) {
    many.emplace_back(tests::dial(server.command_port()), protocol());
    many.back().send({false, 1, tests::kEcho, 1}, R"({"text":"here"})");
    tally.check(bool(many.back().receive()), "as many as may come from one address");
  }
  tally.check(tests::dial(server.command_port()).receive().empty(), "and not one more");
  tally.check(server.counters().connections_refused == 1, "which is counted");
}

/// Silent connections do not keep apps out.
void silent(Tally& tally) {
  ServerConfig few = free_ports();
  few.limits = protocol().defaults.limits;
  few.limits->connections = 8;
  few.connections_per_address = 100;
  for (const ServerConfig& config : {free_ports(), few}) {
    const auto server = *Server::bind(protocol(), service(), config);
    std::vector<tests::Socket> commands;
    std::vector<tests::Socket> streams;
    for (int at = 0; at < 8; ++at) {
      commands.push_back(tests::dial(server.command_port()));
      streams.push_back(tests::dial(server.data_port()));
    }
    // The app has not sent anything yet.
    const tests::Socket early = tests::dial(server.data_port());
    tally.check(streams.front().receive().empty(), "the oldest silent data connection gives way");
    const Connection app = connected(server);
    tally.check(commands.front().receive().empty(), "the oldest silent connection gives way");
    tally.check(bool(app.call(Echo{"hello", {}})), "to an app, which is served");
    tally.check(server.counters().connections_displaced == 2, "both are counted");
    tally.check(server.counters().connections_refused == 0, "and nobody is refused");
    tally.check(server.connections().size() == 8, "there are as many as there may be");
  }
}

/// An exception that does not derive from `std::exception`.
struct Odd {};

/// Throws as requested.
Handled throwing(const Context& context, std::string_view text) {
  return fc_runtime::serve<Echo, Echo>(
      protocol(), context, text, [](const Context&, const Echo& request) -> Result<Echo, Refusal> {
        if (request.text == "secret range") {
          return Echo{std::to_string(std::vector<int>().at(request.text.size())), {}};
        }
        if (request.text == "secret number") throw 42;
        if (request.text == "secret odd") throw Odd();
        if (request.text == "secret body") return Echo{"\xFF", {}};
        if (request.text == "secret long") return Echo{std::string(1U << 16U, 'x'), {}};
        return request;
      });
}

void handler_errors(Tally& tally) {
  Lines lines;
  std::mutex mutex;
  std::vector<std::pair<std::exception_ptr, std::uint32_t>> told;
  ServerConfig config = free_ports();
  config.limits = protocol().defaults.limits;
  config.limits->frame_bytes = 1U << 15U;
  config.log = lines.log();
  config.on_handler_error = [&](const std::exception_ptr& error, const Context& context) {
    const std::lock_guard held(mutex);
    told.emplace_back(error, context.id);
    if (told.size() == 1) throw Odd();
  };
  const auto server = *Server::bind(protocol(), throwing, config);
  ClientConfig there = to(server.command_port());
  there.first_id = 500;
  const auto app = *Connection::connect(protocol(), there);
  for (const char* text :
       {"secret range", "secret number", "secret odd", "secret body", "secret long"}) {
    const auto failed = app.call(Echo{text, {}});
    tally.check(!failed && failed.error().refusal && failed.error().refusal->code == 2001,
                std::string(text) + " is answered");
  }
  const auto echo = app.call(Echo{"hello", {}});
  tally.check(echo && echo->text == "hello", "the robot lives");
  tally.check(server.counters().handlers_panicked == 5, "errors are counted");
  for (const char* part : {"error toy: the handler of `echo` threw `std::out_of_range`",
                           "error toy: the handler of `echo` threw `int`",
                           "error toy: the handler of `echo` threw `(anonymous namespace)::Odd`",
                           "error toy: the response to `echo` cannot be sent: not_utf8 at `text`",
                           "error toy: the response to `echo` cannot be sent: frame_too_long",
                           "error toy: `on_handler_error` threw `(anonymous namespace)::Odd`"}) {
    tally.check(lines.has(part), part);
  }
  tally.check(!lines.has_now("secret"), "no contents of a body");
  const std::lock_guard held(mutex);
  tally.check(told.size() == 5 && told[0].second == 500 && told[3].second == 503,
              "the hook has each error with its call");
  try {
    std::rethrow_exception(told.at(3).first);
  } catch (const fc_runtime::UnsendableResponse& error) {
    tally.check(std::string(error.what()).find("not_utf8") == 0, "and what is wrong");
  } catch (...) {
    tally.check(false, "a response that breaks the spec has an error of its own");
  }
}

/// An exception of a callback harms neither an app nor a robot.
void callbacks_throw(Tally& tally) {
  ServerConfig config = free_ports();
  Lines lines;
  const fc_runtime::Log log = lines.log();
  // The log function may throw as well.
  config.log = [log](fc_runtime::LogLevel level, std::string_view line) {
    log(level, line);
    throw Odd();
  };
  const auto server = *Server::bind(protocol(), service(), config);
  ClientConfig there = to(server.command_port());
  there.log = config.log;
  const auto app = *Connection::connect(protocol(), there);
  app.call_async(Echo{"secret", {}}, [](const auto&) { throw Odd(); });
  tally.check(lines.has("error toy: the callback of `echo` threw"), "a callback of a call");
  const auto queue = app.reports();
  tally.check(bool(app.call(Echo{"hello", {}})), "the app lives");
  tally.check(bool(server.push_async(Go{1, {}},
                                     [](const std::vector<fc_runtime::AckOutcome>&) { throw 42; })),
              "a report is queued");
  tally.check(lines.has("error toy: a callback of a report threw `int`"), "its callback");
  tally.check(bool(app.call(Echo{"hello", {}})), "the robot lives");
  tally.check(!lines.has_now("secret"), "no contents of a body");
}

/// A flood of errors does not flood the log.
void log_flood(Tally& tally) {
  std::atomic<int> lines{0};
  ServerConfig config = free_ports();
  config.log = [&](fc_runtime::LogLevel, std::string_view) { ++lines; };
  const auto server = *Server::bind(
      protocol(), [](const Context&, std::string_view) -> Handled { throw Odd(); }, config);
  const Connection app = connected(server);
  for (std::uint16_t code = 400; code < 420; ++code) {
    tally.check(bool(app.call_body(code, "{}")), "each is answered");
  }
  tally.check(lines == 5 && server.counters().handlers_panicked == 20, "five lines for 20 errors");
}

/// Apps cannot make a robot exceed its memory limit.
void memory(Tally& tally) {
  ServerConfig config = free_ports();
  config.memory = std::size_t{256} << 10U;
  const auto server = *Server::bind(protocol(), service(), config);
  const Connection app = connected(server);
  tally.check(bool(app.call(Echo{"hello", {}})), "it is connected");
  std::string frame;
  tally.check(bool(fc_runtime::Encoder(protocol())
                       .append(frame, {false, 1, tests::kEcho, 1}, std::string(2U << 20U, ' '))),
              "a frame of 2 MiB");
  const tests::Socket commands = tests::dial(server.command_port());
  commands.send(std::string_view(frame).substr(0, 1U << 20U));
  tally.check(commands.receive().empty(), "who holds most is closed");
  const tests::Socket streams = tests::dial(server.data_port());
  streams.send(std::string_view(frame).substr(0, 1U << 20U));
  tally.check(streams.receive().empty(), "also at the data port");
  tally.check(server.counters().connections_evicted == 2, "both are counted");
  tally.check(bool(app.call(Echo{"hello", {}})), "others go on");
}

/// Requests of disconnected apps do not begin.
void gone(Tally& tally) {
  Door door;
  std::atomic<int> begun{0};
  const auto handles = service(&door);
  ServerConfig config = free_ports();
  config.handler_threads = 1;
  const auto server = *Server::bind(
      protocol(),
      [&](const Context& context, std::string_view text) {
        if (text.find("late") != std::string_view::npos) ++begun;
        return handles(context, text);
      },
      config);
  const Connection app = connected(server);
  auto waits = std::async(std::launch::async, [&] { return app.call(Go{1, {}}); });
  tally.check(door.has(1), "the only thread is busy");
  {
    Frames other(tests::dial(server.command_port()), protocol());
    const std::uint64_t before = server.counters().bytes_in;
    other.send({false, 1, tests::kEcho, 1}, R"({"text":"late"})");
    while (server.counters().bytes_in == before) std::this_thread::yield();
    other.socket().reset();
  }
  while (server.connections().size() > 1) std::this_thread::yield();
  door.open();
  tally.check(bool(waits.get()), "the first is answered");
  tally.check(bool(app.call(Echo{"hello", {}})) && begun == 0, "the other has not begun");
}

/// At the limit of abandoned handlers, no more begin.
void abandoned(Tally& tally) {
  Door door;
  ServerConfig config = free_ports();
  config.handler_timeout = milliseconds(50);
  config.abandoned_handlers = 2;
  const auto server = *Server::bind(protocol(), service(&door), config);
  const Connection app = connected(server);
  for (int at = 0; at < 2; ++at) {
    const auto late = app.call(Go{1, {}});
    tally.check(!late && late.error().refusal->code == 2002, "a handler that takes too long");
  }
  const auto refused = app.call(Go{1, {}});
  tally.check(!refused && refused.error().refusal->code == 2001, "one too many");
  tally.check(server.counters().abandoned_reached == 1, "it is counted");
  door.open();
}

void settings(Tally& tally) {
  using Change = std::function<void(ServerConfig&)>;
  for (const auto& [name, change] : std::vector<std::pair<std::string, Change>>{
           {"address", [](ServerConfig& it) { it.address = ""; }},
           {"address", [](ServerConfig& it) { it.address = "robot"; }},
           {"handler_timeout", [](ServerConfig& it) { it.handler_timeout = milliseconds(-1); }},
           {"handler_threads", [](ServerConfig& it) { it.handler_threads = 0; }},
           {"abandoned_handlers", [](ServerConfig& it) { it.abandoned_handlers = 0; }},
           {"max_age", [](ServerConfig& it) { it.max_age = milliseconds(-1); }},
           {"limits.frame_bytes", [](ServerConfig& it) { it.limits.emplace().frame_bytes = 0; }},
           {"limits.in_flight", [](ServerConfig& it) { it.limits.emplace().in_flight = 0; }},
           {"limits.connections", [](ServerConfig& it) { it.limits.emplace().connections = 0; }},
           {"limits.json_depth",
            [](ServerConfig& it) { it.limits.emplace().json_depth = 100'000; }},
           {"connections_per_address", [](ServerConfig& it) { it.connections_per_address = 0; }},
           {"gzip.level",
            [](ServerConfig& it) {
              it.gzip = fc_runtime::Gzip{0, 10};
            }},
           {"header_timeout", [](ServerConfig& it) { it.header_timeout = milliseconds(-1); }},
           {"stall_timeout", [](ServerConfig& it) { it.stall_timeout = milliseconds(-1); }},
           {"idle_timeout", [](ServerConfig& it) { it.idle_timeout = milliseconds(-1); }},
           {"keepalive", [](ServerConfig& it) { it.keepalive = milliseconds(-1); }},
           {"keepalive", [](ServerConfig& it) { it.keepalive = std::chrono::hours(24); }},
       }) {
    ServerConfig config = free_ports();
    change(config);
    const auto bound = Server::bind(protocol(), service(), config);
    tally.check(!bound && bound.error().detail.find("`ServerConfig::" + name + "`") == 0, name);
  }
  const auto server = *Server::bind(protocol(), service(), free_ports());
  using Other = std::function<void(ClientConfig&)>;
  for (const auto& [name, change] : std::vector<std::pair<std::string, Other>>{
           {"host", [](ClientConfig& it) { it.host = ""; }},
           {"host", [](ClientConfig& it) { it.host = " "; }},
           {"host", [](ClientConfig& it) { it.host = std::string("robot\0", 6); }},
           {"command_port", [](ClientConfig& it) { it.command_port = std::uint16_t{0}; }},
           {"data_port", [](ClientConfig& it) { it.data_port = std::uint16_t{0}; }},
           {"connect_timeout", [](ClientConfig& it) { it.connect_timeout = milliseconds(-1); }},
           {"call_timeout", [](ClientConfig& it) { it.call_timeout = milliseconds(-1); }},
           {"reconnect.first", [](ClientConfig& it) { it.reconnect->first = milliseconds(-1); }},
           {"reconnect.longest",
            [](ClientConfig& it) { it.reconnect->longest = milliseconds(-1); }},
           {"keepalive", [](ClientConfig& it) { it.keepalive = milliseconds(-1); }},
           {"stall_timeout", [](ClientConfig& it) { it.stall_timeout = milliseconds(-1); }},
           {"limits.inflated_bytes",
            [](ClientConfig& it) { it.limits.emplace().inflated_bytes = 0; }},
           {"gzip.level",
            [](ClientConfig& it) {
              it.gzip = fc_runtime::Gzip{0, 0};
            }},
       }) {
    ClientConfig config = to(server.command_port(), server.data_port());
    change(config);
    const auto app = Connection::connect(protocol(), config);
    tally.check(!app && app.error().kind == LossKind::Settings &&
                    app.error().detail.find("`ClientConfig::" + name + "`") == 0,
                name);
    const auto call = Connection::connect_lazy(protocol(), config).call(Echo{"hello", {}});
    tally.check(!call && call.error().name() == "closed", name + ", connected lazily");
  }
  // The longest time is limited by the clock.
  ClientConfig patient = to(server.command_port());
  patient.connect_timeout = patient.stall_timeout = milliseconds::max();
  patient.call_timeout = milliseconds::max();
  const auto app = *Connection::connect(protocol(), patient);
  const auto queue = app.reports();
  CallOptions options;
  options.timeout = milliseconds::max();
  tally.check(bool(app.call(Echo{"hello", {}}, options)), "a call that may take for ever");
  tally.check(bool(server.push_async(Go{1, {}}, nullptr)), "a report");
  tally.check(bool(queue->next(milliseconds::max())), "and who waits for it for ever");
  options.timeout = milliseconds(-1);
  const auto early = app.call(Echo{"hello", {}}, options);
  tally.check(!early && early.error().name() == "invalid_request", "a time below 0");
}

void shutdown(Tally& tally) {
  Door door;
  const auto server = *Server::bind(protocol(), service(&door), free_ports());
  ClientConfig config = to(server.command_port());
  config.reconnect.reset();
  const auto app = *Connection::connect(protocol(), config);
  std::vector<std::future<Result<Nothing, fc_runtime::CallError>>> moving;
  for (int at = 1; at <= 8; ++at) {
    moving.push_back(std::async(std::launch::async, [&, at] { return app.call(Go{at, {}}); }));
  }
  tally.check(door.has(8), "all are being handled");
  auto over = std::async(std::launch::async, [&] { server.shutdown(kPatience); });
  door.open();
  int answered = 0;
  for (auto& call : moving) answered += call.get() ? 1 : 0;
  over.get();
  tally.check(answered == 8, "what has begun is answered");
  const auto late = app.call(Echo{"late", {}});
  tally.check(!late, "and nothing more");

  // A handler that does not end does not block the shutdown.
  Door closed;
  const auto stubborn = *Server::bind(protocol(), service(&closed), free_ports());
  ClientConfig other = to(stubborn.command_port());
  other.reconnect.reset();
  const auto waiting = *Connection::connect(protocol(), other);
  auto call = std::async(std::launch::async, [&] { return waiting.call(Go{1, {}}); });
  tally.check(closed.has(1), "it is being handled");
  stubborn.shutdown(milliseconds(0));
  const auto lost = call.get();
  tally.check(!lost && lost.error().name() == "lost", "it is cut off");
  closed.open();
}

void handler_timeout(Tally& tally) {
  Door door;
  ServerConfig config = free_ports();
  config.handler_timeout = milliseconds(50);
  const auto server = *Server::bind(protocol(), service(&door), config);
  const Connection app = connected(server);
  const auto late = app.call(Go{1, {}});
  tally.check(!late && late.error().refusal && late.error().refusal->code == 2002,
              "a handler that takes too long");
  door.open();
  tally.check(bool(app.call(Go{1, {}})), "the next is in time");
}

}  // namespace

int main() {
  Tally tally;
  for (const auto test :
       {calls,     metrics, compressed, reports,   streams,  subscriptions,  stream_contents,
        allowed,   losses,  stalls,     hostile,   silent,   handler_errors, callbacks_throw,
        log_flood, memory,  gone,       abandoned, settings, shutdown,       handler_timeout}) {
    test(tally);
  }
  return tally.outcome("things over TCP", 300);
}
