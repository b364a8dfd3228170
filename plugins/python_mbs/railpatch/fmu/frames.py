"""Pictures of the frames and reference points on an FMU's page, as SVG in the page itself."""

from __future__ import annotations

import math
from html import escape
from typing import Any

from railpatch.fmu.table import SIDES, Kind

INK, SOFT, AXIS, POINT, FORCE = "#333", "#96a2b0", "#1565c0", "#d6452e", "#2e7d32"
STYLE = (
    "text{font:12px sans-serif;fill:#333}.a{fill:#1565c0}.p{fill:#d6452e}.f{fill:#2e7d32}"
    "svg{max-width:100%;height:auto;background:#fff}figure{margin:1em 0}"
    "figcaption{font-size:13px;max-width:60em}"
)
MARKERS = "".join(
    f'<marker id="m{key}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
    f'orient="auto-start-reverse"><path d="M0 0 8 4 0 8z" fill="{colour}"/></marker>'
    for key, colour in (("a", AXIS), ("p", POINT), ("f", FORCE), ("k", INK))
)
COLOURS = {"a": AXIS, "p": POINT, "f": FORCE, "k": INK}


class Picture:
    """Shapes in pixels, x to the right and y down."""

    def __init__(self, width: int, height: int, title: str) -> None:
        self.head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'width="{width}" role="img"><title>{escape(title)}</title><defs>{MARKERS}</defs>'
        )
        self.parts: list[str] = []

    def line(self, *points: float, colour: str = INK, width: float = 1.5, dash: str = "") -> None:
        """Through points x, y, x, y, ..."""
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(
            f'<polyline points="{numbers(points)}" fill="none" stroke="{colour}" '
            f'stroke-width="{width}"{dashed}/>'
        )

    def area(self, *points: float, colour: str = SOFT) -> None:
        """A filled polygon."""
        self.parts.append(
            f'<polygon points="{numbers(points)}" fill="{colour}" fill-opacity="0.35" '
            f'stroke="{INK}"/>'
        )

    def arrow(self, x: float, y: float, dx: float, dy: float, key: str, label: str = "") -> None:
        """From a point by dx, dy, with a label at its tip."""
        self.parts.append(
            f'<line x1="{x:g}" y1="{y:g}" x2="{x + dx:g}" y2="{y + dy:g}" '
            f'stroke="{COLOURS[key]}" stroke-width="2" marker-end="url(#m{key})"/>'
        )
        length = math.hypot(dx, dy)
        if label:
            right = 8 if dx > -1e-9 else -8 - 6.3 * len(label)
            self.text(x + dx + (right if abs(dx) > 0.3 * length else 7), y + dy + 4, label, key)

    def turn(self, x: float, y: float, radius: float, key: str, label: str, begin: float) -> None:
        """A clockwise arrow of 100 degrees about a point, from an angle in degrees."""
        a, b = math.radians(begin), math.radians(begin + 100)
        xa, ya = x + radius * math.cos(a), y + radius * math.sin(a)
        xb, yb = x + radius * math.cos(b), y + radius * math.sin(b)
        self.parts.append(
            f'<path d="M{xa:.1f} {ya:.1f} A{radius} {radius} 0 0 1 {xb:.1f} {yb:.1f}" fill="none" '
            f'stroke="{COLOURS[key]}" stroke-width="2" marker-end="url(#m{key})"/>'
        )
        middle = math.radians(begin + 50)
        side = math.cos(middle)
        xt = x + (radius + 8) * side - (6.3 * len(label) if side < -0.2 else 0)
        self.text(xt, y + (radius + 12) * math.sin(middle) + 4, label, key)

    def into(self, x: float, y: float, label: str, key: str = "a") -> None:
        """An axis into the page."""
        colour = COLOURS[key]
        self.parts.append(
            f'<circle cx="{x:g}" cy="{y:g}" r="6" fill="#fff" stroke="{colour}" stroke-width="2"/>'
            f'<path d="M{x - 4:g} {y - 4:g}l8 8m0-8l-8 8" stroke="{colour}" stroke-width="2"/>'
        )
        if label:
            self.text(x - 8 - 6.5 * len(label), y - 7, label, key)

    def point(self, x: float, y: float, label: str, dx: float = 7, dy: float = -7) -> None:
        """A named point."""
        self.parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="4" fill="{POINT}"/>')
        self.text(x + dx, y + dy, label, "p")

    def text(self, x: float, y: float, text: str, key: str = "k") -> None:
        """A label."""
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" class="{key}">{escape(text)}</text>')

    def figure(self, caption: str) -> str:
        """The whole, with a caption."""
        body = "\n".join(self.parts)
        return f"<figure>{self.head}\n{body}\n</svg><figcaption>{caption}</figcaption></figure>"


def numbers(points: Any) -> str:
    """As SVG has them."""
    return " ".join(f"{v:.1f}" for v in points)


def pictures(kind: Kind, config: dict[str, Any]) -> str:
    """The figures that belong to a scene of this kind. config: of the core, for its profiles."""
    if kind.kind == "patch":
        return patch_picture()
    side = kind.sides[-1]
    roller = "roller" in kind.conditions
    # of a rail that changes along the track the first section
    profiles = [
        found if (found := config[body][side]) is not None else config["rail_sections"][side][0]
        for body in ("wheel", "rail")
    ]
    return along(kind, roller) + above(kind) + profile_picture(profiles, side, roller)


def along(kind: Kind, roller: bool) -> str:
    """The wheelset from behind."""
    p = Picture(700, 330, "Track frame and wheelset, seen forward along the track")
    top, centre = 250.0, 110.0
    rail = "roller" if roller else "rail"
    p.line(60, top, 640, top, colour=SOFT, dash="6 4")
    p.text(255, top + 56, f"plane on the {rail}s' tops")
    p.line(300, top + 44, 280, top + 3, width=1)
    p.line(150, centre, 550, centre, width=8, colour=SOFT)
    for side in kind.sides:
        s = 1 if side else -1
        x = 350 + 160 * s
        p.area(
            x - 30 * s,
            20,
            x + 30 * s,
            24,
            x + 30 * s,
            244,
            x - 30 * s,
            top,
            x - 38 * s,
            top + 16,
            x - 44 * s,
            top + 14,
            x - 44 * s,
            12,
            x - 38 * s,
            10,
        )
        p.area(x - 18, top, x + 18, top, x + 18, top + 34, x - 18, top + 34, colour="#465262")
        p.line(x, centre, x, top - 4, dash="2 3", width=1)
        p.point(x, centre, f"A {SIDES[side]}", 7 if s > 0 else -42, -9)
        p.point(x, top - 4, f"P {SIDES[side]}", 34 if s > 0 else -64, 18)
        p.arrow(x + 84 * s, top + 20, 0, -46, "f", f"{SIDES[side]}.force")
    p.line(350, centre, 350, top, dash="2 3", width=1)
    p.text(356, 190, "nominal radius, where z = 0")
    p.into(350, top, "x")
    p.arrow(350, top, 70, 0, "a", "y")
    p.arrow(350, top, 0, 46, "a", "z")
    p.text(300, top - 10, "O")
    p.point(350, centre, "C: wheelset.y, .z", 10, -12)
    p.turn(350, centre, 34, "p", "wheelset.roll", 200)
    return p.figure(
        "<b>Track frame</b>, seen forward along the track: origin O between the "
        f"{rail}s in the plane on their tops, x forward (into the picture), y to the right, z "
        "down. <b>C</b>, the wheelset's centre: wheelset.y and wheelset.z are its place, "
        "wheelset.roll turns about x through it, all moments are about it. <b>P</b>: origin of a "
        "wheel's profile; <b>A</b>: where the plane of that origin meets the wheelset's axis. "
        "Forces are those on the wheels, in these axes."
    )


def above(kind: Kind) -> str:
    """The wheelset from above."""
    p = Picture(700, 300, "Wheelset from above")
    centre = 160.0
    p.line(150, centre, 550, centre, width=8, colour=SOFT)
    for side in kind.sides:
        s = 1 if side else -1
        x = 350 + 160 * s
        p.area(x - 16, centre - 80, x + 16, centre - 80, x + 16, centre + 80, x - 16, centre + 80)
        p.line(x, 30, x, 280, width=1, dash="10 4", colour="#465262")
        p.point(x, centre, f"A {SIDES[side]}", 22 if s > 0 else -62, -8)
        p.turn(x, centre, 58, "p", f"wheelset.{SIDES[side]}.rotation[3]", 255 if s > 0 else 225)
        p.arrow(x + 24 * s, centre + 76, 0, -40, "p", f"{SIDES[side]}.offset[1]" if s > 0 else "")
    p.into(350, centre, "z")
    p.arrow(350, centre, 0, -90, "a", "x, forward")
    p.arrow(350, centre, 80, 0, "a", "y")
    p.point(350, centre, "C", -18, 20)
    p.turn(350, centre, 44, "p", "wheelset.yaw", 60)
    return p.figure(
        "From above, forward is up. wheelset.yaw turns about z through C. A wheel's offset along "
        "x (component 1) and its rotation about z (component 3) move its axis, about A. The pitch "
        "rate is about the axle, by the right-hand rule about y: forward rolling is below 0."
    )


def profile_picture(profiles: list[dict[str, Any]], side: int, roller: bool) -> str:
    """Profiles of one side as they are in the scene, drawn apart."""
    p = Picture(700, 380, "Wheel and rail of one side, drawn apart")
    sign = 1 if side else -1
    scale, gap, left = 2600.0, 70.0, 300.0
    rail = "roller" if roller else "rail"
    name = SIDES[side]
    own = {"wheel": 150.0, "rail": 150.0 + gap}
    for (body, down), profile in zip(own.items(), profiles, strict=True):
        points = [
            v
            for y, z in zip(profile["y"], profile["z"], strict=True)
            for v in (left + sign * scale * float(y), down + scale * float(z))
        ]
        step = max(1, len(points) // 400)
        kept = [v for i in range(0, len(points) - 1, 2 * step) for v in points[i : i + 2]]
        p.line(*kept, colour=INK, width=2.5)
        label = "P" if body == "wheel" else "R"
        p.point(left, down, label, -20, -6 if body == "wheel" else 20)
    p.turn(left, 150, 60, "p", f"wheelset.{name}.rotation[1]", 235)
    p.arrow(left, 150, 70, 0, "p")
    p.text(left + 60, 168, f"wheelset.{name}.offset[2]", "p")
    p.turn(left, 220, 115, "p", f"track.{name}.rotation[1]", 40)
    p.arrow(left, 220, 0, 60, "p", f"track.{name}.offset[3]")
    at, down = left + 210, 280.0
    tilt = 0.18 * sign
    p.into(at, down, "x")
    p.arrow(at, down, 70 * math.cos(tilt), 70 * math.sin(tilt), "a", "s")
    p.arrow(at, down, -70 * math.sin(tilt), 70 * math.cos(tilt), "a", "n")
    p.line(at, down, at, down + 84, dash="3 3", width=1)
    p.text(at + 24, down + 50, "contact_angle, from z to n")
    p.text(at - 30, down - 22, "contact frame")
    turned = (
        "a roller's offset moves its axle, its rotation about x turns its profile about R"
        if roller
        else "offset and rotation of a rail move it, the rotation about x about R"
    )
    return p.figure(
        f"The {name} wheel and {rail}, seen forward along the track, their profiles as in this "
        "scene and drawn apart. <b>P</b>, <b>R</b>: origins of the profiles. A wheel's offset "
        "along y and z and its rotation about x (component 1) move its profile, about P; it still "
        f"turns about the wheelset's axis; {turned}. <b>Contact frame</b> of a patch: origin at "
        f"its position on the {rail}, x along rolling, s along the surface, n into the {rail}; "
        "normal_force presses the wheel against n; creep_force on the wheel is along x [1] and s "
        "[2], spin_moment on it about n."
    )


def patch_picture() -> str:
    """The contact frame of a patch that is given directly."""
    p = Picture(700, 260, "Contact frame")
    p.parts.append(
        f'<ellipse cx="300" cy="120" rx="120" ry="70" fill="{SOFT}" fill-opacity="0.35" '
        f'stroke="{INK}"/>'
    )
    p.into(300, 120, "n")
    p.arrow(300, 120, 190, 0, "a", "x, along rolling (direction = 1)")
    p.arrow(300, 120, 0, 105, "a", "y")
    p.turn(300, 120, 40, "p", "spin_creepage, spin_moment", 20)
    p.arrow(300, 120, -90, 0, "f", "creep_force where creepage > 0")
    p.point(300, 120, "contact reference", -45, -50)
    return p.figure(
        "<b>Contact frame</b>, seen from the wheel into the rail: origin at the contact reference, "
        "x along rolling, y to the right of it, n into the rail. Forces and the moment act on the "
        "wheel; the moment is about n through the contact reference."
    )
