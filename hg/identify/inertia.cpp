#include "hg/identify/inertia.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/core/error.h"
#include "hg/identify/block_regression.h"
#include "hg/identify/inertia_rows.h"
#include "hg/identify/pseudo_inertia.h"
#include "hg/identify/scaled_inverse.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kFewestOfInertia = 15;  // blocks, s
constexpr double kShows = 0.5;        // of the deviation that the URDF leaves

// Estimate of the base parameters (relative to the URDF) and the inverse of its covariance.
struct BaseEstimate {
  VectorXd x;
  MatrixXd covariance, information;
};

// The inverse, inflated, in place of the jackknife's covariance, which is too rough to be inverted.
BaseEstimate base_estimate(const Regressed& found, Eigen::Index bases) {
  BaseEstimate result;
  result.x = found.x.head(bases);
  result.covariance = found.inflation * found.inverse.topLeftCorner(bases, bases);
  result.information = scaled_inverse(result.covariance);
  return result;
}

std::vector<BaseFigure> base_figures(const BaseParameters& base, const BaseEstimate& found,
                                     const VectorXd& nominal, const MatrixXd& prior) {
  const VectorXd before = base.combination * nominal;
  const MatrixXd open = base.combination * prior * base.combination.transpose();
  std::vector<BaseFigure> figures;
  for (Eigen::Index i = 0; i < found.x.size(); ++i) {
    const double deviation = std::sqrt(found.covariance(i, i));
    figures.push_back(
        {base.names[static_cast<std::size_t>(i)],
         before[i],
         {before[i] + found.x[i], deviation, deviation <= kShows * std::sqrt(open(i, i))}});
  }
  return figures;
}

VectorXd figures_of(const LinkParameters& p) {
  const model::Inertial inertial = inertial_of(p);
  const Eigen::Matrix3d& I = inertial.inertia;
  VectorXd figures(kLinkFigures);
  figures << inertial.mass, inertial.p_com, I(0, 0), I(0, 1), I(1, 1), I(0, 2), I(1, 2), I(2, 2);
  return figures;
}

// Deviations of the figures of a link whose parameters have this covariance.
VectorXd deviations_of(const LinkParameters& p, const MatrixXd& covariance) {
  constexpr double kStep = 1e-6;
  MatrixXd by(kLinkFigures, kLinkParameters);
  for (Eigen::Index i = 0; i < kLinkParameters; ++i) {
    const LinkParameters step = kStep * LinkParameters::Unit(i);
    by.col(i) = (figures_of(p + step) - figures_of(p - step)) / (2.0 * kStep);
  }
  return (by * covariance * by.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

std::vector<LinkInertia> links_of(const InertiaModel& model, const ConsistentParameters& found) {
  std::vector<LinkInertia> links;
  for (std::size_t i = 0; i < model.links().size(); ++i) {
    const Eigen::Index at = static_cast<Eigen::Index>(i) * kLinkParameters;
    const auto block = [&](const MatrixXd& m) {
      return MatrixXd(m.block(at, at, kLinkParameters, kLinkParameters));
    };
    const LinkParameters before = model.nominal().segment<kLinkParameters>(at);
    const LinkParameters now = found.p.segment<kLinkParameters>(at);
    LinkInertia link = {model.links()[i], inertial_of(before), inertial_of(now), {}, {}};
    const VectorXd old = figures_of(before), values = figures_of(now);
    const VectorXd deviations = deviations_of(now, block(found.covariance));
    const VectorXd open = deviations_of(before, block(found.prior));
    for (int k = 0; k < kLinkFigures; ++k) {
      const auto index = static_cast<std::size_t>(k);
      link.nominal_values[index] = old[k];
      link.figures[index] = {values[k], deviations[k], deviations[k] <= kShows * open[k]};
    }
    links.push_back(std::move(link));
  }
  return links;
}

std::string lack_of(const InertiaEstimate& estimate) {
  const auto count = static_cast<int>(estimate.base.size());
  if (2 * estimate.shown >= count) return "";
  const auto least = std::ranges::min_element(estimate.joints, {}, &JointFit::acceleration);
  return fmt::format(
      "the motion shows {} of {} base parameters, half are needed: {} moved over {:.2g} rad with "
      "{:.2g} rad/s^2 rms; move all joints far and fast, together and one by one, for a minute",
      estimate.shown, count, least->name, least->way, least->acceleration);
}

}  // namespace

InertiaEstimate identify_inertia(const std::vector<JointMotion>& parts,
                                 const config::SimulatedDeviceConfig& device) {
  InertiaModel model(device);
  const BaseParameters base = base_parameters(model, device.model.n_m, device.model.chain.nv());
  const auto bases = static_cast<Eigen::Index>(base.chosen.size());
  InertiaRows rows(model, base, parts, device.model, device.simulation.gear_ratio);
  InertiaEstimate result;
  result.joints = rows.motion();
  if (rows.blocks() < kFewestOfInertia) {
    result.missing = fmt::format("it moved for {} s only, {} are needed: record longer",
                                 rows.blocks(), kFewestOfInertia);
    return result;
  }
  const Regressed found = rows.solve(result.joints);
  const BaseEstimate estimate = base_estimate(found, bases);
  const VectorXd absolute = base.combination * model.nominal() + estimate.x;
  const ConsistentParameters consistent =
      consistent_parameters(absolute, estimate.information, base.combination, model.nominal());
  result.base = base_figures(base, estimate, model.nominal(), consistent.prior);
  result.links = links_of(model, consistent);
  result.shown = static_cast<int>(std::ranges::count_if(
      result.base, [](const BaseFigure& figure) { return figure.found.is_found; }));
  result.missing = lack_of(result);
  return result;
}

RecordedInertia identify_recorded_inertia(const std::string& file,
                                          std::optional<config::SimulatedDeviceConfig> device) {
  RecordedJoints recorded = read_joints(file, std::move(device));
  const bool has_torques = std::ranges::all_of(
      recorded.parts, [](const JointMotion& part) { return part.tau.cols() == part.q.cols(); });
  if (!has_torques) {
    throw SetupError(
        fmt::format("{}{}: has no joint torques, which inertial parameters need; the drives of {} "
                    "report positions only",
                    recording::to_text(recorded.losses), file, recorded.device.name));
  }
  return {std::move(recorded.losses), recorded.used_s,
          identify_inertia(recorded.parts, recorded.device)};
}

}  // namespace hg::identify
