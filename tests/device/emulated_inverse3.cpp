#include "tests/device/emulated_inverse3.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <list>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/physics/servo/scheduling.h"

namespace cavum::testing_device {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using nlohmann::json;

json json_of(Vec3 v) { return {{"x", v.x}, {"y", v.y}, {"z", v.z}}; }

/// The head of an unmasked text frame, RFC 6455 section 5.2, for 126 to 65,535 bytes.
std::string frame_head(std::size_t bytes) {
  return {static_cast<char>(0x81), static_cast<char>(126), static_cast<char>(bytes >> 8),
          static_cast<char>(bytes & 0xff)};
}

/// The other side has closed the line.
bool has_left(int socket) {
  pollfd look{.fd = socket, .events = POLLRDHUP, .revents = 0};
  return ::poll(&look, 1, 0) > 0;
}

}  // namespace

struct EmulatedInverse3::Line {
  explicit Line(asio::ip::tcp::socket socket)
      : cutter(::dup(socket.native_handle())), stream(std::move(socket)) {}
  ~Line() { ::close(cutter); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  void cut() const { ::shutdown(cutter, SHUT_RDWR); }

  const int cutter;  // the same socket for other threads, so that its number is not another's once
                     // the line is over
  beast::websocket::stream<asio::ip::tcp::socket> stream;
  std::set<std::string> pushed;  // ids of devices that it told a force
  std::thread thread;
};

struct EmulatedInverse3::Listener {
  asio::io_context context{1};
  asio::ip::tcp::acceptor acceptor{context};
  std::atomic<bool> stops{false};
  std::mutex mutex;
  std::list<Line> lines;
  std::thread thread;

  void cut_all() {
    const std::lock_guard lock(mutex);
    for (const Line& line : lines) line.cut();
  }
};

EmulatedInverse3::EmulatedInverse3(bool newer) : newer_(newer) { start(); }

EmulatedInverse3::~EmulatedInverse3() { stop(); }

void EmulatedInverse3::start() {
  listener_ = std::make_unique<Listener>();
  auto& acceptor = listener_->acceptor;
  acceptor.open(asio::ip::tcp::v4());
  acceptor.set_option(asio::socket_base::reuse_address(true));
  acceptor.bind({asio::ip::address_v4::loopback(), port_});
  acceptor.listen();
  port_ = acceptor.local_endpoint().port();
  listener_->thread = std::thread([this] { listen(); });
}

void EmulatedInverse3::stop() {
  if (!listener_) return;
  listener_->stops = true;
  ::shutdown(listener_->acceptor.native_handle(), SHUT_RDWR);
  listener_->thread.join();
  cut();
  for (Line& line : listener_->lines) line.thread.join();
  listener_.reset();
}

void EmulatedInverse3::cut() { listener_->cut_all(); }

void EmulatedInverse3::listen() {
  Listener& l = *listener_;
  while (!l.stops) {
    beast::error_code error;
    asio::ip::tcp::socket socket(l.context);
    l.acceptor.accept(socket, error);
    if (error) continue;
    socket.set_option(asio::ip::tcp::no_delay(true), error);
    const std::lock_guard lock(l.mutex);
    Line& line = l.lines.emplace_back(std::move(socket));
    line.thread = std::thread([this, &line] { serve(line); });
  }
}

void EmulatedInverse3::serve(Line& line) {
  ++lines_;
  static_cast<void>(ask_for_fifo(
      69));  // where the system allows it, so that what is measured is the stylus and not this
  try {
    line.stream.accept();
    reply(line, true);
    for (;;) {
      beast::flat_buffer buffer;
      line.stream.read(buffer);
      hear(line, beast::buffers_to_string(buffer.data()));
      reply(line, false);
    }
  } catch (const std::exception&) {  // closed or cut
  }
  {  // a client that has gone pushes no more
    const std::lock_guard lock(mutex_);
    for (const auto& id : line.pushed) {
      told_[id].force_n = {};
      told_[id].since = Clock::now();
    }
  }
  line.cut();
  --lines_;
}

void EmulatedInverse3::hear(Line& line, const std::string& text) {
  const json message = json::parse(text, nullptr, false);
  std::function<void()> moves;
  {
    const std::lock_guard lock(mutex_);
    moves = moves_;
  }
  if (moves) moves();
  const std::lock_guard lock(mutex_);
  try {
    for (const auto& device : message.at("inverse3")) {
      const std::string id = device.at("device_id");
      const json& force = device.at("commands").at("set_cursor_force");
      if (force.size() != 1 || devices_.count(id) == 0) throw std::invalid_argument("force");
      const json& v = force.begin().value();
      Told& told = told_[id];
      const Vec3 force_n{v.at("x"), v.at("y"), v.at("z")};
      if (!(force_n == told.force_n)) told.since = Clock::now();
      told.force_n = force_n;
      told.name = force.begin().key();
      ++told.count;
      line.pushed.insert(id);
    }
  } catch (const std::exception&) {
    ++wrong_;
  }
}

std::string EmulatedInverse3::state(bool first) const {
  json message = json::object();
  const std::lock_guard lock(mutex_);
  if (first && newer_) message["session_id"] = 7;
  json &devices = message["inverse3"] = json::array(),
       &wireless = message["wireless_verse_grip"] = json::array(),
       &wired = message["verse_grip"] = json::array();
  for (const auto& [id, d] : devices_) {
    json device{{"device_id", id},
                {"state",
                 {{"cursor_position", json_of(d.position_m)},
                  {"cursor_velocity", json_of({})},
                  {"control_mode", "idle"}}},
                {"status",
                 {{"calibrated", d.calibrated},
                  {"in_use", false},
                  {"power_supply", d.powered},
                  {"ready", true},
                  {"started", true}}}};
    if (first)
      device["config"] = {
          {"type", "inverse3"}, {"handedness", "right"}, {"basis", {{"permutation", "XYZ"}}}};
    devices.push_back(device);
  }
  for (const auto& [id, g] : grips_) {
    const json orientation{{"w", g.orientation.w},
                           {"x", g.orientation.x},
                           {"y", g.orientation.y},
                           {"z", g.orientation.z}};
    if (g.wired)
      wired.push_back({{"device_id", id},
                       {"state", {{"orientation", orientation}, {"hall", 0}, {"button", g.a}}}});
    else
      wireless.push_back({{"device_id", id},
                          {"state",
                           {{"orientation", orientation},
                            {"buttons", {{"a", g.a}, {"b", g.b}, {"c", false}}},
                            {"trial_level", 0.8}}}});
  }
  return message.dump();
}

void EmulatedInverse3::reply(Line& line, bool first) {
  std::string text = state(first);
  auto& stream = line.stream;
  stream.text(true);
  switch (answer_.load()) {
    case Answer::state:
      break;
    case Answer::nothing:
      return;
    case Answer::no_json:
      text = "\x01\x02 what is this?";
      break;
    case Answer::cut_short:
      text.resize(text.size() / 2);
      break;
    case Answer::another_json:
      text = R"({"inverse3":[{"device_id":7,"state":[]}]})";
      break;
    case Answer::too_large:
      text = R"({"inverse3":[],"more":")" + std::string(1 << 20, 'x') + "\"}";
      break;
    case Answer::too_deep:
      text = R"({"inverse3":)" + std::string(20000, '[') + std::string(20000, ']') + "}";
      break;
    case Answer::bytes:
      stream.binary(true);
      break;
    case Answer::far_away:
      text =
          R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e300,"y":0,"z":0}}}]})";
      break;
    case Answer::half:
    case Answer::in_two_parts: {
      const std::string frame = frame_head(text.size()) + text;
      asio::write(stream.next_layer(), asio::buffer(frame.data(), frame.size() / 2));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      while (answer_ == Answer::half && !has_left(stream.next_layer().native_handle()))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      asio::write(stream.next_layer(),
                  asio::buffer(frame.data() + frame.size() / 2, frame.size() - frame.size() / 2));
      return;
    }
  }
  stream.write(asio::buffer(text));
}

EmulatedInverse3::Told EmulatedInverse3::told(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = told_.find(id);
  return found == told_.end() ? Told{} : found->second;
}

Vec3 EmulatedInverse3::force_n(const std::string& id) const { return told(id).force_n; }

}  // namespace cavum::testing_device
