#include "hg/hqp/text.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>

#include "hg/core/error.h"

namespace hg::hqp {
namespace {

// Splits a text into lines and the current line into words.
class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// Goes to the next line that is not blank; false at the end of the text.
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

  /// As next_line(), where a line must come.
  void need_line(const std::string& expected) {
    if (!next_line()) fail(expected, "the end of the file");
  }

  void need_word(std::string_view expected) {
    const std::string_view word = next_word();
    if (word != expected) fail(describe(expected), describe(word));
  }

  int need_integer(const char* meaning, int min, int max) {
    const std::string_view word = next_word();
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = error == std::errc() && end == word.data() + word.size();
    if (word.empty() || !is_number || value < min || value > max) {
      fail(std::string(meaning) + " of " + std::to_string(min) + ".." + std::to_string(max),
           describe(word));
    }
    return value;
  }

  double need_number(int position, int count) {
    const std::string_view word = next_word();
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = error == std::errc() && end == word.data() + word.size();
    if (word.empty() || !is_number || std::isnan(value)) {
      fail("number " + std::to_string(position) + " of " + std::to_string(count), describe(word));
    }
    return value;
  }

  void need_end_of_line() {
    const std::string_view word = next_word();
    if (!word.empty()) fail("the end of the line", describe(word));
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& got) const {
    throw SetupError(name_ + ":" + std::to_string(line_number_) + ": expected " + expected +
                     ", got " + got);
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r";

  std::string_view next_word() {
    const std::size_t begin = line_.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    line_.remove_prefix(begin);
    const std::string_view word = line_.substr(0, line_.find_first_of(kBlanks));
    line_.remove_prefix(word.size());
    return word;
  }

  static std::string describe(std::string_view word) {
    return word.empty() ? "the end of the line" : std::string("'").append(word).append("'");
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
};

ParsedRow parse_row(Reader& reader, int level, int n, bool is_equality) {
  reader.need_line("a row of " + std::string(is_equality ? "an equality" : "an inequality"));
  const int count = n + (is_equality ? 1 : 2);
  ParsedRow row = {level, std::vector<double>(static_cast<std::size_t>(n)), {}};
  int position = 0;
  for (double& coefficient : row.coefficients) {
    coefficient = reader.need_number(++position, count);
    if (!std::isfinite(coefficient)) reader.fail("a finite coefficient", "an infinite one");
  }
  row.bounds.lb = reader.need_number(++position, count);
  row.bounds.ub = is_equality ? row.bounds.lb : reader.need_number(++position, count);
  reader.need_end_of_line();
  if (row.bounds.empty()) {
    reader.fail("lb <= ub", std::to_string(row.bounds.lb) + " > " + std::to_string(row.bounds.ub));
  }
  if (row.bounds.lb == kInfinity || row.bounds.ub == -kInfinity) {
    reader.fail("a bound that can be met", "one at infinity");
  }
  return row;
}

// Index of the only coefficient if that is 1, else -1.
int single_variable(const std::vector<double>& coefficients) {
  int variable = -1;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] == 0.0) continue;
    if (coefficients[i] != 1.0 || variable >= 0) return -1;
    variable = static_cast<int>(i);
  }
  return variable;
}

// The line with `hqp` has been reached.
Problem parse_problem(Reader& reader) {
  reader.need_word("hqp");
  const int n = reader.need_integer("a number of variables", 1, kMaxVariables);
  const int levels = reader.need_integer("a number of levels", 1, kMaxLevels);
  reader.need_end_of_line();

  std::vector<ParsedRow> rows;
  for (int level = 0; level < levels; ++level) {
    reader.need_line("'level'");
    reader.need_word("level");
    const int free = kMaxRows - static_cast<int>(rows.size());
    const int equalities = reader.need_integer("a number of equalities", 0, free);
    const int inequalities = reader.need_integer("a number of inequalities", 0, free - equalities);
    reader.need_end_of_line();
    for (int i = 0; i < equalities; ++i) rows.push_back(parse_row(reader, level, n, true));
    for (int i = 0; i < inequalities; ++i) rows.push_back(parse_row(reader, level, n, false));
  }
  reader.need_line("'end'");
  reader.need_word("end");
  reader.need_end_of_line();

  Problem problem({n, levels, std::max(1, static_cast<int>(rows.size()))});
  std::size_t next = 0;
  for (int level = 0; level < levels; ++level) {
    problem.add_level();
    for (; next < rows.size() && rows[next].level == level; ++next) {
      const ParsedRow& row = rows[next];
      const int variable = single_variable(row.coefficients);
      if (variable >= 0) {
        problem.add_bound(variable, row.bounds);
      } else {
        problem.add_row(row.coefficients, row.bounds);
      }
    }
  }
  return problem;
}

void write_number(std::ostream& out, double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
  out.write(text, end - text);
}

void write_row(std::ostream& out, const Problem& problem, int row, bool is_equality) {
  const double weight = problem.weight(row);
  for (int i = 0; i < problem.variables(); ++i) {
    const double coefficient = problem.variable(row) < 0
                                   ? problem.coefficients(row)[static_cast<std::size_t>(i)]
                                   : (problem.variable(row) == i ? 1.0 : 0.0);
    write_number(out, weight * coefficient);
    out << ' ';
  }
  write_number(out, weight * problem.bounds(row).lb);
  if (!is_equality) {
    out << ' ';
    write_number(out, weight * problem.bounds(row).ub);
  }
  out << '\n';
}

}  // namespace

std::vector<Problem> parse_problems(std::string_view text, const std::string& name) {
  Reader reader(text, name);
  std::vector<Problem> problems;
  while (reader.next_line()) problems.push_back(parse_problem(reader));
  if (problems.empty()) reader.fail("'hqp'", "an empty file");
  return problems;
}

std::string read_text(const std::string& file) {
  const gzFile handle = gzopen(file.c_str(), "rb");
  if (handle == nullptr) throw SetupError(file + ": cannot be opened for reading");
  std::string text;
  std::vector<char> buffer(1 << 16);
  int count = 0;
  while ((count = gzread(handle, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  const bool is_complete = gzclose(handle) == Z_OK && count == 0;
  if (!is_complete) throw SetupError(file + ": is damaged, or not a file");
  return text;
}

std::vector<Problem> read_problems(const std::string& file) {
  return parse_problems(read_text(file), file);
}

void write_problem(std::ostream& out, const Problem& problem) {
  const auto is_equality = [&](int row) {
    return problem.bounds(row).lb == problem.bounds(row).ub;
  };
  out << "hqp " << problem.variables() << ' ' << problem.levels() << '\n';
  for (int level = 0; level < problem.levels(); ++level) {
    const int first = problem.first_row(level);
    const int end = problem.end_row(level);
    int first_inequality = first;
    while (first_inequality < end && is_equality(first_inequality)) ++first_inequality;
    out << "level " << first_inequality - first << ' ' << end - first_inequality << '\n';
    for (int row = first; row < end; ++row) {
      write_row(out, problem, row, row < first_inequality);
    }
  }
  out << "end\n";
}

}  // namespace hg::hqp
