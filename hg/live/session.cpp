#include "hg/live/session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "hg/core/nearest_name.h"
#include "hg/core/text.h"
#include "hg/core/visible.h"
#include "hg/messages/cdr_reader.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/ros_messages.h"
#include "hg/messages/schema.h"

namespace hg::live {
namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 16;               // nested arrays and objects of a frame
constexpr std::size_t kMostWaiting = 256;  // orders of a client without an answer
constexpr std::size_t kMostWatched = 1000;
constexpr std::size_t kMostPublished = 64;
constexpr std::size_t kMostRefusals = 10;  // reported for one frame
constexpr std::size_t kLongestName = 200;  // bytes, of names that are repeated in answers
constexpr std::size_t kLongestKnown = 64;  // bytes; a longer name is like none of ours
constexpr double kFarthest = 100.0;        // m; beyond any device
constexpr std::string_view kTrigger = "std_srvs/srv/Trigger";
constexpr std::string_view kUnlimited = "unlimited";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Frame text_frame(const Json& json) {
  // what was sent to us may be no UTF-8
  return {.head = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

// Discarded where the text is no JSON or nested too deeply.
Json parsed(std::string_view text) {
  bool is_deep = false;
  const auto look = [&](int depth, Json::parse_event_t, const Json&) {
    is_deep = is_deep || depth > kDeepest;
    return !is_deep;
  };
  Json json = Json::parse(text, look, false);
  return is_deep ? Json(Json::value_t::discarded) : json;
}

const Json* find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto field = object.find(key);
  return field == object.end() ? nullptr : &*field;
}

// Empty array: there is none of this name.
const Json& list(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const Json* field = find(object, key);
  return field != nullptr && field->is_array() ? *field : kNone;
}

std::optional<std::uint32_t> id_in(const Json* json) {
  if (json == nullptr || !json->is_number_unsigned()) return {};
  const auto id = json->get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) return {};
  return static_cast<std::uint32_t>(id);
}

// Null: no string.
const std::string* text_in(const Json* json) {
  return json != nullptr && json->is_string() ? json->get_ptr<const std::string*>() : nullptr;
}

std::string shown(std::string_view name) { return visible(name.substr(0, kLongestName)); }

std::optional<std::string> id_of_request(const Json& json) {
  const std::string* id = text_in(find(json, "id"));
  if (id == nullptr || id->size() > kLongestName) return {};
  return *id;
}

std::string schema_of_request(std::string_view part) {
  return std::string(kTrigger) + "_" + std::string(part);
}

Json service_part(std::string_view part, const std::string& schema) {
  return {{"encoding", "cdr"},
          {"schemaName", schema_of_request(part)},
          {"schemaEncoding", "ros2msg"},
          {"schema", schema}};
}

// the range and the unit are additions of ours to the protocol
Json parameter_json(const Parameter& parameter, double value) {
  Json json = {{"name", parameter.name},
               {"min", parameter.min},
               {"max", parameter.max},
               {"unit", parameter.unit}};
  if (std::isfinite(value)) {
    json["value"] = value;
    json["type"] = "float64";
  } else {
    json["value"] = kUnlimited;
  }
  return json;
}

Frame parameter_frame(Json parameters, const std::optional<std::string>& id) {
  Json json = {{"op", "parameterValues"}, {"parameters", std::move(parameters)}};
  if (id) json["id"] = *id;
  return text_frame(json);
}

std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

bool is_base(const messages::Header& header) {
  return header.frame_id == "base" || header.frame_id.empty();
}

Eigen::Vector3d vector(const messages::Vector3& v) { return {v.x, v.y, v.z}; }

std::string no_such(std::string_view what, std::string_view name,
                    const std::vector<std::string>& names) {
  std::string text = "there is no " + std::string(what) + " '" + shown(name) + "'";
  const std::string nearest = name.size() > kLongestKnown ? "" : nearest_name(name, names);
  return nearest.empty() ? text : text + "; the nearest name is '" + nearest + "'";
}

}  // namespace

std::string_view chosen_protocol(std::string_view offered) noexcept {
  while (!offered.empty()) {
    std::string_view name = offered.substr(0, offered.find(','));
    offered.remove_prefix(std::min(offered.size(), name.size() + 1));
    while (name.starts_with(' ')) name.remove_prefix(1);
    while (name.ends_with(' ')) name.remove_suffix(1);
    const auto* known = std::ranges::find(kProtocols, name);
    if (known != kProtocols.end()) return *known;
  }
  return {};
}

std::vector<Frame> Session::greeting() const {
  const Json info = {
      {"op", "serverInfo"},
      {"name", "hapticgiant"},
      {"capabilities",
       {"clientPublish", "parameters", "parametersSubscribe", "services", "assets", "time"}},
      {"supportedEncodings", {"cdr"}},
      {"metadata", {{"frame", "base"}}},
      {"sessionId", board_.session}};
  Json offers = Json::array();
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    offers.push_back({{"id", i + 1},
                      {"topic", channel.topic},
                      {"encoding", "cdr"},
                      {"schemaName", channel.schema_name},
                      {"schema", channel.schema},
                      {"schemaEncoding", "ros2msg"}});
  }
  const std::string response = messages::schema_text<messages::TriggerResponse>();
  Json services = Json::array();
  for (std::size_t i = 0; i < kServices.size(); ++i) {
    services.push_back({{"id", i + 1},
                        {"name", std::string(kServicePrefix) + std::string(kServices[i])},
                        {"type", kTrigger},
                        {"requestSchema", ""},
                        {"responseSchema", response},
                        {"request", service_part("Request", "")},
                        {"response", service_part("Response", response)}});
  }
  return {text_frame(info), text_frame({{"op", "advertise"}, {"channels", std::move(offers)}}),
          text_frame({{"op", "advertiseServices"}, {"services", std::move(services)}})};
}

Reaction Session::take(std::string_view frame, bool is_text) {
  Reaction reaction;
  if (!is_text) {
    take_binary(frame, reaction);
    return reaction;
  }
  const Json json = parsed(frame);
  if (json.is_object()) {
    take_text(json, reaction);
  } else {
    refuse("a text frame must be one JSON object", reaction);
  }
  return reaction;
}

void Session::take_text(const Json& json, Reaction& reaction) {
  const std::string* op = text_in(find(json, "op"));
  if (op == nullptr) return refuse("a text frame must have the field \"op\"", reaction);
  if (*op == "subscribe") return subscribe(json, reaction);
  if (*op == "unsubscribe") return unsubscribe(json, reaction);
  if (*op == "advertise") return advertise(json, reaction);
  if (*op == "unadvertise") return unadvertise(json, reaction);
  if (*op == "getParameters") return get_parameters(json, reaction);
  if (*op == "setParameters") return set_parameters(json, reaction);
  if (*op == "subscribeParameterUpdates") return subscribe_parameters(json, reaction, true);
  if (*op == "unsubscribeParameterUpdates") return subscribe_parameters(json, reaction, false);
  if (*op == "fetchAsset") return fetch_asset(json, reaction);
  refuse("this server has no operation '" + shown(*op) + "'", reaction);
}

void Session::take_binary(std::string_view frame, Reaction& reaction) {
  std::uint8_t op = 0;
  if (!live::take(frame, op)) return refuse("an empty binary frame", reaction);
  if (op == static_cast<std::uint8_t>(ClientOp::kMessage)) return take_message(frame, reaction);
  if (op == static_cast<std::uint8_t>(ClientOp::kServiceRequest)) {
    return call_service(frame, reaction);
  }
  refuse("a binary frame must begin with 1 (message) or 2 (service), got " + std::to_string(op),
         reaction);
}

void Session::subscribe(const Json& json, Reaction& reaction) {
  for (const Json& item : list(json, "subscriptions")) {
    const auto id = id_in(find(item, "id"));
    const auto channel = id_in(find(item, "channelId"));
    if (!id || !channel || *channel < 1 || *channel > kTopicCount) {
      refuse("a subscription must have an id and the channelId of an advertised channel", reaction);
      continue;
    }
    const bool is_taken = std::ranges::find(subscriptions_, id) != subscriptions_.end();
    std::optional<std::uint32_t>& place = subscriptions_[*channel - 1];
    if (is_taken || place) {
      refuse("subscription " + std::to_string(*id) + " to channel " + std::to_string(*channel) +
                 ": the id is in use, or the channel is subscribed already",
             reaction);
      continue;
    }
    place = id;
    const auto& latched = board_.latched[*channel - 1];
    if (latched) reaction.frames.push_back(frame_of(*latched));
  }
}

void Session::unsubscribe(const Json& json, Reaction& reaction) {
  for (const Json& item : list(json, "subscriptionIds")) {
    const auto id = id_in(&item);
    const auto known = std::ranges::find(subscriptions_, id);
    if (!id || known == subscriptions_.end()) {
      refuse("there is no such subscription to end", reaction);
    } else {
      known->reset();
    }
  }
}

void Session::advertise(const Json& json, Reaction& reaction) {
  for (const Json& item : list(json, "channels")) {
    const auto id = id_in(find(item, "id"));
    const std::string* topic = text_in(find(item, "topic"));
    const std::string* encoding = text_in(find(item, "encoding"));
    if (!id || topic == nullptr || encoding == nullptr) {
      refuse("an advertised channel must have id, topic and encoding", reaction);
      continue;
    }
    const auto* known = std::ranges::find(kClientTopics, *topic);
    if (known == kClientTopics.end()) {
      refuse(no_such("topic to publish", *topic, {kClientTopics.begin(), kClientTopics.end()}),
             reaction);
    } else if (*encoding != "cdr") {
      refuse(std::string(*known) + ": the encoding must be cdr, got '" + shown(*encoding) + "'",
             reaction);
    } else if (published_.size() >= kMostPublished || !published_.try_emplace(*id, *known).second) {
      refuse(std::string(*known) + ": the id of the channel is in use", reaction);
    }
  }
}

void Session::unadvertise(const Json& json, Reaction& reaction) {
  for (const Json& item : list(json, "channelIds")) {
    const auto id = id_in(&item);
    const auto known = id ? published_.find(*id) : published_.end();
    if (known == published_.end()) {
      refuse("there is no such channel to end", reaction);
      continue;
    }
    const std::string_view topic = known->second;
    published_.erase(known);
    let_go(topic, reaction);
  }
}

void Session::let_go(std::string_view topic, Reaction& reaction) {
  if (topic == kHandTargetTopic) {
    reaction.hand = HandTarget{};
  } else {
    reaction.wrench = Vector6::Zero();
  }
}

void Session::get_parameters(const Json& json, Reaction& reaction) const {
  Json values = Json::array();
  const Json& names = list(json, "parameterNames");
  for (const Parameter& parameter : board_.parameters) {
    const bool is_asked =
        names.empty() || std::ranges::find(names, Json(parameter.name)) != names.end();
    if (is_asked) values.push_back(parameter_json(parameter, parameter.value));
  }
  reaction.frames.push_back(parameter_frame(std::move(values), id_of_request(json)));
}

void Session::set_parameters(const Json& json, Reaction& reaction) {
  Setting setting{.id = id_of_request(json)};
  const std::uint64_t number = next_setting_++;
  for (const Json& item : list(json, "parameters")) {
    const std::string* name = text_in(find(item, "name"));
    const Json* value = find(item, "value");
    if (name == nullptr) {
      refuse("a parameter must have a name", reaction);
      continue;
    }
    const Parameter* parameter = board_.find_parameter(*name);
    if (parameter == nullptr && reaction.refusals >= kMostRefusals) {
      refuse({}, reaction);
      continue;
    }
    if (parameter == nullptr) {
      std::vector<std::string> names;
      for (const Parameter& known : board_.parameters) names.push_back(known.name);
      refuse(no_such("parameter", *name, names), reaction);
      continue;
    }
    const double number_in = value != nullptr && value->is_number() ? value->get<double>() : kNan;
    setting.names.push_back(*name);
    setting.values.push_back(kNan);
    if (!(number_in >= parameter->min && number_in <= parameter->max)) {
      refuse(*name + ": must be a number of " + hg::to_text(parameter->min) + " .. " +
                 hg::to_text(parameter->max) + (parameter->unit.empty() ? "" : " ") +
                 parameter->unit + ", got " +
                 (value == nullptr
                      ? "none"
                      : shown(value->dump(-1, ' ', true, Json::error_handler_t::replace))),
             reaction);
    } else if (places_.size() >= kMostWaiting) {
      refuse(*name + ": too many changes are waiting", reaction);
    } else {
      setting.values.back() = number_in;
      places_[next_order_] = {number, setting.values.size() - 1};
      reaction.orders.push_back({next_order_++, Order::Kind::kSet, *name, number_in});
      ++setting.waiting;
    }
  }
  if (setting.waiting == 0) return end_setting(setting, reaction);
  settings_[number] = std::move(setting);
}

// The values in force from now on: those that were followed, else the present ones.
void Session::end_setting(const Setting& setting, Reaction& reaction) const {
  Json values = Json::array();
  bool is_refused = false;
  for (std::size_t i = 0; i < setting.names.size(); ++i) {
    const Parameter* parameter = board_.find_parameter(setting.names[i]);
    if (parameter == nullptr) continue;  // of a run that is over
    const double asked = setting.values[i];
    is_refused = is_refused || std::isnan(asked);
    values.push_back(parameter_json(*parameter, std::isnan(asked) ? parameter->value : asked));
  }
  // without an id only those who watch get it; a refused value is reported in any case
  if (setting.id || is_refused) {
    reaction.frames.push_back(parameter_frame(std::move(values), setting.id));
  }
}

void Session::subscribe_parameters(const Json& json, Reaction& reaction, bool is_on) {
  const Json& names = list(json, "parameterNames");
  if (names.empty()) {  // all
    watches_all_ = is_on;
    watched_.clear();
    return;
  }
  for (const Json& item : names) {
    const std::string* name = text_in(&item);
    if (name == nullptr || name->size() > kLongestName) {
      refuse("names of parameters must be texts", reaction);
    } else if (!is_on) {
      watched_.erase(*name);
    } else if (watched_.size() < kMostWatched) {
      watched_.insert(*name);
    }
  }
}

std::vector<Frame> Session::changed_parameters(const std::vector<std::string>& names) const {
  Json values = Json::array();
  for (const std::string& name : names) {
    const Parameter* parameter = board_.find_parameter(name);
    const bool is_watched = watches_all_ || watched_.contains(name);
    if (is_watched && parameter != nullptr) {
      values.push_back(parameter_json(*parameter, parameter->value));
    }
  }
  if (values.empty()) return {};
  return {parameter_frame(std::move(values), {})};
}

void Session::fetch_asset(const Json& json, Reaction& reaction) const {
  const auto request = id_in(find(json, "requestId"));
  const std::string* uri = text_in(find(json, "uri"));
  if (!request || uri == nullptr) {
    return refuse("fetchAsset must have requestId and uri", reaction);
  }
  Bytes content = board_.find_asset ? board_.find_asset(*uri) : nullptr;
  const std::string error = content != nullptr ? "" : "there is no asset " + shown(*uri);
  Frame frame{.is_text = false, .head = begin_frame(ServerOp::kAssetResponse)};
  append(frame.head, *request);
  append(frame.head, static_cast<std::uint8_t>(content == nullptr));
  append(frame.head, static_cast<std::uint32_t>(error.size()));
  frame.head += error;
  reaction.is_refused = content == nullptr;
  frame.payload = std::move(content);
  reaction.frames.push_back(std::move(frame));
}

void Session::call_service(std::string_view bytes, Reaction& reaction) {
  Call call;
  std::uint32_t length = 0;
  const bool is_whole = live::take(bytes, call.service) && live::take(bytes, call.call) &&
                        live::take(bytes, length) && length <= bytes.size();
  if (!is_whole) return refuse("a service request is too short", reaction);
  const bool is_known = call.service >= 1 && call.service <= kServices.size();
  const bool is_stop = is_known && kServices[call.service - 1] == "stop";
  std::string why_not;
  if (!is_known) {
    why_not = "there is no service of this id";
  } else if (bytes.substr(0, length) != "cdr") {
    why_not = "the encoding of the request must be cdr";
  } else if (!is_stop && calls_.size() >= kMostWaiting) {
    why_not = "too many requests are waiting";
  }
  if (!why_not.empty()) {
    reaction.is_refused = true;
    reaction.frames.push_back(text_frame({{"op", "serviceCallFailure"},
                                          {"serviceId", call.service},
                                          {"callId", call.call},
                                          {"message", why_not}}));
    return;
  }
  calls_[next_order_] = call;
  reaction.orders.push_back(
      {next_order_++, Order::Kind::kService, std::string(kServices[call.service - 1])});
}

Reaction Session::answer(double order, std::string_view refusal) {
  Reaction reaction;
  if (const auto call = calls_.find(order); call != calls_.end()) {
    messages::CdrWriter cdr;
    const auto response = cdr.encode(messages::TriggerResponse{
        refusal.empty(), refusal.empty() ? "done" : std::string(refusal)});
    Frame frame{.is_text = false, .head = begin_frame(ServerOp::kServiceResponse)};
    append(frame.head, call->second.service);
    append(frame.head, call->second.call);
    append(frame.head, std::uint32_t{3});
    frame.head += "cdr";
    frame.head.append(reinterpret_cast<const char*>(response.data()), response.size());
    reaction.frames.push_back(std::move(frame));
    calls_.erase(call);
  } else if (const auto place = places_.find(order); place != places_.end()) {
    const auto setting = settings_.find(place->second.setting);
    const std::size_t index = place->second.index;
    places_.erase(place);
    if (!refusal.empty()) {
      setting->second.values[index] = kNan;
      refuse(setting->second.names[index] + ": " + std::string(refusal), reaction);
    }
    if (--setting->second.waiting == 0) {
      end_setting(setting->second, reaction);
      settings_.erase(setting);
    }
  }
  return reaction;
}

void Session::take_message(std::string_view bytes, Reaction& reaction) {
  std::uint32_t channel = 0;
  if (!live::take(bytes, channel)) return refuse("a message is too short", reaction);
  const auto known = published_.find(channel);
  if (known == published_.end()) {
    return refuse("channel " + std::to_string(channel) + " was not advertised", reaction);
  }
  if (known->second == kHandTargetTopic) return take_hand(bytes, reaction);
  take_wrench(bytes, reaction);
}

// Whether it is a message of this type in the frame base; refused otherwise.
template <typename Stamped>
bool Session::decode(std::string_view payload, std::string_view topic, std::string_view type,
                     Stamped& message, Reaction& reaction) {
  const std::string place = std::string(topic) + ": ";
  if (!messages::CdrReader(as_bytes(payload)).decode(message)) {
    refuse(place + "must be a " + std::string(type), reaction);
    return false;
  }
  if (!is_base(message.header)) {
    refuse(place + "frame_id must be 'base', got '" + shown(message.header.frame_id) + "'",
           reaction);
    return false;
  }
  return true;
}

void Session::take_hand(std::string_view payload, Reaction& reaction) {
  messages::PoseStamped message;
  if (!decode(payload, kHandTargetTopic, "geometry_msgs/msg/PoseStamped", message, reaction)) {
    return;
  }
  const messages::Point& p = message.pose.position;
  const messages::Quaternion& q = message.pose.orientation;
  const Eigen::Vector4d xyzw(q.x, q.y, q.z, q.w);
  HandTarget target{.active = true, .p_B = {p.x, p.y, p.z}, .press = 1.0};
  const bool is_near = target.p_B.allFinite() && target.p_B.cwiseAbs().maxCoeff() <= kFarthest;
  target.turns = !xyzw.isZero(0.0);
  const bool is_rotation = !target.turns || std::abs(xyzw.squaredNorm() - 1.0) < 1e-3;
  if (!is_near || !is_rotation) {
    return refuse(
        "/hand_target: the position must be within 100 m, the quaternion of length 1, or zero: "
        "free to turn",
        reaction);
  }
  if (target.turns) {
    target.R_B = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  }
  reaction.hand = target;
}

void Session::take_wrench(std::string_view payload, Reaction& reaction) {
  messages::WrenchStamped message;
  if (!decode(payload, kReferenceWrenchTopic, "geometry_msgs/msg/WrenchStamped", message,
              reaction)) {
    return;
  }
  Vector6 w;
  w << vector(message.wrench.force), vector(message.wrench.torque);
  if (!w.allFinite()) return refuse("/reference_wrench: must be finite", reaction);
  reaction.wrench = w;
}

Frame Session::frame_of(const Message& message) const {
  Frame frame{
      .is_text = false, .head = begin_frame(ServerOp::kMessage), .payload = message.payload};
  append(frame.head, subscriptions_[message.channel].value_or(0));
  append(frame.head, message.time_ns);
  return frame;
}

Frame Session::time_frame(std::uint64_t time_ns) {
  Frame frame{.is_text = false, .head = begin_frame(ServerOp::kTime)};
  append(frame.head, time_ns);
  return frame;
}

Frame Session::status(int level, std::string_view text, std::string_view id) {
  Json json = {{"op", "status"}, {"level", level}, {"message", text}};
  if (!id.empty()) json["id"] = id;
  return text_frame(json);
}

void Session::refuse(std::string_view why, Reaction& reaction) {
  reaction.is_refused = true;
  if (++reaction.refusals > kMostRefusals + 1) return;
  const bool is_reported = reaction.refusals <= kMostRefusals;
  reaction.frames.push_back(status(kWarning, is_reported ? why : "and more that was refused"));
}

}  // namespace hg::live
