/* The same as steps.c for FMI 3.0, of which a variable may be an array:
 *   steps_fmi3 LIBRARY TOKEN RESOURCES LOADS MOVED START REFERENCE:LENGTH...
 * START is the value of MOVED, or its values with commas between them; all go on by 1e-8 in each of
 * 100 steps. Prints the Float64 outputs in hexadecimal, a line for each element. */
#include <string.h>

#include "fmi3Functions.h"
#include "library.h"

enum { LONGEST = 64 };

static void say(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                fmi3String message) {
  (void)environment;
  fprintf(stderr, "status %d, %s: %s\n", (int)status, category, message);
}

/* numbers with commas between them; gives how many */
static size_t numbers(const char *text, double *values) {
  size_t count = 0;
  for (char *end; *text != '\0' && count < LONGEST; text = *end == ',' ? end + 1 : end) {
    values[count++] = strtod(text, &end);
    check(end != text, "a number");
  }
  return count;
}

int main(int count, char **arguments) {
  check(count > 7, "seven arguments or more");
  void *library = load(arguments[1], atoi(arguments[4]));
  FUNCTION(fmi3InstantiateCoSimulation);
  FUNCTION(fmi3EnterInitializationMode);
  FUNCTION(fmi3ExitInitializationMode);
  FUNCTION(fmi3SetFloat64);
  FUNCTION(fmi3DoStep);
  FUNCTION(fmi3GetFloat64);
  FUNCTION(fmi3Terminate);
  FUNCTION(fmi3FreeInstance);
  fmi3Instance slave =
      fmi3InstantiateCoSimulation_("slave", arguments[2], arguments[3], fmi3False, fmi3True,
                                   fmi3False, fmi3False, NULL, 0, NULL, say, NULL);
  check(slave != NULL, "instantiate");
  check(fmi3EnterInitializationMode_(slave, fmi3False, 0.0, 0.0, fmi3False, 0.0) == fmi3OK,
        "enter");
  check(fmi3ExitInitializationMode_(slave) == fmi3OK, "exit");
  const fmi3ValueReference moved = (fmi3ValueReference)strtoul(arguments[5], NULL, 10);
  double values[LONGEST], now[LONGEST];
  const size_t length = numbers(arguments[6], values);
  const double step = 1e-3;
  for (int k = 0; k < 100; ++k) {
    for (size_t i = 0; i < length; ++i) now[i] = values[i] + 1e-8 * k;
    fmi3Boolean event, ended, early;
    fmi3Float64 reached;
    check(fmi3SetFloat64_(slave, &moved, 1, now, length) == fmi3OK, "set");
    check(fmi3DoStep_(slave, k * step, step, fmi3True, &event, &ended, &early, &reached) == fmi3OK,
          "step");
    check(!ended && !early, "the whole step");
  }
  for (int i = 7; i < count; ++i) {
    const fmi3ValueReference reference = (fmi3ValueReference)strtoul(arguments[i], NULL, 10);
    const char *colon = strchr(arguments[i], ':');
    const size_t size = colon == NULL ? 1 : strtoul(colon + 1, NULL, 10);
    check(size >= 1 && size <= LONGEST, "a length");
    check(fmi3GetFloat64_(slave, &reference, 1, now, size) == fmi3OK, "get");
    for (size_t k = 0; k < size; ++k)
      printf("%u[%u] %a\n", (unsigned)reference, (unsigned)k, now[k]);
  }
  check(fmi3Terminate_(slave) == fmi3OK, "terminate");
  fmi3FreeInstance_(slave);
  check(close_library(library), "unload");
  return 0;
}
