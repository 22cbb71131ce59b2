/// The free body of an experiment.
#pragma once

namespace hg::experiments {

/// The body that the handle should feel like.
struct FreeTwin {
  double mass = 6.0;     ///< kg
  double damping = 4.0;  ///< Ns/m
};

}  // namespace hg::experiments
