#include "apps/offline/campaign.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/python_program.h"
#include "hg/core/error.h"
#include "hg/scenario/options.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

experiments::Part part_of(const std::string& text) {
  experiments::Part part;
  const std::size_t slash = text.find('/');
  const auto read = [](std::string_view digits, std::size_t& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  const bool is_read = slash != std::string::npos &&
                       read(std::string_view(text).substr(0, slash), part.index) &&
                       read(std::string_view(text).substr(slash + 1), part.count);
  if (is_read && 1 <= part.index && part.index <= part.count) return part;
  throw SetupError(fmt::format("--part: expected I/N with I from 1 to N, got '{}'", text));
}

// The results that the manifests of a sweep have, by number.
std::map<std::size_t, json> results_in(const fs::path& folder) {
  std::map<std::size_t, json> results;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("manifest") || entry.path().extension() != ".jsonl") continue;
    std::ifstream lines(entry.path());
    for (std::string line; std::getline(lines, line);) {
      const json record = json::parse(line, nullptr, false);
      if (!record.is_object() || !record.contains("results")) continue;
      for (const auto& [number, result] : record["results"].items()) {
        results[std::stoul(number)] = result;
      }
    }
  }
  return results;
}

// A folder may have a sweep of another kind, written by hand.
void refuse_other_sweep(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  std::ifstream text(file);
  const json sweep = json::parse(text, nullptr, false);
  if (sweep.is_object() && sweep.contains("command") && sweep.contains("parts")) return;
  throw SetupError(file.string() + ": is another sweep; --sweep needs a folder of its own");
}

}  // namespace

void add_campaign_options(Command command, CampaignOptions& options) {
  command.add_option("--sweep", options.folder,
                     "keep the runs in this folder: the same command continues, and `hapticgiant "
                     "sweep FOLDER/sweep.yaml` plays them elsewhere (docs/start/sweep.md)");
  command.add_option("--part", options.part,
                     "I/N: play each N-th run from the I-th on, and print the results as JSON");
}

void check_sweep_program(const CampaignOptions& options) {
  if (options.folder.empty()) return;
  std::vector<std::string> words = python_program_that_runs_us("sweep");
  words.emplace_back("--check");
  if (run_program(words).code == 0) return;
  throw SetupError(
      fmt::format("{} cannot play many runs: it needs PyYAML; tools/setup.sh build, pip install "
                  "'hapticgiant[sweep]', or apt install python3-yaml, then the same command again",
                  words[0]));
}

bool play_campaign(const Campaign& campaign, const CampaignOptions& options) {
  if (!options.part.empty()) {
    experiments::Runs runs(part_of(options.part));
    campaign.play(runs);
    json results = json::object();
    for (const auto& [number, result] : runs.results()) results[std::to_string(number)] = result;
    print_out("\n" + json{{"results", results}}.dump(1) + "\n");
    return true;
  }
  if (options.folder.empty()) {
    experiments::Runs runs(progress_of("runs"));
    campaign.play(runs);
    return false;
  }
  const fs::path folder = fs::absolute(options.folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": cannot be made: " + error.message());
  const fs::path sweep = folder / "sweep.yaml";
  refuse_other_sweep(sweep);
  json files = json::array();
  for (const config::Scenario& it : campaign.scenarios) {
    files.push_back(scenario::hash_of(it.sources));
  }
  const json text = {{"title", campaign.command.front()},
                     {"command", campaign.command},
                     {"parts", campaign.parts},
                     {"files", files}};
  write_output(sweep.string(), text.dump(1) + "\n");
  std::vector<std::string> words = python_program_that_runs_us("sweep");
  words.insert(words.end(), {"--quiet", sweep.string()});
  const Ended ended = run_program(words);
  if (ended.code != 0) {
    throw SetupError(
        fmt::format("{}: not all runs have a result\n{}", campaign.command.front(), ended.said));
  }
  experiments::Runs runs(results_in(fs::path(sweep).replace_extension(".sweep")));
  campaign.play(runs);
  return false;
}

std::string file_or_name(const std::string& value) {
  std::error_code error;
  return fs::is_regular_file(value, error) ? fs::absolute(value).string() : value;
}

}  // namespace hg::apps
