/// Mailbox for reference wrenches of live clients: the program takes the newest.
///
/// One client gives it at a time: the first, until it ends, leaves, or is silent for 0.12 s; then
/// the wrench is zero. Times are arguments. Not synchronised.
#pragma once

#include <cstdint>

#include "hg/core/types.h"

namespace hg::viewer_server {

class ReferenceWrenchBox {
 public:
  static constexpr double kSilence_s = 0.12;

  /// Stores a wrench, resolved in B; false when another client gives one: it is ignored.
  bool put(std::uint64_t client, const Vector6& w, double now_s) {
    look(now_s);
    if (giver_ != 0 && giver_ != client) return false;
    giver_ = client;
    heard_s_ = now_s;
    newest_ = w;
    is_new_ = true;
    return true;
  }

  /// Ends the wrench of a client that ends it or has disconnected.
  void leave(std::uint64_t client) {
    if (giver_ == client) end();
  }

  /// Gets the newest wrench since the last call, and its client, 0 when it has ended; false: none.
  bool take(Vector6& w, std::uint64_t& client, double now_s) {
    look(now_s);
    if (!is_new_) return false;
    is_new_ = false;
    w = newest_;
    client = giver_;
    return true;
  }

 private:
  void look(double now_s) {
    if (giver_ != 0 && now_s - heard_s_ > kSilence_s) end();
  }

  void end() {
    giver_ = 0;
    newest_.setZero();
    is_new_ = true;
  }

  Vector6 newest_ = Vector6::Zero();
  double heard_s_ = 0.0;
  std::uint64_t giver_ = 0;  ///< client that gives the wrench; 0 = none
  bool is_new_ = false;
};

}  // namespace hg::viewer_server
