#include "hg/config/read_chain.h"

#include "hg/core/error.h"

namespace hg::config {
namespace {

[[noreturn]] void fail(LoaderFile& file, const std::string& message) {
  file.faults.add_complete(message);
  file.faults.throw_if_any();
  throw SetupError(message);
}

}  // namespace

std::string read_urdf(LoaderFile& file, const std::filesystem::path& urdf) {
  if (urdf.empty()) file.faults.throw_if_any();
  try {
    return file.sources.read(urdf);
  } catch (const SetupError& error) {
    fail(file, error.what());
  }
}

model::Chain parse_chain(LoaderFile& file, const std::filesystem::path& urdf,
                         const std::string& text, const model::ChainOptions& options) {
  try {
    return model::Chain::from_urdf_text(text, urdf.generic_string(), options);
  } catch (const SetupError& error) {
    fail(file, error.what());
  }
}

model::Chain read_chain(LoaderFile& file, const std::filesystem::path& urdf,
                        const model::ChainOptions& options) {
  return parse_chain(file, urdf, read_urdf(file, urdf), options);
}

}  // namespace hg::config
