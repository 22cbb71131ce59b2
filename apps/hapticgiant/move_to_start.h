/// `hapticgiant run --move-to-start`: the way of a remote device to where the twin starts.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/prepared_run.h"
#include "hg/page/run_page.h"

namespace hg::apps {

constexpr int kNotThere = 3;  ///< exit code of a run whose device has not come to the start

/// Whether the run begins with such a way, by the law; a Franka moves by a motion of its own.
bool moves_by_law(const RunArguments& arguments);

/// Prepares the way of the run from where its device stands. Throws SetupError, also when the
/// device cannot be at the start of the twin.
std::unique_ptr<PreparedRun> prepare_way(const RunArguments& arguments);

/// Plays the way to its end, and releases the device. Returns why it is not there; empty = it is.
std::string move_to_start(PreparedRun& way, const std::atomic<bool>& interrupted,
                          const BackgroundOutput& output, page::RunPage* page);

/// Ends the session with a remote device, and prints its message.
void close_device(device::ConnectedDevice& device, const Fault& fault);

}  // namespace hg::apps
