/// A browser's side of HTTP and WebSocket on plain sockets, for tests: sends exactly the bytes that
/// it is given.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hg::viewer_server::test {

class RawClient {
 public:
  explicit RawClient(std::uint16_t port, int receive_buffer = 0) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    if (receive_buffer > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    const timeval patience = {20, 0};  // so that a server that never answers fails the test
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no connection");
    }
  }
  ~RawClient() { close(); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return;  // the server has closed: the test reads that next
      bytes.remove_prefix(count);
    }
  }

  /// Sends a GET with these header lines (each ending in CRLF) and returns the whole answer.
  std::string get(std::string_view target, std::string_view headers) {
    send("GET " + std::string(target) + " HTTP/1.1\r\n" + std::string(headers) + "\r\n");
    return read_answer();
  }

  /// Head and body of one HTTP answer; what came until the server closed, if it is not complete.
  std::string read_answer() {
    while (received_.find("\r\n\r\n") == std::string::npos && receive()) continue;
    const std::size_t head = received_.find("\r\n\r\n");
    const std::size_t field = received_.find("Content-Length: ");
    if (head == std::string::npos) return received_;
    const std::size_t body = field < head ? std::stoul(received_.substr(field + 16)) : 0;
    while (received_.size() < head + 4 + body && receive()) continue;
    std::string answer = received_.substr(0, head + 4 + body);
    received_.erase(0, answer.size());
    return answer;
  }

  /// Asks for a WebSocket; returns the answer, which begins with "HTTP/1.1 101" when it is open.
  std::string upgrade(std::string_view target, std::string_view headers) {
    return get(target, std::string(headers) +
                           "Connection: Upgrade\r\nUpgrade: websocket\r\n"
                           "Sec-WebSocket-Version: 13\r\n"
                           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
  }

  /// One masked text message (opcode 1) or another one.
  void send_message(std::string_view text, unsigned char opcode = 1) {
    constexpr std::array<unsigned char, 4> kMask = {1, 2, 3, 4};
    std::string frame(1, static_cast<char>(0x80u | opcode));
    if (text.size() < 126) {
      frame += static_cast<char>(0x80u | text.size());
    } else {
      frame += static_cast<char>(0x80u | 126u);
      frame += static_cast<char>(text.size() >> 8);
      frame += static_cast<char>(text.size() & 255u);
    }
    for (const unsigned char byte : kMask) frame += static_cast<char>(byte);
    for (std::size_t i = 0; i < text.size(); ++i) {
      frame += static_cast<char>(static_cast<unsigned char>(text[i]) ^ kMask[i % 4]);
    }
    send(frame);
  }

  struct Message {
    int opcode = -1;  ///< 1 text, 2 binary, 8 close, 9 ping; -1 = the server closed the connection
    std::string text;
  };

  /// With all its parts; a control frame between them is not expected. Pings are skipped.
  Message read_message(bool takes_pings = false) {
    while (true) {
      Message message;
      for (bool is_last = false; !is_last;) {
        Message part = read_frame(is_last);
        if (part.opcode < 0) return {};
        if (part.opcode != 0) message.opcode = part.opcode;
        message.text += part.text;
      }
      if (message.opcode != 9 || takes_pings) return message;
    }
  }

 private:
  bool has(std::size_t size) {
    while (received_.size() < size && receive()) continue;
    return received_.size() >= size;
  }

  Message read_frame(bool& is_last) {
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(received_[i]); };
    if (!has(2)) return {};
    is_last = (byte(0) & 128) != 0;
    std::size_t size = byte(1) & 127u;
    const std::size_t start = size == 127 ? 10 : size == 126 ? 4 : 2;
    if (!has(start)) return {};
    if (start > 2) size = 0;
    for (std::size_t i = 2; i < start; ++i) size = 256u * size + byte(i);
    if (!has(start + size)) return {};
    Message message = {byte(0) & 15, received_.substr(start, size)};
    received_.erase(0, start + size);
    return message;
  }

  bool receive() {
    std::array<char, 4096> bytes;
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (count <= 0) return false;
    received_.append(bytes.data(), count);
    return true;
  }

  int socket_ = -1;
  std::string received_;
};

}  // namespace hg::viewer_server::test
