#include "hg/commissioning/generator/self_collision.h"

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/mesh_loader/loader.h>
#include <coal/shape/geometric_shapes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "hg/commissioning/generator/postures.h"
#include "hg/controller/safety/collision/distance.h"
#include "hg/core/mesh_file.h"
#include "hg/core/open_file.h"
#include "hg/model/link_meshes.h"
#include "hg/model/urdf.h"
#include "hg/model/urdf_parts.h"

namespace hg::generator {
namespace {

using MeshModel = coal::BVHModel<coal::OBBRSS>;

constexpr double kSafeDistance = 0.01;          // m; the capsules stand out of the meshes already
constexpr double kNear = kSafeDistance + 0.02;  // m, as the pairs of a device are chosen
constexpr double kMeshMargin = 0.01;            // m, between meshes that never touch
constexpr double kFineEnough = 0.015;           // m; what stands out less is not parted
constexpr std::size_t kMostPerBody = 6;
constexpr double kLongestEdge = 0.02;  // m, of the triangles that are shared out
constexpr int kPostures = 1500;        // in which capsules are compared
constexpr int kGrid = 36;              // values of each of two joints

// some of the triangles of a body, and the capsule around them
struct Part {
  std::vector<Triangle> triangles;
  Capsule capsule;
  double stands_out = 0.0;
};

struct Body {
  std::string link;
  int frame = -1;
  int joints = 0;  // that move it
  std::vector<std::string> files;
  std::vector<Triangle> triangles;  // in the frame of the link
  std::unique_ptr<MeshModel> mesh;
  std::vector<Part> parts;
  bool is_final = false;
};

coal::Transform3s transform_of(const Pose& pose) { return {pose.R, pose.p}; }

Pose pose_of(const model::ChainData& chain, int frame) {
  return frame < 0 ? Pose{} : chain.pose(frame);
}

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

// The bodies from the root on, with meshes and primitives; none without meshes.
std::vector<Body> read_bodies(const ChainPart& part, const model::Urdf& urdf,
                              const model::ChainModel& chain, std::vector<std::string>& unread) {
  model::ChainData neutral(chain);
  neutral.update_poses(Eigen::VectorXd::Zero(chain.nv()));
  const std::vector<collision::Shape> places = places_of_links(urdf, chain);
  std::vector<Body> bodies;
  for (const model::LinkMesh& mesh : model::link_meshes(read_file(part.urdf))) {
    const auto place = std::ranges::find(places, mesh.link, &collision::Shape::name);
    if (place == places.end()) continue;
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

void build_mesh(Body& body) {
  body.mesh = std::make_unique<MeshModel>();
  body.mesh->beginModel(static_cast<unsigned>(body.triangles.size()),
                        static_cast<unsigned>(3 * body.triangles.size()));
  for (const Triangle& t : body.triangles) body.mesh->addTriangle(t[0], t[1], t[2]);
  body.mesh->endModel();
  body.mesh->computeLocalAABB();
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

void begin_with_one(Body& body) {
  build_mesh(body);
  // a mesh in millimetres is not cut into millions
  const double size = (body.mesh->aabb_local.max_ - body.mesh->aabb_local.min_).norm();
  std::vector<Triangle> triangles = cut(body.triangles, std::max(kLongestEdge, size / 100.0));
  const Capsule capsule = fit_capsule(triangles);
  body.parts = {{std::move(triangles), capsule}};
  measure(body);
}

// parts one part in two; false when it cannot be parted
bool part_in_two(Body& body, std::size_t index) {
  auto [first, second] = split(body.parts[index].triangles);
  if (second.empty()) return false;
  const Capsule a = fit_capsule(first), b = fit_capsule(second);
  body.parts[index] = {std::move(first), a};
  body.parts.push_back({std::move(second), b});
  measure(body);
  return true;
}

collision::Shape shape_of(const Body& body, std::size_t index) {
  const Capsule& capsule = body.parts[index].capsule;
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  collision::Shape shape = {.name = fmt::format("{} {}", body.link, index + 1),
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

// Two bodies with two joints between them: in all of a grid of postures, whether the meshes stay
// apart.
bool meshes_stay_apart(const Body& a, const Body& b, const std::vector<Interval>& ranges,
                       model::ChainData& chain) {
  const collision::Distance capsules(shape_of(a, 0), shape_of(b, 0));
  coal::CollisionRequest request;
  request.security_margin = kMeshMargin;
  Eigen::VectorXd q(static_cast<Eigen::Index>(ranges.size()));
  for (int i = 0; i < q.size(); ++i) q[i] = 0.5 * (ranges[i].lb + ranges[i].ub);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const Interval &first = ranges[a.joints], &second = ranges[a.joints + 1];
    q[a.joints] = std::lerp(first.lb, first.ub, (i / kGrid) / (kGrid - 1.0));
    q[a.joints + 1] = std::lerp(second.lb, second.ub, (i % kGrid) / (kGrid - 1.0));
    chain.update_poses(q);
    const Pose at = pose_of(chain, a.frame), bt = pose_of(chain, b.frame);
    if (capsules(at, bt) > kMeshMargin) continue;
    coal::CollisionResult result;
    if (coal::collide(a.mesh.get(), transform_of(at), b.mesh.get(), transform_of(bt), request,
                      result) > 0) {
      return false;
    }
  }
  return true;
}

bool is_apart(const SelfCollision& result, const std::string& a, const std::string& b) {
  return std::ranges::find(result.never_touch, std::pair(a, b)) != result.never_touch.end();
}

// The pairs of capsules that come near each other in sampled postures: their number, and how often
// each part of each body is near another.
struct Nearness {
  int pairs = 0;
  std::vector<std::vector<int>> counts;
};

struct Postures {
  std::vector<std::vector<Pose>> of_bodies;  // per posture and body
};

Nearness nearness(const std::vector<Body>& bodies, const SelfCollision& result,
                  const Postures& postures) {
  Nearness found;
  for (const Body& body : bodies) found.counts.emplace_back(body.parts.size(), 0);
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      if (bodies[b].joints - bodies[a].joints < 2) continue;
      if (is_apart(result, bodies[a].link, bodies[b].link)) continue;
      for (std::size_t i = 0; i < bodies[a].parts.size(); ++i) {
        for (std::size_t k = 0; k < bodies[b].parts.size(); ++k) {
          const collision::Distance distance(shape_of(bodies[a], i), shape_of(bodies[b], k));
          int count = 0;
          for (const auto& poses : postures.of_bodies) {
            if (distance(poses[a], poses[b]) < kNear) ++count;
          }
          found.pairs += count > 0 ? 1 : 0;
          found.counts[a][i] += count;
          found.counts[b][k] += count;
        }
      }
    }
  }
  return found;
}

Postures draw_postures(const std::vector<Body>& bodies, const std::vector<Interval>& ranges,
                       model::ChainData& chain) {
  Postures postures;
  PostureSampler sampler(ranges);
  for (int n = 0; n < kPostures; ++n) {
    chain.update_poses(sampler.draw());
    std::vector<Pose>& poses = postures.of_bodies.emplace_back();
    for (const Body& body : bodies) poses.push_back(pose_of(chain, body.frame));
  }
  return postures;
}

// what a body was before one of its capsules was parted
struct StepBack {
  std::size_t body = 0;
  std::vector<Part> parts;
};

// parts the capsule that stands out most, counted by how often it is near others; false: none left
bool refine_once(std::vector<Body>& bodies, const SelfCollision& result, const Postures& postures,
                 std::vector<StepBack>& steps_back) {
  const Nearness now = nearness(bodies, result, postures);
  double most = 0.0;
  std::size_t body = 0, part = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].is_final || bodies[b].parts.size() >= kMostPerBody) continue;
    for (std::size_t i = 0; i < bodies[b].parts.size(); ++i) {
      if (bodies[b].parts[i].stands_out < kFineEnough) continue;
      const double value = bodies[b].parts[i].stands_out * now.counts[b][i];
      if (value <= most) continue;
      most = value;
      body = b;
      part = i;
    }
  }
  if (most == 0.0) return false;
  std::vector<Part> before = bodies[body].parts;
  if (!part_in_two(bodies[body], part) ||
      nearness(bodies, result, postures).pairs > kDraftedPairs) {
    bodies[body].parts = std::move(before);
    bodies[body].is_final = true;
  } else {
    steps_back.push_back({body, std::move(before)});
  }
  return true;
}

// pairs as they are chosen when the device is loaded
void choose_pairs(const std::vector<Body>& bodies, std::optional<double> floor,
                  const model::ChainModel& chain, const std::vector<Interval>& ranges,
                  SelfCollision& result) {
  result.shapes.clear();
  if (floor) result.shapes.push_back(collision::floor_at(*floor));
  const auto link_of = [&](const collision::Shape& shape) -> std::string {
    const auto body = std::ranges::find(bodies, shape.body, &Body::joints);
    return body == bodies.end() ? std::string() : body->link;
  };
  for (const Body& body : bodies) {
    for (std::size_t i = 0; i < body.parts.size(); ++i) result.shapes.push_back(shape_of(body, i));
  }
  result.pairs = collision::choose_pairs(result.shapes, chain, ranges, kNear);
  std::erase_if(result.pairs.watched, [&](const collision::Pair& pair) {
    return is_apart(result, link_of(result.shapes[pair.a]), link_of(result.shapes[pair.b]));
  });
}

std::string numbers(const Eigen::Vector3d& p) {
  return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
}

}  // namespace

SelfCollision fit_self_collision(const ChainPart& part, const model::ChainModel& model,
                                 const std::vector<Interval>& ranges, std::optional<double> floor,
                                 const std::function<void(std::size_t, std::size_t)>& progress) {
  SelfCollision result = {.safe_distance = kSafeDistance};
  const model::Urdf urdf =
      model::serial_part(model::read_urdf_file(part.urdf), part.root_link, part.tip_link);
  std::vector<Body> bodies = read_bodies(part, urdf, model, result.unread);
  if (bodies.empty()) return result;

  std::size_t step = 0;
  const std::size_t steps = bodies.size() * (1 + kMostPerBody);
  const auto tell = [&] {
    if (progress) progress(std::min(++step, steps), steps);
  };
  for (Body& body : bodies) {
    begin_with_one(body);
    tell();
  }
  model::ChainData chain(model);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (bodies[b].joints - bodies[a].joints != 2) continue;
      if (meshes_stay_apart(bodies[a], bodies[b], ranges, chain)) {
        result.never_touch.emplace_back(bodies[a].link, bodies[b].link);
      }
    }
  }
  const Postures postures = draw_postures(bodies, ranges, chain);
  std::vector<StepBack> steps_back;
  while (refine_once(bodies, result, postures, steps_back)) tell();

  choose_pairs(bodies, floor, model, ranges, result);
  while (result.pairs.watched.size() > kDraftedPairs && !steps_back.empty()) {
    bodies[steps_back.back().body].parts = std::move(steps_back.back().parts);
    steps_back.pop_back();
    choose_pairs(bodies, floor, model, ranges, result);
  }
  for (const Body& body : bodies) {
    FittedBody fitted = {.link = body.link, .files = body.files, .capsules = {}};
    for (const Part& p : body.parts) {
      fitted.capsules.push_back(p.capsule);
      fitted.stands_out = std::max(fitted.stands_out, p.stands_out);
    }
    result.bodies.push_back(std::move(fitted));
  }
  return result;
}

double smallest_distance(const SelfCollision& shapes, const model::ChainData& chain) {
  double smallest = kInfinity;
  for (const collision::Pair& pair : shapes.pairs.watched) {
    const collision::Shape &a = shapes.shapes[pair.a], &b = shapes.shapes[pair.b];
    const collision::Distance distance(a, b);
    smallest = std::min(smallest, distance(pose_of(chain, a.frame), pose_of(chain, b.frame)));
  }
  return smallest;
}

std::string collision_lines(const SelfCollision& shapes) {
  if (shapes.bodies.empty()) return "";
  std::string text = fmt::format(
      "\ncollision:  # [V] capsules around the meshes of the URDF\n"
      "  safe_distance_m: {:g}  # [A] the capsules stand out of the meshes already\n"
      "  capsules:\n",
      shapes.safe_distance);
  for (const FittedBody& body : shapes.bodies) {
    const std::string what =
        body.files.empty() ? "the primitives of the URDF"
        : body.files.size() == 1
            ? body.files.front()
            : fmt::format("{} and {} more", body.files.front(), body.files.size() - 1);
    text += fmt::format("    # fitted to {}: {:.0f} mm outside at most\n", what,
                        std::ceil(1e3 * body.stands_out));
    for (const Capsule& capsule : body.capsules) {
      text += fmt::format("    - {{link: {}, from_m: {}, to_m: {}, radius_m: {:.4f}}}\n",
                          quoted(body.link), numbers(capsule.from), numbers(capsule.to),
                          capsule.radius);
    }
  }
  if (shapes.never_touch.empty()) return text;
  text += fmt::format(
      "  never_touch:  # [V] their meshes stay {:g} mm apart in {} postures of the two joints "
      "between them\n",
      1e3 * kMeshMargin, kGrid * kGrid);
  for (const auto& [a, b] : shapes.never_touch) {
    text += fmt::format("    - {{links: [{}, {}]}}\n", quoted(a), quoted(b));
  }
  return text;
}

std::vector<std::string> news_of(const SelfCollision& shapes) {
  std::vector<std::string> news;
  if (!shapes.bodies.empty()) {
    std::size_t capsules = 0;
    double most = 0.0;
    for (const FittedBody& body : shapes.bodies) {
      capsules += body.capsules.size();
      most = std::max(most, body.stands_out);
    }
    news.push_back(fmt::format(
        "self-collision: {} capsules around the meshes, at most {:.0f} mm outside; {} pairs are "
        "watched",
        capsules, std::ceil(1e3 * most), shapes.pairs.watched.size()));
  }
  if (!shapes.unread.empty()) {
    news.push_back(fmt::format(
        "self-collision: {} meshes are missing or cannot be read and are not watched, the first "
        "is {}; ROS_PACKAGE_PATH is searched for packages",
        shapes.unread.size(), shapes.unread.front()));
  }
  return news;
}

}  // namespace hg::generator
