"""Every rollout format, read back by a reader that is not ours."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from stairwright.errors import InputError
from stairwright.export.formats import (
    ROLLOUT_FORMATS,
    convert,
    load,
    load_rollout,
    save,
)
from stairwright.robot.description import JOINTS
from stairwright.simulation.result import Rollout
from tests.export.mcap_reading import messages
from tests.scene.example import example_plan, example_rollout


@pytest.fixture(scope="module")
def run() -> Rollout:
    rollout = example_rollout(example_plan(count=30))
    # A tenth of the samples keeps the tests quick.
    thin = {name: values[::10] for name, values in rollout.series}
    return rollout.model_copy(update={"series": type(rollout.series)(**thin)})


def assert_same_series(a: Rollout, b: Rollout) -> None:
    for name, values in a.series:
        np.testing.assert_array_equal(values, getattr(b.series, name), err_msg=name)


def test_json_round_trip(run, tmp_path):
    save(run, tmp_path / "run.json")
    data = json.loads((tmp_path / "run.json").read_text())
    assert data["schema"] == "stairwright/rollout/1"
    assert np.array(data["series"]["contact_force"]).shape == (len(run.series), 4, 2)
    assert_same_series(run, load_rollout(tmp_path / "run.json"))


def test_csv_columns_carry_units_and_exact_numbers(run):
    rows = list(csv.DictReader(io.StringIO(ROLLOUT_FORMATS["csv"].write(run).decode())))
    assert len(rows) == len(run.series)
    for i in (0, 17, -1):
        row, s = rows[i], run.series
        assert float(row["time_s"]) == s.time[i]
        assert float(row["base_z_m"]) == s.base_position[i, 2]
        assert float(row["base_qw"]) == s.base_quaternion[i, 0]
        assert float(row["RL_calf_rad"]) == s.q[i, 7]
        assert float(row["RL_calf_desired_rad"]) == s.q_desired[i, 7]
        assert float(row["RR_wheel_speed_rad_per_s"]) == s.dq[i, 11]
        assert float(row["FR_force_z_N"]) == s.contact_force[i, 1, 1]
    assert run.plan_id in rows[0]["source"]


def test_npz_round_trip_without_the_plan(run, tmp_path):
    save(run, tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz", allow_pickle=False) as file:
        np.testing.assert_array_equal(file["torque"], run.series.torque)
        about = json.loads(str(file["metadata"]))
    assert about["joint_order"] == list(JOINTS)
    assert about["document"]["outcome"] == "success"
    again = load_rollout(tmp_path / "run.npz")
    assert_same_series(run, again)
    assert again.model_dump(exclude={"series", "plan"}) == run.model_dump(
        exclude={"series", "plan"}
    )


def test_mcap_joint_states_and_transforms(run):
    content = ROLLOUT_FORMATS["mcap"].write(run)
    topics = messages(content)
    assert len(topics["/joint_states"]) == len(topics["/tf"]) == len(run.series)
    stamp, state = topics["/joint_states"][40]
    assert stamp == pytest.approx(run.series.time[40], abs=1e-9)
    assert list(state.name) == list(JOINTS)
    np.testing.assert_array_equal(state.position, run.series.q[40])
    np.testing.assert_array_equal(state.effort, run.series.torque[40])
    turn = topics["/tf"][40][1].transforms[0].transform.rotation
    np.testing.assert_array_equal((turn.w, turn.x, turn.y, turn.z), run.series.base_quaternion[40])
    ((_, asked),) = topics["/joint_trajectory"]
    np.testing.assert_array_equal(asked.points[40].positions, run.series.q_desired[40])


def test_mcap_is_read_by_rosbags(run, tmp_path):
    save(run, tmp_path / "run.mcap")
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        chosen = [c for c in reader.connections if c.topic == "/joint_states"]
        states = [reader.deserialize(raw, c.msgtype) for c, _, raw in reader.messages(chosen)]
    np.testing.assert_array_equal([s.velocity for s in states], run.series.dq)


def test_convert_knows_a_rollout_by_its_schema(run, tmp_path):
    save(run, tmp_path / "run.json")
    convert(tmp_path / "run.json", "csv", tmp_path / "run.csv")
    assert (tmp_path / "run.csv").read_bytes() == ROLLOUT_FORMATS["csv"].write(run)
    assert isinstance(load(tmp_path / "run.json"), Rollout)
    with pytest.raises(InputError, match=r"\.html"):
        save(run, tmp_path / "run.mjcf")
