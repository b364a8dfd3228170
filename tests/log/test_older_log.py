"""Logs that an older version wrote stay readable: what was added since is absent."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import synthetic
from click.testing import CliRunner
from railpatch.command.cli import cli
from railpatch.log import read_run
from railpatch.log.channels import CHANNELS, Message
from railpatch.log.encode import encode
from railpatch.log.stream import LogStream
from railpatch.report import write_report

# what was added since
LATER = {
    "WheelsetState": ("left_rail", "right_rail"),
    "WheelContact": ("friction_work",),
}
LATER_TOPICS = ("/wheelset/momentum",)


def _older(message: Message) -> Message:
    later = LATER.get(message.name, ())
    assert all(message.field(name) for name in later)
    return replace(message, fields=tuple(f for f in message.fields if f.name not in later))


def _write(path) -> None:
    table = tuple(
        replace(entry, message=_older(entry.message))
        for entry in CHANNELS
        if entry.topic not in LATER_TOPICS
    )
    messages = {entry.topic: entry.message for entry in table}
    attached = [("old.toml", "application/toml", synthetic.CASE.encode())]
    log = LogStream(path, table, {"scene": "old.toml", "track_kind": "rail"}, attached)
    for index in range(5):
        state = synthetic.state(index) | {"x": 0.1 * index}
        given = {"/wheelset/state": state, "/wheelset/energy": {"friction_work": 1.0 * index}}
        given |= {f"/{side}/contact": synthetic.side(side, index) for side in ("left", "right")}
        encoded = {topic: encode(messages[topic], v, topic) for topic, v in given.items()}
        log.add(encoded, index * 10**7)
    log.close()


def test_older_log(tmp_path):
    path = tmp_path / "old.mcap"
    _write(path)
    run = read_run(path)
    assert "left_rail" not in run["/wheelset/state"].messages[0]
    assert list(run["/wheelset/energy"]["friction_work"]) == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert len(run["/wheelset/momentum"]) == 0
    page = write_report(path, tmp_path / "page.html").read_text(encoding="utf-8")
    assert page.count('id="waves"') == page.count('id="energy"') == 1
    assert 'id="momentum"' not in page
    made = CliRunner().invoke(cli, ["layout", str(path), "-o", str(tmp_path / "layout.json")])
    assert made.exit_code == 0, made.output
    layout = json.loads((tmp_path / "layout.json").read_text())
    titles = [tab["title"] for tab in layout["configById"]["Tab!tabs"]["tabs"]]
    assert titles == ["Motion", "Forces", "Contact", "Energy"]
    assert np.isfinite(run["/left/contact"]["force"]).all()
