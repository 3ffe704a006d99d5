"""Nodes that stand still: kept by name and layer, replaced or moved in place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stairwright.arrays import Floats

from . import shapes
from .palette import Rgb


class Nodes:
    """The scene's standing nodes. `layers` is shared with whoever shows and hides them."""

    def __init__(self, scene: Any, layers: Mapping[str, bool]) -> None:
        self._scene, self._layers = scene, layers
        self._handles: dict[str, tuple[str, Any]] = {}  # node -> (layer, handle)

    def show(self) -> None:
        """Follow the layers."""
        for layer, handle in self._handles.values():
            handle.visible = self._layers[layer]

    def keep(self, layer: str, node: str, handle: Any) -> None:
        """Remember a node that was added to the scene."""
        self._handles[node] = (layer, handle)

    def drop(self, layer: str) -> None:
        """Remove all nodes of a layer."""
        for node in [n for n, (of, _) in self._handles.items() if of == layer]:
            self._handles.pop(node)[1].remove()

    def mesh(
        self,
        layer: str,
        node: str,
        mesh: shapes.Mesh,
        colour: Rgb,
        flat: bool = False,
    ) -> None:
        """A plain mesh; one with the same faces as before moves in place, which costs far less."""
        handle = self._handles[node][1] if node in self._handles else None
        if handle is not None and np.array_equal(handle.faces, mesh.faces):
            handle.vertices = mesh.vertices.astype(np.float32)
            handle.color = colour
            return
        handle = self._scene.add_mesh_simple(
            node,
            mesh.vertices,
            mesh.faces,
            color=colour,
            flat_shading=flat,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
            visible=self._layers[layer],
        )
        self.keep(layer, node, handle)

    def lines(
        self,
        layer: str,
        node: str,
        segments: Floats,
        colour: Rgb,
        pixels: float,
    ) -> None:
        """Line segments (n, 2, 3) of one colour, `pixels` wide."""
        if len(segments) == 0:
            segments = np.zeros((1, 2, 3))
        if node in self._handles:
            handle = self._handles[node][1]
            handle.points = segments.astype(np.float32)
            handle.colors = np.array(colour, np.uint8)
            return
        handle = self._scene.add_line_segments(
            node,
            segments.astype(np.float32),
            colour,
            thickness=pixels,
            thickness_units="screen",
            visible=self._layers[layer],
        )
        self.keep(layer, node, handle)
