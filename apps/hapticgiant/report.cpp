#include "apps/hapticgiant/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/python_program.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kMissing = 69;  // exit code of the report program: a library is missing

std::vector<std::string> export_program(const std::string& format) {
  std::vector<std::string> words = python_program("report");
  words.insert(words.end(), {"--export", format});
  return words;
}

[[noreturn]] void refuse(const std::string& interpreter) {
  throw SetupError(fmt::format(
      "{} cannot write the report: it needs scipy, matplotlib and jinja2; tools/setup.sh build, "
      "pip install 'hapticgiant[report]', or apt install python3-scipy python3-matplotlib "
      "python3-jinja2, then the same command again",
      interpreter));
}

// null: none
nlohmann::ordered_json absolute(const std::string& path) {
  if (path.empty()) return nullptr;
  return fs::absolute(path).string();
}

nlohmann::ordered_json json_of(const Report& report) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (const auto& [name, file] : report.files) {
    if (!file.empty()) files[name] = absolute(file);
  }
  return {{"results", report.results},     {"folder", absolute(report.folder)},
          {"docs", absolute(report.docs)}, {"files", files},
          {"last_line", report.last_line}, {"kept", report.kept},
          {"exit_code", report.exit_code}};
}

}  // namespace

void check_report_program() {
  std::vector<std::string> words = python_program("report");
  words.emplace_back("--check");
  if (run_program(words).code != 0) refuse(words[0]);
}

int become_reports(const std::vector<Report>& reports) {
  nlohmann::ordered_json document = {{"version", kVersion}};
  std::string kept;
  for (const Report& report : reports) {
    document["reports"].push_back(json_of(report));
    kept += report.kept;
  }
  try {
    check_report_program();
    // a recording may hold texts that are no UTF-8
    become_program(python_program("report"),
                   document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } catch (const SetupError& error) {
    if (kept.empty()) throw;
    print_error("{}\n{}", error.what(), kept);
    return kNotWritten;
  }
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
        fmt::format("--format {}: {} lacks {}; pip install 'hapticgiant[export]' there, or set "
                    "HAPTICGIANT_PYTHON to a Python that has it. --format csv needs nothing",
                    format, words[0], ended.said));
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

}  // namespace hg::apps
