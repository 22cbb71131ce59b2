/// The person beside a simulated machine: does at once what is asked, and sees the true handle.
#pragma once

#include <atomic>
#include <functional>
#include <utility>

#include "hg/commission/rig.h"

namespace hg::commission {

class SimulatedCrew : public Crew {
 public:
  using Print = std::function<void(double time_s, const std::string& words)>;
  /// `interrupted` must outlive it.
  explicit SimulatedCrew(const std::atomic<bool>& interrupted, Print print = {})
      : interrupted_(interrupted), print_(std::move(print)) {}

  bool holds_key() override { return true; }
  bool wants_to_end() override { return interrupted_.load(); }
  void say(double time_s, const std::string& words) override {
    if (print_) print_(time_s, words);
  }
  /// Without words: what moves from here on is what the next question is about.
  void ask(const Question& question) override;
  std::optional<bool> answer() override;
  void pull(const Eigen::Vector3d& direction) override { pull_ = direction; }
  void act(const Pose& T_B_H, CommandFrame& command) override;

 private:
  const std::atomic<bool>& interrupted_;
  Print print_;
  Pose T_B_H_, start_;
  Question question_;
  Eigen::Vector3d pull_ = Eigen::Vector3d::Zero();
};

}  // namespace hg::commission
