// cntc_readinpfile: the first case of an input file, as the calls that set the same. The grammar is
// that of railpatch/inp/blocks.py. What the calls refuse when a case is solved is refused here,
// with the file's name, and nothing is changed then.
#include <array>
#include <cmath>
#include <map>

#include "calls.hpp"
#include "mapping.hpp"
#include "words.hpp"

using namespace contact_addon;

namespace {

constexpr int whole_case = 1988, simpack_case = 1990;

struct place_of_digit {
  const char *name;
  int code;      // of cntc_setflags; 0: of another call, or none
  bool simpack;  // whether the file says it in SIMPACK's variant
};

// Control words, digits from the left.
constexpr std::array<place_of_digit, 7> first_word{{{"C1", flag_config, false},
                                                    {"P", 0, false},
                                                    {"B", flag_bound, true},
                                                    {"T", flag_tangential, true},
                                                    {"N", flag_normal, false},
                                                    {"F", flag_force, false},
                                                    {"S", 0, false}}};
constexpr std::array<place_of_digit, 7> second_word{{{"V", 0, true},
                                                     {"L", 0, true},
                                                     {"D", flag_patches, true},
                                                     {"C3", flag_influence, true},
                                                     {"M", 0, true},
                                                     {"Z", 0, true},
                                                     {"E", 0, true}}};
constexpr std::array<place_of_digit, 8> third_word{{{"X", 0, true},
                                                    {"H", 0, false},
                                                    {"G", 0, true},
                                                    {"I", 0, false},
                                                    {"A", flag_matfile, true},
                                                    {"O", flag_output, true},
                                                    {"W", flag_flow, true},
                                                    {"R", flag_return, true}}};

class input_file {
 public:
  input_file(const char *call, problem &p, words file, std::string folder, bool simpack)
      : call_(call),
        p_(p),
        ire_(p.ire),
        file_(std::move(file)),
        folder_(std::move(folder)),
        simpack_(simpack) {}

  // Raises input_error.
  void read() {
    file_.expect("MODULE REID CPID");
    const int module = file_.whole("MODULE");
    const bool fits = simpack_ ? module == 0 || module == 11 : module == 1;
    if (!fits)
      file_.fail("module " + std::to_string(module) + ": allowed " +
                 (simpack_ ? "0 or 11 in SIMPACK's variant (1990)" : "1, wheels on rails (1988)"));
    file_.end_line();
    control();
    solver();
    friction();
    if (digit("C3") >= 2) material();
    damping_and_heat();
    if (digit("D") >= 2) patches();
    track();
    wheelset();
    if (digit("S") >= 2) {
      if (!simpack_)
        file_.fail("S = " + std::to_string(digit("S")) +
                   ": blocks of points below the surface are not read, allowed 0; subs_addblock "
                   "adds them");
    }
    if (!file_.ended()) say(call_, "the first case is taken, the rest of the file is left");
  }

 private:
  int digit(const std::string &name) const { return digits_.at(name); }
  // As it counts here: of SIMPACK's variant some are the caller's.
  int flag(const char *name, int code) const { return simpack_ ? p_.flags.get(code) : digit(name); }
  bool roller() const { return flag("C1", flag_config) >= 4; }
  std::vector<double> reals(const std::vector<const char *> &names,
                            const std::string &angles = "") {
    std::vector<double> found;
    std::string line;
    for (const char *name : names) line.append(line.empty() ? "" : " ").append(name);
    file_.expect(line);
    for (const char *name : names) {
      const std::string padded = std::string(" ").append(name).append(" ");
      found.push_back(file_.real(name, angles.find(padded) != std::string::npos));
    }
    return found;
  }
  void optional(std::vector<double> &values, int most) {
    for (int i = 0; i < most; ++i) {
      const auto value = file_.optional();
      if (!value) break;
      values.push_back(*value);
    }
    file_.end_line();
  }

  template <size_t N>
  void control_word(const char *shown, const std::array<place_of_digit, N> &places) {
    std::string word = file_.digits(shown);
    if (word.size() > N) file_.fail(std::string(shown) + ": " + word + " has too many digits");
    word.insert(0, N - word.size(), '0');
    for (size_t i = 0; i < N; ++i) digits_[places[i].name] = word[i] - '0';
    for (const place_of_digit &place : places) {
      if (place.code == 0 || (simpack_ && !place.simpack)) continue;
      const int value = digit(place.name);
      const flag_rule &rule = flag_rules[static_cast<size_t>(flag_values::place_of(place.code))];
      if (value < (rule.kept_by_low ? 0 : rule.least) || value > rule.most)
        file_.fail(std::string(place.name) + " = " + std::to_string(value) + ": allowed " +
                   std::to_string(rule.least) + " ... " + std::to_string(rule.most));
      set_flag(place.code, value);
    }
  }

  void set_flag(int code, int value) {
    int all = -1, one = 1;
    cntc_setflags(&ire_, &all, &one, &code, &value);
  }

  void control() {
    control_word("the control word CPBTNFS", first_word);
    file_.end_line();
    control_word("the control word VLDCMZE", second_word);
    const int packed = static_cast<int>(file_.optional().value_or(1.0));
    digits_["M2"] = packed % 10;
    if (packed / 10 > 0)
      file_.fail("M2 = " + std::to_string(packed) +
                 ": gap weighting has no counterpart, allowed 0 ... 9");
    file_.end_line();
    control_word("the control word XHGIAOWR", third_word);
    file_.end_line();
    if (digit("X") == 1) {
      file_.digits("PSFLCIN");
      file_.end_line();
    }
    for (const char *name : {"Z", "E"})
      if (const int most = name[0] == 'Z' ? 3 : 5; digit(name) > most)
        file_.fail(std::string(name) + " = " + std::to_string(digit(name)) + ": allowed 0 ... " +
                   std::to_string(most));
    const auto keeps = [&](const char *name, const char *allowed) {
      file_.fail(std::string(name) + " = " + std::to_string(digit(name)) +
                 " keeps what was, and nothing was before the first case: allowed " + allowed);
    };
    if (digit("L") == 1) keeps("L", "0, 2 ... 4, 6");
    if (digit("D") == 0) keeps("D", "2, 4, 5");
    if (!simpack_ && (digit("S") == 1 || digit("S") == 2)) keeps("S", "0");
    if (!simpack_) {
      set_flag(flag_sequence, 2);
      set_flag(flag_start, 0);
    }
  }

  void solver() {
    const int g = digit("G");
    if (g == 1) return;
    if (g > 5) file_.fail("G = " + std::to_string(g) + ": allowed 0 ... 5");
    std::vector<double> v = reals({"MAXGS", "MAXIN", "MAXNR", "MAXOUT", "EPS"});
    file_.optional();
    file_.end_line();
    if (!(v[0] >= 1) || !(v[4] > 0))
      file_.fail("MAXGS and EPS are " + words::shown(v[0]) + " and " + words::shown(v[4]) +
                 ", allowed >= 1 and > 0");
    int ints[4];
    for (int i = 0; i < 4; ++i)
      ints[i] = static_cast<int>(std::fmin(std::fmax(v[static_cast<size_t>(i)], 0.0), 1e9));
    if (g == 2 || g == 3) reals({"OMEGAH", "OMEGAS", "INISLP", "OMGSLP"});
    if (g == 4) reals({"INISLP", "OMGSLP"});
    if (g == 5) reals({"FDECAY", "BETATH", "KDOWFB", "D_IFC", "D_LIN", "D_CNS", "D_SLP", "POW_S"});
    file_.end_line();
    // how the core solves is its own: tolerance and count are what counts
    int all = -1, zero = 0, four = 4, one = 1;
    cntc_setsolverflags(&ire_, &all, &zero, &four, ints, &one, &v[4]);
  }

  void friction() {
    const int law = digit("L"), variation = digit("V");
    static const std::map<int, std::vector<const char *>> laws{
        {0, {"FSTAT", "FKIN"}},
        {2, {"FKIN", "FLIN1", "SABSH1", "FLIN2", "SABSH2"}},
        {3, {"FKIN", "FRAT1", "SABSH1", "FRAT2", "SABSH2"}},
        {4, {"FKIN", "FEXP1", "SABSH1", "FEXP2", "SABSH2"}},
        {6, {"FREF", "TREF", "DFHEAT", "DTHEAT"}}};
    if (!laws.contains(law)) file_.fail("L = " + std::to_string(law) + ": allowed 0 ... 4, 6");
    if (variation > 2) file_.fail("V = " + std::to_string(variation) + ": allowed 0 ... 2");
    int sets = 1;
    if (variation > 0) {
      sets = file_.whole("NVF");
      if (sets < 1 || sets > 10)
        file_.fail("NVF is " + std::to_string(sets) + ", allowed 1 ... 10");
    }
    std::vector<std::vector<double>> rows;
    std::vector<double> places;
    for (int i = 0; i < sets; ++i) {
      if (variation > 0) {
        places.push_back(file_.real("angle or s of friction", variation == 1));
        if (i > 0 && !(places.back() > places[places.size() - 2]))
          file_.fail("the angle or s of friction is " + words::shown(places.back()) +
                     ", allowed more than that of the set before, " +
                     words::shown(places[places.size() - 2]));
      }
      rows.push_back(reals(laws.at(law)));
      if (law == 0 && rows.back()[0] != rows.back()[1])
        file_.fail("FSTAT is " + words::shown(rows.back()[0]) + ", allowed FKIN (" +
                   words::shown(rows.back()[1]) + ") with L = 0");
    }
    const std::vector<double> memory =
        law != 0 ? reals({"MEMDST", "MEM_S0"}) : std::vector<double>{};
    file_.end_line();
    std::vector<double> v;
    if (variation > 0) v.push_back(sets);
    for (size_t i = 0; i < rows.size(); ++i) {
      if (variation > 0) v.push_back(places[i]);
      v.insert(v.end(), rows[i].begin(), rows[i].end());
      v.insert(v.end(), memory.begin(), memory.end());
    }
    int all = -1, method = 10 * variation + law, count = static_cast<int>(v.size());
    cntc_setfrictionmethod(&ire_, &all, &method, &count, v.data());
  }

  void material() {
    if (digit("C3") == 4) {
      reals({"IF_METH", "VARIANT"});
      file_.end_line();
    }
    int m = digit("M");
    std::vector<double> v = reals({"NU1", "NU2", "G1", "G2"});
    if (digit("B") == 1) reals({"FLXZ"});
    std::vector<double> more;
    if (m == 1) more = reals({"FG1", "FG2", "TC1", "TC2"});
    if (m == 2) more = reals({"FLX", "K0", "ALFA", "BETA"});
    if (m == 3 || m == 5) more = reals({"K0", "ALFA", "BETA"});
    if (m == 4) more = reals({"G3", "LAYTHK", "TAU_C0", "K_TAU"});
    if (m > 7) file_.fail("M = " + std::to_string(m) + ": allowed 0 ... 7");
    file_.end_line();
    v.insert(v.end(), more.begin(), more.end());
    int all = -1, count = static_cast<int>(v.size());
    cntc_setmaterialparameters(&ire_, &all, &m, &count, v.data());
  }

  void damping_and_heat() {
    int all = -1;
    if (digit("M2") == 2) {
      reals({"CDAMPN", "CDAMPT", "DFNMAX", "DFTMAX"});
      file_.fail("M2 = 2, contact damping, has no counterpart");
    }
    if (simpack_) return;  // H is the caller's
    int h = digit("H");
    if (h == 2 || h > 3) file_.fail("H = " + std::to_string(h) + ": allowed 0, 1, 3");
    std::vector<double> v;
    if (h == 3) {
      for (int k = 0; k < 2; ++k) {
        const auto body = reals({"BKTEMP", "HEATCP", "LAMBDA", "DENS"});
        v.insert(v.end(), body.begin(), body.end());
      }
      v.push_back(digit("M") == 4 ? file_.real("BETAPL") : 1.0);
      file_.end_line();
    }
    int count = static_cast<int>(v.size());
    v.push_back(0);
    cntc_settemperaturedata(&ire_, &all, &h, &count, v.data());
  }

  void patches() {
    std::vector<double> v = reals({"DX", "DS", "DQREL", "A_SEP", "D_SEP", "D_COMB"}, " A_SEP ");
    optional(v, 2);
    double chi = 0, step = v[2];
    v.erase(v.begin() + 2);
    int all = -1, kind = -1, count = static_cast<int>(v.size());
    cntc_setpotcontact(&ire_, &all, &kind, &count, v.data());
    cntc_setrollingstepsize(&ire_, &all, &chi, &step);
  }

  // A profile's line, and those that it says follow.
  void profile(int type) {
    file_.expect("'FILE' MIRRORY SCALE SMOOTH MIRRORZ");
    const std::string name = file_.string(type == 0 ? "the rail's profile" : "the wheel's profile");
    std::vector<double> v = reals({"MIRRORY", "SCALE", "SMOOTH"});
    optional(v, 2);
    const double option = v.size() > 4 ? v[4] : 0.0;
    std::vector<double> curve(5), errors(2);
    if (option >= 1) {
      curve = reals({"ISMOOTH", "ZIGTHRS", "KINKHIGH", "KINKLOW", "KINKWID"},
                    " ZIGTHRS KINKHIGH KINKLOW ");
      file_.end_line();
    }
    if (option >= 2) {
      errors = reals({"ERRHND", "MAXOMIT"});
      file_.end_line();
    }
    const auto whole = [](double value) {
      return static_cast<int>(std::fmin(std::fmax(value, -9.0), 9.0));
    };
    const int ints[6] = {
        type, 0, whole(v[0]), whole(v.size() > 3 ? v[3] : 0.0), whole(errors[0]), whole(curve[0])};
    const double values[7] = {v[1], v[2], errors[1], curve[1], curve[2], curve[3], curve[4]};
    const int given = option >= 1 ? 7 : 2;
    set_profile(call_, p_, below_folder(folder_, name), 6, ints, given, values);
  }

  void track() {
    int z = digit("Z");
    const bool design = z == 1 || z == 3, moved = !simpack_ && (z == 2 || z == 3);
    std::vector<double> v;
    if (design) {
      v = reals({"GAUGHT"});
      const auto two = v[0] > 0 ? reals({"GAUGSQ", "GAUGWD"}) : reals({"RAILY0", "RAILZ0"});
      v.insert(v.end(), two.begin(), two.end());
      const double last = roller() ? file_.real("NOMRAD") : file_.real("CANT", true);
      v.push_back(roller() ? 0.0 : last);
      v.push_back(roller() ? last : 1e3 * p_.wheel.roller_radius);
      optional(v, 1);
    }
    if (z == 3) profile(0);
    if (moved) {
      const auto six = reals({"DY", "DZ", "DROLL", "VY", "VZ", "VROLL"}, " DROLL VROLL ");
      file_.end_line();
      v.insert(v.end(), six.begin(), six.end());
    }
    if (z == 3 && simpack_) z = 1;
    int count = static_cast<int>(v.size());
    if (design || moved) cntc_settrackdimensions(&ire_, &z, &count, v.data());
    if (moved && digit("F") == 3) {
      std::vector<double> support = reals({"KY", "FY", "KZ", "FZ"});
      optional(support, 1);
      z = 32;
      count = static_cast<int>(support.size());
      cntc_settrackdimensions(&ire_, &z, &count, support.data());
    }
  }

  void wheelset() {
    int e = digit("E"), count;
    if (e == 3 || e == 5) {
      std::vector<double> v = reals({"FBDIST", "FBPOS", "NOMRAD"});
      optional(v, 1);
      count = static_cast<int>(v.size());
      cntc_setwheelsetdimensions(&ire_, &e, &count, v.data());
      profile(1);
    }
    if (simpack_) return;  // position, velocity and deviations are the caller's
    const int force = digit("F");
    if (e >= 1) {
      const bool given = digit("N") == 1;
      auto v = reals({"S", "Y", given ? "FZ" : "Z", "ROLL", "YAW", "PITCH"}, " ROLL YAW PITCH ");
      file_.end_line();
      if (given) {
        cntc_setverticalforce(&ire_, &v[2]);
        v[2] = 0;
      }
      count = 6;
      cntc_setwheelsetposition(&ire_, &e, &count, v.data());
    }
    if (e >= 2) {
      auto v = reals({roller() ? "RPITCH" : "VS", "VY", "VZ", "VROLL", "VYAW",
                      force == 1   ? "FX"
                      : force == 2 ? "MY"
                                   : "VPITCH"},
                     " RPITCH VROLL VYAW VPITCH ");
      file_.end_line();
      if (force == 1) {
        int all = -1;
        double none = 0;
        cntc_settangentialforces(&ire_, &all, &v[5], &none);
        v[5] = 0;
      }
      count = 6;
      cntc_setwheelsetvelocity(&ire_, &e, &count, v.data());
    }
    std::vector<double> bent;
    if (e >= 4) {
      const std::string angles = " DROLL DYAW DPITCH VROLL VYAW VPITCH ";
      bent = reals({"DX", "DY", "DZ", "DROLL", "DYAW", "DPITCH"}, angles);
      file_.end_line();
      const auto rates = reals({"VX", "VY", "VZ", "VROLL", "VYAW", "VPITCH"}, angles);
      file_.end_line();
      bent.insert(bent.end(), rates.begin(), rates.end());
    }
    if (e >= 1) {
      count = static_cast<int>(bent.size());
      cntc_setwheelsetflexibility(&ire_, &e, &count, bent.data());
    }
  }

  const char *call_;
  problem &p_;
  int ire_;
  words file_;
  std::string folder_;
  bool simpack_;
  std::map<std::string, int> digits_;
};

// What a file may change.
struct settings {
  flag_values flags;
  material_data material;
  friction_data friction;
  heat_data heat;
  solver_data solver;
  wheel_data wheel;
  decltype(problem::refused) refused;

  explicit settings(const problem &p)
      : flags(p.flags),
        material(p.material),
        friction(p.friction),
        heat(p.heat),
        solver(p.solver),
        wheel(p.wheel),
        refused(p.refused) {}
  void give_back(problem &p) const {
    p.flags = flags;
    p.material = material;
    p.friction = friction;
    p.heat = heat;
    p.solver = solver;
    p.wheel = wheel;
    p.refused = refused;
    p.changed = true;
  }
};

int read_input_file(const char *call, problem &p, int type, const std::string &path) {
  if (type != whole_case && type != simpack_case) {
    say(call, "type " + std::to_string(type) + " has no counterpart: 1988, or 1990 (SIMPACK)");
    return error_input_file;
  }
  const settings before(p);
  const int unit = p.flags.get(flag_units);
  std::string said, why;
  p.flags.set(flag_units, 1934, said);
  try {
    input_file file(call, p, words::of_file(path), path.substr(0, path.find_last_of("/\\") + 1),
                    type == simpack_case);
    file.read();
    map_case(p, false);
  } catch (const input_error &error) {
    why = error.what();
  } catch (const refusal &error) {
    why = path + ": " + error.text;
  }
  if (!why.empty()) {
    before.give_back(p);
    say(call, why);
    return error_input_file;
  }
  p.flags.set(flag_units, unit, said);
  p.changed = true;
  return error_none;
}

}  // namespace

void cntc_readinpfile(int *ire, int *type, const char *name, int *len_name, int *ierror) {
  const char *call = "cntc_readinpfile";
  CONTACT_ADDON_NEEDS(call, ire, type, name, len_name, ierror)
  *ierror = with_problem(call, *ire, -1, modules::wheels, patches::element, true, [&](problem &p) {
    return read_input_file(call, p, *type, below_folder(work_folder(), text_of(name, len_name)));
  });
}
