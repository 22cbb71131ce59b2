#include "hg/experiments/runs.h"

#include <algorithm>
#include <limits>

#include "hg/core/error.h"

namespace hg::experiments {

std::vector<nlohmann::json> Runs::next(std::size_t count,
                                       const std::function<nlohmann::json(std::size_t)>& play,
                                       std::size_t together) {
  std::vector<nlohmann::json> found(count);
  const std::size_t units = (count + together - 1) / together;
  if (plays_) {
    play_units(units, [&](std::size_t unit) {
      for (std::size_t i = unit * together; i < std::min(count, (unit + 1) * together); ++i) {
        // as from another process: JSON has no NaN
        found[i] = nlohmann::json::parse(play(i).dump());
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (!found[i].is_null()) results_[next_ + i] = found[i];
    }
  }
  for (std::size_t i = 0; i < count && !plays_; ++i) {
    const auto known = results_.find(next_ + i);
    if (known == results_.end()) {
      throw SetupError("run " + std::to_string(next_ + i) + " has no result");
    }
    found[i] = known->second;
  }
  next_ += count;
  units_ += units;
  return found;
}

void Runs::play_units(std::size_t count, const std::function<void(std::size_t)>& play_unit) {
  if (is_threaded_) return do_all(count, play_unit, progress_);
  for (std::size_t unit = 0; unit < count; ++unit) {
    if ((units_ + unit) % part_.count == part_.index - 1) play_unit(unit);
  }
}

double number_of(const nlohmann::json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace hg::experiments
