#include "hg/recording/problem_dumps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/whole_file.h"
#include "hg/hqp/text.h"

namespace hg::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kPatience(2);  // for one file, at the end

std::string ended(const hqp::CapturedProblem& kept) {
  const std::string time =
      kept.cycle_time_us > 0.0 ? fmt::format(", cycle took {:.0f} us", kept.cycle_time_us) : "";
  return fmt::format("{} after {} active set{}{}", hqp::to_string(kept.status), kept.iterations,
                     kept.iterations == 1 ? "" : "s", time);
}

std::string text_of(const hqp::CapturedProblem& kept, const std::string& name) {
  std::ostringstream out;
  hqp::write_problem(
      out, {.problem = kept.problem, .options = kept.options, .guess = kept.guess, .name = name});
  return out.str();
}

bool write_file(const fs::path& file, const std::string& text) try {
  make_folder(file.parent_path().string());
  write_whole_file(file.string(), text);
  return true;
} catch (const SetupError&) {
  return false;
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

ProblemDumps::ProblemDumps(Place place) : ProblemDumps(std::move(place), write_file) {}

ProblemDumps::ProblemDumps(Place place, Write write)
    : place_(std::move(place)), write_(std::move(write)) {}

bool ProblemDumps::has_next(const hqp::ProblemCapture& problems) const {
  return !place_.folder.empty() && !has_failed_ && next_ < problems.size();
}

std::string ProblemDumps::look_at(const hqp::ProblemCapture& problems) {
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
  // with copies: the thread may outlive the run, or wait for a disk for ever
  std::promise<Written> promise;
  writing_ = promise.get_future();
  auto write_one = [promise = std::move(promise), write = write_, place = place_,
                    kept = problems[next_++]]() mutable noexcept {
    Written written = {.cycle = kept.cycle};
    try {
      written.file = place.folder / fmt::format("{}_hqp_{}.hqp", place.stem, kept.cycle);
      written.ended = ended(kept);
      const std::string name =
          fmt::format("{}, cycle {}, {}", place.origin, kept.cycle, written.ended);
      written.is_whole = write(written.file, text_of(kept, name));
    } catch (const std::exception&) {
      written.is_whole = false;  // no memory: reported as any file that cannot be written
    }
    promise.set_value(std::move(written));
  };
  try {
    std::thread(std::move(write_one)).detach();
  } catch (const std::system_error&) {
    writing_ = {};
    has_failed_ = true;
    text += "solver: its problems cannot be written: no more threads";
  }
  return text;
}

std::string ProblemDumps::finish(const hqp::ProblemCapture& problems) {
  std::string texts;
  while (writing_.valid() || has_next(problems)) {
    if (writing_.valid() && writing_.wait_for(kPatience) != std::future_status::ready) {
      const std::size_t lost = problems.size() - next_ + 1;
      next_ = problems.size();
      writing_ = {};
      if (!texts.empty()) texts += '\n';
      return texts + fmt::format("solver: {} problem{} NOT written: {} has not taken them in {} s",
                                 lost, lost == 1 ? "" : "s", place_.folder.string(),
                                 kPatience.count());
    }
    const std::string text = look_at(problems);
    if (!texts.empty() && !text.empty()) texts += '\n';
    texts += text;
  }
  return texts;
}

std::string ProblemDumps::summary(const hqp::ProblemCapture& problems) const {
  if (problems.count() == 0) return {};
  std::string text = fmt::format("  problems     in {} cycle{} the solver failed or took long, ",
                                 problems.count(), problems.count() == 1 ? "" : "s");
  if (files_ == 0) return text + "none was written\n";
  return text + fmt::format("{} written: {}\n", files_,
                            (place_.folder / (place_.stem + "_hqp_*.hqp")).string());
}

}  // namespace hg::recording
