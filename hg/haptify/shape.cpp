#include "hg/haptify/shape.h"

namespace hg::haptify {

inspection::Workspace measure_shape(const config::Device& device, const ShapeConfig& config,
                                    std::uint64_t seed) {
  inspection::Random random(seed);
  inspection::Survey survey;
  survey.options.seed = seed;
  survey.cloud = inspection::cloud(device, config.postures, true, random);
  return inspection::workspace(device, survey);
}

}  // namespace hg::haptify
