#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/hapticgiant/identify_command.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_setup.h"
#include "hg/commissioning/identification/friction_traces.h"
#include "hg/config/device.h"
#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/recording/recording_reader.h"

namespace hg::apps {
namespace {

using identification::FrictionEstimate;
using identification::FrictionFigure;
using identification::FrictionTraces;

// Hands the samples on, with the device that the recording was made with unless another is given.
class Reader final : public recording::RecordingListener {
 public:
  explicit Reader(std::optional<config::Device> device) : device_(std::move(device)) {}

  void configuration(const recording::NamedText& text) override {
    if (!traces_) configuration_.push_back(text);
  }
  void event(const recording::Event&) override {}
  void sample(const Sample& sample) override {
    if (!traces_) start();
    traces_->add(sample);
  }

  const config::Device& device() const { return *device_; }
  const FrictionTraces& traces() const { return *traces_; }

 private:
  void start() {
    if (!device_) {
      try {
        device_ = recorded_scenario(configuration_).device;
      } catch (const SetupError& error) {
        throw SetupError(
            fmt::format("its configuration is not understood, give the device with --device: {}",
                        error.what()));
      }
    }
    traces_.emplace(device_->model, device_->control.loop.current_lag);
  }

  std::optional<config::Device> device_;
  std::optional<FrictionTraces> traces_;
  std::vector<recording::NamedText> configuration_;
};

// One line of the table and of the device file.
struct Line {
  const char* key;
  FrictionFigure found;
  double believed;
};

std::vector<Line> lines_of(const FrictionEstimate& found, const ActuatorModel& believed) {
  return {{"coulomb_friction_Nm", found.coulomb, believed.coulomb_friction},
          {"viscous_friction_Nms_per_rad", found.viscous, believed.viscous_friction},
          {"load_friction", found.load, believed.load_friction},
          {"stiction", found.stiction, believed.stiction},
          {"stribeck_rad_per_s", found.stribeck_speed, believed.stribeck_speed},
          {"presliding_rad", found.presliding, believed.presliding}};
}

std::string number(double value) { return fmt::format("{:.3g}", value); }

void print_joint(const std::string& name, const FrictionEstimate& found,
                 const ActuatorModel& believed) {
  print_out(
      "\n{}  slid {:.0f} s forward, {:.0f} s backward, {} reversals, up to {:.2f} rad/s; {:.2f} Nm "
      "rms unexplained\n",
      name, found.forward_s, found.backward_s, found.reversals, found.speed, found.residual);
  for (const Line& line : lines_of(found, believed)) {
    print_out("  {:<30}{:>9} {:<12}  device file {}\n", line.key,
              line.found.is_found ? number(line.found.value) : "-",
              line.found.is_found ? fmt::format("+- {}", number(line.found.deviation)) : "",
              number(line.believed));
  }
  for (const std::string& missing : found.missing) print_out("  not found: {}\n", missing);
}

void print_yaml(const std::vector<std::string>& names,
                const std::vector<FrictionEstimate>& estimates,
                const std::vector<ActuatorModel>& believed) {
  print_out("\nfor device.yaml, into the entry of each joint:\nactuators:\n");
  for (std::size_t i = 0; i < names.size(); ++i) {
    print_out("  {}:\n", names[i]);
    if (!estimates[i].coulomb.is_found) print_out("    # nothing was found\n");
    for (const Line& line : lines_of(estimates[i], believed[i])) {
      if (!line.found.is_found) continue;
      print_out("    {}: {}  # +- {}\n", line.key, number(line.found.value),
                number(line.found.deviation));
    }
    if (estimates[i].presliding_elements > 0) {
      print_out("    presliding_elements: {}\n", estimates[i].presliding_elements);
    }
  }
}

nlohmann::ordered_json to_json(const std::vector<std::string>& names,
                               const std::vector<FrictionEstimate>& estimates,
                               const std::vector<ActuatorModel>& believed) {
  nlohmann::ordered_json json;
  json["identified"] = "friction";
  json["joints"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const FrictionEstimate& found = estimates[i];
    nlohmann::ordered_json joint;
    joint["name"] = names[i];
    for (const Line& line : lines_of(found, believed[i])) {
      nlohmann::ordered_json& entry = joint[line.key];
      entry["is_found"] = line.found.is_found;
      if (line.found.is_found) {
        entry["value"] = line.found.value;
        entry["deviation"] = line.found.deviation;
      }
      entry["device_file"] = line.believed;
    }
    if (found.presliding_elements > 0) joint["presliding_elements"] = found.presliding_elements;
    joint["residual_Nm"] = found.residual;
    joint["forward_s"] = found.forward_s;
    joint["backward_s"] = found.backward_s;
    joint["reversals"] = found.reversals;
    joint["missing"] = found.missing;
    json["joints"].push_back(joint);
  }
  return json;
}

}  // namespace

int identify_friction(const IdentifyFrictionArguments& arguments) {
  check_writable(arguments.json, kJson);
  std::optional<config::Device> device;
  if (!arguments.device.empty())
    device = config::load_device(config::find_device(arguments.device));
  Reader reader(std::move(device));
  const recording::ReadResult read = recording::read_recording(arguments.file, reader);
  print_out(recording::to_text(read.losses));
  const FrictionTraces& traces = reader.traces();
  const DeviceModel& model = reader.device().model;
  if (traces.used() == 0) {
    throw SetupError(fmt::format(
        "{}: none of its {} samples has drives that are on, motor encoders, joint torques and the "
        "command at work: record a run whose joints move under torque control",
        arguments.file, traces.samples()));
  }
  print_out("{}: {} joints, drives on for {:.1f} s\n", arguments.file, traces.joints().size(),
            static_cast<double>(traces.used()) * model.dt());
  std::vector<std::string> names;
  std::vector<FrictionEstimate> estimates;
  bool is_any_found = false;
  for (std::size_t i = 0; i < traces.joints().size(); ++i) {
    names.push_back(model.chain.joints()[static_cast<std::size_t>(model.n_p) + i].name);
    estimates.push_back(identification::identify_friction(traces.joints()[i], model.actuators[i]));
    print_joint(names[i], estimates[i], model.actuators[i]);
    is_any_found = is_any_found || estimates[i].coulomb.is_found;
  }
  write_json(arguments.json, to_json(names, estimates, model.actuators));
  if (!is_any_found) {
    print_error("not usable: no joint moved enough for its friction\n");
    return 2;
  }
  print_yaml(names, estimates, model.actuators);
  return 0;
}

}  // namespace hg::apps
