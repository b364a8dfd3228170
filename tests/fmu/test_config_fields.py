"""Every number of a case reaches the FMU: what the core's config holds is what the FMU reads."""

from __future__ import annotations

import re

from conftest import PROJECT
from railpatch import _core

# handed over as arrays or set by the caller
ELSEWHERE = {"cookie", "undeformed_distance", "wheel", "rail", "observer", "observer_user"}


def test_every_field_of_the_config_is_handed_over() -> None:
    header = (PROJECT / "core" / "include" / "railpatch.h").read_text(encoding="utf-8")
    (body,) = re.findall(r"typedef struct rp_config \{(.*?)\} rp_config;", header, re.DOTALL)
    plain = re.sub(r"/\*.*?\*/", "", body, flags=re.DOTALL)
    names = set(re.findall(r"(\w+)(?:\[\d+\])*\s*[;,]", plain))
    assert "fitted" in names
    assert names - ELSEWHERE == set(_core.config_numbers({}))
