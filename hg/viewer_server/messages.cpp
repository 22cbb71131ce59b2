#include "hg/viewer_server/messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
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

template <typename Vector>
std::vector<double> list(const Vector& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

template <typename First, typename Second>
std::vector<double> joined(const First& first, const Second& second) {
  std::vector<double> all = list(first);
  all.insert(all.end(), second.data(), second.data() + second.size());
  return all;
}

Vec3 vec3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Quaternion quaternion(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {q.x(), q.y(), q.z(), q.w()};
}

std::optional<double> bounded(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

SceneChainMessage chain_message(const SceneChain& chain, std::string_view address) {
  SceneChainMessage message;
  if (!chain.urdf.empty()) message.urdf = address;
  message.p_B_root = vec3(chain.T_B_root.p);
  message.quaternion_B_root = quaternion(chain.T_B_root.R);
  for (const SceneJoint& joint : chain.joints) {
    message.joints.push_back({joint.name, joint.type, joint.planar, vec3(joint.axis),
                              bounded(joint.range.lb), bounded(joint.range.ub),
                              bounded(joint.dq_max), bounded(joint.tau_max)});
  }
  return message;
}

std::vector<SceneSurfaceMessage> surface_messages(const std::vector<SceneSurface>& surfaces) {
  std::vector<SceneSurfaceMessage> messages;
  for (const SceneSurface& s : surfaces) {
    messages.push_back(
        {s.name, s.shape, vec3(s.pose.p), vec3(s.size), quaternion(s.pose.R), s.triangles});
  }
  return messages;
}

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

HandMessage hand_message(const HandTarget& hand) {
  std::optional<Quaternion> turn;
  if (hand.turns) turn = quaternion(hand.R_B);
  return {hand.active, vec3(hand.p_B), turn, hand.press};
}

std::size_t limit_count(const CycleRecord& record, const LimitCatalogue& limits) {
  return std::min(limits.size(), record.limits.size());
}

std::optional<FeltLimitMessage> felt_message(const CycleRecord& record,
                                             const LimitCatalogue& limits) {
  const int index = record.felt_limit;
  if (index < 0 || static_cast<std::size_t>(index) >= limit_count(record, limits)) return {};
  const auto i = static_cast<std::size_t>(index);
  return FeltLimitMessage{index, limits[i].name, limit_text(limits[i], record.limits[i]),
                          record.w_felt};
}

void add_limits(const CycleRecord& record, const LimitCatalogue& limits, FrameMessage& frame) {
  for (std::size_t i = 0; i < limit_count(record, limits); ++i) {
    const LimitReport& report = record.limits[i];
    frame.limit_position.push_back(report.position);
    frame.limit_distance.push_back(bounded(std::min(report.to_lower, report.to_upper)));
    if (report.state == LimitState::kInactive) continue;
    frame.active.push_back({static_cast<int>(i), report, limit_text(limits[i], report)});
  }
}

// coordinates at which the page draws the device
std::vector<double> q_device(const CycleRecord& record) {
  return joined(record.robot.q_p, record.reference.q_m);
}

void add_motion(const CycleRecord& record, FrameMessage& frame) {
  const RobotState& robot = record.robot;
  frame.q_device = q_device(record);
  frame.q_measured = joined(robot.q_p, robot.q_m);
  frame.dq_device = joined(robot.dq_p, record.reference.dq_m);
  frame.dq_measured = joined(robot.dq_p, robot.dq_m);
  frame.tau_measured = list(robot.tau_m);
  frame.q_twin = list(record.twin.q_a);
  frame.dq_twin = list(record.twin.dq_a);
  frame.q_gantry_target = list(record.q_p_target);
  frame.tracking_error = list(record.tracking.error);
  frame.is_clamped = record.tracking.is_clamped;
  frame.p_B_H = vec3(record.T_B_H.p);
  frame.quaternion_B_H = quaternion(record.T_B_H.R);
  frame.v_H = vec3(record.v_H);
  frame.p_B_E = vec3(record.T_B_E.p);
  frame.quaternion_B_E = quaternion(record.T_B_E.R);
  frame.p_B_elbow = vec3(record.p_B_elbow);
  frame.force = vec3(robot.w_H.head<3>());
  frame.torque = vec3(robot.w_H.tail<3>());
  frame.sync_error_mm = 1e3 * record.sync_error;
  frame.sync_error_deg = record.sync_error_angle * 180.0 / M_PI;
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

std::string encode_scene(const Scene& scene, double update_rate_hz) {
  SceneMessage message{.run = scene.run,
                       .source = scene.source,
                       .title = scene.title,
                       .description = scene.description,
                       .rate_hz = scene.rate_hz,
                       .update_rate_hz = update_rate_hz,
                       .begin_s = scene.begin_s,
                       .duration_s = scene.duration_s,
                       .device = chain_message(scene.device, kDeviceAddress),
                       .twin = chain_message(scene.twin, kTwinAddress),
                       .gantry_joints = scene.gantry_joints,
                       .limits = limit_messages(scene.limits),
                       .floor_z = scene.floor_z,
                       .box = {vec3(scene.box.min()), vec3(scene.box.max())},
                       .environment = scene.environment,
                       .surfaces = surface_messages(scene.surfaces),
                       .choices = scene.choices,
                       .settings = {},
                       .commands = scene.commands,
                       .refusal = scene.refusal,
                       .stopping = scene.stopping};
  for (const Setting& s : scene.settings) {
    message.settings.push_back(
        {s.name, s.group, s.label, s.unit, s.min, s.max, bounded(s.value), s.step, s.help});
  }
  return to_json(message);
}

SafetyMessage safety_message(const View& view) {
  const CycleRecord& record = view.record;
  const SafetyView& safety = view.safety;
  return {record.stop,
          record.is_autonomous,
          static_cast<int>(record.fault.code),
          safety.cause,
          safety.release,
          safety.warning,
          safety.panel.emergency_stop || !safety.stop_pressed_by.empty(),
          safety.stop_pressed_by,
          safety.panel};
}

std::string encode_frame(const View& view, const LimitCatalogue& limits, std::uint64_t clients) {
  const CycleRecord& record = view.record;
  FrameMessage frame;
  frame.run = view.run;
  frame.time_s = record.time_s;
  frame.mode = record.mode;
  frame.mode_text = mode_text(record);
  if (record.fault.code != FaultCode::kNone) frame.fault = to_string(record.fault.code);
  frame.status = view.status_text;
  add_motion(record, frame);
  frame.felt = felt_message(record, limits);
  add_limits(record, limits, frame);
  if (record.contact.surface >= 0) frame.contact = record.contact;
  frame.budget = view.budget;
  frame.singularity = view.singularity;
  frame.cycle_time_us = view.cycle_time_us;
  frame.cycle_time_max_us = view.cycle_time_max_us;
  frame.hand = hand_message(view.hand);
  frame.run_state = view.run_state;
  frame.safety = safety_message(view);
  frame.clients = clients;
  if (view.ghost) {
    const CycleRecord& other = view.ghost->record;
    frame.ghost = {view.ghost->time_s, q_device(other), list(other.twin.q_a), vec3(other.T_B_H.p),
                   vec3(other.robot.w_H.head<3>())};
  }
  return to_json(frame);
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
