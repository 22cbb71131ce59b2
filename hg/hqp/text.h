/// Problems as text: solver inputs can be dumped, mailed, and solved again.
///
/// One problem after another, in a plain or gzipped file; numbers in full precision, `inf` allowed:
///   hqp <n> <levels>
///   name <text>                                     where it comes from     (optional)
///   options <member of SolverOptions> <value> ...         those not at default    (optional)
///   level <m_eq> <m_iq>
///   <m_eq lines: n coefficients, then b>
///   <m_iq lines: n coefficients, then lb, then ub>
///   ... next level
///   guess <state> <before>                          of an ActiveSet         (optional)
///   end
/// A row with one coefficient, of value 1, is a bound on that variable. After the numbers of a row
/// there may be
///   weight <w>   of its slack, default 1
///   dense        a row of add_row() although it has one coefficient, of value 1
///   bad          deliberately invalid content that the solver refuses; an error without this word
/// Guesses have a letter per row: .lu=<> in the order of RowState; `before` may be left out.
/// Set-up code: allocates, and throws SetupError with "file:line: what was expected".
#pragma once

#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

/// A problem with all inputs of its solve: gives the same bits again.
struct RecordedProblem {
  Problem problem;
  SolverOptions options = {};
  std::optional<ActiveSet> guess = {};  ///< initial guess of the solve; none = nothing is known
  std::string name = {};                ///< origin of the problem, one line
};

/// All problems in `text`; `name` stands for the file in messages. Row ids follow the order of the
/// text.
std::vector<RecordedProblem> parse_recorded_problems(std::string_view text,
                                                     const std::string& name);
/// Parses all problems in `text`, without options, guesses and names.
std::vector<Problem> parse_problems(std::string_view text, const std::string& name);

/// Reads all problems of a plain or gzipped file.
std::vector<RecordedProblem> read_recorded_problems(const std::string& file);
std::vector<Problem> read_problems(const std::string& file);

/// Smallest capacity that holds each of the problems; all sizes 1 without problems.
Capacity capacity_for(std::span<const Problem> problems);
Capacity capacity_for(std::span<const RecordedProblem> problems);

/// Writes one problem so that the same one is read back, bit for bit. Ids stay the same, so
/// equalities that do not come first in their level are written as lb = ub. Line breaks and other
/// control characters of a name become blanks. Throws SetupError, see check_solver_options(), and
/// then writes nothing.
void write_problem(std::ostream& out, const RecordedProblem& recorded);
void write_problem(std::ostream& out, const Problem& problem);

/// Reads the content of a plain or gzipped file. Throws SetupError when it cannot be read.
std::string read_text(const std::string& file);

}  // namespace hg::hqp
