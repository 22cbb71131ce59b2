#include "hg/check/machine_inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hg/config/bus/machine_file.h"

namespace hg::check {
namespace {

constexpr double kFactor = 3.0;                   // between two ratings of one joint
constexpr std::uint32_t kLargestTorque = 0x6072;  // CiA 402, in counts of target_torque

// "; suspected scale 0.09" where a thousandth or a thousandfold makes the torque fit the rating.
std::string scale_instead(double scale, double torque, double rating) {
  for (const double factor : {1e-3, 1e3}) {
    const double mended = factor * torque;
    if (mended > kFactor * rating || rating > kFactor * mended) continue;
    return fmt::format("; suspected scale {:.4g}", factor * scale);
  }
  return "";
}

// A drive whose largest torque is another than the joint's rating: its scale is wrong.
void inspect_torque(const ethercat::Slave& slave, std::size_t index, double rating,
                    Collector& out) {
  const auto setting =
      std::ranges::find(slave.settings, kLargestTorque, &ethercat::Setting::object);
  const auto target = std::ranges::find(slave.outputs, ethercat::Output::kTargetTorque,
                                        &ethercat::Entry<ethercat::Output>::meaning);
  if (setting == slave.settings.end() || target == slave.outputs.end()) return;
  const double torque = setting->value * std::abs(target->scale);
  if (!std::isfinite(rating) || (torque <= kFactor * rating && rating <= kFactor * torque)) return;
  out.add(Severity::kWarning,
          fmt::format("slaves[{}].outputs[{}].scale", index, target - slave.outputs.begin()),
          fmt::format("object 0x6072, {:g}, times this scale is {:.3g} Nm; the joint's rating is "
                      "{:g} Nm{}",
                      setting->value, torque, rating, scale_instead(target->scale, torque, rating)),
          "give Nm per count: for per mille of the rated torque, that over 1000");
}

}  // namespace

Findings inspect_machine(const std::string& file, const config::DeviceConfig& device) {
  const std::vector<model::Joint>& joints = device.model.chain.joints();
  std::vector<std::string> names;
  for (int i = 0; i < device.model.n_p + device.model.n_m; ++i) names.push_back(joints[i].name);
  config::SourceReader reader;
  config::Places places;
  const ethercat::Machine machine = config::load_machine(file, reader, names, &places);
  Collector out(reader.texts(), places);
  for (std::size_t k = 0; k < machine.slaves.size(); ++k) {
    const int joint = machine.slaves[k].joint;
    if (joint >= device.model.n_p)
      inspect_torque(machine.slaves[k], k, joints[joint].effort_max, out);
  }
  return std::move(out.findings);
}

}  // namespace hg::check
