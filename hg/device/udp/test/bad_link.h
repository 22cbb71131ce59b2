/// A network between two sockets of this machine that loses, doubles, swaps, cuts and corrupts
/// datagrams, by the numbers of a seed.
#pragma once

#include <atomic>
#include <random>
#include <string>
#include <thread>

#include "hg/device/udp/udp_socket.h"

namespace hg::udp {

/// Shares of the datagrams, 0..1; each way has random numbers of its own.
struct Badness {
  double loses = 0.0, doubles = 0.0, swaps = 0.0, cuts = 0.0, corrupts = 0.0;
};

class BadLink {
 public:
  BadLink(const Address& server, const Badness& badness, unsigned seed)
      : badness_(badness),
        near_(UdpSocket::listening_at({"127.0.0.1", "0"})),
        far_(UdpSocket::talking_to(server)),
        to_server_{std::mt19937(seed), {}, false},
        to_client_{std::mt19937(seed + 1), {}, false},
        thread_([this] { run(); }) {}
  ~BadLink() {
    stop_.store(true);
    thread_.join();
  }

  /// Where the client finds the server.
  Address address() const { return parse_address("bad link", to_string(near_.own_address())); }

 private:
  struct Way {
    std::mt19937 random;
    Datagram held_back;
    bool holds_back = false;
  };

  void run() {
    Datagram datagram;
    Peer from;
    while (!stop_.load()) {
      bool any = false;
      if (near_.receive(datagram, from)) {
        any = true;
        client_ = from;
        pass(to_server_, datagram, [this](auto bytes) { far_.send(bytes); });
      }
      if (far_.receive(datagram, from)) {
        any = true;
        pass(to_client_, datagram, [this](auto bytes) { near_.send(bytes, client_); });
      }
      if (!any) near_.wait(now_ns() + 50'000);  // so that far_ is looked at, too
    }
  }

  template <typename Send>
  void pass(Way& way, Datagram& datagram, Send send) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const auto happens = [&](double probability) { return share(way.random) < probability; };
    if (happens(badness_.loses)) return;
    if (happens(badness_.cuts)) datagram.size = way.random() % datagram.size;
    if (happens(badness_.corrupts)) {
      datagram.bytes[way.random() % datagram.size] ^= std::byte{1} << way.random() % 8;
    }
    if (!way.holds_back && happens(badness_.swaps)) {
      way.held_back = datagram;
      way.holds_back = true;
      return;
    }
    send(datagram.view());
    if (happens(badness_.doubles)) send(datagram.view());
    if (way.holds_back) send(way.held_back.view());
    way.holds_back = false;
  }

  Badness badness_;
  UdpSocket near_, far_;
  Peer client_;
  Way to_server_, to_client_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace hg::udp
