#include "hg/config/schema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "hg/model/urdf.h"

namespace hg::config {
namespace {

// Bounds on the magnitude of values of any plausible machine; 0 is also allowed where a description
// allows it.
struct Sizes {
  double least, largest;
};

struct Unit {
  std::string_view suffix;
  std::string_view text;
  Sizes sizes;
};

// longer suffixes first: "_m_per_s" also ends in "_s"
constexpr std::array<Unit, 34> kUnits = {{
    {"_rad_per_s2_per_sqrt_Hz", "rad/s^2/sqrt(Hz)", {1e-15, 1e4}},
    {"_rad_per_s_per_sqrt_Hz", "rad/s/sqrt(Hz)", {1e-15, 1e4}},
    {"_m_per_s3_per_sqrt_Hz", "m/s^3/sqrt(Hz)", {1e-15, 1e4}},
    {"_m_per_s2_per_sqrt_Hz", "m/s^2/sqrt(Hz)", {1e-15, 1e4}},
    {"_rad_per_s_per_K", "rad/s/K", {1e-15, 1e4}},
    {"_m_per_s2_per_K", "m/s^2/K", {1e-15, 1e4}},
    {"_Nm_per_sqrt_Hz", "Nm/sqrt(Hz)", {1e-15, 1e4}},
    {"_N_per_sqrt_Hz", "N/sqrt(Hz)", {1e-15, 1e4}},
    {"_1_per_sqrt_s", "1/sqrt(s)", {1e-15, 1e3}},
    {"_K_per_sqrt_s", "K/sqrt(s)", {1e-15, 1e3}},
    {"_Nms2_per_rad2", "Nms^2/rad^2", {1e-9, 1e9}},
    {"_Ns2_per_m2", "Ns^2/m^2", {1e-9, 1e9}},
    {"_Nms_per_rad", "Nms/rad", {1e-9, 1e9}},
    {"_rad_per_s2", "rad/s^2", {1e-6, 1e6}},
    {"_Nm_per_rad", "Nm/rad", {1e-6, 1e10}},
    {"_rad_per_s", "rad/s", {1e-6, 1e4}},
    {"_Ns_per_m", "Ns/m", {1e-9, 1e9}},
    {"_m_per_s2", "m/s^2", {1e-6, 1e5}},
    {"_1_per_s2", "1/s^2", {1e-6, 1e8}},
    {"_N_per_m", "N/m", {1e-6, 1e10}},
    {"_m_per_s", "m/s", {1e-6, 1e3}},
    {"_1_per_s", "1/s", {1e-6, 1e5}},
    {"_1_per_K", "1/K", {1e-15, 1e3}},
    {"_per_s", "1/s", {1e-6, 1e5}},
    {"_kg_m2", "kg m^2", {1e-15, 1e9}},
    {"_rad", "rad", {1e-9, 1e3}},
    {"_kg", "kg", {1e-9, 1e6}},
    {"_Nm", "Nm", {1e-6, 1e7}},
    {"_Hz", "Hz", {1e-3, 1e6}},
    {"_N", "N", {1e-6, 1e7}},
    {"_m", "m", {1e-9, 1e3}},
    {"_s", "s", {1e-6, 1e5}},
    {"_K", "K", {1e-6, 1e4}},
    {"_C", "°C", {1e-6, 1e4}},
}};

const Unit* find_unit(std::string_view key) noexcept {
  const auto* found =
      std::ranges::find_if(kUnits, [&](const Unit& unit) { return key.ends_with(unit.suffix); });
  return found == kUnits.end() ? nullptr : found;
}

}  // namespace

Bounds::Bounds(const Range& range, std::string_view key)
    : lb_(range.lb), ub_(range.ub), allows_infinity_(range.allows_infinity) {
  if (const Unit* unit = find_unit(key)) {
    const auto [least, largest] = unit->sizes;
    lb_ = range.excludes_lb && range.lb == 0.0 ? least : std::max(lb_, -largest);
    ub_ = std::min(ub_, largest);
  }
  if (!std::isfinite(lb_) || !std::isfinite(ub_) || (range.excludes_lb && lb_ == 0.0)) {
    throw std::logic_error("'" + std::string(key) +
                           "' has no unit and needs a range with two ends");
  }
}

bool Bounds::contains(double value) const noexcept {
  if (std::isinf(value)) return allows_infinity_ && (value > 0.0 || lb_ < 0.0);
  return lb_ <= value && value <= ub_;  // false for NaN
}

std::string Bounds::text() const {
  const std::string text = model::to_text(lb_) + " .. " + model::to_text(ub_);
  if (!allows_infinity_) return text;
  return text + (lb_ < 0.0 ? ", .inf or -.inf" : " or .inf");
}

std::string_view unit_of(std::string_view key) noexcept {
  const Unit* unit = find_unit(key);
  return unit == nullptr ? std::string_view() : unit->text;
}

}  // namespace hg::config
