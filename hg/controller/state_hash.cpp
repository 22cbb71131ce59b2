#include "hg/controller/state_hash.h"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "hg/controller/cycle_state.h"
#include "hg/core/fields.h"

namespace hg::controller {
namespace {

template <typename T, typename Hash>
concept IsHashed = requires(Hash& hash, const T& state) {
  hashed(hash, state);
};

class Hash {
 public:
  std::uint64_t value() const noexcept { return value_; }

  // for the fields() of signals, whose names, notes and units are not part of the hash
  template <typename T>
  void operator()(const char*, const T& value, const char* = "",
                  const Unit& = unit::kNone) noexcept {
    mix(value);
  }

  void mix(std::uint64_t word) noexcept {
    value_ = (std::rotl(value_, 5) ^ word) * 0x517cc1b727220a95ULL;
  }
  void mix(double number) noexcept { mix(std::bit_cast<std::uint64_t>(number)); }
  template <typename T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void mix(T value) noexcept { mix(static_cast<std::uint64_t>(value)); }
  template <typename Derived>
  void mix(const Eigen::PlainObjectBase<Derived>& v) noexcept {
    for (Eigen::Index i = 0; i < v.size(); ++i) mix(v.data()[i]);
  }
  void mix(const Interval& interval) noexcept {
    mix(interval.lb);
    mix(interval.ub);
  }
  template <typename T, std::size_t kSize>
  void mix(const std::array<T, kSize>& values) noexcept {
    mix_first(values, static_cast<int>(kSize));
  }
  template <HasFields T>
  void mix(const T& state) noexcept {
    fields(*this, state);
  }
  template <IsHashed<Hash> T>
  void mix(const T& state) noexcept {
    hashed(*this, state);
  }
  template <typename First, typename Second, typename... More>
  void mix(const First& first, const Second& second, const More&... more) noexcept {
    mix(first);
    mix(second);
    (mix(more), ...);
  }

  // the first `count` items; small ones are packed into words
  template <typename T, std::size_t kSize>
  void mix_first(const std::array<T, kSize>& items, int count) noexcept {
    if constexpr (std::is_class_v<T>) {
      for (int i = 0; i < count; ++i) mix(items[i]);
    } else {
      mix_packed(items.data(), count);
    }
  }

 private:
  template <typename T>
  void mix_packed(const T* values, std::size_t count) noexcept {
    constexpr std::size_t kInWord = sizeof(std::uint64_t) / sizeof(T);
    static_assert(kInWord > 1 && std::has_unique_object_representations_v<T>);
    std::uint64_t word = 0;
    std::size_t i = 0;
    for (; i + kInWord <= count; i += kInWord) {
      std::memcpy(&word, values + i, sizeof(word));
      mix(word);
    }
    if (i == count) return;
    word = 0;
    std::memcpy(&word, values + i, (count - i) * sizeof(T));
    mix(word);
  }

  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace

std::uint64_t hash_of(const CycleState& state, int rows) noexcept {
  Hash hash;
  hashed(hash, state, rows);
  return hash.value();
}

}  // namespace hg::controller
