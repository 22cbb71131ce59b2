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

/// Value of `name` in the query of a request target, as it stands; empty if missing.
std::string_view query_value(std::string_view target, std::string_view name) noexcept;

/// Value of `name` in a Cookie header; empty if missing.
std::string_view cookie_value(std::string_view cookies, std::string_view name) noexcept;

/// One thing that can be asked for.
struct Asset {
  std::string content_type;
  std::string content;
};

/// By path, for example "/assets/index.js". Only what is in the table can ever be served: there is
/// no path arithmetic at request time.
using AssetTable = std::map<std::string, Asset, std::less<>>;

/// Reads all files below `page`; links are not followed. "/" is index.html. Throws SetupError when
/// the folder has no index.html or holds more than 64 MB.
AssetTable load_page(const std::filesystem::path& page);

/// Throws SetupError when the file cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace hg::viewer_server
