#include "hg/viewer_server/messages.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "hg/viewer_server/access.h"
#include "hg/viewer_server/limit_text.h"

namespace hg::viewer_server {
namespace {

using Json = nlohmann::json;
using Fields = std::map<std::string, std::string>;  // name to type, as written in TypeScript

// The interfaces of messages.ts.
std::map<std::string, Fields> read_interfaces() {
  const std::string source = read_file("viewer/src/messages.ts");
  const std::regex interface(R"(export interface (\w+) \{([^}]*)\})");
  const std::regex field(R"(\n  (\w+): ([^;]+);)");
  std::map<std::string, Fields> interfaces;
  for (std::sregex_iterator i(source.begin(), source.end(), interface), end; i != end; ++i) {
    const std::string body = (*i)[2];
    Fields& fields = interfaces[(*i)[1]];
    for (std::sregex_iterator f(body.begin(), body.end(), field); f != end; ++f) {
      fields[(*f)[1]] = (*f)[2];
    }
  }
  return interfaces;
}

void expect_type(const Json& json, std::string type, const std::string& item);

void expect_interface(const Json& json, const std::string& name, const std::string& item) {
  static const auto interfaces = read_interfaces();
  ASSERT_TRUE(interfaces.contains(name)) << name;
  const Fields& fields = interfaces.at(name);
  ASSERT_TRUE(json.is_object()) << item;
  for (const auto& [field, value] : json.items()) {
    EXPECT_TRUE(fields.contains(field)) << item << "." << field << " is not in messages.ts";
  }
  for (const auto& [field, type] : fields) {
    ASSERT_TRUE(json.contains(field)) << item << "." << field << " is missing";
    expect_type(json.at(field), type, item + "." + field);
  }
}

void expect_type(const Json& json, std::string type, const std::string& item) {
  if (type.ends_with(" | null")) {
    if (json.is_null()) return;
    type.resize(type.size() - 7);
  }
  if (type.ends_with("[]")) {
    ASSERT_TRUE(json.is_array()) << item;
    for (const Json& part : json) expect_type(part, type.substr(0, type.size() - 2), item + "[]");
  } else if (type == "Vec3") {
    expect_type(json, "number[]", item);
    EXPECT_EQ(json.size(), 3u) << item;
  } else if (type == "number") {
    EXPECT_TRUE(json.is_number()) << item;
  } else if (type == "string") {
    EXPECT_TRUE(json.is_string()) << item;
  } else if (type == "boolean") {
    EXPECT_TRUE(json.is_boolean()) << item;
  } else if (type.starts_with('"')) {
    EXPECT_NE(type.find(json.dump()), std::string::npos) << item << " is not one of " << type;
  } else {
    expect_interface(json, type, item);
  }
}

Scene make_scene() {
  Scene scene;
  scene.title = "Door";
  scene.device.urdf = "device.urdf";
  scene.device.joints = {{"ppu1", JointType::kPrismatic}, {"m1", JointType::kRevolute}};
  scene.twin.joints = {{"free", JointType::kFloating},
                       {"glide x", JointType::kPrismatic, "glide", Eigen::Vector3d::UnitY()}};
  scene.limits = {{LimitKind::kManipulatorJoint, "m1", true, {-kInfinity, 1.0}},
                  {LimitKind::kVirtualJoint, "q4+q5", true, {0.0, 1.0}},
                  {LimitKind::kCartesian, "elbow x", false, {-1.0, 1.0}},
                  {LimitKind::kTwinJoint, "hinge", true, {0.0, 1.75}}};
  scene.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -2, -3), Eigen::Vector3d(1, 2, 3));
  return scene;
}

CycleRecord make_record() {
  CycleRecord record;
  record.time_s = 1.5;
  record.mode = Mode::kRunning;
  record.robot.q_p = Eigen::Vector2d(0.1, 0.2);
  record.robot.w_H << 1, 2, 3, 4, 5, 6;
  record.reference.q_m = Eigen::Vector3d(0.3, 0.4, 0.5);
  record.twin.q_a = Eigen::Vector2d(0.6, 0.7);
  record.T_B_H.p = Eigen::Vector3d(7, 8, 9);
  record.felt_limit = 2;
  record.limits[2].state = LimitState::kUpper;
  record.limits[2].cause = LimitCause::kPosition;
  record.limits[2].reaction = -23.4;
  record.sync_error = 0.0015;
  return record;
}

TEST(EncodeScene, HasTheFieldsOfTheTypeScriptSide) {
  const Json json = Json::parse(encode_scene(make_scene(), 60.0));
  expect_interface(json, "Scene", "scene");
  EXPECT_EQ(json["device"]["urdf"], kDeviceAddress);
  EXPECT_EQ(json["twin"]["urdf"], "");
  EXPECT_EQ(json["twin"]["joints"][0]["type"], "floating");
  EXPECT_TRUE(json["limits"][0]["min"].is_null());
  EXPECT_EQ(json["limits"][2]["unit"], "m");
}

TEST(EncodeFrame, HasTheFieldsOfTheTypeScriptSide) {
  const HandTarget hand = {true, Eigen::Vector3d(0.1, 0.2, 0.3), 0.5};
  const Json json =
      Json::parse(encode_frame(make_record(), hand, 8.0, "status", make_scene().limits));
  expect_interface(json, "Frame", "frame");
  EXPECT_EQ(json["q_device"], Json({0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(json["q_twin"], Json({0.6, 0.7}));
  EXPECT_EQ(json["p_B_H_m"], Json({7.0, 8.0, 9.0}));
  EXPECT_EQ(json["force_N"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["torque_Nm"], Json({4.0, 5.0, 6.0}));
  EXPECT_EQ(json["felt"]["text"], "elbow x: upper limit, 23 N");
  EXPECT_EQ(json["sync_error_mm"], 1.5);
  EXPECT_EQ(json["mode"], "running");
  EXPECT_EQ(json["fault"], "");
}

TEST(EncodeFrame, SaysNothingIsFeltWhenTheIndexIsOutsideTheCatalogue) {
  CycleRecord record = make_record();
  for (const int index : {-1, 4, 1'000'000}) {
    record.felt_limit = index;
    EXPECT_TRUE(
        Json::parse(encode_frame(record, {}, 0.0, "", make_scene().limits))["felt"].is_null());
  }
}

TEST(EncodeFrame, WritesNullForWhatIsNotFinite) {
  CycleRecord record = make_record();
  record.T_B_H.p.x() = std::numeric_limits<double>::quiet_NaN();
  record.robot.w_H[1] = std::numeric_limits<double>::infinity();
  const Json json = Json::parse(encode_frame(record, {}, 0.0, "", {}));
  EXPECT_TRUE(json["p_B_H_m"][0].is_null());
  EXPECT_TRUE(json["force_N"][1].is_null());
}

TEST(EncodeEvent, HasTheFieldsOfTheTypeScriptSideAndSurvivesAnyBytes) {
  const Json json = Json::parse(encode_event(1.5, "unlocked", "bad \xff byte, \"quote\" <b>"));
  expect_interface(json, "Event", "event");
  EXPECT_EQ(json["time_s"], 1.5);
}

TEST(DecodeHand, ReadsWhatThePageSends) {
  const Json json = {{"type", "hand"}, {"active", true}, {"p_B_m", {0.1, 0.2, -1}}, {"press", 1}};
  expect_interface(json, "Hand", "hand");
  HandTarget target;
  ASSERT_EQ(decode_hand(json.dump(), target), DecodeStatus::kOk);
  EXPECT_TRUE(target.active);
  EXPECT_EQ(target.p_B, Eigen::Vector3d(0.1, 0.2, -1.0));
  EXPECT_EQ(target.press, 1.0);
}

TEST(DecodeHand, RefusesEveryMissingWrongOrAdditionalField) {
  const Json good = {{"type", "hand"}, {"active", true}, {"p_B_m", {0, 0, 0}}, {"press", 0}};
  HandTarget target;
  ASSERT_EQ(decode_hand(good.dump(), target), DecodeStatus::kOk);
  for (const auto& [field, value] : good.items()) {
    Json missing = good;
    missing.erase(field);
    EXPECT_EQ(decode_hand(missing.dump(), target), DecodeStatus::kMalformed) << field;
    Json wrong = good;
    wrong[field] = {{"x", 1}};
    EXPECT_EQ(decode_hand(wrong.dump(), target), DecodeStatus::kMalformed) << field;
  }
  Json additional = good;
  additional["more"] = 1;
  EXPECT_EQ(decode_hand(additional.dump(), target), DecodeStatus::kMalformed);
  for (const char* text : {"", "{", "[]", "null", "1", "\xff\xfe", "{\"type\":\"hand\"}"}) {
    EXPECT_EQ(decode_hand(text, target), DecodeStatus::kMalformed) << text;
  }
}

TEST(DecodeHand, RefusesNumbersOutOfRange) {
  const auto decode = [](const char* x, const char* press) {
    HandTarget target;
    return decode_hand(std::string(R"({"type":"hand","active":true,"p_B_m":[)") + x +
                           R"(,0,0],"press":)" + press + "}",
                       target);
  };
  EXPECT_EQ(decode("99", "1"), DecodeStatus::kOk);
  EXPECT_EQ(decode("101", "1"), DecodeStatus::kOutOfRange);
  EXPECT_EQ(decode("-1e300", "1"), DecodeStatus::kOutOfRange);
  EXPECT_EQ(decode("0", "1.01"), DecodeStatus::kOutOfRange);
  EXPECT_EQ(decode("0", "-0.01"), DecodeStatus::kOutOfRange);
  EXPECT_NE(decode("1e999", "0"), DecodeStatus::kOk);
  EXPECT_NE(decode("NaN", "0"), DecodeStatus::kOk);
}

TEST(DecodeHand, NeverAcceptsATargetThatIsNotFinite) {
  rc::check([](const std::string& text) {
    HandTarget target;
    const std::string almost = R"({"type":"hand","active":true,"p_B_m":[0,0,)" + text + "]}";
    RC_ASSERT(decode_hand(text, target) != DecodeStatus::kOk);
    RC_ASSERT(decode_hand(almost, target) != DecodeStatus::kOk || target.p_B.allFinite());
  });
}

TEST(LimitText, NamesSideCauseAndReaction) {
  const LimitInfo elbow = {LimitKind::kCartesian, "elbow x", false, {}};
  const LimitInfo hinge = {LimitKind::kTwinJoint, "hinge", true, {}};
  LimitReport report;
  report.reaction = -4.12;
  report.state = LimitState::kLower;
  const std::pair<LimitCause, const char*> cases[] = {
      {LimitCause::kPosition, "hinge: lower limit, 4.1 Nm"},
      {LimitCause::kVelocity, "hinge: speed limit, 4.1 Nm"},
      {LimitCause::kAcceleration, "hinge: acceleration limit, 4.1 Nm"},
      {LimitCause::kLock, "hinge: locked, 4.1 Nm"},
      {LimitCause::kLatch, "hinge: latched, 4.1 Nm"},
      {LimitCause::kFriction, "hinge: held by friction, 4.1 Nm"},
      {LimitCause::kContradiction, "hinge: limits contradict each other, 4.1 Nm"}};
  for (const auto& [cause, text] : cases) {
    report.cause = cause;
    EXPECT_EQ(limit_text(hinge, report), text);
  }
  EXPECT_EQ(
      limit_text(elbow,
                 {.state = LimitState::kUpper, .cause = LimitCause::kPosition, .reaction = 23.4}),
      "elbow x: upper limit, 23 N");
  EXPECT_EQ(
      limit_text(elbow,
                 {.state = LimitState::kViolated, .cause = LimitCause::kPosition, .excess = 0.003}),
      "elbow x: limit, exceeded by 3 mm");
}

TEST(FaultText, IsEmptyWithoutAFaultAndElseGivesValueAndLimit) {
  EXPECT_EQ(fault_text({}), "");
  const std::string text = fault_text({FaultCode::kSpeedExceeded, 2, 2.6, 2.5});
  EXPECT_NE(text.find("(number 3): 2.6, limit 2.5"), std::string::npos) << text;
}

}  // namespace
}  // namespace hg::viewer_server
