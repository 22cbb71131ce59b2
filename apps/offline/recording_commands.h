/// `hapticgiant plot FILE...` and `hapticgiant compare A B`: what recordings show.
#pragma once

namespace hg::apps {

class Command;

/// Adds the commands plot and compare to the program. Exit code of plot: 0, also without figures;
/// of compare: 0 when nothing but timing differs, otherwise 1.
void add_plot_and_compare(Command app, int& exit_code);

}  // namespace hg::apps
