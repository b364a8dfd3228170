"""solve_many(): the numbers of single solves, for any number of threads; what it refuses."""

from __future__ import annotations

import copy
import pickle
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest
import railpatch
from patch_cases import patch_case
from railpatch import CaseError, Contact, StateError, solve_many
from railpatch.many import BLOCK, INPUT, RESULT

N = 40
RNG = np.random.default_rng(7)
CREEPAGE = RNG.uniform(-4e-3, 4e-3, (N, 2))
FORCE = RNG.uniform(1e4, 1e5, N)
SPIN = RNG.uniform(-0.5, 0.5, N)
WHEEL = {
    "kind": "wheel_rail",
    "wheel": {"side": "right"},
    "wheelset": {
        "vertical_force": 8e4,
        "speed": 20.0,
        "pitch_rate": -43.478,
        "nominal_radius": 0.46,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.07,
    },
    "track": {"gauge": 1.435, "gauge_height": 0.014},
    "profiles": {"wheel": "worn@2", "rail": "worn@3"},
    "friction": {"coefficient": 0.3},
    "method": {"normal": "hertz", "tangential": "fastsim"},
    "grid": {"elements": [12, 12]},
}


def patch(**method: Any) -> dict[str, Any]:
    """One patch of Hertz's."""
    return patch_case({"curvatures": [2.0, 1.5]}, force=5e4, elements=12, creepage=(0, 0), **method)


def transient() -> dict[str, Any]:
    """The same in transient rolling, a step at a time."""
    case = patch(tangential="full")
    case["grid"] = {"element_size": [1e-3, 1e-3], "max_elements": [16, 16]}
    case["motion"] |= {"regime": "transient_rolling", "distance": 5e-4, "steps": 1}
    return case


def same(a: Any, b: Any) -> bool:
    """To the bit, absent numbers alike."""
    if b is None:
        return bool(np.isnan(a).all())
    return np.asarray(a, dtype=float).tobytes() == np.asarray(b, dtype=float).tobytes()


def test_records_are_those_of_the_core() -> None:
    """A case's input as a record has the values of its fields."""
    case = patch(tangential="polach")
    contact = Contact(case)
    from railpatch.case.to_core import input_of

    values = input_of(contact.case)
    record = np.frombuffer(railpatch._core.input_record(values), dtype=INPUT)[0]
    for name, value in values.items():
        assert same(record[name], value), name
    assert RESULT["side"].shape == (2,)


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("tangential", ["full", "table", "none"])
def test_patches_are_single_solves(tangential: str, threads: int) -> None:
    """Every number, to the bit."""
    case = patch(tangential=tangential)
    inputs: dict[str, Any] = {"normal_force": FORCE}
    if tangential == "none":
        case.pop("motion"), case.pop("friction")
    else:
        inputs |= {"creepage": CREEPAGE, "spin_creepage": SPIN}
    states = solve_many(case, inputs, threads=threads)
    assert len(states) == N
    assert states.good.all()
    contact = Contact(case)
    for i in range(0, N, 7):
        contact.reset()
        alone = contact.step(**{name: values[i] for name, values in inputs.items()}).data
        for name, values in states.arrays.items():
            head, _, rest = name.partition(".")
            wanted = alone[head][rest] if rest else alone[head]
            assert (values[i] == wanted) if head == "status" else same(values[i], wanted), name


@pytest.mark.parametrize("kind", ["wheel_rail", "wheelset"])
def test_wheels_are_single_solves(kind: str) -> None:
    """With flange contact, and beside the rail; of deviations too, by names with dots or tables."""
    case = copy.deepcopy(WHEEL) | {"kind": kind}
    if kind == "wheelset":
        case.pop("wheel")
    y = np.linspace(-2e-3, 5e-3, 16)
    load = np.full(16, 8e4)
    load[3] = 0.0
    offset = np.outer(np.linspace(0, 1, 16), [0.0, 2e-4, 1e-5])
    states = solve_many(
        case,
        {
            "y": y,
            "vertical_force": load,
            "track": {"right": {"offset": offset}},
            "right.rotation": [0, 0, 1e-4],
        },
        threads=2,
    )
    contact = Contact(case)
    counts = set()
    for i in range(16):
        contact.reset()
        one = contact.step(
            y=y[i],
            vertical_force=load[i],
            track={"right": {"offset": offset[i]}},
            right={"rotation": [0, 0, 1e-4]},
        ).data
        assert states["status"][i] == one["status"]
        assert same(states["force"][i], one["force"])
        prefix, wheel = ("right.", one["right"]) if kind == "wheelset" else ("", one)
        patches = wheel["patches"]
        counts.add(len(patches))
        assert states[f"{prefix}patches.count"][i] == len(patches)
        for name in ("normal_force", "creep_force", "position", "error_estimate.max_pressure"):
            values = states[f"{prefix}patches.{name}"][i]
            assert np.isnan(values[len(patches) :]).all()
            for value, found in zip(values, patches, strict=False):
                head, _, rest = name.partition(".")
                assert same(value, found[head][rest] if rest else found[head]), name
        if kind == "wheelset":
            assert same(states["left.contact_power"][i], one["left"]["contact_power"])
            assert same(states["axle_torque"][i], one["axle_torque"])
    assert {0, 1, 2} <= counts


def test_sequences_are_motions() -> None:
    """Each step from the last one's solution, each sequence from nothing: what a contact that is
    reset between them gives."""
    case = patch(tangential="full") | {}
    creepage = np.tile(CREEPAGE[:10], (4, 1))
    states = solve_many(case, {"creepage": creepage}, threads=3, sequence=10)
    contact = Contact(case)
    for i in range(40):
        if i % 10 == 0:
            contact.reset()
        alone = contact.step(creepage=creepage[i])
        assert same(states["creep_force"][i], alone["creep_force"])
        assert states["iterations"][i] == alone["iterations"]
    for k in range(1, 4):
        assert same(states["creep_force"][10 * k : 10 * k + 10], states["creep_force"][:10])


def test_transient_rolling_in_sequences() -> None:
    """Histories that do not know of each other."""
    case = transient()
    states = solve_many(case, {"creepage": np.tile([[1e-3, 0.0]], (12, 1))}, sequence=4)
    contact = Contact(case)
    forces = [contact.step(creepage=[1e-3, 0.0])["creep_force"] for _ in range(4)]
    assert same(states["creep_force"], forces * 3)


def test_what_was_not_found_is_told_by_its_number() -> None:
    """Reasons and warnings; the other states are as they are."""
    case = copy.deepcopy(WHEEL)
    y = np.array([0.0, 0.3, 1e-3])
    states = solve_many(case, {"y": y})
    assert list(states["status"]) == ["converged", "out_of_range", "converged"]
    alone = [railpatch.Contact(case).step(y=value) for value in y]
    assert states.reason == {1: alone[1].reason}
    assert states.warnings == {i: r.warnings for i, r in enumerate(alone) if r.warnings}
    assert states.good.tolist() == [True, False, True]


def test_fields_are_those_of_single_solves() -> None:
    """On one thread."""
    case = patch(tangential="full")
    states = solve_many(case, {"creepage": CREEPAGE[:3]}, fields=True)
    for i in range(3):
        alone = Contact(case).step(creepage=CREEPAGE[i], fields=True)
        (found,) = states["fields"][i]
        assert same(found["pressure"], alone["pressure"])
        assert same(found["traction"], alone["traction"])
        assert same(states["creep_force"][i], alone["creep_force"])


def test_outputs_that_are_kept_and_progress() -> None:
    """Blocks are told; a name that there is not is refused with those that there are."""
    case = patch(tangential="polach")
    count = 2 * BLOCK + 5
    told: list[tuple[int, int]] = []
    states = solve_many(
        case,
        {"creepage": np.full((count, 2), 1e-3)},
        outputs=["creep_force"],
        progress=lambda done, all_: told.append((done, all_)),
    )
    assert states.keys() == ["status", "creep_force"]
    done = [first for first, _ in told]
    assert done[0] == BLOCK
    assert done == sorted(set(done))
    assert done[-1] == count
    assert {total for _, total in told} == {count}
    with pytest.raises(CaseError, match="outputs: value is 'creep_forse', allowed status, normal"):
        solve_many(case, {"creepage": CREEPAGE}, outputs=["creep_forse"])


def test_forces_that_are_prescribed() -> None:
    """In one direction, and nothing in the other one."""
    case = patch(tangential="full")
    case["motion"] = {
        "tangential_force": [1e3, "creepage"],
        "creepage": [0.0, 1e-3],
        "rolling_speed": 9.0,
    }
    force = np.outer(np.linspace(1e3, 8e3, 6), [1.0, 0.0])
    states = solve_many(case, {"tangential_force": force})
    assert states["creep_force"][:, 0] == pytest.approx(force[:, 0], rel=1e-6)
    alone = Contact(case).step(tangential_force=[float(force[3, 0]), "creepage"])
    assert same(states["creepage"][3], alone["creepage"])
    with pytest.raises(CaseError, match="tangential_force: has component 1, allowed 0"):
        solve_many(case, {"tangential_force": force + 1.0})


@pytest.mark.parametrize(
    ("inputs", "told"),
    [
        ({"creepages": CREEPAGE}, "creepages: value is"),
        ({"creepage": CREEPAGE[:, 0]}, "creepage: value has the shape (40,), allowed 2 numbers"),
        ({"creepage": CREEPAGE, "normal_force": FORCE[:9]}, "normal_force has 9"),
        ({"normal_force": 5e4}, "none has rows"),
        ({"normal_force": [1e4, float("nan")]}, "normal_force: value of state [1] is not finite"),
        ({"normal_force": ["a"]}, "normal_force: value is ['a'], allowed numbers"),
        ({"normal_force": ["1e4", "2e4"]}, "normal_force: value is ['1e4', '2e4'], allowed num"),
        ({"normal_force": [True, False]}, "normal_force: value is [True, False], allowed numbers"),
        ({"normal_force": [1e4 + 1j]}, "allowed numbers"),
        ({"normal_force": np.ma.masked_array([1e4, 2e4], [False, True])}, "allowed numbers"),
        ({"direction": [1, 1.5]}, "direction: value of state [1] is no integer, allowed integers"),
        ({"normal_force": [1e4, 1e4, -1.0]}, "state 2: normal_force is -1, allowed is [0, inf)"),
        ({"normal_force": []}, "inputs: have 0 rows"),
        ([1], "inputs: value is [1], allowed a table of arrays"),
    ],
)
def test_wrong_inputs_are_refused(inputs: Any, told: str) -> None:
    """By name, value and place."""
    with pytest.raises(CaseError) as error:
        solve_many(patch(tangential="polach"), inputs)
    assert told in str(error.value)


def test_the_number_of_a_wrong_state_is_known() -> None:
    """Beyond the first block too."""
    force = np.full(BLOCK + 20, 1e4)
    force[BLOCK + 3] = -5.0
    with pytest.raises(StateError) as error:
        solve_many(patch(tangential="polach"), {"normal_force": force})
    assert error.value.state == BLOCK + 3


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"threads": 0}, "threads: value is 0, allowed 1 to 1024"),
        ({"threads": 1.5}, "threads: value is 1.5"),
        ({"sequence": 3}, "sequence: value is 3, allowed what divides 40 states"),
        ({"threads": 2, "fields": True}, "threads: value is 2, allowed 1 with fields"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, Any], told: str) -> None:
    """By name and value."""
    with pytest.raises(CaseError, match="value is") as error:
        solve_many(patch(tangential="polach"), {"normal_force": FORCE}, **options)
    assert told in str(error.value)


def test_other_threads_run_and_signals_end_it() -> None:
    """The lock is released; an interrupt ends many states soon."""
    case = patch(tangential="full")
    case["grid"]["elements"] = [24, 24]
    creepage = np.tile(CREEPAGE, (250, 1))
    ticks: list[float] = []
    running = True

    def tick() -> None:
        while running:
            ticks.append(time.perf_counter())
            time.sleep(0.005)

    def stop(_signal: int, _frame: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, stop)
    thread = threading.Thread(target=tick)
    thread.start()
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        begin = time.perf_counter()
        with pytest.raises(KeyboardInterrupt):
            solve_many(case, {"creepage": creepage}, threads=2)
        spent = time.perf_counter() - begin
    finally:
        running = False
        thread.join()
        signal.signal(signal.SIGALRM, before)
    # 10,000 states take 10 s and more
    assert spent < 5.0
    assert len(ticks) > 5


def test_tables_for_other_packages() -> None:
    """A column for each number in pandas; what is not installed is told."""
    states = solve_many(patch(tangential="polach"), {"creepage": CREEPAGE})
    frame = states.to_pandas()
    assert len(frame) == N
    assert list(frame["creep_force[1]"]) == list(states["creep_force"][:, 1])
    assert set(frame["status"]) == {"converged"}
    with pytest.raises(ImportError, match="xarray is not installed; pip install xarray has it"):
        states.to_xarray()
    assert repr(states) == f"States({N}: {N} converged)"
    with pytest.raises(KeyError, match="no quantity 'force'; there are status, normal_force"):
        states["force"]


@pytest.mark.parametrize(
    "make", [copy.copy, copy.deepcopy, lambda c: pickle.loads(pickle.dumps(c))]
)
def test_contacts_are_copied_with_their_state(make: Any) -> None:
    """The next step of both gives the same bits, which a new contact's does not; they do not know
    of each other."""
    case = transient()
    contact = Contact(case)
    for _ in range(3):
        contact.step(creepage=[2e-3, 1e-3], normal_force=6e4)
    other = make(contact)
    wanted = contact.step(creepage=[1e-3, 0.0])["creep_force"]
    contact.step(creepage=[5e-3, 0.0])
    assert same(other.step(creepage=[1e-3, 0.0])["creep_force"], wanted)
    anew = Contact(case).step(creepage=[1e-3, 0.0], normal_force=6e4)
    assert not same(anew["creep_force"], wanted)


def test_results_show_themselves_in_notebooks() -> None:
    """Numbers with units, of wheel and patches; nothing of a file's text is markup."""
    page = Contact(WHEEL).step(y=0.0)._repr_html_()
    assert "<caption>converged</caption>" in page
    assert "<caption>patch 1</caption>" in page
    assert page.count("<td>normal_force</td>") == page.count("<caption>patch") == 2
    assert "<td>max_pressure</td>" in page
    assert "<td>Pa</td>" in page
    result = railpatch.Result({"status": "converged", "reason": "<b>"})
    assert "&lt;b&gt;" in result._repr_html_()
