#include "hg/controller/cycle.h"

#include "hg/controller/cycle_stages.h"

namespace hg::controller {

Cycle::Cycle(const CycleConfig& config, const DeviceModel& device, const rendering::TwinModel& twin)
    : stages_(std::make_unique<CycleStages>(config, device, twin)) {}
Cycle::Cycle(Cycle&& other) noexcept = default;
Cycle& Cycle::operator=(Cycle&& other) noexcept = default;
Cycle::~Cycle() = default;

void Cycle::step(const SensorFrame& sensors, const OperatorFrame& operator_input,
                 CommandFrame& command, CycleRecord& record) noexcept HG_NONBLOCKING {
  stages_->step(sensors, operator_input, command, record);
}

bool Cycle::is_held(const SensorFrame& sensors) const noexcept { return stages_->is_held(sensors); }
const DeviceModel& Cycle::device() const noexcept { return stages_->rendering().device(); }
double Cycle::time_s() const noexcept { return stages_->time_s(); }
void Cycle::watch(const StageProbe& probe) noexcept { stages_->watch(probe); }
const CycleState& Cycle::state() const noexcept { return stages_->state(); }
void Cycle::restore(const CycleState& state) noexcept { stages_->restore(state); }
const hqp::Problem& Cycle::problem() const noexcept { return stages_->rendering().problem(); }
const hqp::ProblemCapture& Cycle::kept_problems() const noexcept {
  return stages_->rendering().kept_problems();
}
void Cycle::keep_problem(double cycle_time_us) noexcept { stages_->keep_problem(cycle_time_us); }

}  // namespace hg::controller
