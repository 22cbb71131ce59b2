/// A number with its standard deviation.
#pragma once

namespace hg::identify {

struct Figure {
  double value = 0.0;
  double deviation = 0.0;
  bool is_found = false;  ///< false: not observable from the motion, `value` is the nominal one

  /// Half of the interval that covers the truth with 95 %.
  double interval() const noexcept { return 2.0 * deviation; }
};

}  // namespace hg::identify
