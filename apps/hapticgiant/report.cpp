#include "apps/hapticgiant/report.h"

#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/figure_program.h"
#include "apps/hapticgiant/output_file.h"
#include "hg/core/open_file.h"

namespace hg::apps {

std::string report_text(const std::filesystem::path& folder, const nlohmann::ordered_json& results,
                        const char* name) {
  write_output((folder / "results.json").string(), results.dump() + "\n");
  write_report(folder, "");
  return read_file(folder / name);
}

}  // namespace hg::apps
