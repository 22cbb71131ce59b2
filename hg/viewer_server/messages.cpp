#include "hg/viewer_server/messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hg/viewer_server/command_message.h"
#include "hg/viewer_server/frame_message.h"
#include "hg/viewer_server/json_reader.h"
#include "hg/viewer_server/json_writer.h"
#include "hg/viewer_server/limit_text.h"
#include "hg/viewer_server/scene_message.h"

namespace hg::viewer_server {
namespace {

constexpr double kFarthestTarget = 100.0;  // m; beyond any device
constexpr double kLargestId = kLargestPage;
constexpr std::size_t kLongestName = 200;  // bytes
constexpr int kFirstPriority = 2;          // 1 is the coupling of hand and twin

std::size_t limit_count(const FrameMessage& frame) {
  return std::min(frame.limits.size(), frame.view.record.limits.size());
}

HandTarget hand_target(const HandMessage& hand) {
  HandTarget target;
  target.active = hand.active;
  target.p_B = {hand.p_B[0], hand.p_B[1], hand.p_B[2]};
  target.press = hand.press;
  target.turns = hand.quaternion_B_H.has_value();
  if (target.turns) {
    const Quaternion& q = *hand.quaternion_B_H;
    target.R_B = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  }
  return target;
}

bool is_in_range(const HandMessage& hand) {
  const auto is_near = [](double x) { return std::abs(x) <= kFarthestTarget; };
  if (!std::all_of(hand.p_B.begin(), hand.p_B.end(), is_near)) return false;
  if (hand.quaternion_B_H) {
    double square = 0.0;
    for (const double x : *hand.quaternion_B_H) square += x * x;
    if (!(std::abs(square - 1.0) < 1e-3)) return false;
  }
  return hand.press >= 0.0 && hand.press <= 1.0;
}

bool is_id(double number) {
  return number == std::floor(number) && number >= 0.0 && number <= kLargestId;
}

bool is_in_range(const CommandMessage& command) {
  return is_id(command.id) && command.name.size() <= kLongestName;
}

// Discarded where the text is no JSON, or an object has a key twice: other readers may disagree on
// which of the two counts.
nlohmann::json parsed(std::string_view text) {
  using Json = nlohmann::json;
  std::vector<std::set<std::string>> keys;  // keys of the objects that are open
  bool is_unique = true;
  const auto look = [&](int, Json::parse_event_t event, const Json& value) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key) {
      is_unique = keys.back().insert(value.get<std::string>()).second && is_unique;
    }
    return true;
  };
  Json json = Json::parse(text, look, false);  // no exceptions
  return is_unique ? json : Json(Json::value_t::discarded);
}

}  // namespace

// Task levels as in [HG] Table II: Cartesian frames one after the other, three rows each.
std::vector<SceneLimitMessage> limit_messages(const LimitCatalogue& limits) {
  std::vector<SceneLimitMessage> messages;
  int axes = 0, priority = kFirstPriority;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const LimitInfo& limit = limits[i];
    const bool is_other_kind = i > 0 && limit.kind != limits[i - 1].kind;
    if (is_other_kind || (axes > 0 && axes % 3 == 0)) ++priority;
    axes = limit.kind == LimitKind::kCartesian ? axes % 3 + 1 : 0;
    messages.push_back({limit.name, limit.kind, limit.is_angle ? LimitUnit::kRad : LimitUnit::kM,
                        bounded(limit.range.lb), bounded(limit.range.ub), priority});
  }
  return messages;
}

std::vector<double> list(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return {vector.begin(), vector.end()};
}

std::vector<double> joined(const Eigen::Ref<const Eigen::VectorXd>& first,
                           const Eigen::Ref<const Eigen::VectorXd>& second) {
  std::vector<double> all = list(first);
  all.insert(all.end(), second.begin(), second.end());
  return all;
}

std::string fault_name(const CycleRecord& record) {
  const FaultCode code = record.fault.code;
  return std::string(code != FaultCode::kNone ? to_string(code) : "");
}

std::vector<double> q_device(const CycleRecord& record) {
  return joined(record.robot.q_p, record.reference.q_m);
}

std::optional<TwinBaseMessage> twin_base_message(const TwinBase& base) {
  return base.is_moving ? std::optional(TwinBaseMessage{base}) : std::nullopt;
}

HandMessage hand_message(const HandTarget& hand) {
  std::optional<Quaternion> turn;
  if (hand.turns) turn = quaternion(hand.R_B);
  return {hand.active, {hand.p_B.x(), hand.p_B.y(), hand.p_B.z()}, turn, hand.press};
}

std::optional<FeltLimitMessage> felt_limit(const FrameMessage& frame) {
  const CycleRecord& record = frame.view.record;
  const int felt = record.felt_limit;
  if (felt < 0 || std::cmp_greater_equal(felt, limit_count(frame))) return {};
  const LimitInfo& limit = frame.limits[felt];
  return FeltLimitMessage{felt, limit.name, limit_text(limit, record.limits[felt]), record.w_felt};
}

std::vector<ActiveLimitMessage> active_limits(const FrameMessage& frame) {
  std::vector<ActiveLimitMessage> active;
  for (std::size_t i = 0; i < limit_count(frame); ++i) {
    const LimitReport& report = frame.view.record.limits[i];
    if (report.state == LimitState::kInactive) continue;
    active.push_back({static_cast<int>(i), report, limit_text(frame.limits[i], report)});
  }
  return active;
}

std::vector<double> limit_positions(const FrameMessage& frame) {
  std::vector<double> positions;
  for (std::size_t i = 0; i < limit_count(frame); ++i) {
    positions.push_back(frame.view.record.limits[i].position);
  }
  return positions;
}

std::vector<std::optional<double>> limit_distances(const FrameMessage& frame) {
  std::vector<std::optional<double>> distances;
  for (std::size_t i = 0; i < limit_count(frame); ++i) {
    const LimitReport& report = frame.view.record.limits[i];
    distances.push_back(bounded(std::min(report.to_lower, report.to_upper)));
  }
  return distances;
}

std::string encode_scene(Scene scene, double update_rate_hz) {
  scene.update_rate_hz = update_rate_hz;
  scene.device.address = kDeviceAddress;
  scene.twin.address = kTwinAddress;
  return to_json(scene);
}

std::string encode_frame(const View& view, const LimitCatalogue& limits, std::uint64_t clients,
                         const HandHolder& holder) {
  return to_json(FrameMessage{view, limits, clients, holder});
}

std::string encode_event(std::uint64_t run, double time_s, std::string_view name,
                         std::string_view text) {
  return to_json(EventMessage{run, time_s, std::string(name), std::string(text)});
}

std::string encode_values(const std::vector<double>& values) {
  ValuesMessage message;
  for (const double value : values) message.values.push_back(bounded(value));
  return to_json(message);
}

std::string encode_answer(double id, std::string_view reason) {
  return to_json(AnswerMessage{id, reason.empty(), std::string(reason)});
}

std::string encode_welcome(std::uint64_t page) { return to_json(WelcomeMessage{page}); }

DecodeStatus decode(std::string_view text, PageMessage& message) {
  const nlohmann::json json = parsed(text);
  HandMessage hand;
  if (JsonReader(json).read(hand)) {
    if (!is_in_range(hand)) return DecodeStatus::kOutOfRange;
    message.hand = hand_target(hand);
    return DecodeStatus::kHand;
  }
  HoldMessage hold;
  if (JsonReader(json).read(hold)) {
    message.hold = hold.sequence;
    return is_id(hold.sequence) ? DecodeStatus::kHold : DecodeStatus::kOutOfRange;
  }
  CommandMessage command;
  if (!JsonReader(json).read(command)) return DecodeStatus::kMalformed;
  if (!is_in_range(command)) return DecodeStatus::kOutOfRange;
  message.command = {
      .id = command.id, .name = command.command, .argument = command.name, .value = command.value};
  return DecodeStatus::kCommand;
}

std::string_view refusal_text(DecodeStatus status) noexcept {
  switch (status) {
    case DecodeStatus::kHand:
    case DecodeStatus::kHold:
    case DecodeStatus::kCommand:
      return "";
    case DecodeStatus::kMalformed:
      return "not a message of docs/start/viewer.md";
    case DecodeStatus::kOutOfRange:
      return "a number or name is out of range";
  }
  return "";
}

}  // namespace hg::viewer_server
