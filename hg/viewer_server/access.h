/// Who may ask, and for what: pure functions on the text of requests, and the files that exist.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace hg::viewer_server {

/// 128 random bits of the operating system as 32 hexadecimal digits.
std::string random_token();

/// True when both are equal; the time taken does not tell where they differ.
bool is_same_secret(std::string_view a, std::string_view b) noexcept;

/// Where the server listens.
struct Listener {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6; 0.0.0.0 or :: = all of this machine
  std::uint16_t port = 0;
};

/// Address and port as they stand in a link; IPv6 in brackets.
std::string host_text(std::string_view address, std::uint16_t port);

/// Host header of this machine: 127.0.0.1, localhost or the address that is listened at, with
/// exactly this port; where all are listened at, any address but no other name, because only names
/// can be made to point here by somebody else.
bool is_own_host(std::string_view host, const Listener& listener);

/// Origin header of a page of this server.
bool is_own_origin(std::string_view origin, const Listener& listener);

/// The path of a request target, without its query.
std::string_view path_of(std::string_view target) noexcept;

/// The token in an Authorization header, "Bearer TOKEN"; empty if missing.
std::string_view bearer_token(std::string_view authorization) noexcept;

/// The protocol of the WebSocket that a page speaks.
inline constexpr std::string_view kProtocol = "hapticgiant";

/// The token in a Sec-WebSocket-Protocol header, "hapticgiant, token.TOKEN": what a browser can
/// send with a WebSocket; empty if missing or of another protocol.
std::string_view protocol_token(std::string_view protocols) noexcept;

/// One thing that can be asked for.
struct Asset {
  std::string content_type;
  std::string content;
  bool is_public = false;  ///< also for who has no token
};

/// By path, for example "/assets/index.js". Only what is in the table can ever be served: there is
/// no path arithmetic at request time.
using AssetTable = std::map<std::string, Asset, std::less<>>;

/// Reads all files below `page`, which are public: a browser cannot send the token with what it
/// loads for a page. Links are not followed. "/" is index.html. Throws SetupError when the folder
/// has no index.html or holds more than 64 MB.
AssetTable load_page(const std::filesystem::path& page);

}  // namespace hg::viewer_server
