#include "hg/experiments/process_faults.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/core/scratch_folder.h"
#include "hg/device/udp/device_server.h"
#include "hg/experiments/fault_campaign.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/remote_setup.h"

extern char** environ;

namespace hg::experiments {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr auto kUntilRunning = std::chrono::seconds(60);
constexpr auto kUntilEnded = std::chrono::seconds(30);
constexpr auto kFaultToStop = milliseconds(300);
constexpr auto kFrozen = std::chrono::seconds(1);
constexpr double kWatchedAfter_s =
    1.0;  // after the session: the device continues without a program
constexpr std::uint64_t kUnwritten = 1000;  // samples that a recording may lack at its end

struct Description {
  ProcessFault fault;
  std::string_view name, what;
  bool may_die = false;      ///< the controller may end by a signal
  bool is_recorded = true;   ///< the recording is complete except for its end
  bool is_reported = false;  ///< reported by an exit code other than 0
  bool is_stop = false;      ///< the device has to stop on its own: no more commands arrive
};

constexpr auto kDescriptions = std::to_array<Description>({
    {ProcessFault::kNone, "none", "only the stop"},
    {ProcessFault::kTerminalStalled, "terminal_stalled", "its output is not read"},
    {ProcessFault::kTerminalClosed, "terminal_closed", "what it prints has no reader"},
    {ProcessFault::kDiskFull, "disk_full", "no file may grow", false, false, true},
    {ProcessFault::kFolderGone, "folder_gone", "its recording is deleted", false, false, true},
    {ProcessFault::kNoDescriptors, "no_descriptors", "it may open nothing more"},
    {ProcessFault::kNoMemory, "no_memory", "it gets no more memory", true, false},
    {ProcessFault::kBusy, "processors_busy", "others take all processors", false, false},
    {ProcessFault::kFrozen, "frozen", "it is suspended for a second", false, true, false, true},
    {ProcessFault::kSuspended, "suspended", "it is suspended for good", true, true, false, true},
    {ProcessFault::kKilled, "killed", "kill -9", true, true, false, true},
});

const Description& description_of(ProcessFault fault) {
  return *std::ranges::find(kDescriptions, fault, &Description::fault);
}

// The simulated device, and the true motion of its axes from a given moment on. Written by the
// thread that serves it; the atomics are for other threads, the rest is read when that thread has
// ended.
class Witness final : public device::Device {
 public:
  explicit Witness(const config::Scenario& scenario)
      : device_(scenario::make_simulated_device(scenario)), scenario_(scenario) {}

  void read(SensorFrame& sensors) noexcept override { device_->read(sensors); }
  void write(const CommandFrame& command) noexcept override {
    device_->write(command);
    periods.fetch_add(1, std::memory_order_relaxed);
    is_on.store(command.enable, std::memory_order_relaxed);
    if (is_watched.load(std::memory_order_relaxed)) watch(*device_->truth());
  }

  void watch(const Truth& truth) noexcept {
    const safety::MonitorConfig& stated = scenario_.device.monitor;
    const DeviceModel& device = scenario_.device.model;
    const double dt = scenario_.device.model.dt();
    if (from_m_.size() == 0) {
      from_m_ = truth.q_m;
      from_p_ = truth.q_p;
    }
    for (Eigen::Index i = 0; i < from_m_.size(); ++i) {
      look(truth.q_m[i] - from_m_[i],
           stated.stop_distance_of_joint(device.is_slide(static_cast<int>(i))));
    }
    for (Eigen::Index i = 0; i < from_p_.size(); ++i) {
      look(truth.q_p[i] - from_p_[i], stated.stop_distance_of_gantry(device.is_gantry_slide()));
    }
    energy_ -= dt * truth.w_H.dot(truth.twist);
    most_energy = std::max(most_energy, energy_);
    watched_s_ += dt;
    if (!stands_still(truth)) {
      rest_s = std::numeric_limits<double>::quiet_NaN();
    } else if (std::isnan(rest_s)) {
      rest_s = watched_s_;
    }
  }

  std::atomic<std::uint64_t> periods{0};
  std::atomic<bool> is_on{false};       ///< drives are commanded on
  std::atomic<bool> is_watched{false};  ///< motion is evaluated, from the stop on
  double share = 0.0, most_energy = 0.0;
  double rest_s = std::numeric_limits<double>::quiet_NaN();

 private:
  void look(double way, double stated) noexcept { share = std::max(share, std::abs(way) / stated); }

  std::unique_ptr<device::Device> device_;
  const config::Scenario& scenario_;
  VectorM from_m_;
  VectorP from_p_;
  double energy_ = 0.0, watched_s_ = 0.0;
};

// Serves the device to one controller, and lets it continue on its own afterwards.
void serve(udp::DeviceServer& server, Witness& witness, double dt, const std::atomic<bool>& stop) {
  if (!server.wait_for_client(stop)) return;
  server.serve(witness, stop);
  SensorFrame sensors;
  for (double t = 0.0; t < kWatchedAfter_s; t += dt) {
    witness.read(sensors);
    witness.write({});
  }
}

// Program and terminal of a controller.
class Controller {
 public:
  Controller(const std::string& program, const std::string& scenario, const std::string& address,
             const std::string& folder) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw SetupError("no pipe for the controller");
    terminal_ = ends[0];
    program_end_ = ends[1];
    std::vector<std::string> words = {
        "hapticgiant", "run",    scenario, "--device-address", address,      "--recordings",
        folder,        "--port", "0",      "--no-browser",     "--priority", "0"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, program_end_, 1);
    posix_spawn_file_actions_adddup2(&actions, program_end_, 2);
    const int failed =
        posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw SetupError("the controller cannot be started");
    reader_ = std::thread([this] { read(); });
  }

  ~Controller() {
    if (!has_ended()) send(SIGKILL);
    while (!has_ended()) std::this_thread::sleep_for(milliseconds(5));
    is_read_ = false;
    reader_.join();
    if (terminal_ >= 0) close(terminal_);
    if (program_end_ >= 0) close(program_end_);
  }
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  void send(int signal) const { kill(pid_, signal); }

  void limit(__rlimit_resource what) const {
    const rlimit none = {0, 0};
    prlimit(pid_, what, &none, nullptr);
  }

  // Stops reading and fills the pipe.
  void stall() {
    stop_reading();
    const int other = open(fmt::format("/proc/self/fd/{}", program_end_).c_str(),
                           O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    const std::array<char, 4096> text{};
    while (write(other, text.data(), text.size()) > 0) continue;
    while (write(other, text.data(), 1) > 0) continue;
    close(other);
  }

  void hang_up() {
    stop_reading();
    close(terminal_);
    terminal_ = -1;
  }

  bool has_ended() {
    if (!has_ended_) has_ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return has_ended_;
  }
  int exit_code() const { return has_ended_ && WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }

 private:
  void stop_reading() {
    is_read_ = false;
    reader_.join();
    reader_ = std::thread([] {});
  }
  void read() {
    std::array<char, 4096> text{};
    fcntl(terminal_, F_SETFL, O_NONBLOCK);
    while (is_read_) {
      if (::read(terminal_, text.data(), text.size()) <= 0) {
        std::this_thread::sleep_for(milliseconds(5));
      }
    }
  }

  int terminal_ = -1, program_end_ = -1;
  pid_t pid_ = 0;
  int status_ = 0;
  bool has_ended_ = false;
  std::atomic<bool> is_read_{true};
  std::thread reader_;
};

// Threads that occupy the processors.
class Load {
 public:
  void begin() {
    for (unsigned i = 0; i < 4 * std::max(1U, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([this] {
        while (is_busy_.load(std::memory_order_relaxed)) continue;
      });
    }
  }
  ~Load() {
    is_busy_ = false;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> is_busy_{true};
  std::vector<std::thread> threads_;
};

void apply(ProcessFault fault, Controller& controller, const std::string& folder, Load& load) {
  switch (fault) {
    case ProcessFault::kNone:
      return;
    case ProcessFault::kTerminalStalled:
      return controller.stall();
    case ProcessFault::kTerminalClosed:
      return controller.hang_up();
    case ProcessFault::kDiskFull:
      return controller.limit(RLIMIT_FSIZE);
    case ProcessFault::kFolderGone: {
      std::error_code error;  // something may be written there just now: then once more
      for (int k = 0; k < 3; ++k) std::filesystem::remove_all(folder, error);
      return;
    }
    case ProcessFault::kNoDescriptors:
      return controller.limit(RLIMIT_NOFILE);
    case ProcessFault::kNoMemory:
      return controller.limit(RLIMIT_AS);
    case ProcessFault::kBusy:
      return load.begin();
    case ProcessFault::kFrozen:
    case ProcessFault::kSuspended:
      return controller.send(SIGSTOP);
    case ProcessFault::kKilled:
      return controller.send(SIGKILL);
  }
}

bool wait_for(std::chrono::seconds longest, const auto& is_so) {
  const Clock::time_point end = Clock::now() + longest;
  while (!is_so()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return true;
}

class SampleCounter final : public recording::RecordingListener {
 public:
  void configuration(const recording::NamedText& /*text*/) override {}
  void event(const recording::Event& /*event*/) override {}
  void sample(const Sample& /*sample*/) override { ++count; }
  std::uint64_t count = 0;
};

std::uint64_t samples_in(const std::filesystem::path& folder) {
  std::uint64_t most = 0;  // beside it lie the last seconds of a fault
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_symlink() || entry.path().extension() != ".mcap") continue;
    SampleCounter counter;
    try {
      recording::read_recording(entry.path(), counter);
    } catch (const SetupError&) {
      // counted as far as it was read
    }
    most = std::max(most, counter.count);
  }
  return most;
}

bool has_done_well(const ProcessCase& result) {
  const Description& expected = description_of(result.fault);
  return result.has_run && !std::isnan(result.rest_s) && result.travel_share <= 1.0 &&
         result.energy <= CampaignConfig{}.energy_bound &&
         (expected.may_die || (result.has_ended && result.exit_code >= 0)) &&
         (!expected.is_reported || result.exit_code != 0) &&
         (!expected.is_recorded || result.recorded + kUnwritten >= result.periods);
}

// Sets a flag at the end of a scope, however it is left.
class GivesUp {
 public:
  explicit GivesUp(std::atomic<bool>& flag) : flag_(flag) {}
  ~GivesUp() { flag_ = true; }
  GivesUp(const GivesUp&) = delete;
  GivesUp& operator=(const GivesUp&) = delete;

 private:
  std::atomic<bool>& flag_;
};

ProcessCase play(const std::string& program, const std::string& name, ProcessFault fault,
                 Random& random) {
  ProcessCase result = {.fault = fault, .scenario = name};
  const config::Scenario scenario = config::load_scenario(config::find_scenario(name));
  const Interval times = fault_times(scenario);
  const double at_s = random.between(times.lb, times.ub);
  const double dt = scenario.device.model.dt();
  const ScratchFolder scratch;
  const std::string folder = scratch.path() + "/recordings";

  udp::DeviceServer server(udp::parse_address("--listen", "127.0.0.1:0"),
                           {.actual = scenario::describe(scenario, false),
                            .server = "hapticgiant faults",
                            .is_simulated = true});
  Witness witness(scenario);
  std::atomic<bool> gives_up{false}, has_served{false};
  {
    const std::jthread device([&] {
      serve(server, witness, dt, gives_up);
      has_served = true;
    });
    const GivesUp at_last(gives_up);
    Load load;
    Controller controller(program, name, server.address(), folder);
    result.has_run =
        wait_for(kUntilRunning,
                 [&] {
                   return controller.has_ended() ||
                          (witness.is_on && static_cast<double>(witness.periods) * dt > at_s);
                 }) &&
        !controller.has_ended();
    const bool is_stop = description_of(fault).is_stop;
    if (is_stop) witness.is_watched = true;
    apply(fault, controller, folder, load);
    if (fault == ProcessFault::kFrozen) {
      std::this_thread::sleep_for(kFrozen);
      controller.send(SIGCONT);
    } else if (!is_stop) {
      std::this_thread::sleep_for(kFaultToStop);
      witness.is_watched = true;
    }
    result.periods = witness.periods;
    controller.send(SIGTERM);
    const auto has_ended = [&] { return has_served && controller.has_ended(); };
    const bool ends = fault != ProcessFault::kSuspended;
    result.has_ended = ends ? wait_for(kUntilEnded, has_ended)
                            : wait_for(kUntilEnded, [&] { return has_served.load(); });
    result.exit_code = controller.exit_code();
  }
  result.rest_s = witness.rest_s;
  result.travel_share = witness.share;
  result.energy = witness.most_energy;
  result.recorded = samples_in(folder);
  result.is_good = has_done_well(result);
  return result;
}

}  // namespace

std::vector<ProcessCase> play_process_faults(const std::string& program,
                                             const std::vector<std::string>& scenarios,
                                             int repetitions, std::uint64_t seed) {
  std::vector<ProcessCase> cases;
  Random random(seed);
  for (int k = 0; k < repetitions; ++k) {
    for (const Description& description : kDescriptions) {
      const std::string& scenario = scenarios[cases.size() % scenarios.size()];
      ProcessCase result;
      // a computer that is busy with other things may stop the run before its fault begins
      for (int tries = 0; tries < 3 && !result.has_run; ++tries) {
        result = play(program, scenario, description.fault, random);
      }
      cases.push_back(std::move(result));
    }
  }
  return cases;
}

nlohmann::ordered_json to_json(const std::vector<ProcessCase>& cases) {
  nlohmann::ordered_json json = {{"kind", "process_faults"},
                                 {"passed", std::ranges::all_of(cases, &ProcessCase::is_good)}};
  for (const ProcessCase& result : cases) {
    const Description& expected = description_of(result.fault);
    json["cases"].push_back({{"fault", expected.name},
                             {"what", expected.what},
                             {"scenario", result.scenario},
                             {"passed", result.is_good},
                             {"has_run", result.has_run},
                             {"at_rest_after_s", result.rest_s},
                             {"travel_share", result.travel_share},
                             {"energy_J", result.energy},
                             {"has_ended", result.has_ended},
                             {"exit_code", result.exit_code},
                             {"periods", result.periods},
                             {"recorded", result.recorded}});
  }
  return json;
}

}  // namespace hg::experiments
