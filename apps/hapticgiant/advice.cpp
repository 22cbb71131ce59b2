#include "apps/hapticgiant/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hg/config/file_kind.h"
#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

struct Meaning {
  std::vector<std::string_view> words;
  std::string_view command;
};

const std::array<Meaning, 11>& meanings() {
  static const std::array<Meaning, 11> kAll = {{
      {{"list", "ls", "scenarios", "scenario", "twins", "devices", "models", "examples", "demo"},
       "'hapticgiant run --list' lists scenarios, devices and twins"},
      {{"start", "play", "launch", "go", "begin", "feel", "execute", "exec", "simulation", "sim"},
       "'hapticgiant run' begins a run of the door, 'hapticgiant run --list' names the others"},
      {{"view", "viewer", "open", "show", "page", "gui", "watch", "web"},
       "'hapticgiant run' opens the page of a run, 'hapticgiant replay RECORDING --view' that of a "
       "recording"},
      {{"record", "recordings"}, "'hapticgiant run' records every run, into recordings/"},
      {{"figure", "figures", "graph", "chart", "draw"},
       "'hapticgiant plot RECORDING' draws figures"},
      {{"diff"}, "'hapticgiant compare RECORDING RECORDING' lists differences"},
      {{"validate", "verify", "lint", "datasheet", "info", "inspect"},
       "'hapticgiant check FILE' says what is wrong with files, and prints a datasheet"},
      {{"create", "init", "make", "generate", "import", "convert", "device", "twin"},
       "'hapticgiant new device URDF' and 'hapticgiant new twin URDF' write first files"},
      {{"connect", "calibrate", "calibration"},
       "'hapticgiant commission' makes the first motions of a machine, 'hapticgiant identify' "
       "finds its parameters"},
      {{"ros", "ros1", "ros2"}, "'hapticgiant bridge ros2' shows runs to ROS"},
      {{"csv", "parquet", "hdf5", "rosbag"}, "'hapticgiant export RECORDING' writes tables"},
  }};
  return kAll;
}

std::string meaning_of(const std::string& word) {
  const auto found = std::ranges::find_if(meanings(), [&](const Meaning& meaning) {
    return std::ranges::find(meaning.words, word) != meaning.words.end();
  });
  return found == meanings().end() ? ""
                                   : fmt::format("{}: no such command; {}", word, found->command);
}

std::string advice_of_yaml(const std::string& file) {
  config::SourceReader reader;
  const config::FileKind kind = config::kind_of(file, reader);
  const std::string is = fmt::format("{}: is a {} file; 'hapticgiant ", file, to_string(kind));
  switch (kind) {
    case config::FileKind::kScenario:
      return fmt::format("{}run {}' runs it", is, file);
    case config::FileKind::kDevice:
      return fmt::format("{0}run --device {1}' runs it, 'hapticgiant check {1}' checks it", is,
                         file);
    case config::FileKind::kTwin:
      return fmt::format("{0}run --twin {1}' runs it, 'hapticgiant check {1}' checks it", is, file);
    case config::FileKind::kScript:
      return fmt::format("{}run --user {}' plays it", is, file);
    case config::FileKind::kTool:
    case config::FileKind::kSimulation:
    case config::FileKind::kMachine:
      return fmt::format("{}check {}' checks it", is, file);
  }
  return "";
}

// What a file is for, by its kind; empty: unknown.
std::string advice_of_file(const std::string& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";
  const fs::path ending = fs::path(file).extension();
  if (ending == ".mcap") {
    return fmt::format("{0}: is a recording; 'hapticgiant replay {0} --view' shows it", file);
  }
  if (ending == ".urdf") {
    return fmt::format(
        "{0}: is a URDF; 'hapticgiant new device {0}' makes a device of it, 'hapticgiant new twin "
        "{0}' a twin",
        file);
  }
  try {
    return ending == ".yaml" ? advice_of_yaml(file) : "";
  } catch (const SetupError&) {
    return "";
  }
}

// A file, or the name of a shipped scenario, also misspelt.
std::string advice_of_name(const std::string& word) {
  if (std::string of_file = advice_of_file(word); !of_file.empty()) return of_file;
  std::vector<std::string> names;
  for (const config::ShippedFile& shipped : config::shipped_scenarios())
    names.push_back(shipped.name);
  const bool is_one = std::ranges::find(names, word) != names.end();
  const std::string near = is_one ? word : misspelt_name(word, names);
  if (near.empty()) return "";
  if (is_one) return fmt::format("{0}: is a scenario; 'hapticgiant run {0}' runs it", word);
  return fmt::format("{}: no such command or scenario, did you mean 'hapticgiant run {}'?", word,
                     near);
}

}  // namespace

Advices advices() {
  return {.meanings = meaning_of, .others = [](const std::string& word) -> std::string {
            try {
              return advice_of_name(word);
            } catch (const SetupError&) {  // no models are installed
              return "";
            }
          }};
}

void add_help(Command app) {
  const auto command = std::make_shared<std::string>();
  const std::vector<std::string> names = app.subcommand_names();
  const Command help = app.add_subcommand("help", "Describes a command: help run, help new twin.");
  help.add_option("command", *command, "the command; without: all of them").suggest([names] {
    return names;
  });
  help.callback([command] {});  // keeps the word while the line is parsed
}

}  // namespace hg::apps
