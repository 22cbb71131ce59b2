#include "hg/model/urdf_vectors.h"

#include <tinyxml2.h>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace hg::model {
namespace {

using tinyxml2::XMLElement;

// Looks at `e` and all that it contains.
void collect(const XMLElement& e, const std::string& kind, const std::string& name,
             UrdfVectors& found) {
  const auto take = [&](const char* element, const char* key, std::vector<UrdfVector>& list) {
    const char* text = e.Attribute(key);
    if (text == nullptr || std::string_view(e.Name()) != element) return;
    list.push_back({kind, name, e.GetLineNum(), text, vector3_of(text)});
  };
  take("origin", "rpy", found.turns);
  take("mesh", "scale", found.scales);
  for (auto* child = e.FirstChildElement(); child; child = child->NextSiblingElement()) {
    collect(*child, kind, name, found);
  }
}

}  // namespace

std::optional<Eigen::Vector3d> vector3_of(const std::string& text) {
  Eigen::Vector3d values;
  Eigen::Index count = 0;
  std::istringstream words(text);
  for (std::string word; words >> word; ++count) {
    const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (count == 3 || error != std::errc() || stop != end || !std::isfinite(value)) return {};
    values[count] = value;
  }
  if (count != 3) return {};
  return values;
}

UrdfVectors urdf_vectors(const std::string& urdf) {
  UrdfVectors found;
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) return found;
  const XMLElement* robot = document.RootElement();
  for (auto* e = robot->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind != "link" && kind != "joint") continue;
    const char* name = e->Attribute("name");
    collect(*e, kind, name == nullptr ? "" : name, found);
  }
  return found;
}

}  // namespace hg::model
