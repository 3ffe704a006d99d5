"""What terrains and robots have in common: presets, and documents saved under their names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar
from urllib.parse import quote

from fastapi import Request, Response

from stairwright.api.problems import Problem, not_found
from stairwright.api.responses import model_json, models_json
from stairwright.api.services import Services
from stairwright.documents import Model
from stairwright.errors import InputError
from stairwright.robot.description import Robot
from stairwright.storage.saved import Saved
from stairwright.terrain.profile import Terrain

D = TypeVar("D", Terrain, Robot)
MOST_SAVED = 10_000


@dataclass(frozen=True)
class Named(Generic[D]):
    """Documents of one kind by name.

    Attributes:
        kind: What one of them is called.
        presets: Names of those that come along, which nobody overwrites.
        load: One of the presets.
        saved: Those that were saved.
        shown: One of them as the API shows it, and whether it is read-only.
    """

    kind: str
    presets: Callable[[], Sequence[str]]
    load: Callable[[str], D]
    saved: Callable[[Services], Saved[D]]
    shown: Callable[[D, bool], Model]

    def listing(self, request: Request, services: Services, limit: int, offset: int) -> Response:
        """Presets first, then saved ones by name."""
        shown = [self.shown(self.load(name), True) for name in self.presets()]
        shown += [self.shown(each, False) for each in self.saved(services).all()]
        page = shown[offset : offset + limit]
        return models_json(request, page, total=len(shown), limit=limit, offset=offset)

    def find(self, services: Services, name: str) -> D:
        """One of them.

        Raises:
            Problem: 404 if there is none of that name.
        """
        if name in self.presets():
            return self.load(name)
        saved = self.saved(services).get(name)
        if saved is None:
            raise not_found(self.kind, name, by="name")
        return saved

    def get(self, request: Request, services: Services, name: str) -> Response:
        """One of them, shown."""
        found = self.find(services, name)
        return model_json(request, self.shown(found, name in self.presets()))

    def put(
        self, request: Request, services: Services, name: str, said: str, document: D
    ) -> Response:
        """Save one under the address's `name`, the body having `said` its own.

        Raises:
            Problem: 403 for a preset's name, 409 if no more can be saved.
            InputError: If the names differ.
        """
        self._refuse_preset(name, "save under another name")
        if said != name:
            raise InputError(f"the body says {said!r}, the address {name!r}", ("name",))
        saved = self.saved(services)
        if saved.count() >= MOST_SAVED:
            raise Problem(409, f"{MOST_SAVED} {self.kind}s are saved already", kind="full")
        new = saved.put(document)
        headers = {"location": quote(request.url.path)} if new else None
        return model_json(request, self.shown(document, False), 201 if new else 200, headers)

    def delete(self, services: Services, name: str) -> None:
        """Remove a saved one.

        Raises:
            Problem: 403 for a preset's name, 404 if there is none.
        """
        self._refuse_preset(name, "presets cannot be deleted")
        if not self.saved(services).delete(name):
            raise not_found(self.kind, name, by="name")

    def _refuse_preset(self, name: str, advice: str) -> None:
        if name in self.presets():
            raise Problem(403, f"{name!r} is a preset: {advice}", kind="read-only")
