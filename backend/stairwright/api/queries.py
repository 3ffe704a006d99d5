"""Query parameters that no route knows are refused: a misspelt one would be ignored in silence."""

from __future__ import annotations

from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute
from starlette.requests import HTTPConnection

from .problems import MAX_ERRORS, FieldError, Problem, printable


async def known_query(connection: HTTPConnection) -> None:
    """Let a request pass whose route knows all of its parameters.

    Raises:
        Problem: 422 that names the unknown ones and says which there are.
    """
    route = connection.scope.get("route")
    if not connection.scope["query_string"] or not isinstance(route, APIRoute):
        return
    known = sorted(_parameters(route.dependant))
    unknown = [name for name in connection.query_params if name not in known]
    if not unknown:
        return
    there_are = f"there are: {', '.join(known)}" if known else "there are none here"
    message = f"there is no such parameter; {there_are}"
    errors = [FieldError(field=printable(name), message=message) for name in unknown[:MAX_ERRORS]]
    more = f" (and {len(unknown) - 1} more)" if len(unknown) > 1 else ""
    raise Problem(422, f"{errors[0].field}: {message}{more}", kind="bad-input", errors=errors)


def _parameters(dependant: Dependant) -> set[str]:
    names = {field.alias for field in dependant.query_params}
    return names.union(*map(_parameters, dependant.dependencies))
