/* Solves the cases of a file by the C interface and prints a hash of all numbers of each, so that
 * the same program tells whether the core gives the same bits on any system:
 *   steps CASES TABLE            a line for each case: name | errors and statuses | numbers, hash
 *   steps CASES TABLE NUMBER     all numbers of that case, in hexadecimal
 * CASES is written by interface.py, as records: a word of 4 bytes, how many doubles follow
 * (int32), a name of 120 bytes, the doubles; on systems with the first byte the lowest. TABLE is
 * the creep table of cases that need one. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "railpatch.h"
#include "railpatch_fields.h"

enum { most_arrays = 64, most_numbers = 1 << 22 };

struct record {
  char word[4];
  int32_t count;
  char name[120];
};

struct work {
  rp_config config;
  rp_input input;
  rp_contact *contact;
  rp_result result;
  char name[120], outcome[256];
  double *arrays[most_arrays];
  int array_count;
  double *numbers;
  size_t number_count;
  unsigned char *table;
  size_t table_size;
};

static void check(int good, const char *what) {
  if (good) return;
  fprintf(stderr, "failed: %s\n", what);
  exit(1);
}

/* --- numbers of a result -----------------------------------------------------------------------
 */

static void put(struct work *w, double value) {
  check(w->number_count < most_numbers, "fewer numbers in a case");
  w->numbers[w->number_count++] = value;
}

/* members of 8 bytes are doubles, of 4 integers and choices */
static void put_member(struct work *w, const void *member, size_t size, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const char *at = (const char *)member + i * (size / count);
    double value;
    int32_t integer;
    if (size / count == sizeof value) {
      memcpy(&value, at, sizeof value);
      put(w, value);
    } else {
      memcpy(&integer, at, sizeof integer);
      put(w, integer);
    }
  }
}

#define NOTHING(type, name, count)
#define PUT(type, name, count, ...) put_member(w, &r->name, sizeof r->name, count);
static void put_patch(struct work *w, const rp_patch_result *r) {
  RP_PATCH_RESULT_FIELDS(PUT, NOTHING)
}
static void put_side(struct work *w, const rp_side_result *r) {
  RP_SIDE_RESULT_FIELDS(PUT, NOTHING)
  for (int i = 0; i < r->patch_count + r->alternative_count; ++i) put_patch(w, &r->patch[i]);
}
static void put_result(struct work *w, const rp_result *r) {
  RP_RESULT_FIELDS(PUT, NOTHING)
  for (int side = 0; side < 2; ++side) put_side(w, &r->side[side]);
}

static void put_field(struct work *w, int side, int patch, rp_field field) {
  size_t count = 0;
  const rp_error error = rp_get_field(w->contact, side, patch, field, NULL, &count);
  put(w, (double)count);
  if (error != RP_ERROR_SIZE) return;
  check(w->number_count + count <= most_numbers, "fewer numbers in a case");
  check(rp_get_field(w->contact, side, patch, field, w->numbers + w->number_count, &count) == RP_OK,
        "field");
  w->number_count += count;
}

static void put_fields(struct work *w) {
#define PUT_FIELD(name, value, word) put_field(w, side, patch, name);
  for (int side = 0; side < 2; ++side) {
    const rp_side_result *r = &w->result.side[side];
    for (int patch = 0; patch < r->patch_count + r->alternative_count; ++patch) {
      RP_FIELDS(PUT_FIELD)
    }
  }
}

/* what is no number has bits of its own on each processor */
static uint64_t hash_of(const double *numbers, size_t count) {
  uint64_t hash = 14695981039346656037u;
  for (size_t i = 0; i < count; ++i) {
    uint64_t bits = 0x7ff8000000000000u;
    if (numbers[i] == numbers[i]) memcpy(&bits, &numbers[i], sizeof bits);
    for (int k = 0; k < 64; k += 8) hash = (hash ^ ((bits >> k) & 255)) * 1099511628211u;
  }
  return hash;
}

/* --- a case ------------------------------------------------------------------------------------
 */

static int set_member(void *member, size_t size, size_t count, const struct record *r,
                      const double *values) {
  check((size_t)r->count == count, r->name);
  for (size_t i = 0; i < count; ++i) {
    char *at = (char *)member + i * (size / count);
    const int32_t integer = (int32_t)values[i];
    if (size / count == sizeof(double))
      memcpy(at, &values[i], sizeof(double));
    else
      memcpy(at, &integer, sizeof integer);
  }
  return 1;
}

#define SET(type, field, count, ...) \
  if (strcmp(r->name, #field) == 0)  \
    return set_member(&target->field, sizeof target->field, count, r, values);
static int set_config(rp_config *target, const struct record *r, const double *values) {
  RP_CONFIG_FIELDS(SET, NOTHING)
  return 0;
}
static int set_input(rp_input *target, const struct record *r, const double *values) {
  RP_INPUT_FIELDS(SET, NOTHING)
  return 0;
}

/* "wheel 0 y", "runout 1", "undeformed_distance": the case keeps the values */
static void set_array(struct work *w, const struct record *r, double *values) {
  rp_config *c = &w->config;
  char body[32] = "", part[32] = "";
  int side = 0;
  check(w->array_count < most_arrays, "fewer arrays in a case");
  w->arrays[w->array_count++] = values;
  sscanf(r->name, "%31s %d %31s", body, &side, part);
  side = side != 0;
  if (strcmp(body, "undeformed_distance") == 0) {
    c->undeformed_distance = values;
  } else if (strcmp(body, "runout") == 0) {
    c->runout[side] = values;
  } else if (strcmp(body, "rail_height") == 0) {
    c->rail_height[side] = values;
  } else {
    rp_profile *profile = strcmp(body, "wheel") == 0 ? &c->wheel[side] : &c->rail[side];
    profile->count = r->count;
    if (strcmp(part, "arc_length") == 0) profile->arc_length = values;
    if (strcmp(part, "y") == 0) profile->y = values;
    if (strcmp(part, "z") == 0) profile->z = values;
    if (strcmp(part, "dy") == 0) profile->dy = values;
    if (strcmp(part, "dz") == 0) profile->dz = values;
  }
}

static void begin(struct work *w, const char *name) {
  memcpy(w->name, name, sizeof w->name);
  w->outcome[0] = '\0';
  w->number_count = 0;
  w->contact = NULL;
  rp_default_config(&w->config);
  rp_default_input(&w->input);
}

static void say(struct work *w, const char *text) {
  const size_t used = strlen(w->outcome);
  snprintf(w->outcome + used, sizeof w->outcome - used, "%s%s", used ? "," : "", text);
}

static void step(struct work *w) {
  rp_error error = RP_OK;
  if (!w->contact) {
    if (w->config.tangential == RP_TANGENTIAL_TABLE) {
      w->config.creep_table = w->table;
      w->config.creep_table_size = w->table_size;
    }
    error = rp_create(&w->config, &w->contact, NULL);
  }
  if (error == RP_OK) error = rp_step(w->contact, &w->input, &w->result, NULL);
  say(w, error == RP_OK ? rp_status_text(w->result.status) : rp_error_text(error));
  if (error != RP_OK) return;
  put_result(w, &w->result);
  put_fields(w);
}

/* the input's numbers as rates */
static void differentiate(struct work *w, const rp_input *direction) {
  rp_result change;
  rp_derivative_kind kind = RP_DERIVATIVE_EXACT;
  rp_jacobian jacobian;
  rp_error error = rp_differentiate(w->contact, direction, &change, &kind, NULL);
  if (error == RP_OK) {
    put(w, kind);
    put_result(w, &change);
  }
  say(w, rp_error_text(error));
  if (w->config.kind == RP_PATCH) return;
  error = rp_get_jacobian(w->contact, &jacobian, NULL);
  say(w, rp_error_text(error));
  if (error != RP_OK) return;
  put_member(w, jacobian.side, sizeof jacobian.side, 2 * 6 * 12);
  put_member(w, jacobian.z, sizeof jacobian.z, 12);
  put(w, jacobian.z_force);
}

static void end(struct work *w, int shown) {
  if (shown) {
    for (size_t i = 0; i < w->number_count; ++i)
      if (w->numbers[i] == w->numbers[i])
        printf("%a\n", w->numbers[i]);
      else
        printf("nan\n");
  } else {
    printf("%s | %s | %lu, %08lx%08lx\n", w->name, w->outcome, (unsigned long)w->number_count,
           (unsigned long)(hash_of(w->numbers, w->number_count) >> 32),
           (unsigned long)(hash_of(w->numbers, w->number_count) & 0xffffffffu));
  }
}

static void forget(struct work *w) {
  rp_destroy(w->contact);
  w->contact = NULL;
  for (int i = 0; i < w->array_count; ++i) free(w->arrays[i]);
  w->array_count = 0;
}

static void read_table(struct work *w, const char *path) {
  FILE *file = fopen(path, "rb");
  check(file != NULL, path);
  w->table = (unsigned char *)malloc(1 << 26);
  check(w->table != NULL, "memory");
  w->table_size = fread(w->table, 1, 1 << 26, file);
  fclose(file);
}

int main(int count, char **arguments) {
  static struct work w;
  check(count == 3 || count == 4, "two arguments or three");
  const int only = count == 4 ? atoi(arguments[3]) : -1;
  FILE *file = fopen(arguments[1], "rb");
  check(file != NULL, arguments[1]);
  read_table(&w, arguments[2]);
  w.numbers = (double *)malloc(most_numbers * sizeof(double));
  check(w.numbers != NULL, "memory");
  struct record r;
  rp_input direction;
  int number = -1;
  while (fread(&r, sizeof r, 1, file) == 1) {
    double *values = (double *)malloc((size_t)(r.count + 1) * sizeof(double));
    check(values != NULL && fread(values, sizeof(double), (size_t)r.count, file) == (size_t)r.count,
          "a whole file");
    if (memcmp(r.word, "case", 4) == 0) {
      begin(&w, r.name);
      rp_default_direction(&direction);
      ++number;
    }
    const int wanted = only < 0 || number == only;
    if (memcmp(r.word, "conf", 4) == 0) check(set_config(&w.config, &r, values), r.name);
    if (memcmp(r.word, "inpu", 4) == 0) check(set_input(&w.input, &r, values), r.name);
    if (memcmp(r.word, "rate", 4) == 0) check(set_input(&direction, &r, values), r.name);
    if (memcmp(r.word, "step", 4) == 0 && wanted) step(&w);
    if (memcmp(r.word, "diff", 4) == 0 && wanted && w.contact) differentiate(&w, &direction);
    const int kept = memcmp(r.word, "arra", 4) == 0;
    if (kept) set_array(&w, &r, values);
    if (memcmp(r.word, "done", 4) == 0) {
      if (wanted) end(&w, only >= 0);
      forget(&w);
    }
    if (!kept) free(values);
  }
  fclose(file);
  free(w.numbers);
  free(w.table);
  return 0;
}
