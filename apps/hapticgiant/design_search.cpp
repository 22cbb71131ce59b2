#include "apps/hapticgiant/design_search.h"

#include <vector>

#include "apps/hapticgiant/python_program.h"
#include "hg/core/error.h"

namespace hg::apps {

void add_design_search(CLI::App& app) {
  const std::vector<CLI::App*> known =
      app.get_subcommands([](const CLI::App* it) { return it->get_name() == "design"; });
  CLI::App* design = known.empty() ? app.add_subcommand("design",
                                                        "From requirements to a device that runs "
                                                        "(docs/start/design.md).")
                                   : known.front();
  design->require_subcommand(0, 1);
  design->allow_extras();
  design->callback([design] {
    if (!design->get_subcommands().empty()) return;
    if (design->remaining().empty()) {
      throw SetupError(
          "design: expected the file of a problem, such as "
          "models/design/haptic_giant.yaml, or arm or measure");
    }
    become_python_program("design", design->remaining());
  });
}

}  // namespace hg::apps
