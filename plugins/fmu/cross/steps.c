/* Runs an unpacked FMU and prints its outputs, by nothing but the library's functions, so that the
 * same program tries the library of any system:
 *   steps LIBRARY GUID RESOURCES LOADS MOVED START REFERENCE...
 * Loads and unloads the library LOADS times; then makes 100 steps in which the input MOVED goes on
 * by 1e-8 each, and prints the Real outputs in hexadecimal. Exit code 0 where all went well. */
#include "fmi2Functions.h"
#include "library.h"

static void say(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                fmi2String category, fmi2String message, ...) {
  (void)environment;
  fprintf(stderr, "%s: status %d, %s: %s\n", name, (int)status, category, message);
}

int main(int count, char **arguments) {
  check(count > 7, "seven arguments or more");
  void *library = load(arguments[1], atoi(arguments[4]));
  FUNCTION(fmi2Instantiate);
  FUNCTION(fmi2SetupExperiment);
  FUNCTION(fmi2EnterInitializationMode);
  FUNCTION(fmi2ExitInitializationMode);
  FUNCTION(fmi2SetReal);
  FUNCTION(fmi2DoStep);
  FUNCTION(fmi2GetReal);
  FUNCTION(fmi2Terminate);
  FUNCTION(fmi2FreeInstance);
  fmi2CallbackFunctions callbacks = {say, NULL, NULL, NULL, NULL};
  fmi2Component slave = fmi2Instantiate_("slave", fmi2CoSimulation, arguments[2], arguments[3],
                                         &callbacks, fmi2False, fmi2True);
  check(slave != NULL, "instantiate");
  check(fmi2SetupExperiment_(slave, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK, "set up");
  check(fmi2EnterInitializationMode_(slave) == fmi2OK, "enter");
  check(fmi2ExitInitializationMode_(slave) == fmi2OK, "exit");
  const fmi2ValueReference moved = (fmi2ValueReference)strtoul(arguments[5], NULL, 10);
  const double start = strtod(arguments[6], NULL), step = 1e-3;
  for (int k = 0; k < 100; ++k) {
    const double value = start + 1e-8 * k;
    check(fmi2SetReal_(slave, &moved, 1, &value) == fmi2OK, "set");
    check(fmi2DoStep_(slave, k * step, step, fmi2True) == fmi2OK, "step");
  }
  for (int i = 7; i < count; ++i) {
    const fmi2ValueReference reference = (fmi2ValueReference)strtoul(arguments[i], NULL, 10);
    double value;
    check(fmi2GetReal_(slave, &reference, 1, &value) == fmi2OK, "get");
    printf("%u %a\n", (unsigned)reference, value);
  }
  check(fmi2Terminate_(slave) == fmi2OK, "terminate");
  fmi2FreeInstance_(slave);
  check(close_library(library), "unload");
  return 0;
}
