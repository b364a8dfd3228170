"""kind = "wheel_rail" and "wheelset": wheels on rails or rollers."""

from __future__ import annotations

import itertools
from typing import Annotated, Literal

from pydantic import Field, model_validator

from railpatch.case.asked import Damage, Subsurface, check_asked
from railpatch.case.common import (
    Friction,
    Grid,
    Layer,
    Material,
    Method,
    Temperature,
    check_accuracy,
    check_fitted,
    check_left_out,
    check_max_work,
    check_physics,
    check_reference,
    check_tangential,
)
from railpatch.case.fluid import Fluid, check_fluid
from railpatch.case.own_influence import check_own_influence
from railpatch.case.rails import (
    RailSupport,
    Section,
    Sections,
    WheelSection,
    WheelSections,
    check_blend,
    check_sections,
)
from railpatch.case.rolling import RailShape, WheelMotion, WheelShape, check_rolling
from railpatch.case.types import (
    LEFT_OUT,
    SIDES,
    AngleVector,
    Number,
    Pair,
    Problems,
    ShiftVector,
    Table,
    Vector,
    exactly_one,
    key,
    listed,
    number_or,
    one_of,
    refuse,
    relation,
)
from railpatch.case.viscous import check_viscous
from railpatch.profiles import Reading
from railpatch.profiles.builtin import builtin_profile
from railpatch.profiles.smooth import MEASURED_WAVELENGTH

Text = Annotated[str, Field(min_length=1)]


# of [wheelset], what moves beside its height
WHEELSET_STATE = (
    *("x", "y", "roll", "pitch", "yaw"),
    *("speed", "vy", "vz", "roll_rate", "pitch_rate", "yaw_rate"),
    "time_step",
)
# of these, what a step finds where the word stands in place of a number
FOUND = {"roll": "balanced", "pitch_rate": "free"}
# what says the pitch rate that is found
OF_FREE = ("axle_torque", "longitudinal_force")


class Deviation(Table):
    """Deviation of a wheel from the rigid wheelset, or of a rail from its design position."""

    offset: ShiftVector = Field(default=[0.0, 0.0, 0.0], description="m, offset along x, y, z")
    rotation: AngleVector = Field(
        default=[0.0, 0.0, 0.0], description="rad, rotation about x, y, z"
    )
    velocity: Vector = Field(
        default=[0.0, 0.0, 0.0], description="m/s, rate of offset, into the creepages"
    )
    angular_velocity: Vector = Field(
        default=[0.0, 0.0, 0.0], description="rad/s, rate of rotation, into the creepages"
    )

    @property
    def moving(self) -> tuple[str, ...]:
        """The deviation, not the shape."""
        return tuple(Deviation.model_fields)


class WheelDeviation(Deviation, WheelShape):
    """Deviation of a wheel, and its shape around the circumference."""

    sections: WheelSections | None = Field(
        default=None,
        description="profiles round the wheel (rad, file), interpolated in between; the one in "
        "[profiles] is then the wheel that pages draw and that is checked in its place",
    )

    @model_validator(mode="after")
    def _increasing(self) -> WheelDeviation:
        check_sections(self.sections)
        return self


class Wheelset(Table):
    """Position, attitude and velocity of the wheelset in track axes, and its dimensions."""

    x: Number = Field(
        default=0.0, description="m, position along the track, for what varies along it"
    )
    y: float = key()
    z: float | None = key("; or vertical_force", default=None)
    vertical_force: float | None = key(default=None)
    roll: number_or("roll", FOUND["roll"]) = key(
        "; 'balanced': that at which the contact forces have no roll moment about the wheelset's "
        "centre (wheelset)",
        bounded=False,
    )
    pitch: Number = Field(
        default=0.0, description="rad, about the axle, for what varies around the wheels"
    )
    yaw: float = key()
    speed: float = key()
    vy: float = key()
    vz: float = key()
    roll_rate: float = key()
    yaw_rate: float = key()
    pitch_rate: number_or("pitch_rate", FOUND["pitch_rate"]) = key(
        "; 'free': that at which the contact forces have the torque axle_torque about the axle, or "
        "along the track the sum longitudinal_force",
        bounded=False,
    )
    axle_torque: float | None = key(
        "; only with pitch_rate = 'free', left out: 0, no drive and no brake", default=None
    )
    longitudinal_force: float | None = key(
        "; only with pitch_rate = 'free', in place of axle_torque", default=None
    )
    time_step: float = key()
    nominal_radius: float = key(default=...)
    flange_back_distance: float = key(default=...)
    flange_back_position: float = key(default=0.0)
    max_patches: int | None = key(default=None)
    left: WheelDeviation = Field(
        default=WheelDeviation(), description="left wheel's deviation (m, rad), wheelset axes"
    )
    right: WheelDeviation = Field(
        default=WheelDeviation(), description="right wheel's deviation (m, rad), wheelset axes"
    )

    @model_validator(mode="after")
    def _one_height(self) -> Wheelset:
        exactly_one(self, ("z", "vertical_force"))
        refuse(self._by_pitch_rate())
        return self

    def _by_pitch_rate(self) -> Problems:
        for name in OF_FREE:
            if (value := getattr(self, name)) is None:
                continue
            if self.pitch_rate != FOUND["pitch_rate"]:
                yield relation(name, value, "only with pitch_rate = 'free'")
        if self.axle_torque is not None and self.longitudinal_force is not None:
            allowed = f"{LEFT_OUT} with longitudinal_force: one of them says the pitch rate"
            yield relation("axle_torque", self.axle_torque, allowed)

    @property
    def moving(self) -> tuple[str, ...]:
        """Position and velocity, not the dimensions."""
        height = "z" if self.z is not None else "vertical_force"
        given = [name for name in WHEELSET_STATE if name not in self.found]
        if "pitch_rate" in self.found:
            given.append("axle_torque" if self.longitudinal_force is None else OF_FREE[1])
        return (*given, height, *SIDES)

    @property
    def found(self) -> tuple[str, ...]:
        """The keys that a step finds, of a wheelset in balance."""
        return tuple(name for name, word in FOUND.items() if getattr(self, name) == word)


class Rail(Deviation, RailShape):
    """A rail's deviation, running surface, and its profiles where they vary along the track."""

    sections: Sections | None = Field(
        default=None,
        description="profiles along the track (m, file), interpolated linearly in between and "
        "constant beyond, instead of one in [profiles]",
    )
    origin: Pair | None = Field(
        default=None,
        description="m, [y, z] of the profile's origin in track axes (left y < 0), of profiles "
        "whose heights and places are to be taken as they are; left out: gauge and the rail's top "
        "at z = 0 say where it lies",
    )

    @model_validator(mode="after")
    def _increasing(self) -> Rail:
        check_sections(self.sections)
        for k, value in enumerate(self.origin or ()):
            low, high = (listed(f"rail_origin_{'yz'[k]}")[end] for end in ("low", "high"))
            if not low <= value <= high:
                raise relation(f"origin[{k}]", value, f"{low:g} to {high:g} m")
        return self


class Track(Table):
    """Rails or rollers."""

    kind: one_of("track") = Field(
        default="rail", description="what the wheels run on, rails or rollers of a rig (no unit)"
    )
    gauge: float = key()
    gauge_height: float = key()
    gauge_widening: float = key()
    cant: float = key()
    curvature: float = key()
    roller_radius: float | None = key(default=None)
    roller_pitch_rate: float | None = key(default=None)
    section_blend: one_of("section_blend") | None = Field(
        default=None,
        description="what knots of 'sections' of rails and wheels do between two: 'cubic' has a "
        "continuous slope; only with two or more sections; left out: 'linear' (no unit)",
    )
    irregularity: Text | None = Field(
        default=None,
        description="record of the rails' deviations (file, no unit), m: x, left lateral, left "
        "vertical, right lateral, right vertical; added to their offsets at wheelset.x",
    )
    rail_support: RailSupport | None = Field(
        default=None, description="springs and dampers under the rails (N/m, N s/m)"
    )
    left: Rail = Field(default=Rail(), description="left rail's deviation (m, rad), track axes")
    right: Rail = Field(default=Rail(), description="right rail's deviation (m, rad), track axes")

    @model_validator(mode="after")
    def _keys_of_kind(self) -> Track:
        if self.kind == "roller":
            if self.roller_radius is None:
                raise relation("roller_radius", "missing", "a radius > 0 m with kind = 'roller'")
            for key in ("cant", "curvature"):
                if getattr(self, key) != 0.0:
                    raise relation(key, getattr(self, key), "0 with kind = 'roller'")
            for side in SIDES:
                if (origin := getattr(self, side).origin) is not None:
                    raise relation(f"{side}.origin", origin, "none with kind = 'roller'")
            return self
        for key in ("roller_radius", "roller_pitch_rate"):
            if getattr(self, key) is not None:
                raise relation(key, getattr(self, key), "only with kind = 'roller'")
        return self

    @property
    def moving(self) -> tuple[str, ...]:
        """The rails' or rollers' deviations, and the rollers' speed."""
        return (*SIDES, "roller_pitch_rate") if self.kind == "roller" else SIDES


class ProfileFile(Table):
    """What profile files do not say of themselves; left out: found by rules, or asked for."""

    unit: Literal["m", "mm", "in"] | None = Field(
        default=None, description="of length in the files (no unit)"
    )
    swap: bool | None = Field(
        default=None, description="whether the columns are z, y in place of y, z (no unit)"
    )
    mirror: Literal["none", "y", "z", "yz"] | None = Field(
        default=None,
        description="axes that point the other way than from the flange or gauge side to the field "
        "side, and down (no unit)",
    )
    origin: Pair | None = Field(
        default=None,
        description="m, [y, z] of the profile's origin in the files' axes, after swap and mirror: "
        "of a wheel where the nominal radius is measured",
    )

    @property
    def reading(self) -> Reading:
        """For the readers of files."""
        origin = None if self.origin is None else (self.origin[0], self.origin[1])
        return Reading(self.unit, self.swap, self.mirror, origin)


class Profiles(Table):
    """Profiles by path (relative to the case file) or built-in name; by side or for both."""

    wheel: Text | None = Field(default=None, description="both wheels' profile (file, no unit)")
    rail: Text | None = Field(
        default=None, description="both rails' or rollers' profile (file, no unit)"
    )
    wheel_left: Text | None = Field(default=None, description="left wheel (file, no unit)")
    wheel_right: Text | None = Field(default=None, description="right wheel (file, no unit)")
    rail_left: Text | None = Field(default=None, description="left rail or roller (file, no unit)")
    rail_right: Text | None = Field(
        default=None, description="right rail or roller (file, no unit)"
    )
    smoothing: Annotated[float, Field(ge=0, le=0.1)] | None = Field(
        default=None,
        description="m, wave length of which half the amplitude is kept in profile files; 0: "
        f"interpolation; left out: what the noise of the points asks for, at least "
        f"{MEASURED_WAVELENGTH} for MiniProf measurements",
    )
    wheel_file: ProfileFile | None = Field(
        default=None, description="how the wheels' files are read (m, no unit)"
    )
    rail_file: ProfileFile | None = Field(
        default=None, description="how the rails' or rollers' files are read (m, no unit)"
    )

    @model_validator(mode="after")
    def _no_doubles(self) -> Profiles:
        for body in ("wheel", "rail"):
            sided = [f"{body}_{side}" for side in SIDES if getattr(self, f"{body}_{side}")]
            if getattr(self, body) is not None and sided:
                raise relation(body, f"{getattr(self, body)!r}", f"only without '{sided[0]}'")
        return self

    def of(self, body: Literal["wheel", "rail"], side: str) -> tuple[str, str | None]:
        """Key and value of the profile of one body on one side."""
        if getattr(self, body) is not None:
            return body, getattr(self, body)
        return f"{body}_{side}", getattr(self, f"{body}_{side}")

    def reading(self, body: Literal["wheel", "rail"]) -> Reading:
        """How files of one body are read."""
        table = getattr(self, f"{body}_file")
        return Reading() if table is None else table.reading


# of [profiles], those that name one
PROFILE_KEYS = tuple(
    name for name in Profiles.model_fields if not name.endswith("_file") and name != "smoothing"
)


class Wheel(Table):
    """Which wheel a wheel_rail case is."""

    side: one_of("side") = Field(default="right", description="side (no unit)")


class _WheelCase(Table):
    """What both kinds with wheels have."""

    material: Material = Field(default=Material(), description="elastic constants (Pa, -)")
    grid: Grid | None = Field(
        default=None, description="elements (-, m); left out: 24 across the contact"
    )
    friction: Friction | None = Field(
        default=None, description="friction law (-); needed where there is a tangential problem"
    )
    layer: Layer | None = Field(default=None, description="third-body layer (Pa, m)")
    temperature: Temperature | None = Field(
        default=None, description="surface temperature (degrees C, W/(m K), J/(kg K), kg/m^3)"
    )
    fluid: Fluid | None = Field(
        default=None, description="liquid between wheel and rail (m, Pa s, degrees C, m^3/s)"
    )
    method: Method = Field(default=Method(), description="theories and tolerances (-)")
    subsurface: Subsurface | None = Field(
        default=None, description="stresses below the surface at these depths (m)"
    )
    damage: Damage | None = Field(
        default=None, description="wear and rolling contact fatigue by these laws (-)"
    )
    motion: WheelMotion = Field(default=WheelMotion(), description="how wheels roll (no unit)")
    wheelset: Wheelset = Field(description="position, velocity, dimensions (m, rad, m/s, rad/s)")
    track: Track = Field(
        description="rails or rollers (m, rad, rad/s); [track] with kind = 'rail' is enough"
    )
    profiles: Profiles = Field(description="profiles by file or name (no unit)")

    @property
    def moving(self) -> tuple[str, ...]:
        """The tables that hold keys which move."""
        fluid = ("fluid",) if self.fluid is not None else ()
        friction = ("friction",) if self.friction is not None and self.has_tangential else ()
        motion = ("motion",) if self.motion.regime_changes and self.has_tangential else ()
        return ("wheelset", "track", *fluid, *friction, *motion)

    @property
    def sides(self) -> tuple[str, ...]:
        """The sides that have a wheel."""
        return SIDES

    @property
    def has_tangential(self) -> bool:
        """Whether the scene has a tangential problem."""
        return self.method.tangential != "none"

    def _check_frame(self) -> Problems:
        if self.method.contact_frame != "inclined":
            return
        if self.track.kind != "roller":
            yield relation("method.contact_frame", "'inclined'", "'track' with kind = 'rail'")
        if self.method.reference_surface != "plane":
            shown = repr(self.method.reference_surface)
            where = "with contact_frame = 'inclined'"
            yield relation("method.reference_surface", shown, f"'plane' {where}")

    @model_validator(mode="after")
    def _relations(self) -> _WheelCase:
        refuse(
            itertools.chain(
                self._check_physics(),
                self._check_profiles(),
                check_viscous(self),
                check_own_influence(self),
                check_asked(self, False),
            )
        )
        return self

    def _check_physics(self) -> Problems:
        if self.has_tangential:
            yield from check_tangential(
                self.material,
                self.friction,
                self.layer,
                self.grid,
                self.method,
                self.motion.regime,
                self.fluid,
            )
            stores = self.temperature is not None and self.temperature.bulk is not None
            yield from check_fluid(
                self.fluid,
                self.friction,
                self.method.accuracy,
                self.method.tangential,
                without_time="temperature.bulk" if stores else None,
            )
            if self.fluid is not None and self.fluid.model == "ehl":
                others = "'film', 'strip' or 'regimes'"
                allowed = f"{others} with kind = {self.kind!r}: 'ehl' is of kind = 'patch'"
                yield relation("fluid.model", "'ehl'", allowed)
            yield from check_physics(
                self.friction, self.layer, self.temperature, self.grid, self.method
            )
        else:
            yield from check_left_out(self, "with method.tangential = 'none'")
        yield from check_fitted(self.grid, self.method)
        yield from check_accuracy(self.grid, self.method)
        yield from check_reference(self.material, self.grid, self.method)
        yield from check_rolling(self)
        yield from self._check_frame()
        yield from self._check_balance()
        yield from check_max_work(self.method, self._unlimited())

    def _unlimited(self) -> str | None:
        """Why no work of a search for the height can be limited; None: it can."""
        if self.wheelset.vertical_force is None:
            return "without wheelset.vertical_force: no height is searched"
        if self.track.rail_support is not None:
            return "with track.rail_support: the rails' place is part of the search"
        if self.wheelset.found:
            return f"with a balance: wheelset.{next(iter(self.wheelset.found))} is found too"
        if self.method.accuracy is not None:
            return "with method.accuracy: give 'grid'"
        return None

    def _check_balance(self) -> Problems:
        for name in self.wheelset.found:
            shown = repr(FOUND[name])
            if len(self.sides) == 1 and name == "roll":
                yield relation(f"wheelset.{name}", shown, "a number with kind = 'wheel_rail'")
            elif name == "pitch_rate" and not self.has_tangential:
                allowed = "a number with method.tangential = 'none': nothing turns the axle"
                yield relation(f"wheelset.{name}", shown, allowed)

    def section_lists(
        self, *tables: str, every: bool = False
    ) -> dict[str, list[Section] | list[WheelSection]]:
        """Profiles along the track and round the wheels, by key; every: of a side without a wheel
        too, which a case of both leaves in one of its wheels."""
        return {
            f"{table}.{side}.sections": getattr(getattr(self, table), side).sections or []
            for table in tables
            for side in (SIDES if every else self.sides)
        }

    def _check_profiles(self) -> Problems:
        lists = self.section_lists("track", "wheelset", every=True)
        yield from check_blend(self.track.section_blend, lists)
        for body in ("wheel", "rail"):
            yield from self._check_read(body)
        for side in self.sides:
            for body in ("wheel", "rail"):
                key, value = self.profiles.of(body, side)
                if body == "rail" and getattr(self.track, side).sections is not None:
                    yield from self._check_sections(key, value)
                elif value is None:
                    yield relation(
                        f"profiles.{key}", "missing", f"'{key}', or '{body}' for both sides"
                    )

    def _check_read(self, body: Literal["wheel", "rail"]) -> Problems:
        """What is said of files is said of some."""
        names = [self.profiles.of(body, side)[1] for side in self.sides]
        lists = self.section_lists("track" if body == "rail" else "wheelset", every=True)
        names += [part.profile for own in lists.values() for part in own]
        files = [name for name in names if name and builtin_profile(name, body) is None]
        table = getattr(self.profiles, f"{body}_file")
        if table is not None and not files:
            shown = table.model_dump(exclude_none=True)
            yield relation(f"profiles.{body}_file", shown, f"with a file as {body} profile")

    def _check_sections(self, key: str, value: str | None) -> Problems:
        """A rail has one profile or sections."""
        every = all(getattr(self.track, side).sections is not None for side in self.sides)
        if value is not None and (every or key != "rail"):
            allowed = f"{LEFT_OUT} where the track's rail has 'sections'"
            yield relation(f"profiles.{key}", repr(value), allowed)


class WheelRailCase(_WheelCase):
    """One wheel on its rail or roller."""

    kind: Literal["wheel_rail"] = Field(description="kind of case (no unit)")
    wheel: Wheel = Field(default=Wheel(), description="which wheel (no unit)")

    @property
    def sides(self) -> tuple[str, ...]:
        """The side that has a wheel."""
        return (self.wheel.side,)


class WheelsetCase(_WheelCase):
    """Both wheels on their rails or rollers."""

    kind: Literal["wheelset"] = Field(description="kind of case (no unit)")
