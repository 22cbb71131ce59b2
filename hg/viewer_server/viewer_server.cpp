// The only file that includes Boost.Beast: it takes half a minute to compile.
#include "hg/viewer_server/viewer_server.h"

#ifdef __SANITIZE_THREAD__
#pragma GCC diagnostic ignored "-Wtsan"  // Asio's fences: unknown to the sanitizer, not needed here
#endif

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/viewer_server/access.h"
#include "hg/viewer_server/hub.h"
#include "hg/viewer_server/meshes.h"
#include "hg/viewer_server/messages.h"
#include "hg/viewer_server/page.h"
#include "hg/viewer_server/visitor.h"

namespace hg::viewer_server {

bool Hub::has_token(const Request& request) const {
  if (is_same_secret(query_value(view(request.target()), "token"), token)) return true;
  const std::string cookie = "hapticgiant_" + std::to_string(port);
  return is_same_secret(cookie_value(view(request[http::field::cookie]), cookie), token);
}

void Hub::join(const std::shared_ptr<Page>& page) {
  page->number = next_page++;
  pages.insert(page);
  clients = pages.size();
  for (const Text& event : events) page->tell(event);
  if (newest_frame) page->show(newest_frame);
}

void Hub::leave(const std::shared_ptr<Page>& page) {
  pages.erase(page);
  clients = pages.size();
  const std::lock_guard lock(hand_mutex);
  hand.leave(page->number);
}

void Hub::put_hand(std::uint64_t page, const HandTarget& target) {
  const std::lock_guard lock(hand_mutex);
  hand.put(page, target, now_s());
}

void Hub::show(Text frame) {
  newest_frame = std::move(frame);
  for (const auto& page : pages) page->show(newest_frame);
}

void Hub::announce(Text event) {
  if (events.size() == kMaxEvents) events.pop_front();
  events.push_back(event);
  for (const auto& page : pages) page->tell(event);
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kSendBuffer = 64 * 1024;  // bytes; small, so that what arrives is fresh
constexpr long kMaxConnections = 64;

tcp::acceptor listen_on(asio::io_context& context, std::uint16_t port) {
  tcp::acceptor acceptor(context);
  const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), port);
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error == asio::error::address_in_use) {
    throw SetupError("viewer: port " + std::to_string(port) +
                     " is taken; choose another one, or 0 for any that is free");
  }
  if (error) {
    throw SetupError("viewer: port " + std::to_string(port) + ": " + error.message());
  }
  return acceptor;
}

}  // namespace

struct ViewerServer::Impl {
  Impl(const Options& options, const Scene& scene)
      : limits(scene.limits),
        period(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / options.update_rate_hz))),
        hub(scene.box),
        acceptor(listen_on(context, options.port)),
        retry(context) {
    hub.port = acceptor.local_endpoint().port();
    hub.token = options.token.empty() ? random_token() : options.token;
    hub.assets = load_page(options.page);
    hub.assets["/scene.json"] = {"application/json", encode_scene(scene, options.update_rate_hz)};
    if (!scene.device.urdf.empty()) {
      hub.assets[std::string(kDeviceAddress)] = {
          "application/xml", with_meshes(scene.device.urdf, "/models/device/", hub.assets)};
    }
    if (!scene.twin.urdf.empty()) {
      hub.assets[std::string(kTwinAddress)] = {
          "application/xml", with_meshes(scene.twin.urdf, "/models/twin/", hub.assets)};
    }
    accept();
    thread = std::thread([this] { context.run(); });
  }

  ~Impl() {
    context.stop();
    thread.join();
    hub.pages.clear();  // their sockets need the context
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error) {  // for example no file descriptor left: try again a little later
        retry.expires_after(std::chrono::milliseconds(200));
        retry.async_wait([this](error_code) { accept(); });
        return;
      }
      if (hub.connections.use_count() > kMaxConnections) {
        ++hub.refused;
      } else {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        socket.set_option(tcp::socket::send_buffer_size(kSendBuffer), ignored);
        std::make_shared<Visitor>(hub, std::move(socket))->read();
      }
      accept();
    });
  }

  // On the server's thread: takes what publish() left and sends it.
  void send_newest() {
    Outbox outbox;
    {
      const std::lock_guard lock(mutex);
      std::swap(outbox.frame, pending.frame);
      std::swap(outbox.events, pending.events);
      is_posted = false;
    }
    for (std::string& event : outbox.events) {
      hub.announce(std::make_shared<const std::string>(std::move(event)));
    }
    if (!outbox.frame) return;
    const NewestFrame& frame = *outbox.frame;
    hub.show(std::make_shared<const std::string>(
        encode_frame(frame.record, frame.hand, frame.cycle_time_us, frame.status_text, limits)));
  }

  // With the mutex held.
  void post_once() {
    if (std::exchange(is_posted, true)) return;
    asio::post(context, [this] { send_newest(); });
  }

  struct NewestFrame {
    CycleRecord record;
    HandTarget hand;
    double cycle_time_us;
    std::string status_text;
  };

  // What waits for the server's thread.
  struct Outbox {
    std::unique_ptr<NewestFrame> frame;
    std::vector<std::string> events;
  };

  const LimitCatalogue limits;
  const Clock::duration period;
  Clock::time_point due;  // of the next frame; only the caller of publish() uses it
  std::mutex mutex;       // guards pending and is_posted
  Outbox pending;
  bool is_posted = false;

  Hub hub;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer retry;
  std::thread thread;
};

namespace {

void check(const Options& options) {
  if (!std::isfinite(options.update_rate_hz) || options.update_rate_hz <= 0.0) {
    throw SetupError("viewer: update_rate_hz must be positive, got " +
                     std::to_string(options.update_rate_hz));
  }
  if (options.token.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw SetupError("viewer: token must be hexadecimal digits");
  }
}

}  // namespace

ViewerServer::ViewerServer(const Options& options, const Scene& scene) {
  check(options);
  check(scene);
  impl_ = std::make_unique<Impl>(options, scene);
}

ViewerServer::~ViewerServer() = default;

std::string ViewerServer::url() const {
  return "http://127.0.0.1:" + std::to_string(impl_->hub.port) + "/?token=" + impl_->hub.token;
}

void ViewerServer::publish(const Sample& sample, std::string_view status_text) {
  const Clock::time_point now = Clock::now();
  if (now < impl_->due) return;
  // half a period of slack, so that a caller at just this rate loses nothing by jitter
  impl_->due = std::max(impl_->due + impl_->period, now + impl_->period / 2);

  auto frame = std::make_unique<Impl::NewestFrame>(
      Impl::NewestFrame{sample.record, sample.operator_input.hand_target, sample.cycle_time_us,
                        std::string(status_text)});
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.frame = std::move(frame);
  impl_->post_once();
}

void ViewerServer::announce_event(double time_s, std::string_view name, std::string_view text) {
  std::string event = encode_event(time_s, name, text);
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.events.push_back(std::move(event));
  impl_->post_once();
}

bool ViewerServer::take_hand_target(HandTarget& target) {
  const std::lock_guard lock(impl_->hub.hand_mutex);
  return impl_->hub.hand.take(target, now_s());
}

Counters ViewerServer::counters() const {
  const Hub& hub = impl_->hub;
  return {hub.clients, hub.sent, hub.dropped, hub.refused};
}

}  // namespace hg::viewer_server
