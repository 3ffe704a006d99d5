"""The service does what its OpenAPI document says: schemathesis asks it everything."""

from __future__ import annotations

from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, settings
from schemathesis.checks import CHECKS, load_all_checks
from schemathesis.config import SchemathesisConfig

from tests.conftest import Server


@pytest.fixture(scope="module")
def api_schema(server: Server) -> Any:
    return schemathesis.openapi.from_url(
        f"{server.url}/api/v1/openapi.json", config=SchemathesisConfig.discover()
    )


schema = schemathesis.pytest.from_fixture("api_schema")
load_all_checks()
# What is valid one by one may be refused together: an unknown name, a goal before the start.
CHECKED = [check for check in CHECKS.get_all() if check.__name__ != "positive_data_acceptance"]


@pytest.mark.slow
@schema.parametrize()
@settings(
    max_examples=50,
    deadline=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)
def test_every_operation(case: Any) -> None:
    response = case.call(timeout=120)
    assert response.status_code < 500, response.text
    case.validate_response(response, checks=CHECKED)
