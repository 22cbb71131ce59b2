/// `hapticgiant plot FILE...` and `hapticgiant compare A B`: what recordings show.
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds the commands plot and compare to the program. Exit code of plot: 0, also without figures;
/// of compare: 0 when nothing but timing differs, otherwise 1.
void add_plot_and_compare(CLI::App& app, int& exit_code);

}  // namespace hg::apps
