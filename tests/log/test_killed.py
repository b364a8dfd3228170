"""A run that is killed keeps its log up to less than a second before."""

from __future__ import annotations

import contextlib
import os
import signal
import struct
import subprocess
import sys
import time
from io import BytesIO
from pathlib import Path

import pytest
import synthetic
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from railpatch.log import RunFileError, read_run

HERE = Path(__file__).parent
DEADLINE = 60.0  # s, for what takes a quarter of one


def _start(path: Path, positions: int) -> subprocess.Popen:
    paths = os.pathsep.join(filter(None, sys.path))
    return subprocess.Popen(
        [sys.executable, str(HERE / "killed_run.py"), path, str(positions)],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": paths},
    )


def _kill(process: subprocess.Popen) -> None:
    process.send_signal(signal.SIGKILL)
    assert process.wait(timeout=10) == -signal.SIGKILL
    process.stdout.close()


def _kept(path: Path, fewest: int, process: subprocess.Popen) -> list[int]:
    """Positions in the file of a process that goes on, once there are some; it has a minute."""
    end = time.monotonic() + DEADLINE
    kept: list[int] = []
    while len(kept) < fewest and time.monotonic() < end:
        assert process.poll() is None
        time.sleep(0.02)
        with contextlib.suppress(RunFileError, FileNotFoundError):
            kept = [int(t) for t in read_run(path)["/wheelset/state"].time]
    return kept


def test_killed_while_computing(tmp_path):
    """The caller is busy in one long position: what it wrote before gets into the file."""
    path = tmp_path / "run.mcap"
    process = _start(path, 5)
    try:
        for expected in range(5):
            assert process.stdout.readline() == f"{expected}\n"
        assert _kept(path, 5, process) == [0, 1, 2, 3, 4]
    finally:
        _kill(process)
    run = read_run(path)
    assert run.truncated
    assert run.problem
    assert list(run["/wheelset/state"].time) == [0, 1, 2, 3, 4]
    assert run.attachments["rig.toml"].data == synthetic.CASE.encode()
    assert run.metadata["railpatch"]["scene"] == "rig.toml"


def test_killed_while_writing(tmp_path):
    """Positions keep coming, and get into the file meanwhile: none of them is lost."""
    path = tmp_path / "run.mcap"
    # more than there is time for
    process = _start(path, 100_000)
    try:
        seen = _kept(path, 20, process)
    finally:
        _kill(process)
    assert len(seen) >= 20
    run = read_run(path)
    assert run.truncated
    kept = [int(t) for t in run["/wheelset/state"].time]
    assert kept == list(range(len(kept)))
    assert set(seen) <= set(kept)


def test_killed_before_the_first_position(tmp_path):
    with_header = tmp_path / "run.mcap"
    log = synthetic.open_log(with_header)
    data = with_header.read_bytes()
    log.close()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data)
    run = read_run(cut)
    assert run.truncated
    assert run.attachments.keys() == {"rig.toml", *synthetic.PROFILES}


def test_the_mcap_library_streams_a_cut_file(tmp_path):
    path = synthetic.write_rig_run(tmp_path / "run.mcap")
    path.write_bytes(path.read_bytes()[:-2000])
    topics = []
    # what the library raises hangs on the record within which the file ends
    with open(path, "rb") as stream, contextlib.suppress(EndOfFile, struct.error):
        for _, channel, _ in NonSeekingReader(stream).iter_messages(log_time_order=False):
            topics.append(channel.topic)
        pytest.fail("the file was to be cut")
    assert topics.count("/left/contact") == 37


@pytest.fixture(scope="module")
def many_chunks(tmp_path_factory):
    """Bytes of a run, and the ends of its chunks."""
    path = tmp_path_factory.mktemp("cut") / "run.mcap"
    with synthetic.open_log(path) as log:
        for index in range(12):
            synthetic.write_position(log, index)
            time.sleep(0.09)
    return path.read_bytes()


def test_cut_anywhere(tmp_path, many_chunks):
    """Never an exception, never a wrong value, and never less for a longer file."""
    path, before = tmp_path / "cut.mcap", 0
    start = many_chunks.index(b"zstd")
    for end in [
        *range(start, len(many_chunks), 997),
        *range(len(many_chunks) - 60, len(many_chunks)),
    ]:
        path.write_bytes(many_chunks[:end])
        run = read_run(path)
        assert run.truncated, end
        state = run["/wheelset/state"]
        assert len(state) >= before
        before = len(state)
        if before:
            assert list(state["y"]) == [synthetic.lateral_at(i) for i in range(before)]
    assert before == 12
    path.write_bytes(many_chunks)
    assert not read_run(path).truncated


def test_damaged_chunk_is_noticed(tmp_path, many_chunks):
    last = make_reader(BytesIO(many_chunks)).get_summary().chunk_indexes[-1]
    data = bytearray(many_chunks)
    data[last.chunk_start_offset + last.chunk_length // 2] ^= 0xFF
    path = tmp_path / "damaged.mcap"
    path.write_bytes(data)
    run = read_run(path)
    assert run.truncated
    assert len(run["/wheelset/state"]) < 12


def test_an_error_ends_the_run_with_a_whole_file(tmp_path):
    path = tmp_path / "run.mcap"
    with contextlib.suppress(KeyboardInterrupt), synthetic.open_log(path) as log:
        synthetic.write_position(log, 0)
        raise KeyboardInterrupt
    run = read_run(path)
    assert not run.truncated
    assert run.stopped_by == "KeyboardInterrupt"
