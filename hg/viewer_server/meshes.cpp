#include "hg/viewer_server/meshes.h"

#include <algorithm>
#include <utility>

#include "hg/core/mesh_file.h"
#include "hg/core/open_file.h"

namespace hg::viewer_server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMesh = "<mesh";
constexpr std::string_view kAttribute = "filename=";

// file that a URDF refers to by `name`; empty when there is none that a page can draw
fs::path find_drawable(const fs::path& urdf, std::string_view name) {
  const fs::path file = find_mesh(urdf, name);
  const std::string extension = file.extension().string();
  const bool is_drawable = extension == ".stl" || extension == ".STL" || extension == ".dae";
  return is_drawable ? file : fs::path();
}

// a name of a mesh in the text of a URDF
struct MeshName {
  std::size_t begin = 0, end = 0;
};

std::vector<MeshName> mesh_names(const std::string& text) {
  std::vector<MeshName> names;
  for (std::size_t mesh = text.find(kMesh); mesh != std::string::npos;
       mesh = text.find(kMesh, mesh + 1)) {
    const std::size_t attribute = text.find(kAttribute, mesh);
    if (attribute == std::string::npos || attribute > text.find('>', mesh)) continue;
    const std::size_t quote = attribute + kAttribute.size();
    const std::size_t begin = quote + 1;
    if (begin >= text.size()) break;
    const std::size_t end = text.find(text[quote], begin);
    if (end == std::string::npos) break;
    names.push_back({begin, end});
  }
  return names;
}

}  // namespace

std::string with_meshes(const fs::path& urdf, const std::string& text, std::string_view folder,
                        AssetTable& assets, MeshAddresses& addresses) {
  std::string served;
  std::size_t copied = 0;
  for (const auto& [begin, end] : mesh_names(text)) {
    const std::string name = text.substr(begin, end - begin);
    const auto [known, is_new] = addresses.try_emplace(name, name);
    const fs::path file = is_new ? find_drawable(urdf, name) : fs::path();
    if (!file.empty()) {
      const std::string extension = file.extension() == ".dae" ? ".dae" : ".stl";
      known->second = std::string(folder) + std::to_string(addresses.size()) + extension;
      assets[known->second] = {"application/octet-stream", live::to_bytes(read_file(file))};
    }
    served.append(text, copied, begin - copied).append(known->second);
    copied = end;
  }
  return served.append(text, copied);
}

std::vector<std::string> missing_meshes(const fs::path& urdf, const std::string& text) {
  std::vector<std::string> missing;
  for (const auto& [begin, end] : mesh_names(text)) {
    std::string name = text.substr(begin, end - begin);
    const bool is_known = std::ranges::find(missing, name) != missing.end();
    if (!is_known && find_drawable(urdf, name).empty()) missing.push_back(std::move(name));
  }
  return missing;
}

}  // namespace hg::viewer_server
