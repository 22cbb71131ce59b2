#include "hg/controller/rendering/surfaces/mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "hg/core/input_fault.h"

namespace hg::surfaces {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes of a binary STL file

Vector3d middle(const Triangle& triangle) {
  return (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
}

// Connectivity of triangles: corners at the same place, and edges.
class Seams {
 public:
  // Number of a corner.
  int add(const Corners& corners) {
    std::array<int, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<double, 3> place = {corners[i].x(), corners[i].y(), corners[i].z()};
      const int next = static_cast<int>(next_.size());
      const auto [found, is_new] = places_.try_emplace(place, next);
      if (is_new) next_.push_back(next);
      numbers[i] = found->second;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = numbers[i], b = numbers[(i + 1) % 3];
      next_[last(a)] = last(b);
      if (a < b) ++surplus_[{a, b}];
      if (b < a) --surplus_[{b, a}];
    }
    return numbers[0];
  }
  // Representative of all connected corners.
  int last(int corner) {
    const auto next = [&](int at) -> int& { return next_[at]; };
    for (; next(corner) != corner; corner = next(corner)) next(corner) = next(next(corner));
    return corner;
  }
  bool is_closed() const {
    return std::ranges::all_of(surplus_, [](const auto& edge) { return edge.second == 0; });
  }

 private:
  std::map<std::array<double, 3>, int> places_;
  std::vector<int> next_;  // link from each corner to one connected with it
  // Per edge: triangles in one direction minus the other
  std::map<std::pair<int, int>, int> surplus_;
};

std::uint32_t count_of(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + kHeader - sizeof(count), sizeof(count));
  return count;
}

std::vector<Corners> read_binary(std::string_view content, double scale) {
  std::vector<Corners> triangles(count_of(content));
  const char* next = content.data() + kHeader;
  for (Corners& corners : triangles) {
    std::array<float, 12> numbers{};  // normal, then the corners
    std::memcpy(numbers.data(), next, sizeof(numbers));
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = scale * Vector3d(numbers[3 * i + 3], numbers[3 * i + 4], numbers[3 * i + 5]);
    }
    next += kRecord;
  }
  return triangles;
}

// Words of a text, with their line numbers.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  // false at the end
  bool next(std::string_view& word) {
    constexpr std::string_view kSpace = " \t\r\n";
    const std::size_t begin = std::min(rest_.find_first_not_of(kSpace), rest_.size());
    line_ += std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
    rest_.remove_prefix(begin);
    word = rest_.substr(0, std::min(rest_.find_first_of(kSpace), rest_.size()));
    rest_.remove_prefix(word.size());
    return !word.empty();
  }
  int line() const { return static_cast<int>(line_); }

 private:
  std::string_view rest_;
  std::ptrdiff_t line_ = 1;
};

[[noreturn]] void fail(std::string_view source, const std::string& what, int line = 0) {
  throw InputError(InputFault{.file = std::string(source), .line = line, .what = what});
}

double read_number(Words& words, std::string_view source) {
  std::string_view word;
  double value = 0.0;
  words.next(word);
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size()) return value;
  fail(source, "a number is expected after 'vertex', got '" + std::string(word) + "'",
       words.line());
}

std::vector<Corners> read_text(std::string_view content, std::string_view source, double scale) {
  std::vector<Vector3d> corners;
  Words words(content);
  std::string_view word;
  while (words.next(word)) {
    if (word != "vertex") continue;
    Vector3d& corner = corners.emplace_back();
    for (double& value : corner) value = scale * read_number(words, source);
  }
  if (corners.size() % 3 != 0) {
    fail(source,
         "three vertices a facet are expected, got " + std::to_string(corners.size()) + " in all");
  }
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  return triangles;
}

}  // namespace

Mesh::Mesh(const std::vector<Corners>& triangles) {
  constexpr double kLeastArea = 1e-14;  // m^2
  Seams seams;
  for (const Corners& corners : triangles) {
    const Vector3d twice = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!twice.allFinite()) throw SetupError("corners of triangles must be finite");
    const int corner = seams.add(corners);
    if (twice.norm() <= 2.0 * kLeastArea) continue;
    triangles_.push_back({corners, twice.normalized(), corner});
  }
  is_closed_ = seams.is_closed();
  for (Triangle& triangle : triangles_) triangle.solid = seams.last(triangle.solid);
  if (triangles_.empty() || triangles_.size() > kMaxTriangles) {
    throw SetupError("1 .. " + std::to_string(kMaxTriangles) + " triangles with an area, got " +
                     std::to_string(triangles_.size()));
  }
  is_one_solid_ = std::ranges::all_of(
      triangles_, [&](const Triangle& triangle) { return triangle.solid == triangles_[0].solid; });
  std::vector<int> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * order.size());
  build(order, 0, order.size());
}

// Halves the triangles along the longest edge of their box.
void Mesh::build(std::vector<int>& order, std::size_t begin, std::size_t end) {
  const std::size_t index = nodes_.size();
  Node& node = nodes_.emplace_back();
  const auto triangle = [&](int i) -> const Triangle& { return triangles_[i]; };
  for (std::size_t i = begin; i < end; ++i) {
    for (const Vector3d& corner : triangle(order[i]).corners) node.box.extend(corner);
  }
  if (end - begin == 1) {
    node.triangle = order[begin];
  } else {
    Eigen::Index axis = 0;
    node.box.sizes().maxCoeff(&axis);
    const std::size_t half = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(half), at(end), [&](int a, int b) {
      return middle(triangle(a))[axis] < middle(triangle(b))[axis];
    });
    build(order, begin, half);
    build(order, half, end);
  }
  nodes_[index].next = static_cast<int>(nodes_.size());
}

// The solid angle of all triangles seen from the point is the whole sphere inside, zero outside (A.
// van Oosterom, J. Strackee, IEEE Trans. Biomedical Engineering 30(2), 1983).
bool Mesh::encloses(const Vector3d& point) const noexcept {
  double angle = 0.0;
  for (const Triangle& triangle : triangles_) {
    const Vector3d a = triangle.corners[0] - point, b = triangle.corners[1] - point,
                   c = triangle.corners[2] - point;
    const double ra = a.norm(), rb = b.norm(), rc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                              ra * rb * rc + a.dot(b) * rc + b.dot(c) * ra + c.dot(a) * rb);
  }
  return angle > 2.0 * std::numbers::pi;
}

Mesh read_stl(std::string_view content, std::string_view source, double scale) {
  const bool is_binary = content.size() >= kHeader &&
                         content.size() == kHeader + kRecord * std::size_t{count_of(content)};
  if (!is_binary && !content.starts_with("solid")) {
    fail(source,
         "no STL file: it neither begins with 'solid' nor has the length that its "
         "count of triangles demands");
  }
  const std::vector<Corners> triangles =
      is_binary ? read_binary(content, scale) : read_text(content, source, scale);
  try {
    return Mesh(triangles);
  } catch (const SetupError& error) {
    fail(source, error.what());
  }
}

}  // namespace hg::surfaces
