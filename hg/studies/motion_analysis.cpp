#include "hg/studies/motion_analysis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/analysis/truth_summary.h"

namespace hg::studies {
namespace {

constexpr double kPi = std::numbers::pi;

// Second-order Butterworth low-pass.
class LowPass {
 public:
  LowPass(double cutoff_Hz, double rate_Hz) noexcept {
    const double k = std::tan(kPi * cutoff_Hz / rate_Hz);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
    b_ = k * k * norm;
    a1_ = 2.0 * (k * k - 1.0) * norm;
    a2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
  }

  Eigen::Vector3d step(const Eigen::Vector3d& x) noexcept {
    const Eigen::Vector3d y = b_ * (x + 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
    x2_ = x1_;
    x1_ = x;
    y2_ = y1_;
    y1_ = y;
    return y;
  }

 private:
  double b_, a1_, a2_;
  Eigen::Vector3d x1_ = Eigen::Vector3d::Zero(), x2_ = x1_, y1_ = x1_, y2_ = x1_;
};

std::size_t count_of(double seconds, double rate_Hz) {
  return static_cast<std::size_t>(std::llround(seconds * rate_Hz));
}

}  // namespace

Feel feel(std::span<const HandleSample> motion, const FreeTwin& twin, double rate_Hz,
          double settling) {
  const std::size_t first = count_of(settling, rate_Hz);
  if (motion.size() <= first) return {};
  LowPass own_share(kForceBand, rate_Hz), extra(kForceBand, rate_Hz);
  analysis::HighPass above_5(5.0, rate_Hz), above_20(20.0, rate_Hz);
  Feel sum;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const HandleSample& now = motion[i];
    const Eigen::Vector3d own = twin.mass * now.a + twin.damping * now.v;
    const double own_now = own_share.step(own).norm();
    const double extra_now = extra.step(now.f - own).norm();
    const double vibration_5 = above_5.step(now.a).squaredNorm();
    const double vibration_20 = above_20.step(now.a).squaredNorm();
    if (i < first) continue;
    sum.force += now.f.norm();
    sum.own_share += own_now;
    sum.extra += extra_now;
    sum.vibration_5 += vibration_5;
    sum.vibration_20 += vibration_20;
  }
  const auto count = static_cast<double>(motion.size() - first);
  return {.force = sum.force / count,
          .own_share = sum.own_share / count,
          .extra = sum.extra / count,
          .vibration_5 = std::sqrt(sum.vibration_5 / count),
          .vibration_20 = std::sqrt(sum.vibration_20 / count),
          .centroid_Hz = spectral_centroid(motion.subspan(first), rate_Hz)};
}

double spectral_centroid(std::span<const HandleSample> motion, double rate_Hz) {
  constexpr double kWindow = 0.5;                     // s
  constexpr double kLowest = 20.0, kHighest = 500.0;  // Hz
  const std::size_t length = count_of(kWindow, rate_Hz);
  if (motion.size() < length) return 0.0;
  std::vector<double> hann(length);
  std::vector<std::complex<double>> turn(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(length);
    hann[i] = 0.5 - 0.5 * std::cos(angle);
    turn[i] = std::polar(1.0, -angle);
  }
  const double step_Hz = rate_Hz / static_cast<double>(length);
  const auto lowest = static_cast<std::size_t>(std::ceil(kLowest / step_Hz));
  const auto highest =
      std::min(length / 2, static_cast<std::size_t>(std::floor(kHighest / step_Hz)));
  std::vector<double> power(length / 2 + 1, 0.0);
  for (std::size_t begin = 0; begin + length <= motion.size(); begin += length / 2) {
    for (std::size_t bin = lowest; bin <= highest; ++bin) {
      Eigen::Vector3cd sum = Eigen::Vector3cd::Zero();
      for (std::size_t i = 0; i < length; ++i) {
        sum += hann[i] * turn[bin * i % length] * motion[begin + i].a;
      }
      power[bin] += sum.squaredNorm();
    }
  }
  double weights = 0.0, moments = 0.0;
  for (std::size_t bin = lowest; bin <= highest; ++bin) {
    weights += std::sqrt(power[bin]);
    moments += std::sqrt(power[bin]) * static_cast<double>(bin) * step_Hz;
  }
  return weights > 0.0 ? moments / weights : 0.0;
}

std::complex<double> phasor(std::span<const double> x, double frequency_Hz, double rate_Hz) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double angle = 2.0 * kPi * frequency_Hz * static_cast<double>(i) / rate_Hz;
    sum += x[i] * std::polar(1.0, -angle);
  }
  return x.empty() ? sum : 2.0 * sum / static_cast<double>(x.size());
}

char symbol(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kStable:
      return '.';
    case Verdict::kSlow:
      return 'r';
    case Verdict::kHunts:
      return 'h';
    case Verdict::kSustained:
      return 'U';
    case Verdict::kDiverges:
      return 'X';
  }
  return '?';
}

std::string_view to_string(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kStable:
      return "stable";
    case Verdict::kSlow:
      return "slow decay";
    case Verdict::kHunts:
      return "hunts";
    case Verdict::kSustained:
      return "sustained";
    case Verdict::kDiverges:
      return "diverges";
  }
  return "unknown";
}

Verdict judge_decay(std::span<const double> speed, const CalmRule& rule, double rate_Hz) {
  const std::size_t window = count_of(rule.window, rate_Hz);
  const auto largest = [](std::span<const double> part) { return *std::ranges::max_element(part); };
  const double before = largest(speed.subspan(window, window));
  const double last = largest(speed.last(window));
  if (last <= rule.calm_speed) return Verdict::kStable;
  if (last > rule.growing * before) return Verdict::kDiverges;
  return last > rule.sustained * before ? Verdict::kSustained : Verdict::kSlow;
}

}  // namespace hg::studies
