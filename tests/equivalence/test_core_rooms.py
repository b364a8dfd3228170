"""Rooms of the core: includes point one way, names are unique, plug-ins see the interface."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "core"
PLUGINS = ROOT / "plugins"
INTERFACE = {"railpatch.h", "railpatch_fields.h"}
# what plug-ins see of the core beyond its interface, and why
LOOKS_INSIDE = {
    "timing.cpp": {"numeric/fft.hpp", "numeric/memory.hpp"},  # times the FFT itself
    "module.cpp": {"fast/theories.hpp"},  # hands the table of theories on to Python
    # hands out the profile that the core has between two slices
    "slices.cpp": {"geometry/profile_sections.hpp"},
    # functions that are the same on every computer: for Python, for the angles of bodies
    "elementary.cpp": {"numeric/elementary.hpp"},
    "angles.hpp": {"numeric/elementary.hpp"},
    "frames.cpp": {"numeric/elementary.hpp"},
    "vehicle_bodies.cpp": {"numeric/elementary.hpp"},
    "vehicle_course.cpp": {"numeric/elementary.hpp"},
    "vehicle_drives.cpp": {"numeric/elementary.hpp"},
    "vehicle_equations.cpp": {"numeric/elementary.hpp"},
    "vehicle_suspension.cpp": {"numeric/elementary.hpp"},
}

# what the standard headers give that a build with RAILPATCH_PCH reads before each file
STANDARD = {
    "algorithm": "all_of any_of clamp copy copy_backward copy_if copy_n count count_if equal"
    " fill fill_n find find_if for_each generate iota is_sorted lower_bound max"
    " max_element min min_element minmax none_of nth_element partition remove_if"
    " replace reverse rotate sort stable_sort transform unique upper_bound",
    "array": "array",
    "cmath": "abs acos asin atan atan2 cbrt ceil copysign cos cosh erf exp fabs floor fmax"
    " fmin fmod frexp hypot isfinite isinf isnan ldexp lerp llround log log1p"
    " lround nearbyint pow remainder rint round signbit sin sinh sqrt tan tanh"
    " trunc",
    "complex": "complex conj polar",
    "cstring": "memcmp memcpy memmove memset strchr strcmp strlen strncmp strstr",
    "limits": "numeric_limits",
    "memory": "make_shared make_unique shared_ptr uninitialized_value_construct_n unique_ptr",
    "numbers": "numbers",
    "optional": "make_optional nullopt optional",
    "utility": "as_const declval exchange forward in_range index_sequence integer_sequence"
    " make_index_sequence make_pair move pair swap",
    "vector": "vector",
}
GIVEN_BY = {name: header for header, names in STANDARD.items() for name in names.split()}

Sources = dict[str, str]


def sources(folder: Path) -> Sources:
    """Path in the folder -> text, of everything that is compiled."""
    return {
        path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*"))
        if path.suffix in {".c", ".cpp", ".h", ".hpp", ".inc"}
    }


def documented_rooms() -> list[str]:
    """From the floor up, in the core's own table."""
    text = (CORE / "README.md").read_text(encoding="utf-8")
    return re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)


def built_rooms() -> list[str]:
    """From the floor up, in the build."""
    text = (CORE / "CMakeLists.txt").read_text(encoding="utf-8")
    listed = re.search(r"set\(core_rooms\s+(.*?)\)", text, re.DOTALL)
    assert listed is not None
    return listed[1].split()


def includes(text: str) -> list[str]:
    """What a file includes in quotes."""
    return re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.MULTILINE)


def upward(texts: Sources, rooms: list[str]) -> list[str]:
    """Includes of rooms below in the table, and of files that are nowhere."""
    found = []
    for path, text in texts.items():
        room, _, _ = path.rpartition("/")
        for other in includes(text):
            target, _, name = other.rpartition("/")
            if f"include/{other}" in texts and not target:
                continue
            if other not in texts or target not in rooms:
                found.append(f"{path} includes {other}, which is in no room")
            elif room not in rooms or rooms.index(target) > rooms.index(room):
                found.append(f"{path} includes {name} of {target}, above {room or 'all'}")
    return found


def left_to_others(texts: Sources) -> list[str]:
    """Names for which neither a file nor what it includes has the standard header."""
    given: dict[str, set[str]] = {}

    def standard(path: str) -> set[str]:
        if path not in given:
            text = texts.get(path, texts.get(f"include/{path}", ""))
            own = set(re.findall(r"^\s*#\s*include\s+<(\w+)>", text, re.MULTILINE))
            given[path] = own.union(*map(standard, includes(text)))
        return given[path]

    return [
        f"{path} uses std::{name} without <{GIVEN_BY[name]}>"
        for path, text in texts.items()
        if not path.endswith(".inc")
        for name in sorted(set(re.findall(r"\bstd::(\w+)", re.sub(r"//.*", "", text))))
        if name in GIVEN_BY and GIVEN_BY[name] not in standard(path)
    ]


def shared_names(texts: Sources) -> list[str]:
    """Base names that files of more than one room have."""
    rooms: dict[str, set[str]] = {}
    for path in texts:
        room, _, name = path.rpartition("/")
        rooms.setdefault(name.partition(".")[0], set()).add(room)
    return [f"{name} in {', '.join(sorted(r))}" for name, r in rooms.items() if len(r) > 1]


def beyond_the_interface(plugins: Sources, core: Sources) -> list[str]:
    """Includes of the core's insides by plug-ins."""
    return [
        f"{path} includes {other}"
        for path, text in plugins.items()
        for other in includes(text)
        if (other in core or "core/" in other)
        and other not in LOOKS_INSIDE.get(Path(path).name, set())
    ]


def test_rooms_stand_in_one_order() -> None:
    """The table, the build and the folders hold the same rooms."""
    assert documented_rooms() == built_rooms()
    folders = {path.parent.name for path in CORE.glob("*/*.cpp")}
    assert folders == set(documented_rooms())


def test_no_include_points_up() -> None:
    """A room includes those before it in the table."""
    texts = sources(CORE)
    assert len(texts) > 100
    assert upward(texts, documented_rooms()) == []


def test_files_include_what_they_use() -> None:
    """Builds that read the standard headers beforehand would not tell."""
    assert left_to_others(sources(CORE)) == []
    options = (CORE / "CMakeLists.txt").read_text(encoding="utf-8")
    listed = re.search(r"target_precompile_headers\((.*?)\)", options, re.DOTALL)
    assert listed is not None
    assert set(re.findall(r"<(\w+)>", listed[1])) == set(STANDARD)


def test_names_are_unique() -> None:
    """A file's name alone says where it is."""
    assert shared_names(sources(CORE)) == []


def test_plugins_see_the_interface_only() -> None:
    """But for what LOOKS_INSIDE names, which is all needed."""
    plugins, core = sources(PLUGINS), sources(CORE)
    assert {path.name for path in (CORE / "include").iterdir()} == INTERFACE
    assert beyond_the_interface(plugins, core) == []
    seen = {(Path(p).name, other) for p, text in plugins.items() for other in includes(text)}
    assert {(name, other) for name, others in LOOKS_INSIDE.items() for other in others} <= seen


def test_the_table_fits_on_a_screen() -> None:
    """It is read at once or not at all."""
    assert len((CORE / "README.md").read_text(encoding="utf-8").splitlines()) <= 60


def test_what_breaks_the_rules_is_named() -> None:
    """The checks find what they look for."""
    texts = {
        "include/railpatch.h": "",
        "low/a.hpp": '#include "railpatch.h"\n  # include "high/b.hpp"\n#include <cmath>',
        "low/c.cpp": '#include "b.hpp"',
        "high/b.hpp": '#include "low/a.hpp"',
        "high/c.hpp": "",
    }
    assert upward(texts, ["low", "high"]) == [
        "low/a.hpp includes b.hpp of high, above low",
        "low/c.cpp includes b.hpp, which is in no room",
    ]
    assert shared_names(texts) == ["c in high, low"]
    texts = {
        "low/a.hpp": "#include <cmath>\n#include <vector>",
        "low/a.cpp": '#include "low/a.hpp"\nstd::sqrt(2.0); std::max(1, 2); std::vector<int> a;',
    }
    assert left_to_others(texts) == ["low/a.cpp uses std::max without <algorithm>"]
    plugins = {"x/timing.cpp": '#include "railpatch.h"\n#include "low/a.hpp"'}
    assert beyond_the_interface(plugins, {"low/a.hpp": ""}) == ["x/timing.cpp includes low/a.hpp"]
