#include "tests/law/recorded_states.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "hg/hqp/text.h"

namespace hg {
namespace {

const std::string kEnding = ".states.jsonl.gz";

// JSON has no infinity, the recordings do
nlohmann::json parse(std::string line) {
  const std::string word = "Infinity";
  for (std::size_t at = line.find(word); at != std::string::npos; at = line.find(word, at)) {
    const bool is_negative = at > 0 && line[at - 1] == '-';
    line.replace(at - is_negative, word.size() + is_negative, is_negative ? "\"-inf\"" : "\"inf\"");
  }
  return nlohmann::json::parse(line);
}

double number(const nlohmann::json& value) {
  if (!value.is_string()) return value.get<double>();
  return value.get<std::string>() == "inf" ? kInfinity : -kInfinity;
}

limits::JointLimits joint_limits(const nlohmann::json& from, const std::string& q_min,
                                 const std::string& q_max, const std::string& dq_max,
                                 const std::string& ddq_max, std::size_t i) {
  return {number(from.at(q_min).at(i)), number(from.at(q_max).at(i)), number(from.at(dq_max).at(i)),
          number(from.at(ddq_max).at(i))};
}

}  // namespace

std::filesystem::path reference_folder() {
  const char* folder = std::getenv("HG_REFERENCE_DATA");
  return folder != nullptr ? folder : "tests/reference";
}

std::vector<std::string> recording_names() {
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(reference_folder())) return names;
  for (const auto& entry : std::filesystem::directory_iterator(reference_folder())) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(kEnding)) names.push_back(file.substr(0, file.size() - kEnding.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

Recording read_recording(const std::string& name) {
  const std::filesystem::path base = reference_folder() / name;
  Recording recording;
  std::istringstream states(hqp::read_text(base.string() + kEnding));
  std::string line;
  std::getline(states, line);
  recording.header = parse(line);
  while (std::getline(states, line)) recording.states.push_back(parse(line));

  recording.problems = hqp::read_problems(base.string() + ".hqp.gz");
  std::istringstream solutions(hqp::read_text(base.string() + ".sol.gz"));
  while (std::getline(solutions, line)) {
    std::istringstream words(line);
    recording.solutions.emplace_back();
    for (std::string word; words >> word;) recording.solutions.back().push_back(std::stod(word));
  }
  recording.is_skipped.resize(recording.states.size());
  if (std::filesystem::exists(base.string() + ".skip")) {
    std::istringstream skip(hqp::read_text(base.string() + ".skip"));
    // the first word of a line is the index of a problem; what follows says why
    while (std::getline(skip, line)) {
      std::size_t index = 0;
      if (std::istringstream(line) >> index) recording.is_skipped.at(index) = true;
    }
  }
  return recording;
}

Eigen::VectorXd vector_of(const nlohmann::json& array) {
  Eigen::VectorXd vector(static_cast<Eigen::Index>(array.size()));
  for (std::size_t i = 0; i < array.size(); ++i) {
    vector[static_cast<Eigen::Index>(i)] = number(array[i]);
  }
  return vector;
}

DeviceModel recorded_device(const Recording& recording) {
  const nlohmann::json& params = recording.header.at("params");
  DeviceModel device{
      .chain = model::ChainModel::from_urdf_file(reference_folder() / "models/hapticgiant.urdf"),
      .n_p = 2,
      .n_m = 6};
  device.handle = device.chain.frame("handle");
  device.elbow = device.chain.frame("elbow");
  device.rate_Hz = 1.0 / number(params.at("dt"));
  device.gantry_range.resize(2);
  for (std::size_t i = 0; i < 6; ++i) {
    device.joint_limits.push_back(
        joint_limits(params, "qm_min", "qm_max", "dqm_max", "ddqm_max", i));
  }
  device.virtual_joints = {
      {.name = "q4+q5",
       .weights = Eigen::Vector<double, 6>(0, 0, 0, 1, 1, 0),
       .limits = {number(params.at("s_min")), number(params.at("s_max")), kInfinity, kInfinity}}};
  for (const int frame : {device.handle, device.elbow}) {
    CartesianLimit box{.name = "box", .frame = frame, .axes = {}, .margin = 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.axes[axis].q_min = number(params.at("x_lb").at(axis));
      box.axes[axis].q_max = number(params.at("x_ub").at(axis));
    }
    device.cartesian_limits.push_back(box);
  }
  return device;
}

rendering::TwinModel recorded_twin(const Recording& recording, const std::vector<int>& locked) {
  const nlohmann::json& dt = recording.header.at("dt");
  model::ChainOptions options{.gravity = dt.at("gravity").get<bool>()};
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<Eigen::Index>(row);
    const Eigen::VectorXd numbers = vector_of(dt.at("T_BA").at(row));
    options.T_B_root.R.row(i) = numbers.head<3>();
    options.T_B_root.p[i] = numbers[3];
  }
  const std::string urdf = dt.at("urdf").get<std::string>();
  rendering::TwinModel twin{
      .chain = model::ChainModel::from_urdf_file(reference_folder() / "models" / urdf, options)};
  twin.end_effector = twin.chain.frame(dt.at("ee").get<std::string>());
  twin.q_start = twin.chain.neutral();
  for (std::size_t i = 0; i < twin.chain.joints().size(); ++i) {
    const model::Joint& joint = twin.chain.joints()[i];
    rendering::TwinDof dof{.name = joint.name, .q_index = joint.q_index};
    dof.limits = joint_limits(dt, "qmin", "qmax", "dqmax", "ddqmax", i);
    dof.stiffness = number(dt.at("K").at(i));
    dof.rest = number(dt.at("q_rest").at(i));
    dof.damping = number(dt.at("D").at(i));
    twin.dofs.push_back(dof);
    if (locked.at(i) == 0) continue;
    twin.locks.push_back(
        {.name = "lock", .dof = static_cast<int>(i), .position = 0.0, .engaged_while = {}});
  }
  return twin;
}

rendering::RenderingOptions recorded_options(const Recording& recording) {
  const nlohmann::json& params = recording.header.at("params");
  return {.law = rendering::Law::kPaper,
          .bounds = rendering::Bounds::kPaper,
          .T_C = number(params.at("T_C")),
          .kP_tran = number(params.at("kP_tran")),
          .kD_tran = number(params.at("kD_tran")),
          .kP_rot = number(params.at("kP_rot")),
          .kD_rot = number(params.at("kD_rot"))};
}

}  // namespace hg
