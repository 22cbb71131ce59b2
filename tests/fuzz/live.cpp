#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "hg/live/session.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

using live::Board;
using live::Frame;
using live::Order;
using live::Parameter;
using live::Reaction;
using live::Session;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

void check_frame(const Frame& frame) {
  if (frame.is_text) {
    require(nlohmann::json::accept(frame.head) && frame.payload == nullptr, "no JSON");
  } else {
    require(!frame.head.empty() && frame.head[0] >= 1 && frame.head[0] <= 4, "operation");
  }
}

void check(const Reaction& reaction, const Parameter& parameter) {
  for (const Frame& frame : reaction.frames) check_frame(frame);
  for (const Order& order : reaction.orders) {
    const bool is_set = order.kind == Order::Kind::kSet;
    require(!is_set || (order.name == parameter.name && order.value >= parameter.min &&
                        order.value <= parameter.max),
            "a value out of range");
  }
  if (reaction.hand) {
    require(reaction.hand->p_B.allFinite() && reaction.hand->p_B.cwiseAbs().maxCoeff() <= 100.0,
            "position");
    const Eigen::Matrix3d product = reaction.hand->R_B * reaction.hand->R_B.transpose();
    require((product - Eigen::Matrix3d::Identity()).norm() < 0.1, "no rotation");
  }
  if (reaction.wrench) require(reaction.wrench->allFinite(), "wrench");
}

}  // namespace

void live(Bytes bytes) {
  Board board;
  board.session = "x";
  board.parameters = {{"hinge.damping", "Nms/rad", 2.0, 0.0, 50.0}};
  for (std::size_t i = 0; i < live::kTopicCount; ++i) {
    board.latched[i] = live::Message{i, 1, live::to_bytes("latched")};
  }
  Session session(board);
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (rest.size() >= 2) {
    const bool is_text = (rest[0] & 1) != 0;
    const bool is_refused = (rest[0] & 2) != 0;
    const std::size_t size = static_cast<unsigned char>(rest[1]);
    const Reaction reaction = session.take(rest.substr(2, size), is_text);
    check(reaction, board.parameters[0]);
    for (const Order& order : reaction.orders) {
      check(session.answer(order.id, is_refused ? "refused" : ""), board.parameters[0]);
    }
    rest.remove_prefix(std::min(rest.size(), size + 2));
  }
  live::chosen_protocol(rest);
}

}  // namespace hg::fuzz
