// Elements that lie in rows: vectors hold, row after row, the row's x components and then its y
// components (rolling_newton.hpp). And the one way from a grid to such rows and back.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "half_space/influence.hpp"
#include "numeric/memory.hpp"

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

// The elements of a grid that are in contact, and products on the grid with vectors of them.
class row_elements {
 public:
  row_elements(int max_nx, int max_ny);
  // Those under pressure; rows begin at their leading edges, rows without contact are left out.
  // boxed: products are on the least grid that holds them.
  void collect(const grid &g, const double *pressure, int direction, bool boxed = false);
  // That of products, on elements as those of g.
  grid product_grid(const grid &g) const;

  int count() const { return count_; }
  int rows() const { return rows_; }
  size_t vector_size() const { return 2 * static_cast<size_t>(count_); }
  const int *row_start() const { return row_start_.data(); }
  int length(int row) const { return row_start()[row + 1] - row_start()[row]; }
  // indices on the grid of a row's elements
  const int *at(int row) const { return at_.data() + row_start()[row]; }
  bool gapless(int row) const {
    const int *elements = at(row), n = length(row);
    return std::abs(elements[n - 1] - elements[0]) == n - 1;
  }
  // The longest row where none has a gap, else -1: the others' matrices are the beginning of its.
  int common_row() const;

  // f(element, index on the grid, indices of its components in vectors)
  template <class F>
  void for_each(F &&f) const {
    for_each_row_element(rows_, row_start(), [&](size_t element, size_t ix, size_t iy) {
      f(element, static_cast<size_t>(at_[element]), ix, iy);
    });
  }
  // out = B v by run(px, py, sx, sy) on the products' grid, where v is zero out of contact.
  template <class Run>
  void product(const double *v, double *out, Run &&run) {
    double *px = grid_[0].data(), *py = grid_[1].data();
    for_each_row_element(rows_, row_start(), [&](size_t k, size_t ix, size_t iy) {
      const auto at = static_cast<size_t>(within_[k]);
      px[at] = v[ix];
      py[at] = v[iy];
    });
    run(px, py, x(), y());
    const double *sx = x(), *sy = y();
    for_each_row_element(rows_, row_start(), [&](size_t k, size_t ix, size_t iy) {
      const auto at = static_cast<size_t>(within_[k]);
      out[ix] = sx[at];
      out[iy] = sy[at];
    });
  }
  // The vector of two fields on the grid.
  void gather(const double *x, const double *y, double *v) const {
    for_each([&](size_t, size_t at, size_t ix, size_t iy) {
      v[ix] = x[at];
      v[iy] = y[at];
    });
  }
  // Fields on the grid for a product's result.
  double *x() { return grid_[2].data(); }
  double *y() { return grid_[3].data(); }
  size_t bytes() const { return 2 * at_.bytes() + row_start_.bytes() + 4 * grid_[0].bytes(); }

 private:
  int count_ = 0, rows_ = 0;
  int box_[4] = {0, 0, 0, 0};  // of products: first column and row, numbers of both
  aligned_buffer<int> at_, row_start_;
  aligned_buffer<int> within_;  // indices on the products' grid
  aligned_buffer<double> grid_[4];
};

}  // namespace railpatch
