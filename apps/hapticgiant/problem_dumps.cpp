#include "apps/hapticgiant/problem_dumps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "hg/hqp/text.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

std::string ended(const hqp::KeptProblem& kept) {
  const std::string time =
      kept.cycle_time_us > 0.0 ? fmt::format(", cycle took {:.0f} us", kept.cycle_time_us) : "";
  return fmt::format("{} after {} active set{}{}", hqp::to_string(kept.status), kept.iterations,
                     kept.iterations == 1 ? "" : "s", time);
}

bool write(const fs::path& file, const hqp::KeptProblem& kept, const std::string& name) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  std::ofstream out(file);
  hqp::write_problem(
      out, {.problem = kept.problem, .options = kept.options, .guess = kept.guess, .name = name});
  out.close();
  return out.good();
}

// A word of a command, as a shell takes it.
std::string shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("/._-+,:=@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

ProblemDumps::ProblemDumps(Place place) : place_(std::move(place)) {}

bool ProblemDumps::has_next(const hqp::KeptProblems& problems) const {
  return !place_.folder.empty() && !has_failed_ && next_ < problems.size();
}

std::string ProblemDumps::look_at(const hqp::KeptProblems& problems) {
  std::string text;
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    const Written written = writing_.get();
    const std::string file = written.file.string();
    if (!written.is_whole) {
      has_failed_ = true;
      text = fmt::format("solver: {} cannot be written", file);
    } else if (++files_ == 1) {
      text =
          fmt::format("solver: cycle {}, {}; to look at it:\n  {} hqp solve {} --explain",
                      written.cycle, written.ended, shell_word(place_.program), shell_word(file));
    }
  }
  if (!has_next(problems)) return text;
  // a copy: the thread may outlive the run
  writing_ = std::async(std::launch::async, [place = place_, kept = problems[next_++]] {
    const fs::path file = place.folder / fmt::format("{}_hqp_{}.hqp", place.stem, kept.cycle);
    const std::string how = ended(kept);
    const std::string name = fmt::format("{}, cycle {}, {}", place.origin, kept.cycle, how);
    return Written{file, kept.cycle, how, write(file, kept, name)};
  });
  return text;
}

std::string ProblemDumps::finish(const hqp::KeptProblems& problems) {
  std::string texts;
  while (writing_.valid() || has_next(problems)) {
    if (writing_.valid()) writing_.wait();
    const std::string text = look_at(problems);
    if (!texts.empty() && !text.empty()) texts += '\n';
    texts += text;
  }
  return texts;
}

std::string ProblemDumps::summary(const hqp::KeptProblems& problems) const {
  if (problems.count() == 0) return {};
  std::string text = fmt::format("  problems     in {} cycle{} the solver failed or took long, ",
                                 problems.count(), problems.count() == 1 ? "" : "s");
  if (files_ == 0) return text + "none was written\n";
  return text + fmt::format("{} written: {}\n", files_,
                            (place_.folder / (place_.stem + "_hqp_*.hqp")).string());
}

}  // namespace hg::apps
