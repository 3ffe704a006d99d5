"""Terrains: the presets."""

from __future__ import annotations

from fastapi import APIRouter

from stairwright.api.bodies import TerrainDocument
from stairwright.api.problems import describe, not_found
from stairwright.library import load_terrain, terrains

router = APIRouter(prefix="/terrains", tags=["terrains"])


@router.get("")
def list_terrains() -> list[TerrainDocument]:
    """All terrains: presets first."""
    return [_preset(name) for name in terrains()]


@router.get("/{name}", responses=describe(404))
def get_terrain(name: str) -> TerrainDocument:
    """One terrain."""
    if name not in terrains():
        raise not_found("terrain", name)
    return _preset(name)


def _preset(name: str) -> TerrainDocument:
    return TerrainDocument(**load_terrain(name).model_dump(), readonly=True)
