/// `hapticgiant export`: a recording as a table for other tools.
#pragma once

namespace hg::apps {

class Command;

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_export(Command app, int& exit_code);

}  // namespace hg::apps
