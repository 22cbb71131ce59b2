#include "hg/identify/recorded_friction.h"

#include <fmt/format.h>

#include <utility>

#include "hg/core/error.h"
#include "hg/identify/friction_traces.h"
#include "hg/identify/recorded_device.h"
#include "hg/identify/settling.h"

namespace hg::identify {
namespace {

// Collects the traces of all joints, with the device of the recording unless another is given.
class Reader final : public recording::RecordingListener {
 public:
  Reader(const std::string& file, std::optional<config::DeviceConfig> device)
      : file_(file), device_(std::move(device)) {}

  void configuration(const recording::NamedText& text) override {
    if (!traces_) configuration_.push_back(text);
  }
  void event(const recording::Event&) override {}
  void sample(const Sample& sample) override {
    if (!traces_) start();
    traces_->add(sample);
  }

  const config::DeviceConfig& device() const { return *device_; }
  const FrictionTraces& traces() const { return *traces_; }

 private:
  void start() {
    if (!device_) device_ = recorded_device(file_, configuration_);
    traces_.emplace(device_->model, device_->control.loop.current_lag);
  }

  const std::string& file_;
  std::optional<config::DeviceConfig> device_;
  std::optional<FrictionTraces> traces_;
  std::vector<recording::NamedText> configuration_;
};

}  // namespace

RecordedFriction identify_recorded_friction(const std::string& file,
                                            std::optional<config::DeviceConfig> device) {
  Reader reader(file, std::move(device));
  RecordedFriction result;
  result.losses = recording::read_recording(file, reader).losses;
  const FrictionTraces& traces = reader.traces();
  const DeviceModel& model = reader.device().model;
  refuse_if_cut_up(file, result.losses, traces.used(), traces.gaps());
  if (traces.used() == 0) {
    throw SetupError(fmt::format(
        "{}{}: none of its {} samples has drives that are on, motor encoders, joint torques and "
        "the command at work: record a run whose joints move under torque control",
        recording::to_text(result.losses), file, traces.samples()));
  }
  result.used_s = static_cast<double>(traces.used()) * model.dt();
  for (int i = 0; i < model.n_m; ++i) {
    const ActuatorModel& nominal = model.actuators[i];
    result.joints.push_back({model.chain.joints()[model.n_p + i].name,
                             identify_friction(traces.joints()[i], nominal), nominal});
  }
  return result;
}

}  // namespace hg::identify
