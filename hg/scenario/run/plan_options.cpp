#include "hg/scenario/run/plan_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/viewer_server/access.h"

namespace hg::scenario {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& option, const std::string& why) {
  throw SetupError(fmt::format("--{}: {}", option, why));
}

/// Checks every value that differs from its default.
struct Checker {
  template <class T, class Rule>
  void operator()(const std::string& option, const std::optional<T>& value, const Rule& rule) {
    if (value) (*this)(option, *value, rule);
  }
  template <class T>
  requires(std::integral<T> || std::floating_point<T>) void operator()(const std::string& option,
                                                                       T value,
                                                                       const NumberRule& rule) {
    const double number = static_cast<double>(value);
    if (!std::isfinite(number)) refuse(option, fmt::format("expected a number, got {}", value));
    if (!rule.holds(number)) refuse(option, fmt::format("must be {}, got {}", rule.words, value));
  }
  void operator()(const std::string& option, const std::string& value, const NameRule& names) {
    if (value.empty() || std::ranges::find(names, value) != names.end()) return;
    refuse(option, fmt::format("expected one of {}, got '{}', did you mean '{}'?",
                               fmt::join(names, ", "), value, nearest_name(value, names)));
  }
  void operator()(const std::string&, const auto&, AnyText) {}
};

void require_address(const MachineAddress& machine) {
  if (!machine.address.empty()) return;
  const auto refuse_if = [](bool is_given, const char* option) {
    if (is_given) refuse(option, "needs --device-address");
  };
  refuse_if(!machine.machine_file.empty(), "machine");
  refuse_if(!machine.key_file.empty(), "key-file");
  refuse_if(!machine.despite.empty(), "despite");
  refuse_if(!machine.confirmed_joints.empty(), "posture-confirmed");
  refuse_if(machine.without_start_test, "without-start-test");
  refuse_if(machine.moves_to_start, "move-to-start");
}

std::string key_of(std::string option) {
  std::ranges::replace(option, '-', '_');
  return option;
}

/// Reads the values that a request has.
class Reader {
 public:
  explicit Reader(const Json& request) : request_(request) {}

  template <class T>
  void operator()(const std::string& option, T& value, const auto& /*rule*/) {
    keys_.push_back(key_of(option));
    const auto found = request_.find(keys_.back());
    if (found != request_.end()) read(option, *found, value);
  }

  /// Throws SetupError if the request has a key that was not read.
  void finish() const {
    for (const auto& [key, value] : request_.items()) {
      if (std::ranges::find(keys_, key) != keys_.end()) continue;
      throw SetupError(fmt::format("request: no option is called '{}', did you mean '{}'?", key,
                                   nearest_name(key, keys_)));
    }
  }

 private:
  static void expect(bool is_right, const std::string& option, const char* what, const Json& json) {
    if (!is_right) refuse(option, fmt::format("expected {}, got {}", what, json.dump()));
  }

  template <class T>
  static void read(const std::string& option, const Json& json, std::optional<T>& value) {
    read(option, json, value.emplace());
  }
  static void read(const std::string& option, const Json& json, bool& value) {
    expect(json.is_boolean(), option, "true or false", json);
    value = json.get<bool>();
  }
  static void read(const std::string& option, const Json& json, double& value) {
    expect(json.is_number(), option, "a number", json);
    value = json.get<double>();
  }
  template <std::integral T>
  static void read(const std::string& option, const Json& json, T& value) {
    expect(json.is_number_integer(), option, "a whole number", json);
    const auto number = json.get<std::int64_t>();
    expect(std::in_range<T>(number), option, "a whole number in its range", json);
    value = static_cast<T>(number);
  }
  static void read(const std::string& option, const Json& json, std::string& value) {
    expect(json.is_string() && !json.get_ref<const std::string&>().empty(), option,
           "a text that is not empty", json);
    value = json.get<std::string>();
  }
  static void read(const std::string& option, const Json& json, std::vector<std::string>& value) {
    expect(json.is_array(), option, "a list of texts", json);
    value.clear();
    for (const Json& each : json) read(option, each, value.emplace_back());
  }

  const Json& request_;
  std::vector<std::string> keys_;
};

// Throws SetupError where a key of the request is given twice: the parser would take the last.
Json parsed(std::string_view json) {
  std::set<std::string> keys;
  const auto note = [&](int depth, Json::parse_event_t event, const Json& key) {
    if (event != Json::parse_event_t::key || depth != 1) return true;
    if (!keys.insert(key.get<std::string>()).second) {
      throw SetupError(fmt::format("request: {} is given twice", key.dump()));
    }
    return true;
  };
  return Json::parse(json, note, false);
}

// What says something about a page has no sense without one.
void refuse_page_options(const Json& request, const RunPlan& plan) {
  const auto refuse_with = [&](const char* key, bool is_ruled_out, const char* by) {
    if (is_ruled_out && request.contains(key)) {
      throw SetupError(fmt::format("request: {} excludes {}", by, key));
    }
  };
  for (const char* key : {"bind", "port", "token_file", "embedded_in"}) {
    refuse_with(key, plan.timing.is_fast, "fast");
    refuse_with(key, !plan.page.is_served, "viewer: false");
  }
  refuse_with("lsl", plan.timing.is_fast && plan.records.has_lab_streams, "fast");
}

}  // namespace

void check_plan(const RunPlan& plan) {
  RunPlan checked = plan;
  if (checked.timing.cpu == RunTiming{}.cpu) checked.timing.cpu = 0;
  visit_options(checked, Checker{});
  require_address(plan.machine);
  for (const std::string& origin : plan.page.embedders) {
    if (viewer_server::is_web_origin(origin)) continue;
    refuse("embedded-in", fmt::format("expected the origin of a page, as {}, got '{}'",
                                      viewer_server::kOriginExample, origin));
  }
}

RunPlan plan_of_request(std::string_view json) {
  const Json request = parsed(json);
  if (!request.is_object()) {
    throw SetupError("request: expected one JSON object, as {\"scenario\": \"door\"}");
  }
  RunPlan plan;
  Reader reader(request);
  visit_options(plan, reader);
  reader.finish();
  refuse_page_options(request, plan);
  check_plan(plan);
  return plan;
}

}  // namespace hg::scenario
