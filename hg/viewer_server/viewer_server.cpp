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
#include "hg/live/session.h"
#include "hg/viewer_server/access.h"
#include "hg/viewer_server/desk_commands.h"
#include "hg/viewer_server/hub.h"
#include "hg/viewer_server/live_client.h"
#include "hg/viewer_server/meshes.h"
#include "hg/viewer_server/messages.h"
#include "hg/viewer_server/page.h"
#include "hg/viewer_server/visitor.h"

namespace hg::viewer_server {

Hub::Hub(const Eigen::AlignedBox3d& limits) : hand(limits) {
  board.session = random_token().substr(0, 8);
  board.find_asset = [this](std::string_view name) -> live::Bytes {
    const auto address = live_assets.find(name);
    if (address == live_assets.end()) return nullptr;
    const auto asset = assets.find(address->second);
    return asset == assets.end() ? nullptr : asset->second.content;
  };
}

bool Hub::has_token(const Request& request) const {
  if (websocket::is_upgrade(request) && path_of(view(request.target())) == kLivePath) {
    return is_same_secret(query_token(view(request.target())), token);
  }
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

void Hub::note_round_trip() {
  double slowest = -1.0;
  for (const auto& page : pages) slowest = std::max(slowest, page->pings.round_trip_s());
  round_trip_s = slowest >= 0.0 ? slowest : kUnknown;
}

void Hub::leave(const std::shared_ptr<Page>& page) {
  pages.erase(page);
  note_round_trip();
  clients = pages.size();
  let_go(page->number);
}

void Hub::join(const std::shared_ptr<LiveClient>& client) {
  client->number = next_page++;
  live_clients.insert(client);
  live_count = live_clients.size();
}

void Hub::leave(const std::shared_ptr<LiveClient>& client) {
  live_clients.erase(client);
  live_count = live_clients.size();
  note_wanted();
  let_go(client->number);
}

void Hub::let_go(std::uint64_t number) {
  if (desk != nullptr) desk->leave(number);
  const std::lock_guard lock(input_mutex);
  hand.leave(number);
  wrench.leave(number);
}

void Hub::note_wanted() {
  live::Wanted all;
  for (const auto& client : live_clients) {
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = all[i] || client->wants(i);
  }
  wanted = all.to_ulong();
}

void Hub::put_wrench(std::uint64_t client, const Vector6& w) {
  const std::lock_guard lock(input_mutex);
  if (w.isZero(0.0)) return wrench.leave(client);
  wrench.put(client, w, now_s());
}

void Hub::warn(std::uint64_t client, std::string_view text) {
  for (const auto& candidate : live_clients) {
    if (candidate->number != client) continue;
    candidate->answer({live::Session::status(live::Session::kWarning, text)});
  }
}

void Hub::show(const live::Batch& batch) {
  for (const auto& client : live_clients) {
    if (batch.time_ns != 0) client->show(live::Session::time_frame(batch.time_ns));
    for (const live::Message& message : batch.messages) client->show(message);
  }
}

void Hub::latch(const live::Message& message) {
  board.latched[message.channel] = message;
  for (const auto& client : live_clients) client->show(message);
}

void Hub::set_parameters(const std::vector<double>& present) {
  std::vector<std::string> changed;
  for (std::size_t i = 0; i < std::min(present.size(), board.parameters.size()); ++i) {
    live::Parameter& parameter = board.parameters[i];
    if (std::exchange(parameter.value, present[i]) != present[i]) changed.push_back(parameter.name);
  }
  if (changed.empty()) return;
  for (const auto& client : live_clients) client->send_changes(changed);
}

void Hub::put_hand(std::uint64_t page, const HandTarget& target) {
  const std::lock_guard lock(input_mutex);
  hand.put(page, target, now_s());
}

bool Hub::follows(CommandName name) const {
  return std::ranges::find(followed, name) != followed.end();
}

bool Hub::put_command(Command command) {
  const std::lock_guard lock(input_mutex);
  if (commands.size() >= (command.is_done ? kMaxDone : kMaxCommands)) return false;
  commands.push_back(std::move(command));
  return true;
}

std::string Hub::ask_for_hand(std::uint64_t page) {
  const std::lock_guard lock(input_mutex);
  return hand.ask(page, now_s()) ? "" : "no other page has the hand";
}

HandHolder Hub::holder() {
  const std::lock_guard lock(input_mutex);
  return hand.holder(now_s());
}

std::optional<std::string> Hub::take(Command command, MessageRate& rate) {
  if (command.name == CommandName::kAskForHand && follows(command.name)) {
    return rate.admit(now_s()) ? ask_for_hand(command.page) : "too many commands";
  }
  if (command.name == CommandName::kClutch && follows(command.name)) {
    const std::uint64_t page = holder().page;
    if (page != 0 && page != command.page) {
      return "page " + std::to_string(page) + " has the hand";
    }
  }
  if (desk != nullptr) {
    const auto answer = obey_at_desk(command, followed, now_ns(), *desk);
    command.stops = desk->stops();
    if (answer) {
      command.is_done = answer->empty();
      if (command.is_done) put_command(command);  // reported to the program if there is room
      return answer;
    }
  }
  if (!rate.admit(now_s())) return "too many commands";
  if (!put_command(std::move(command))) return "too many commands are waiting";
  return std::nullopt;
}

void Hub::answer(std::uint64_t page, double id, std::string_view refusal) {
  for (const auto& candidate : pages) {
    if (candidate->number == page) candidate->answer(id, refusal);
  }
  for (const auto& candidate : live_clients) {
    if (candidate->number == page) candidate->answer(id, refusal);
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

constexpr std::string_view kLiveAssets = "package://hapticgiant";
constexpr std::size_t kMostBatches = 100;  // waiting for the server's thread
constexpr int kSendBuffer = 64 * 1024;     // bytes; small, so that what arrives is fresh

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
              AssetTable& assets, MeshAddresses& live_assets) {
  if (chain.urdf.empty()) return;
  const std::string text = chain.urdf_text.empty() ? read_file(chain.urdf) : chain.urdf_text;
  MeshAddresses meshes;
  assets[std::string(address)] = {
      "application/xml", live::to_bytes(with_meshes(chain.urdf, text, folder, assets, meshes))};
  live_assets.merge(meshes);
  // live clients fetch meshes by their names
  const std::string original = std::string(folder) + "original.urdf";
  assets[original] = {"application/xml",
                      live::to_bytes(chain.live_text.empty() ? text : chain.live_text)};
  live_assets[std::string(kLiveAssets) + std::string(address.substr(address.rfind('/')))] =
      original;
}

// Assets of a scene, those of the live interface by the names of the meshes in the URDFs.
AssetTable assets_of(const Scene& scene, double update_rate_hz, MeshAddresses& live_assets) {
  AssetTable assets;
  assets["/scene.json"] = {"application/json", live::to_bytes(encode_scene(scene, update_rate_hz))};
  add_urdf(scene.device, kDeviceAddress, "/models/device/", assets, live_assets);
  add_urdf(scene.twin, kTwinAddress, "/models/twin/", assets, live_assets);
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
    hub.content_policy = content_policy(options.embedders);
    hub.assets = load_page(options.page);
    take(new_scene(scene, update_rate_hz));
    accept();
    thread = std::thread([this] { context.run(); });
    pthread_setname_np(thread.native_handle(), "page server");
  }

  ~Impl() {
    context.stop();
    thread.join();
    hub.pages.clear();  // their sockets need the context
    hub.live_clients.clear();
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
    MeshAddresses live_assets;
  };

  static NewScene new_scene(const Scene& scene, double update_rate_hz) {
    NewScene next{.scene = scene, .assets = {}, .live_assets = {}};
    next.assets = assets_of(scene, update_rate_hz, next.live_assets);
    return next;
  }

  struct Answer {
    std::uint64_t page;
    double id;
    std::string refusal;
  };
  struct Warning {
    std::uint64_t client;
    std::string text;
  };

  // Items waiting for the server's thread, in the order of processing.
  struct Outbox {
    std::unique_ptr<NewScene> scene;
    std::vector<std::string> events;
    std::vector<Answer> answers;
    std::vector<Warning> warnings;
    std::optional<std::vector<double>> values;
    std::unique_ptr<View> view;
    std::vector<live::Message> latched;
    std::vector<live::Batch> batches;
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
    hub.live_assets = std::move(scene.live_assets);
    hub.board.parameters.clear();
    std::vector<std::string> names;
    for (const Setting& setting : scene.scene.settings) {
      hub.board.parameters.push_back(
          {setting.name, setting.unit, setting.value, setting.min, setting.max});
      names.push_back(setting.name);
    }
    for (const auto& client : hub.live_clients) client->send_changes(names);
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
      hub.answer(answer.page, answer.id, answer.refusal);
    }
    for (const Warning& warning : outbox.warnings) hub.warn(warning.client, warning.text);
    for (const live::Message& message : outbox.latched) hub.latch(message);
    for (const live::Batch& batch : outbox.batches) hub.show(batch);
    if (outbox.values) {
      hub.set_parameters(*outbox.values);
      hub.values = to_text(encode_values(*outbox.values));
      for (const auto& page : hub.pages) page->notify(hub.values);
    }
    if (outbox.view && hub.desk != nullptr) {
      outbox.view->safety.stop_pressed_by = hub.desk->stop_pressed_by();
    }
    if (outbox.view) {
      hub.show(to_text(encode_frame(*outbox.view, limits, hub.pages.size(), hub.holder())));
    }
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
  for (const std::string& origin : options.embedders) {
    if (is_web_origin(origin)) continue;
    throw SetupError("viewer: a page that shows this one must have an origin like " +
                     std::string(kOriginExample) + ", got '" + origin + "'");
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
  auto next = std::make_unique<Impl::NewScene>(Impl::new_scene(scene, impl_->update_rate_hz));
  impl_->run = scene.run;
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.scene = std::move(next);
  impl_->pending.events.clear();
  impl_->pending.view.reset();
  impl_->pending.batches.clear();
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
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.values = values;
  impl_->post_once();
}

bool ViewerServer::take_hand_target(HandTarget& target) {
  const std::lock_guard lock(impl_->hub.input_mutex);
  return impl_->hub.hand.take(target, now_s());
}

bool ViewerServer::take_reference_wrench(Vector6& w, std::uint64_t& client) {
  const std::lock_guard lock(impl_->hub.input_mutex);
  return impl_->hub.wrench.take(w, client, now_s());
}

void ViewerServer::warn(std::uint64_t client, std::string_view text) {
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.warnings.push_back({client, std::string(text)});
  impl_->post_once();
}

bool ViewerServer::has_live_clients() const { return impl_->hub.live_count > 0; }

live::Wanted ViewerServer::live_wanted() const { return impl_->hub.wanted.load(); }

void ViewerServer::publish_live(live::Batch batch) {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->pending.batches.size() == kMostBatches) {  // the server's thread does not run
    impl_->pending.batches.erase(impl_->pending.batches.begin());
    ++impl_->hub.dropped;
  }
  impl_->pending.batches.push_back(std::move(batch));
  impl_->post_once();
}

void ViewerServer::latch_live(live::Message message) {
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.latched.push_back(std::move(message));
  impl_->post_once();
}

std::vector<Command> ViewerServer::take_commands() {
  const std::lock_guard lock(impl_->hub.input_mutex);
  return std::exchange(impl_->hub.commands, {});
}

void ViewerServer::answer(const Command& command, std::string_view refusal) {
  if (!refusal.empty()) ++impl_->hub.refused;
  const std::lock_guard lock(impl_->mutex);
  impl_->pending.answers.push_back({command.page, command.id, std::string(refusal)});
  impl_->post_once();
}

Counters ViewerServer::counters() const {
  const Hub& hub = impl_->hub;
  return {hub.clients, hub.live_count, hub.sent, hub.dropped, hub.refused, hub.round_trip_s};
}

}  // namespace hg::viewer_server
