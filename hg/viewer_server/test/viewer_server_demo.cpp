// A page without a controller: a fake door that follows the dragged handle like a spring, and a
// device that is posed at the door's handle in closed form. Serves the browser test.
//
// Usage: viewer_server_demo PAGE DEVICE_URDF DOOR_URDF [PORT]; ends on SIGINT and SIGTERM.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "hg/core/error.h"
#include "hg/viewer_server/viewer_server.h"

namespace {

using hg::viewer_server::JointType;

constexpr double kPeriod = 1e-3;  // s
std::atomic<bool> is_over{false};

// Hinge upright at `root`, lever at its free edge; the handle is where the device's hand grips.
struct Door {
  Eigen::Vector3d root = {-0.4, 0.0, -0.85};
  double hinge = 0.0, hinge_speed = 0.0, lever = 0.0;
  bool is_locked = true;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();

  Eigen::Matrix3d R_B_hinge() const {
    return Eigen::AngleAxisd(hinge, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }

  Eigen::Vector3d handle() const {
    const Eigen::Vector3d p_lever = {0.86 - 0.11 * std::cos(lever), -0.06, -0.11 * std::sin(lever)};
    return root + R_B_hinge() * p_lever;
  }

  void step(const hg::HandTarget& hand) {
    force.setZero();
    if (hand.active) force = 300.0 * (hand.p_B - handle());
    if (force.norm() > 60.0) force *= 60.0 / force.norm();

    const double pressed = hand.active ? 0.8 * hand.press : 0.0;
    lever += kPeriod / 0.08 * (pressed - lever);
    is_locked = lever < 0.5 && hinge < 0.03;

    const Eigen::Vector3d arm = handle() - root;
    const double torque = (arm.x() * force.y() - arm.y() * force.x()) - 3.0 - 2.0 * hinge;
    hinge_speed += kPeriod * (torque - 4.0 * hinge_speed) / 2.5;
    hinge += kPeriod * hinge_speed;
    const double upper = is_locked ? std::min(hinge, 0.0) : 1.75;
    if (hinge < 0.0 || hinge > upper) hinge_speed = 0.0;
    hinge = std::clamp(hinge, 0.0, std::max(upper, 0.0));
  }
};

// Closed-form posture: elbow bent by a right angle, hand level, gantry wherever that needs it.
void pose_device(const Door& door, hg::CycleRecord& record) {
  const Eigen::Vector3d p = door.handle();
  const double psi = door.hinge - 0.5 * M_PI;
  const double s = 0.5 * M_PI;
  const double q4 = std::acos(std::clamp((-0.75 - 0.12 * std::cos(s) - p.z()) / 0.42, -1.0, 1.0));
  const double q2 = 0.5 * M_PI;
  const double q3 = -std::atan(0.53 / 0.67);
  const double q1 = psi - M_PI - q2 - q3;
  const double out = 0.42 * std::sin(q4) + 0.12 * std::sin(s);
  record.reference.q_m.resize(6);
  record.reference.q_m << q1, q2, q3, q4, s - q4, 0.0;
  record.robot.q_p.resize(2);
  record.robot.q_p << p.x() - 0.53 * std::cos(q1) - 0.67 * std::cos(q1 + q2) - out * std::cos(psi),
      p.y() - 0.53 * std::sin(q1) - 0.67 * std::sin(q1 + q2) - out * std::sin(psi);
}

void report(const Door& door, hg::CycleRecord& record) {
  record.mode = hg::Mode::kRunning;
  record.twin.q_a.resize(2);
  record.twin.q_a << door.hinge, door.lever;
  record.T_B_H.p = door.handle();
  record.robot.w_H.head<3>() = door.force;
  record.limit_count = 1;
  const bool leans = door.force.norm() > 2.0;
  record.felt_limit = leans && (door.is_locked || door.hinge >= 1.75 || door.hinge <= 0.0) ? 0 : -1;
  record.limits[0].cause = door.is_locked ? hg::LimitCause::kLock : hg::LimitCause::kPosition;
  record.limits[0].state = door.hinge > 1.0 ? hg::LimitState::kUpper : hg::LimitState::kLower;
  record.limits[0].reaction = 0.7 * door.force.norm();
}

hg::viewer_server::Scene make_scene(const char* device, const char* door_urdf, const Door& door) {
  hg::viewer_server::Scene scene;
  scene.title = "Door, demonstration";
  scene.device.urdf = device;
  for (const char* name : {"ppu1", "ppu2", "m1", "m2", "m3", "m4", "m5", "m6"}) {
    const bool is_gantry = name[0] == 'p';
    scene.device.joints.push_back({name, is_gantry ? JointType::kPrismatic : JointType::kRevolute});
  }
  scene.gantry_joints = 2;
  scene.environment = hg::viewer_server::Environment::kDoor;
  scene.refusal = "this demonstration follows no commands";
  scene.twin.urdf = door_urdf;
  scene.twin.T_B_root.p = door.root;
  scene.twin.joints = {{"hinge", JointType::kRevolute}, {"lever", JointType::kRevolute}};
  scene.limits = {{hg::LimitKind::kTwinJoint, "hinge", true, {0.0, 1.75}},
                  {hg::LimitKind::kTwinJoint, "lever", true, {0.0, 0.8}}};
  scene.box =
      Eigen::AlignedBox3d(Eigen::Vector3d(-1.7, -2.1, -1.4), Eigen::Vector3d(1.7, 2.1, -0.4));
  return scene;
}

void run(hg::viewer_server::ViewerServer& server, Door door) {
  using Clock = std::chrono::steady_clock;
  hg::viewer_server::View view;
  view.cycle_time_us = view.cycle_time_max_us = 8.0;
  view.status_text = "simulated at 1000 Hz";
  auto next = Clock::now();
  for (bool was_locked = true; !is_over; was_locked = door.is_locked) {
    server.take_hand_target(view.hand);
    for (const auto& command : server.take_commands()) {
      server.answer(command, "this demonstration follows no commands");
    }
    door.step(view.hand);
    report(door, view.record);
    pose_device(door, view.record);
    view.record.time_s += kPeriod;
    if (server.is_due()) server.publish(view);
    if (was_locked != door.is_locked) {
      server.announce_event(view.record.time_s, door.is_locked ? "locked" : "unlocked",
                            door.is_locked ? "the latch has caught" : "the lever is pressed");
    }
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: viewer_server_demo PAGE DEVICE_URDF DOOR_URDF [PORT]\n";
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { is_over = true; });
  }
  try {
    const Door door;
    hg::viewer_server::ServerOptions options;
    options.page = argv[1];
    if (argc > 4) options.port = static_cast<std::uint16_t>(std::atoi(argv[4]));
    hg::viewer_server::ViewerServer server(options, make_scene(argv[2], argv[3], door));
    std::cout << "page: " << server.url() << std::endl;
    run(server, door);
  } catch (const hg::SetupError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
  return 0;
}
