/* Libraries of any system for steps.c and steps_fmi3.c, and how these end. */
#ifndef RAILPATCH_CROSS_LIBRARY_H
#define RAILPATCH_CROSS_LIBRARY_H

#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) {
  return (void *)GetProcAddress((HMODULE)library, name);
}
static int close_library(void *library) { return FreeLibrary((HMODULE)library) != 0; }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
static int close_library(void *library) { return dlclose(library) == 0; }
#endif

static void check(int good, const char *what) {
  if (good) return;
  fprintf(stderr, "failed: %s\n", what);
  exit(1);
}

/* loads and unloads it so many times, then loads it */
static void *load(const char *path, int times) {
  for (int i = 0; i < times; ++i) {
    void *once = open_library(path);
    check(once != NULL && close_library(once), "load and unload");
  }
  void *library = open_library(path);
  check(library != NULL, "load");
  return library;
}

/* a variable of the function's name with an underscore, found in `library` */
#define FUNCTION(name)                                      \
  name##TYPE *name##_ = (name##TYPE *)find(library, #name); \
  check(name##_ != NULL, #name)

#endif
