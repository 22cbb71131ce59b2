/// Parallel execution of independent tasks on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace hg::experiments {

/// Callback that reports from time to time how many tasks are done; called by one thread at a time.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Calls work(i) once for every i < count, from as many threads as there are cores, and returns
/// when all is done. The first exception ends it and is thrown again.
void do_all(std::size_t count, const std::function<void(std::size_t)>& work,
            const Progress& progress);

}  // namespace hg::experiments
