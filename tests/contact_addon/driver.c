/* The calls of two programs that come with CONTACT, in their order, by our own header:
 *   driver basic DIR [repeat]       ellipse and own grid, material with plastic layer, falling
 * friction driver wheels RAIL WHEEL POSITIONS DIR  a wheelset's two wheels on rails; POSITIONS: one
 * line of y (mm), roll, yaw (rad), pitch rate (rad/s) each Every number is printed as "name value".
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact_addon.h"

static void fail(const char *what, int code) {
  fprintf(stderr, "%s: %d\n", what, code);
  exit(1);
}

static void begin(const char *folder) {
  int units[3] = {11, 12, 13}, count = 3, version = 0, error = 1, output = 0;
  int len_folder = (int)strlen(folder), blank = 1, len_name = 6;
  cntc_setfileunits(&count, units);
  cntc_initializefirst(&version, &error, &output, folder, " ", "driver", &len_folder, &blank,
                       &len_name);
  if (version < 2500 || error != 0) fail("initializefirst", error);
  int codes[2] = {2000, 2003}, values[2] = {2, 1};
  count = 2;
  cntc_setglobalflags(&count, codes, values);
}

static void print_patch(int ire, int icp, const char *name) {
  double pen, fn, fx, fy, mz, c, h, s, p, t, vx, vy, phi, dx, dy, cpu, wall, temps[2];
  int mx = 0, my = 0;
  cntc_getpenetration(&ire, &icp, &pen);
  cntc_getcreepages(&ire, &icp, &vx, &vy, &phi);
  cntc_getcontactforces(&ire, &icp, &fn, &fx, &fy, &mz);
  cntc_getnumelements(&ire, &icp, &mx, &my);
  cntc_getgriddiscretization(&ire, &icp, &dx, &dy);
  cntc_getcontactpatchareas(&ire, &icp, &c, &h, &s);
  cntc_getmaximumpressure(&ire, &icp, &p);
  cntc_getmaximumtraction(&ire, &icp, &t);
  cntc_getmaximumtemperature(&ire, &icp, temps, temps + 1);
  printf("%s.pen %.17g\n%s.cksi %.17g\n%s.ceta %.17g\n%s.cphi %.17g\n", name, pen, name, vx, name,
         vy, name, phi);
  printf("%s.fn %.17g\n%s.fx %.17g\n%s.fy %.17g\n%s.mz %.17g\n", name, fn, name, fx, name, fy, name,
         mz);
  printf("%s.mx %d\n%s.my %d\n%s.dx %.17g\n%s.dy %.17g\n", name, mx, name, my, name, dx, name, dy);
  printf("%s.area %.17g\n%s.adhesion %.17g\n%s.slip %.17g\n", name, c, name, h, name, s);
  printf("%s.pmax %.17g\n%s.tmax %.17g\n%s.temp1 %.17g\n%s.temp2 %.17g\n", name, p, name, t, name,
         temps[0], name, temps[1]);
  int n = mx * my;
  double *pn = malloc(sizeof(double) * (size_t)n * 5), *px = pn + n, *py = px + n, *sx = py + n,
         *sy = sx + n;
  int *el = malloc(sizeof(int) * (size_t)n);
  cntc_gettractions(&ire, &icp, &n, pn, px, py);
  cntc_getmicroslip(&ire, &icp, &n, sx, sy);
  cntc_getelementdivision(&ire, &icp, &n, el);
  int most[2] = {0, 0}, counts[4] = {0, 0, 0, 0};
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < n; ++i) {
    if (px[i] * px[i] + py[i] * py[i] > px[most[0]] * px[most[0]] + py[most[0]] * py[most[0]])
      most[0] = i;
    if (sx[i] * sx[i] + sy[i] * sy[i] > sx[most[1]] * sx[most[1]] + sy[most[1]] * sy[most[1]])
      most[1] = i;
    if (el[i] >= 0 && el[i] < 4) ++counts[el[i]];
    sum[0] += pn[i] * dx * dy;
    sum[1] += px[i] * dx * dy;
    sum[2] += py[i] * dx * dy;
  }
  printf("%s.sum_pn %.17g\n%s.sum_px %.17g\n%s.sum_py %.17g\n", name, sum[0], name, sum[1], name,
         sum[2]);
  printf("%s.traction_ix %d\n%s.traction_iy %d\n", name, most[0] % mx + 1, name, most[0] / mx + 1);
  printf("%s.slip_ix %d\n%s.slip_iy %d\n%s.slip_max %.17g\n", name, most[1] % mx + 1, name,
         most[1] / mx + 1, name, hypot(sx[most[1]], sy[most[1]]));
  printf("%s.exterior %d\n%s.stick %d\n%s.slipping %d\n%s.plastic %d\n", name, counts[0], name,
         counts[1], name, counts[2], name, counts[3]);
  cntc_getcalculationtime(&ire, &icp, &cpu, &wall);
  if (!(wall > 0)) fail("no time", 0);
  free(pn);
  free(el);
}

static void set_up_basic(int ire, int icp) {
  int codes[] = {1933, 1970, 1972, 1983}, values[] = {1935, 2, 3, 0}, count = 4;
  cntc_setflags(&ire, &icp, &count, codes, values);
  int meta_codes[] = {2011, 2012};
  double meta[] = {0.5, 1.25};
  count = 2;
  cntc_setmetadata(&ire, &icp, &count, meta_codes, meta);
  double velocity = 24, chi = 0, dq = 0.0005, vx = 0.001, vy = 0, phi = 0.4;
  cntc_setreferencevelocity(&ire, &icp, &velocity);
  cntc_setrollingstepsize(&ire, &icp, &chi, &dq);
  cntc_setcreepages(&ire, &icp, &vx, &vy, &phi);
  if (ire == 1) {
    int m = 0, four = 4, l = 0, two = 2, kind = -3, five = 5, g = 0, one = 1;
    double steel[] = {.28, .28, 82e9, 82e9}, mu[] = {.3, .3}, pen = 5e-5;
    double ellipse[] = {21, 33, .00425, .007, 21. / 17.};
    cntc_setmaterialparameters(&ire, &icp, &m, &four, steel);
    cntc_setfrictionmethod(&ire, &icp, &l, &two, mu);
    cntc_setpenetration(&ire, &icp, &pen);
    cntc_sethertzcontact(&ire, &icp, &kind, &five, ellipse);
    int ints[] = {999, 30, 30, 1};
    double eps[] = {1e-4};
    cntc_setsolverflags(&ire, &icp, &g, &four, ints, &one, eps);
  } else {
    int m = 4, eight = 8, l = 5, three = 3, kind = 1, six = 6, base = 9, n = 23 * 33;
    double layer[] = {.28, .28, 82e9, 82e9, 100e6, 1e-5, 0, 0},
           polach[] = {.3, .6, 0.69314718055994531 / 1.25};
    double fn = 42083, grid[] = {23, 33, -.00725, -.00725, .0005, .0005}, h[23 * 33];
    cntc_setfrictionmethod(&ire, &icp, &l, &three, polach);
    cntc_setmaterialparameters(&ire, &icp, &m, &eight, layer);
    cntc_setnormalforce(&ire, &icp, &fn);
    cntc_setpotcontact(&ire, &icp, &kind, &six, grid);
    for (int i = 0; i < n; ++i) {
      const double x = -.00725 + .0005 * (i % 23 + .5), y = -.00725 + .0005 * (i / 23 + .5);
      h[i] = 1.214 * x * x + .5731 * y * y;
    }
    cntc_setundeformeddistc(&ire, &icp, &base, &n, h);
  }
}

static int solve(int ire, int icp) {
  int error = -1;
  cntc_calculate(&ire, &icp, &error);
  return error;
}

static void basic(const char *folder, int repeat) {
  begin(folder);
  int icp = 2, one = 1, two = 2, version, error, three = 3, len = 1;
  for (int ire = 1; ire <= 2; ++ire) {
    cntc_initialize(&ire, &three, &version, &error, " ", &len);
    if (error != 0) fail("initialize", error);
    set_up_basic(ire, icp);
  }
  printf("first.error %d\n", solve(1, icp));
  double hertz[10];
  int ten = 10;
  cntc_gethertzcontact(&one, &icp, &ten, hertz);
  for (int i = 0; i < 10; ++i) printf("first.hertz%d %.17g\n", i, hertz[i]);
  print_patch(1, icp, "first");
  printf("second.error %d\n", solve(2, icp));
  print_patch(2, icp, "second");
  double fn = 19563, vx = .001, vy = 0, phi = -.3;
  cntc_setnormalforce(&two, &icp, &fn);
  cntc_setcreepages(&two, &icp, &vx, &vy, &phi);
  printf("third.error %d\n", solve(2, icp));
  print_patch(2, icp, "third");
  cntc_finalize(&two);
  printf("fourth.error %d\n", solve(1, icp));
  print_patch(1, icp, "fourth");
  for (int i = 0; i < repeat; ++i) solve(1, icp);
  cntc_finalize(&one);
}

static void set_up_wheel(int ire, const char *rail, const char *wheel) {
  int version, error, module = 1, len = 1, all = -1;
  cntc_initialize(&ire, &module, &version, &error, " ", &len);
  if (error != 0) fail("initialize", error);
  int codes[] = {1933, 1967, 1972, 1970, 1977, 1993},
      values[] = {1934, ire == 1 ? 0 : 1, 3, 2, 2, 20000};
  int count = 6;
  cntc_setflags(&ire, &all, &count, codes, values);
  int g = 0, four = 4, one = 1, m = 0, l = 0, two = 2, kind = -1, five = 5, z = 3, eleven = 11,
      e = 3, three = 3;
  int ints[] = {999, 100, 30, 1};
  double eps[] = {1e-5}, steel[] = {.28, .28, 82000, 82000}, mu[] = {.3, .3};
  double grid[] = {.2, .2, 1.5707963267948966, 8, 4}, chi = 0, dq = 1;
  double track[] = {14, 0, 1435, 0, 0, 0, 0, 0, 0, 0, 0}, sizes[] = {1360, -70, 460};
  cntc_setsolverflags(&ire, &all, &g, &four, ints, &one, eps);
  cntc_setmaterialparameters(&ire, &all, &m, &four, steel);
  cntc_setfrictionmethod(&ire, &all, &l, &two, mu);
  cntc_setpotcontact(&ire, &all, &kind, &five, grid);
  cntc_setrollingstepsize(&ire, &all, &chi, &dq);
  cntc_settrackdimensions(&ire, &z, &eleven, track);
  int profile_ints[] = {0, 0, 0, 0, 0, 0}, n_ints = 6, n_reals = 2, length = (int)strlen(rail);
  double profile_reals[] = {1, 0};
  cntc_setprofileinputfname(&ire, rail, &length, &n_ints, profile_ints, &n_reals, profile_reals);
  cntc_setwheelsetdimensions(&ire, &e, &three, sizes);
  profile_ints[0] = 1;
  length = (int)strlen(wheel);
  cntc_setprofileinputfname(&ire, wheel, &length, &n_ints, profile_ints, &n_reals, profile_reals);
  int block = 1, kind_of_block = 9, nx = 1, ny = 1, nz = 3;
  double x[] = {0}, y[] = {0}, depth[] = {0.5, 1, 2};
  subs_addblock(&ire, &all, &block, &kind_of_block, &nx, &ny, &nz, x, y, depth);
}

static void move(int ire, const double *at) {
  int e = 2, six = 6;
  double position[] = {0, at[0], 0, at[1], at[2], 0}, velocity[] = {2000, 0, 0, 0, 0, at[3]},
         force = 10000;
  cntc_setwheelsetposition(&ire, &e, &six, position);
  cntc_setwheelsetvelocity(&ire, &e, &six, velocity);
  cntc_setverticalforce(&ire, &force);
}

static void wheels(const char *rail, const char *wheel, FILE *positions, const char *folder) {
  double at[4];
  begin(folder);
  for (int ire = 1; ire <= 2; ++ire) set_up_wheel(ire, rail, wheel);
  for (int k = 0; fscanf(positions, "%lf %lf %lf %lf", at, at + 1, at + 2, at + 3) == 4; ++k)
    for (int ire = 1; ire <= 2; ++ire) {
      int all = -1, count = 24, patches = 0;
      move(ire, at);
      char name[40];
      snprintf(name, sizeof name, "%s%d", ire == 1 ? "left" : "right", k);
      printf("%s.error %d\n", name, solve(ire, all));
      double force[24], place[38];
      cntc_getglobalforces(&ire, &all, &count, force);
      for (int i = 0; i < 24; ++i) printf("%s.force%d %.17g\n", name, i, force[i]);
      cntc_getnumcontactpatches(&ire, &patches);
      printf("%s.patches %d\n", name, patches);
      for (int icp = 1; icp <= patches; ++icp) {
        char patch[60];
        snprintf(patch, sizeof patch, "%s.%d", name, icp);
        count = 38;
        cntc_getcontactlocation(&ire, &icp, &count, place);
        for (int i = 0; i < 38; ++i) printf("%s.place%d %.17g\n", patch, i, place[i]);
        print_patch(ire, icp, patch);
      }
      if (ire == 2 && k == 11) {
        int error = -1, block = 1, nx, ny, nz, icp = 1, columns[] = {1, 2, 3, 8}, four = 4;
        subs_calculate(&ire, &all, &error);
        subs_getblocksize(&ire, &icp, &block, &nx, &ny, &nz);
        printf("block.error %d\nblock.size %d\n", error, nx * ny * nz);
        int n = nx * ny * nz;
        double values[4 * 64];
        if (n > 64) fail("block", n);
        subs_getresults(&ire, &icp, &block, &n, &four, columns, values);
        for (int i = 0; i < 4 * n; ++i) printf("block.value%d %.17g\n", i, values[i]);
      }
      if (k == 0) { /* what was set holds on */
        int codes[] = {1977, 1978}, values[] = {1, 1}, two = 2, g = 1, none = 0, l = 1, zero = 0;
        cntc_setflags(&ire, &all, &two, codes, values);
        cntc_setsolverflags(&ire, &all, &g, &none, NULL, &none, NULL);
        cntc_setfrictionmethod(&ire, &all, &l, &none, NULL);
        cntc_settrackdimensions(&ire, &zero, &none, NULL);
        cntc_setwheelsetdimensions(&ire, &zero, &none, NULL);
      }
    }
  cntc_finalizelast();
}

int main(int count, char **arguments) {
  if (count > 2 && strcmp(arguments[1], "basic") == 0) {
    basic(arguments[2], count > 3 ? atoi(arguments[3]) : 0);
  } else if (count > 5 && strcmp(arguments[1], "wheels") == 0) {
    FILE *positions = fopen(arguments[4], "r");
    if (!positions) fail("no positions", 0);
    wheels(arguments[2], arguments[3], positions, arguments[5]);
    fclose(positions);
  } else {
    return 2;
  }
  return 0;
}
