"""The service does what its OpenAPI document says: schemathesis asks it everything."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings

from tests.conftest import Server

if TYPE_CHECKING:
    import schemathesis

EXAMPLES = 2  # of each kind, valid and invalid, for each of some fifty operations


def ask(operation: Any, mode: schemathesis.GenerationMode, checks: list[Any]) -> None:
    """Generated requests to one operation; each answer must keep the document."""

    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy(generation_mode=mode))
    def one(case: Any) -> None:
        response = case.call(timeout=120)
        assert response.status_code < 500, f"{case.as_curl_command()}\n{response.text[:500]}"
        case.validate_response(response, checks=checks)

    one()


@pytest.mark.slow
def test_every_operation_with_good_and_bad_requests(server: Server) -> None:
    import schemathesis
    from schemathesis.checks import CHECKS, load_all_checks

    load_all_checks()
    # Values that are fine one by one may be refused together: an unknown name, a goal before the
    # start, two sources of a plan.
    checks = [each for each in CHECKS.get_all() if each.__name__ != "positive_data_acceptance"]
    schema = schemathesis.openapi.from_url(f"{server.url}/api/v1/openapi.json")
    operations = [result.ok() for result in schema.get_all_operations()]
    assert len(operations) >= 25
    for operation in operations:
        ask(operation, schemathesis.GenerationMode.POSITIVE, checks)
        if any((operation.body, operation.query, operation.path_parameters, operation.headers)):
            ask(operation, schemathesis.GenerationMode.NEGATIVE, checks)
