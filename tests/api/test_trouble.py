"""What is tried again and again is told when it begins to fail, and when it works again."""

import logging

import pytest

from stairwright.api.trouble import Trouble


def test_the_same_failure_is_told_once_whatever_file_it_names(
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.INFO)
    trouble = Trouble(logging.getLogger("tests.trouble"), "keeping")
    for name in ("a.partial", "b.partial"):
        trouble.failed(PermissionError(13, "Permission denied", name))
    trouble.failed(OSError(28, "No space left on device", "b.partial"))
    trouble.worked()
    trouble.worked()
    assert [record.levelname for record in caplog.records] == ["ERROR", "ERROR", "INFO"]
