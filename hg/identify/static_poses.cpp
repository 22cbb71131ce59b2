#include "hg/identify/static_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/assembly.h"

namespace hg::identify {
namespace {

constexpr int kCandidates = 400;

// Of a sequence that fills [0, 1) evenly; `base` is a prime.
double halton(int index, int base) {
  double value = 0.0, share = 1.0;
  for (int i = index; i > 0; i /= base) {
    share /= base;
    value += share * (i % base);
  }
  return value;
}

VectorM candidate(const DeviceModel& device, int index) {
  constexpr std::array<int, kMaxManipulator> kBases = {2, 3, 5, 7, 11, 13, 17};
  VectorM q_m(device.n_m);
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& joint = device.joint_limits[i];
    const double lowest = std::max(joint.q_min, -std::numbers::pi);
    const double highest = std::min(joint.q_max, std::numbers::pi);
    q_m[i] = std::lerp(lowest, highest, halton(index + 1, kBases[i]));
  }
  return q_m;
}

bool is_within(const limits::JointLimits& limits, double q) {
  return limits.q_min <= q && q <= limits.q_max;
}

// A posture and the direction of gravity in the sensor there.
struct Candidate {
  VectorM q_m;
  Eigen::Vector3d up_S;
};

std::vector<Candidate> candidates(const config::DeviceConfig& device) {
  const DeviceModel& model = device.model;
  model::ChainData chain(model.chain);
  std::vector<Candidate> usable;
  for (int k = 0; k < kCandidates; ++k) {
    const VectorM q_m = candidate(model, k);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(model.n_p + model.n_m);
    q.tail(model.n_m) = q_m;
    chain.update_poses(q);
    const auto sum_holds = [&](const VirtualJoint& sum) {
      return is_within(sum.limits, sum.weights.dot(q_m));
    };
    const auto frame_holds = [&](const CartesianLimit& limit) {
      const Eigen::Vector3d p = chain.pose(limit.frame).p;
      return is_within(limit.axes[0], p.x()) && is_within(limit.axes[1], p.y()) &&
             is_within(limit.axes[2], p.z());
    };
    if (!std::ranges::all_of(model.virtual_joints, sum_holds) ||
        !std::ranges::all_of(model.cartesian_limits, frame_holds)) {
      continue;
    }
    const Eigen::Matrix3d R_B_S = chain.pose(model.handle).R * device.model.T_H_S.R;
    usable.push_back({q_m, R_B_S.row(2).transpose()});
  }
  return usable;
}

constexpr std::array<const char*, 9> kColumns = {"a_x", "a_y", "a_z", "f_x", "f_y",
                                                 "f_z", "n_x", "n_y", "n_z"};

// Of comma, semicolon and tab the one that the first line has most of: spreadsheets write the list
// separator of their country.
char separator_of(std::string_view header) {
  return std::ranges::max(std::string_view(",;\t"), {},
                          [&](char separator) { return std::ranges::count(header, separator); });
}

std::vector<std::string> cells(std::string_view line, char separator) {
  std::vector<std::string> result(1);
  bool is_quoted = false;
  for (const char c : line) {
    const bool begins = result.back().find_first_not_of(" \t") == std::string::npos;
    if (c == '"' && (is_quoted || begins)) {
      is_quoted = !is_quoted;
    } else if (c == separator && !is_quoted) {
      result.emplace_back();
    } else {
      result.back() += c;
    }
  }
  for (std::string& cell : result) {
    const auto first = cell.find_first_not_of(" \t\r");
    const auto last = cell.find_last_not_of(" \t\r");
    cell = first == std::string::npos ? "" : cell.substr(first, last - first + 1);
  }
  return result;
}

constexpr double kLargest = 1e6;  // m/s^2, N or Nm: no sensor shows more

// Where commas do not separate cells, one may be that of a decimal.
double number(const std::string& text, char separator, const std::string& where) {
  std::string plain = text;
  if (separator != ',') std::ranges::replace(plain, ',', '.');
  double value = 0.0;
  const char* last = plain.data() + plain.size();
  const auto [end, error] = std::from_chars(plain.data(), last, value);
  if (error != std::errc() || end != last || !std::isfinite(value)) {
    throw SetupError(where + ": expected a number, got '" + text + "'");
  }
  if (std::abs(value) > kLargest) {
    throw SetupError(
        fmt::format("{}: expected a reading of at most {:g}, got {:g}", where, kLargest, value));
  }
  return value;
}

// Places of the nine columns, then that of `pose`, -1 without.
std::array<int, 10> find_columns(const std::vector<std::string>& header, const std::string& name) {
  std::array<int, 10> places;
  const auto place = [&](const char* column) {
    const auto found = std::ranges::find(header, column);
    return found == header.end() ? -1 : static_cast<int>(found - header.begin());
  };
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    places[i] = place(kColumns[i]);
    if (places[i] >= 0) continue;
    std::vector<std::string> others = header;
    std::erase_if(others, [](const std::string& column) {
      return std::ranges::find(kColumns, column) != kColumns.end();
    });
    const std::string nearest = nearest_name(kColumns[i], others);
    throw SetupError(fmt::format("{}:1: {}: there is no such column{}; needs {}", name, kColumns[i],
                                 nearest.empty() ? "" : ", nearest is '" + nearest + "'",
                                 fmt::join(kColumns, ", ")));
  }
  places[9] = place("pose");
  return places;
}

}  // namespace

std::vector<VectorM> static_postures(const config::DeviceConfig& device, int count) {
  const std::vector<Candidate> all = candidates(device);
  std::vector<Candidate> chosen;
  while (!all.empty() && static_cast<int>(chosen.size()) < count) {
    // the one whose nearest neighbour among the chosen is farthest away
    const auto distance = [&](const Candidate& candidate) {
      double nearest = kInfinity;
      for (const Candidate& other : chosen) {
        nearest = std::min(nearest, (candidate.up_S - other.up_S).norm());
      }
      return nearest;
    };
    const auto farthest = std::ranges::max_element(all, {}, distance);
    if (!(distance(*farthest) > 0.0)) break;
    chosen.push_back(*farthest);
  }
  std::vector<VectorM> postures;
  for (const Candidate& candidate : chosen) postures.push_back(candidate.q_m);
  return postures;
}

StaticPose measure_simulated(const config::SimulatedDeviceConfig& device, const VectorM& q_m) {
  const scenario::Start start = {.T_B_H = {}, .q_p = VectorP::Zero(device.model.n_p), .q_m = q_m};
  simulator::Simulation simulation = scenario::make_unheld_simulation(device, start);
  CommandFrame brakes_closed;
  brakes_closed.q_m = q_m;
  brakes_closed.dq_m = brakes_closed.ddq_m = VectorM::Zero(device.model.n_m);
  brakes_closed.tau_m = brakes_closed.dq_m;
  brakes_closed.dq_p = VectorP::Zero(device.model.n_p);
  StaticPose mean;
  const int second = static_cast<int>(std::lround(device.model.rate_Hz));
  for (int k = 0; k < 2 * second; ++k) {
    brakes_closed.sequence = simulation.sensors().sequence;
    simulation.step(brakes_closed);
    if (k < second) continue;
    mean.a_S += simulation.sensors().a_S / second;
    mean.w_S += simulation.sensors().w_S / second;
  }
  return mean;
}

std::vector<StaticPose> read_static_poses(const std::string& name, const std::string& text) {
  const char end = text.find('\n') != std::string::npos ? '\n' : '\r';
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line, end);
  if (line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // a byte order mark
  const char separator = separator_of(line);
  const std::vector<std::string> header = cells(line, separator);
  const std::array<int, 10> columns = find_columns(header, name);
  struct Sum {
    StaticPose pose;
    int rows = 0;
  };
  std::map<std::string, Sum> sums;
  for (int row = 2; std::getline(stream, line, end); ++row) {
    const std::vector<std::string> values = cells(line, separator);
    if (values == std::vector<std::string>{""}) continue;
    const std::string where = fmt::format("{}:{}", name, row);
    if (values.size() != header.size()) {
      throw SetupError(fmt::format("{}: expected {} values as in the first line, got {}", where,
                                   header.size(), values.size()));
    }
    const auto value = [&](std::size_t i) {
      return number(values[columns[i]], separator, where + ": " + kColumns[i]);
    };
    Sum& sum = sums[columns[9] < 0 ? where : values[columns[9]]];
    sum.pose.a_S += Eigen::Vector3d(value(0), value(1), value(2));
    for (int i = 0; i < 6; ++i) sum.pose.w_S[i] += value(3 + i);
    ++sum.rows;
  }
  std::vector<StaticPose> poses;
  for (auto& [key, sum] : sums) {
    poses.push_back({sum.pose.a_S / sum.rows, sum.pose.w_S / sum.rows});
  }
  if (poses.empty()) throw SetupError(name + ":1: expected rows of readings below the header");
  return poses;
}

}  // namespace hg::identify
