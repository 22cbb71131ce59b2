#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "hg/viewer_server/access.h"
#include "hg/viewer_server/hand_target_box.h"
#include "hg/viewer_server/messages.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

using namespace viewer_server;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

void check_hand(const HandTarget& hand) {
  require(hand.p_B.allFinite() && hand.p_B.cwiseAbs().maxCoeff() <= 100.0, "position");
  require(hand.press >= 0.0 && hand.press <= 1.0, "press");
  require(hand.R_B.allFinite(), "rotation");
  const Eigen::Matrix3d product = hand.R_B * hand.R_B.transpose();
  require((product - Eigen::Matrix3d::Identity()).norm() < 0.1, "no rotation");
  const Eigen::AlignedBox3d room(Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0));
  HandTargetBox box(room);
  HandTarget taken;
  if (!box.put(1, hand, 0.0) || !box.take(taken, 0.0) || !taken.active) return;
  require(taken.p_B.cwiseAbs().maxCoeff() <= 1.0 + HandTargetBox::kMargin + 1e-9,
          "out of the room");
}

}  // namespace

void commands(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  PageMessage message;
  switch (decode(text, message)) {
    case DecodeStatus::kHand:
      check_hand(message.hand);
      break;
    case DecodeStatus::kHold:
      require(std::isfinite(message.hold), "sequence number");
      break;
    case DecodeStatus::kCommand:
      require(std::isfinite(message.command.value), "value");
      require(message.command.id >= 0.0 && message.command.id <= 0x1p53 &&
                  message.command.id == std::floor(message.command.id),
              "id");
      require(message.command.argument.size() <= 200, "name");
      encode_answer(message.command.id, message.command.argument);
      break;
    case DecodeStatus::kMalformed:
    case DecodeStatus::kOutOfRange:
      break;
  }
  // the same bytes as parts of a request
  const Listener listener{.address = "127.0.0.1", .port = 8080};
  const bool is_own = is_own_host(text, listener);
  require(!is_own || text == "127.0.0.1:8080" || text == "localhost:8080", "another host");
  is_own_origin(text, listener);
  bearer_token(text);
  protocol_token(text);
  path_of(text);
}

}  // namespace hg::fuzz
