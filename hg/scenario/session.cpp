#include "hg/scenario/session.h"

#include <utility>

#include "hg/config/simulation/scenario.h"
#include "hg/scenario/assembly.h"

namespace hg::scenario {
namespace {

runtime::SessionPlan plan_of(const config::Scenario& scenario, TwinForceSource* twin_force,
                             TwinBaseSource* twin_base) {
  return {.duration_s = planned_duration_s(scenario),
          .changes = scenario.changes,
          .load = faults::loads_of(scenario.faults),
          .twin_force = twin_force,
          .twin_base = twin_base};
}

}  // namespace

Session::Session(const config::Scenario& scenario)
    : Session(scenario, make_simulated_device(scenario)) {}

Session::Session(const std::filesystem::path& file) : Session(config::load_scenario(file)) {}

Session::Session(const config::Scenario& scenario, std::unique_ptr<device::Device> device)
    : SessionParts{make_cycle(scenario), std::move(device), make_twin_force(scenario),
                   make_twin_base(scenario)},
      runtime::Session(own_cycle, *own_device,
                       plan_of(scenario, own_twin_force.get(), own_twin_base.get())) {}

}  // namespace hg::scenario
