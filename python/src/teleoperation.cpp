/// Bindings of the benchmark of bilateral control, for methods that are written in Python.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/simulation/hand_schema.h"
#include "hg/config/simulation/teleoperation_schema.h"
#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/teleoperation/grid.h"
#include "python/src/bind.h"

namespace hg::python {
namespace {

using namespace teleoperation;

// The first exception of Python code that a trial has called; rethrown when the trial has ended.
using Thrown = std::shared_ptr<std::exception_ptr>;

// Calls a method of an object; after an exception nothing is called any more.
template <typename Result, typename Call>
Result guarded(const Thrown& thrown, Result otherwise, Call&& call) noexcept {
  if (*thrown) return otherwise;
  try {
    return call();
  } catch (...) {
    *thrown = std::current_exception();
    return otherwise;
  }
}

PortVector one(double value) { return PortVector::Constant(1, value); }

// What a half sees of its own side. Trials have one coordinate.
struct Port {
  double x = 0.0, v = 0.0, f = 0.0, x_target = 0.0, taken = 0.0, given = 0.0;
};

Port own(const LeaderPort& port) {
  return {port.x[0],           port.v[0], port.f_hand[0], port.x[0], port.energy.taken[0],
          port.energy.given[0]};
}

Port own(const RemotePort& port) {
  return {port.x[0],           port.v[0], port.f[0], port.x_target[0], port.energy.taken[0],
          port.energy.given[0]};
}

template <typename Owner>
class InPython : public Owner {
 public:
  InPython(nb::object object, Thrown thrown)
      : object_(std::move(object)), thrown_(std::move(thrown)) {}

 protected:
  template <typename OwnPort, typename Arrived, typename Packet>
  nb::object call_step(const OwnPort& port, const Arrived& arrived, bool is_new, Packet& packet) {
    return object_.attr("step")(own(port), nb::cast(arrived, nb::rv_policy::copy), is_new,
                                nb::cast(&packet, nb::rv_policy::reference));
  }

  nb::object object_;
  Thrown thrown_;
};

class PythonLeader final : public InPython<LeaderMethod> {
 public:
  using InPython::InPython;
  void start(Eigen::Index /*size*/) noexcept override {
    guarded(thrown_, 0, [&] { return object_.attr("start")(), 0; });
  }
  PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                  LeaderPacket& packet) noexcept override {
    return guarded(thrown_, one(0.0),
                   [&] { return one(nb::cast<double>(call_step(port, arrived, is_new, packet))); });
  }
};

class PythonRemote final : public InPython<RemoteMethod> {
 public:
  using InPython::InPython;
  void start(const PortVector& x) noexcept override {
    guarded(thrown_, 0, [&] { return object_.attr("start")(x[0]), 0; });
  }
  RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                    RemotePacket& packet) noexcept override {
    const RemoteTarget hold = {port.x_target, one(0.0), one(0.0)};
    return guarded(thrown_, hold, [&] {
      const nb::object target = call_step(port, arrived, is_new, packet);
      const auto at = [&](int i) { return one(nb::cast<double>(target[i])); };
      return RemoteTarget{at(0), at(1), at(2)};
    });
  }
};

template <typename E>
E named(const std::string& name, config::Choices<E> choices) {
  std::vector<std::string> names;
  for (const config::Choice<E>& one : choices) {
    if (name == one.name) return one.value;
    names.emplace_back(one.name);
  }
  throw SetupError("must be one of them, got '" + name + "'; the nearest is " +
                   nearest_name(name, names));
}

template <typename E>
std::string name_of(E value, config::Choices<E> choices) {
  for (const config::Choice<E>& one : choices) {
    if (one.value == value) return std::string(one.name);
  }
  return {};
}

// Property of a packet that is one number in trials.
template <auto kField, typename Packet>
void number(nb::class_<Packet>& bound, const char* name, const char* help) {
  bound.def_prop_rw(
      name,
      [](const Packet& packet) {
        const PortVector& value = packet.*kField;
        return value.size() > 0 ? value[0] : 0.0;
      },
      [](Packet& packet, double value) { packet.*kField = one(value); }, help);
}

void bind_packets(nb::module_& module) {
  nb::class_<Port>(module, "Port", "A side of the link at the begin of a period.")
      .def_ro("x", &Port::x, "position, m")
      .def_ro("v", &Port::v, "velocity, m/s")
      .def_ro("f", &Port::f, "force of the hand on the leader, of the wall on the machine, N")
      .def_ro("x_target", &Port::x_target, "target of the machine in the last period, m")
      .def_ro("taken", &Port::taken, "energy that the port has taken so far, J")
      .def_ro("given", &Port::given, "energy that it has given, J");
  nb::class_<LeaderPacket> leader(module, "LeaderPacket", "What the leader sends.");
  leader.def_ro("sent_s", &LeaderPacket::sent_s, "leader's clock, s");
  number<&LeaderPacket::x>(leader, "x", "position for the machine, m");
  number<&LeaderPacket::v>(leader, "v", "its velocity, m/s");
  number<&LeaderPacket::f>(leader, "f", "free for use by the method, as wave and energy");
  number<&LeaderPacket::wave>(leader, "wave", "free for use by the method");
  number<&LeaderPacket::energy>(leader, "energy", "free for use by the method");
  nb::class_<RemotePacket> remote(module, "RemotePacket", "What the remote side sends.");
  remote.def_ro("sent_s", &RemotePacket::sent_s, "remote clock, s");
  remote.def_ro("answered_s", &RemotePacket::answered_s, "sent_s of the packet that it answers, s");
  number<&RemotePacket::x>(remote, "x", "measured position, m");
  number<&RemotePacket::v>(remote, "v", "measured velocity, m/s");
  number<&RemotePacket::x_target>(remote, "x_target", "target of the machine, m");
  number<&RemotePacket::f>(remote, "f", "force of the wall on the machine, N");
  number<&RemotePacket::reflected>(remote, "reflected",
                                   "free for use by the method, as wave and energy");
  number<&RemotePacket::wave>(remote, "wave", "free for use by the method");
  number<&RemotePacket::energy>(remote, "energy", "energy that the port has taken, J, or other");
}

void bind_cases(nb::module_& module) {
  nb::class_<TrialConfig>(module, "TrialConfig", "What a method may know before a trial.")
      .def_ro("dt", &TrialConfig::dt, "period, s")
      .def_ro("body_mass", &TrialConfig::body_mass, "inertia that the hand moves, kg")
      .def_prop_ro("delay_s", [](const TrialConfig& c) { return c.link.delay; })
      .def_prop_ro("machine_mass", [](const TrialConfig& c) { return c.machine.mass; })
      .def_prop_ro("machine_stiffness", [](const TrialConfig& c) { return c.machine.stiffness; })
      .def_prop_ro("machine_damping", [](const TrialConfig& c) { return c.machine.damping; });
  nb::class_<GridCase>(module, "GridCase", "A trial of the grid, and what came of it. SI units.")
      .def_ro("delay", &GridCase::delay)
      .def_ro("jitter", &GridCase::jitter)
      .def_ro("loss", &GridCase::loss)
      .def_ro("wall", &GridCase::wall)
      .def_prop_ro("hand",
                   [](const GridCase& c) {
                     return name_of<person::HandPreset>(c.hand, config::kHandPresets);
                   })
      .def_prop_ro("is_calm", [](const GridCase& c) { return c.result.is_stable; })
      .def_prop_ro("created_W",
                   [](const GridCase& c) { return c.result.created / c.result.duration_s; })
      .def_prop_ro("created_leader_W",
                   [](const GridCase& c) { return c.result.created_leader / c.result.duration_s; })
      .def_prop_ro("first_offset", [](const GridCase& c) { return c.result.first_offset; })
      .def_prop_ro("rest_offset", [](const GridCase& c) { return c.result.rest_offset; })
      .def_prop_ro("rest_force_error", [](const GridCase& c) { return c.result.rest_force_error; })
      .def_prop_ro("position_rms", [](const GridCase& c) { return c.result.position_rms; })
      .def_prop_ro("force_rms", [](const GridCase& c) { return c.result.force_rms; })
      .def_prop_ro("regulation_rms", [](const GridCase& c) { return c.result.regulation_rms; })
      .def_prop_ro("regulation_ratio", &GridCase::regulation_ratio,
                   "error of the wall's force over that of a hand that feels nothing")
      .def_prop_ro("peak_hand", [](const GridCase& c) { return c.result.peak_hand; })
      .def_prop_ro("peak_wall", [](const GridCase& c) { return c.result.peak_wall; })
      .def_ro("peak_ratio", &GridCase::peak_ratio,
              "largest force of the hand over that of position force without delay");
}

std::vector<GridCase> play(const nb::object& leader, const nb::object& remote, Grid grid,
                           const std::vector<std::string>& hands) {
  const Thrown thrown = std::make_shared<std::exception_ptr>();
  grid.methods = {MethodKind::kPositionForce};
  grid.hands.clear();
  for (const std::string& hand : hands)
    grid.hands.push_back(named<person::HandPreset>(hand, config::kHandPresets));
  grid.make_leader = [&](const TrialConfig& config) {
    return std::make_unique<PythonLeader>(leader(config), thrown);
  };
  grid.make_remote = [&](const TrialConfig& config) {
    return std::make_unique<PythonRemote>(remote(config), thrown);
  };
  std::vector<GridCase> cases = play_grid(grid, [&](const GridCase&) {
    if (*thrown) std::rethrow_exception(*thrown);
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  });
  return cases;
}

}  // namespace

void bind_teleoperation(nb::module_& module) {
  bind_packets(module);
  bind_cases(module);
  const Grid grid;
  module.def(
      "play_grid",
      [](const nb::object& leader, const nb::object& remote, std::vector<double> delays,
         std::vector<double> jitters, std::vector<double> losses, std::vector<double> walls,
         const std::vector<std::string>& hands, std::uint64_t seed) {
        Grid chosen;
        chosen.delays = std::move(delays);
        chosen.jitters = std::move(jitters);
        chosen.losses = std::move(losses);
        chosen.walls = std::move(walls);
        chosen.seed = seed;
        return play(leader, remote, std::move(chosen), hands);
      },
      nb::arg("leader"), nb::arg("remote"), nb::arg("delays") = grid.delays,
      nb::arg("jitters") = grid.jitters, nb::arg("losses") = grid.losses,
      nb::arg("walls") = grid.walls,
      nb::arg("hands") = std::vector<std::string>{"relaxed", "normal", "stiff"},
      nb::arg("seed") = grid.seed,
      "Plays the trials of `hapticgiant experiment teleoperation` with a method of yours.\n\n"
      "leader(config) and remote(config) make its halves for a trial:\n"
      "leader.start() and leader.step(port, arrived, is_new, packet) -> force on the leader, N;\n"
      "remote.start(x) and remote.step(port, arrived, is_new, packet) -> (x, v, f), target of the\n"
      "machine's spring and damper and a force that is added. Each is called once per period with\n"
      "the newest packet that has arrived from the other half, and may fill its own. delays and\n"
      "jitters in s, losses as shares, walls in N/m. Returns a GridCase per trial.");
}

}  // namespace hg::python
