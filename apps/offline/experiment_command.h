/// `hapticgiant experiment NAME`: the paper's experiments, and how the simulated device feels at
/// the handle.
#pragma once

namespace hg::apps {

class Command;

/// Adds the subcommands to the program; running it sets `exit_code`: 0, 1 when a run ended in a
/// fault or left a limit, and those of paper_experiment_command.h.
void add_experiment(Command app, int& exit_code);

}  // namespace hg::apps
