/// `hapticgiant design`: what a human arm can do, and how well a device serves it.
#pragma once

namespace hg::apps {

class Command;

/// Adds `design arm` and `design measure` to the program.
void add_design(Command app, int& exit_code);

}  // namespace hg::apps
