#include "hg/studies/haptify/benchmark.h"

#include "hg/studies/haptify/groups.h"

namespace hg::haptify {

Benchmark measure(const config::Scenario& scenario, const HaptifyOptions& options,
                  const Told& told) {
  Benchmark result = {.options = options, .device = scenario.device.name};
  const Group group = {scenario, options, told, result};
  add_workspace(group);
  add_free_space(group);
  add_sources(group);
  add_sliding(group);
  add_stiffness(group);
  add_peak(group);
  add_dynamics(group);
  add_transparency(group);
  add_force_response(group);
  add_latency(group);
  add_z_width(group);
  add_impacts(group);
  add_felt_mass(group);
  add_rotation(group);
  add_springs(group);
  return result;
}

}  // namespace hg::haptify
