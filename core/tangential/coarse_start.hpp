// A start for the tangential problem where none is known: the solution on a grid of elements twice
// as long and wide, which itself starts that way. From the simplified theory's traction, Newton's
// steps move the edge between stick and slip by some elements each, so that finer grids take more
// steps; from here they take three or four on any grid (nested iteration, Hackbusch 1985, chapter
// 5).
#pragma once

#include <memory>

#include "tangential/tangential.hpp"

namespace railpatch {

class coarse_start {
 public:
  // Of grids up to the given size, whose products use the given transforms.
  coarse_start(const influence::medium &of, const fft_plans &plans, int max_nx, int max_ny);
  // Whether a grid is fine enough to be worth it.
  static bool serves(int nx, int ny) { return nx >= least_elements && ny >= least_elements; }

  // Sets the tractions of `fields` to a start; leaves them where it finds none. Its iterations, at
  // a quarter of the price and less, are not among those that results count.
  void find(const grid &g, const double *pressure, const double *bound, const rolling_input &input,
            const tangential_options &options, tangential_fields fields);
  size_t bytes() const;

 private:
  static constexpr int least_elements = 40;
  void restrict_to(const grid &coarse, const grid &g, const double *pressure, const double *bound);
  void prolong(const grid &coarse, const grid &g, const double *bound,
               tangential_fields fields) const;

  fft_plans plans_;
  influence influence_;
  tangential_solver solver_;
  std::unique_ptr<coarse_start> coarser_;
  aligned_buffer<double> pressure_, bound_, px_, py_, sx_, sy_;
  aligned_buffer<unsigned char> division_;
};

}  // namespace railpatch
