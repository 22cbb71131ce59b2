/// The program `hapticgiant-design`: searches for a device that serves a person's arm, and writes
/// its files. `hapticgiant design` starts it.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/design/optimiser.h"
#include "apps/design/results.h"
#include "hg/core/error.h"
#include "hg/design/design_problem.h"

namespace {

namespace fs = std::filesystem;
using namespace hg;
using nlohmann::ordered_json;

constexpr int kInternalError = 1, kBadInput = 2;
constexpr double kPenalty = 10.0;    // of a violation of 1, in units of capability
constexpr double kNearFront = 0.01;  // of capability at the same burden

struct Arguments {
  std::string problem, out;
  int seed = -1;
  unsigned workers = 2;
  bool is_quick = false;
};

double burden_of(const design::DesignProblem& problem, const design::DesignScore& score) {
  return problem.burden == design::Burden::kMovingMass ? score.moving_mass : score.price;
}

void show_progress(const char* what, double share) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{:<30} {:3.0f} %", what, 100.0 * share);
  if (share >= 1.0) fmt::print(stderr, "\n");
}

std::string text_of(const design::DesignScore& score) {
  return fmt::format(
      "capability {:.3f}, {:.1f} kg, price {:.0f}, {:.0f} N, {:.1f} Nm, clear {:.0f} %",
      score.capability, score.moving_mass, score.price, score.metrics.force.low,
      score.metrics.torque.low, 100.0 * score.clear_share);
}

// The reference among the points of the front: what the best point of no more burden has over it.
ordered_json against_front(const design::DesignProblem& problem,
                           const design::DesignScore& reference,
                           const std::vector<design::DesignScore>& points) {
  const design::DesignScore* best = nullptr;
  for (const design::DesignScore& point : points) {
    if (point.violation > 0.0 || burden_of(problem, point) > burden_of(problem, reference))
      continue;
    if (best == nullptr || point.capability > best->capability) best = &point;
  }
  if (best == nullptr)
    return {{"is_near", true}, {"why", "no design of the front has so little burden"}};
  const double ahead = best->capability - reference.capability;
  ordered_json json = {{"is_near", ahead <= kNearFront}, {"capability_ahead", ahead}};
  json["front_point"] = search::to_json(*best);
  double sum = 0.0;
  for (double weight : problem.weights) sum += weight;
  for (std::size_t i = 0; i < design::kTerms.size(); ++i) {
    json["by_term"][design::kTerms[i]] =
        problem.weights[i] / sum * (best->terms[i] - reference.terms[i]);
  }
  return json;
}

design::DesignProblem read_problem(const Arguments& arguments) {
  design::DesignProblem problem = design::load_problem(arguments.problem);
  if (arguments.seed >= 0) problem.search.seed = arguments.seed;
  if (arguments.is_quick) {
    problem.search.population = 16;
    problem.search.generations = 20;
    problem.search.poses = 150;
  }
  return problem;
}

struct Found {
  search::Best best;                      // of the search for capability alone
  std::vector<search::FrontPoint> front;  // of the search for capability and little burden
  double seconds = 0.0;
};

Found find(const design::DesignProblem& problem, const design::Judge& judge,
           const design::DesignScore& reference, unsigned workers) {
  const auto violated = [](const design::DesignScore& score) { return kPenalty * score.violation; };
  search::Problem single = {.lower = design::lower_point(problem),
                            .upper = design::upper_point(problem),
                            .integers = 2 * design::kDesignJoints};
  single.evaluate = [&](const search::Point& x) -> std::vector<double> {
    const design::DesignScore score = judge(design::to_variables(problem, x));
    return {violated(score) - score.capability};
  };
  search::Problem both = single;
  both.objectives = 2;
  const double scale = burden_of(problem, reference);
  both.evaluate = [&](const search::Point& x) -> std::vector<double> {
    const design::DesignScore score = judge(design::to_variables(problem, x));
    return {violated(score) - score.capability,
            violated(score) + burden_of(problem, score) / scale};
  };
  search::Options options = {.population = static_cast<unsigned>(problem.search.population),
                             .generations = static_cast<unsigned>(problem.search.generations),
                             .islands = static_cast<unsigned>(problem.search.islands),
                             .workers = workers,
                             .seed = static_cast<std::uint64_t>(problem.search.seed)};
  using search::Algorithm;
  const auto start = std::chrono::steady_clock::now();
  options.progress = [](double share) { show_progress("one objective", share); };
  Found found;
  found.best = search::minimise(single, {Algorithm::kGenetic, Algorithm::kAntColony}, options);
  options.progress = [](double share) { show_progress("front", share); };
  options.start = {found.best.x};  // the end of the front where only the capability counts
  found.front = search::front(both, options);
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return found;
}

// The best design of both searches, and the designs of the front.
struct Choice {
  design::DesignVariables variables;
  std::string by;                           // algorithm
  std::vector<design::DesignScore> points;  // of all points of the front
  ordered_json front = ordered_json::array();
};

Choice choose(const design::DesignProblem& problem, const design::Judge& judge,
              const Found& found) {
  Choice choice = {.variables = design::to_variables(problem, found.best.x),
                   .by = found.best.algorithm};
  double value = found.best.value;
  for (const search::FrontPoint& it : found.front) {
    const design::DesignVariables variables = design::to_variables(problem, it.x);
    choice.points.push_back(judge(variables));
    if (choice.points.back().violation > 0.0) continue;
    choice.front.push_back({{"variables", search::to_json(problem, variables)},
                            {"score", search::to_json(choice.points.back())}});
    if (it.values[0] >= value) continue;
    choice.variables = variables;
    value = it.values[0];
    choice.by = "nsga2";
  }
  return choice;
}

ordered_json settings_json(const design::DesignProblem& problem, const Arguments& arguments,
                           double seconds, const std::string& by) {
  ordered_json json = {
      {"kind", "design"},
      {"name", problem.name},
      {"problem", arguments.problem},
      {"seed", problem.search.seed},
      {"poses", problem.search.poses},
      {"population", problem.search.population},
      {"generations", problem.search.generations},
      {"islands", problem.search.islands},
      {"seconds", seconds},
      {"burden", problem.burden == design::Burden::kMovingMass ? "moving_mass_kg" : "price"},
      {"found_by", by}};
  json["requirements"] = {{"force_N", problem.requirements.force},
                          {"torque_Nm", problem.requirements.torque},
                          {"moving_mass_kg", problem.requirements.moving_mass},
                          {"price", problem.requirements.price},
                          {"clear_share", problem.requirements.clear_share},
                          {"clearance_m", problem.requirements.clearance},
                          {"walk_m2", problem.requirements.walk_area}};
  return json;
}

void print_design(const design::DesignProblem& problem, const design::DesignScore& score,
                  const Choice& choice, double seconds) {
  fmt::print("design      {}\n", text_of(score));
  fmt::print("found by    {} in {:.0f} s, seed {}; front of {} designs\n", choice.by, seconds,
             problem.search.seed, choice.front.size());
  if (!score.fault.empty()) throw SetupError("no candidate is a device: " + score.fault);
  if (score.violation > 0.0) {
    fmt::print("warning     no candidate meets all requirements: widen bounds or catalogue\n");
  }
}

void run(const Arguments& arguments) {
  const design::DesignProblem problem = read_problem(arguments);
  const fs::path out = arguments.out;
  std::error_code error;
  fs::create_directories(out / "device", error);
  if (error) throw SetupError(fmt::format("--out {}: {}", arguments.out, error.message()));

  const design::Judge judge(problem);
  const design::DesignScore reference = judge(problem.base.variables);
  fmt::print("base        {}\n", text_of(reference));
  std::fflush(stdout);
  const Found found = find(problem, judge, reference, arguments.workers);
  const Choice choice = choose(problem, judge, found);
  const design::Judge looker(problem, true);  // keeps the poses for the maps
  const design::DesignScore score = looker(choice.variables);
  print_design(problem, score, choice, found.seconds);
  design::make_device(problem.base, problem.catalogue, choice.variables, problem.name,
                      problem.prices)
      .files.write(out / "device");

  ordered_json json = settings_json(problem, arguments, found.seconds, choice.by);
  json["chosen"] = {{"variables", search::to_json(problem, choice.variables)},
                    {"score", search::to_json(score)}};
  json["base"] = {{"name", problem.base.device.name},
                  {"variables", search::to_json(problem, problem.base.variables)},
                  {"score", search::to_json(reference)},
                  {"against_front", against_front(problem, reference, choice.points)}};
  json["front"] = choice.front;
  for (const search::Progress& it : found.best.progress) {
    json["convergence"].push_back({{"algorithm", it.algorithm},
                                   {"island", it.island},
                                   {"evaluations", it.evaluations},
                                   {"value", -it.best}});
  }
  json["sensitivity"] = search::sensitivity(problem, judge, choice.variables);
  json["coverage"] = {
      {"columns", {"x_m", "y_m", "z_m", "weight", "reached", "velocity", "acceleration"}},
      {"chosen", search::coverage(looker, score)},
      {"base", search::coverage(looker, looker(problem.base.variables))}};
  std::ofstream file(out / "results.json");
  file << json.dump(1) << "\n";
  file.close();
  if (!file) throw SetupError((out / "results.json").generic_string() + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  apps::Program program("Searches for a device that serves a person's arm (docs/start/design.md).",
                        "hapticgiant-design");
  const apps::Command command = program.command();
  command.add_option("problem", arguments.problem, "design problem, a YAML file").required();
  command.add_option("-o,--out", arguments.out, "folder of the design").required();
  command.add_option("--seed", arguments.seed, "0 to 1000000000, in place of the file's")
      .check(apps::whole_number(0, 1000000000));
  command
      .add_option("--workers", arguments.workers,
                  "threads, 1 to 256; the result does not depend on them")
      .check(apps::whole_number(1, 256))
      .capture_default_str();
  command.add_flag("--quick", arguments.is_quick, "small populations and few poses: a look");
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    run(arguments);
    return 0;
  } catch (const SetupError& error) {
    apps::print_error("{}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    apps::print_error("internal error: {}\n", error.what());
    return kInternalError;
  }
}
