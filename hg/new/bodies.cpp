#include "hg/new/bodies.h"

#include <coal/distance.h>
#include <coal/mesh_loader/loader.h>
#include <coal/shape/geometric_shapes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/mesh_file.h"
#include "hg/core/open_file.h"
#include "hg/model/link_meshes.h"

namespace hg::new_files {
namespace {

constexpr double kLongestEdge = 0.02;  // m, of the triangles that are shared out

// the triangles of a file, in the frame of the link; empty when it cannot be read
std::vector<Triangle> read_mesh(const std::filesystem::path& file, const model::LinkMesh& mesh) {
  std::vector<Triangle> triangles;
  if (file.empty()) return triangles;
  coal::BVHModelPtr_t loaded;
  try {
    loaded = coal::MeshLoader().load(file.string(), mesh.scale);
  } catch (const std::exception&) {
    return triangles;
  }
  if (!loaded || !loaded->vertices || !loaded->tri_indices) return triangles;
  const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
    return mesh.T_link_mesh.R * (*loaded->vertices)[i] + mesh.T_link_mesh.p;
  };
  for (const coal::Triangle& t : *loaded->tri_indices) {
    const Triangle triangle = {corner(t[0]), corner(t[1]), corner(t[2])};
    if ((triangle[0] + triangle[1] + triangle[2]).allFinite()) triangles.push_back(triangle);
  }
  return triangles;
}

// a primitive as triangles that lie on it or outside
std::vector<Triangle> triangles_of(const model::UrdfCollision& element) {
  constexpr int kSides = 24;
  const bool is_box = element.shape == model::UrdfShape::kBox;
  const bool is_ball = element.shape == model::UrdfShape::kSphere;
  const double outside = is_box ? 1.0 : 1.0 / std::cos(M_PI / kSides);
  const double height = is_ball ? element.size.x() : 0.5 * element.size[is_box ? 2 : 1];
  // profiles (radius, height) of the rings of a prism, or of a ball between the tangent ones
  std::vector<std::pair<double, double>> rings = {{1.0, -height}, {1.0, height}};
  if (is_ball) {
    const double t = std::tan(M_PI / 8.0);
    rings = {{t, -height}, {1.0, -t * height}, {1.0, t * height}, {t, height}};
  }
  const auto corner = [&](std::size_t ring, int side) -> Eigen::Vector3d {
    const auto [radius, z] = rings[ring];
    const double angle = 2.0 * M_PI * side / kSides;
    Eigen::Vector3d p(std::cos(angle), std::sin(angle), 0.0);
    if (is_box) {
      const bool is_left = side % 4 == 1 || side % 4 == 2;
      p = {is_left ? -0.5 * element.size.x() : 0.5 * element.size.x(),
           side % 4 > 1 ? -0.5 * element.size.y() : 0.5 * element.size.y(), 0.0};
    } else {
      p *= element.size.x() * outside * radius;
    }
    p.z() = z;
    return element.T_link_shape.R * p + element.T_link_shape.p;
  };
  std::vector<Triangle> triangles;
  const int sides = is_box ? 4 : kSides;
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
    for (int k = 0; k < sides; ++k) {
      triangles.push_back({corner(ring, k), corner(ring, k + 1), corner(ring + 1, k)});
      triangles.push_back({corner(ring + 1, k), corner(ring, k + 1), corner(ring + 1, k + 1)});
    }
  }
  for (const std::size_t end : {std::size_t{0}, rings.size() - 1}) {
    for (int k = 1; k + 1 < sides; ++k) {
      triangles.push_back({corner(end, 0), corner(end, k), corner(end, k + 1)});
    }
  }
  return triangles;
}

// where the links are: the shapes of a URDF in which each link is a ball of its name
std::vector<collision::Shape> places_of_links(model::Urdf urdf, const model::ChainModel& chain) {
  for (model::UrdfLink& link : urdf.links) {
    link.collisions = {{.name = link.name,
                        .T_link_shape = {},
                        .shape = model::UrdfShape::kSphere,
                        .size = Eigen::Vector3d::Constant(0.01)}};
  }
  return collision::read_geometry(urdf, chain).shapes;
}

// Adds triangles in the frame `from` of the chain, which stands in any posture, to the body.
void add(const std::vector<Triangle>& triangles, int from, const model::ChainData& chain,
         Body& body) {
  const Pose at = pose_of(chain, from), to = pose_of(chain, body.frame);
  for (Triangle t : triangles) {
    for (Eigen::Vector3d& p : t) p = to.R.transpose() * (at.R * p + at.p - to.p);
    body.triangles.push_back(t);
  }
}

// the body that the shape belongs to, added if it is not there
Body& body_at(const collision::Shape& place, std::vector<Body>& bodies) {
  const auto known = std::ranges::find(bodies, place.body, &Body::joints);
  if (known != bodies.end()) return *known;
  Body& added = bodies.emplace_back();
  added.link = place.name;
  added.frame = place.frame;
  added.joints = place.body;
  return added;
}

std::shared_ptr<const MeshModel> mesh_of(const std::vector<Triangle>& triangles) {
  auto mesh = std::make_shared<MeshModel>();
  mesh->beginModel(static_cast<unsigned>(triangles.size()),
                   static_cast<unsigned>(3 * triangles.size()));
  for (const Triangle& t : triangles) mesh->addTriangle(t[0], t[1], t[2]);
  mesh->endModel();
  mesh->computeLocalAABB();
  return mesh;
}

Part part_of(std::vector<Triangle> triangles, Body& body) {
  Part part = {.number = body.parts_made++,
               .triangles = {},
               .mesh = mesh_of(triangles),
               .capsule = fit_capsule(triangles)};
  part.triangles = std::move(triangles);
  return part;
}

double distance_to_mesh(const Body& body, const Eigen::Vector3d& p) {
  const coal::Sphere point(1e-6);
  const coal::DistanceRequest request;
  coal::DistanceResult result;
  return coal::distance(&point, {Eigen::Matrix3d::Identity(), p}, body.mesh.get(),
                        coal::Transform3s::Identity(), request, result);
}

// how far the capsule stands out of the mesh where it is not inside another one of the body
double stand_out(const Body& body, std::size_t index) {
  constexpr int kPoints = 150;
  const double golden = M_PI * (3.0 - std::sqrt(5.0));
  const Capsule& capsule = body.parts[index].capsule;
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  const double length = axis.norm();
  const Eigen::Vector3d w =
      length > 0.0 ? Eigen::Vector3d(axis / length) : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d u = w.unitOrthogonal(), v = w.cross(u);
  const double height = length + 2.0 * capsule.radius;  // equal areas at equal heights
  double most = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double z = (i + 0.5) / kPoints * height - capsule.radius;
    const double at = std::clamp(z, 0.0, length);
    const double r =
        std::sqrt(std::max(0.0, capsule.radius * capsule.radius - (z - at) * (z - at)));
    const Eigen::Vector3d p =
        capsule.from + z * w + r * (std::cos(golden * i) * u + std::sin(golden * i) * v);
    bool is_inside = false;
    for (std::size_t k = 0; k < body.parts.size(); ++k) {
      is_inside = is_inside || (k != index && distance_to(body.parts[k].capsule, p) < 0.0);
    }
    if (!is_inside) most = std::max(most, distance_to_mesh(body, p));
  }
  return most;
}

void measure(Body& body) {
  for (std::size_t i = 0; i < body.parts.size(); ++i) {
    body.parts[i].stands_out = stand_out(body, i);
  }
}

}  // namespace

std::vector<Body> read_bodies(const ChainPart& part, const model::Urdf& urdf,
                              const model::ChainModel& chain, std::vector<std::string>& unread) {
  model::ChainData neutral(chain);
  neutral.update_poses(Eigen::VectorXd::Zero(chain.nv()));
  const std::vector<collision::Shape> places = places_of_links(urdf, chain);
  std::vector<Body> bodies;
  for (const model::LinkMesh& mesh : model::link_meshes(read_file(part.urdf))) {
    const auto place = std::ranges::find(places, mesh.link, &collision::Shape::name);
    if (place == places.end()) continue;
    if (!mesh.fault.empty()) throw SetupError(part.urdf.generic_string() + ":" + mesh.fault);
    const std::vector<Triangle> triangles = read_mesh(find_mesh(part.urdf, mesh.name), mesh);
    if (triangles.empty()) {
      if (std::ranges::find(unread, mesh.name) == unread.end()) unread.push_back(mesh.name);
      continue;
    }
    Body& body = body_at(*place, bodies);
    const std::string file = std::filesystem::path(mesh.name).filename().string();
    if (std::ranges::find(body.files, file) == body.files.end()) body.files.push_back(file);
    add(triangles, place->frame, neutral, body);
  }
  if (bodies.empty()) return bodies;
  for (const model::UrdfLink& link : urdf.links) {
    const auto place = std::ranges::find(places, link.name, &collision::Shape::name);
    if (place == places.end()) continue;
    for (const model::UrdfCollision& element : link.collisions) {
      if (element.shape == model::UrdfShape::kOther) continue;
      add(triangles_of(element), place->frame, neutral, body_at(*place, bodies));
    }
  }
  std::ranges::sort(bodies, {}, &Body::joints);
  return bodies;
}

void begin_with_one(Body& body) {
  body.mesh = mesh_of(body.triangles);
  // a mesh in millimetres is not cut into millions
  body.size = (body.mesh->aabb_local.max_ - body.mesh->aabb_local.min_).norm();
  body.parts = {part_of(cut(body.triangles, std::max(kLongestEdge, body.size / 100.0)), body)};
  measure(body);
}

bool part_in_two(Body& body, std::size_t index) {
  auto [first, second] = split(body.parts[index].triangles);
  if (second.empty()) return false;
  body.parts[index] = part_of(std::move(first), body);
  body.parts.push_back(part_of(std::move(second), body));
  measure(body);
  return true;
}

collision::Shape shape_of(const Body& body, std::size_t index) {
  const Capsule& capsule = body.parts[index].capsule;
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  collision::Shape shape = {.name = fmt::format("{}_{}", body.link, index + 1),
                            .body = body.joints,
                            .frame = body.frame,
                            .T_frame_shape = {},
                            .radius = capsule.radius,
                            .half_length = 0.5 * axis.norm()};
  shape.T_frame_shape.p = 0.5 * (capsule.from + capsule.to);
  shape.T_frame_shape.R =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  return shape;
}

Pose pose_of(const model::ChainData& chain, int frame) {
  return frame < 0 ? Pose{} : chain.pose(frame);
}

}  // namespace hg::new_files
