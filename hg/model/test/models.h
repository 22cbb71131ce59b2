/// The chains that the tests of this module share, and random states of them.
#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::model {

inline ChainModel haptic_giant_chain(const ChainOptions& options = {}) {
  return ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf", options);
}

inline ChainModel twin_chain(const std::string& name, const ChainOptions& options = {}) {
  return ChainModel::from_urdf_file("models/twins/" + name + "/" + name + ".urdf", options);
}

/// The file of a robot of the wheel example-robot-data, tools/requirements-test.txt.
inline std::filesystem::path example_robot_file(const std::string& file) {
  for (const auto& python : std::filesystem::directory_iterator(".venv/lib")) {
    const auto path =
        python.path() / "site-packages/cmeel.prefix/share/example-robot-data/robots" / file;
    if (std::filesystem::exists(path)) return path;
  }
  throw SetupError(file + ": no such robot; pip install -r tools/requirements-test.txt");
}

inline ChainModel example_robot(const std::string& file, const std::string& tip_link = "") {
  return ChainModel::from_urdf_file(example_robot_file(file), {.tip_link = tip_link});
}

/// A placement that is no multiple of a right angle.
inline Pose slanted() {
  return {Eigen::Vector3d(0.3, -1.2, 0.5),
          (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized())).toRotationMatrix()};
}

/// Slanted axes, a prismatic and a floating joint in the middle, masses on fixed links.
inline ChainModel mixed_chain(const ChainOptions& options = {}) {
  constexpr std::string_view kText = R"(<robot name="mixed">
  <link name="base"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="a"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.4 -0.3 0.2"/><axis xyz="1 2 -3"/>
    <limit lower="-2" upper="2"/></joint>
  <link name="a"><inertial><origin xyz="0.1 0 0.2" rpy="0.3 0.1 0"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.02" izz="0.04" ixy="0.001" ixz="0" iyz="0"/></inertial></link>
  <joint name="weld" type="fixed"><parent link="a"/><child link="a_tool"/>
    <origin xyz="0.2 -0.1 0" rpy="0 0.5 0.3"/></joint>
  <link name="a_tool"><inertial><origin xyz="0 0.1 0"/><mass value="0.7"/>
    <inertia ixx="0.002" iyy="0.001" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="a_tool"/><child link="b"/>
    <origin xyz="0 0 0.4"/><axis xyz="0.6 0 0.8"/><limit lower="-1" upper="1"/></joint>
  <link name="b"><inertial><origin xyz="0.05 0 0"/><mass value="1.5"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="free" type="floating"><parent link="b"/><child link="c"/>
    <origin xyz="0.3 0 0" rpy="0 0 1"/></joint>
  <link name="c"><inertial><origin xyz="0 0.1 0.1"/><mass value="3"/>
    <inertia ixx="0.05" iyy="0.06" izz="0.07" ixy="0" ixz="0.01" iyz="0"/></inertial></link>
  <joint name="spin" type="continuous"><parent link="c"/><child link="d"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 1 0"/></joint>
  <link name="d"><inertial><origin xyz="0 0 0.1"/><mass value="0.5"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="handle_fix" type="fixed"><parent link="d"/><child link="handle"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.5 0.4 0.3"/></joint>
  <link name="handle"/>
</robot>)";
  return ChainModel::from_urdf_text(kText, "mixed.urdf", options);
}

/// Every kind of chain, all with frames "handle".
inline std::vector<ChainModel> all_chains() {
  const ChainOptions options = {.T_B_root = slanted()};
  std::vector<ChainModel> chains;
  chains.push_back(haptic_giant_chain());
  for (const char* twin : {"free_space", "door", "excavator"}) {
    chains.push_back(twin_chain(twin, options));
  }
  chains.push_back(mixed_chain(options));
  chains.push_back(ChainModel::free_body({.mass = 4.0,
                                          .inertia = Eigen::Vector3d(0.05, 0.07, 0.09).asDiagonal(),
                                          .p_handle_com = Eigen::Vector3d(0.1, -0.05, 0.2)},
                                         options));
  ChainOptions floating = options;
  floating.floating_root = true;
  chains.push_back(ChainModel::from_urdf_text(R"(<robot name="floating"><link name="body"><inertial>
    <mass value="5"/><inertia ixx="0.1" iyy="0.2" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="arm" type="continuous"><parent link="body"/><child link="handle"/>
    <origin xyz="0.2 0 0.1"/><axis xyz="0 0 1"/></joint>
    <link name="handle"><inertial><origin xyz="0.3 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)",
                                              "floating.urdf", floating));
  return chains;
}

/// Random states: every coordinate in (-2, 2), orientations anywhere, velocities in (-2, 2).
class RandomState {
 public:
  explicit RandomState(unsigned seed) : engine_(seed) {}

  Eigen::VectorXd vector(int size) {
    Eigen::VectorXd v(size);
    for (double& x : v) x = uniform_(engine_);
    return v;
  }
  Eigen::VectorXd q(const ChainModel& chain) {
    return chain.integrate(chain.neutral(), vector(chain.nv()));
  }
  Eigen::VectorXd q(const ChainData& chain) { return q(chain.model()); }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> uniform_{-2.0, 2.0};
};

}  // namespace hg::model
