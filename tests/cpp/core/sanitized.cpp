// Compiled by each build for itself, where the objects of a test may be another's.
#include "../scenes.hpp"

namespace scenes {

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define RP_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(RP_SANITIZED)
const bool sanitized = true;
#else
const bool sanitized = false;
#endif

}  // namespace scenes
