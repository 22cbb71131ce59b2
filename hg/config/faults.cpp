#include "hg/config/faults.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "hg/core/error.h"

namespace hg::config {

void Places::add(const std::string& item, Place place) { places_.emplace(item, place); }

Place Places::nearest(std::string item) const {
  while (true) {
    const auto found = places_.find(item);
    if (found != places_.end()) return found->second;
    const std::size_t end = item.find_last_of(".[");
    if (end == std::string::npos) return {};
    item.resize(end);
  }
}

void Faults::add(Place place, std::string_view item, std::string_view what) {
  std::string message =
      file_ + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": ";
  if (!item.empty()) (message += item) += ": ";
  faults_.push_back({place, message += what});
}

void Faults::add_complete(std::string_view message) {
  faults_.push_back({{std::numeric_limits<int>::max(), 0}, std::string(message)});
}

void Faults::throw_if_any() const {
  if (faults_.empty()) return;
  std::vector<Fault> sorted = faults_;
  std::ranges::stable_sort(sorted, {}, [](const Fault& fault) {
    return std::tuple(fault.place.line, fault.place.column);
  });
  std::string message;
  for (const Fault& fault : sorted) {
    if (!message.empty()) message += '\n';
    message += fault.message;
  }
  throw SetupError(message);
}

}  // namespace hg::config
