#include "apps/hapticgiant/problem_dumps.h"

#include <fmt/format.h>

#include <fstream>
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

}  // namespace

ProblemDumps::ProblemDumps(fs::path folder, std::string name, std::string origin)
    : folder_(std::move(folder)), name_(std::move(name)), origin_(std::move(origin)) {}

std::string ProblemDumps::look_at(const hqp::KeptProblems& problems) {
  if (folder_.empty() || has_failed_ || next_ == problems.size()) return {};
  const hqp::KeptProblem& kept = problems[next_++];
  const fs::path file = folder_ / fmt::format("{}_hqp_{}.hqp", name_, kept.cycle);
  has_failed_ =
      !write(file, kept, fmt::format("{}, cycle {}, {}", origin_, kept.cycle, ended(kept)));
  if (has_failed_) return fmt::format("solver: {} cannot be written", file.string());
  if (++files_ > 1) return {};
  return fmt::format("solver: cycle {}, {}; to look at it:\n  hapticgiant hqp solve {} --explain",
                     kept.cycle, ended(kept), file.string());
}

std::string ProblemDumps::summary(const hqp::KeptProblems& problems) const {
  if (problems.count() == 0) return {};
  std::string text = fmt::format("  problems     in {} cycle{} the solver failed or took long, ",
                                 problems.count(), problems.count() == 1 ? "" : "s");
  if (files_ == 0) return text + "none was written\n";
  return text +
         fmt::format("{} written: {}\n", files_, (folder_ / (name_ + "_hqp_*.hqp")).string());
}

}  // namespace hg::apps
