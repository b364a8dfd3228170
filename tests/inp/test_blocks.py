"""Every block and option of input files of CONTACT, read or refused by line and name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import railpatch
from inp_parts import BASIC, WHEEL, place, tables_of, text_of, with_profiles
from railpatch.errors import CaseError


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return with_profiles(tmp_path_factory.mktemp("inp"))


# what is changed in a basic case, key of the TOML, its value
BASIC_READ = [
    ({}, "motion.creepage", [0.0012, 0.0]),
    ({}, "motion.spin_creepage", -0.1),
    ({}, "motion.rolling_speed", 15.0),
    ({}, "material.shear_modulus", [82e9, 82e9]),
    ({"solver": "200 50 30 1 1D-6 9000"}, "method.tolerance", 1e-6),
    ({"third": "0200211", "solver": "200 50 30 1 1e-6\n1. 1. 0 1."}, "method.tolerance", 1e-6),
    ({"third": "0400211", "solver": "200 50 30 1 1e-6\n0 1."}, "method.max_iterations", 200),
    ({"third": "0500211", "solver": "9 9 9 1 1e-6\n1 2 3 4 5 6 7 8"}, "method.max_iterations", 9),
    ({"third": "10000211\n0000000"}, "method.normal", "half_space"),
    ({"first": "203000", "motion": "0.05 0 0 0"}, "load.approach", 5e-5),
    ({"first": "200100", "rolling": ""}, "load.normal_force", 50000.0),
    ({"first": "201100", "rolling": ""}, "motion.regime", "shift"),
    ({"first": "202100"}, "motion.distance", 6e-4),
    ({"grid": "24 1 -7.2 -0.24 0.6 0.48"}, "grid.element_size", [6e-4, 4.8e-4]),
    ({"grid": "2 20 -7.2 -4.8 7.2 0.48"}, "grid.element_size", [7.2e-3, 4.8e-4]),
    (
        {"first": "203110", "motion": "50000 0.5 0.001 0"},
        "motion.tangential_force",
        [-8750.0, "creepage"],
    ),
    (
        {"first": "203120", "motion": "50000 0.5 0.1 0"},
        "motion.tangential_force",
        [-8750.0, -1750.0],
    ),
    ({"rolling": "180d 0.6 15000."}, "motion.direction", -1),
    ({"rolling": "0r 0.6 15000. 0.1667 comment"}, "motion.rolling_speed", 15.0),
    ({"motion": "50000. 0 0 1e-3 0. 2. SPINXO SPINYO"}, "motion.creepage", [-0.002, 0.0]),
    (
        {"second": "222020", "friction": "0.1 0.2 800 0. 900 0.001 1."},
        "friction.halving_speed",
        0.8,
    ),
    ({"second": "322020", "friction": "0.1 0.2 800 0. 900 0.001 1."}, "friction.shape", "rational"),
    (
        {"second": "422020", "friction": "0.1 0.2 800 .1 900 0.001 1."},
        "friction.amplitude",
        [0.2, 0.1],
    ),
    (
        {"second": "422020", "friction": "0.1 0.2 800 0. 900 0.001 1."},
        "friction.memory_distance",
        1e-6,
    ),
    (
        {"second": "022320", "material": ".28 .28 82000 82000 0.5 0.1 0.6"},
        "method.fastsim_beta",
        0.6,
    ),
    (
        {"second": "022420", "material": ".28 .28 82000 82000 8200 1.25 0 0"},
        "layer.thickness",
        1.25e-3,
    ),
    ({"second": "022420", "material": ".28 .28 82000 82000 0 0 35 -1e3"}, "layer.hardening", -1e12),
    ({"second": "022520", "material": ".28 .28 82000 82000 1 1 0"}, "method.tangential", "fastrip"),
    (
        {"second": "022120", "material": ".5 .5 82000 82000 2 3 0.2 0.3"},
        "material.viscoelastic_ratio",
        [3.0, 2.0],
    ),
    (
        {"second": "022120", "material": ".5 .5 82000 82000 0 3 0.2 0.3"},
        "material.relaxation_time",
        [0.3, 0.0],
    ),
    ({"second": "022620"}, "method.flexibility_blending", "none"),
    ({"second": "022720"}, "method.flexibility_blending", "sliding"),
    (
        {"third": "3000211", "heat": "20 450 0.05 7.85e-6\n30 460 0.04 7.8e-6"},
        "temperature.conductivity",
        [40.0, 50.0],
    ),
    (
        {"potcon": "-1", "grid": "24 20 0.5e-3 1e-3 1.2", "distance": ""},
        "geometry.curvatures",
        [0.5, 1.0],
    ),
    (
        {"potcon": "-3", "grid": "24 20 6. 4. 1.2", "distance": ""},
        "grid.element_size",
        [6e-4, 4.8e-4],
    ),
    (
        {"potcon": "-4", "grid": "24 5 1e-3 4. 1.2", "distance": ""},
        "geometry.line_contact_radius",
        0.5,
    ),
    ({"potcon": "2", "grid": "24 20 -7.2 -4.8 7.2 4.8"}, "grid.element_size", [6e-4, 4.8e-4]),
    ({"potcon": "3", "grid": "24 20 -6.9 -4.56 0.6 0.48"}, "grid.element_size", [6e-4, 4.8e-4]),
    ({"potcon": "4", "grid": "24 20 -6.9 -4.56 6.9 4.56"}, "grid.element_size", [6e-4, 4.8e-4]),
    ({"second": "022020 1"}, "kind", "patch"),
]
# and what is refused, with a word of the reason
BASIC_REFUSED = [
    ({"first": "213100", "material": ".28 .28 82000 82000 1e-3"}, "B = 1 (a thin sheet)"),
    ({"first": "243100"}, "B = 4 (SDEC)"),
    ({"first": "223100"}, "B = 2 without an ellipse"),
    ({"first": "203010", "motion": "0.05 0.5 0 0"}, "F > 0 with the penetration given"),
    (
        {"first": "202100", "second": "022120", "material": ".28 .28 82000 82000 1 1 1 1"},
        "M = 1 (viscoelastic bodies) with T = 2",
    ),
    (
        {
            "second": "022120",
            "material": ".28 .28 82000 82000 1 1 1 1",
            "potcon": "-1",
            "grid": "24 20 0.5e-3 1e-3 1.2",
            "distance": "",
        },
        "M = 1 (viscoelastic bodies) with an ellipse",
    ),
    ({"second": "022220", "material": ".28 .28 82000 82000 1 1 1 1"}, "M = 2 (one flexibility"),
    ({"second": "022520", "material": ".28 .28 82000 82000 2 1 0"}, "M = 5 with K0"),
    ({"second": "023020"}, "C3 = 3"),
    ({"second": "024020", "material": "0 1 2\n0 0 1 1\n.28 .28 82000 82000"}, "C3 = 4"),
    ({"second": "029020", "material": "'coef.txt'\n.28 .28 82000 82000"}, "C3 = 9"),
    ({"second": "022020 2", "heat": "1 1 1 1"}, "M2 = 2"),
    ({"second": "022020 11"}, "gap weighting"),
    (
        {"potcon": "-3", "grid": "24 20 6. 4. 1.2", "distance": "", "second": "022009"}
        | {"extra": "0 0\n" * 480},
        "extra rigid slip with an ellipse",
    ),
    (
        {"second": "022329", "material": ".28 .28 82000 82000 1 1 0", "extra": "0 0\n" * 480},
        "extra rigid slip without the full theory",
    ),
    ({"second": "322020", "friction": "0.1 0.2 800 .1 900 0.001 1."}, "L = 3 with a second term"),
    ({"second": "622020", "friction": "0.3 0 -.1 400 0 0"}, "L = 6 without temperatures"),
    ({"friction": "0.35 0.3"}, "L = 0 with FSTAT other than FKIN"),
    ({"rolling": "90d 0.6 15000."}, "CHI"),
    ({"potcon": "-6", "grid": "24 20 6. 4. 4. 1.2", "distance": ""}, "IPOTCN = -6"),
    ({"potcon": "-2", "grid": "24 20 1e-3 1.5 1.2", "distance": ""}, "IPOTCN = -2"),
    ({"distance": "1 2\n1e-3 0 1e-3 0 0 0\n1 1 1 1 1 1"}, "IPLAN = 2"),
    ({"distance": "1 3\n1e-3 0 1e-3 0 0 0\n" + "1 " * 8}, "IPLAN = 3"),
    ({"distance": "1 4\n1e-3 0 1e-3 0 0 0\n2\n" + "1 " * 9}, "IPLAN = 4"),
    ({"second": "322020", "friction": "0.1 0.2 800 0"}, "expected a number"),
    ({"solver": "200 50 x"}, "MAXNR: expected a number, found 'x'"),
    ({"potcon": "4", "grid": "24 1 -6.9 0 6.9 0"}, "IPOTCN = 4 with one row"),
    ({"grid": "0 20 -7.2 -4.8 0.6 0.48"}, "a grid of 0 x 20"),
    ({"potcon": "7"}, "IPOTCN is 7"),
    ({"distance": "5 1"}, "IBASE is 5"),
    ({"end": ""}, "ends without 'module 0'"),
    ({"module": "2 MODULE"}, "module 2"),
    ({"first": "12345678"}, "too many digits"),
    ({"second": "122020", "friction": ""}, "L = 1 in the first case"),
    ({"first": "204100"}, "line 2: T = 4: allowed 0, 1, 2, 3"),
    ({"first": "203900"}, "N = 9: allowed 0, 1"),
    ({"first": "203140"}, "F = 4: allowed 0, 1, 2"),
    ({"first": "273100"}, "line 2: B = 7: allowed 0, 1, 2, 3, 4, 5, 6"),
    ({"first": "703100"}, "P = 7: allowed 0, 1, 2, 3"),
    ({"second": "1022020"}, "line 3: V = 1: allowed 0, 3"),
    ({"second": "025020"}, "C3 = 5: allowed 0, 1, 2, 3, 4, 9"),
    ({"second": "022027"}, "E = 7: allowed 0, 1, 2, 3, 9"),
    ({"third": "4000211"}, "line 4: H = 4: allowed 0, 1, 3"),
    ({"third": "20000211"}, "X = 2: allowed 0, 1"),
]


@pytest.mark.parametrize(("changes", "key", "value"), BASIC_READ)
def test_basic_blocks(folder, changes, key, value):
    tables = tables_of(folder, text_of(BASIC, **changes))
    found = place(tables, key)
    if isinstance(value, str):
        assert found == value
    elif isinstance(value, list) and isinstance(value[-1], str):
        assert found[-1] == value[-1]
        assert found[0] == pytest.approx(value[0])
    else:
        assert found == pytest.approx(value)
    railpatch.Contact(tables, folder=folder)  # it is a case


@pytest.mark.parametrize(("changes", "reason"), BASIC_REFUSED)
def test_basic_refused(folder, changes, reason):
    with pytest.raises(CaseError) as error:
        tables_of(folder, text_of(BASIC, **changes))
    assert reason in str(error.value)
    assert "case.inp" in str(error.value)


WHEEL_READ = [
    ({}, "wheel.side", "right"),
    ({"first": "0203100"}, "wheel.side", "left"),
    ({}, "wheelset.yaw", np.radians(0.1)),
    ({"first": "1203000", "position": "0 2. 0.31 0 0 0"}, "wheelset.z", 3.1e-4),
    (
        {"first": "5203100", "track": "14. 0 1435. 500.", "velocity": "40. 0 0 0 0 -43.48"},
        "track.roller_radius",
        0.5,
    ),
    (
        {"first": "5203100", "track": "14. 0 1435. 500.", "velocity": "40. 0 0 0 0 -43.48"},
        "track.roller_pitch_rate",
        40.0,
    ),
    ({"track": "14. 0 1435. 0.025 1e-6"}, "track.curvature", 1e-3),
    ({"track": "14. 0 1435. 1.5d CANT"}, "track.cant", np.radians(1.5)),
    ({"deviation": "1. -2. 0.1d 3. 4. 0.5"}, "track.right.offset", [0.0, 1e-3, -2e-3]),
    ({"deviation": "1. -2. 0.1d 3. 4. 0.5"}, "track.right.velocity", [0.0, 3e-3, 4e-3]),
    (
        {"first": "1203130", "support": "100. 500. 0. 0."},
        "track.rail_support.stiffness",
        [1e5, 0.0],
    ),
    ({"first": "1203130", "support": "100. 500. 0. 0."}, "track.right.offset", [0.0, 5e-3, 0.0]),
    (
        {"second": "0022035", "flexibility": "1 2 3 .1 .2 .3\n0 0 0 0 0 0"},
        "wheelset.right.rotation",
        [0.1, 0.3, 0.2],
    ),
    (
        {"second": "0042033", "patches": "0.4 0.4 1. 90d 8. 4. 12."},
        "method.reference_surface",
        "curved",
    ),
    (
        {"second": "1022033", "friction": "2\n-0.2 0.1 0.1\n0.1 0.3 0.3"},
        "friction.factor",
        [[-0.075, 3.0], [0.225, 1.0]],
    ),
    (
        {"second": "2022033", "friction": "2\n0 0.2 0.2\n1000. 0.3 0.3"},
        "friction.along_track",
        [[0.0, 1.0], [1.0, 1.5]],
    ),
    ({"first": "1202100", "patches": "0.4 0.4 2. 180d 8. 4."}, "wheelset.time_step", 4e-5),
    ({"first": "1253100"}, "method.normal", "kik_piotrowski"),
    ({"first": "1263100"}, "method.normal", "analyn"),
    ({"first": "1200100"}, "method.tangential", "none"),
    (
        {
            "rail": "'rail.txt' 0 1. 2. -1 1\n2 2.6 0.5 0.1 2.",
            "wheel": "'wheel.txt' 0 1. 2. -1 2\n2 2.6 0.5 0.1 2.\n0 0.5",
        },
        "profiles.smoothing",
        2e-3,
    ),
    ({"rail": "'rail.txt' 1 25.4 0. 1"}, "profiles.rail_file.mirror", "yz"),
    (
        {"first": "1203110", "velocity": "20000. 0 0 0 0 -3000."},
        "wheelset.longitudinal_force",
        3000.0,
    ),
    ({"first": "1203120", "velocity": "20000. 0 0 0 0 0."}, "wheelset.pitch_rate", "free"),
    ({"first": "1203120", "velocity": "20000. 0 0 0 0 46e4"}, "wheelset.axle_torque", -460.0),
    (
        {"first": "1203103", "flexibility": "1 1\n9\n1 2 3\n0.\n0. 1.\n0.5 1. 2.\n1\n3 0.5 0.5\n0"},
        "kind",
        "wheel_rail",
    ),
]
WHEEL_REFUSED = [
    ({"first": "2203100"}, "line 2: C1 = 2: allowed 0, 1, 4, 5"),
    ({"first": "1204100"}, "T = 4: allowed 0, 1, 2, 3"),
    ({"second": "3022033"}, "line 3: V = 3: allowed 0, 1, 2"),
    ({"second": "0025033"}, "C3 = 5: allowed 0, 1, 2, 3, 4"),
    ({"first": "1201100"}, "T = 1"),
    ({"first": "1200110"}, "F = 1, 2"),
    ({"first": "1223100"}, "B = 2 on wheels"),
    ({"second": "0032033"}, "D = 3"),
    ({"second": "0072033"}, "D = 7"),
    ({"second": "0023033"}, "C3 = 3"),
    ({"second": "0024033", "material": "0 4\n.28 .28 82000 82000"}, "C3 = 4"),
    ({"patches": "0.4 0.4 1. 90d 6. 4."}, "D_SEP"),
    ({"patches": "0.4 0.4 1. 30d 8. 4."}, "A_SEP"),
    ({"first": "5203100", "track": "-1. 10. 20. 460."}, "GAUGHT <= 0"),
    ({"wheelset": "1360. -70. 460. 70."}, "YTAPE"),
    ({"first": "1203130", "support": "100. 500. 0. 0. 1."}, "DYSTEP0"),
    ({"rail": "'rail.txt' 0 1. 2. -1"}, "SMOOTH = 2 of 'rail.txt' by ISMOOTH = 0"),
    ({"rail": "'rail.txt' 0 3. 0. -1"}, "SCALE = 3"),
    ({"rail": "rail.txt 0 3. 0. -1"}, "expected a name"),
    ({"second": "1022033", "friction": "2\n-0.2 0.1 0.1\n0.1 0.3 0.2"}, "no multiples"),
    ({"second": "0022031", "wheelset": "", "wheel": "", "velocity": ""}, "block of wheelset"),
    ({"second": "1022033", "friction": "11\n"}, "NVF is 11"),
]


@pytest.mark.parametrize(("changes", "key", "value"), WHEEL_READ)
def test_wheel_blocks(folder, changes, key, value):
    tables = tables_of(folder, text_of(WHEEL, **changes))
    found = place(tables, key)
    if isinstance(value, str):
        assert found == value
    else:
        np.testing.assert_allclose(found, value, atol=1e-15)


@pytest.mark.parametrize(("changes", "reason"), WHEEL_REFUSED)
def test_wheel_refused(folder, changes, reason):
    with pytest.raises(CaseError) as error:
        tables_of(folder, text_of(WHEEL, **changes))
    assert reason in str(error.value)
