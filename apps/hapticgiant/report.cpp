#include "apps/hapticgiant/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/python_program.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

// exit codes of the report program: a library is missing; its verdict is this plus 1 or 3
constexpr int kMissing = 69, kVerdict = 100, kLargestVerdict = 3;
std::vector<std::string> export_program(const std::string& format) {
  std::vector<std::string> words = python_program("report");
  words.insert(words.end(), {"--export", format});
  return words;
}

[[noreturn]] void refuse(const std::string& interpreter) {
  throw SetupError(fmt::format(
      "{} cannot write the report: it needs scipy, matplotlib and jinja2; tools/setup.sh build, "
      "pip install scipy matplotlib jinja2, or apt install python3-scipy python3-matplotlib "
      "python3-jinja2, then the same command again",
      interpreter));
}

}  // namespace

void check_report_program() {
  std::vector<std::string> words = python_program("report");
  words.emplace_back("--check");
  if (run_program(words).code != 0) refuse(words[0]);
}

int write_report(const fs::path& folder, const std::string& docs,
                 const std::vector<fs::path>& runs) {
  std::vector<std::string> words = python_program("report");
  words.push_back(fs::absolute(folder).string());
  for (const fs::path& run : runs) words.push_back(fs::absolute(run).string());
  if (!docs.empty()) words.insert(words.end(), {"--docs", fs::absolute(docs).string()});
  const auto [code, said] = run_program(words);
  if (code == Ended::kNotStarted || code == kMissing) refuse(words[0]);
  print_out(said);
  if (code == 0) return 0;
  if (code > kVerdict && code <= kVerdict + kLargestVerdict) return code - kVerdict;
  const std::string& program = words[words[2] == "-m" ? 3 : 2];
  throw SetupError(fmt::format("{}: no report: {} of {} ended with {}", folder.string(), program,
                               words[0], code));
}

int report_on(const fs::path& folder, const nlohmann::ordered_json& results,
              const std::string& docs) {
  write_output((folder / "results.json").string(), results.dump() + "\n");
  return write_report(folder, docs);
}

std::string python_package_folder(const std::string& package) {
  const std::string code = fmt::format(
      "import importlib.util as u; s = u.find_spec('{}'); "
      "print(s.submodule_search_locations[0] if s else '', end='')",
      package);
  const Ended ended = run_program({python_interpreter(), "-B", "-c", code});
  return ended.code == 0 ? ended.said : "";
}

void check_export_program(const std::string& format) {
  const std::vector<std::string> words = export_program(format);
  std::vector<std::string> check = words;
  check.emplace_back("--check");
  const Ended ended = run_program(check);
  if (ended.code == kMissing) {
    throw SetupError(
        fmt::format("--format {}: {} lacks {}; pip install {} there, or set HAPTICGIANT_PYTHON to "
                    "a Python that "
                    "has it. --format csv needs nothing",
                    format, words[0], ended.said, ended.said));
  }
  if (ended.code != 0) {
    throw SetupError(fmt::format(
        "--format {}: needs Python, and {} does not work; set HAPTICGIANT_PYTHON to one with "
        "hapticgiant[export]. --format csv needs nothing",
        format, words[0]));
  }
}

ExportProgram::ExportProgram(const std::string& format) : words_(export_program(format)) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw SetupError("export: no pipe can be made");
  child_ = start_program(words_, ends[0], STDIN_FILENO);
  input_ = ends[1];
}

ExportProgram::~ExportProgram() {
  if (input_ >= 0) close(input_);
  if (child_ > 0) waitpid(child_, nullptr, 0);
}

void ExportProgram::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return finish();  // which says why
    bytes.remove_prefix(written);
  }
}

void ExportProgram::finish() {
  close(std::exchange(input_, -1));
  int status = 0;
  const pid_t child = std::exchange(child_, 0);
  const bool has_ended = child > 0 && waitpid(child, &status, 0) == child;
  if (has_ended && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw SetupError(fmt::format("{} could not write the export", words_[0]));
}

std::string report_text(const fs::path& folder, const nlohmann::ordered_json& results,
                        const char* name, const std::string& docs) {
  report_on(folder, results, docs);
  return read_file(folder / name);
}

}  // namespace hg::apps
