#include "hg/start_test/memory.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sodium/crypto_hash_sha256.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hg/core/error.h"

namespace hg::start_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::time_t kClockAhead = 60;  // s that another clock may be ahead

std::string date_of(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", parts);
}

// File names may be invalid UTF-8; invalid parts are replaced.
std::string text_of(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// whether `kept` is the form in which `name` was written to a file
bool is_same(const Json& kept, const std::string& name) {
  return kept.is_string() && text_of(kept) == text_of(Json(name));
}

const char* unit_of(const Position& position) { return position.is_slide ? "m" : "rad"; }

}  // namespace

std::string sha256(std::span<const std::string_view> texts) {
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  for (const std::string_view text : texts) {
    crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(text.data()),
                              text.size());
  }
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256_final(&state, hash.data());
  return fmt::format("{:02x}", fmt::join(hash, ""));
}

std::string file_of(std::string_view folder, std::string_view kind, std::string_view device,
                    std::string_view where) {
  std::string name = fmt::format("{}_{}", device, where);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  }
  return fmt::format("{}/{}_{}.json", folder, kind, name);
}

std::string to_json(const StartTestResult& result) {
  Json json;
  json["device"] = result.device;
  json["address"] = result.address;
  json["simulated"] = result.is_simulated;
  json["passed"] = result.has_passed;
  json["ended"] = date_of(result.ended);
  json["ended_unix_s"] = static_cast<std::int64_t>(result.ended);
  json["version"] = result.version;
  if (!result.computer.empty()) json["computer"] = result.computer;
  json["files_sha256"] = result.files_sha256;
  json["items"] = Json::array();
  for (const Item& item : result.items) {
    Json& line = json["items"].emplace_back();
    line["name"] = item.name;
    line["outcome"] = to_string(item.outcome);
    line["found"] = item.found;
    if (item.answered_s) line["answered_s"] = *item.answered_s;
    if (item.power_off_s) line["power_off_s"] = *item.power_off_s;
    if (item.motion) line["motion_rad_or_m"] = *item.motion;
    if (item.load) line["load_Nm_or_N"] = *item.load;
  }
  return text_of(json, 2) + "\n";
}

Validity check_validity(std::string_view text, const Requirements& required) {
  const Json json = Json::parse(text, nullptr, false);
  Validity validity;
  const auto object = [&](std::string why) {
    validity.objection = std::move(why);
    return validity;
  };
  try {
    const Json& time = json.at("ended_unix_s");
    const std::time_t ended = time.is_number_integer() ? time.get<std::int64_t>() : -1;
    if (ended < 0) return object("it cannot be read");
    if (ended > required.now + kClockAhead) {
      return object("it is of the future: look at the clock");
    }
    validity.ended = date_of(ended);
    std::string failed;
    for (const Json& item : json.at("items")) {
      const std::string outcome = item.at("outcome"), name = item.at("name");
      if (outcome == to_string(Outcome::kFailed)) failed += (failed.empty() ? "" : ", ") + name;
      if (outcome == to_string(Outcome::kUntested)) validity.untested.push_back(name);
    }
    if (!is_same(json.at("device"), required.device)) return object("it is of another device");
    if (!is_same(json.at("address"), required.address)) {
      return object("it is of the device at " + json.at("address").get<std::string>());
    }
    if (json.at("simulated").get<bool>()) return object("it is of a simulation");
    if (!json.at("passed").get<bool>() || !failed.empty()) {
      return object(failed.empty() ? "it did not finish" : "failed: " + failed);
    }
    if (json.at("files_sha256") != required.files_sha256) {
      return object("the files of the device have changed since");
    }
    const auto age_s = static_cast<double>(required.now - ended);
    if (age_s > required.valid_for_s) {
      constexpr double kHour = 3600.0;
      return object(fmt::format("it is {:.1f} h old, and counts for {:g} h", age_s / kHour,
                                required.valid_for_s / kHour));
    }
  } catch (const Json::exception&) {
    return object("it cannot be read");
  }
  return validity;
}

std::string posture_to_json(const std::string& device, const std::string& address, std::time_t at,
                            const std::vector<Position>& posture) {
  Json json;
  json["device"] = device;
  json["address"] = address;
  json["brakes_closed"] = date_of(at);
  json["positions"] = Json::array();
  for (const Position& position : posture) {
    json["positions"].push_back(
        {{"name", position.name}, {"value", position.value}, {"unit", unit_of(position)}});
  }
  return text_of(json, 2) + "\n";
}

std::vector<Moved> compare_posture(std::string_view text, const std::string& address,
                                   const std::vector<Position>& now,
                                   const StartTestConfig& config) {
  const Json json = Json::parse(text, nullptr, false);
  std::vector<Moved> moved;
  try {
    if (!is_same(json.at("address"), address)) {
      throw SetupError("expected the posture of the machine at " + address + ", got that at " +
                       json.at("address").get<std::string>());
    }
    for (const Position& position : now) {
      const auto& kept = json.at("positions");
      const auto found = std::ranges::find_if(
          kept, [&](const Json& line) { return is_same(line.at("name"), position.name); });
      const std::string is =
          fmt::format("{}: {:.3f} {}", position.name, position.value, unit_of(position));
      if (found == kept.end()) {
        moved.push_back({position.name, is + ", of which the last run has kept nothing"});
        continue;
      }
      const double was = found->at("value");
      double by = position.value - was;
      if (position.is_endless) by = std::remainder(by, 2.0 * std::numbers::pi);
      const double allowed = position.is_slide ? config.slide_posture : config.posture;
      if (std::abs(by) <= allowed) continue;
      moved.push_back({position.name, fmt::format("{}, the last run has left it at {:.3f} {}", is,
                                                  was, unit_of(position))});
    }
  } catch (const Json::exception&) {
    throw SetupError("expected the posture that a run has kept");
  }
  return moved;
}

}  // namespace hg::start_test
