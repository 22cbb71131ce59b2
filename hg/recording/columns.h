/// Samples as columns: one per field, named by the path of the field in a recording.
///
/// Used by Python's run(), by reports and by the comparison of a replay.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "hg/messages/message.h"
#include "hg/signals/state.h"

namespace hg::recording {

/// What the numbers in a row of a column belong to.
enum class Axis {
  kNone,
  kGantry,          ///< axes of the gantry
  kManipulator,     ///< joints of the manipulator
  kJoint,           ///< gantry, then manipulator
  kTwinCoordinate,  ///< coordinates of the twin; a floating joint has 7
  kTwinVelocity,    ///< degrees of freedom of the twin; a floating joint has 6
  kLimit,           ///< limits
  kDirection,       ///< x, y, z
  kSpatial,         ///< along x, y, z, then about x, y, z
  kRotation,        ///< a rotation matrix, row by row
  kUnitReading,     ///< six readings per inertial unit
  kUnit,            ///< inertial units
};

/// All numbers of one field, row after row.
struct Column {
  std::string name;
  std::string note;  ///< what it is; see hg/core/fields.h
  Unit unit;
  Axis axis = Axis::kNone;
  char kind = 'f';        ///< kind of the numbers as numpy writes it: b, i, u, f
  std::size_t bytes = 0;  ///< bytes of one number
  bool is_wide = false;   ///< two dimensions even if every row has one number
  bool is_kept = true;    ///< whether append() adds to it
  std::size_t least_width = 1;
  std::vector<std::byte> data;
  std::vector<std::size_t> counts;  ///< numbers in each row

  /// Numbers of the longest row, at least `least_width`.
  std::size_t width() const {
    return counts.empty() ? least_width : std::max(least_width, *std::ranges::max_element(counts));
  }
};

/// The archive (see hg/core/fields.h) that appends every number of a sample to its column.
///
/// A field of a sequence becomes one column with an entry per item; record.time_s is "time_s", and
/// likewise for all fields of the record. Rows of a column may differ in length.
class Columns {
 public:
  /// Keeps the columns with these names; without names all.
  explicit Columns(const std::vector<std::string>& names = {}) {
    const Sample blank;
    visit(blank, Pass::kDefine);
    for (Column& column : columns_) {
      column.is_kept = names.empty() || std::ranges::find(names, column.name) != names.end();
    }
  }

  void append(const Sample& sample) {
    ++rows_;
    visit(sample, Pass::kAppend);
  }

  /// Removes all rows; from then on no row is shorter than the longest one so far, so that columns
  /// can be written in parts.
  void clear() {
    rows_ = 0;
    for (Column& column : columns_) {
      column.least_width = column.width();
      column.data.clear();
      column.counts.clear();
    }
  }

  /// Gives rows at least the widths of these columns, which are those of another Columns.
  void widen(const std::vector<Column>& columns) {
    for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].least_width = columns[i].width();
  }

  std::size_t rows() const noexcept { return rows_; }
  /// All columns in the order of the fields; those that are not kept have no rows.
  const std::vector<Column>& all() const noexcept { return columns_; }

  template <typename T>
  void operator()(const char* name, const T& value, const char* note = "",
                  const Unit& unit = unit::kNone) {
    if (pass_ == Pass::kDefine) {
      note_ = messages::with_numbers<T>(note);
      unit_ = unit;
    }
    put(name, value);
  }

  template <typename T, std::size_t kCapacity>
  void sequence(const char* name, const std::array<T, kCapacity>& items, int count, const char*) {
    const std::size_t first = next_;
    const Pass pass = pass_;
    if (pass == Pass::kAppend && count == 0) pass_ = Pass::kSkip;
    is_sequence_ = true;
    put(name, items[0]);
    for (int i = 1; i < count && pass == Pass::kAppend; ++i) {
      next_ = first;
      put(name, items[i]);
    }
    is_sequence_ = false;
    pass_ = pass;
  }

 private:
  enum class Pass { kDefine, kAppend, kSkip };

  void visit(const Sample& sample, Pass pass) {
    pass_ = pass;
    next_ = 0;
    fields(*this, sample);
  }

  template <HasFields T>
  void put(const char* name, const T& message) {
    const std::size_t length = path_.size();
    if (length > 0 || std::strcmp(name, "record") != 0) path_ += std::string(name) + ".";
    fields(*this, message);
    path_.resize(length);
  }

  template <messages::IsScalar T>
  void put(const char* name, const T& value) {
    const Axis axis = is_sequence_ ? Axis::kLimit : Axis::kNone;
    if (Column* column = next<T>(name, axis)) add(*column, &value);
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void put(const char* name,
           const Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix) {
    Column* column =
        next<double>(name, axis_of(kRows == Eigen::Dynamic ? kMaxRows : -kRows * kCols));
    if (column == nullptr) return;
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index col = 0; col < matrix.cols(); ++col) add(*column, &matrix(row, col));
    }
  }

  // `size`: the capacity, or minus the fixed number of entries
  static constexpr Axis axis_of(int size) {
    switch (size) {
      case -3:
        return Axis::kDirection;
      case -6:
      case 6:
        return Axis::kSpatial;
      case -9:
        return Axis::kRotation;
      case kMaxGantry:
        return Axis::kGantry;
      case kMaxManipulator:
        return Axis::kManipulator;
      case kMaxGantry + kMaxManipulator:
        return Axis::kJoint;
      case kMaxTwin:
        return Axis::kTwinVelocity;
      case kMaxTwinCoords:
        return Axis::kTwinCoordinate;
      case kMaxInertialUnits:
        return Axis::kUnit;
      case 6 * kMaxInertialUnits:
        return Axis::kUnitReading;
      default:
        return Axis::kNone;
    }
  }

  template <typename T>
  Column* next(const char* name, Axis axis) {
    if (pass_ == Pass::kDefine) {
      columns_.push_back({.name = path_ + name,
                          .note = note_,
                          .unit = unit_,
                          .axis = axis,
                          .kind = kind_of<T>(),
                          .bytes = sizeof(T),
                          .is_wide = axis != Axis::kNone});
    }
    Column& column = columns_[next_++];
    if (pass_ == Pass::kDefine || !column.is_kept) return nullptr;
    column.counts.resize(rows_);
    return pass_ == Pass::kAppend ? &column : nullptr;
  }

  template <typename T>
  static constexpr char kind_of() {
    if constexpr (std::is_same_v<T, bool>) return 'b';
    if constexpr (std::is_floating_point_v<T>) return 'f';
    if constexpr (std::is_enum_v<T>) return kind_of<std::underlying_type_t<T>>();
    return std::is_unsigned_v<T> ? 'u' : 'i';
  }

  template <typename T>
  static void add(Column& column, const T* value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(value);
    column.data.insert(column.data.end(), bytes, bytes + sizeof(T));
    ++column.counts.back();
  }

  Pass pass_ = Pass::kDefine;
  bool is_sequence_ = false;
  std::string path_;
  std::string note_;      ///< of the field being defined
  Unit unit_;             ///< of the field being defined
  std::size_t next_ = 0;  ///< column that the next field belongs to
  std::size_t rows_ = 0;
  std::vector<Column> columns_;
};

/// Bytes of a column in rows of column.width() numbers; shorter rows are padded with NaN or 0.
inline std::vector<std::byte> padded(const Column& column, std::size_t rows) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t width = column.width();  // looks at every row
  const std::size_t numbers = rows * width;
  std::vector<std::byte> bytes(numbers * column.bytes);
  if (column.kind == 'f') {
    for (std::size_t i = 0; i < numbers; ++i) {
      std::memcpy(bytes.data() + i * sizeof kNan, &kNan, sizeof kNan);
    }
  }
  const std::byte* from = column.data.data();
  for (std::size_t row = 0; row < column.counts.size(); ++row) {
    const std::size_t size = column.counts[row] * column.bytes;
    std::copy_n(from, size, bytes.data() + row * width * column.bytes);
    from += size;
  }
  return bytes;
}

/// The kept columns as the content of a file that numpy.load() reads: a structured array with a
/// row per sample and a field per column; see padded().
std::string to_npy(const Columns& columns);

}  // namespace hg::recording
