// A scenario without clock and threads: the door, opened by its scripted hand. Argument: its file.
#include <cstdio>

#include "hg/runtime/requests.h"
#include "hg/scenario/assembly.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const hg::config::Scenario door = hg::config::load_scenario(arguments[1]);
  hg::controller::Cycle cycle = hg::scenario::make_cycle(door);
  hg::simulator::SimulatedDevice device = hg::scenario::make_simulated_device(door);
  hg::Sample sample;
  while (sample.record.time_s < 10.6) {
    device.read(sample.sensors);
    cycle.step(sample.sensors, sample.operator_input, sample.command, sample.record);
    device.write(sample.command);
    sample.operator_input.request =
        hg::runtime::next_request(sample.record, cycle.is_held(sample.sensors), false);
  }
  std::printf("hinge at %.2f rad after %.1f s\n", sample.record.twin.q_a[0], sample.record.time_s);
}
