"""Documents: records of values."""

from __future__ import annotations

import copy
import json
import pickle

import pytest

from stairwright.documents import Deferred, Model
from stairwright.planning import plan as planning
from stairwright.planning.plan import Margins, Plan, Pose
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


@pytest.fixture(scope="module")
def whole() -> Plan:
    """A path whose poses have been made."""
    made = plan("curb-015")
    assert made.poses
    return made


@pytest.fixture
def unread(whole: Plan) -> tuple[Plan, list[object]]:
    """The same plan with poses that nobody has asked for, and an entry for each time they are."""
    times: list[object] = []

    def make() -> list[Pose]:
        times.append(None)
        return list(whole.poses)

    return whole.model_copy(update={"poses": Deferred(make)}), times


class Holder(Model):
    """A document within which a plan is."""

    plan: Plan


def test_poses_of_a_path_are_not_made_before_they_are_needed():
    made = plan("curb-015")
    assert isinstance(made.__dict__["poses"], Deferred)
    assert made.binding is not None
    assert made.timing.total > 0.0
    assert made.critical[-1] == len(made.poses) - 1
    assert isinstance(made.__dict__["poses"], list)


@pytest.mark.parametrize(
    "use",
    [
        lambda plan: plan.poses,
        lambda plan: Plan.model_validate(plan.model_dump()).poses,
        lambda plan: Plan.model_validate_json(plan.model_dump_json()).poses,
        lambda plan: (
            Holder.model_validate(
                json.loads(Holder.model_construct(plan=plan).model_dump_json())
            ).plan.poses
        ),
        lambda plan: pickle.loads(pickle.dumps(plan.__dict__["poses"])),
        lambda plan: copy.deepcopy(plan.__dict__["poses"]),
        lambda plan: plan.model_copy(update={"id": "p-1"}).poses,
        lambda plan: dict(plan)["poses"],
        lambda plan: eval(repr(plan.__dict__["poses"]), vars(planning)),
    ],
)
def test_a_deferred_field_is_the_same_however_it_is_read(whole, unread, use):
    deferred, times = unread
    found = use(deferred)
    assert type(found) is list
    assert found == whole.poses
    assert len(times) == 1
    use(deferred)
    assert len(times) == 1


def test_a_deferred_field_takes_part_in_comparing(whole, unread):
    deferred, _ = unread
    assert deferred == whole
    assert whole == whole.model_copy(update={"poses": Deferred(lambda: list(whole.poses))})
    assert whole != whole.model_copy(update={"poses": Deferred(lambda: whole.poses[1:])})


def test_a_deferred_field_can_be_excluded(unread):
    deferred, times = unread
    assert "poses" not in deferred.model_dump(mode="json", exclude={"poses"})
    assert not times
