"""The blocks of a case, in the order of the grammar: what each control digit asks for is read."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from railpatch.inp.digits import out_of_range
from railpatch.inp.words import Reader

# most elements that a list may have
MAX_ELEMENTS = 1_000_000
SOLVER = "MAXGS MAXIN MAXNR MAXOUT EPS"
SOLVER_MORE = {
    2: "OMEGAH OMEGAS INISLP OMGSLP",
    3: "OMEGAH OMEGAS INISLP OMGSLP",
    4: "INISLP OMGSLP",
    5: "FDECAY BETATH KDOWFB D_IFC D_LIN D_CNS D_SLP POW_S",
}
# values of one friction set, and what follows all of them
LAWS = {
    0: "FSTAT FKIN",
    2: "FKIN FLIN1 SABSH1 FLIN2 SABSH2",
    3: "FKIN FRAT1 SABSH1 FRAT2 SABSH2",
    4: "FKIN FEXP1 SABSH1 FEXP2 SABSH2",
    6: "FREF TREF DFHEAT DTHEAT",
}
MATERIALS = {
    1: "FG1 FG2 TC1 TC2",
    2: "FLX K0 ALFA BETA",
    3: "K0 ALFA BETA",
    4: "G3 LAYTHK TAU_C0 K_TAU",
    5: "K0 ALFA BETA",
}
HERTZ = {
    -1: "A1 B1 SCALE",
    -2: "A1 AOB SCALE",
    -3: "AA BB SCALE",
    -4: "A1 BB SCALE",
    -5: "AA BB SCALE",
    -6: "AA BNEG BPOS SCALE",
}
GRIDS = {1: "XL YL DX DY", 2: "XL YL XH YH", 3: "XC1 YC1 DX DY", 4: "XC1 YC1 XCM YCM"}


@dataclass(frozen=True)
class Case:
    """One case: module, patch, number, first line, control digits, what was read and what stays of
    the case before, by block."""

    module: int
    patch: tuple[int, int]
    number: int
    line: int
    digits: dict[str, int]
    blocks: dict[str, dict[str, Any]] = field(default_factory=dict)
    folder: str = ""

    @property
    def name(self) -> str:
        """For files."""
        return f"case_{self.number:03d}"


# digits of the control words from the left; of module 3 without C1
FIRST = ("C1", "P", "B", "T", "N", "F", "S")
SECOND = ("V", "L", "D", "C3", "M", "Z", "E")
THIRD = ("X", "H", "G", "I", "A", "O", "W", "R")


def control(reader: Reader, module: int) -> dict[str, int]:
    """The three control words."""
    found: dict[str, int] = {}
    for names in (FIRST if module == 1 else FIRST[1:], SECOND, THIRD):
        line, shown = reader.line, "".join(name[0] for name in names)
        word = reader.digits(f"the control word {shown}")
        if "B" in names and len(word) == 1 and reader.beside.upper() == "MODULE":
            raise reader.error(
                f"a module begins within module {module}: the last digit of HGIAOWR of the case "
                "before, R, has to be 1 to end that one",
                line,
            )
        if len(word) > len(names):
            raise reader.error(f"{shown}: {word} has too many digits", line)
        digits = dict(zip(names, map(int, word.rjust(len(names), "0")), strict=True))
        if wrong := out_of_range(module, digits):
            raise reader.error(wrong, line)
        found |= digits
        if names == SECOND:
            packed = reader.optional()
            found["M2"] = int(packed) % 10 if packed is not None else 1
            found["WGAP"] = int(packed) // 10 if packed is not None else 0
        reader.end_line()
        if names == THIRD and found["X"] == 1:
            reader.digits("PSFLCIN")
            reader.end_line()
    return found


def read_blocks(reader: Reader, case: Case) -> Case:
    """The blocks that the digits ask for, over those of the case before."""
    blocks = dict(case.blocks)
    if case.module == 1:
        _wheel(reader, case.digits, blocks)
    else:
        _basic(reader, case.digits, blocks)
    if case.digits["S"] >= 2:
        _subsurface(reader, case.digits, blocks)
    reader.end_line()
    return replace(case, blocks=blocks)


def _optional(reader: Reader, names: str, angles: tuple[str, ...] = ()) -> dict[str, float]:
    """Optional values at the end of a line; what follows them is comment."""
    found = {}
    for name in names.split():
        value = reader.optional(angle=name in angles)
        if value is None:
            break
        found[name] = value
    reader.end_line()
    return found


def _solver(reader: Reader, g: int, blocks: dict[str, Any]) -> None:
    if g == 1:
        return
    values = reader.reals(SOLVER) | _optional(reader, "NPOT_MAX")
    if g in SOLVER_MORE:
        values |= reader.reals(SOLVER_MORE[g])
        reader.end_line()
    elif g != 0:
        raise reader.error(f"G = {g}: allowed 0 ... 5")
    blocks["solver"] = values


def _friction(reader: Reader, digits: dict[str, int], blocks: dict[str, Any]) -> None:
    law, variation = digits["L"], digits["V"]
    if law == 1:
        return
    if law not in LAWS:
        raise reader.error(f"L = {law}: allowed 0 ... 4, 6")
    sets: list[dict[str, float]] = []
    count = 1
    if variation in (1, 2):
        count = reader.integer("NVF")
        if not 1 <= count <= 10:
            raise reader.error(f"NVF is {count}, allowed 1 ... 10")
    if variation == 3:
        count = int(blocks.get("grid", {}).get("MY", 1))
    for _ in range(count):
        one = {}
        if variation in (1, 2):
            one["PLACE"] = reader.real("angle or s of friction", angle=variation == 1)
        sets.append(one | reader.reals(LAWS[law]))
    memory = reader.reals("MEMDST MEM_S0") if law != 0 else {}
    reader.end_line()
    blocks["friction"] = {"L": law, "V": variation, "sets": sets, **memory, "line": reader.line}


def _material(reader: Reader, digits: dict[str, int], blocks: dict[str, Any]) -> None:
    m = digits["M"]
    values: dict[str, Any] = {"M": m} | reader.reals("NU1 NU2 G1 G2")
    if digits["B"] == 1:
        values |= reader.reals("FLXZ")
    if m in MATERIALS:
        values |= reader.reals(MATERIALS[m])
    elif m not in (0, 6, 7):
        raise reader.error(f"M = {m}: allowed 0 ... 7")
    reader.end_line()
    blocks["material"] = values


def _damping_and_heat(reader: Reader, digits: dict[str, int], blocks: dict[str, Any]) -> None:
    if digits["M2"] == 2:
        blocks["damping"] = reader.reals("CDAMPN CDAMPT DFNMAX DFTMAX")
        reader.end_line()
    elif digits["M2"] == 0:
        blocks.pop("damping", None)
    if digits["H"] == 3:
        bodies = [reader.reals("BKTEMP HEATCP LAMBDA DENS") for _ in range(2)]
        heat: dict[str, Any] = {"bodies": bodies}
        if digits["M"] == 4:
            heat |= reader.reals("BETAPL")
        reader.end_line()
        blocks["heat"] = heat
    elif digits["H"] == 0:
        blocks.pop("heat", None)


def _profile(reader: Reader) -> dict[str, Any]:
    """A profile's line, and those that it says follow."""
    line = reader.line
    reader.expect("'FILE' MIRRORY SCALE SMOOTH")
    values: dict[str, Any] = {"file": reader.string("a profile's name"), "line": line}
    values |= reader.reals("MIRRORY SCALE SMOOTH") | _optional(reader, "MIRRORZ PRFOPT")
    option = int(values.get("PRFOPT", 0))
    thresholds = ("ZIGTHRS", "KINKHIGH", "KINKLOW")
    if option >= 1:
        values |= reader.reals("ISMOOTH ZIGTHRS KINKHIGH KINKLOW KINKWID", thresholds)
        reader.end_line()
    if option >= 2:
        values |= reader.reals("ERRHND MAXOMIT")
        reader.end_line()
    return values


def _track(reader: Reader, digits: dict[str, int], blocks: dict[str, Any], roller: bool) -> None:
    z = digits["Z"]
    if z in (1, 3):
        reader.expect("GAUGHT GAUGSQ GAUGWD " + ("NOMRAD" if roller else "CANT"))
        height = reader.real("GAUGHT")
        names = "GAUGSQ GAUGWD" if height > 0 else "RAILY0 RAILZ0"
        values = {"GAUGHT": height} | reader.reals(names)
        values |= reader.reals("NOMRAD") if roller else reader.reals("CANT", ("CANT",))
        blocks["track"] = values | _optional(reader, "CURV")
    if z == 3:
        blocks["rail"] = _profile(reader)
    if z in (2, 3):
        angles = ("DROLL", "VROLL")
        blocks["deviation"] = reader.reals("DY DZ DROLL VY VZ VROLL", angles)
        reader.end_line()
        if digits["F"] == 3:
            blocks["support"] = reader.reals("KY FY KZ FZ") | _optional(reader, "DYSTEP0")
    if z > 3:
        raise reader.error(f"Z = {z}: allowed 0 ... 3")


def _wheelset(reader: Reader, digits: dict[str, int], blocks: dict[str, Any], roller: bool) -> None:
    e = digits["E"]
    if e in (3, 5):
        blocks["wheelset"] = reader.reals("FBDIST FBPOS NOMRAD") | _optional(reader, "YTAPE")
        blocks["wheel"] = _profile(reader)
    if e >= 1:
        height = "FZ" if digits["N"] == 1 else "Z"
        turns = ("ROLL", "YAW", "PITCH")
        blocks["position"] = reader.reals(f"S Y {height} ROLL YAW PITCH", turns)
        reader.end_line()
    if e >= 2:
        first = "RPITCH" if roller else "VS"
        last = {1: "FX", 2: "MY"}.get(digits["F"], "VPITCH")
        angles = ("RPITCH", "VROLL", "VYAW", "VPITCH")
        blocks["velocity"] = reader.reals(f"{first} VY VZ VROLL VYAW {last}", angles)
        reader.end_line()
    if e >= 4:
        turns = ("DROLL", "DYAW", "DPITCH", "VROLL", "VYAW", "VPITCH")
        blocks["flexibility"] = reader.reals("DX DY DZ DROLL DYAW DPITCH", turns)
        reader.end_line()
        blocks["flexibility"] |= reader.reals("VX VY VZ VROLL VYAW VPITCH", turns)
        reader.end_line()
    elif e >= 1:
        blocks.pop("flexibility", None)
    if e > 5:
        raise reader.error(f"E = {e}: allowed 0 ... 5")


def _wheel(reader: Reader, digits: dict[str, int], blocks: dict[str, Any]) -> None:
    roller = digits["C1"] in (4, 5)
    _solver(reader, digits["G"], blocks)
    _friction(reader, digits, blocks)
    if digits["C3"] >= 2:
        if digits["C3"] == 4:
            blocks["angles"] = reader.reals("IF_METH VARIANT")
            reader.end_line()
        _material(reader, digits, blocks)
    _damping_and_heat(reader, digits, blocks)
    if digits["D"] >= 2:
        values = reader.reals("DX DS DQREL A_SEP D_SEP D_COMB", ("A_SEP",))
        blocks["patches"] = values | _optional(reader, "D_TURN G_MISS")
    _track(reader, digits, blocks, roller)
    _wheelset(reader, digits, blocks, roller)


def _grid(reader: Reader, blocks: dict[str, Any]) -> None:
    reader.expect("IPOTCN")
    line = reader.line
    kind = reader.integer("IPOTCN")
    reader.end_line()
    if kind not in HERTZ and kind not in GRIDS:
        raise reader.error(f"IPOTCN is {kind}, allowed -6 ... -1, 1 ... 4{reader.told()}", line)
    values: dict[str, Any] = {"IPOTCN": kind}
    sizes = (HERTZ | GRIDS)[kind]
    reader.expect(f"MX MY {sizes}")
    values |= {name: reader.integer(name) for name in ("MX", "MY")}
    values |= {name: reader.real(name) for name in sizes.split()}
    reader.end_line()
    mx, my = values["MX"], values["MY"]
    if min(mx, my) < 1 or mx * my > MAX_ELEMENTS:
        raise reader.error(f"a grid of {mx} x {my} elements is not possible")
    blocks["grid"] = values
    if kind < 0:
        blocks.pop("distance", None)


def _distance(reader: Reader, blocks: dict[str, Any]) -> None:
    reader.expect("IBASE IPLAN")
    base, plan = reader.integer("IBASE"), reader.integer("IPLAN")
    reader.end_line()
    grid = blocks["grid"]
    count = {1: 6, 3: 8, 9: grid["MX"] * grid["MY"]}.get(base)
    values: list[float] = []
    if base == 2:
        points = reader.integer("NN")
        if not 2 <= points <= MAX_ELEMENTS:
            raise reader.error(f"NN is {points}, allowed 2 or more")
        values, count = [float(points)], 4 + points
    if count is None:
        raise reader.error(f"IBASE is {base}, allowed 1, 2, 3, 9")
    values += [reader.real("undeformed distance") for _ in range(count)]
    reader.end_line()
    if plan == 2:
        reader.reals("A1 A2 A3 A4 A5 A6")
        reader.end_line()
    elif plan == 3:
        [reader.real("rectangle") for _ in range(8)]
        reader.end_line()
    elif plan == 4:
        patches = reader.integer("NPATCH")
        if not 1 <= patches <= 100:
            raise reader.error(f"NPATCH is {patches}, allowed 1 ... 100")
        [reader.real("rectangle") for _ in range(4 * patches + patches * (patches - 1) // 2)]
        reader.end_line()
    elif plan != 1:
        raise reader.error(f"IPLAN is {plan}, allowed 1 ... 4")
    blocks["distance"] = {"IBASE": base, "IPLAN": plan, "values": values}


def _basic(reader: Reader, digits: dict[str, int], blocks: dict[str, Any]) -> None:
    _solver(reader, digits["G"], blocks)
    first = "FN" if digits["N"] == 1 else "PEN"
    second = "FX" if digits["F"] >= 1 else "CKSI"
    third = "FY" if digits["F"] == 2 else "CETA"
    values = reader.reals(f"{first} {second} {third} CPHI")
    blocks["motion"] = values | _optional(reader, "SPINXO SPINYO")
    if digits["V"] == 0:
        _friction(reader, digits, blocks)
    if digits["C3"] >= 2:
        if digits["T"] in (2, 3):
            rolling = reader.reals("CHI DQ VELOC", ("CHI",))
            blocks["rolling"] = rolling | _optional(reader, "FACPHI")
        if digits["C3"] == 4:
            blocks["angles"] = reader.reals("IF_METH VARIANT NN")
            [reader.real("angle") for _ in range(2 * min(int(blocks["angles"]["NN"]), 10000))]
            reader.end_line()
        if digits["C3"] == 9:
            blocks["influence"] = {"file": reader.string("a file of influence coefficients")}
            reader.end_line()
        _material(reader, digits, blocks)
    _damping_and_heat(reader, digits, blocks)
    if digits["D"] == 2:
        _grid(reader, blocks)
    if "grid" not in blocks:
        raise reader.error("no grid was given yet (D = 2)")
    if digits["Z"] == 2 and blocks["grid"]["IPOTCN"] > 0:
        _distance(reader, blocks)
    if digits["V"] == 3:
        _friction(reader, digits, blocks)
    if digits["E"] in (2, 3, 9):
        count = blocks["grid"]["MX"] * blocks["grid"]["MY"]
        values = [reader.real("extra rigid slip") for _ in range(2 * count)]
        reader.end_line()
        blocks["extra"] = {"values": values}
    elif digits["E"] == 0:
        blocks.pop("extra", None)


def _subsurface(reader: Reader, digits: dict[str, int], blocks: dict[str, Any]) -> None:
    reader.reals("A_s O_s")
    reader.end_line()
    if digits["S"] < 3:
        return
    blocks["below"] = {}
    while (kind := reader.integer("ISUBS")) != 0:
        reader.end_line()
        if kind in (2, 6):
            [reader.integer("IXL IXINC IXH, IYL IYINC IYH") for _ in range(6)]
        counts = []
        if kind in (3, 7, 9):
            counts = [reader.integer("NX, NY, NZ") for _ in range(3 if kind == 9 else 2)]
            _check_counts(reader, counts)
            [reader.real("a place") for _ in range(sum(counts))]
        elif kind not in (1, 2, 5, 6):
            raise reader.error(f"ISUBS is {kind}, allowed 0, 1-3, 5-7, 9")
        if kind in (1, 2, 3):
            reader.reals("NZ ZL DZ")
        elif kind != 9:
            counts = [reader.integer("NZ")]
            _check_counts(reader, counts)
            [reader.real("a depth") for _ in range(counts[0])]
        reader.end_line()


def _check_counts(reader: Reader, counts: list[int]) -> None:
    if not all(0 <= count <= MAX_ELEMENTS for count in counts):
        raise reader.error(f"{counts} places are not possible")
