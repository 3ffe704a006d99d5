"""Documents: records of values."""

from __future__ import annotations

import pickle

import pytest

from stairwright.planning.plan import Margins, Pose
from stairwright.planning.planner import plan


def test_a_trusted_record_is_the_one_that_validation_makes() -> None:
    values = {"clearance": 0.01, "com": 0.02, "friction": 0.1, "torque": 3.0}
    checked, trusted = Margins(**values), Margins.trusted(**values)
    assert trusted == checked
    assert hash(trusted) == hash(checked)
    assert trusted.model_dump_json() == checked.model_dump_json()
    assert trusted.model_fields_set == checked.model_fields_set
    assert pickle.loads(pickle.dumps(trusted)) == checked
    assert trusted.model_copy(update={"com": 0.5}).com == 0.5
    assert trusted.com == 0.02


@pytest.mark.parametrize("method", ["path", "critical"])
def test_poses_have_all_fields_in_their_order(method):
    for pose in plan("curb-015", method=method).poses:
        assert list(pose.__dict__) == list(Pose.model_fields)
        assert list(pose.margins.__dict__) == list(Margins.model_fields)
        assert Pose.model_validate(pose.model_dump()) == pose
