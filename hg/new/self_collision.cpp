#include "hg/new/self_collision.h"

#include <algorithm>
#include <map>
#include <utility>

#include "hg/controller/safety/collision/distance.h"
#include "hg/controller/safety/collision/shapes.h"
#include "hg/model/urdf.h"
#include "hg/model/urdf_parts.h"
#include "hg/new/bodies.h"
#include "hg/new/clearance.h"
#include "hg/workspace/postures.h"

namespace hg::new_files {
namespace {

constexpr double kSafeDistance = 0.01;          // m; the capsules stand out of the meshes already
constexpr double kNear = kSafeDistance + 0.02;  // m, as the pairs of a device are chosen
constexpr double kMostCrowded = 0.5;            // share of the postures
constexpr double kFineEnough = 0.015;           // m; what stands out less is not parted
constexpr std::size_t kMostPerBody = 6;
constexpr int kPostures = 1500;  // in which capsules are compared

// in how many postures two parts meet
struct Meetings {
  int near = 0;      // their capsules are within kNear
  int crowded = 0;   // their capsules are within kCrowded
  int touching = 0;  // their meshes touch, or nearly
};

// what all steps of a fit share
struct Fitting {
  std::vector<Body> bodies;
  std::vector<std::vector<Pose>> postures;  // of each body in each posture
  Clearance clearance;
  std::optional<collision::Shape> floor;
  std::map<PartPair, Meetings> meetings;
  SelfCollision result;
};

// where a part is
struct Place {
  std::size_t body = 0, part = 0;
};

const Meetings& meetings(Fitting& fit, const Place& at_a, const Place& at_b) {
  const Body &a = fit.bodies[at_a.body], &b = fit.bodies[at_b.body];
  const auto [known, is_new] = fit.meetings.try_emplace(pair_of(a, at_a.part, b, at_b.part));
  Meetings& found = known->second;
  if (!is_new) return found;
  const collision::Distance distance(shape_of(a, at_a.part), shape_of(b, at_b.part));
  for (const std::vector<Pose>& poses : fit.postures) {
    const Pose &T_B_a = poses[at_a.body], &T_B_b = poses[at_b.body];
    const double between = distance(T_B_a, T_B_b);
    if (between >= kNear) continue;
    ++found.near;
    if (between >= kCrowded) continue;
    ++found.crowded;
    found.touching += touches(a.parts[at_a.part], T_B_a, b.parts[at_b.part], T_B_b) ? 1 : 0;
  }
  return found;
}

// Whether the meshes of two parts never touch: no sample has found it, and it is proven.
bool is_proven_apart(Fitting& fit, const Place& a, const Place& b) {
  if (meetings(fit, a, b).touching > 0) return false;
  return fit.clearance.is_proven(fit.bodies[a.body], a.part, fit.bodies[b.body], b.part);
}

bool is_apart(const SelfCollision& result, const std::string& a, const std::string& b) {
  return std::ranges::any_of(result.apart,
                             [&](const auto& pair) { return pair.a == a && pair.b == b; });
}

// Bodies with two joints between them whose meshes are proven to stay apart.
void find_bodies_apart(Fitting& fit) {
  for (std::size_t b = 0; b < fit.bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (fit.bodies[b].joints - fit.bodies[a].joints != 2) continue;
      if (!is_proven_apart(fit, {a, 0}, {b, 0})) continue;
      fit.result.apart.push_back({fit.bodies[a].link, fit.bodies[b].link});
    }
  }
}

// The pairs of capsules that come near each other in sampled postures: their number, and how often
// each part of each body is near another.
struct Nearness {
  int pairs = 0;
  std::vector<std::vector<int>> counts;
};

// Pairs of parts that no sample has found touching are likely to be proven apart in the end.
void count_pair(Fitting& fit, const Place& a, const Place& b, Nearness& found) {
  const Meetings& meeting = meetings(fit, a, b);
  const int joints = fit.bodies[b.body].joints - fit.bodies[a.body].joints;
  if (meeting.near == 0 || (joints == 2 && meeting.touching == 0)) return;
  found.pairs += 1;
  found.counts[a.body][a.part] += meeting.crowded - meeting.touching;
  found.counts[b.body][b.part] += meeting.crowded - meeting.touching;
}

// The floor costs pairs, too, but nothing is parted because of it.
int pairs_with_floor(const Fitting& fit, std::size_t body) {
  if (!fit.floor || fit.bodies[body].joints == 0) return 0;
  int pairs = 0;
  for (std::size_t i = 0; i < fit.bodies[body].parts.size(); ++i) {
    const collision::Distance distance(*fit.floor, shape_of(fit.bodies[body], i));
    pairs += std::ranges::any_of(
        fit.postures, [&](const auto& poses) { return distance(Pose{}, poses[body]) < kNear; });
  }
  return pairs;
}

Nearness nearness(Fitting& fit) {
  Nearness found;
  const std::vector<Body>& bodies = fit.bodies;
  for (const Body& body : bodies) found.counts.emplace_back(body.parts.size(), 0);
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    found.pairs += pairs_with_floor(fit, a);
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      if (bodies[b].joints - bodies[a].joints < 2) continue;
      if (is_apart(fit.result, bodies[a].link, bodies[b].link)) continue;
      for (std::size_t i = 0; i < bodies[a].parts.size(); ++i) {
        for (std::size_t k = 0; k < bodies[b].parts.size(); ++k) {
          count_pair(fit, {a, i}, {b, k}, found);
        }
      }
    }
  }
  return found;
}

std::vector<std::vector<Pose>> draw_postures(const std::vector<Body>& bodies,
                                             const std::vector<Interval>& ranges,
                                             const model::ChainModel& model) {
  std::vector<std::vector<Pose>> postures;
  model::ChainData chain(model);
  workspace::PostureSampler sampler(ranges);
  for (int n = 0; n < kPostures; ++n) {
    chain.update_poses(sampler.draw());
    std::vector<Pose>& poses = postures.emplace_back();
    for (const Body& body : bodies) poses.push_back(pose_of(chain, body.frame));
  }
  return postures;
}

// what a body was before one of its capsules was parted
struct StepBack {
  std::size_t body = 0;
  std::vector<Part> parts;
};

// Parts capsules, first the one that stands out most, counted by how often it is near others.
class Refinement {
 public:
  explicit Refinement(Fitting& fit) : fit_(fit), is_final_(fit.bodies.size(), false) {}

  // false: none is left
  bool step() {
    const Nearness now = nearness(fit_);
    double most = 0.0;
    std::size_t body = 0, part = 0;
    for (std::size_t b = 0; b < fit_.bodies.size(); ++b) {
      const std::vector<Part>& parts = fit_.bodies[b].parts;
      if (is_final_[b] || parts.size() >= kMostPerBody) continue;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const double value = parts[i].stands_out * now.counts[b][i];
        if (parts[i].stands_out < kFineEnough || value <= most) continue;
        most = value;
        body = b;
        part = i;
      }
    }
    if (most == 0.0) return false;
    std::vector<Part> before = fit_.bodies[body].parts;
    if (!part_in_two(fit_.bodies[body], part) || nearness(fit_).pairs > kDraftedPairs) {
      fit_.bodies[body].parts = std::move(before);
      is_final_[body] = true;
    } else {
      steps_.push_back({body, std::move(before)});
    }
    return true;
  }

  // takes the last step back; false: there is none
  bool step_back() {
    if (steps_.empty()) return false;
    fit_.bodies[steps_.back().body].parts = std::move(steps_.back().parts);
    steps_.pop_back();
    return true;
  }

 private:
  Fitting& fit_;
  std::vector<bool> is_final_;
  std::vector<StepBack> steps_;
};

// Whether watching two parts would stop the arm in most postures although it does not touch itself.
bool is_crowded(Fitting& fit, const Place& a, const Place& b) {
  const auto most = static_cast<int>(kMostCrowded * static_cast<double>(fit.postures.size()));
  const Meetings& meeting = meetings(fit, a, b);
  return meeting.crowded > most && meeting.touching < most;
}

CrowdedPair crowded_pair(Fitting& fit, const Place& a, const Place& b) {
  const Meetings& meeting = meetings(fit, a, b);
  const auto count = static_cast<double>(fit.postures.size());
  return {.a = shape_of(fit.bodies[a.body], a.part).name,
          .b = shape_of(fit.bodies[b.body], b.part).name,
          .near = meeting.crowded / count,
          .touch = meeting.touching / count};
}

// Pairs as they are chosen when the device is loaded, without those that need not or cannot be
// watched.
void choose_pairs(Fitting& fit, const model::ChainModel& chain,
                  const std::vector<Interval>& ranges) {
  SelfCollision& result = fit.result;
  result.shapes.clear();
  result.parts_apart.clear();
  result.crowded.clear();
  std::vector<Place> places;
  if (fit.floor) {
    result.shapes.push_back(*fit.floor);
    places.push_back({});
  }
  for (std::size_t b = 0; b < fit.bodies.size(); ++b) {
    for (std::size_t i = 0; i < fit.bodies[b].parts.size(); ++i) {
      result.shapes.push_back(shape_of(fit.bodies[b], i));
      places.push_back({b, i});
    }
  }
  result.pairs = collision::choose_pairs(result.shapes, chain, ranges, kNear);
  std::erase_if(result.pairs.watched, [&](const collision::Pair& pair) {
    if (result.shapes[pair.a].is_surrounding) return false;
    const Place &a = places[pair.a], &b = places[pair.b];
    if (is_apart(result, fit.bodies[a.body].link, fit.bodies[b.body].link)) return true;
    if (is_proven_apart(fit, a, b)) {
      result.parts_apart.push_back({result.shapes[pair.a].name, result.shapes[pair.b].name});
      return true;
    }
    if (!is_crowded(fit, a, b)) return false;
    result.crowded.push_back(crowded_pair(fit, a, b));
    return true;
  });
  // capsules that touch in every posture are left out when the device is loaded
  for (const collision::Excluded& pair : result.pairs.excluded) {
    const Place &a = places[pair.a], &b = places[pair.b];
    if (pair.reason != collision::Exclusion::kAlways || result.shapes[pair.a].is_surrounding ||
        is_apart(result, fit.bodies[a.body].link, fit.bodies[b.body].link)) {
      continue;
    }
    if (is_proven_apart(fit, a, b)) continue;
    result.crowded.push_back(crowded_pair(fit, a, b));
  }
}

// Takes steps of the refinement back until few enough pairs are watched.
void keep_to_the_limit(Fitting& fit, Refinement& refinement, const model::ChainModel& chain,
                       const std::vector<Interval>& ranges) {
  constexpr std::size_t kOfAStep = 6;  // pairs that parting a capsule adds, about
  choose_pairs(fit, chain, ranges);
  while (fit.result.pairs.watched.size() > kDraftedPairs) {
    const std::size_t excess = fit.result.pairs.watched.size() - kDraftedPairs;
    if (!refinement.step_back()) return;
    for (std::size_t i = 0; i < excess / kOfAStep; ++i) refinement.step_back();
    choose_pairs(fit, chain, ranges);
  }
}

}  // namespace

SelfCollision fit_self_collision(const ChainPart& part, const model::ChainModel& model,
                                 const std::vector<Interval>& ranges, std::optional<double> floor,
                                 const std::function<void(std::size_t, std::size_t)>& progress) {
  Fitting fit = {.clearance = Clearance(model, ranges)};
  fit.result.safe_distance = kSafeDistance;
  const model::Urdf urdf =
      model::serial_part(model::read_urdf_file(part.urdf), part.root_link, part.tip_link);
  fit.bodies = read_bodies(part, urdf, model, fit.result.unread);
  if (floor) fit.floor = collision::floor_at(*floor);
  if (fit.bodies.empty()) {
    fit.result.shapes = collision::read_geometry(urdf, model).shapes;
    if (floor) fit.result.shapes.push_back(*fit.floor);
    fit.result.pairs = collision::choose_pairs(fit.result.shapes, model, ranges, kNear);
    return std::move(fit.result);
  }

  std::size_t step = 0;
  const std::size_t steps = fit.bodies.size() * (1 + kMostPerBody);
  const auto report = [&] {
    if (progress) progress(std::min(++step, steps), steps);
  };
  for (Body& body : fit.bodies) {
    begin_with_one(body);
    report();
  }
  fit.postures = draw_postures(fit.bodies, ranges, model);
  find_bodies_apart(fit);
  Refinement refinement(fit);
  while (refinement.step()) report();
  keep_to_the_limit(fit, refinement, model, ranges);

  for (const Body& body : fit.bodies) {
    FittedBody fitted = {.link = body.link, .files = body.files, .capsules = {}};
    fitted.size = body.size;
    for (const Part& p : body.parts) {
      fitted.capsules.push_back(p.capsule);
      fitted.stands_out = std::max(fitted.stands_out, p.stands_out);
    }
    fit.result.bodies.push_back(std::move(fitted));
  }
  return std::move(fit.result);
}

}  // namespace hg::new_files
