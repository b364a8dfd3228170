#include <thread>

#include "calls.hpp"

using namespace contact_addon;

void cntc_setfileunits(int *, int *) {}  // files are opened without numbers

void cntc_initializefirst(int *ifcver, int *ierror, int *ioutput, const char *wrkdir,
                          const char *outdir, const char *expnam, int *len_wrkdir, int *len_outdir,
                          int *len_expnam) {
  CONTACT_ADDON_NEEDS("cntc_initializefirst", ifcver, ierror)
  *ifcver = version;
  *ierror = guarded("cntc_initializefirst", [&] {
    start(ioutput ? *ioutput : 1, text_of(wrkdir, len_wrkdir), text_of(outdir, len_outdir),
          text_of(expnam, len_expnam));
    return 0;
  });
}

void cntc_initializefirst_new(int *ifcver, int *ierror, int *ioutput, const char *wrkdir,
                              const char *outdir, const char *expnam, int *len_wrkdir,
                              int *len_outdir, int *len_expnam) {
  cntc_initializefirst(ifcver, ierror, ioutput, wrkdir, outdir, expnam, len_wrkdir, len_outdir,
                       len_expnam);
}

// The folder for output was said with cntc_initializefirst; nothing is written without it.
void cntc_initialize(int *ire, int *imodul, int *ifcver, int *ierror, const char *, int *) {
  const char *call = "cntc_initialize";
  CONTACT_ADDON_NEEDS(call, ire, imodul, ifcver, ierror)
  *ifcver = version;
  *ierror = guarded(call, [&] {
    const int code = make_element(*ire, *imodul);
    if (code == error_element)
      say(call, "result element " + std::to_string(*ire) + " is not in 1 ... 999");
    if (code == error_other) say(call, "module " + std::to_string(*imodul) + " is neither 1 nor 3");
    return code;
  });
}

void cntc_setglobalflags(int *count, int *codes, int *values) {
  const char *call = "cntc_setglobalflags";
  CONTACT_ADDON_NEEDS(call, count, codes, values)
  guarded(call, [&] {
    for (int i = 0; i < *count; ++i) {
      if (codes[i] == flag_threads)
        set_threads(values[i]);
      else if (codes[i] != 0 && codes[i] != flag_debug && codes[i] != flag_licence)
        say(call, "flag " + std::to_string(codes[i]) + " is unknown and ignored");
    }
    return 0;
  });
}

// Of the caller's; each solves on its own.
void cntc_getmaxnumthreads(int *count) {
  CONTACT_ADDON_NEEDS("cntc_getmaxnumthreads", count)
  const unsigned found = std::thread::hardware_concurrency();
  *count = found > 0 ? static_cast<int>(found) : 1;
}

void cntc_finalize(int *ire) {
  CONTACT_ADDON_NEEDS("cntc_finalize", ire)
  guarded("cntc_finalize", [&] {
    drop_element(*ire);
    return 0;
  });
}

void cntc_finalizelast(void) {
  guarded("cntc_finalizelast", [] {
    stop();
    return 0;
  });
}
