/// What must be right with this computer before it drives a machine: the doctor's bad lines.
#pragma once

#include <string>
#include <vector>

#include "hg/doctor/assessment.h"
#include "hg/runtime/control_thread.h"

namespace hg::doctor {

/// Throws SetupError for a name in `despite` that is no item of the doctor, with the nearest one.
void check_items(const std::vector<std::string>& despite);

/// Decides by lines of an assessment. Items named in `despite` are let pass, also where they are
/// fine. Returns what was let pass, in words; empty: nothing. Throws SetupError with every other
/// bad line.
std::string decide(const std::vector<Assessment>& lines, const std::vector<std::string>& despite);

/// Assesses this computer, and for a second and a half how late a thread with these options wakes
/// up at `rate_Hz` (item "lateness"); then decides.
std::string check_ready(double rate_Hz, const runtime::ThreadOptions& thread,
                        const std::vector<std::string>& despite);

}  // namespace hg::doctor
