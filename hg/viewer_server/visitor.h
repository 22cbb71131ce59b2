/// One HTTP connection: checks each request, serves entries of the table, or becomes a
/// page or a live client.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hg/viewer_server/hub.h"
#include "hg/viewer_server/live_client.h"
#include "hg/viewer_server/page.h"

namespace hg::viewer_server {

constexpr std::uint32_t kLargestHeader = 8192;  // bytes

/// HTTP connection; destroyed when it closes or becomes a page.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(Hub& hub, tcp::socket&& socket) : hub_(hub), stream_(std::move(socket)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kLargestHeader);
    parser_->body_limit(0);
    if (known_) {
      stream_.expires_after(kRequestTimeout);
    } else {
      stream_.expires_after(kStrangerTimeout);
    }
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

  /// Closes the connection to make room for another one.
  void drop() { stream_.close(); }

 private:
  void answer() {
    const Request& request = parser_->get();
    const beast::string_view origin = request[http::field::origin];
    const bool is_upgrade = websocket::is_upgrade(request);
    const std::string_view path = path_of(view(request.target()));
    const bool is_live = is_upgrade && path == kLivePath;

    if (request.count(http::field::host) != 1 ||
        !is_own_host(view(request[http::field::host]), hub_.listener)) {
      refuse(http::status::forbidden, "wrong host");
    } else if (!origin.empty() && !is_live && !is_own_origin(view(origin), hub_.listener)) {
      refuse(http::status::forbidden, "wrong origin");
    } else if (request.method() != http::verb::get) {
      refuse(http::status::method_not_allowed, "only GET");
    } else if (is_upgrade && !is_live && (origin.empty() || path != "/ws")) {
      refuse(http::status::forbidden, "wrong origin or path");
    } else if (const Asset* asset = found(); !is_upgrade && asset != nullptr && asset->is_public) {
      serve(*asset);
    } else if (!hub_.has_token(request)) {
      refuse(http::status::forbidden, "Open the link that the program printed: it has the token.");
    } else if (!known_ && !(known_ = hub_.make_known(this))) {
      refuse(http::status::service_unavailable, "too many connections");
    } else if (is_live) {
      become_live(request);
    } else if (is_upgrade) {
      std::make_shared<Page>(hub_, std::move(stream_), std::move(known_))->start(request);
    } else if (asset != nullptr) {
      serve(*asset);
    } else {
      respond(http::status::not_found, "text/plain", "not found\n");
    }
  }

  void become_live(const Request& request) {
    const std::string_view protocol =
        live::chosen_protocol(view(request[http::field::sec_websocket_protocol]));
    if (protocol.empty()) {
      refuse(http::status::bad_request,
             "the subprotocol must be foxglove.sdk.v1 or foxglove.websocket.v1");
    } else if (hub_.live_places.use_count() > kMostLive) {
      refuse(http::status::service_unavailable, "too many live clients");
    } else {
      std::make_shared<LiveClient>(hub_, std::move(stream_), std::move(known_), hub_.live_places)
          ->start(request, protocol);
    }
  }

  // Requested asset; null: no such asset.
  const Asset* found() const {
    const auto asset = hub_.assets.find(path_of(view(parser_->get().target())));
    return asset == hub_.assets.end() ? nullptr : &asset->second;
  }

  void serve(const Asset& asset) { respond(http::status::ok, asset.content_type, *asset.content); }

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
    response_ = {status, request.version()};
    response_.set(http::field::content_type, content_type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy", hub_.content_policy);
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.body() = std::move(body);
    response_.keep_alive(status == http::status::ok && request.keep_alive());
    response_.prepare_payload();
    stream_.expires_after(kRequestTimeout);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (!error && self->response_.keep_alive()) return self->read();
                        error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  Hub& hub_;
  beast::tcp_stream stream_;
  std::shared_ptr<int> known_;  ///< set once it has shown the token
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace hg::viewer_server
