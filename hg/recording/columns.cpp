#include "hg/recording/columns.h"

#include <fmt/format.h>

namespace hg::recording {
namespace {

// Format 1.0 of numpy: magic, version, length of the header in two bytes, the header.
std::string npy_head(const std::vector<const Column*>& columns, std::size_t rows) {
  constexpr std::size_t kAligned = 64, kMagic = 10;
  std::string text = "{'descr': [";
  for (const Column* column : columns) {
    text += fmt::format("('{}', '{}{}{}'", column->name, column->bytes == 1 ? '|' : '<',
                        column->kind, column->bytes);
    text += column->is_wide ? fmt::format(", ({},)), ", column->width()) : "), ";
  }
  text += fmt::format("], 'fortran_order': False, 'shape': ({},), }}", rows);
  text.append(kAligned - 1 - (kMagic + text.size()) % kAligned, ' ');
  text += '\n';
  const auto length = static_cast<unsigned>(text.size());
  std::string head("\x93NUMPY\x01\0", 8);
  head += static_cast<char>(length & 0xffU);
  head += static_cast<char>(length >> 8U);
  return head + text;
}

}  // namespace

std::string to_npy(const Columns& columns) {
  std::vector<const Column*> kept;
  std::vector<std::vector<std::byte>> all;
  for (const Column& column : columns.all()) {
    if (!column.is_kept) continue;
    kept.push_back(&column);
    all.push_back(padded(column, columns.rows()));
  }
  std::string text = npy_head(kept, columns.rows());
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    for (const std::vector<std::byte>& bytes : all) {
      const std::size_t size = bytes.size() / columns.rows();
      text.append(reinterpret_cast<const char*>(bytes.data()) + row * size, size);
    }
  }
  return text;
}

}  // namespace hg::recording
