#include "hg/config/read_chain.h"

#include "hg/core/error.h"
#include "hg/model/urdf.h"

namespace hg::config {

std::optional<UrdfText> read_urdf(LoaderFile& file, const std::filesystem::path& urdf) {
  file.knows_names = false;
  if (urdf.empty()) return {};
  try {
    UrdfText result = {urdf, file.sources.read(urdf), {}};
    for (const model::UrdfLink& link :
         model::read_urdf_text(result.text, urdf.generic_string()).links) {
      result.link_names.push_back(link.name);
    }
    file.knows_names = true;
    return result;
  } catch (const SetupError& error) {
    file.faults.add_complete(error.what());
    return {};
  }
}

std::optional<model::Chain> no_chain(LoaderFile& file) {
  file.knows_names = false;
  return {};
}

std::string name_of(const std::vector<std::string>& names, int index) {
  return index < 0 ? "" : names[static_cast<std::size_t>(index)];
}

std::optional<model::Chain> read_chain(LoaderFile& file, const UrdfText& urdf,
                                       const model::ChainOptions& options) {
  try {
    return model::Chain::from_urdf_text(urdf.text, urdf.file.generic_string(), options);
  } catch (const SetupError& error) {
    file.faults.add_complete(error.what());
    return no_chain(file);
  }
}

}  // namespace hg::config
