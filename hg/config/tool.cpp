#include "hg/config/tool.h"

#include "hg/config/file_kind.h"
#include "hg/config/loader.h"
#include "hg/config/tool_schema.h"
#include "hg/core/error.h"

namespace hg::config {

Tool load_tool(const std::filesystem::path& path, SourceReader& reader) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  Tool tool;
  load_file_of_kind(FileKind::kTool, file, [&](Loader& loader) {
    describe(loader, tool);
    if (file.faults.count() > 0) return;
    if (tool.body.mass == 0.0) {
      loader.rule(tool.body.inertia.isZero(), "inertia_kg_m2",
                  "a tool without mass has no inertia");
      return;
    }
    try {
      model::check_inertial({tool.body.mass, tool.body.p_com, tool.body.inertia}, "tool");
    } catch (const SetupError& error) {
      loader.rule(false, "inertia_kg_m2", error.what());
    }
  });
  return tool;
}

}  // namespace hg::config
