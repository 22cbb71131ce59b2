#include "hg/experiments/haptify/measures.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "hg/analysis/truth_summary.h"
#include "hg/core/linear_algebra.h"
#include "hg/simulator/random_stream.h"

namespace hg::haptify {
namespace {

using Signal = std::vector<Eigen::Vector3d>;
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

std::size_t count_of(double seconds, double rate_Hz) { return std::llround(seconds * rate_Hz); }

// Forwards and backwards: fourth order, no phase.
Signal above_band(std::span<const Eigen::Vector3d> input, double rate_Hz) {
  Signal signal(input.begin(), input.end());
  for (int pass = 0; pass < 2; ++pass) {
    analysis::HighPass filter(kVibrationBand, rate_Hz);
    for (Eigen::Vector3d& value : signal) value = filter.step(value);
    std::ranges::reverse(signal);
  }
  return signal;
}

// The largest number of samples up to `count` without prime factors above 5: an FFT of a large
// prime takes a thousand times as long.
std::size_t fast_count(std::size_t count) {
  for (; count > 1; --count) {
    std::size_t rest = count;
    for (const std::size_t factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) break;
  }
  return count;
}

// Of a signal that has nothing but vibration: rms in each band, by Parseval.
std::array<double, kBandEdges.size() - 1> band_rms(const std::vector<double>& signal,
                                                   double rate_Hz) {
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, signal);
  const auto n = static_cast<double>(signal.size());
  std::array<double, kBandEdges.size() - 1> result{};
  for (std::size_t i = 0; i <= signal.size() / 2; ++i) {
    const double frequency = static_cast<double>(i) * rate_Hz / n;
    for (std::size_t band = 0; band < result.size(); ++band) {
      const bool is_in = frequency >= kBandEdges[band] && frequency < kBandEdges[band + 1];
      if (is_in) result[band] += 2.0 * std::norm(spectrum[i]) / (n * n);
    }
  }
  for (double& value : result) value = std::sqrt(value);
  return result;
}

}  // namespace

Feel feel(std::span<const HandleSample> motion, const experiments::FreeTwin& twin, double rate_Hz,
          double settling) {
  const std::size_t first = count_of(settling, rate_Hz);
  if (motion.size() <= first) return {};
  LowPass own_share(kForceBand, rate_Hz), extra(kForceBand, rate_Hz);
  analysis::HighPass above_5(5.0, rate_Hz);
  Feel sum;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const HandleSample& now = motion[i];
    const Eigen::Vector3d own = twin.mass * now.a + twin.damping * now.v;
    const double own_now = own_share.step(own).norm();
    const double extra_now = extra.step(now.f - own).norm();
    const double squares_5 = above_5.step(now.a).squaredNorm();
    if (i < first) continue;
    sum.force += now.f.norm();
    sum.own_share += own_now;
    sum.extra += extra_now;
    sum.acceleration_5Hz += squares_5;
  }
  const auto count = static_cast<double>(motion.size() - first);
  return {.force = sum.force / count,
          .own_share = sum.own_share / count,
          .extra = sum.extra / count,
          .acceleration_5Hz = std::sqrt(sum.acceleration_5Hz / count)};
}

Spectrum spectrum(std::span<const Eigen::Vector3d> signal, double rate_Hz) {
  constexpr double kWindow = 0.5;  // s
  const std::size_t length = count_of(kWindow, rate_Hz);
  if (length == 0 || signal.size() < length) return {};
  std::vector<double> hann(length), part(length);
  double weight = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    hann[i] =
        0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / static_cast<double>(length));
    weight += hann[i] * hann[i];
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> bins;
  Spectrum result = {.step_Hz = rate_Hz / static_cast<double>(length),
                     .magnitude = std::vector<double>(length / 2 + 1, 0.0)};
  double windows = 0.0;
  for (std::size_t begin = 0; begin + length <= signal.size(); begin += length / 2) {
    windows += 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < length; ++i) part[i] = hann[i] * signal[begin + i][axis];
      fft.fwd(bins, part);
      for (std::size_t i = 0; i < result.magnitude.size(); ++i) {
        result.magnitude[i] += std::norm(bins[i]);
      }
    }
  }
  for (double& value : result.magnitude) {
    value = std::sqrt(2.0 * value / (windows * weight * rate_Hz));
  }
  return result;
}

double spectral_centroid(const Spectrum& spectrum) {
  constexpr double kLowest = 20.0, kHighest = 500.0;  // Hz
  double weights = 0.0, moments = 0.0;
  for (std::size_t i = 0; i < spectrum.magnitude.size(); ++i) {
    const double frequency = static_cast<double>(i) * spectrum.step_Hz;
    if (frequency < kLowest || frequency > kHighest) continue;
    weights += spectrum.magnitude[i];
    moments += spectrum.magnitude[i] * frequency;
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

Signal with_noise(std::span<const Eigen::Vector3d> signal, double density, double rate_Hz,
                  std::uint64_t seed) {
  const double sigma = density * std::sqrt(rate_Hz);
  Signal noisy(signal.begin(), signal.end());
  for (int axis = 0; axis < 3; ++axis) {
    // noise differs from that of the device's own sensor, which has moved the handle
    const int channel = 3 + axis;
    simulator::RandomStream random(seed, simulator::RandomEffect::kAccelerometerNoise, channel);
    for (Eigen::Vector3d& value : noisy) value[axis] += sigma * random.gaussian();
  }
  return noisy;
}

std::vector<double> dft321(std::span<const Eigen::Vector3d> axes) {
  using Complex = std::complex<double>;
  if (axes.empty()) return {};
  Eigen::FFT<double> fft;
  std::vector<double> one(axes.size());
  std::vector<Complex> spectrum, sum(axes.size());
  std::vector<double> energy(axes.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < axes.size(); ++i) one[i] = axes[i][axis];
    fft.fwd(spectrum, one);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      sum[i] += spectrum[i];
      energy[i] += std::norm(spectrum[i]);
    }
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    sum[i] = std::polar(std::sqrt(energy[i]), std::arg(sum[i]));
  }
  std::vector<double> result;
  fft.inv(result, sum);
  return result;
}

Vibration vibration(std::span<const Eigen::Vector3d> acceleration, double rate_Hz) {
  const std::size_t margin = count_of(0.25, rate_Hz);
  if (acceleration.size() < 6 * margin) return {};
  const Signal filtered = above_band(acceleration, rate_Hz);
  const std::vector<double> reduced =
      dft321(std::span(filtered).subspan(margin, fast_count(filtered.size() - 2 * margin)));
  double squares = 0.0;
  Signal along_x(reduced.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    squares += reduced[i] * reduced[i];
    along_x[i].x() = reduced[i];
  }
  Vibration result = {.rms = std::sqrt(squares / static_cast<double>(reduced.size())),
                      .band_rms = band_rms(reduced, rate_Hz),
                      .spectrum = spectrum(along_x, rate_Hz)};
  result.centroid_Hz = spectral_centroid(result.spectrum);
  return result;
}

DynamicFit fit_dynamics(std::span<const double> f, std::span<const double> v,
                        std::span<const double> a) {
  const auto n = static_cast<Eigen::Index>(f.size());
  Eigen::MatrixX3d regressors(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double sign = v[i] > 0.0 ? 1.0 : (v[i] < 0.0 ? -1.0 : 0.0);
    regressors.row(i) << a[i], v[i], sign;
  }
  const Eigen::Map<const Eigen::VectorXd> force(f.data(), n);
  const Eigen::Vector3d fit = LeastSquares(regressors).solve(force);
  const double left = (force - regressors * fit).squaredNorm();
  const double all = (force.array() - force.mean()).matrix().squaredNorm();
  return {.inertia = fit[0],
          .damping = fit[1],
          .friction = fit[2],
          .r2 = all > 0.0 ? 1.0 - left / all : 0.0};
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<Eigen::Index>(x.size());
  if (n < 2) return {};
  const Eigen::Map<const Eigen::ArrayXd> xs(x.data(), n), ys(y.data(), n);
  const double mean_x = xs.mean(), mean_y = ys.mean();
  const double spread = (xs - mean_x).square().sum();
  if (spread <= 0.0) return {0.0, mean_y};
  const double slope = ((xs - mean_x) * (ys - mean_y)).sum() / spread;
  return {slope, mean_y - slope * mean_x};
}

std::complex<double> amplitude(std::span<const double> x, double frequency_Hz, double rate_Hz) {
  std::vector<double> weighted(x.begin(), x.end());
  const double step = 2.0 * std::numbers::pi / static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    weighted[i] *= 1.0 - std::cos(step * static_cast<double>(i));
  }
  return phasor(weighted, frequency_Hz, rate_Hz);
}

double bandwidth(std::span<const double> frequency_Hz, std::span<const double> ratio,
                 double factor) {
  const double allowed = std::log(factor);
  const auto off = [&](std::size_t i) { return std::abs(std::log(ratio[i])); };
  for (std::size_t i = 0; i < frequency_Hz.size(); ++i) {
    if (off(i) <= allowed) continue;
    if (i == 0) return frequency_Hz[0];
    const double share = (allowed - off(i - 1)) / (off(i) - off(i - 1));
    return frequency_Hz[i - 1] *
           std::pow(frequency_Hz[i] / frequency_Hz[i - 1], std::clamp(share, 0.0, 1.0));
  }
  return frequency_Hz.empty() ? 0.0 : frequency_Hz.back();
}

double delay(std::span<const double> reference, std::span<const double> signal, double rate_Hz,
             double most) {
  const std::size_t shifts = count_of(most, rate_Hz);
  if (reference.size() <= shifts + 1) return 0.0;
  std::vector<double> cost(shifts + 1, 0.0);
  for (std::size_t shift = 0; shift <= shifts; ++shift) {
    // the same samples of the signal for every shift
    for (std::size_t i = shifts; i < signal.size(); ++i) {
      const double off = signal[i] - reference[i - shift];
      cost[shift] += off * off;
    }
  }
  const std::size_t best = std::ranges::min_element(cost) - cost.begin();
  double fraction = 0.0;  // of a sample, by a parabola through three costs
  if (best > 0 && best < shifts) {
    const double bend = cost[best - 1] - 2.0 * cost[best] + cost[best + 1];
    if (bend > 0.0) fraction = 0.5 * (cost[best - 1] - cost[best + 1]) / bend;
  }
  return (static_cast<double>(best) + fraction) / rate_Hz;
}

}  // namespace hg::haptify
