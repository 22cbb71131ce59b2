#include "hg/config/read_chain.h"

#include "hg/core/error.h"

namespace hg::config {

model::Chain read_chain(LoaderFile& file, const std::filesystem::path& urdf,
                        const model::ChainOptions& options) {
  if (!urdf.empty()) {
    try {
      return model::Chain::from_urdf_text(file.sources.read(urdf), urdf.generic_string(), options);
    } catch (const SetupError& error) {
      file.faults.add_complete(error.what());
    }
  }
  file.faults.throw_if_any();
  throw SetupError(file.path.generic_string() + ": a chain needs a URDF");
}

}  // namespace hg::config
