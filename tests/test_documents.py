"""Documents: records of values."""

from __future__ import annotations

import pickle

from stairwright.planning.plan import Margins


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
