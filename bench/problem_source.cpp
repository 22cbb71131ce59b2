#include "bench/problem_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "hg/core/error.h"
#include "hg/hqp/problem.h"
#include "hg/hqp/text.h"

namespace hg::bench {
namespace fs = std::filesystem;
namespace {

std::vector<std::vector<double>> read_numbers(const std::string& file) {
  std::vector<std::vector<double>> lines;
  std::istringstream text(hqp::read_text(file));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;)
      lines.back().push_back(std::strtod(word.c_str(), nullptr));
  }
  return lines;
}

bool is_problem_file(const std::string& name) {
  return name.ends_with(".hqp") || name.ends_with(".hqp.gz");
}

std::size_t bytes_of(const hqp::Problem& problem) {
  const hqp::Capacity& capacity = problem.capacity();
  return sizeof(double) * (capacity.variables + 6) * capacity.rows;
}

}  // namespace

ProblemSource::ProblemSource(std::string name, const config::Scenario& scenario, std::size_t most)
    : name_(std::move(name)), remaining_(most), player_(std::make_unique<Player>(scenario)) {}

ProblemSource::ProblemSource(const fs::path& file, std::size_t most) : remaining_(most) {
  for (hqp::RecordedProblem& recorded : hqp::read_recorded_problems(file.string())) {
    block_.push_back(std::move(recorded.problem));
    guesses_.push_back(recorded.guess);
  }
  name_ = file.filename().string();
  name_.resize(name_.find(".hqp"));
  is_sequence_ = !name_.starts_with("random");
  read_reference((file.parent_path() / name_).string());
}

void ProblemSource::read_reference(const std::string& stem) {
  if (!fs::exists(stem + ".sol.gz")) return;
  norms_ = read_numbers(stem + ".sol.gz");
  if (norms_.size() != block_.size()) {
    throw SetupError(stem + ".sol.gz: expected one line per problem, " +
                     std::to_string(block_.size()) + ", got " + std::to_string(norms_.size()));
  }
  for (std::size_t i = 0; i < norms_.size(); ++i) {
    const int variables = block_[i].variables(), levels = block_[i].levels();
    if (std::ssize(norms_[i]) != variables + levels) {
      throw SetupError(stem + ".sol.gz:" + std::to_string(i + 1) + ": expected " +
                       std::to_string(variables) + " variables and " + std::to_string(levels) +
                       " slacks, got " + std::to_string(norms_[i].size()) + " numbers");
    }
    norms_[i].erase(norms_[i].begin(), norms_[i].begin() + variables);
    for (double& norm : norms_[i]) norm = std::sqrt(norm);
  }
  if (fs::exists(stem + ".skip")) read_skipped(stem + ".skip");
}

void ProblemSource::read_skipped(const std::string& file) {
  std::istringstream text(hqp::read_text(file));
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    std::string word;
    if (!(std::istringstream(line) >> word)) continue;
    std::size_t index = 0;
    const char* const end = word.data() + word.size();
    const auto [read_to, error] = std::from_chars(word.data(), end, index);
    if (error != std::errc() || read_to != end || index >= norms_.size()) {
      throw SetupError(file + ":" + std::to_string(line_number) +
                       ": expected the index of a problem, 0.." +
                       std::to_string(norms_.size() - 1) + ", got '" + word + "'");
    }
    norms_[index].clear();
  }
}

const hqp::ActiveSet* ProblemSource::guess(std::size_t index) const {
  return index < guesses_.size() && guesses_[index] ? &*guesses_[index] : nullptr;
}

std::span<const double> ProblemSource::reference(std::size_t index) const {
  return has_reference() ? std::span<const double>(norms_[index]) : std::span<const double>();
}

std::span<const hqp::Problem> ProblemSource::next() {
  if (player_ != nullptr) return next_of_scenario();
  const std::size_t count = std::min(remaining_, block_.size());
  remaining_ = 0;
  return {block_.data(), count};
}

std::span<const hqp::Problem> ProblemSource::next_of_scenario() {
  const hqp::Problem& problem = player_->cycle().problem();
  const std::size_t most = std::min(
      {remaining_, kBlockProblems,
       std::max<std::size_t>(1, kBlockBytes / std::max<std::size_t>(1, bytes_of(problem)))});
  std::size_t count = 0;
  bool is_wanted = most > 0;
  while (is_wanted) {
    player_->begin();
    player_->run();
    if (player_->is_running()) {
      if (count < block_.size()) {
        block_[count] = problem;
      } else {
        block_.push_back(problem);
      }
      ++count;
    }
    const bool has_more = player_->end();
    if (!has_more) remaining_ = count;
    is_wanted = has_more && count < most;
  }
  remaining_ -= count;
  return {block_.data(), count};
}

std::vector<fs::path> reference_files(const fs::path& root) {
  const char* variable = std::getenv("HG_REFERENCE_DATA");
  const fs::path folder = variable != nullptr ? fs::path(variable) : root / "tests" / "reference";
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_problem_file(entry.path().filename().string())) files.push_back(entry.path());
  }
  if (variable != nullptr && files.empty()) {
    throw SetupError("HG_REFERENCE_DATA: expected a folder with *.hqp or *.hqp.gz, got '" +
                     folder.string() + "'");
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace hg::bench
