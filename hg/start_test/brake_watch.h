/// Watches closed brakes: how far each moves, and what it carries meanwhile.
#pragma once

#include <string>
#include <vector>

#include "hg/start_test/procedure.h"

namespace hg::start_test {

class BrakeWatch {
 public:
  explicit BrakeWatch(const Setup& setup);

  /// From `time_s` on nothing may move away from where it was in `from`.
  void begin(const Observation& from, double time_s);
  /// One more period; a sample that is no good says nothing. Names of brakes that have slipped
  /// since the last call, once each.
  std::vector<std::string> look(const Observation& seen);
  /// Names of brakes that have not carried their least load for kLoaded seconds yet.
  std::vector<std::string> without_load() const;
  /// One per brake, the gantry first; kUntested where nothing was watched, and in a simulation
  /// also without enough load, which fails the brake of a machine.
  std::vector<Item> items() const;

  static constexpr double kLoaded = 1.0;  ///< s

 private:
  struct Brake {
    Joint joint;
    double bound = 0.0;   ///< of its motion, rad or m
    double start = 0.0;   ///< rad or m
    double motion = 0.0;  ///< the largest
    double load = 0.0;    ///< the largest
    double slipped_under = 0.0, loaded_s = 0.0;
    bool has_slipped = false;
  };

  bool is_good(const Observation& seen) const;
  void start(const Observation& seen);
  template <typename F>
  void each(const Observation& seen, F&& f);

  std::vector<Brake> brakes_;
  std::size_t n_p_;
  Outcome without_load_;  ///< a simulated hand cannot twist through the device protocol
  double last_s_ = 0.0;
  bool has_begun_ = false, has_start_ = false;
};

}  // namespace hg::start_test
