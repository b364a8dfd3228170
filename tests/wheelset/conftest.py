"""The wheelset with its contact in an FMU, for the tests of co-simulation."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import wheelset_scenes as scenes

from wheelset_demo.coupling.slave import ContactSlave
from wheelset_demo.coupling.study import slave_of, with_elements
from wheelset_demo.scene import WheelsetScene


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> WheelsetScene:
    """hunting.toml, on a small grid."""
    return with_elements(scenes.scene(tmp_path_factory.mktemp("s"), "hunting.toml"), 8)


@pytest.fixture(scope="module")
def slave(scene: WheelsetScene) -> Iterator[ContactSlave]:
    """Its contact in an FMU."""
    with slave_of(scene) as found:
        yield found
