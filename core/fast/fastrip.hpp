// FaStrip (Sichani, Enblom, Berg 2016, Vehicle System Dynamics 54): stick area and its tractions by
// the strip theory of Haines and Ollerton with Kalker's spin (1967, J. Inst. Math. Appl. 3),
// corrected to the linear theory of the ellipse; directions in the slip area by FASTSIM.
//
// Each row is a strip in plane strain (along x) and antiplane strain (along y), of half-length h
// and its own middle, wherever that lies. In rolling coordinates from the middle, with the elliptic
// bound K0 sqrt(h^2 - x^2), a strip that sticks ahead of x = 2d - h has
//   q_i = K_i sqrt(h^2 - x^2) - K'_i sqrt((h - d)^2 - (x - d)^2),  i = x, y
// and du/dx = w there, since the slip that K sqrt(h^2 - x^2) causes is linear in x:
//   K_x d = K'_x d = A = -(f11 xi - f33 phi y) G/(2(1 - nu)),
//   K'_y d = B = -f22 eta G/2,  K'_y - K_y = T = f23 phi G/2,  |K| = K0,
// where eta is that at the strip's middle. So 1/d is the greater root of
//   (A^2 + B^2)/d^2 - 2 B T/d + T^2 - K0^2 = 0; without a root above 1/h the strip slips.
// The factors f turn the strips' own coefficients pi^2/(4(1 - nu)), pi^2/4, pi sqrt(a/b)/3 and
// pi^2 b/(16(1 - nu) a) into C11, C22, C23 and C33 of the ellipse.
#pragma once

#include "fast/fast_problem.hpp"

namespace railpatch {

tangential_result solve_fastrip(const fast_problem &problem, tangential_fields fields,
                                creep_resultants &sums);

}  // namespace railpatch
