/// Samples as columns: one array per field, named by the path of the field in a recording.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "hg/recording/message.h"
#include "hg/signals/state.h"

namespace hg::python {

namespace nb = nanobind;

/// The archive (see hg/core/fields.h) that appends every number of a sample to its column.
///
/// A field of a sequence becomes one column with an entry per item; record.time_s is "time_s", and
/// likewise for all fields of the record. Shorter rows are padded with NaN or 0.
class Columns {
 public:
  Columns() {
    const Sample blank;
    visit(blank, Pass::kDefine);
  }

  void append(const Sample& sample) {
    ++rows_;
    visit(sample, Pass::kAppend);
  }

  /// Arrays by name, of shape (rows), or (rows, width) where a field has more than one number.
  nb::dict to_dict() const {
    nb::dict arrays;
    for (const Column& column : columns_) arrays[column.name.c_str()] = array_of(column);
    return arrays;
  }

  template <typename T>
  void operator()(const char* name, const T& value, const char* = "") {
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
      put(name, items[static_cast<std::size_t>(i)]);
    }
    is_sequence_ = false;
    pass_ = pass;
  }

 private:
  enum class Pass { kDefine, kAppend, kSkip };

  struct Column {
    std::string name;
    nb::dlpack::dtype type;
    bool is_wide;                     ///< two dimensions even if every row has one number
    std::vector<std::byte> data;      ///< rows in sequence
    std::vector<std::size_t> counts;  ///< numbers in each row
  };

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

  template <recording::IsScalar T>
  void put(const char* name, const T& value) {
    if (Column* column = next<T>(name, is_sequence_)) add(*column, &value, 1);
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void put(const char* name,
           const Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix) {
    Column* column = next<double>(name, true);
    if (column == nullptr) return;
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index col = 0; col < matrix.cols(); ++col) add(*column, &matrix(row, col), 1);
    }
  }

  template <typename T>
  Column* next(const char* name, bool is_wide) {
    if (pass_ == Pass::kDefine) columns_.push_back({path_ + name, type_of<T>(), is_wide, {}, {}});
    const std::size_t index = next_++;
    if (pass_ != Pass::kAppend) return nullptr;
    columns_[index].counts.resize(rows_);
    return &columns_[index];
  }

  template <typename T>
  static nb::dlpack::dtype type_of() {
    if constexpr (std::is_enum_v<T>) {
      return nb::dtype<std::underlying_type_t<T>>();
    } else {
      return nb::dtype<T>();
    }
  }

  template <typename T>
  static void add(Column& column, const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const std::byte*>(values);
    column.data.insert(column.data.end(), bytes, bytes + count * sizeof(T));
    column.counts.back() += count;
  }

  nb::object array_of(const Column& column) const;

  Pass pass_ = Pass::kDefine;
  bool is_sequence_ = false;
  std::string path_;
  std::size_t next_ = 0;  ///< column that the next field belongs to
  std::size_t rows_ = 0;
  std::vector<Column> columns_;
};

}  // namespace hg::python
