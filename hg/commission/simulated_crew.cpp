#include "hg/commission/simulated_crew.h"

#include "hg/core/rotation.h"

namespace hg::commission {

void SimulatedCrew::ask(const Question& question) {
  if (question.words.empty()) start_ = T_B_H_;
  question_ = question;
}

// A motion counts as the one asked for when it goes its way by half of it to twice as far.
std::optional<bool> SimulatedCrew::answer() {
  const auto is_like = [](const Eigen::Vector3d& seen, const Eigen::Vector3d& asked) {
    const double share = seen.dot(asked) / asked.squaredNorm();
    return share > 0.5 && share < 2.0 && (seen - share * asked).norm() < 0.5 * seen.norm();
  };
  constexpr double kSees = 0.004;  // m
  if (question_.way.norm() > kSees) return is_like(T_B_H_.p - start_.p, question_.way);
  return is_like(rotation_between(start_.R, T_B_H_.R), question_.turn);
}

// The hand stays where the handle is, or beyond it where it pulls.
void SimulatedCrew::act(const Pose& T_B_H, CommandFrame& command) {
  constexpr double kReach = 0.25;  // m
  T_B_H_ = T_B_H;
  command.hand_target.active = true;
  command.hand_target.turns = false;
  command.hand_target.p_B = T_B_H.p + kReach * pull_;
}

}  // namespace hg::commission
