/// Binding of a struct by its list of fields: attribute names, columns of run() and columns of a
/// recording are the same, and each is defined once.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstddef>
#include <vector>

#include "hg/core/fields.h"
#include "hg/messages/message.h"
#include "python/src/arrays.h"

namespace hg::python {

/// The archive (see hg/core/fields.h) that adds one property per field of T to its class.
template <typename T>
class FieldBinder {
 public:
  FieldBinder(nb::class_<T>& target, const T& blank) : target_(target), blank_(blank) {}

  template <typename Value>
  void operator()(const char* name, Value& value, const char* note = "",
                  const Unit& unit = unit::kNone) {
    add(name, Offset<Value>{distance(&value)}, with_unit(note, unit).c_str());
  }

  template <typename Item, std::size_t kCapacity>
  void sequence(const char* name, std::array<Item, kCapacity>& items, int& count,
                const char* note) {
    const Offset<std::array<Item, kCapacity>> all{distance(&items)};
    const Offset<int> used{distance(&count)};
    target_.def_prop_ro(
        name,
        [all, used](T& self) {
          const auto* first = all.in(self).data();
          return std::vector<Item>(first, first + used.in(self));
        },
        note);
  }

 private:
  /// Byte offset of a member in T.
  template <typename Value>
  struct Offset {
    std::ptrdiff_t bytes;
    Value& in(T& self) const {
      return *reinterpret_cast<Value*>(reinterpret_cast<std::byte*>(&self) + bytes);
    }
  };

  std::ptrdiff_t distance(const void* member) const {
    return static_cast<const std::byte*>(member) - reinterpret_cast<const std::byte*>(&blank_);
  }

  template <messages::IsScalar Value>
  void add(const char* name, Offset<Value> member, const char* note) {
    target_.def_prop_rw(
        name, [member](T& self) { return member.in(self); },
        [member](T& self, Value value) { member.in(self) = value; }, note);
  }

  template <HasFields Value>
  void add(const char* name, Offset<Value> member, const char* note) {
    target_.def_prop_rw(
        name, [member](T& self) -> Value& { return member.in(self); },
        [member](T& self, const Value& value) { member.in(self) = value; },
        nb::for_getter(nb::rv_policy::reference_internal), note);
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void add(const char* name,
           Offset<Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>> member,
           const char* note) {
    target_.def_prop_rw(
        name, [member](T& self) { return to_numpy(member.in(self)); },
        [member, name](T& self, const ArrayIn& values) { assign(values, name, member.in(self)); },
        note);
  }

  nb::class_<T>& target_;
  const T& blank_;
};

/// Binds the class of a struct with a list of fields.
template <HasFields T>
nb::class_<T> bind_fields(nb::module_& module, const char* name, const char* text) {
  nb::class_<T> target(module, name, text);
  target.def(nb::init<>());
  target.def("__copy__", [](const T& self) { return T(self); });
  T blank{};
  FieldBinder<T> binder(target, blank);
  fields(binder, blank);
  return target;
}

}  // namespace hg::python
