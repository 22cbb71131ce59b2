#include "hg/core/input_fault.h"

#include <utility>

namespace hg {
namespace {

std::string lines_of(const std::vector<InputFault>& faults) {
  std::string lines;
  for (const InputFault& fault : faults) (lines += lines.empty() ? "" : "\n") += to_text(fault);
  return lines;
}

}  // namespace

std::string text_without_place(const InputFault& fault) {
  return fault.item.empty() ? fault.what : fault.item + ": " + fault.what;
}

std::string to_text(const InputFault& fault) {
  if (fault.file.empty() && fault.line == 0) return text_without_place(fault);
  std::string place = fault.file;
  if (fault.line > 0) place += ":" + std::to_string(fault.line);
  if (fault.line > 0 && fault.column > 0) place += ":" + std::to_string(fault.column);
  return place + ": " + text_without_place(fault);
}

InputError::InputError(std::vector<InputFault> all)
    : SetupError(lines_of(all)), faults(std::move(all)) {}

InputError::InputError(InputFault fault) : InputError(std::vector{std::move(fault)}) {}

std::vector<InputFault> faults_of(const SetupError& error) {
  const auto* input = dynamic_cast<const InputError*>(&error);
  if (input != nullptr) return input->faults;
  return {{.what = error.what()}};
}

}  // namespace hg
