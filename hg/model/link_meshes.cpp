#include "hg/model/link_meshes.h"

#include <tinyxml2.h>

#include <sstream>

#include "hg/model/urdf_vectors.h"

namespace hg::model {
namespace {

using tinyxml2::XMLElement;

Eigen::Vector3d vector3(const XMLElement* e, const char* key, const Eigen::Vector3d& otherwise) {
  const char* text = e == nullptr ? nullptr : e->Attribute(key);
  if (text == nullptr) return otherwise;
  Eigen::Vector3d value = otherwise;
  std::istringstream(text) >> value.x() >> value.y() >> value.z();
  return value;
}

Pose origin(const XMLElement& shape) {
  const XMLElement* e = shape.FirstChildElement("origin");
  const Eigen::Vector3d rpy = vector3(e, "rpy", Eigen::Vector3d::Zero());
  Pose pose;
  pose.p = vector3(e, "xyz", Eigen::Vector3d::Zero());
  pose.R = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
               .toRotationMatrix();
  return pose;
}

void add_meshes(const XMLElement& link, const char* kind, std::vector<LinkMesh>& meshes) {
  for (auto* e = link.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
    const XMLElement* geometry = e->FirstChildElement("geometry");
    const XMLElement* mesh = geometry ? geometry->FirstChildElement("mesh") : nullptr;
    if (mesh == nullptr || mesh->Attribute("filename") == nullptr) continue;
    LinkMesh& added = meshes.emplace_back(LinkMesh{.link = link.Attribute("name", nullptr),
                                                   .name = mesh->Attribute("filename"),
                                                   .T_link_mesh = origin(*e),
                                                   .fault = {}});
    const char* text = mesh->Attribute("scale");
    if (text == nullptr) continue;
    const std::optional<Eigen::Vector3d> scale = vector3_of(text);
    if (scale) {
      added.scale = *scale;
    } else {
      added.fault = std::to_string(mesh->GetLineNum()) + ": link " + added.link +
                    ": <mesh> scale must be three numbers, got '" + text + "'";
    }
  }
}

}  // namespace

std::vector<LinkMesh> link_meshes(const std::string& urdf) {
  std::vector<LinkMesh> meshes;
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) return meshes;
  const XMLElement* robot = document.RootElement();
  for (auto* e = robot->FirstChildElement("link"); e; e = e->NextSiblingElement("link")) {
    if (e->Attribute("name") == nullptr) continue;
    const bool has_collision = e->FirstChildElement("collision") != nullptr;
    add_meshes(*e, has_collision ? "collision" : "visual", meshes);
  }
  return meshes;
}

}  // namespace hg::model
