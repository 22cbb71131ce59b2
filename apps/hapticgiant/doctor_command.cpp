#include "apps/hapticgiant/doctor_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/version.h"
#include "hg/analysis/timing.h"
#include "hg/doctor/assessment.h"
#include "hg/doctor/jitter.h"

namespace hg::apps {
namespace {

using doctor::Assessment;
using doctor::Jitter;
using doctor::Readiness;

constexpr double kRates_Hz[] = {1000.0, 10000.0};

/// Measurements at one rate.
struct Measured {
  Jitter ordinary, real_time;
};

void print(const Assessment& line) {
  print_out(
      fmt::format("  {:<5} {:<11} {}\n", doctor::to_string(line.level), line.item, line.found));
  if (!line.fix.empty()) print_out(fmt::format("  {:<17} -> {}\n", "", line.fix));
}

nlohmann::ordered_json to_json(const std::vector<Assessment>& lines,
                               const std::vector<Measured>& measured) {
  nlohmann::ordered_json json;
  json["version"] = kVersion;
  json["exit_code"] = doctor::exit_code(lines);
  for (const Assessment& line : lines) {
    json["lines"].push_back({{"level", doctor::to_string(line.level)},
                             {"item", line.item},
                             {"found", line.found},
                             {"fix", line.fix}});
  }
  for (const Measured& pair : measured) {
    for (const Jitter* jitter : {&pair.ordinary, &pair.real_time}) {
      json["jitter"].push_back({{"rate_Hz", jitter->rate_Hz},
                                {"priority", jitter->thread.priority},
                                {"late_us", analysis::to_json(jitter->wake_up_us)}});
    }
  }
  return json;
}

}  // namespace

int doctor(const DoctorArguments& arguments) {
  check_writable(arguments.json, kJson);
  runtime::check_thread_options({.priority = arguments.priority, .cpu = arguments.cpu});
  print_out(
      fmt::format("HapticGiant {}: is this computer ready for a control loop?\n\n", kVersion));
  std::vector<Assessment> lines = doctor::assess_computer();
  for (const Assessment& line : lines) print(line);

  print_out(
      fmt::format("\nhow late threads wake up, measured for {:.0f} s:\n", 4.0 * arguments.seconds));
  const auto measure = [&](double rate_Hz, int priority) {
    return doctor::measure_jitter(rate_Hz, arguments.seconds,
                                  {.priority = priority, .cpu = arguments.cpu});
  };
  // all ordinary threads first: the others lock the memory
  std::vector<Measured> measured;
  for (const double rate_Hz : kRates_Hz) measured.push_back({.ordinary = measure(rate_Hz, 0)});
  for (Measured& pair : measured) {
    const double rate_Hz = pair.ordinary.rate_Hz;
    pair.real_time = measure(rate_Hz, arguments.priority);
    // 1 kHz is what devices need; faster is a choice
    lines.push_back(doctor::assess(pair.ordinary, pair.real_time, rate_Hz == kRates_Hz[0]));
    print(lines.back());
  }

  const auto count = [&](Readiness level) {
    return std::ranges::count_if(lines,
                                 [=](const Assessment& line) { return line.level == level; });
  };
  print_out(fmt::format("\n{} ok, {} to look at, {} bad: {}\n", count(Readiness::kOk),
                        count(Readiness::kWarn), count(Readiness::kBad),
                        count(Readiness::kBad) > 0
                            ? "simulate here, but do not drive a device from here"
                            : (count(Readiness::kWarn) > 0 ? "a device can be driven, see above"
                                                           : "a device can be driven")));
  if (!arguments.json.empty()) {
    write_output(arguments.json, to_json(lines, measured).dump(2) + "\n");
  }
  return doctor::exit_code(lines);
}

void add_doctor(Command app, int& exit_code) {
  const auto arguments = std::make_shared<DoctorArguments>();
  const Command command = app.add_subcommand(
      "doctor", "How ready this computer is for a control loop, and what to change.");
  command.footer(
      "Examples:\n"
      "  hapticgiant doctor                       a quarter of a minute\n"
      "  hapticgiant doctor --seconds 600 --cpu 3 --json doctor.json");
  command.add_option("--seconds", arguments->seconds, "of each of the four measurements")
      .check(number_that("from 0.1 to 100000", [](double v) { return v >= 0.1 && v <= 1e5; }))
      .capture_default_str();
  command.add_option("--priority", arguments->priority, "as in run")
      .check(number_that("from 1 to 99", [](double v) { return v >= 1.0 && v <= 99.0; }))
      .capture_default_str();
  command.add_option("--cpu", arguments->cpu, "as in run").check(at_least(0));
  command.add_option("--json", arguments->json, "write everything as JSON to this file");
  command.callback([arguments, &exit_code] { exit_code = doctor(*arguments); });
}

}  // namespace hg::apps
