#include "python/src/play/remote.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "hg/core/error.h"
#include "hg/teleoperation/remote_udp/remote_server.h"

namespace nb = nanobind;

namespace hg::python {
namespace {

using namespace teleoperation;
using Numbers = std::vector<double>;

PortVector vector_of(const Numbers& numbers, Eigen::Index size) {
  if (static_cast<Eigen::Index>(numbers.size()) != size) {
    throw SetupError("expected " + std::to_string(size) + " numbers, got " +
                     std::to_string(numbers.size()));
  }
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), size);
}

Numbers list_of(const PortVector& v) { return {v.data(), v.data() + v.size()}; }

/// RemoteServer with lists, and errors as SetupError of the package.
class Remote {
 public:
  Remote(const std::string& address, const Numbers& lowest, const Numbers& highest, double mass,
         double stiffness, double damping, double speed, double acceleration, double force,
         double rate_Hz, bool is_lock_step, const std::string& coordinates,
         const std::string& key_file, const std::string& server) {
    const auto size = static_cast<Eigen::Index>(lowest.size());
    RemoteServerConfig config = {.description = {.coordinates = coordinates,
                                                 .size = static_cast<int>(size),
                                                 .rate_Hz = rate_Hz,
                                                 .is_lock_step = is_lock_step},
                                 .impedance = {mass, stiffness, damping},
                                 .server = server};
    const PortVector end = vector_of(highest, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      config.limiter.axes.push_back(
          {.range = {lowest[i], end[i]}, .v_max = speed, .a_max = acceleration, .f_max = force});
    }
    if (!key_file.empty()) config.key = udp::Key::from_file(key_file);
    server_.emplace(udp::parse_address("address", address), config);
    size_ = size;
  }

  std::optional<std::tuple<Numbers, Numbers, Numbers>> step(const Numbers& x, const Numbers& v,
                                                            const Numbers& f) {
    const MachineState state = {vector_of(x, size_), vector_of(v, size_), vector_of(f, size_)};
    const nb::gil_scoped_release no_gil;
    if (!server_->step(state, target_)) return {};
    return std::tuple(list_of(target_.x), list_of(target_.v), list_of(target_.f));
  }
  std::string address() const { return server_->address(); }
  std::string news() { return server_->news(); }
  bool has_leader() const { return server_->has_leader(); }
  bool follows() const {
    const RemoteCause cause = server_->cause();
    return !holds(cause) && cause != RemoteCause::kReleased;
  }

 private:
  Eigen::Index size_ = 0;
  std::optional<RemoteServer> server_;
  RemoteTarget target_;
};

}  // namespace

void bind_remote(nb::module_& module) {
  nb::register_exception_translator([](const std::exception_ptr& error, void*) {
    try {
      std::rethrow_exception(error);
    } catch (const SetupError& setup) {
      const nb::object type = nb::module_::import_("hapticgiant._core").attr("SetupError");
      PyErr_SetString(type.ptr(), setup.what());
    }
  });
  nb::class_<Remote>(module, "RemoteServer",
                     "The side of a remote machine: its half of the method of bilateral control, "
                     "its limits and its watchdog, led over a network by one leader at a time. SI "
                     "units.")
      .def(nb::init<const std::string&, const Numbers&, const Numbers&, double, double, double,
                    double, double, double, double, bool, const std::string&, const std::string&,
                    const std::string&>(),
           nb::arg("address"), nb::arg("lowest"), nb::arg("highest"), nb::kw_only(),
           nb::arg("mass"), nb::arg("stiffness"), nb::arg("damping"), nb::arg("speed") = 1.0,
           nb::arg("acceleration") = 20.0, nb::arg("force") = 100.0, nb::arg("rate_Hz") = 1000.0,
           nb::arg("is_lock_step") = false, nb::arg("coordinates") = "tool",
           nb::arg("key_file") = "", nb::arg("server") = "python")
      .def("step", &Remote::step, nb::arg("x"), nb::arg("v"), nb::arg("f"),
           "Target (x, v, f) for the coming period of a machine with measured position, velocity "
           "and force of its surroundings: its own controller follows x and v with stiffness and "
           "damping, and adds f. To be called once per period. None, in lock-step only: no period "
           "of the leader came, the machine must stand still.")
      .def("news", &Remote::news, "What has happened since the last call, in lines.")
      .def_prop_ro("address", &Remote::address, "HOST:PORT that it listens at")
      .def_prop_ro("has_leader", &Remote::has_leader)
      .def_prop_ro("follows", &Remote::follows, "whether the machine is being led");
}

}  // namespace hg::python
