#include "apps/offline/export_command.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/export_table.h"
#include "apps/offline/subcommand.h"
#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/core/visible.h"
#include "hg/recording/column_facts.h"
#include "hg/recording/recording_reader.h"
#include "hg/recording/rosbag2.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using recording::Column;
using recording::Columns;

constexpr double kTick_s = 1e-7;              // times are whole cycles up to rounding
constexpr std::size_t kBlockBytes = 1 << 24;  // of rows that are written together
constexpr double kMostRate_Hz = 1e9;
constexpr char kTime[] = "time_s";

struct ExportArguments {
  std::string file, format = "csv";
  std::string out;                   ///< without suffix; empty = name of the recording
  std::vector<std::string> columns;  ///< patterns; empty = all
  std::string json;                  ///< list of the columns; empty = printed
  std::optional<double> rate_Hz, from_s, to_s;
};

// Which samples of a run are wanted: the first one in every period.
class Part {
 public:
  explicit Part(const ExportArguments& arguments)
      : from_s_(arguments.from_s.value_or(-kInfinity)),
        to_s_(arguments.to_s.value_or(kInfinity)),
        period_s_(arguments.rate_Hz ? 1.0 / *arguments.rate_Hz : 0.0) {}

  bool takes(double time_s) {
    if (time_s < from_s_ - kTick_s || time_s >= to_s_ - kTick_s) return false;
    if (!has_begun_) begin_s_ = time_s;
    has_begun_ = true;
    // periods are counted, so that their rounding does not add up
    const double since_s = time_s - begin_s_ + kTick_s;
    if (since_s < static_cast<double>(periods_) * period_s_) return false;
    // rates up to kMostRate_Hz and times up to centuries fit
    if (period_s_ > 0.0) periods_ = static_cast<std::uint64_t>(since_s / period_s_) + 1;
    return true;
  }

 private:
  double from_s_, to_s_, period_s_;
  double begin_s_ = 0.0;
  std::uint64_t periods_ = 0;  ///< that have a row already, or none
  bool has_begun_ = false;
};

class Listener : public recording::RecordingListener {
 public:
  Listener(const ExportArguments& arguments, const std::vector<std::string>& names)
      : columns_(names), part_(arguments) {}

  void configuration(const recording::NamedText&) override {}
  void event(const messages::Event&) override {}
  void sample(const Sample& sample) override {
    if (was_interrupted()) throw SetupError("export: interrupted, nothing is written");
    if (!part_.takes(sample.record.time_s)) return;
    columns_.append(sample);
    if (columns_.rows() >= block_rows_) take_block();
  }

 protected:
  // takes the rows of columns_ and clears them
  virtual void take_block() = 0;

  Columns columns_;
  std::size_t block_rows_ = 256;

 private:
  Part part_;
};

// What must be known before the first row is written: how long rows become, and all but the rows.
class Survey final : public Listener {
 public:
  Survey(const ExportArguments& arguments, const std::vector<std::string>& names)
      : Listener(arguments, names), has_numbers_(columns_.all().size(), false) {}

  void configuration(const recording::NamedText& text) override { configuration_.push_back(text); }
  void metadata(const std::string& name, const recording::KeyValues& pairs) override {
    if (name == "run") run_ = pairs;
    if (name == "limits") limits_ = pairs;
  }
  void event(const messages::Event& event) override { events_.push_back(event); }
  void sample(const Sample& sample) override {
    state_hash_ = sample.record.state_hash;
    Listener::sample(sample);
  }

  // Facts about the table; call it once, at the end.
  Json finish(const ExportArguments& arguments, const recording::ReadResult& read) {
    take_block();
    if (rows_ == 0) throw SetupError(arguments.file + ": has no sample in that time");
    Json facts = {{"file", visible(fs::canonical(arguments.file).filename().string())},
                  {"exported_by", std::string("hapticgiant ") + kVersion},
                  {"rows", rows_},
                  {"from_s", from_s_},
                  {"to_s", to_s_}};
    if (arguments.rate_Hz) facts["rate_Hz"] = *arguments.rate_Hz;
    facts["is_complete"] = read.is_complete;
    facts["losses"] = recording::to_text(read.losses);
    for (const auto& [key, value] : run_) facts["run"][key] = value;
    describe_scenario(facts["run"]);
    facts["run"]["last_state_hash"] = fmt::format("{:016x}", state_hash_);
    const recording::RunParts parts(run_, limits_);
    const std::vector<Column>& all = columns_.all();
    Json columns = Json::array();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].is_kept || !has_numbers_[i]) continue;
      row_bytes_ += all[i].bytes * all[i].width();
      columns.push_back(describe(all[i], parts.facts_of(all[i])));
      if (all[i].name == kTime) std::rotate(columns.begin(), columns.end() - 1, columns.end());
    }
    facts["columns"] = columns;
    return facts;
  }

  const std::vector<messages::Event>& events() const noexcept { return events_; }
  std::size_t row_bytes() const noexcept { return row_bytes_; }
  // with the lengths of their longest rows
  const std::vector<Column>& columns() const noexcept { return columns_.all(); }

 private:
  void take_block() override {
    if (columns_.rows() == 0) return;
    const std::vector<Column>& all = columns_.all();
    for (std::size_t i = 0; i < all.size(); ++i) {
      has_numbers_[i] = has_numbers_[i] || !all[i].data.empty();
      if (all[i].name != kTime) continue;
      std::vector<double> times(columns_.rows());
      std::memcpy(times.data(), all[i].data.data(), all[i].data.size());
      if (rows_ == 0) from_s_ = times.front();
      to_s_ = times.back();
    }
    rows_ += columns_.rows();
    columns_.clear();
  }

  // what the scenario says, where it can be read
  void describe_scenario(Json& run) const {
    try {
      const config::Scenario scenario = scenario::recorded_scenario(configuration_);
      const analysis::RunFacts facts = scenario::facts_of_scenario(scenario);
      run.update(Json{{"scenario", scenario.title},
                      {"device", scenario.device.name},
                      {"seed", std::to_string(scenario.device.simulation.seed)},
                      {"law", facts.law},
                      {"bounds", facts.bounds}});
    } catch (const SetupError&) {
      run["scenario"] = "not understood by this version";
    }
  }

  static Json describe(const Column& column, const recording::ColumnFacts& known) {
    const char* kind = column.kind == 'f' ? "float" : column.kind == 'u' ? "uint" : "int";
    Json json = {{"name", column.name}, {"type", fmt::format("{}{}", kind, 8 * column.bytes)}};
    if (column.kind == 'b') json["type"] = "bool";
    if (column.is_wide) json["width"] = column.width();
    json["unit"] = known.unit;
    json["description"] = column.note;
    if (!column.is_wide) return json;
    json["axis"] = known.axis;
    json["labels"] = Json::array();
    json["units"] = Json::array();
    for (std::size_t i = 0; i < std::min(known.labels.size(), column.width()); ++i) {
      json["labels"].push_back(known.labels[i]);
      json["units"].push_back(known.units[i]);
    }
    return json;
  }

  std::vector<recording::NamedText> configuration_;
  recording::KeyValues run_, limits_;
  std::vector<messages::Event> events_;
  std::vector<bool> has_numbers_;  // of each column
  std::uint64_t rows_ = 0, state_hash_ = 0;
  double from_s_ = 0.0, to_s_ = 0.0;
  std::size_t row_bytes_ = 0;
};

class Writer final : public Listener {
 public:
  Writer(const ExportArguments& arguments, const std::vector<std::string>& names,
         const Survey& survey, ExportTable& table)
      : Listener(arguments, names), table_(table) {
    columns_.widen(survey.columns());
    block_rows_ = std::max<std::size_t>(1, kBlockBytes / survey.row_bytes());
  }
  void finish() {
    take_block();
    table_.finish();
  }

 private:
  void take_block() override {
    if (columns_.rows() == 0) return;
    table_.write(columns_);
    columns_.clear();
  }

  ExportTable& table_;
};

// Names of the columns that the patterns choose, with the time; empty = all.
std::vector<std::string> chosen(const std::vector<std::string>& patterns) {
  if (patterns.empty()) return {};
  std::vector<std::string> all, names = {kTime};
  const Columns columns;
  for (const Column& column : columns.all()) all.push_back(column.name);
  for (const std::string& pattern : patterns) {
    const std::size_t before = names.size();
    for (const std::string& name : all) {
      if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) names.push_back(name);
    }
    if (names.size() > before) continue;
    throw SetupError(fmt::format(
        "--columns: no column is called {}, did you mean '{}'? 'hapticgiant export --list-columns' "
        "prints all",
        pattern, nearest_name(pattern, all)));
  }
  return names;
}

// Where the export goes, without suffix.
std::string place_of(const ExportArguments& arguments) {
  if (arguments.out.empty()) {
    std::string name = fs::canonical(arguments.file).stem().string();
    if (name.ends_with(".partial")) name.resize(name.rfind('.'));
    return name;
  }
  const fs::path out = arguments.out;
  const std::string name = out.filename().string();
  if (name.empty() || name == "." || name == "..")
    throw SetupError("--out " + arguments.out + ": expected a name of files");
  for (const char* suffix : {".csv", ".parquet", ".h5", ".hdf5"}) {
    if (out.extension() == suffix) return fs::path(out).replace_extension().string();
  }
  return arguments.out;
}

void print_damage(bool is_complete, const std::vector<recording::Loss>& losses) {
  print_out(recording::to_text(losses));
  if (is_complete) return;
  print_out("CUT OFF     the recording was not completed; all that it holds is exported\n");
}

int export_rosbag2(const ExportArguments& arguments) {
  if (!arguments.columns.empty() || arguments.rate_Hz) {
    throw SetupError("--columns, --rate: not possible with rosbag2, which has whole messages");
  }
  watch_interruption();
  recording::Rosbag2Plan plan = {.folder = place_of(arguments), .is_interrupted = was_interrupted};
  if (arguments.from_s) plan.from_s = *arguments.from_s - kTick_s;
  if (arguments.to_s) plan.to_s = *arguments.to_s - kTick_s;
  const recording::Rosbag2Result result = recording::write_rosbag2(arguments.file, plan);
  print_damage(result.is_complete, result.losses);
  print_out("rosbag2     {}: {} messages on {} topics{}\n", plan.folder.string(), result.messages,
            result.topics, result.is_link ? ", the recording itself (hard link)" : "");
  return 0;
}

int export_table(const ExportArguments& arguments) {
  const std::vector<std::string> names = chosen(arguments.columns);
  const std::string out = place_of(arguments);
  if (arguments.format != "csv") check_export_program(arguments.format);
  watch_interruption();
  Survey survey(arguments, names);
  const recording::ReadResult read = recording::read_recording(arguments.file, survey);
  const Json facts = survey.finish(arguments, read);
  std::vector<std::string> kept;
  for (const Json& column : facts["columns"]) kept.push_back(column["name"]);

  ExportFiles files(out + ".json");
  const std::unique_ptr<ExportTable> table =
      arguments.format == "csv"
          ? make_csv(files, out, facts, survey.events())
          : make_python_table(files, arguments.format, out, facts, survey.events());
  Writer writer(arguments, kept, survey, *table);
  (void)recording::read_recording(arguments.file, writer);
  writer.finish();
  for (const std::string& file : files.keep()) print_out("written     {}\n", file);
  print_damage(read.is_complete, read.losses);
  print_out("table       {} rows, {:.3f} .. {:.3f} s, {} columns; {} events\n",
            facts["rows"].get<std::uint64_t>(), facts["from_s"].get<double>(),
            facts["to_s"].get<double>(), kept.size(), survey.events().size());
  return 0;
}

int list_columns(const std::string& json_file) {
  const recording::RunParts parts;
  const Columns columns;
  if (!json_file.empty()) {
    check_writable(json_file, kJson);
    Json list = {{"columns", Json::array()}};
    for (const Column& column : columns.all()) {
      list["columns"].push_back({{"name", column.name},
                                 {"has_index", column.is_wide},
                                 {"unit", parts.facts_of(column).unit},
                                 {"description", column.note}});
    }
    write_json(json_file, list);
    return 0;
  }
  for (const Column& column : columns.all()) {
    print_out("{:<36} {:<16} {}\n", column.name + (column.is_wide ? "[]" : ""),
              parts.facts_of(column).unit, column.note);
  }
  return 0;
}

int run_export(const ExportArguments& arguments) {
  if (arguments.from_s && arguments.to_s && !(*arguments.from_s < *arguments.to_s)) {
    throw SetupError("--to: must be later than --from");
  }
  return arguments.format == "rosbag2" ? export_rosbag2(arguments) : export_table(arguments);
}

}  // namespace

void add_export(Command app, int& exit_code) {
  const auto arguments = std::make_shared<ExportArguments>();
  const Command command = add_offline(app, "export");
  command.footer(
      "Examples:\n"
      "  hapticgiant export recordings/latest.mcap --columns 'robot.*' twin.q_a --rate 100\n"
      "  hapticgiant export recordings/latest.mcap --format parquet --out door\n"
      "  hapticgiant export recordings/latest.mcap --format rosbag2 --from 2 --to 5\n"
      "  hapticgiant export --list-columns");
  const Option file =
      command.add_option("file", arguments->file, "recording, also one that is damaged or cut off")
          .existing_file();
  const auto lists = std::make_shared<bool>(false);
  const Option list =
      command.add_flag("--list-columns", *lists, "print names, units and meanings of all columns")
          .excludes(file);
  command.add_option("--json", arguments->json, "write that list as JSON to this file instead")
      .needs(list);
  command.add_option("--format", arguments->format, "csv, parquet, hdf5 or rosbag2")
      .one_of({"csv", "parquet", "hdf5", "rosbag2"})
      .capture_default_str();
  command.add_option("-o,--out", arguments->out,
                     "name of the files, or of the folder; default: that of the recording, here");
  command.add_option("--columns", arguments->columns,
                     "names of columns, with * and ?; default: all. The time is always there");
  command
      .add_option("--rate", arguments->rate_Hz,
                  "rows per second: the first sample of each period; default: all samples")
      .check(number_that("more than 0 and at most 1e9",
                         [](double v) { return v > 0.0 && v <= kMostRate_Hz; }));
  const auto is_time = number_that("a finite number", [](double v) { return std::isfinite(v); });
  command.add_option("--from", arguments->from_s, "run time of the first row, s").check(is_time);
  command.add_option("--to", arguments->to_s, "run time that the rows end before, s")
      .check(is_time);
  command.callback([arguments, lists, file, &exit_code] {
    if (!*lists && file.count() == 0) refuse_without("file");
    exit_code = *lists ? list_columns(arguments->json) : run_export(*arguments);
  });
}

}  // namespace hg::apps
