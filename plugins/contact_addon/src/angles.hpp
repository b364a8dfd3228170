// Sines and their like, which are the same on every computer: the core's own.
#pragma once

#include "numeric/elementary.hpp"

namespace contact_addon {

using railpatch::acos;
using railpatch::atan2;
using railpatch::cos;
using railpatch::sin;

}  // namespace contact_addon
