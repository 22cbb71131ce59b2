#include "apps/ros2/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hg/messages/cdr_reader.h"

namespace hg::ros2 {
namespace {

using nlohmann::json;

constexpr std::size_t kMostWaiting = 64;
constexpr std::chrono::seconds kPatience(2);
constexpr std::string_view kId = "ros2-";
constexpr std::string_view kNoRun = "no run is connected";
// a run takes values one by one, so that it could refuse the second after the first
constexpr std::string_view kOneOnly =
    "expected one parameter: several cannot be set as one; nothing is changed";
constexpr std::string_view kUnlimited = "unlimited";  // of the live interface

const json* find(const json& values, const std::string& name) {
  for (const json& one : values) {
    if (one.value("name", "") == name) return &one;
  }
  return nullptr;
}

ParameterValue value_of(const json& values, const std::string& name) {
  const json* found = find(values, name);
  return found != nullptr && found->contains("value") ? to_value(found->at("value"))
                                                      : ParameterValue{};
}

// an infinite end is null in JSON
double end_of_range(const json& parameter, const char* name, double infinite) {
  const auto found = parameter.find(name);
  return found != parameter.end() && found->is_number() ? found->get<double>() : infinite;
}

ParameterDescriptor describe(const json& values, const std::string& name) {
  ParameterDescriptor made = {.name = name, .type = value_of(values, name).type};
  const json* found = find(values, name);
  if (found == nullptr) return made;
  if (const std::string unit = found->value("unit", ""); !unit.empty()) {
    made.description = "in " + unit;
  }
  if (made.type == ParameterValue::kDouble && found->contains("max")) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    made.floating_point_range = {{.from_value = end_of_range(*found, "min", -kInfinity),
                                  .to_value = end_of_range(*found, "max", kInfinity)}};
  }
  return made;
}

// whether a run has taken a value: JSON may have rounded it
bool is_taken(const json& asked, const json& got) {
  if (!asked.is_number() || !got.is_number()) return asked == got;
  const double a = asked, b = got;
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

std::string text_of(const json& value) { return value.is_string() ? value : json(value.dump()); }

std::vector<SetParametersResult> results(const std::vector<Parameter>& changes, const json& values,
                                         const std::string& reason) {
  std::vector<SetParametersResult> all;
  for (const Parameter& change : changes) {
    SetParametersResult result;
    const json* now = find(values, change.name);
    if (now == nullptr) {
      result.reason = reason.empty() ? "there is no such parameter" : reason;
    } else if (is_taken(to_json(change.value), now->value("value", json()))) {
      result.successful = true;
    } else {
      result.reason = (reason.empty() ? "refused" : reason) + "; the value is " +
                      text_of(now->value("value", json()));
    }
    all.push_back(std::move(result));
  }
  return all;
}

}  // namespace

ParameterValue to_value(const json& value) {
  ParameterValue made;
  if (value.is_boolean()) {
    made.type = ParameterValue::kBool;
    made.bool_value = value;
  } else if (value.is_number()) {
    made.type = ParameterValue::kDouble;
    made.double_value = value;
  } else if (value == kUnlimited) {
    made.type = ParameterValue::kDouble;
    made.double_value = std::numeric_limits<double>::infinity();
  } else if (value.is_string()) {
    made.type = ParameterValue::kString;
    made.string_value = value;
  } else if (value.is_array() &&
             std::ranges::all_of(value, [](const json& one) { return one.is_number(); })) {
    made.type = ParameterValue::kDoubles;
    made.double_array_value = value.get<std::vector<double>>();
  }
  return made;
}

json to_json(const ParameterValue& value) {
  switch (value.type) {
    case ParameterValue::kBool:
      return value.bool_value;
    case ParameterValue::kInteger:
      return static_cast<double>(value.integer_value);
    case ParameterValue::kDouble:
      return value.double_value;
    case ParameterValue::kString:
      return value.string_value;
    case ParameterValue::kDoubles:
      return value.double_array_value;
    default:
      return nullptr;
  }
}

Parameters::Parameters(Node& node, const std::string& name, const std::function<void()>& arrived) {
  const std::pair<Kind, std::pair<std::string, std::string>> all[] = {
      {Kind::kGet, {"get_parameters", "GetParameters"}},
      {Kind::kTypes, {"get_parameter_types", "GetParameterTypes"}},
      {Kind::kDescribe, {"describe_parameters", "DescribeParameters"}},
      {Kind::kList, {"list_parameters", "ListParameters"}},
      {Kind::kSet, {"set_parameters", "SetParameters"}},
      {Kind::kSetAtomically, {"set_parameters_atomically", "SetParametersAtomically"}}};
  for (const auto& [kind, names] : all) {
    services_[kind] =
        node.serve("/" + name + "/" + names.first, "rcl_interfaces/srv/" + names.second, arrived);
  }
}

bool Parameters::decode(Waiting& waiting) const {
  messages::CdrReader reader(waiting.request.message);
  if (is_change(waiting.kind)) {
    List<Parameter> list;
    if (!reader.decode(list)) return false;
    waiting.changes = std::move(list.items);
    return true;
  }
  if (waiting.kind == Kind::kList) {
    ListParametersRequest request;
    if (!reader.decode(request)) return false;
    waiting.names = std::move(request.prefixes);
    return true;
  }
  Names names;
  if (!reader.decode(names)) return false;
  waiting.names = std::move(names.names);
  return true;
}

json Parameters::question(const Waiting& waiting, const std::string& id) const {
  if (!is_change(waiting.kind)) {
    return {{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", id}};
  }
  json list = json::array();
  for (const Parameter& change : waiting.changes) {
    list.push_back({{"name", change.name}, {"value", to_json(change.value)}});
  }
  return {{"op", "setParameters"}, {"parameters", list}, {"id", id}};
}

void Parameters::pass_on(const Send& send) {
  for (auto& [kind, service] : services_) {
    Waiting waiting = {.kind = kind};
    while (service->take(waiting.request)) {
      waiting.since = Clock::now();
      if (!decode(waiting)) continue;  // not the bytes of such a request
      if (!send || waiting_.size() >= kMostWaiting) {
        answer(waiting, json::array(), std::string(send ? "too many requests wait" : kNoRun));
        continue;
      }
      if (kind == Kind::kSetAtomically && waiting.changes.size() > 1) {
        answer(waiting, json::array(), std::string(kOneOnly));
        waiting = {.kind = kind};
        continue;
      }
      send(question(waiting, std::string(kId) + std::to_string(++asked_)));
      waiting_[asked_] = std::exchange(waiting, {.kind = kind});
    }
  }
}

void Parameters::take(const json& values, const std::string& id) {
  for (auto found = waiting_.begin(); found != waiting_.end(); ++found) {
    if (std::string(kId) + std::to_string(found->first) != id) continue;
    answer(found->second, values, "");
    waiting_.erase(found);
    return;
  }
}

void Parameters::on_status(const std::string& status) {
  for (auto& [number, waiting] : waiting_) {
    if (!is_change(waiting.kind)) continue;
    waiting.reason += (waiting.reason.empty() ? "" : "; ") + status;
    return;
  }
}

void Parameters::give_up(const std::string& why, bool all) {
  const auto now = Clock::now();
  for (auto item = waiting_.begin(); item != waiting_.end();) {
    if (!all && now - item->second.since < kPatience) {
      ++item;
      continue;
    }
    answer(item->second, json::array(), why);
    item = waiting_.erase(item);
  }
}

void Parameters::answer(Waiting& waiting, const json& values, const std::string& failure) {
  if (!failure.empty()) waiting.reason = failure;
  switch (waiting.kind) {
    case Kind::kGet: {
      List<ParameterValue> list;
      for (const auto& name : waiting.names) list.items.push_back(value_of(values, name));
      return send(waiting, cdr_.encode(list));
    }
    case Kind::kTypes: {
      List<std::uint8_t> list;
      for (const auto& name : waiting.names) list.items.push_back(value_of(values, name).type);
      return send(waiting, cdr_.encode(list));
    }
    case Kind::kDescribe: {
      List<ParameterDescriptor> list;
      for (const auto& name : waiting.names) list.items.push_back(describe(values, name));
      return send(waiting, cdr_.encode(list));
    }
    case Kind::kList: {
      ListParametersResponse response;
      for (const json& one : values) {
        const std::string name = one.value("name", "");
        const auto begins = [&](const std::string& prefix) {
          return name == prefix || name.starts_with(prefix + ".");
        };
        if (waiting.names.empty() || std::ranges::any_of(waiting.names, begins)) {
          response.names.push_back(name);
        }
      }
      return send(waiting, cdr_.encode(response));
    }
    case Kind::kSet: {
      List<SetParametersResult> list = {results(waiting.changes, values, waiting.reason)};
      return send(waiting, cdr_.encode(list));
    }
    case Kind::kSetAtomically: {
      SetParametersResult result = {.successful = true};
      for (const auto& one : results(waiting.changes, values, waiting.reason)) {
        if (!one.successful) result = one;
      }
      return send(waiting, cdr_.encode(result));
    }
  }
}

void Parameters::send(const Waiting& waiting, Bytes message) {
  if (services_.at(waiting.kind)->answer(waiting.request, message)) return;
  unsent_.push_back(
      {waiting.kind, waiting.request, {message.begin(), message.end()}, Clock::now()});
}

void Parameters::retry() {
  const auto now = Clock::now();
  std::erase_if(unsent_, [&](const Answer& answer) {
    return services_.at(answer.kind)->answer(answer.request, answer.message) ||
           now - answer.since > kPatience;
  });
}

}  // namespace hg::ros2
