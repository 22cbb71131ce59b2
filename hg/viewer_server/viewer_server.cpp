// The only file that includes Boost.Beast: it takes half a minute to compile.
#include "hg/viewer_server/viewer_server.h"

#ifdef __SANITIZE_THREAD__
#pragma GCC diagnostic ignored "-Wtsan"  // Asio's fences: unknown to the sanitizer, not needed here
#endif

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/viewer_server/access.h"
#include "hg/viewer_server/hand_target_box.h"
#include "hg/viewer_server/message_rate.h"
#include "hg/viewer_server/messages.h"

namespace hg::viewer_server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Text = std::shared_ptr<const std::string>;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr auto kRequestTimeout = std::chrono::seconds(15);
constexpr std::uint32_t kLargestHeader = 8192;  // bytes
constexpr std::size_t kLargestMessage = 4096;   // bytes; a hand target has about 80
constexpr int kSendBuffer = 64 * 1024;          // bytes; small, so that what arrives is fresh
constexpr long kMaxConnections = 64;
constexpr std::size_t kMaxEvents = 200;  // kept for pages that connect later

constexpr std::string_view kContentPolicy =
    "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

double now_s() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

class Page;

// What all connections share. Everything but the counters and the hand target belongs to the
// server's thread.
struct Hub {
  explicit Hub(const Eigen::AlignedBox3d& limits) : hand(limits) {}

  bool has_token(const Request& request) const;
  void join(const std::shared_ptr<Page>& page);
  void leave(const std::shared_ptr<Page>& page);
  void put_hand(std::uint64_t page, const HandTarget& target);
  void show(Text frame);
  void announce(Text event);

  std::uint16_t port = 0;
  std::string token;
  AssetTable assets;
  std::set<std::shared_ptr<Page>> pages;
  std::deque<Text> events;
  Text newest_frame;
  std::uint64_t next_page = 1;
  std::shared_ptr<int> connections = std::make_shared<int>();  // one more owner per connection

  std::atomic<std::uint64_t> clients{0};
  std::atomic<std::uint64_t> sent{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::uint64_t> refused{0};
  std::mutex hand_mutex;
  HandTargetBox hand;
};

// One open page: sends all events and the newest frame, reads hand targets.
class Page : public std::enable_shared_from_this<Page> {
 public:
  Page(Hub& hub, beast::tcp_stream&& stream, std::shared_ptr<int> connection)
      : hub_(hub), socket_(std::move(stream)), connection_(std::move(connection)) {}

  void start(const Request& request) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kRequestTimeout, kRequestTimeout, true});
    socket_.read_message_max(kLargestMessage);
    socket_.text(true);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->hub_.join(self);
      self->read();
    });
  }

  // Replaces a frame that is still waiting.
  void show(Text frame) {
    if (frame_) ++hub_.dropped;
    frame_ = std::move(frame);
    write();
  }

  void tell(Text event) {
    if (events_.size() == kMaxEvents) {
      events_.pop_front();
      ++hub_.dropped;
    }
    events_.push_back(std::move(event));
    write();
  }

  std::uint64_t number = 0;

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        if (error == websocket::error::message_too_big) ++self->hub_.refused;
        self->hub_.leave(self);
        return;
      }
      self->listen();
      self->read();
    });
  }

  void listen() {
    const auto bytes = buffer_.cdata();
    const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
    HandTarget target;
    if (rate_.admit(now_s()) && socket_.got_text() &&
        decode_hand(text, target) == DecodeStatus::kOk) {
      hub_.put_hand(number, target);
    } else {
      ++hub_.refused;
    }
    buffer_.clear();
  }

  void write() {
    if (current_) return;  // one at a time; the end of it calls again
    if (!events_.empty()) {
      current_ = std::move(events_.front());
      events_.pop_front();
    } else if (frame_) {
      current_ = std::move(frame_);
      ++hub_.sent;
    } else {
      return;
    }
    socket_.async_write(asio::buffer(*current_),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          self->current_.reset();
                          if (!error) self->write();
                        });
  }

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  std::shared_ptr<int> connection_;
  beast::flat_buffer buffer_;
  MessageRate rate_;
  std::deque<Text> events_;  // waiting
  Text frame_;               // waiting
  Text current_;             // on its way
};

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

// One HTTP connection, until it ends or becomes a page.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(Hub& hub, tcp::socket&& socket)
      : hub_(hub), stream_(std::move(socket)), connection_(hub.connections) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kLargestHeader);
    parser_->body_limit(0);
    stream_.expires_after(kRequestTimeout);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) {
                         self->answer();
                       } else if (error.category() ==
                                  http::make_error_code(http::error::bad_method).category()) {
                         if (error != http::error::end_of_stream) self->refuse_and_close();
                       }
                     });
  }

 private:
  void answer() {
    const Request& request = parser_->get();
    const beast::string_view origin = request[http::field::origin];
    const bool is_upgrade = websocket::is_upgrade(request);

    if (!is_own_host(view(request[http::field::host]), hub_.port)) {
      refuse(http::status::forbidden, "wrong host");
    } else if (!origin.empty() && !is_own_origin(view(origin), hub_.port)) {
      refuse(http::status::forbidden, "wrong origin");
    } else if (request.method() != http::verb::get) {
      refuse(http::status::method_not_allowed, "only GET");
    } else if (!hub_.has_token(request)) {
      refuse(http::status::forbidden, "Open the link that the program printed: it has the token.");
    } else if (is_upgrade && (origin.empty() || path_of(view(request.target())) != "/ws")) {
      refuse(http::status::forbidden, "wrong origin or path");
    } else if (is_upgrade) {
      std::make_shared<Page>(hub_, std::move(stream_), std::move(connection_))->start(request);
    } else {
      serve(view(request.target()));
    }
  }

  void serve(std::string_view target) {
    const auto asset = hub_.assets.find(path_of(target));
    if (asset == hub_.assets.end()) {
      respond(http::status::not_found, "text/plain", "not found\n");
    } else {
      respond(http::status::ok, asset->second.content_type, asset->second.content);
    }
  }

  void refuse(http::status status, std::string_view reason) {
    ++hub_.refused;
    respond(status, "text/plain", std::string(reason) + "\n");
  }

  // After bytes that are not a request.
  void refuse_and_close() {
    ++hub_.refused;
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
  }

  void respond(http::status status, std::string_view content_type, std::string body) {
    const Request& request = parser_->get();
    response_ = Response(status, request.version());
    response_.set(http::field::content_type, content_type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy", kContentPolicy);
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Content-Type-Options", "nosniff");
    if (status == http::status::ok && path_of(view(request.target())) == "/") {
      response_.set(http::field::set_cookie, "hapticgiant_" + std::to_string(hub_.port) + "=" +
                                                 hub_.token +
                                                 "; Path=/; HttpOnly; SameSite=Strict");
    }
    response_.body() = std::move(body);
    response_.keep_alive(status == http::status::ok && request.keep_alive());
    response_.prepare_payload();
    http::async_write(stream_, response_,
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (!error && self->response_.keep_alive()) return self->read();
                        error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  Hub& hub_;
  beast::tcp_stream stream_;
  std::shared_ptr<int> connection_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

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
      hub.assets[std::string(kDeviceAddress)] = {"application/xml", read_file(scene.device.urdf)};
    }
    if (!scene.twin.urdf.empty()) {
      hub.assets[std::string(kTwinAddress)] = {"application/xml", read_file(scene.twin.urdf)};
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
