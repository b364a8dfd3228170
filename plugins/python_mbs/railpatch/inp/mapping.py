"""From a case of an input file to a case here: SI, wheel minus rail. What has no counterpart is an
error that names it and its line."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from railpatch.errors import CaseError
from railpatch.inp.blocks import Case
from railpatch.inp.digits import (
    FACTORS,
    NORMAL,
    REFUSED,
    REFUSED_ON_WHEELS,
    REGIME,
    SHAPE,
    USUAL,
)
from railpatch.inp.profiles import profiles_of, put_sections

MM = 1e-3


class Mapping:
    """One case on its way. ``refuse`` raises with file and line."""

    def __init__(self, case: Case, name: str, folder: Path = Path()) -> None:
        self.case, self.digits, self.blocks = case, case.digits, case.blocks
        self.name, self.folder = name, folder
        self.offset = (0.0, 0.0)  # m, of the grid's middle

    def refuse(self, what: str) -> CaseError:
        """To be raised."""
        case = self.case
        return CaseError(
            f"{self.name}, line {case.line}, case {case.number}: {what} has no counterpart"
        )

    def check(self, table: dict[str, dict[int, str]]) -> None:
        """Raises where a digit is one of those refused."""
        for digit, values in table.items():
            if (why := values.get(self.digits.get(digit, 0))) is not None:
                raise self.refuse(f"{digit} = {self.digits[digit]} ({why})")

    @property
    def tangential(self) -> bool:
        """Whether there is a tangential problem."""
        return self.digits["T"] != 0

    def tables(self) -> dict[str, Any]:
        """The case."""
        self.check(REFUSED)
        if self.digits["M2"] == 2 or "damping" in self.blocks:
            raise self.refuse("M2 = 2 (contact damping)")
        if self.digits["WGAP"] > 0:
            raise self.refuse("gap weighting")
        tables = self._wheel() if self.case.module == 1 else self._basic()
        tables |= self._materials()
        if self.tangential:
            tables["friction"] = self._friction()
        if "heat" in self.blocks:
            tables["temperature"] = self._heat()
        return tables

    def _materials(self) -> dict[str, Any]:
        m = self.blocks.get("material")
        if m is None:
            raise self.refuse("a case without material (C3 >= 2)")
        found: dict[str, Any] = {
            "material": {
                "shear_modulus": [1e6 * m["G2"], 1e6 * m["G1"]],
                "poisson_ratio": [m["NU2"], m["NU1"]],
            }
        }
        kind = m["M"]
        if kind == 1:
            found["material"] |= self._viscous(m)
        if kind == 2:
            raise self.refuse("M = 2 (one flexibility)")
        if kind == 4 and self.tangential:
            layer = {"thickness": MM * m["LAYTHK"]}
            if m["LAYTHK"] > 0:
                layer["shear_modulus"] = 1e6 * m["G3"]
            if 0 < m["TAU_C0"] < 1e10:
                layer |= {"yield_stress": 1e6 * m["TAU_C0"], "hardening": 1e9 * m["K_TAU"]}
                if "heat" in self.blocks:
                    layer["plastic_heat_fraction"] = self.blocks["heat"].get("BETAPL", 1.0)
            found["layer"] = layer
        return found

    def _viscous(self, m: dict[str, Any]) -> dict[str, Any]:
        """Ratios and times of rail and wheel, of basic contacts in steady rolling along x."""
        if self.case.module == 1:
            raise self.refuse("M = 1 (viscoelastic bodies) of wheels")
        if self.digits["T"] != 3:
            raise self.refuse(f"M = 1 (viscoelastic bodies) with T = {self.digits['T']}")
        if self.blocks["grid"]["IPOTCN"] < 0:
            raise self.refuse("M = 1 (viscoelastic bodies) with an ellipse (IPOTCN < 0)")
        ratio = [m["FG2"], m["FG1"]]
        if not any(ratio):
            return {}
        times = [m["TC2"], m["TC1"]]
        times = [time if f > 0 else 0.0 for f, time in zip(ratio, times, strict=True)]
        return {"viscoelastic_ratio": ratio, "relaxation_time": times}

    def _method(self) -> dict[str, Any]:
        d, m = self.digits, self.blocks.get("material", {"M": 0})
        solver = self.blocks.get("solver")
        if solver is None:
            raise self.refuse("a case without solver settings (G)")
        method: dict[str, Any] = {
            "normal": NORMAL[d["B"]],
            "tolerance": min(max(solver["EPS"], 1e-12), 0.1),
            "max_iterations": int(min(max(solver["MAXGS"], 1), 100000)),
        }
        kind = m["M"]
        if not self.tangential:
            return method
        if kind in (3, 5, 6, 7) and d["T"] != 3:
            raise self.refuse(f"M = {kind} with T = {d['T']}")
        if kind == 3:
            method |= {"tangential": "fastsim", "flexibility_blending": "contact"}
            method |= {f"fastsim_{a}": m[b] for a, b in FACTORS.items()}
            if d["B"] in (2, 3):
                method["traction_bound"] = "parabolic" if d["B"] == 3 else "elliptic"
        elif kind in (5, 6, 7):
            if kind == 5 and not m["K0"] == m["ALFA"] == 1:
                raise self.refuse("M = 5 with K0 or ALFA other than 1")
            blending = "none" if kind == 6 else "sliding"
            method |= {"tangential": "fastrip", "flexibility_blending": blending}
        elif d["B"] == 3:
            raise self.refuse("B = 3 (the parabolic bound) without FASTSIM")
        else:
            method["spin_offset"] = "sixth" if d["T"] == 3 else "none"
            if d["T"] == 1:
                del method["spin_offset"]
        return method

    def _friction(self) -> dict[str, Any]:
        f = self.blocks.get("friction")
        if f is None:
            raise self.refuse("a case without friction (L)")
        law, one = f["L"], f["sets"][0]
        if law == 0:
            if one["FSTAT"] != one["FKIN"]:
                raise self.refuse(
                    f"L = 0 with FSTAT other than FKIN (its line of friction has {one['FSTAT']:g} "
                    f"and {one['FKIN']:g})"
                )
            table: dict[str, Any] = {"coefficient": one["FSTAT"]}
        elif law == 6:
            if f["MEMDST"] != 0:
                raise self.refuse("L = 6 with a memory distance")
            if "heat" not in self.blocks:
                raise self.refuse("L = 6 without temperatures (H = 3)")
            table = {
                "law": "temperature",
                "reference": one["FREF"],
                "change": one["DFHEAT"],
                "reference_temperature": one["TREF"],
                "temperature_range": one["DTHEAT"],
            }
        else:
            table = self._falling(law, list(one.values())[-5:], f)
        return table | self._variation(f)

    def _falling(self, law: int, values: list[float], f: dict[str, Any]) -> dict[str, Any]:
        kinetic, f1, s1, f2, s2 = values
        if law == 3 and f2 != 0:
            raise self.refuse("L = 3 with a second term")
        table: dict[str, Any] = {
            "law": "slip_velocity",
            "shape": SHAPE[law],
            "kinetic": kinetic,
            "amplitude": f1,
            "halving_speed": MM * s1 if s1 > 0 else 1.0,
        }
        if f2 != 0:
            table |= {"amplitude": [f1, f2], "halving_speed": [MM * s1, MM * s2]}
        if f["MEMDST"] > 0:
            table |= {
                "memory_distance": MM * f["MEMDST"],
                "memory_speed": max(MM * f["MEM_S0"], 1e-9),
            }
        return table

    def _variation(self, f: dict[str, Any]) -> dict[str, Any]:
        sets = f["sets"]
        if f["V"] == 0 or len(sets) == 1:
            return {}
        if f["V"] == 3:
            raise self.refuse("V = 3 (friction by row)")
        scaled = {"FSTAT", "FKIN", "FREF", "DFHEAT"}
        points = []
        for one in sets:
            names = [name for name in one if name != "PLACE"]
            first = names[0]
            factor = one[first] / sets[0][first] if sets[0][first] else math.nan
            for name in names:
                grows = name in scaled or name.startswith(("FLIN", "FRAT", "FEXP"))
                wanted = sets[0][name] * (factor if grows else 1.0)
                if not math.isclose(one[name], wanted, rel_tol=1e-9, abs_tol=1e-12):
                    raise self.refuse("friction sets that are no multiples of the first")
            points.append([one["PLACE"], factor])
        if f["V"] == 2:
            return {"along_track": [[MM * place, factor] for place, factor in points]}
        cant = self.blocks["track"].get("CANT", 0.0)
        return {"factor": [[cant - place, factor] for place, factor in reversed(points)]}

    def _heat(self) -> dict[str, Any]:
        if self.digits["T"] != 3:
            raise self.refuse("temperatures (H = 3) beside T = 3")
        rail, wheel = self.blocks["heat"]["bodies"]
        both = (wheel, rail)
        return {
            "wheel": wheel["BKTEMP"],
            "rail": rail["BKTEMP"],
            "heat_capacity": [body["HEATCP"] for body in both],
            "conductivity": [1e3 * body["LAMBDA"] for body in both],
            "density": [1e9 * body["DENS"] for body in both],
        }

    # --- contacts given directly

    def _basic(self) -> dict[str, Any]:
        d = self.digits
        if d["F"] > 0 and d["N"] != 1:
            raise self.refuse("F > 0 with the penetration given (N = 0)")
        if d["C3"] in (3, 4, 9) or "influence" in self.blocks:
            raise self.refuse(f"C3 = {d['C3']} (other influence coefficients)")
        motion = self.blocks["motion"]
        load = {"normal_force": motion["FN"]} if d["N"] == 1 else {"approach": MM * motion["PEN"]}
        tables: dict[str, Any] = {"kind": "patch", "load": load, "method": self._method()}
        tables |= self._grid()
        if self.tangential:
            tables["motion"] = self._motion()
        return tables

    def _grid(self) -> dict[str, Any]:
        g = self.blocks["grid"]
        kind = g["IPOTCN"]
        counts = [g["MX"], g["MY"]]
        if kind < 0:
            return self._ellipse(g, kind, counts)
        if self.digits["B"] in (2, 3):
            raise self.refuse(f"B = {self.digits['B']} without an ellipse (IPOTCN < 0)")
        low, last = list(g.values())[3:5], list(g.values())[5:7]
        if kind in (1, 3):
            size = last
        elif kind == 2:
            size = [(b - a) / n for a, b, n in zip(low, last, counts, strict=True)]
        else:
            size = [(b - a) / max(n - 1, 1) for a, b, n in zip(low, last, counts, strict=True)]
        first = [a + 0.5 * s if kind <= 2 else a for a, s in zip(low, size, strict=True)]
        if max(counts) > 1000:
            raise self.refuse(f"a grid of {counts[0]} x {counts[1]} elements (1000 either way)")
        if kind == 4 and min(counts) < 2:
            raise self.refuse("IPOTCN = 4 with one row or column (nothing says its size)")
        middle = [f + 0.5 * (n - 1) * s for f, n, s in zip(first, counts, size, strict=True)]
        self.offset = MM * middle[0], MM * middle[1]
        rows = [
            [MM * self._distance(i, j, first, size) for i in range(counts[0])]
            for j in range(counts[1])
        ]
        return {
            "geometry": {"undeformed_distance": rows},
            "grid": {"element_size": [MM * size[0], MM * size[1]]},
        }

    def _distance(self, i: int, j: int, first: list[float], size: list[float]) -> float:
        """mm, of an element."""
        given = self.blocks.get("distance")
        if given is None:
            raise self.refuse("a grid without undeformed distance (Z = 2)")
        if given["IPLAN"] != 1:
            raise self.refuse(f"IPLAN = {given['IPLAN']} (a part of the grid)")
        b, base = given["values"], given["IBASE"]
        x, y = first[0] + i * size[0], first[1] + j * size[1]
        if base == 1:
            return b[0] * x * x + b[1] * x * y + b[2] * y * y + b[3] * x + b[4] * y + b[5]
        if base == 9:
            return b[j * self.blocks["grid"]["MX"] + i]
        try:
            if base == 3:
                wave = b[0] * math.sin(b[1] * (x - b[2])) - b[3] * math.sin(b[4] * (x - b[5]))
                return wave + x * x / b[6] + y * y / b[7]
            at = (y - b[3]) / b[4]
            k = min(max(math.floor(at), 0), int(b[0]) - 2)
            if not -1e-9 <= at <= b[0] - 1 + 1e-9:
                raise self.refuse("a row outside the given heights (IBASE = 2)")
            height = b[5 + k] + (at - k) * (b[6 + k] - b[5 + k])
            return height + (x - b[1]) ** 2 / (2 * b[2])
        except ZeroDivisionError:
            raise self.refuse(f"IBASE = {base} with a radius or distance of 0") from None

    def _ellipse(self, g: dict[str, Any], kind: int, counts: list[int]) -> dict[str, Any]:
        one, other, scale = list(g.values())[3:6]
        if kind == -6:
            raise self.refuse("IPOTCN = -6 (SDEC)")
        if kind in (-2, -5):
            raise self.refuse(f"IPOTCN = {kind} (give the curvatures, -1 or -4, or the axes, -3)")
        if not min(one, other) > 0 or not scale >= 1:
            raise self.refuse("an ellipse with values of 0 or less, or SCALE below 1")
        elements = [max(round(n / scale), 2) for n in counts]
        if kind == -3:
            axes = [MM * one, MM * other]
            size = [2 * scale * a / n for a, n in zip(axes, counts, strict=True)]
            return {"geometry": {"semi_axes": axes}, "grid": {"element_size": size}}
        if kind == -1:
            curvatures = {"curvatures": [1e3 * one, 1e3 * other]}
            return {"geometry": curvatures, "grid": {"elements": elements}}
        if self.digits["N"] != 1:
            raise self.refuse("a line contact with the penetration given")
        line = {"line_contact_radius": MM / (2 * one), "width": 2 * MM * other}
        return {"geometry": line, "grid": {"elements": [elements[0], 1]}}

    def _motion(self) -> dict[str, Any]:
        d, m = self.digits, self.blocks["motion"]
        rolling = self.blocks.get("rolling", {"CHI": 0.0, "DQ": 1.0, "VELOC": 1e3})
        turned = math.remainder(rolling["CHI"], 2 * math.pi)
        if abs(turned) > 1e-9 and abs(abs(turned) - math.pi) > 1e-9:
            raise self.refuse(f"CHI = {rolling['CHI']:g} rad (rolling along +x or -x only)")
        shift = d["T"] == 1
        unit = MM if shift else 1.0
        phi = -m["CPHI"] * (1.0 if shift else 1e3)
        # slip about the middle of the grid
        about = [
            self.offset[0] - MM * m.get("SPINXO", 0.0),
            self.offset[1] - MM * m.get("SPINYO", 0.0),
        ]
        creepage = [
            -unit * m.get("CKSI", 0.0) - phi * about[1],
            -unit * m.get("CETA", 0.0) + phi * about[0],
        ]
        motion: dict[str, Any] = {"regime": REGIME[d["T"]], "spin_creepage": phi + 0.0}
        motion["rolling_speed"] = MM * max(abs(rolling["VELOC"]), 1e-9)
        if not shift and abs(turned) > 1:
            motion["direction"] = -1
        if d["F"] > 0:
            if self.blocks["material"]["M"] not in (0, 4):
                raise self.refuse("F > 0 without the full theory (M = 0, 4)")
            bound = self._at_rest() * m["FN"]
            size = math.hypot(m["FX"], m.get("FY", 0.0)) if d["F"] == 2 else abs(m["FX"])
            cut = bound / max(size, 1.0)
            force: list[Any] = [-cut * m["FX"], -cut * m["FY"] if d["F"] == 2 else "creepage"]
            motion["tangential_force"] = force
            creepage = [0.0, creepage[1] if d["F"] == 1 else 0.0]
        motion["creepage"] = [value + 0.0 for value in creepage]
        if "extra" in self.blocks:
            motion["slip_field"] = self._extra_slip(unit)
        if d["T"] == 2:
            motion |= {"distance": MM * rolling["DQ"], "steps": 1}
        return motion

    def _extra_slip(self, unit: float) -> list[list[list[float]]]:
        """Rigid slip of each element, given as pairs of body 1 minus body 2 (assumed)."""
        grid, values = self.blocks["grid"], self.blocks["extra"]["values"]
        if grid["IPOTCN"] < 0:
            raise self.refuse("extra rigid slip with an ellipse (IPOTCN < 0)")
        if self.blocks["material"]["M"] not in (0, 4):
            raise self.refuse("extra rigid slip without the full theory (M = 0, 4)")
        mx, my = grid["MX"], grid["MY"]
        if len(values) != 2 * mx * my:
            raise self.refuse("extra rigid slip of another grid")
        return [
            [[-unit * values[2 * (j * mx + i) + c] + 0.0 for i in range(mx)] for j in range(my)]
            for c in range(2)
        ]

    def _at_rest(self) -> float:
        one = self.blocks["friction"]["sets"][0]
        law = self.blocks["friction"]["L"]
        values = [value for name, value in one.items() if name != "PLACE"]
        return values[0] + values[1] + values[3] if 2 <= law <= 4 else values[0]

    # --- wheels

    def _wheel(self) -> dict[str, Any]:
        self.check(REFUSED_ON_WHEELS)
        d, b = self.digits, self.blocks
        if d["B"] in (2, 3):
            raise self.refuse(f"B = {d['B']} on wheels")
        for name in ("patches", "track", "rail", "wheelset", "wheel", "position"):
            if name not in b:
                raise self.refuse(f"a case without its block of {name}")
        side = "left" if d["C1"] in (0, 4) else "right"
        patches = b["patches"]
        turn = patches.get("D_TURN", 2 * patches["D_SEP"] - patches["D_COMB"])
        found = patches["D_SEP"], patches["D_COMB"], turn
        if any(abs(a - c) > 1e-9 for a, c in zip(found, USUAL, strict=True)):
            raise self.refuse("D_SEP, D_COMB, D_TURN other than 8, 4, 12 mm")
        if patches["A_SEP"] < 1.57 or patches.get("G_MISS", -1.0) >= 0:
            raise self.refuse("A_SEP below 90 degrees, or G_MISS")
        method = self._method() | {"patch_rule": "contact", "standstill_speed": 0.0}
        if d["D"] == 4:
            method["reference_surface"] = "curved"
        elif d["C3"] == 4:
            raise self.refuse("C3 = 4 (influence of angles) without D = 4")
        if not self.tangential:
            method["tangential"] = "none"
        profiles, sections = profiles_of(self.blocks, self.folder, self.refuse)
        tables = {
            "kind": "wheel_rail",
            "wheel": {"side": side},
            "method": method,
            "grid": {"element_size": [MM * patches["DX"], MM * patches["DS"]]},
            "wheelset": self._wheelset(side),
            "track": self._track(side),
            "profiles": profiles,
        }
        put_sections(tables, sections, side)
        if d["T"] == 2:
            tables["motion"] = {"regime": "transient_rolling"}
            speed = abs(self._first_velocity()) * (self._roller_radius() if d["C1"] >= 4 else 1.0)
            if not speed > 0:
                raise self.refuse("T = 2 at standstill")
            tables["wheelset"]["time_step"] = MM * patches["DQREL"] * patches["DX"] / speed
        return tables

    def _first_velocity(self) -> float:
        """m/s, or rad/s of a roller."""
        v = self.blocks["velocity"]
        return v["RPITCH"] if "RPITCH" in v else MM * v["VS"]

    def _roller_radius(self) -> float:
        return MM * self.blocks["track"]["NOMRAD"]

    def _wheelset(self, side: str) -> dict[str, Any]:
        d, b = self.digits, self.blocks
        at, sizes = b["position"], b["wheelset"]
        if sizes.get("YTAPE", 1000.0) < 1000.0:
            raise self.refuse("YTAPE")
        found: dict[str, Any] = {
            "y": MM * at["Y"],
            "roll": at["ROLL"],
            "yaw": at["YAW"],
            "x": MM * at["S"],
            "pitch": at["PITCH"],
            "nominal_radius": MM * sizes["NOMRAD"],
            "flange_back_distance": MM * sizes["FBDIST"],
            "flange_back_position": MM * sizes["FBPOS"],
        }
        if d["N"] == 1:
            found["vertical_force"] = at["FZ"]
        else:
            found["z"] = MM * at["Z"]
        if "velocity" in b:
            v = b["velocity"]
            if "RPITCH" not in v:
                found["speed"] = MM * v["VS"]
            found |= {"vy": MM * v["VY"], "vz": MM * v["VZ"], "roll_rate": v["VROLL"]}
            found["yaw_rate"] = v["VYAW"]
            found |= self._turning(v)
        elif self.tangential:
            raise self.refuse("rolling without velocities (E >= 2)")
        if "flexibility" in b:
            found[side] = self._deviation(b["flexibility"])
        return found

    def _turning(self, v: dict[str, float]) -> dict[str, Any]:
        """The pitch rate, or what it is found by: force or torque on body 1, here on the wheel."""
        if "VPITCH" in v:
            return {"pitch_rate": v["VPITCH"]}
        if not self.tangential:
            raise self.refuse("F = 1, 2 without a tangential problem (T = 0)")
        if "FX" in v:
            return {"pitch_rate": "free", "longitudinal_force": 0.0 - v["FX"]}
        return {"pitch_rate": "free", "axle_torque": 0.0 - MM * v["MY"]}

    def _deviation(self, f: dict[str, float]) -> dict[str, Any]:
        return {
            "offset": [MM * f["DX"], MM * f["DY"], MM * f["DZ"]],
            "rotation": [f["DROLL"], f["DPITCH"], f["DYAW"]],
            "velocity": [MM * f["VX"], MM * f["VY"], MM * f["VZ"]],
            "angular_velocity": [f["VROLL"], f["VPITCH"], f["VYAW"]],
        }

    def _track(self, side: str) -> dict[str, Any]:
        d, b = self.digits, self.blocks
        t, roller = b["track"], d["C1"] >= 4
        found: dict[str, Any] = {}
        if t["GAUGHT"] > 0:
            found = {"gauge": MM * t["GAUGWD"], "gauge_height": MM * t["GAUGHT"]}
        elif roller:
            raise self.refuse("GAUGHT <= 0 (a rail placed by RAILY0, RAILZ0) of rollers")
        if roller:
            if t.get("CURV", 0.0) != 0:
                raise self.refuse("CURV of rollers")
            found |= {"kind": "roller", "roller_radius": self._roller_radius()}
            found["roller_pitch_rate"] = self._first_velocity() if "velocity" in b else 0.0
        else:
            found |= {"cant": t["CANT"], "curvature": 1e3 * t.get("CURV", 0.0)}
        offset = [0.0, 0.0, 0.0]
        if "deviation" in b:
            v = b["deviation"]
            offset = [0.0, MM * v["DY"], MM * v["DZ"]]
            found[side] = {
                "offset": offset,
                "rotation": [v["DROLL"], 0.0, 0.0],
                "velocity": [0.0, MM * v["VY"], MM * v["VZ"]],
                "angular_velocity": [v["VROLL"], 0.0, 0.0],
            }
        if d["F"] == 3:
            if "support" not in b:
                raise self.refuse("F = 3 without its stiffnesses (Z = 2, 3)")
            s = b["support"]
            if s.get("DYSTEP0", 0.0) != 0:
                raise self.refuse("DYSTEP0")
            found["rail_support"] = {"stiffness": [1e3 * s["KY"], 1e3 * s["KZ"]]}
            moved = [
                force / (1e3 * k) if k > 0 else 0.0
                for force, k in ((s["FY"], s["KY"]), (s["FZ"], s["KZ"]))
            ]
            found.setdefault(side, {})["offset"] = [0.0, offset[1] + moved[0], offset[2] + moved[1]]
        if not t["GAUGHT"] > 0:
            found.setdefault(side, {})["origin"] = [MM * t["RAILY0"], MM * t["RAILZ0"]]
        return found
