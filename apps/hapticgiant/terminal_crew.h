/// The person beside a machine, at the keyboard of a terminal: the space bar is the key that is
/// held, y and n are answers.
#pragma once

#include <termios.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "hg/commission/rig.h"

namespace hg::apps {

class TerminalCrew final : public commission::Crew {
 public:
  using Print = std::function<void(double time_s, const std::string& words)>;
  /// Reads single keys from now on. `interrupted` must outlive it. Throws SetupError where standard
  /// input is no terminal.
  TerminalCrew(const std::atomic<bool>& interrupted, Print print);
  ~TerminalCrew() override;  ///< Gives the terminal back as it was.
  TerminalCrew(const TerminalCrew&) = delete;
  TerminalCrew& operator=(const TerminalCrew&) = delete;

  bool holds_key() override;
  bool wants_to_end() override { return interrupted_.load(); }
  void say(double time_s, const std::string& words) override;
  void ask(const commission::Question& question) override;
  std::optional<bool> answer() override;
  void pull(const Eigen::Vector3d& /*direction*/) override {}

 private:
  void read_keys();

  const std::atomic<bool>& interrupted_;
  Print print_;
  termios before_{};
  double time_s_ = 0.0;
  std::atomic<std::int64_t> held_until_ns_{0};
  std::atomic<char> answer_{0};  ///< y, n, or 0: none yet
  std::atomic<bool> is_over_{false};
  std::thread reader_;
};

}  // namespace hg::apps
