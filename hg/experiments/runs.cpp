#include "hg/experiments/runs.h"

#include <limits>

#include "hg/core/error.h"

namespace hg::experiments {

std::vector<nlohmann::json> Runs::next(std::size_t count,
                                       const std::function<nlohmann::json(std::size_t)>& play,
                                       std::size_t together) {
  std::vector<nlohmann::json> found(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t number = next_ + i;
    const bool is_mine = (units_ + i / together) % part_.count == part_.index - 1;
    if (plays_ && is_mine) {
      found[i] = results_[number] = play(i);
    } else if (!plays_) {
      const auto known = results_.find(number);
      if (known == results_.end()) {
        throw SetupError("run " + std::to_string(number) + " of the study has no result");
      }
      found[i] = known->second;
    }
  }
  next_ += count;
  units_ += (count + together - 1) / together;
  return found;
}

double number_of(const nlohmann::json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace hg::experiments
