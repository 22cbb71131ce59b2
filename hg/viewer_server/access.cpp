#include "hg/viewer_server/access.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <regex>

#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg::viewer_server {
namespace {

constexpr std::uintmax_t kLargestPage = 64u << 20;  // bytes; a built page has about 1 MB

constexpr std::array<std::array<std::string_view, 2>, 9> kContentTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".woff2", "font/woff2"},
    {".wasm", "application/wasm"},
    {".txt", "text/plain; charset=utf-8"},
}};

std::string content_type(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  for (const auto& [ending, type] : kContentTypes) {
    if (extension == ending) return std::string(type);
  }
  return "application/octet-stream";
}

constexpr std::size_t kTokenDigits = 32;
constexpr std::string_view kDigits = "0123456789abcdef";

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw SetupError(file.string() + ": " + why);
}

// The token in a file that this user alone has; what is checked is what is read.
std::string token_in(const std::filesystem::path& file) {
  const OpenFile kept = open_to_read(file);
  struct stat facts {};
  if (fstat(kept.descriptor(), &facts) != 0) refuse(file, std::strerror(errno));
  if (facts.st_uid != geteuid()) {
    refuse(file,
           "the token of the page must be a file of the user who runs this, got one of user " +
               std::to_string(facts.st_uid) + ", expected " + std::to_string(geteuid()));
  }
  if ((facts.st_mode & 077U) != 0) {
    refuse(file, "the token of the page must be its owner's only: chmod 600 " + file.string());
  }
  std::string token(2 * kTokenDigits, '\0');
  const ssize_t count = read(kept.descriptor(), token.data(), token.size());
  const bool is_longer = count == static_cast<ssize_t>(token.size());
  token.resize(std::max<ssize_t>(count, 0));
  token.erase(token.find_last_not_of(" \r\n") + 1);
  if (is_longer || token.size() != kTokenDigits ||
      token.find_first_not_of(kDigits) != std::string::npos) {
    refuse(file,
           "a token is 32 hexadecimal digits 0-9 a-f: delete the file, and a new one is made");
  }
  return token;
}

bool is_address(const std::string& text, int family) {
  in6_addr address;  // large enough for both
  return inet_pton(family, text.c_str(), &address) == 1;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes;
  if (getentropy(bytes.data(), bytes.size()) != 0) {
    throw SetupError("viewer: the operating system must give random numbers for the token");
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

std::string kept_token(const std::filesystem::path& file) {
  const int made = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (made >= 0) {
    const OpenFile owner(made);
    std::string token = random_token();
    if (write(made, token.data(), token.size()) == static_cast<ssize_t>(token.size())) return token;
    unlink(file.c_str());  // part of a token would be refused at the next start
    refuse(file, "the token of the page cannot be written: is the disk full?");
  }
  if (errno != EEXIST) refuse(file, "cannot be written: " + std::string(std::strerror(errno)));
  return token_in(file);
}

bool is_same_secret(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |=
        static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  }
  return difference == 0;
}

std::string host_text(std::string_view address, std::uint16_t port) {
  const bool has_colons = address.find(':') != std::string_view::npos;
  std::string host;
  if (has_colons) host += '[';
  host += address;
  if (has_colons) host += ']';
  host += ':';
  return host += std::to_string(port);
}

bool is_own_host(std::string_view host, const Listener& listener) {
  for (const std::string_view name : {"127.0.0.1", "localhost", listener.address.c_str()}) {
    if (host == host_text(name, listener.port)) return true;
  }
  const bool is_open = listener.address == "0.0.0.0" || listener.address == "::";
  const std::string port = host_text("", listener.port);
  if (!is_open || !host.ends_with(port)) return false;
  host.remove_suffix(port.size());
  const bool has_brackets = host.starts_with('[') && host.ends_with(']');
  if (has_brackets) host = host.substr(1, host.size() - 2);
  return is_address(std::string(host), has_brackets ? AF_INET6 : AF_INET);
}

bool is_own_origin(std::string_view origin, const Listener& listener) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && is_own_host(origin.substr(kScheme.size()), listener);
}

bool is_web_origin(std::string_view text) {
  static const std::regex kOrigin(R"(https?://([A-Za-z0-9.-]+|\[[0-9A-Fa-f:.]+\])(:[0-9]{1,5})?)");
  return std::regex_match(text.begin(), text.end(), kOrigin);
}

std::string content_policy(const std::vector<std::string>& embedders) {
  std::string policy =
      "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; "
      "frame-ancestors";
  if (embedders.empty()) policy += " 'none'";
  for (const std::string& origin : embedders) policy += " " + origin;
  return policy;
}

std::string_view path_of(std::string_view target) noexcept {
  return target.substr(0, target.find('?'));
}

std::string_view bearer_token(std::string_view authorization) noexcept {
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization.starts_with(kScheme)) return {};
  return authorization.substr(kScheme.size());
}

std::string_view query_token(std::string_view target) noexcept {
  constexpr std::string_view kToken = "token=";
  target.remove_prefix(std::min(target.find('?'), target.size() - 1) + 1);
  while (!target.empty()) {
    const std::string_view part = target.substr(0, target.find('&'));
    if (part.starts_with(kToken)) return part.substr(kToken.size());
    target.remove_prefix(std::min(target.size(), part.size() + 1));
  }
  return {};
}

std::string_view protocol_token(std::string_view protocols) noexcept {
  constexpr std::string_view kToken = "token.";
  const std::size_t comma = protocols.find(',');
  if (comma == std::string_view::npos || protocols.substr(0, comma) != kProtocol) return {};
  protocols.remove_prefix(comma + 1);
  while (protocols.starts_with(' ')) protocols.remove_prefix(1);
  if (!protocols.starts_with(kToken)) return {};
  return protocols.substr(kToken.size());
}

AssetTable load_page(const std::filesystem::path& page) {
  if (!std::filesystem::is_regular_file(page / "index.html")) {
    throw SetupError("viewer: page folder must hold index.html, got " + page.string() +
                     "; build it with: npm ci && npm run build (in viewer/)");
  }
  AssetTable assets;
  std::uintmax_t size = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(page)) {
    if (entry.is_symlink() || !entry.is_regular_file()) continue;
    size += entry.file_size();
    if (size > kLargestPage) {
      throw SetupError("viewer: page folder must hold at most 64 MB, got more in " + page.string());
    }
    const auto path = std::filesystem::path("/") / entry.path().lexically_relative(page);
    assets[path.generic_string()] = {content_type(entry.path()),
                                     live::to_bytes(read_file(entry.path())), true};
  }
  assets["/"] = assets["/index.html"];
  return assets;
}

}  // namespace hg::viewer_server
