/// Problems as text: what the solver is given can be dumped, mailed, and solved again.
///
/// One problem after another, in a plain or gzipped file; numbers in full precision, `inf` allowed:
///   hqp <n> <levels>
///   level <m_eq> <m_iq>
///   <m_eq lines: n coefficients, then b>
///   <m_iq lines: n coefficients, then lb, then ub>
///   ... next level
///   end
/// Set-up code: allocates, and throws SetupError with "file:line: what was expected".
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "hg/hqp/problem.h"

namespace hg::hqp {

/// All problems in `text`; `name` stands for the file in messages. Rows with one coefficient, of
/// value 1, become bounds on that variable; ids are given in the order of the text.
std::vector<Problem> parse_problems(std::string_view text, const std::string& name);

/// All problems of a file, which may be gzipped.
std::vector<Problem> read_problems(const std::string& file);

/// Writes one problem so that parse_problems() reads the same one, up to weights: these are
/// multiplied into rows and bounds. Ids stay the same, so equalities that do not come first in
/// their level are written as lb = ub.
void write_problem(std::ostream& out, const Problem& problem);

/// Content of a plain or gzipped file. Throws SetupError when it cannot be read.
std::string read_text(const std::string& file);

}  // namespace hg::hqp
