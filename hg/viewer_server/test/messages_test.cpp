#include "hg/viewer_server/messages.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "hg/core/enumerators.h"
#include "hg/core/index.h"
#include "hg/core/open_file.h"
#include "hg/core/test/unit_words.h"
#include "hg/viewer_server/access.h"
#include "hg/viewer_server/command_message.h"
#include "hg/viewer_server/frame_message.h"
#include "hg/viewer_server/frame_parts_message.h"
#include "hg/viewer_server/limit_text.h"
#include "hg/viewer_server/scene_message.h"
#include "hg/viewer_server/scene_parts_message.h"

namespace hg::viewer_server {
namespace {

using Json = nlohmann::json;
constexpr char kTypes[] = "viewer/src/messages.ts";

using Fields = std::map<std::string, std::string>;  // name to type, as written in TypeScript

// The interfaces of messages.ts.
std::map<std::string, Fields> read_interfaces() {
  const std::string source = read_file(kTypes);
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
    type.resize(type.size() - 2);
    if (type.starts_with('(')) type = type.substr(1, type.size() - 2);
    for (const Json& part : json) expect_type(part, type, item + "[]");
  } else if (type == "Quaternion") {
    expect_type(json, "number[]", item);
    EXPECT_EQ(json.size(), 4u) << item;
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
  scene.device.name = "Arm";
  scene.device.urdf = "device.urdf";
  scene.device.joints = {{"ppu1", JointType::kPrismatic}, {"m1", JointType::kRevolute}};
  scene.device.joints[1].range = {-1.0, kInfinity};
  scene.gantry_joints = 1;
  scene.choices = {.scenario = "door", .scenarios = {{"door", "Door"}}};
  scene.settings = {{.name = "hinge.damping", .group = "hinge", .max = 10.0, .value = kInfinity}};
  scene.surfaces = {{.name = "table", .shape = SurfaceShape::kMesh, .triangles = {1.0}}};
  scene.shapes = {{.name = "hand_1", .link = "hand", .radius = 0.05, .length = 0.2}};
  scene.checkpoints = {{"first", 1.0, 2.0, 0.5}};
  scene.teleoperation = {.method = "model_mediated", .axes = {{"x", {-0.5, kInfinity}}}};
  scene.teleoperation->walls = {{{0.0, -1.0, 0.0}, -0.2}};
  scene.commands = {CommandName::kPause, CommandName::kSet};
  scene.twin.joints = {{"free", JointType::kFloating},
                       {"glide x", JointType::kPrismatic, "glide", Eigen::Vector3d::UnitY()}};
  scene.limits = {{LimitKind::kManipulatorJoint, "m1", true, {-kInfinity, 1.0}},
                  {LimitKind::kVirtualJoint, "q4+q5", true, {0.0, 1.0}},
                  {LimitKind::kCartesian, "elbow x", false, {-1.0, 1.0}},
                  {LimitKind::kTwinJoint, "hinge", true, {0.0, 1.75}}};
  scene.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -2, -3), Eigen::Vector3d(1, 2, 3));
  return scene;
}

View make_view() {
  View view;
  view.hand = {true, Eigen::Vector3d(0.1, 0.2, 0.3), 0.5};
  view.cycle_time_us = 8.0;
  view.status_text = "status";
  CycleRecord& record = view.record;
  record.time_s = 1.5;
  record.mode = Mode::kRunning;
  record.robot.q_p = Eigen::Vector2d(0.1, 0.2);
  record.robot.q_m = Eigen::Vector3d(0.31, 0.41, 0.51);
  record.robot.w_H << 1, 2, 3, 4, 5, 6;
  record.reference.q_m = Eigen::Vector3d(0.3, 0.4, 0.5);
  record.twin.q_a = Eigen::Vector2d(0.6, 0.7);
  record.T_B_H.p = Eigen::Vector3d(7, 8, 9);
  record.felt_limit = 2;
  record.limits[2].state = LimitState::kUpper;
  record.limits[2].cause = LimitCause::kPosition;
  record.limits[2].reaction = -23.4;
  record.limits[2].to_upper = 0.25;
  record.limits[2].to_lower = 1.75;
  record.contact.surface = 0;
  record.sync_error = 0.0015;
  view.budget.inertia << 1, 0, 0, 0, 0, 2;
  view.singularity = {0.5, 1};
  view.ghost = Ghost{.time_s = 1.25};
  view.teleoperation = TeleoperationView{};
  view.twin_base = {.is_moving = true, .T_B_A = {Eigen::Vector3d(1, 2, 3), {}}};
  view.twin_base.T_B_A.R.setIdentity();
  view.twin_base.twist << 1, 2, 3, 4, 5, 6;
  view.twin_base.acceleration << 7, 8, 9, 10, 11, 12;
  view.ghost->twin_base = view.twin_base;
  view.ghost->record.twin.q_a = ConfigurationA::Constant(1, 2.0);
  return view;
}

Json frame_of(const View& view, const LimitCatalogue& limits = make_scene().limits) {
  return Json::parse(encode_frame(view, limits, 2));
}

// Names of the fields of a struct.
struct Names {
  std::vector<std::string> list;
  template <typename T>
  void operator()(const char* name, const T&, const char* = "", const Unit& = unit::kNone) {
    list.emplace_back(name);
  }
};

template <typename Struct>
void expect_all_in_typescript(const std::string& interface) {
  Names names;
  fields(names, static_cast<const Struct&>(Struct{}));
  const Fields in_typescript = read_interfaces()[interface];
  EXPECT_EQ(in_typescript.size(), names.list.size()) << interface;
  for (const std::string& name : names.list) {
    EXPECT_TRUE(in_typescript.contains(name)) << interface << "." << name;
  }
}

TEST(MessagesTs, HasAllFieldsOfStructsThatAreSentAsTheyAre) {
  expect_all_in_typescript<ContactReport>("Contact");
  expect_all_in_typescript<HandBudget>("Budget");
  expect_all_in_typescript<Singularity>("Singularity");
  expect_all_in_typescript<RunState>("RunState");
}

// Fields with a unit in their note, and floating-point numbers whose unit stands neither in their
// name nor in the list.
struct UnitFaults {
  std::vector<std::string> list;

  void type(std::string_view) {}
  template <typename T>
  void operator()(std::string_view name, const T& value, std::string_view note = {}) {
    static const std::regex unit(".*_(s|us|m|mm|rad|deg|N|Nm|Hz|hz|m_per_s)");
    if (kIsNumber<T> && !std::regex_match(std::string(name), unit)) list.emplace_back(name);
    (*this)(name, value, note, unit::kNone);
  }
  template <typename T>
  void operator()(std::string_view, const T&, std::string_view note, const Unit&) {
    if (!unit_word_in(note).empty()) list.emplace_back(note);
  }

 private:
  template <typename T>
  static constexpr bool kIsNumber =
      std::is_same_v<T, double> || std::is_same_v<T, Vec3> || std::is_same_v<T, Eigen::Vector3d> ||
      std::is_same_v<T, std::optional<double>> || std::is_same_v<T, std::vector<double>> ||
      std::is_same_v<T, std::vector<std::optional<double>>>;
};

template <typename... Messages>
std::vector<std::string> unit_faults(const Messages&... messages) {
  UnitFaults faults;
  (fields(faults, messages), ...);
  return faults.list;
}

TEST(Messages, DeclareTheUnitOfEveryNumberOutsideOfTheNote) {
  const View view = make_view();
  const LimitCatalogue limits;
  EXPECT_EQ(
      unit_faults(Scene{}, SceneChain{}, SceneJoint{}, SceneFollower{}, SceneLimitMessage{},
                  Eigen::AlignedBox3d{}, SceneSurface{}, SceneShape{}, SceneCheckpoint{}, Choices{},
                  Choice{}, Setting{}, SceneTeleoperation{}, SceneAxis{}, SceneWall{}),
      std::vector<std::string>{});
  EXPECT_EQ(unit_faults(FrameMessage{view, limits}, FeltLimitMessage{}, ActiveLimitMessage{},
                        ContactReport{}, HandBudget{}, Singularity{}, RunState{},
                        SafetyMessage{view}, TwinBaseMessage{}, Ghost{}, TeleoperationView{}),
            std::vector<std::string>{});
  EXPECT_EQ(unit_faults(HandMessage{}, HoldMessage{}, CommandMessage{}, WelcomeMessage{},
                        AnswerMessage{}, ValuesMessage{}, EventMessage{}),
            std::vector<std::string>{});
}

TEST(MessagesTs, HasTheFieldsThatAreChosenByName) {
  auto interfaces = read_interfaces();
  for (const char* name : {"state", "cause", "reaction", "excess"}) {
    EXPECT_TRUE(interfaces["ActiveLimit"].contains(name)) << name;
  }
  for (const char* name : {"operator_enable", "override_key", "person_in_field"}) {
    EXPECT_TRUE(interfaces["Safety"].contains(name)) << name;
  }
}

TEST(EncodeFrame, NamesThePageThatHasTheHand) {
  const Scene scene = make_scene();
  const Json json =
      Json::parse(encode_frame(make_view(), scene.limits, 2, {.page = 1, .asked_by = 2}));
  EXPECT_EQ(json["hand_page"], 1);
  EXPECT_EQ(json["hand_asked_by"], 2);
  EXPECT_EQ(frame_of(make_view())["hand_page"], 0);
}

TEST(EncodeScene, HasTheFieldsOfTheTypeScriptSide) {
  const Json json = Json::parse(encode_scene(make_scene(), 60.0));
  expect_interface(json, "Scene", "scene");
  EXPECT_EQ(json["device"]["name"], "Arm");
  EXPECT_EQ(json["device"]["urdf"], kDeviceAddress);
  EXPECT_EQ(json["twin"]["urdf"], "");
  EXPECT_EQ(json["twin"]["joints"][0]["type"], "floating");
  EXPECT_TRUE(json["limits"][0]["min"].is_null());
  EXPECT_EQ(json["limits"][2]["unit"], "m");
  EXPECT_EQ(json["device"]["joints"][1]["q_min"], -1.0);
  EXPECT_TRUE(json["device"]["joints"][1]["q_max"].is_null());
  EXPECT_EQ(json["shapes"][0]["link"], "hand");
  EXPECT_EQ(json["shapes"][0]["length_m"], 0.2);
  EXPECT_EQ(json["commands"], Json({"pause", "set"}));
  EXPECT_TRUE(json["settings"][0]["value"].is_null());
}

TEST(EncodeScene, CountsPrioritiesAsTheLevelsOfTheLaw) {
  Scene scene;
  const auto add = [&](LimitKind kind, int count) {
    for (int i = 0; i < count; ++i) scene.limits.push_back({kind, "x", false, {}});
  };
  add(LimitKind::kManipulatorJoint, 2);
  add(LimitKind::kVirtualJoint, 1);
  add(LimitKind::kCartesian, 6);  // two frames
  add(LimitKind::kTwinJoint, 1);
  const Json limits = Json::parse(encode_scene(scene, 60.0))["limits"];
  std::vector<int> priorities;
  for (const Json& limit : limits) priorities.push_back(limit["priority"]);
  EXPECT_EQ(priorities, (std::vector<int>{2, 2, 3, 4, 4, 4, 5, 5, 5, 6}));
}

TEST(EncodeFrame, HasTheFieldsOfTheTypeScriptSide) {
  const Json json = frame_of(make_view());
  expect_interface(json, "Frame", "frame");
  EXPECT_EQ(json["q_device"], Json({0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(json["q_measured"], Json({0.1, 0.2, 0.31, 0.41, 0.51}));
  EXPECT_EQ(json["q_twin"], Json({0.6, 0.7}));
  EXPECT_EQ(json["p_B_H_m"], Json({7.0, 8.0, 9.0}));
  EXPECT_EQ(json["force_N"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["torque_Nm"], Json({4.0, 5.0, 6.0}));
  EXPECT_EQ(json["felt"]["text"], "elbow x: upper limit, 23 N");
  EXPECT_EQ(json["sync_error_mm"], 1.5);
  EXPECT_EQ(json["mode"], "running");
  EXPECT_EQ(json["fault"], "");
  EXPECT_EQ(json["clients"], 2);
  EXPECT_EQ(json["budget"]["inertia"]["torque_Nm"], Json({0.0, 0.0, 2.0}));
  EXPECT_EQ(json["ghost"]["q_twin"], Json({2.0}));
}

TEST(EncodeFrame, HasTheMovingBaseOfTheTwinOrNone) {
  View view = make_view();
  const Json base = frame_of(view)["twin_base"];
  EXPECT_EQ(base["p_B_m"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(base["quaternion_B"], Json({0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(base["v_m_per_s"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(base["omega"], Json({4.0, 5.0, 6.0}));
  EXPECT_EQ(base["a"], Json({7.0, 8.0, 9.0}));
  EXPECT_EQ(frame_of(view)["ghost"]["twin_base"], base);
  view.twin_base.is_moving = view.ghost->twin_base.is_moving = false;
  EXPECT_TRUE(frame_of(view)["twin_base"].is_null());
  EXPECT_TRUE(frame_of(view)["ghost"]["twin_base"].is_null());
}

TEST(EncodeFrame, NamesTheLimitsThatActAndTheDistanceToTheNearerEnd) {
  const Json json = frame_of(make_view());
  ASSERT_EQ(json["active"].size(), 1u);
  EXPECT_EQ(json["active"][0]["index"], 2);
  EXPECT_EQ(json["active"][0]["state"], "upper");
  EXPECT_EQ(json["active"][0]["cause"], "position");
  EXPECT_EQ(json["active"][0]["reaction"], -23.4);
  EXPECT_EQ(json["limit_distance"], Json({nullptr, nullptr, 0.25, nullptr}));
}

TEST(EncodeFrame, StaysSmallForADeviceWithSevenJointsAndATwinWithSix) {
  View view = make_view();
  LimitCatalogue limits;
  for (int i = 0; i < 21; ++i) limits.push_back({LimitKind::kCartesian, "elbow x", false, {}});
  const double digits = -1.23456;
  view.record.robot.q_m = view.record.robot.dq_m = view.record.robot.tau_m =
      view.record.reference.q_m = view.record.reference.dq_m = view.record.tracking.error =
          VectorM::Constant(7, digits);
  view.record.twin.q_a = ConfigurationA::Constant(7, digits);
  view.record.twin.dq_a = VectorA::Constant(6, digits);
  for (LimitReport& report : view.record.limits) {
    report.position = report.to_lower = digits;
  }
  view.budget.user = view.budget.inertia = view.budget.rest = Vector6::Constant(digits);
  EXPECT_LT(encode_frame(view, limits, 4).size(), 4096u);
}

TEST(EncodeFrame, HasNoFeltLimitWhenTheIndexIsOutsideTheCatalogue) {
  View view = make_view();
  for (const int index : {-1, 4, 1'000'000}) {
    view.record.felt_limit = index;
    EXPECT_TRUE(frame_of(view)["felt"].is_null());
  }
}

TEST(EncodeFrame, WritesNullForWhatIsNotFinite) {
  View view = make_view();
  view.record.T_B_H.p.x() = std::numeric_limits<double>::quiet_NaN();
  view.record.robot.w_H[1] = std::numeric_limits<double>::infinity();
  const Json json = frame_of(view);
  EXPECT_TRUE(json["p_B_H_m"][0].is_null());
  EXPECT_TRUE(json["force_N"][1].is_null());
}

TEST(EncodeFrame, RoundsToAHundredThousandthAndKeepsWhatIsLarge) {
  View view = make_view();
  view.record.T_B_H.p = {0.123456789, -1e-9, 1.5e300};
  EXPECT_EQ(frame_of(view)["p_B_H_m"], Json({0.12346, 0.0, 1.5e300}));
}

TEST(EncodeEvent, HasTheFieldsOfTheTypeScriptSideAndSurvivesAnyBytes) {
  const Json json = Json::parse(encode_event(3, 1.5, "unlocked", "bad \xff byte, \"quote\" <b>"));
  expect_interface(json, "Event", "event");
  EXPECT_EQ(json["time_s"], 1.5);
  EXPECT_EQ(json["run"], 3);
}

TEST(EncodeAnswerAndValues, HaveTheFieldsOfTheTypeScriptSide) {
  const Json accepted = Json::parse(encode_answer(7, ""));
  expect_interface(accepted, "Answer", "answer");
  EXPECT_EQ(accepted["is_accepted"], true);
  EXPECT_EQ(Json::parse(encode_answer(7, "no"))["is_accepted"], false);
  const Json values = Json::parse(encode_values({1.5, kInfinity}));
  expect_interface(values, "Values", "values");
  EXPECT_EQ(values["values"], Json({1.5, nullptr}));
}

// The status alone; hands go to `target`.
DecodeStatus decode_hand(std::string_view text, HandTarget& target) {
  PageMessage message;
  const DecodeStatus status = decode(text, message);
  if (status == DecodeStatus::kHand) target = message.hand;
  return status;
}

Json good_command() {
  return {{"type", "command"}, {"id", 7}, {"command", "set"}, {"name", "x"}, {"value", 1.5}};
}

TEST(DecodeCommand, ReadsWhatThePageSends) {
  expect_interface(good_command(), "Command", "command");
  PageMessage message;
  ASSERT_EQ(decode(good_command().dump(), message), DecodeStatus::kCommand);
  EXPECT_EQ(message.command.id, 7.0);
  EXPECT_EQ(message.command.name, CommandName::kSet);
  EXPECT_EQ(message.command.argument, "x");
  EXPECT_EQ(message.command.value, 1.5);
}

TEST(DecodeCommand, RefusesEveryMissingWrongOrAdditionalField) {
  const Json good = good_command();
  PageMessage message;
  for (const auto& [field, value] : good.items()) {
    Json missing = good;
    missing.erase(field);
    EXPECT_EQ(decode(missing.dump(), message), DecodeStatus::kMalformed) << field;
    Json wrong = good;
    wrong[field] = {{"x", 1}};
    EXPECT_EQ(decode(wrong.dump(), message), DecodeStatus::kMalformed) << field;
  }
  Json additional = good;
  additional["more"] = 1;
  EXPECT_EQ(decode(additional.dump(), message), DecodeStatus::kMalformed);
  Json unknown = good;
  unknown["command"] = "format disk";
  EXPECT_EQ(decode(unknown.dump(), message), DecodeStatus::kMalformed);
}

TEST(DecodeCommand, RefusesAFieldThatIsThereTwice) {
  const std::string good = good_command().dump();
  PageMessage message;
  ASSERT_EQ(decode(good, message), DecodeStatus::kCommand);
  for (const char* twice : {R"("id":1,)", R"("command":"stop",)", R"("type":"command",)"}) {
    EXPECT_EQ(decode("{" + (twice + good.substr(1)), message), DecodeStatus::kMalformed) << twice;
  }
  EXPECT_EQ(decode(R"({"type":"hold","sequence":1,"sequence":2})", message),
            DecodeStatus::kMalformed);
}

TEST(EncodeAnswer, ShowsNothingButText) {
  const Json answer = Json::parse(encode_answer(1.0, "no \u202Eoirnecs \x1b[2J\xc0\x9b"));
  EXPECT_EQ(answer["reason"], "no \\xe2\\x80\\xaeoirnecs \\x1b[2J\\xc0\\x9b");
}

TEST(DecodeCommand, RefusesIdsAndNamesOutOfRange) {
  PageMessage message;
  for (const Json& id : {Json(-1), Json(0.5), Json(1e300)}) {
    Json command = good_command();
    command["id"] = id;
    EXPECT_EQ(decode(command.dump(), message), DecodeStatus::kOutOfRange) << id;
  }
  Json command = good_command();
  command["name"] = std::string(201, 'x');
  EXPECT_EQ(decode(command.dump(), message), DecodeStatus::kOutOfRange);
}

TEST(DecodeHold, TakesWholeSequenceNumbersOnly) {
  const Json good = {{"type", "hold"}, {"sequence", 12}};
  expect_interface(good, "Hold", "hold");
  expect_interface(Json::parse(encode_welcome(3)), "Welcome", "welcome");
  PageMessage message;
  ASSERT_EQ(decode(good.dump(), message), DecodeStatus::kHold);
  EXPECT_EQ(message.hold, 12.0);
  for (const char* text :
       {R"({"type":"hold","sequence":-1})", R"({"type":"hold","sequence":0.5})"}) {
    EXPECT_EQ(decode(text, message), DecodeStatus::kOutOfRange) << text;
  }
  for (const char* text : {R"({"type":"hold"})", R"({"type":"hold","sequence":"1"})",
                           R"({"type":"hold","sequence":1,"more":1})"}) {
    EXPECT_EQ(decode(text, message), DecodeStatus::kMalformed) << text;
  }
}

TEST(DecodeHand, ReadsWhatThePageSends) {
  const Json json = {{"type", "hand"},
                     {"active", true},
                     {"p_B_m", {0.1, 0.2, -1}},
                     {"quaternion_B_H", nullptr},
                     {"press", 1}};
  expect_interface(json, "Hand", "hand");
  HandTarget target;
  ASSERT_EQ(decode_hand(json.dump(), target), DecodeStatus::kHand);
  EXPECT_TRUE(target.active);
  EXPECT_EQ(target.p_B, Eigen::Vector3d(0.1, 0.2, -1.0));
  EXPECT_EQ(target.press, 1.0);
}

TEST(DecodeHand, ReadsATurnAndRefusesOneThatIsNoRotation) {
  Json json = {{"type", "hand"},
               {"active", true},
               {"p_B_m", {0, 0, 0}},
               {"quaternion_B_H", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
               {"press", 0}};
  HandTarget target;
  ASSERT_EQ(decode_hand(json.dump(), target), DecodeStatus::kHand);
  ASSERT_TRUE(target.turns);
  EXPECT_LT((target.R_B * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  View view;
  view.hand = target;
  EXPECT_NEAR(frame_of(view)["hand"]["quaternion_B_H"][2], std::sqrt(0.5), 1e-5);
  for (const Json& turn : {Json{0, 0, 0, 0}, Json{0, 0, 1, 1}}) {
    json["quaternion_B_H"] = turn;
    EXPECT_EQ(decode_hand(json.dump(), target), DecodeStatus::kOutOfRange) << turn;
  }
}

TEST(DecodeHand, RefusesEveryMissingWrongOrAdditionalField) {
  const Json good = {{"type", "hand"}, {"active", true}, {"p_B_m", {0, 0, 0}}, {"press", 0}};
  HandTarget target;
  ASSERT_EQ(decode_hand(good.dump(), target), DecodeStatus::kHand);
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
  EXPECT_EQ(decode("99", "1"), DecodeStatus::kHand);
  EXPECT_EQ(decode("101", "1"), DecodeStatus::kOutOfRange);
  EXPECT_EQ(decode("-1e300", "1"), DecodeStatus::kOutOfRange);
  EXPECT_EQ(decode("0", "1.01"), DecodeStatus::kOutOfRange);
  EXPECT_EQ(decode("0", "-0.01"), DecodeStatus::kOutOfRange);
  EXPECT_NE(decode("1e999", "0"), DecodeStatus::kHand);
  EXPECT_NE(decode("NaN", "0"), DecodeStatus::kHand);
}

TEST(DecodeHand, NeverAcceptsATargetThatIsNotFinite) {
  rc::check([](const std::string& text) {
    HandTarget target;
    const std::string almost = R"({"type":"hand","active":true,"p_B_m":[0,0,)" + text + "]}";
    RC_ASSERT(decode_hand(text, target) != DecodeStatus::kHand);
    RC_ASSERT(decode_hand(almost, target) != DecodeStatus::kHand || target.p_B.allFinite());
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
      {LimitCause::kContradiction, "hinge: limits contradict each other, 4.1 Nm"},
      {LimitCause::kBraking,
       "hinge: slower here, at this speed it could not stop before its end, 4.1 Nm"}};
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

// The words of the page are those of the program, all of them.
template <typename E>
void expect_all_words() {
  const auto all = enumerators<E>();
  ASSERT_EQ(words<E>().size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(hg::index(all[i].value), i);
    EXPECT_EQ(words<E>()[i], to_string(all[i].value)) << all[i].name;
  }
}

TEST(Words, AreThoseOfEveryEnumerator) {
  expect_all_words<Mode>();
  expect_all_words<Stop>();
  expect_all_words<LimitKind>();
  expect_all_words<LimitState>();
  expect_all_words<LimitCause>();
}

}  // namespace
}  // namespace hg::viewer_server
