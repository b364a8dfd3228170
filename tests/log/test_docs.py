"""docs/log_channels.md is the table, and docs/logs.md speaks of what is there."""

from __future__ import annotations

import re
from pathlib import Path

from railpatch.command.cli import cli
from railpatch.log.channels import channel, markdown

from wheelset_demo.scene import Run
from wheelset_demo.vehicle.scene import RunTable

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_the_page_of_channels_is_the_table():
    """It is what railpatch.log.channels.markdown() gives, to the letter."""
    page = DOCS / "log_channels.md"
    assert page.read_text(encoding="utf-8") == markdown(), f"{page} is not markdown(): write it"


def test_topics_and_keys_of_the_page_exist():
    text = (DOCS / "logs.md").read_text(encoding="utf-8")
    topics = set(re.findall(r"`(/(?:wheelset|vehicle|left|rig)/[\w/]+)`", text))
    assert len(topics) > 5
    for topic in topics:
        assert channel(topic)
    keys = {"log_every", "write_rate", "scene_rate", "snapshot_every", "snapshot_rate"}
    assert set(re.findall(r"`(\w+_(?:every|rate))`", text)) == keys
    assert keys <= set(Run.model_fields) | set(RunTable.model_fields)
    for name in set(re.findall(r"`?railpatch (\w+) (?:run|-o)", text)):
        assert cli.get_command(None, name) is not None
    assert Run.model_fields["scene_rate"].default == 30
    assert Run.model_fields["log_every"].default == 10
    assert RunTable.model_fields["log_every"].default == 5
