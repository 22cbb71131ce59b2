/// `hapticgiant design`: what a human arm can do, and how well a device serves it.
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds `design arm` and `design measure` to the program.
void add_design(CLI::App& app);

}  // namespace hg::apps
