// The only file that includes Boost.Beast: it takes half a minute to compile.
#include "hg/viewer_server/viewer_server.h"

#ifdef __SANITIZE_THREAD__
#pragma GCC diagnostic ignored "-Wtsan"  // Asio's fences: unknown to the sanitizer, not needed here
#endif

#include <pthread.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/viewer_server/access.h"
#include "hg/viewer_server/hub.h"
#include "hg/viewer_server/meshes.h"
#include "hg/viewer_server/messages.h"
#include "hg/viewer_server/page.h"
#include "hg/viewer_server/visitor.h"

namespace hg::viewer_server {

bool Hub::has_token(const Request& request) const {
  return websocket::is_upgrade(request)
             ? is_same_secret(protocol_token(view(request[http::field::sec_websocket_protocol])),
                              token)
             : is_same_secret(bearer_token(view(request[http::field::authorization])), token);
}

void Hub::admit_stranger(const std::shared_ptr<Visitor>& visitor) {
  std::erase_if(strangers, [](const auto& stranger) { return stranger.expired(); });
  if (strangers.size() == kMostStrangers) {
    ++refused;
    if (const auto oldest = strangers.front().lock()) oldest->drop();
    strangers.pop_front();
  }
  strangers.push_back(visitor);
}

std::shared_ptr<int> Hub::make_known(const Visitor* visitor) {
  if (known.use_count() > kMostKnown) return {};
  std::erase_if(strangers, [=](const auto& one) { return one.lock().get() == visitor; });
  return known;
}

void Hub::join(const std::shared_ptr<Page>& page) {
  page->number = next_page++;
  pages.insert(page);
  clients = pages.size();
  page->notify(to_text(encode_welcome(page->number)));
  for (const Text& event : events) page->notify(event);
  if (values) page->notify(values);
  if (newest_frame) page->show(newest_frame);
}

void Hub::leave(const std::shared_ptr<Page>& page) {
  pages.erase(page);
  clients = pages.size();
  if (desk != nullptr) desk->leave(page->number);
  const std::lock_guard lock(input_mutex);
  hand.leave(page->number);
}

void Hub::put_hand(std::uint64_t page, const HandTarget& target) {
  const std::lock_guard lock(input_mutex);
  hand.put(page, target, now_s());
}

bool Hub::put_command(Command command) {
  const std::lock_guard lock(input_mutex);
  if (commands.size() >= (command.is_done ? kMaxDone : kMaxCommands)) return false;
  commands.push_back(std::move(command));
  return true;
}

void Hub::answer(std::uint64_t page, const Text& answer) {
  for (const auto& candidate : pages) {
    if (candidate->number == page) candidate->notify(answer);
  }
}

void Hub::show(Text frame) {
  newest_frame = std::move(frame);
  for (const auto& page : pages) page->show(newest_frame);
}

void Hub::announce(const Text& event) {
  if (events.size() == kMaxEvents) events.pop_front();
  events.push_back(event);
  for (const auto& page : pages) page->notify(event);
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kSendBuffer = 64 * 1024;  // bytes; small, so that what arrives is fresh

tcp::acceptor listen_on(asio::io_context& context, const ServerOptions& options) {
  tcp::acceptor acceptor(context);
  error_code error;
  const tcp::endpoint endpoint(asio::ip::make_address(options.address, error), options.port);
  if (error) {
    throw SetupError("viewer: address must be an IP address of this machine, got '" +
                     options.address + "'");
  }
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error == asio::error::address_in_use) {
    throw SetupError("viewer: port " + std::to_string(options.port) +
                     " is taken; choose another one, or 0 for any that is free");
  }
  if (error) {
    throw SetupError("viewer: " + host_text(options.address, options.port) + ": " +
                     error.message());
  }
  return acceptor;
}

void add_urdf(const SceneChain& chain, std::string_view address, std::string_view folder,
              AssetTable& assets) {
  if (chain.urdf.empty()) return;
  const std::string text = chain.urdf_text.empty() ? read_file(chain.urdf) : chain.urdf_text;
  assets[std::string(address)] = {"application/xml", with_meshes(chain.urdf, text, folder, assets)};
}

// Assets of a scene.
AssetTable assets_of(const Scene& scene, double update_rate_hz) {
  AssetTable assets;
  assets["/scene.json"] = {"application/json", encode_scene(scene, update_rate_hz)};
  add_urdf(scene.device, kDeviceAddress, "/models/device/", assets);
  add_urdf(scene.twin, kTwinAddress, "/models/twin/", assets);
  return assets;
}

}  // namespace

struct ViewerServer::Impl {
  Impl(const ServerOptions& options, const Scene& scene)
      : update_rate_hz(options.update_rate_hz),
        period(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / options.update_rate_hz))),
        hub(scene.box),
        acceptor(listen_on(context, options)),
        retry(context) {
    const tcp::endpoint own = acceptor.local_endpoint();
    hub.listener = {own.address().to_string(), own.port()};
    hub.desk = options.desk;
    hub.token = options.token.empty() ? random_token() : options.token;
    hub.assets = load_page(options.page);
    take({scene, assets_of(scene, update_rate_hz)});
    accept();
    thread = std::thread([this] { context.run(); });
    pthread_setname_np(thread.native_handle(), "page server");
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
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      socket.set_option(tcp::socket::send_buffer_size(kSendBuffer), ignored);
      const auto visitor = std::make_shared<Visitor>(hub, std::move(socket));
      hub.admit_stranger(visitor);
      visitor->read();
      accept();
    });
  }

  struct NewScene {
    Scene scene;
    AssetTable assets;
  };

  struct Answer {
    std::uint64_t page;
    std::string text;
  };

  // Items waiting for the server's thread, in the order of processing.
  struct Outbox {
    std::unique_ptr<NewScene> scene;
    std::vector<std::string> events;
    std::vector<Answer> answers;
    std::optional<std::string> values;
    std::unique_ptr<View> view;
  };

  // On the server's thread, or before it runs.
  void take(NewScene scene) {
    std::erase_if(hub.assets,
                  [](const auto& asset) { return asset.first.starts_with("/models/"); });
    for (auto& [path, asset] : scene.assets) hub.assets[path] = std::move(asset);
    limits = scene.scene.limits;
    hub.followed = scene.scene.commands;
    hub.events.clear();
    hub.newest_frame.reset();
    const std::lock_guard lock(hub.input_mutex);
    hub.hand = HandTargetBox(scene.scene.box);
  }

  // On the server's thread: takes and sends what the other functions have queued.
  void send_newest() {
    Outbox outbox;
    {
      const std::lock_guard lock(mutex);
      std::swap(outbox, pending);
      is_posted = false;
    }
    if (outbox.scene) take(std::move(*outbox.scene));
    for (std::string& event : outbox.events) hub.announce(to_text(std::move(event)));
    for (Answer& answer : outbox.answers) {
      hub.answer(answer.page, to_text(std::move(answer.text)));
    }
    if (outbox.values) {
      hub.values = to_text(std::move(*outbox.values));
      for (const auto& page : hub.pages) page->notify(hub.values);
    }
    if (outbox.view && hub.desk != nullptr) {
      outbox.view->safety.stop_pressed_by = hub.desk->stop_pressed_by();
    }
    if (outbox.view) hub.show(to_text(encode_frame(*outbox.view, limits, hub.pages.size())));
  }

  // With the mutex held.
  void post_once() {
    if (std::exchange(is_posted, true)) return;
    asio::post(context, [this] { send_newest(); });
  }

  const double update_rate_hz;
  const Clock::duration period;
  Clock::time_point due;  // time of the next frame; only the caller of publish() uses it
  std::mutex mutex;       // guards pending and is_posted
  Outbox pending;
  bool is_posted = false;
  std::uint64_t run = 0;  // number of the newest scene; only the caller of set_scene() uses it
  LimitCatalogue limits;  // limits of the current scene

  Hub hub;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer retry;
  std::thread thread;
};

namespace {

void check_server_options(const ServerOptions& options) {
  if (!std::isfinite(options.update_rate_hz) || options.update_rate_hz <= 0.0) {
    throw SetupError("viewer: update_rate_hz must be positive, got " +
                     std::to_string(options.update_rate_hz));
  }
  if (options.token.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw SetupError("viewer: token must be hexadecimal digits");
  }
}

}  // namespace

ViewerServer::ViewerServer(const ServerOptions& options, const Scene& scene) {
  check_server_options(options);
  check_scene(scene);
  impl_ = std::make_unique<Impl>(options, scene);
  impl_->run = scene.run;
}

ViewerServer::~ViewerServer() = default;

std::string ViewerServer::url() const {
  const Listener& listener = impl_->hub.listener;
  const bool is_open = listener.address == "0.0.0.0" || listener.address == "::";
  return "http://" + host_text(is_open ? "127.0.0.1" : listener.address, listener.port) +
         "/#token=" + impl_->hub.token;
}

void ViewerServer::set_scene(const Scene& scene) {
  check_scene(scene);
  auto next = std::make_unique<Impl::NewScene>(
      Impl::NewScene{scene, assets_of(scene, impl_->update_rate_hz)});
  impl_->run = scene.run;
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.scene = std::move(next);
  impl_->pending.events.clear();
  impl_->pending.view.reset();
  impl_->post_once();
}

bool ViewerServer::is_due() const { return Clock::now() >= impl_->due; }

void ViewerServer::publish(View view) {
  const Clock::time_point now = Clock::now();
  if (now < impl_->due) return;
  // half a period of slack, so that a caller at just this rate loses nothing by jitter
  impl_->due = std::max(impl_->due + impl_->period, now + impl_->period / 2);

  auto newest = std::make_unique<View>(std::move(view));
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.view = std::move(newest);
  impl_->post_once();
}

void ViewerServer::announce_event(double time_s, std::string_view name, std::string_view text) {
  std::string event = encode_event(impl_->run, time_s, name, text);
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.events.push_back(std::move(event));
  impl_->post_once();
}

void ViewerServer::set_values(const std::vector<double>& values) {
  std::string text = encode_values(values);
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.values = std::move(text);
  impl_->post_once();
}

bool ViewerServer::take_hand_target(HandTarget& target) {
  const std::lock_guard lock(impl_->hub.input_mutex);
  return impl_->hub.hand.take(target, now_s());
}

std::vector<Command> ViewerServer::take_commands() {
  const std::lock_guard lock(impl_->hub.input_mutex);
  return std::exchange(impl_->hub.commands, {});
}

void ViewerServer::answer(const Command& command, std::string_view refusal) {
  std::string text = encode_answer(command.id, refusal);
  if (!refusal.empty()) ++impl_->hub.refused;
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.answers.push_back({command.page, std::move(text)});
  impl_->post_once();
}

Counters ViewerServer::counters() const {
  const Hub& hub = impl_->hub;
  return {hub.clients, hub.sent, hub.dropped, hub.refused};
}

}  // namespace hg::viewer_server
