"""The list of config fields that plug-ins carry against the struct in the public header."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
# not carried: set by the core, or pointers that travel in another way
ELSEWHERE = {
    "cookie",
    "undeformed_distance",
    "wheel",
    "rail",
    "rail_sections",
    "section_position",
    "section_count",
    "runout",
    "rail_height",
    "creep_table",
    "creep_table_size",
    "observer",
    "observer_user",
}


def test_every_plain_field_is_listed() -> None:
    header = (ROOT / "core/include/railpatch.h").read_text()
    body = re.search(r"typedef struct rp_config \{(.*?)\} rp_config;", header, re.DOTALL)
    assert body is not None
    plain = re.sub(r"/\*.*?\*/", "", body[1], flags=re.DOTALL)
    fields = set()
    for declaration in filter(None, (part.strip() for part in plain.split(";"))):
        names = declaration.split(None, 1)[1]
        fields |= {re.sub(r"\[.*", "", name).split()[-1].strip("*") for name in names.split(",")}
    listed = set(
        re.findall(r"X\((\w+)\)", (ROOT / "plugins/common/config_fields.hpp").read_text())
    ) - {"X"}
    assert len(fields) > 40
    assert fields - ELSEWHERE == listed
