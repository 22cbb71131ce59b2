#include "hg/tune/feel.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "hg/core/linear_algebra.h"
#include "hg/experiments/haptify/measures.h"

namespace hg::tune {
namespace {

using Complex = std::complex<double>;

constexpr double kSlowest_Hz = 1.0, kFastest_Hz = 40.0;  // of transparency
constexpr double kDistortionTo_Hz = 20.0;
constexpr int kPerDecade = 10;
constexpr double kVibrationTo_Hz = 500.0, kVibrationStep_Hz = 16.0;

Complex turn(double frequency_Hz, double period_s) {
  return std::polar(1.0, 2.0 * std::numbers::pi * frequency_Hz * period_s);
}

Complex impedance(const Body& body, double frequency_Hz) {
  return {body.damping, 2.0 * std::numbers::pi * frequency_Hz * body.mass};
}

}  // namespace

double Feel::least_transparency_Hz() const { return *std::ranges::min_element(transparency_Hz); }

double Feel::largest_latency_s() const { return *std::ranges::max_element(latency_s); }

std::array<Complex, 3> felt_over_body(Resolvent& resolvent, const HandleLoop& loop,
                                      const Body& body, double frequency_Hz) {
  resolvent.at(turn(frequency_Hz, loop.period_s));
  const Eigen::MatrixXcd y = loop.C * resolvent.solve(loop.B_push);
  const Complex own = impedance(body, frequency_Hz);
  std::array<Complex, 3> ratio;
  for (int i = 0; i < 3; ++i) ratio[i] = y(3 + i, i) / y(i, i) / own;
  return ratio;
}

Feel feel(const HandleLoop& loop, const Body& body, const Eigen::VectorXd& friction) {
  Resolvent resolvent(loop.A);
  const auto relative = [&](double frequency_Hz) {
    return felt_over_body(resolvent, loop, body, frequency_Hz);
  };
  Feel result;
  std::vector<double> frequencies;
  std::array<std::vector<double>, 3> ratios;
  std::array<double, 3> deviation{};
  int counted = 0;
  const double factor = std::pow(10.0, 1.0 / kPerDecade);
  for (double f = kSlowest_Hz; f <= kFastest_Hz; f *= factor) {
    frequencies.push_back(f);
    const auto ratio = relative(f);
    for (std::size_t i = 0; i < 3; ++i) ratios[i].push_back(std::abs(ratio[i]));
    if (f > kDistortionTo_Hz) continue;
    for (std::size_t i = 0; i < 3; ++i) deviation[i] += std::abs(1.0 - ratio[i]);
    ++counted;
  }
  result.distortion = *std::ranges::max_element(deviation) / counted;
  const auto slow = relative(kLatencyAt);
  for (std::size_t i = 0; i < 3; ++i) {
    result.transparency_Hz[i] = haptify::bandwidth(frequencies, ratios[i], haptify::kWithin3dB);
    result.latency_s[i] = std::arg(slow[i]) / (2.0 * std::numbers::pi * kLatencyAt);
  }

  constexpr std::array kFriction_Hz = {0.5, 1.0, 2.0, 4.0, 8.0};
  for (const double f : kFriction_Hz) {
    resolvent.at(turn(f, loop.period_s));
    const Complex own = impedance(body, f);
    const Eigen::MatrixXcd y =
        loop.C.topRows(6) * resolvent.solve(loop.B_motor * friction.asDiagonal());
    result.friction_N += (y.bottomRows(3) - own * y.topRows(3)).norm() / kFriction_Hz.size();
  }

  // white noise of every sample has the density 2 period up to half the rate
  const double density = 2.0 * loop.period_s;
  double power = 0.0, weights = 0.0, moments = 0.0;
  const double last = std::min(kVibrationTo_Hz, 0.5 / loop.period_s);
  for (double f = haptify::kVibrationBand + 0.5 * kVibrationStep_Hz; f < last;
       f += kVibrationStep_Hz) {
    resolvent.at(turn(f, loop.period_s));
    const Eigen::MatrixXcd velocity =
        resolvent.solve_transposed(loop.C.topRows(3)) * loop.B_noise.cast<Complex>();
    const double omega = 2.0 * std::numbers::pi * f;
    const double here = density * omega * omega * velocity.squaredNorm();
    power += here * kVibrationStep_Hz;
    weights += std::sqrt(here);
    moments += std::sqrt(here) * f;
  }
  result.vibration = std::sqrt(power);
  result.centroid_Hz = weights > 0.0 ? moments / weights : 0.0;
  return result;
}

}  // namespace hg::tune
