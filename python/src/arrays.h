/// Conversion between numpy and C++: input is anything that numpy converts to an array, output is a
/// copy.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace hg::python {

namespace nb = nanobind;

/// Array of double in C order, converted from any array-like: list, number, other array.
struct ArrayIn {
  nb::ndarray<const double, nb::c_contig, nb::device::cpu> array;

  std::size_t size() const { return array.size(); }
  const double* data() const { return array.data(); }
};

/// Read-only copy owned by Python.
struct ArrayOut {
  nb::ndarray<nb::numpy, const double> array;
};

inline ArrayOut to_numpy(std::vector<double> values, const std::vector<std::size_t>& shape) {
  auto* owned = new std::vector<double>(std::move(values));
  const nb::capsule owner(owned,
                          [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return {{owned->data(), shape.size(), shape.data(), owner}};
}

/// Copies a vector to a 1-D array, a matrix to a 2-D array.
template <typename Derived>
ArrayOut to_numpy(const Eigen::MatrixBase<Derived>& matrix) {
  std::vector<double> values;
  values.reserve(matrix.size());
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) values.push_back(matrix(row, col));
  }
  std::vector<std::size_t> shape(1, matrix.rows());
  if (Derived::ColsAtCompileTime != 1) shape.push_back(matrix.cols());
  return to_numpy(std::move(values), shape);
}

[[noreturn]] inline void refuse_size(const char* name, std::size_t expected, std::size_t got) {
  throw nb::value_error((std::string(name) + ": expected " + std::to_string(expected) +
                         " numbers, got " + std::to_string(got))
                            .c_str());
}

/// The `size` numbers of `in`. Throws ValueError, beginning with `name`, for another size.
inline Eigen::Map<const Eigen::VectorXd> vector_of(const ArrayIn& in, int size, const char* name) {
  if (std::cmp_not_equal(in.size(), size)) {
    refuse_size(name, size, in.size());
  }
  return {in.data(), size};
}

/// Writes `in` into a vector or matrix (in row-major order) of fixed or limited size.
template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
void assign(const ArrayIn& in, const char* name,
            Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& out) {
  static_assert(kRows != Eigen::Dynamic || kCols == 1);
  if constexpr (kRows == Eigen::Dynamic) {
    if (std::cmp_greater(in.size(), kMaxRows)) {
      throw nb::value_error((std::string(name) + ": expected at most " + std::to_string(kMaxRows) +
                             " numbers, got " + std::to_string(in.size()))
                                .c_str());
    }
    out.resize(in.size());
  } else if (std::cmp_not_equal(in.size(), kRows * kCols)) {
    refuse_size(name, kRows * kCols, in.size());
  }
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    for (Eigen::Index col = 0; col < out.cols(); ++col) {
      out(row, col) = in.data()[row * out.cols() + col];
    }
  }
}

}  // namespace hg::python

namespace nanobind::detail {

template <>
struct type_caster<hg::python::ArrayIn> {
  NB_TYPE_CASTER(hg::python::ArrayIn, const_name("numpy.typing.ArrayLike"))

  bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
    try {
      const object array = module_::import_("numpy").attr("asarray")(
          source, arg("dtype") = "float64", arg("order") = "C");
      value.array = nanobind::cast<decltype(value.array)>(array);
      return true;
    } catch (...) {
      PyErr_Clear();
      return false;
    }
  }
};

/// Each array owns its data: a property would otherwise make its object the owner.
template <>
struct type_caster<hg::python::ArrayOut> {
  using Array = decltype(hg::python::ArrayOut::array);
  NB_TYPE_CASTER(hg::python::ArrayOut, make_caster<Array>::Name)

  static handle from_cpp(const hg::python::ArrayOut& out, rv_policy, cleanup_list* cleanup) {
    return make_caster<Array>::from_cpp(out.array, rv_policy::automatic, cleanup);
  }
};

}  // namespace nanobind::detail
