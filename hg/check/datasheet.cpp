#include "hg/check/datasheet.h"

#include <algorithm>
#include <cmath>

#include "hg/controller/estimation/user_wrench.h"

namespace hg::check {
namespace {

constexpr double kLow = 0.05;  // share of the postures below Distribution::low

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + index);
  return values[index];
}

template <class Value>
std::vector<double> values_of(const workspace::Survey& survey, Value value) {
  std::vector<double> values;
  values.reserve(survey.postures.size());
  for (const workspace::Posture& posture : survey.postures) values.push_back(value(posture));
  return values;
}

template <class Value>
Distribution distribution(const workspace::Survey& survey, Value value) {
  const std::vector<double> values = values_of(survey, value);
  return {quantile(values, 0.0), quantile(values, kLow), quantile(values, 0.5)};
}

Bottleneck bottleneck(const config::DeviceConfig& device, const workspace::Survey& survey,
                      int first_joint, model::Guarantee workspace::Posture::*guarantee) {
  const auto& joints = device.model.chain.joints();
  std::vector<int> counts(joints.size(), 0);
  for (const workspace::Posture& posture : survey.postures) {
    const int joint = (posture.*guarantee).joint;
    if (joint >= 0) ++counts[first_joint + joint];
  }
  const auto most = std::ranges::max_element(counts);
  if (most == counts.end() || *most == 0) return {};
  return {joints[most - counts.begin()].name,
          static_cast<double>(*most) / static_cast<double>(survey.postures.size())};
}

std::vector<JointLine> joint_lines(const config::DeviceConfig& device,
                                   const workspace::Survey& survey) {
  const DeviceModel& model = device.model;
  std::vector<JointLine> lines;
  for (std::size_t i = 0; i < model.chain.joints().size(); ++i) {
    const model::Joint& joint = model.chain.joints()[i];
    JointLine line = {.name = joint.name,
                      .is_angle = !joint.is_slide(),
                      .effort_max = joint.effort_max,
                      .gravity_max = survey.gravity_max[i]};
    if (static_cast<int>(i) < model.n_p) {
      line.is_gantry = true;
      line.range = device.model.gantry_range[i];
      line.dq_max = device.prepositioning.dq_max;
      line.ddq_max = device.model.drive.ddq_max;
    } else {
      const auto& limits = model.joint_limits[i - model.n_p];
      line.range = {limits.q_min, limits.q_max};
      line.dq_max = limits.dq_max;
      line.ddq_max = limits.ddq_max;
    }
    lines.push_back(line);
  }
  return lines;
}

void fill_capability(const config::DeviceConfig& device, const workspace::Survey& survey,
                     Datasheet& sheet) {
  const int n_p = device.model.n_p;
  sheet.force = distribution(survey, [](const workspace::Posture& p) { return p.force.value; });
  sheet.torque = distribution(survey, [](const workspace::Posture& p) { return p.torque.value; });
  sheet.acceleration =
      distribution(survey, [](const workspace::Posture& p) { return p.acceleration.value; });
  sheet.force_bottleneck = bottleneck(device, survey, 0, &workspace::Posture::force);
  sheet.torque_bottleneck = bottleneck(device, survey, 0, &workspace::Posture::torque);
  sheet.acceleration_bottleneck =
      bottleneck(device, survey, n_p, &workspace::Posture::acceleration);
  const auto count = std::ranges::count_if(survey.postures, &workspace::Posture::has_paper_wrench);
  sheet.share_paper_wrench =
      static_cast<double>(count) / static_cast<double>(std::max(1, sheet.postures));
  if (sheet.acceleration.low > 0.0) {
    sheet.free_body_mass = sheet.force.low / sheet.acceleration.low;
  }
}

}  // namespace

Datasheet make_datasheet(const config::DeviceConfig& device, const workspace::Survey& survey) {
  Datasheet sheet;
  sheet.name = device.name;
  sheet.options = survey.options;
  sheet.postures = static_cast<int>(survey.postures.size());
  sheet.share_in_boxes = static_cast<double>(sheet.postures) / std::max(1, survey.drawn);
  sheet.reach = survey.cloud.reach;
  sheet.workspace = workspace::workspace(device, survey);
  if (sheet.postures == 0) return sheet;

  sheet.joints = joint_lines(device, survey);
  for (const JointLine& joint : sheet.joints) {
    if (!std::isfinite(joint.effort_max)) sheet.unrated.push_back(joint.name);
  }
  sheet.has_ratings = sheet.unrated.empty();
  fill_capability(device, survey, sheet);

  sheet.length = survey.length;
  sheet.singular_value =
      distribution(survey, [](const workspace::Posture& p) { return p.conditioning.smallest; });
  const auto conditions =
      values_of(survey, [](const workspace::Posture& p) { return p.conditioning.condition; });
  sheet.condition_median = quantile(conditions, 0.5);
  sheet.condition_high = quantile(conditions, 1.0 - kLow);
  sheet.most_singular = survey.most_singular;
  sheet.stopping = stopping_of(device);
  sheet.stop_time = device.monitor.stop_time;
  sheet.walls = wall_forces(device);
  sheet.bandwidth = {
      .rate_Hz = device.model.rate_Hz,
      .synchronisation_Hz = std::sqrt(device.rendering.kP_tran) / (2.0 * M_PI),
      .gantry_Hz = device.model.n_p > 0 ? device.prepositioning.k_ppu / (2.0 * M_PI) : 0.0,
      .drive_Hz = device.model.n_p > 0 ? 1.0 / (2.0 * M_PI * device.model.drive.lag) : 0.0,
      .wrench_delay_s = estimation::wrench_delay(device.estimation.wrench, device.model.dt())};
  return sheet;
}

}  // namespace hg::check
