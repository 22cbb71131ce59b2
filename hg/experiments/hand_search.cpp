#include "hg/experiments/hand_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/core/random.h"
#include "hg/core/whole_file.h"

namespace hg::experiments {
namespace {

constexpr double kStart = 1.0, kEnd = 10.0;  // s, of the strokes
constexpr std::size_t kParents = 8;          // hands that are varied
constexpr int kRounds = 2;                   // of variation

constexpr std::array<const char*, 6> kChannels = {"x_m",         "y_m",       "z_m",
                                                  "azimuth_rad", "pitch_rad", "roll_rad"};
constexpr std::array<double, 6> kFarthest = {1.5, 1.5, 1.2, 1.5, 1.0, 1.0};

struct Stroke {
  double start_s = 0.0, duration_s = 1.0;
  std::array<double, 6> by{};  // 0: the channel is not moved
};

struct DrawnHand {
  double stiffness = 0.0, damping = 0.0, turning = 0.0, force = 0.0;
  double stop_s = 0.0;  // of an ordinary stop in the middle of the strokes
  std::vector<Stroke> strokes;
};

DrawnHand draw(double force, Random& random) {
  constexpr double kMovesAlong = 0.7, kTurns = 0.4;  // probabilities
  DrawnHand hand = {.stiffness = 200.0 * std::pow(5.0, random.next()),
                    .damping = random.between(20.0, 60.0),
                    .turning = random.between(4.0, 10.0),
                    .force = force * random.between(0.5, 1.0),
                    .stop_s = random.between(0.5 * (kStart + kEnd), kEnd)};
  for (double time = kStart; time < kEnd;) {
    Stroke stroke = {.start_s = time, .duration_s = random.between(0.3, 1.4)};
    for (std::size_t i = 0; i < stroke.by.size(); ++i) {
      const bool is_moved = random.next() < (i < 3 ? kMovesAlong : kTurns);
      const double value = random.between(-kFarthest[i], kFarthest[i]);
      if (is_moved) stroke.by[i] = value;
    }
    time += stroke.duration_s + random.between(0.0, 0.5);
    hand.strokes.push_back(stroke);
  }
  return hand;
}

DrawnHand varied(DrawnHand hand, Random& random) {
  constexpr double kShare = 0.3;  // of the values that change, and by how much
  const auto vary = [&](double& value) {
    const double factor = random.between(1.0 - kShare, 1.0 + kShare);
    if (random.next() < kShare) value *= factor;
  };
  vary(hand.stiffness);
  vary(hand.damping);
  vary(hand.turning);
  vary(hand.stop_s);
  for (Stroke& stroke : hand.strokes) {
    vary(stroke.duration_s);
    std::ranges::for_each(stroke.by, vary);
  }
  return hand;
}

double duration_of(const DrawnHand& hand) {
  return hand.strokes.back().start_s + hand.strokes.back().duration_s + 1.0;
}

std::string person_yaml(const DrawnHand& hand) {
  constexpr double kLever = 0.08;  // m: torque of a hand per its pull
  std::string text = fmt::format(
      "# A hand of `hapticgiant experiment hands`.\n\nframe: base\nhand:\n"
      "  stiffness_N_per_m: [{0:.1f}, {0:.1f}, {0:.1f}]\n"
      "  damping_Ns_per_m: [{1:.1f}, {1:.1f}, {1:.1f}]\n"
      "  grip_stiffness_N_per_m: 3000\n  grip_damping_Ns_per_m: 40\n"
      "  angular_stiffness_Nm_per_rad: [{2:.2f}, {2:.2f}, {2:.2f}]\n"
      "  angular_damping_Nms_per_rad: [0.1, 0.1, 0.1]\n"
      "  force_max_N: {3:.1f}\n  torque_max_Nm: {4:.2f}\n\nsegments:\n",
      hand.stiffness, hand.damping, hand.turning, hand.force, kLever * hand.force);
  for (const Stroke& stroke : hand.strokes) {
    std::string by;
    for (std::size_t i = 0; i < stroke.by.size(); ++i) {
      if (stroke.by[i] == 0.0) continue;
      by += fmt::format("{}{}: {:.3f}", by.empty() ? "" : ", ", kChannels[i], stroke.by[i]);
    }
    if (by.empty()) continue;
    text += fmt::format("  - {{start_s: {:.2f}, duration_s: {:.2f}, by: {{{}}}}}\n", stroke.start_s,
                        stroke.duration_s, by);
  }
  return text + fmt::format("duration_s: {:.2f}\n", duration_of(hand));
}

std::filesystem::path person_file(const HandSearch& search, const std::string& name) {
  return search.folder / (name + "_person.yaml");
}

std::filesystem::path scenario_file(const HandSearch& search, const std::string& name) {
  return search.folder / (name + ".yaml");
}

std::string quoted_path(const std::string& file) {
  using Json = nlohmann::json;
  return Json(std::filesystem::absolute(file).lexically_normal().string())
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

config::Scenario load_hand(const HandSearch& search, const config::Scenario& base,
                           const std::string& name, const DrawnHand& hand) {
  write_whole_file(person_file(search, name).string(), person_yaml(hand));
  write_whole_file(
      scenario_file(search, name).string(),
      fmt::format("title: {}\ndescription: A hand that pulls far beyond the reach of {}.\n"
                  "device: {}\ntwin: {}\nperson: {}_person.yaml\nduration_s: {:.2f}\n",
                  name, base.device.name, quoted_path(base.device.sources.front().name),
                  quoted_path(base.twin.sources.front().name), name, hand.stop_s));
  scenario::ScenarioOptions options = search.world;
  options.scenario = scenario_file(search, name).string();
  options.device.clear();
  options.twin.clear();
  return scenario::load(options);
}

}  // namespace

double badness(const SeededRun& run) noexcept {
  constexpr double kAngle = 2e-3, kLength = 1e-3;  // rad, m
  const double outside = std::max(run.angle.excess / kAngle, run.length.excess / kLength);
  const double fault = run.fault.code == FaultCode::kNone ? 0.0 : 1.0;
  return outside + fault + 0.1 * run.torque_share;
}

std::vector<TriedHand> search_hands(const HandSearch& search, const Progress& progress) {
  const config::Scenario base = scenario::load(search.world);
  Random random(search.seed);
  std::vector<DrawnHand> hands;
  std::vector<TriedHand> tried;
  const int first = std::max(1, search.count / 2);
  for (int round = 0; round <= kRounds; ++round) {
    const int until = round == 0 ? first : first + (search.count - first) * round / kRounds;
    std::vector<std::size_t> parents(hands.size());
    for (std::size_t i = 0; i < parents.size(); ++i) parents[i] = i;
    std::ranges::stable_sort(parents, std::ranges::greater{},
                             [&](std::size_t i) { return badness(tried[i].run); });
    const std::size_t known = hands.size();
    std::vector<Trial> trials;
    for (std::size_t i = known; i < static_cast<std::size_t>(until); ++i) {
      hands.push_back(round == 0 ? draw(search.force, random)
                                 : varied(hands[parents[i % std::min(kParents, known)]], random));
      const std::string name = fmt::format("hand_{}", i + 1);
      trials.push_back(
          {.name = name, .hand = "", .scenario = load_hand(search, base, name, hands.back())});
    }
    const std::vector<SeededRun> runs = play_seeds(trials, 1, 1, progress);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      tried.push_back({trials[i].name, std::move(trials[i].scenario), runs[i]});
    }
  }
  std::ranges::stable_sort(tried, std::ranges::greater{},
                           [](const TriedHand& hand) { return badness(hand.run); });
  return tried;
}

void remove_files(const HandSearch& search, const TriedHand& hand) {
  std::filesystem::remove(person_file(search, hand.name));
  std::filesystem::remove(scenario_file(search, hand.name));
}

}  // namespace hg::experiments
