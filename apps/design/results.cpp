#include "apps/design/results.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace hg::search {
namespace {

using nlohmann::ordered_json;

constexpr double kPercent = 0.01;

double rounded(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace

ordered_json to_json(const design::DesignProblem& problem,
                     const design::DesignVariables& variables) {
  ordered_json json;
  const std::vector<double> point = design::to_point(variables);
  for (std::size_t i = 0; i < design::kContinuous.size(); ++i) {
    json[design::kContinuous[i]] = rounded(point[i]);
  }
  for (std::size_t i = 0; i < design::kDesignJoints; ++i) {
    const design::JointSize& size =
        problem.catalogue.sizes[static_cast<std::size_t>(variables.size[i])];
    json["joints"].push_back(
        {{"name", fmt::format("m{}", i + 1)},
         {"size", size.name},
         {"ratio", size.ratios[static_cast<std::size_t>(variables.ratio[i])]}});
  }
  return json;
}

ordered_json to_json(const design::DesignScore& score) {
  ordered_json json = {{"capability", rounded(score.capability)},
                       {"moving_mass_kg", rounded(score.moving_mass)},
                       {"price", rounded(score.price)},
                       {"clear_share", rounded(score.clear_share)},
                       {"violation", rounded(score.violation)}};
  if (!score.fault.empty()) json["fault"] = score.fault;
  for (std::size_t i = 0; i < design::kTerms.size(); ++i) {
    json["terms"][design::kTerms[i]] = rounded(score.terms[i]);
  }
  const design::DeviceMetrics& metrics = score.metrics;
  json["force_N"] = rounded(metrics.force.low);
  json["torque_Nm"] = rounded(metrics.torque.low);
  json["share_regular"] = rounded(metrics.share_regular);
  json["reflected_mass_mean_kg"] = rounded(metrics.mass_mean);
  json["reflected_mass_worst_kg"] = rounded(metrics.mass_worst);
  json["eigenfrequency_free_Hz"] = rounded(metrics.frequency_median);
  json["eigenfrequency_clamped_Hz"] = rounded(metrics.frequency_clamped);
  return json;
}

ordered_json sensitivity(const design::DesignProblem& problem, const design::Judge& judge,
                         const design::DesignVariables& variables) {
  ordered_json rows = ordered_json::array();
  const design::DesignScore now = judge(variables);
  const auto add = [&](const std::string& name, const std::string& change,
                       const design::DesignVariables& changed) {
    const design::DesignScore then = judge(changed);
    ordered_json row = {{"variable", name}, {"change", change}};
    if (then.fault.empty()) {
      row["capability"] = rounded(then.capability - now.capability);
      row["moving_mass_kg"] = rounded(then.moving_mass - now.moving_mass);
      row["price"] = rounded(then.price - now.price);
      row["violation"] = rounded(then.violation - now.violation);
    } else {
      row["fault"] = then.fault;
    }
    rows.push_back(row);
  };
  const std::vector<double> point = design::to_point(variables);
  for (std::size_t i = 0; i < design::kContinuous.size(); ++i) {
    for (double sign : {-1.0, 1.0}) {
      std::vector<double> moved = point;
      moved[i] *= 1.0 + sign * kPercent;
      add(design::kContinuous[i], sign < 0 ? "-1 %" : "+1 %", design::to_variables(problem, moved));
    }
  }
  for (std::size_t i = 0; i < design::kDesignJoints; ++i) {
    for (int step : {-1, 1}) {
      design::DesignVariables other = variables;
      const int size = variables.size[i] + step;
      const bool has_order = (i == 0 || size <= variables.size[i - 1]) &&
                             (i + 1 == design::kDesignJoints || size >= variables.size[i + 1]);
      if (size >= 0 && size < static_cast<int>(problem.catalogue.sizes.size()) && has_order) {
        other.size[i] = size;
        const auto& of_size = problem.catalogue.sizes[static_cast<std::size_t>(size)];
        other.ratio[i] = std::min(other.ratio[i], static_cast<int>(of_size.ratios.size()) - 1);
        add(fmt::format("m{} size", i + 1), of_size.name, other);
      }
      other = variables;
      const auto& ratios =
          problem.catalogue.sizes[static_cast<std::size_t>(variables.size[i])].ratios;
      const int ratio = variables.ratio[i] + step;
      if (ratio < 0 || ratio >= static_cast<int>(ratios.size())) continue;
      other.ratio[i] = ratio;
      add(fmt::format("m{} ratio", i + 1),
          fmt::format("{:g}", ratios[static_cast<std::size_t>(ratio)]), other);
    }
  }
  return rows;
}

ordered_json coverage(const design::Judge& judge, const design::DesignScore& score) {
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < score.metrics.each.size(); ++i) {
    const design::PoseMetrics& pose = score.metrics.each[i];
    const design::HandPose& hand = judge.human().poses[i];
    const Eigen::Vector3d& p = hand.T_F_hand.p;
    rows.push_back({rounded(p.x()), rounded(p.y()), rounded(p.z()), rounded(hand.weight),
                    pose.is_reached, rounded(pose.velocity), rounded(pose.acceleration)});
  }
  return rows;
}

}  // namespace hg::search
