/// Access control: pure functions on the text of requests, and the files that can be served.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hg/live/frame.h"

namespace hg::viewer_server {

/// Random token: 128 random bits of the operating system as 32 hexadecimal digits.
std::string random_token();

/// Token in `file`, which is created with a random one if missing, for its owner only. Throws
/// SetupError when it is another user's file, others may read it, or it holds no token.
std::string kept_token(const std::filesystem::path& file);

/// Compares two secrets in constant time; true when both are equal.
bool is_same_secret(std::string_view a, std::string_view b) noexcept;

/// Listening address of the server.
struct Listener {
  /// IPv4 or IPv6; 0.0.0.0 or :: = all addresses of this machine
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;
};

/// Address and port as used in a link; IPv6 in brackets.
std::string host_text(std::string_view address, std::uint16_t port);

/// Whether a Host header names this machine: 127.0.0.1, localhost or the listening address, with
/// exactly this port; when listening at all addresses, any address but no other name, because only
/// names can be redirected here by others.
bool is_own_host(std::string_view host, const Listener& listener);

/// Whether an Origin header is that of a page of this server.
bool is_own_origin(std::string_view origin, const Listener& listener);

/// Whether `text` is the origin of a page: http or https, a host, and a port if it is not the
/// usual one, "http://127.0.0.1:8123". Nothing in it can end a directive of content_policy().
bool is_web_origin(std::string_view text);
inline constexpr std::string_view kOriginExample = "http://127.0.0.1:8123";

/// Content-Security-Policy of a page that asks nothing of other machines and that only pages of
/// `embedders`, which are web origins, may show inside themselves.
std::string content_policy(const std::vector<std::string>& embedders);

/// The path of a request target, without its query.
std::string_view path_of(std::string_view target) noexcept;

/// Token in an Authorization header, "Bearer TOKEN"; empty if missing.
std::string_view bearer_token(std::string_view authorization) noexcept;

/// Path of the live interface's WebSocket.
inline constexpr std::string_view kLivePath = "/live";

/// Token in the query of a request target, "/live?token=TOKEN"; empty if missing.
std::string_view query_token(std::string_view target) noexcept;

/// Protocol name of the page's WebSocket.
inline constexpr std::string_view kProtocol = "hapticgiant";

/// Token in a Sec-WebSocket-Protocol header, "hapticgiant, token.TOKEN": the form in which a
/// browser can send it with a WebSocket; empty if missing or of another protocol.
std::string_view protocol_token(std::string_view protocols) noexcept;

/// File or document that can be requested.
struct Asset {
  std::string content_type;
  live::Bytes content;     ///< shared with what is being sent
  bool is_public = false;  ///< served without a token, too
};

/// Assets by path, for example "/assets/index.js". Only entries of the table can ever be served:
/// there is no path arithmetic at request time.
using AssetTable = std::map<std::string, Asset, std::less<>>;

/// Reads all files below `page`, which are public: a browser cannot send the token with the files
/// that it loads for a page. Links are not followed. "/" is index.html. Throws SetupError when the
/// folder has no index.html or holds more than 64 MB.
AssetTable load_page(const std::filesystem::path& page);

}  // namespace hg::viewer_server
