/// Index of the first NaN or infinity in several vectors.
#pragma once

#include <cmath>

namespace hg {

/// Index of the first component that is NaN or infinite, counted through all vectors; -1 = none.
template <typename... Vectors>
int first_not_finite(const Vectors&... vectors) noexcept {
  double nothing = 0.0;  // 0 x is NaN if x is not finite, else 0
  const auto add = [&](const auto& v) {
    for (int i = 0; i < v.size(); ++i) nothing += 0.0 * v[i];
  };
  (add(vectors), ...);
  if (nothing == 0.0) return -1;

  int passed = 0, found = -1;
  const auto look = [&](const auto& v) {
    for (int i = 0; i < v.size() && found < 0; ++i) {
      if (!std::isfinite(v[i])) found = passed + i;
    }
    passed += static_cast<int>(v.size());
  };
  (look(vectors), ...);
  return found;
}

}  // namespace hg
