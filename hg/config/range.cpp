#include "hg/config/range.h"

#include <array>
#include <cmath>

#include "hg/model/urdf.h"

namespace hg::config {
namespace {

struct Unit {
  std::string_view suffix;
  std::string_view text;
};

// longer suffixes first: "_m_per_s" also ends in "_s"
constexpr std::array<Unit, 32> kUnits = {{
    {"_rad_per_s2_per_sqrt_Hz", "rad/s^2/sqrt(Hz)"},
    {"_rad_per_s_per_sqrt_Hz", "rad/s/sqrt(Hz)"},
    {"_m_per_s3_per_sqrt_Hz", "m/s^3/sqrt(Hz)"},
    {"_m_per_s2_per_sqrt_Hz", "m/s^2/sqrt(Hz)"},
    {"_rad_per_s_per_K", "rad/s/K"},
    {"_m_per_s2_per_K", "m/s^2/K"},
    {"_Nm_per_sqrt_Hz", "Nm/sqrt(Hz)"},
    {"_N_per_sqrt_Hz", "N/sqrt(Hz)"},
    {"_1_per_sqrt_s", "1/sqrt(s)"},
    {"_K_per_sqrt_s", "K/sqrt(s)"},
    {"_Nms2_per_rad2", "Nms^2/rad^2"},
    {"_Ns2_per_m2", "Ns^2/m^2"},
    {"_Nms_per_rad", "Nms/rad"},
    {"_rad_per_s2", "rad/s^2"},
    {"_Nm_per_rad", "Nm/rad"},
    {"_rad_per_s", "rad/s"},
    {"_Ns_per_m", "Ns/m"},
    {"_m_per_s2", "m/s^2"},
    {"_1_per_s2", "1/s^2"},
    {"_N_per_m", "N/m"},
    {"_m_per_s", "m/s"},
    {"_1_per_s", "1/s"},
    {"_1_per_K", "1/K"},
    {"_kg_m2", "kg m^2"},
    {"_rad", "rad"},
    {"_kg", "kg"},
    {"_Nm", "Nm"},
    {"_Hz", "Hz"},
    {"_N", "N"},
    {"_m", "m"},
    {"_s", "s"},
    {"_K", "K"},
}};

}  // namespace

bool contains(const Range& range, double value) noexcept {
  if (std::isinf(value) && !range.allows_infinity) return false;
  if (range.excludes_lb && value <= range.lb) return false;
  return range.lb <= value && value <= range.ub;  // false for NaN
}

std::string to_text(const Range& range) {
  const bool has_lb = range.lb > -kInfinity;
  if (has_lb && range.ub < kInfinity) {
    return model::to_text(range.lb) + " .. " + model::to_text(range.ub);
  }
  if (!has_lb) return range.allows_infinity ? "a number, .inf or -.inf" : "finite";
  std::string text = range.excludes_lb ? "> " : ">= ";
  text += model::to_text(range.lb);
  return range.allows_infinity ? text + " or .inf" : text;
}

std::string_view unit_of(std::string_view key) noexcept {
  for (const Unit& unit : kUnits) {
    if (key.ends_with(unit.suffix)) return unit.text;
  }
  return {};
}

}  // namespace hg::config
