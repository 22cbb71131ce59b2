#include "apps/offline/walking_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/config/schema.h"
#include "hg/core/enumerators.h"
#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/experiments/workers.h"
#include "hg/walking/generated_paths.h"
#include "hg/walking/walk.h"

namespace hg::apps {
namespace {

using walking::RedirectionKind;
using walking::WalkedPath;
using walking::WalkFigures;

struct WalkingArguments {
  std::vector<std::string> paths;    ///< folders of recorded paths
  std::vector<std::string> methods;  ///< empty: all
  int buildings = 50;
  std::uint64_t seed = 1;
  std::vector<double> room = {3.3, 3.9};  ///< m
  double buffer = walking::WalkRoom{}.buffer;
  std::string csv;  ///< file for all walks; empty = none
};

struct PathGroup {
  std::string name;
  std::vector<WalkedPath> paths;
};

constexpr auto kMethods = config::choices_of<RedirectionKind>();

std::vector<RedirectionKind> kinds_of(const std::vector<std::string>& names) {
  std::vector<RedirectionKind> kinds;
  for (const config::Choice<RedirectionKind>& method : kMethods) {
    if (names.empty() || std::ranges::find(names, method.name) != names.end())
      kinds.push_back(method.value);
  }
  return kinds;
}

std::vector<PathGroup> groups_of(const WalkingArguments& arguments) {
  constexpr int kEach = 10;  // paths of a family
  std::vector<PathGroup> groups;
  for (const std::string& folder : arguments.paths)
    groups.push_back({folder, walking::read_walked_paths(folder)});
  Random random(arguments.seed);
  PathGroup buildings = {.name = fmt::format("{} buildings", arguments.buildings)};
  for (int i = 0; i < arguments.buildings; ++i)
    buildings.paths.push_back(walking::make_building(random));
  if (arguments.buildings > 0) groups.push_back(std::move(buildings));
  for (const Enumerator<walking::PathFamily>& family : enumerators<walking::PathFamily>()) {
    PathGroup group = {.name = words_of(family.name)};
    for (int i = 0; i < kEach; ++i) group.paths.push_back(walking::make_path(family.value, random));
    groups.push_back(std::move(group));
  }
  return groups;
}

constexpr const char* kHeader =
    "paths,path,method,length_m,duration_s,resets,clearance_m,bend_median_per_m,bend_95_per_m,"
    "bend_most_per_m,noticed_bend_m,noticed_turn_rad,way_gain_least,way_gain_most,"
    "turn_rate_rad_per_s\n";

std::string row_of(const PathGroup& group, const WalkedPath& path, RedirectionKind kind,
                   const WalkFigures& figures) {
  return fmt::format(
      "{},{},{},{:.2f},{:.2f},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.3f},{:.4f},{:"
      ".4f},{:.4f}\n",
      group.name, path.name, words_of(kind), figures.length, figures.duration, figures.resets,
      figures.clearance, figures.bend_quantile(0.5), figures.bend_quantile(0.95),
      figures.bend_quantile(1.0), figures.bent, figures.twisted, figures.way_gain_least,
      figures.way_gain_most, figures.turn_rate);
}

void print_sum(RedirectionKind kind, const WalkFigures& sum) {
  print_out("  {:20} {:6} {:9.2f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:7.0f} %\n", words_of(kind),
            sum.resets, 100.0 * sum.resets / sum.length, sum.clearance, sum.bend_quantile(0.5),
            sum.bend_quantile(0.95), sum.bend_quantile(1.0), 100.0 * sum.bent / sum.length);
}

int experiment_walking(const WalkingArguments& arguments) {
  const walking::WalkRoom room = {.walls = walking::centered(arguments.room[0], arguments.room[1]),
                                  .buffer = arguments.buffer};
  if (!(room.walls.inset(room.buffer).clearance({0.0, 0.0}) >= 0.3)) {
    throw SetupError(fmt::format("--room {:g},{:g}: too small to walk in with a buffer of {:g} m",
                                 arguments.room[0], arguments.room[1], room.buffer));
  }
  const std::vector<PathGroup> groups = groups_of(arguments);
  const std::vector<RedirectionKind> kinds = kinds_of(arguments.methods);
  std::string csv = kHeader;
  print_out(
      "Walks in a room of {:g} m by {:g} m; who comes within {:g} m of a wall and walks on is\n"
      "stopped and turned\n",
      arguments.room[0], arguments.room[1], room.buffer);
  for (const PathGroup& group : groups) {
    std::vector<WalkFigures> figures(group.paths.size() * kinds.size());
    experiments::do_all(
        figures.size(),
        [&](std::size_t i) {
          const auto redirector = make_redirector(kinds[i % kinds.size()], room);
          figures[i] = walking::walk(group.paths[i / kinds.size()], *redirector, room);
        },
        progress_of("walks"));
    double length = 0.0;
    for (std::size_t p = 0; p < group.paths.size(); ++p) length += figures[p * kinds.size()].length;
    print_out("\n{}: {} paths, {:.2f} km\n", group.name, group.paths.size(), 1e-3 * length);
    print_out("  {:20} {:>6} {:>9} {:>8} {:>26} {:>9}\n", "", "resets", "per 100 m", "wall",
              "curvature 50, 95, 100 %", "noticed");
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      WalkFigures sum;
      for (std::size_t p = 0; p < group.paths.size(); ++p) {
        sum.add(figures[p * kinds.size() + k]);
        csv += row_of(group, group.paths[p], kinds[k], figures[p * kinds.size() + k]);
      }
      print_sum(kinds[k], sum);
    }
  }
  print_out(
      "\nwall: smallest distance of a person from a wall, m. curvature: of the way in the room\n"
      "against that in the target environment, 1/m, below which these shares of the way are.\n"
      "noticed: share of the way with a radius below {:g} m, which people notice.\n",
      walking::kNoticedRadius);
  if (!arguments.csv.empty()) write_output(arguments.csv, csv);
  return 0;
}

}  // namespace

void add_walking(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<WalkingArguments>();
  const Command command = experiment.add_subcommand(
      "walking", "long ways through a small room: motion compression beside other methods");
  command
      .add_option("--paths", arguments->paths,
                  "folder of recorded paths: files with interval_s,x_m,y_m; also .csv.gz")
      .allow_extra_args(false);
  command.add_option("--methods", arguments->methods, "only these, separated by commas")
      .delimiter(',')
      .allow_extra_args(false)
      .one_of(names_of(kMethods));
  command.add_option("--buildings", arguments->buildings, "number of random buildings")
      .check(whole_number(0, 100000))
      .capture_default_str();
  command.add_option("--room", arguments->room, "length,width, m")
      .delimiter(',')
      .allow_extra_args(false)
      .expected(2)
      .check(number_within(0.5, 1e3));
  command
      .add_option("--buffer", arguments->buffer,
                  "from a wall to where a person who walks on is stopped, m")
      .check(number_within(0.0, 10.0))
      .capture_default_str();
  command.add_option("--seed", arguments->seed, "of buildings and families").capture_default_str();
  command.add_option("--csv", arguments->csv, "write all walks to this file");
  command.callback([arguments, &exit_code] { exit_code = experiment_walking(*arguments); });
}

}  // namespace hg::apps
