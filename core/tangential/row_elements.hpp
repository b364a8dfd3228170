// Elements that lie in rows: vectors hold, row after row, the row's x components and then its y
// components (rolling_newton.hpp).
#pragma once

#include <cstddef>

namespace railpatch {

// f(element, index of its x component, of its y component). row_start: [rows + 1].
template <class F>
void for_each_row_element(int rows, const int *row_start, F &&f) {
  for (int row = 0; row < rows; ++row) {
    const int begin = row_start[row], n = row_start[row + 1] - begin;
    for (int k = 0; k < n; ++k)
      f(static_cast<std::size_t>(begin + k), static_cast<std::size_t>(2 * begin + k),
        static_cast<std::size_t>(2 * begin + n + k));
  }
}

// The unknowns of a linear system in which elements that stick have two and others one: first one
// of each of a row's elements, then the second ones. f(linearisation of the element, with `stick`,
// index of its first unknown, of its second one, indices of its components in vectors). Returns the
// number of unknowns.
template <class Linearisation, class F>
std::size_t for_each_row_unknown(int rows, const int *row_start, const Linearisation *linear,
                                 F &&f) {
  std::size_t first = 0;
  for (int row = 0; row < rows; ++row) {
    const auto begin = static_cast<std::size_t>(row_start[row]);
    const std::size_t n = static_cast<std::size_t>(row_start[row + 1]) - begin;
    std::size_t second = first + n;
    for (std::size_t k = 0; k < n; ++k) {
      f(linear[begin + k], first + k, second, 2 * begin + k, 2 * begin + n + k);
      if (linear[begin + k].stick) ++second;
    }
    first = second;
  }
  return first;
}

}  // namespace railpatch
