#include "hg/recording/columns.h"

#include <fmt/format.h>

#include <limits>

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

void append_padding(const Column& column, std::size_t numbers, std::string& text) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const bool is_number = column.kind == 'f' && column.bytes == sizeof kNan;
  for (std::size_t i = 0; i < numbers; ++i) {
    if (is_number) {
      text.append(reinterpret_cast<const char*>(&kNan), sizeof kNan);
    } else {
      text.append(column.bytes, '\0');
    }
  }
}

}  // namespace

std::string to_npy(const Columns& columns) {
  std::vector<const Column*> kept;
  for (const Column& column : columns.all()) {
    if (column.is_kept) kept.push_back(&column);
  }
  std::vector<std::size_t> widths, places(kept.size());
  for (const Column* column : kept) widths.push_back(column->width());
  std::string text = npy_head(kept, columns.rows());
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Column& column = *kept[i];
      const std::size_t count = row < column.counts.size() ? column.counts[row] : 0;
      text.append(reinterpret_cast<const char*>(column.data.data()) + places[i],
                  count * column.bytes);
      places[i] += count * column.bytes;
      append_padding(column, widths[i] - count, text);
    }
  }
  return text;
}

}  // namespace hg::recording
