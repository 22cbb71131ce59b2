/// The functions of liblsl, the library of the Lab Streaming Layer, from a shared library that is
/// loaded while the program runs. Declared here because its wheel has no header.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace hg::lab_streaming {

class Liblsl {
 public:
  /// Loads the first of `candidates` that is there: files, or names that the system looks up.
  /// Unless a configuration file of LSL exists, the library only logs errors. Throws SetupError: it
  /// lists all that were tried.
  explicit Liblsl(std::span<const std::string> candidates);
  ~Liblsl();
  Liblsl(const Liblsl&) = delete;
  Liblsl& operator=(const Liblsl&) = delete;

  const std::string& file() const noexcept { return file_; }

  using Info = void*;                                      ///< lsl_streaminfo
  using Outlet = void*;                                    ///< lsl_outlet
  using Xml = void*;                                       ///< lsl_xml_ptr
  static constexpr std::int32_t kDouble = 2, kString = 3;  ///< formats of channels

  Info (*create_info)(const char* name, const char* type, std::int32_t channels, double rate_Hz,
                      std::int32_t format, const char* source) = nullptr;
  void (*destroy_info)(Info) = nullptr;
  Xml (*get_description)(Info) = nullptr;
  Xml (*append_child)(Xml, const char* name) = nullptr;
  Xml (*append_value)(Xml, const char* name, const char* value) = nullptr;
  /// `chunk`: samples that are sent together, 0 = as they are pushed; `buffered`: kept for a reader
  /// that is slow, s (without a rate, hundreds of samples)
  Outlet (*create_outlet)(Info, std::int32_t chunk, std::int32_t buffered) = nullptr;
  void (*destroy_outlet)(Outlet) = nullptr;
  std::int32_t (*has_readers)(Outlet) = nullptr;
  /// `numbers`: sample after sample, `count` in all; `times_s`: one per sample
  std::int32_t (*push_numbers)(Outlet, const double* numbers, unsigned long count,
                               const double* times_s, std::int32_t at_once) = nullptr;
  std::int32_t (*push_text)(Outlet, const char** texts, double time_s,
                            std::int32_t at_once) = nullptr;
  double (*local_clock)() = nullptr;  ///< s, monotonic

 private:
  void* handle_ = nullptr;
  std::string file_;
};

}  // namespace hg::lab_streaming
