"""Reading logs: what they may look like, and what each mistake is answered with."""

from __future__ import annotations

import math

import numpy as np
import pytest
from identification.logs import COLUMNS, written

from dq_marine import checks, load_vehicle
from dq_marine.errors import InvalidInputError
from dq_marine.identification import log as log_module
from dq_marine.identification import read_log

MOTION = COLUMNS[:11]


@pytest.fixture(scope="module")
def rov():
    return load_vehicle("bluerov2_heavy")


@pytest.fixture(scope="module")
def auv():
    return load_vehicle("remus100")


def table(columns=COLUMNS, rows=200):
    """Return rows in which column j of row i is 0.001 (i + j), and time in steps of 0.1 s."""
    return [
        [0.1 * i if name == "time_s" else 0.001 * (i + j) for j, name in enumerate(columns)]
        for i in range(rows)
    ]


def log_of(tmp_path, vehicle, columns, rows=None):
    return read_log(written(tmp_path / "run.csv", table(columns) if rows is None else rows, columns), vehicle)


def test_units_become_si(tmp_path, rov):
    columns = [
        *("time_ms", "down_m", "roll_rad", "pitch_deg", "heading_deg", "u_kn", "v_m_s", "w_m_s"),
        *("p_deg_s", "q_rad_s", "r_rad_s", "X_kN", "N_N_m", "reward", "heading_error_deg"),
    ]
    rows = [
        [100.0 * i, 3.0, 0.2, 10.0, 20.0, 1.0, 2.0, 3.0, 90.0, 0.1, 0.2, 0.03, 4.0, 0.0, 0.0]
        for i in range(200)
    ]
    log = log_of(tmp_path, rov, columns, rows)
    assert log.period == pytest.approx(0.1)
    assert log.velocity_body[0] == pytest.approx([1852.0 / 3600.0, 2.0, 3.0, 0.5 * math.pi, 0.1, 0.2])
    assert log.inputs.actuation == "wrench"
    assert log.inputs.values[0] == pytest.approx([30.0, 0.0, 0.0, 0.0, 0.0, 4.0])
    assert np.isnan(log.position_ned[:, :2]).all()
    assert (log.position_ned[:, 2] == 3.0).all()
    assert np.linalg.norm(log.quaternion_body_to_ned, axis=1) == pytest.approx(1.0)


def test_commands_of_channels_and_their_units(tmp_path, auv):
    columns = [*MOTION, "command_propeller_rpm", "command_rudder_deg", "command_stern_planes_rad"]
    log = log_of(tmp_path, auv, columns, [[*row, 600.0, 10.0, -0.1] for row in table(MOTION)])
    assert log.inputs.actuation == "thrusters"
    assert log.inputs.values[3] == pytest.approx([20.0 * math.pi, math.radians(10.0), -0.1])


def test_actions_are_shares_of_limits(tmp_path, rov, auv):
    columns = [*MOTION, "action_surge", "action_yaw"]
    log = log_of(tmp_path, rov, columns, [[*row, 0.5, -1.0] for row in table(MOTION)])
    assert log.inputs.values[0] == pytest.approx([56.5, 0.0, 0.0, 0.0, 0.0, -30.2])
    columns = [*MOTION, "action_propeller", "action_rudder", "action_stern_planes"]
    log = log_of(tmp_path, auv, columns, [[*row, -0.5, 1.0, 0.25] for row in table(MOTION)])
    angle = auv.fins[0].limit
    assert log.inputs.values[0] == pytest.approx([-79.85, angle, 0.25 * angle])


def test_the_trajectory_of_a_flight_is_a_log(tmp_path, rov):
    """Its columns as `Episode.columns` names them, actions empty at the last instant."""
    from dq_marine.agents.evaluation.trajectory import VECTOR_COLUMNS, write_columns

    names = [name for part in VECTOR_COLUMNS.values() for name in part]
    columns = {"time_s": 0.1 * np.arange(200)} | {name: np.full(200, 0.1) for name in names}
    columns |= {
        name: np.full(200, 1.0 if name == "q_scalar" else 0.0)
        for name in VECTOR_COLUMNS["quaternion_body_to_ned"]
    }
    columns |= {"heading_deg": np.full(200, 90.0), "action_surge": np.append(np.full(199, 0.5), np.nan)}
    columns |= {
        "reward": np.zeros(200),
        "position_error_m": np.zeros(200),
        "heading_error_deg": np.zeros(200),
    }
    write_columns(columns, tmp_path / "flight.csv")
    log = read_log(tmp_path / "flight.csv", rov)
    assert (log.inputs.values[:-1, 0] == 56.5).all()
    assert (log.quaternion_body_to_ned == [1.0, 0.0, 0.0, 0.0]).all()


def without(name):
    return [column for column in COLUMNS if column != name]


def renamed(name, other):
    return [other if column == name else column for column in COLUMNS]


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without("time_s"), r"no column time_s; add it"),
        (without("u_m_s"), r"no column u_m_s: velocity over ground"),
        (without("pitch_deg"), r"no column pitch_deg; add it, or the attitude as q_scalar"),
        (MOTION, r"no columns of what drove the vehicle; add X_N.*command_bow_starboard"),
        ([*MOTION, "throttle", "helm"], r"series of a manoeuvre: throttle and helm"),
        ([*COLUMNS, "action_surge"], r"twice what drove the vehicle, by X_N and by action_surge"),
        ([*MOTION, "command_bow_port"], r"no column command_bow_starboard.*all channels"),
        (renamed("u_m_s", "u_cm_s"), r"column 'u_cm_s' has an unknown unit; give u_m_s or u_kn"),
        (renamed("u_m_s", "u"), r"column 'u' has no unit; name it u_m_s"),
        (renamed("time_s", "time_min"), r"'time_min' has an unknown unit; give time_s or time_ms"),
        ([*COLUMNS, "u_kn"], r"'u_kn' and 'u_m_s' are both 'u'|'u_m_s' and 'u_kn' are both 'u'"),
        ([*COLUMNS, "down_m"], r"depth_m and down_m, which are the same"),
    ],
)
def test_wrong_columns(tmp_path, rov, columns, message):
    with pytest.raises(InvalidInputError, match=message):
        log_of(tmp_path, rov, columns)


def with_cell(line, name, value):
    rows = table()
    rows[line - 2][COLUMNS.index(name)] = value
    return rows


def scaled(factor, *names):
    return [
        [factor if name in names else cell for name, cell in zip(COLUMNS, row, strict=True)]
        for row in table()
    ]


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (with_cell(7, "u_m_s", "nan"), r"line 7: u_m_s = 'nan' is no finite number; leave the field empty"),
        (with_cell(7, "v_m_s", "inf"), r"line 7: v_m_s = 'inf' is no finite number"),
        (with_cell(9, "w_m_s", "fast"), r"line 9: w_m_s = 'fast' is no finite number"),
        (with_cell(5, "time_s", ""), r"line 5: there is no time"),
        (with_cell(5, "time_s", 0.05), r"line 5: time = 0.05 s after 0.2 s; give rows in the order"),
        (with_cell(5, "time_s", 0.2), r"line 5: time = 0.2 s after 0.2 s; give rows in the order"),
        (
            table()[:50] + [[row[0] + 5.0, *row[1:]] for row in table()[50:]],
            r"line 52: 5.1 s since .* without a gap",
        ),
        (with_cell(5, "X_N", ""), r"line 5: a command is missing"),
        (table(rows=30), r"30 rows; give at least 100"),
        (table(rows=0), r"1 lines; give a header"),
        ([*table(), [1.0, 2.0]], r"line 202, has 2 fields, but the header 17"),
        (scaled(300.0, "u_m_s"), r"one of u, v, w = 300 m/s, beyond 60; check the unit"),
        (scaled(57.0, "q_rad_s"), r"one of p, q, r = 57 rad/s, beyond 20; check the unit"),
        (scaled(400.0, "pitch_deg"), r"pitch_deg reaches 400, more than a full turn; check the unit"),
        (scaled("", "v_m_s"), r"u, v, w is missing in 100 % of the rows"),
    ],
)
def test_wrong_rows(tmp_path, rov, rows, message):
    with pytest.raises(InvalidInputError, match=message):
        log_of(tmp_path, rov, COLUMNS, rows)


def test_files_that_are_none(tmp_path, rov, monkeypatch):
    with pytest.raises(InvalidInputError, match=r"there is no file 'nowhere\.csv'"):
        read_log("nowhere.csv", rov)
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00\x01" * 100)
    with pytest.raises(InvalidInputError, match="cannot be read as CSV"):
        read_log(tmp_path / "binary.csv", rov)
    path = written(tmp_path / "run.csv", table())
    monkeypatch.setattr(log_module, "MOST_ROWS", 150)
    with pytest.raises(InvalidInputError, match=r"200 rows; give at most 150: a part of it"):
        read_log(path, rov)
    monkeypatch.setattr(checks, "LARGEST_FILE", 1000)
    with pytest.raises(InvalidInputError, match=r"bytes; give a file of at most 1,000"):
        read_log(path, rov)


def test_a_quaternion_of_another_length(tmp_path, rov):
    columns = ["time_s", "q_scalar", "q_x", "q_y", "q_z", *COLUMNS[5:]]
    with pytest.raises(InvalidInputError, match=r"line 2: the quaternion has length"):
        log_of(tmp_path, rov, columns)
