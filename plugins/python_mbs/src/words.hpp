// The words of every enumeration, by value: those of case files and results.
#pragma once

#include "railpatch_fields.h"

namespace railpatch::python {

template <typename Choice>
struct Words;

#define RAILPATCH_WORD(name, value, word) word,
#define RAILPATCH_WORDS(type, LIST)                              \
  template <>                                                    \
  struct Words<type> {                                           \
    static constexpr const char *all[] = {LIST(RAILPATCH_WORD)}; \
  };
RP_CHOICES(RAILPATCH_WORDS)
#undef RAILPATCH_WORDS
#undef RAILPATCH_WORD

}  // namespace railpatch::python
