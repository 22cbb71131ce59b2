// A machine of one's own. Arguments: its device.yaml, and a twin.yaml to put into its hand.
#include <cstdio>

#include "hg/config/control_cycle.h"
#include "hg/core/error.h"
#include "hg/runtime/runtime.h"
#include "robot.h"

int main(int count, char** arguments) try {
  if (count != 3) return 2;
  const hg::config::DeviceConfig device = hg::config::load_device(arguments[1]);
  const hg::config::Twin twin = hg::config::load_twin(arguments[2]);
  hg::controller::Cycle cycle = hg::config::make_cycle(device, twin);
  const hg::VectorM start{{0.0, 0.6, 1.2, 0.0, 0.8, 0.0}};  // rad
  MyRobot robot(start, device.model.dt());

  hg::runtime::Runtime runtime({.duration_s = 2.0}, cycle, robot);
  runtime.start();
  const hg::runtime::RuntimeReport report = runtime.join();
  if (!report.has_run || report.fault.code != hg::FaultCode::kNone) {
    std::fprintf(stderr, "not run to the end. Fault: %s. Refusal: %s\n",
                 to_string(report.fault.code).data(), to_string(report.refusal).data());
    return 1;
  }
  hg::SensorFrame now;
  robot.read(now);
  const hg::VectorM moved = now.q_m - start;
  std::printf("the joints have moved by up to %.2f rad in %d cycles\n", moved.cwiseAbs().maxCoeff(),
              static_cast<int>(report.cycles));
} catch (const hg::SetupError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
