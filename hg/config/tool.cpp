#include "hg/config/tool.h"

#include "hg/config/loader.h"
#include "hg/config/tool_schema.h"
#include "hg/core/error.h"

namespace hg::config {

Tool load_tool(const std::filesystem::path& path, SourceReader& reader) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  ToolDraft draft;
  load_file(file, [&](Loader& loader) {
    describe(loader, draft);
    if (file.faults.count() > 0) return;
    if (draft.mass == 0.0) {
      loader.rule(draft.inertia.isZero(), "inertia_kg_m2", "a tool without mass has no inertia");
      return;
    }
    try {
      model::check_inertial({draft.mass, draft.centre_of_mass, draft.inertia}, "tool");
    } catch (const SetupError& error) {
      loader.rule(false, "inertia_kg_m2", error.what());
    }
  });
  return {.name = draft.name,
          .body = {.T_link_handle = pose_of(draft.handle),
                   .mass = draft.mass,
                   .p_com = draft.centre_of_mass,
                   .inertia = draft.inertia},
          .T_H_S = pose_of(draft.sensor),
          .has_dead_man = draft.has_dead_man};
}

}  // namespace hg::config
