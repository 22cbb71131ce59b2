/// Monitors closed brakes: motion and load of each.
#pragma once

#include <string>
#include <vector>

#include "hg/start_test/procedure.h"

namespace hg::start_test {

class BrakeWatch {
 public:
  explicit BrakeWatch(const Setup& setup);

  /// Starts monitoring at `time_s`: from then on no joint may move from its position in `from`.
  void begin(const Observation& from, double time_s);
  /// Evaluates one more period; an invalid sample is ignored. Returns names of brakes that have
  /// slipped since the last call, once each.
  std::vector<std::string> look(const Observation& seen);
  /// Names of brakes that have neither slipped nor yet carried their least load for kLoaded
  /// seconds.
  std::vector<std::string> without_load() const;
  /// One result per brake, the gantry first; kUntested where none was monitored, and in a
  /// simulation also without enough load, which fails the brake of a machine.
  std::vector<Item> items() const;

  static constexpr double kLoaded = 1.0;  ///< s

 private:
  struct Brake {
    Joint joint;
    double bound = 0.0;   ///< allowed motion, rad or m
    double start = 0.0;   ///< start position, rad or m
    double motion = 0.0;  ///< largest motion
    double load = 0.0;    ///< largest load
    double slipped_under = 0.0, loaded_s = 0.0;
    bool has_slipped = false;
  };

  bool is_good(const Observation& seen) const;
  void start(const Observation& seen);
  template <typename F>
  void each(const Observation& seen, F&& f);

  std::vector<Brake> brakes_;
  std::size_t n_p_;
  /// Outcome of an unloaded brake: a simulated hand cannot twist through the device protocol
  Outcome without_load_;
  double last_s_ = 0.0;
  bool has_begun_ = false, has_start_ = false;
};

}  // namespace hg::start_test
