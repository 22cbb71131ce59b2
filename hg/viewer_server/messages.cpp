#include "hg/viewer_server/messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/viewer_server/limit_text.h"

namespace hg::viewer_server {
namespace {

using Json = nlohmann::json;

constexpr double kFarthestTarget = 100.0;  // m; beyond any device

std::string to_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);  // not UTF-8: replaced
}

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e5) / 1e5;
}

template <typename Vector>
Json numbers(const Vector& values) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) json.push_back(number(values[i]));
  return json;
}

std::string_view name(JointType type) {
  switch (type) {
    case JointType::kRevolute:
      return "revolute";
    case JointType::kPrismatic:
      return "prismatic";
    case JointType::kFloating:
      return "floating";
  }
  return "unknown";
}

Json encode(const SceneChain& chain, std::string_view address) {
  Json joints = Json::array();
  for (const SceneJoint& joint : chain.joints) {
    joints.push_back({{"name", joint.name},
                      {"type", name(joint.type)},
                      {"planar", joint.planar},
                      {"axis", numbers(joint.axis)}});
  }
  const Eigen::Quaterniond quaternion(chain.T_B_root.R);
  return {{"urdf", chain.urdf.empty() ? "" : address},
          {"p_B_root_m", numbers(chain.T_B_root.p)},
          {"quaternion_B_root", numbers(quaternion.coeffs())},
          {"joints", joints}};
}

Json encode(const LimitInfo& limit) {
  return {{"name", limit.name},
          {"kind", to_string(limit.kind)},
          {"unit", limit.is_angle ? "rad" : "m"},
          {"min", number(limit.range.lb)},
          {"max", number(limit.range.ub)}};
}

Json encode(const HandTarget& hand) {
  return {{"type", "hand"},
          {"active", hand.active},
          {"p_B_m", numbers(hand.p_B)},
          {"press", number(hand.press)}};
}

Json felt_limit(const CycleRecord& record, const LimitCatalogue& limits) {
  const int index = record.felt_limit;
  const auto count = std::min<std::size_t>(limits.size(), record.limits.size());
  if (index < 0 || static_cast<std::size_t>(index) >= count) return nullptr;
  const auto i = static_cast<std::size_t>(index);
  return {{"index", index},
          {"name", limits[i].name},
          {"text", limit_text(limits[i], record.limits[i])}};
}

bool is_finite_number(const Json& json) {
  return json.is_number() && std::isfinite(json.get<double>());
}

}  // namespace

std::string encode_scene(const Scene& scene, double update_rate_hz) {
  Json limits = Json::array();
  for (const LimitInfo& limit : scene.limits) limits.push_back(encode(limit));
  return to_text(
      {{"title", scene.title},
       {"rate_hz", number(scene.rate_hz)},
       {"update_rate_hz", number(update_rate_hz)},
       {"device", encode(scene.device, kDeviceAddress)},
       {"twin", encode(scene.twin, kTwinAddress)},
       {"limits", limits},
       {"floor_z_m", number(scene.floor_z)},
       {"box", {{"min_m", numbers(scene.box.min())}, {"max_m", numbers(scene.box.max())}}}});
}

std::string encode_frame(const CycleRecord& record, const HandTarget& hand, double cycle_time_us,
                         std::string_view status_text, const LimitCatalogue& limits) {
  Json q_device = numbers(record.robot.q_p);
  for (const Json& q : numbers(record.reference.q_m)) q_device.push_back(q);
  return to_text({{"type", "frame"},
                  {"time_s", number(record.time_s)},
                  {"mode", to_string(record.mode)},
                  {"fault", fault_text(record.fault)},
                  {"status", status_text},
                  {"q_device", q_device},
                  {"q_twin", numbers(record.twin.q_a)},
                  {"p_B_H_m", numbers(record.T_B_H.p)},
                  {"force_N", numbers(record.robot.w_H.head<3>())},
                  {"torque_Nm", numbers(record.robot.w_H.tail<3>())},
                  {"felt", felt_limit(record, limits)},
                  {"sync_error_mm", number(1e3 * record.sync_error)},
                  {"sync_error_deg", number(record.sync_error_angle * 180.0 / M_PI)},
                  {"cycle_time_us", number(cycle_time_us)},
                  {"hand", encode(hand)}});
}

std::string encode_event(double time_s, std::string_view name, std::string_view text) {
  return to_text({{"type", "event"}, {"time_s", number(time_s)}, {"name", name}, {"text", text}});
}

DecodeStatus decode_hand(std::string_view text, HandTarget& target) {
  const Json json = Json::parse(text, nullptr, false);  // no exceptions: discarded when malformed
  if (!json.is_object() || json.size() != 4) return DecodeStatus::kMalformed;
  for (const char* field : {"type", "active", "p_B_m", "press"}) {
    if (!json.contains(field)) return DecodeStatus::kMalformed;
  }

  const Json& p = json["p_B_m"];
  const Json& press = json["press"];
  if (json["type"] != "hand" || !json["active"].is_boolean()) return DecodeStatus::kMalformed;
  if (!p.is_array() || p.size() != 3 || !press.is_number()) return DecodeStatus::kMalformed;
  for (const Json& x : p) {
    if (!x.is_number()) return DecodeStatus::kMalformed;
    if (!is_finite_number(x)) return DecodeStatus::kOutOfRange;
    if (std::abs(x.get<double>()) > kFarthestTarget) return DecodeStatus::kOutOfRange;
  }
  if (!is_finite_number(press)) return DecodeStatus::kOutOfRange;
  const double press_share = press.get<double>();
  if (press_share < 0.0 || press_share > 1.0) return DecodeStatus::kOutOfRange;

  target.active = json["active"].get<bool>();
  target.p_B = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  target.press = press_share;
  return DecodeStatus::kOk;
}

}  // namespace hg::viewer_server
