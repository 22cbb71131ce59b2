#include "apps/hapticgiant/haptify_method.h"

#include <fmt/format.h>

namespace hg::apps {

std::vector<std::string> method_of(const haptify::Benchmark& result) {
  std::vector<std::string> text;
  for (const haptify::Figure& figure : result.table) {
    if (!figure.note.empty()) text.push_back(fmt::format("{}: {}.", figure.name, figure.note));
  }
  text.insert(
      text.end(),
      {"Instruments: Haptify has a force plate, motion capture and an instrumented handle; here "
       "the "
       "true motion of the handle and the true wrench of the hand are read from the simulation, "
       "without an error of their own. What the device's own sensors get wrong is in the "
       "figures: it is controlled with them.",
       "Person: Haptify's user holds and leads the handle by hand; here a scripted hand of "
       "docs/concepts/person.md (arm, grip, tremor) does.",
       "Corner frequencies, speeds and durations of Haptify's protocol are not in the paper: "
       "vibration "
       "counts above 20 Hz, and speeds are ours. Forces of free motion depend on them, because "
       "a rendered body is led.",
       "Haptify takes an alpha shape of the positions that a user's hand explored; here postures "
       "are drawn at random with the real kinematics, and the volume is that of the voxels with a "
       "position in them (those at the edge count half). The control loop does not run.",
       "Free motion is that of a rendered free body, which a device under admittance control "
       "cannot do without; Touch and Touch X under impedance control are only switched off."});
  return text;
}

}  // namespace hg::apps
