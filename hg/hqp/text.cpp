#include "hg/hqp/text.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/index.h"
#include "hg/core/nearest_name.h"
#include "hg/core/open_file.h"
#include "hg/core/text.h"

namespace hg::hqp {
namespace {

constexpr std::string_view kStateLetters = ".lu=<>";  // in the order of RowState

// options by the name of their member
constexpr std::array kTolerances = {
    std::pair{"rank_tolerance", &SolverOptions::rank_tolerance},
    std::pair{"feasibility_tolerance", &SolverOptions::feasibility_tolerance}};

// A name of several lines, or with other control characters, would not be read back.
std::string in_one_line(std::string name) {
  const auto is_control = [](unsigned char c) { return std::iscntrl(c) != 0; };
  std::replace_if(name.begin(), name.end(), is_control, ' ');
  const auto first = name.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return name.substr(first, name.find_last_not_of(' ') - first + 1);
}

// Splits a text into lines and the current line into words.
class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// Moves to the next line that is not blank; false at the end of the text.
  bool next_line() {
    while (!text_.empty()) {
      const std::size_t end = text_.find('\n');
      line_ = text_.substr(0, end);
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++line_number_;
      if (line_.find_first_not_of(kBlanks) != std::string_view::npos) return true;
    }
    line_ = {};
    return false;
  }

  /// Moves to the next line, as next_line(), where a line must follow.
  void need_line(const std::string& expected) {
    if (!next_line()) fail(expected, "the end of the file");
  }

  /// The next word of the line; empty at its end.
  std::string_view next_word() {
    const std::size_t begin = line_.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return line_ = {};
    line_.remove_prefix(begin);
    const std::string_view word = line_.substr(0, line_.find_first_of(kBlanks));
    line_.remove_prefix(word.size());
    return word;
  }

  /// Everything up to the end of the line, without blanks around it.
  std::string_view rest_of_line() {
    const std::size_t begin = std::min(line_.find_first_not_of(kBlanks), line_.size());
    const std::string_view rest = line_.substr(begin, line_.find_last_not_of(kBlanks) + 1 - begin);
    line_ = {};
    return rest;
  }

  /// The next word, which must be one of `words`.
  std::string need_one_of(const std::vector<std::string>& words) {
    const std::string word(next_word());
    if (std::find(words.begin(), words.end(), word) == words.end()) fail_word(words, word);
    return word;
  }

  int need_integer(const std::string& meaning, int min, int max) {
    const std::string_view word = next_word();
    int value = 0;
    if (!reads_as(word, value) || value < min || value > max) {
      fail(meaning + " of " + std::to_string(min) + ".." + std::to_string(max), describe(word));
    }
    return value;
  }

  /// Reads a number, which may be infinite or NaN.
  double need_number(const std::string& meaning) {
    const std::string_view word = next_word();
    double value = 0.0;
    if (!reads_as(word, value)) fail(meaning, describe(word));
    return value;
  }

  void need_end_of_line() {
    const std::string_view word = next_word();
    if (!word.empty()) fail("the end of the line", describe(word));
  }

  [[noreturn]] void fail_word(const std::vector<std::string>& words, const std::string& got) const {
    std::string expected;
    for (const std::string& word : words) {
      if (!expected.empty()) expected += &word == &words.back() ? " or " : ", ";
      expected += word.empty() ? "the end of the line" : in_quotes(word);
    }
    std::vector<std::string> candidates = words;
    std::erase(candidates, std::string());
    const bool is_word = got.find_first_not_of("0123456789.-") == 0;
    const bool has_choice = is_word && candidates.size() > 1;
    fail(expected,
         describe(got) + (has_choice ? ", nearest is " + in_quotes(nearest_name(got, candidates))
                                     : std::string()));
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& got) const {
    fail("expected " + expected + ", got " + got);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw SetupError(name_ + ":" + std::to_string(line_number_) + ": " + what);
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r";

  template <typename Number>
  static bool reads_as(std::string_view word, Number& value) {
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    return !word.empty() && error == std::errc() && end == last;
  }

  static std::string describe(std::string_view word) {
    return word.empty() ? "the end of the line" : in_quotes(word);
  }

  std::string_view text_;
  std::string_view line_;
  const std::string& name_;
  int line_number_ = 0;
};

// A row as read, before the number of rows of the problem is known.
struct ParsedRow {
  int level;
  std::vector<double> coefficients;
  Interval bounds;
  double weight = 1.0;
  bool is_dense = false;  ///< a dense row even with a single coefficient of value 1
  bool is_bad = false;    ///< deliberately invalid
};

ParsedRow parse_row(Reader& reader, int level, int n, bool is_equality) {
  reader.need_line("a row of " + std::string(is_equality ? "an equality" : "an inequality"));
  const int count = n + (is_equality ? 1 : 2);
  ParsedRow row = {level, std::vector<double>(n), {}};
  int position = 0;
  const auto need_number = [&] {
    ++position;
    return reader.need_number("number " + std::to_string(position) + " of " +
                              std::to_string(count));
  };
  for (double& coefficient : row.coefficients) coefficient = need_number();
  row.bounds.lb = need_number();
  row.bounds.ub = is_equality ? row.bounds.lb : need_number();
  while (true) {
    const std::string word = reader.need_one_of({"weight", "dense", "bad", ""});
    if (word.empty()) break;
    if (word == "weight") row.weight = reader.need_number("a weight");
    row.is_dense |= word == "dense";
    row.is_bad |= word == "bad";
  }
  const char* const rule = broken_rule(row.bounds, row.weight, norm_of(row.coefficients));
  if (rule != nullptr && !row.is_bad) {
    reader.fail(std::string(rule) + "; a deliberately invalid row ends in 'bad'");
  }
  return row;
}

// Index of the only coefficient if that is 1, else -1.
int single_variable(std::span<const double> coefficients) {
  int variable = -1;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] == 0.0) continue;
    if (coefficients[i] != 1.0 || variable >= 0) return -1;
    variable = static_cast<int>(i);
  }
  return variable;
}

SolverOptions parse_options(Reader& reader) {
  SolverOptions options;
  std::vector<std::string> names = {"max_iterations", "budget", "minimum_norm"};
  for (const auto& [name, member] : kTolerances) names.emplace_back(name);
  names.emplace_back();
  while (true) {
    const std::string name = reader.need_one_of(names);
    if (name.empty()) break;
    if (name == "max_iterations") {
      options.max_iterations = reader.need_integer(name, 1, std::numeric_limits<int>::max());
    }
    if (name == "budget") {
      options.budget = reader.need_integer(name, 0, std::numeric_limits<int>::max());
    }
    if (name == "minimum_norm") options.minimum_norm = reader.need_integer(name, 0, 1) == 1;
    for (const auto& [tolerance, member] : kTolerances) {
      if (name == tolerance) options.*member = reader.need_number("a tolerance");
    }
  }
  try {
    check_solver_options(options);
  } catch (const SetupError& error) {
    reader.fail(error.what());
  }
  return options;
}

using States = std::array<RowState, kMaxRows>;

void parse_states(Reader& reader, std::string_view letters, int rows, States& states) {
  if (std::ssize(letters) != rows ||
      letters.find_first_not_of(kStateLetters) != std::string_view::npos) {
    reader.fail("a letter of " + std::string(kStateLetters) + " for each of the " +
                    std::to_string(rows) + " rows",
                in_quotes(letters));
  }
  std::transform(letters.begin(), letters.end(), states.begin(),
                 [](char letter) { return static_cast<RowState>(kStateLetters.find(letter)); });
}

ActiveSet parse_guess(Reader& reader, int rows) {
  ActiveSet guess;
  parse_states(reader, reader.next_word(), rows, guess.state);
  const std::string_view before = reader.next_word();
  if (!before.empty()) parse_states(reader, before, rows, guess.before);
  reader.need_end_of_line();
  return guess;
}

// The line with the first `level` has been reached.
std::vector<ParsedRow> parse_levels(Reader& reader, int n, int levels) {
  std::vector<ParsedRow> rows;
  for (int level = 0; level < levels; ++level) {
    if (level > 0) {
      reader.need_line("'level'");
      reader.need_one_of({"level"});
    }
    const int free = kMaxRows - static_cast<int>(rows.size());
    const int equalities = reader.need_integer("a number of equalities", 0, free);
    const int inequalities = reader.need_integer("a number of inequalities", 0, free - equalities);
    reader.need_end_of_line();
    for (int i = 0; i < equalities; ++i) rows.push_back(parse_row(reader, level, n, true));
    for (int i = 0; i < inequalities; ++i) rows.push_back(parse_row(reader, level, n, false));
  }
  return rows;
}

Problem make_problem(int n, int levels, const std::vector<ParsedRow>& rows) {
  Problem problem({n, levels, std::max(1, static_cast<int>(rows.size()))});
  std::size_t next = 0;
  for (int level = 0; level < levels; ++level) {
    problem.add_level();
    for (; next < rows.size() && rows[next].level == level; ++next) {
      const ParsedRow& row = rows[next];
      const int variable = row.is_dense ? -1 : single_variable(row.coefficients);
      if (variable >= 0) {
        problem.add_bound(variable, row.bounds, row.weight);
      } else {
        problem.add_row(row.coefficients, row.bounds, row.weight);
      }
    }
  }
  return problem;
}

// The line with `hqp` has been reached.
RecordedProblem parse_recorded(Reader& reader) {
  reader.need_one_of({"hqp"});
  const int n = reader.need_integer("a number of variables", 1, kMaxVariables);
  const int levels = reader.need_integer("a number of levels", 1, kMaxLevels);
  reader.need_end_of_line();

  std::string name;
  SolverOptions options;
  const std::vector<std::string> keywords = {"name", "options", "level"};
  while (true) {
    reader.need_line("'level'");
    const std::string word = reader.need_one_of(keywords);
    if (word == "level") break;
    if (word == "name") name = in_one_line(std::string(reader.rest_of_line()));
    if (word == "options") options = parse_options(reader);
  }
  const std::vector<ParsedRow> rows = parse_levels(reader, n, levels);
  RecordedProblem recorded = {make_problem(n, levels, rows), options, {}, name};

  reader.need_line("'end'");
  if (reader.need_one_of({"guess", "end"}) == "guess") {
    recorded.guess = parse_guess(reader, recorded.problem.rows());
    reader.need_line("'end'");
    reader.need_one_of({"end"});
  }
  reader.need_end_of_line();
  return recorded;
}

void enlarge(Capacity& capacity, const Problem& problem) {
  capacity.variables = std::max(capacity.variables, problem.variables());
  capacity.levels = std::max(capacity.levels, problem.levels());
  capacity.rows = std::max(capacity.rows, problem.rows());
}

bool has_one_bound(const Problem& problem, int row) {
  const auto [lb, ub] = problem.bounds(row);
  return std::bit_cast<std::uint64_t>(lb) == std::bit_cast<std::uint64_t>(ub);
}

void write_row(std::ostream& out, const Problem& problem, int row, bool is_equality) {
  const std::span<const double> coefficients = problem.coefficients(row);
  for (int i = 0; i < problem.variables(); ++i) {
    const double coefficient =
        problem.variable(row) < 0 ? coefficients[i] : (problem.variable(row) == i ? 1.0 : 0.0);
    out << to_text(coefficient) << ' ';
  }
  out << to_text(problem.bounds(row).lb);
  if (!is_equality) out << ' ' << to_text(problem.bounds(row).ub);
  if (problem.weight(row) != 1.0) out << " weight " << to_text(problem.weight(row));
  if (problem.variable(row) < 0 && single_variable(coefficients) >= 0) out << " dense";
  if (broken_rule(problem, row) != nullptr) out << " bad";
  out << '\n';
}

void write_name(std::ostream& out, const std::string& name) {
  const std::string line = in_one_line(name);
  if (!line.empty()) out << "name " << line << '\n';
}

void write_options(std::ostream& out, const SolverOptions& options) {
  const SolverOptions standard;
  std::string text;
  if (options.max_iterations != standard.max_iterations) {
    text += " max_iterations " + std::to_string(options.max_iterations);
  }
  if (options.budget != standard.budget) text += " budget " + std::to_string(options.budget);
  if (options.minimum_norm != standard.minimum_norm) {
    text += std::string(" minimum_norm ") + (options.minimum_norm ? "1" : "0");
  }
  for (const auto& [name, member] : kTolerances) {
    if (options.*member == standard.*member) continue;
    text.append(" ").append(name).append(" ").append(to_text(options.*member));
  }
  if (!text.empty()) out << "options" << text << '\n';
}

std::string letters_of(const States& states, int rows) {
  std::string letters;
  for (int row = 0; row < rows; ++row) {
    letters += kStateLetters[index(states[row])];
  }
  return letters;
}

void write_guess(std::ostream& out, const ActiveSet& guess, int rows) {
  const std::string before = letters_of(guess.before, rows);
  out << "guess " << letters_of(guess.state, rows);
  if (before.find_first_not_of(kStateLetters[0]) != std::string::npos) out << ' ' << before;
  out << '\n';
}

void write_level(std::ostream& out, const Problem& problem, int level) {
  const int first = problem.first_row(level);
  const int end = problem.end_row(level);
  int first_inequality = first;
  while (first_inequality < end && has_one_bound(problem, first_inequality)) ++first_inequality;
  out << "level " << first_inequality - first << ' ' << end - first_inequality << '\n';
  for (int row = first; row < end; ++row) {
    write_row(out, problem, row, row < first_inequality);
  }
}

}  // namespace

std::vector<RecordedProblem> parse_recorded_problems(std::string_view text,
                                                     const std::string& name) {
  Reader reader(text, name);
  std::vector<RecordedProblem> problems;
  while (reader.next_line()) problems.push_back(parse_recorded(reader));
  if (problems.empty()) reader.fail("'hqp'", "an empty file");
  return problems;
}

std::vector<Problem> parse_problems(std::string_view text, const std::string& name) {
  std::vector<Problem> problems;
  for (RecordedProblem& recorded : parse_recorded_problems(text, name)) {
    problems.push_back(std::move(recorded.problem));
  }
  return problems;
}

std::string read_text(const std::string& file) {
  OpenFile opened = open_to_read(file);
  const gzFile handle = gzdopen(opened.descriptor(), "rb");
  if (handle == nullptr) throw SetupError(file + ": cannot be read: out of memory");
  opened.release();  // closed with the handle
  std::string text;
  std::vector<char> buffer(1 << 16);
  int count = 0;
  while ((count = gzread(handle, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0) {
    text.append(buffer.data(), count);
  }
  const bool is_complete = gzclose(handle) == Z_OK && count == 0;
  if (!is_complete) throw SetupError(file + ": is damaged");
  return text;
}

std::vector<RecordedProblem> read_recorded_problems(const std::string& file) {
  return parse_recorded_problems(read_text(file), file);
}

std::vector<Problem> read_problems(const std::string& file) {
  return parse_problems(read_text(file), file);
}

Capacity capacity_for(std::span<const Problem> problems) {
  Capacity capacity = {.variables = 1, .levels = 1, .rows = 1};
  for (const Problem& problem : problems) enlarge(capacity, problem);
  return capacity;
}

Capacity capacity_for(std::span<const RecordedProblem> problems) {
  Capacity capacity = {.variables = 1, .levels = 1, .rows = 1};
  for (const RecordedProblem& recorded : problems) enlarge(capacity, recorded.problem);
  return capacity;
}

void write_problem(std::ostream& out, const RecordedProblem& recorded) {
  check_solver_options(recorded.options);
  const Problem& problem = recorded.problem;
  out << "hqp " << problem.variables() << ' ' << problem.levels() << '\n';
  write_name(out, recorded.name);
  write_options(out, recorded.options);
  for (int level = 0; level < problem.levels(); ++level) write_level(out, problem, level);
  if (recorded.guess) write_guess(out, *recorded.guess, problem.rows());
  out << "end\n";
}

void write_problem(std::ostream& out, const Problem& problem) {
  write_problem(out, RecordedProblem{.problem = problem});
}

}  // namespace hg::hqp
