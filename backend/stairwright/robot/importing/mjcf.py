"""MJCF: what a robot is made of, without what opens files, runs code or multiplies bodies."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import PurePosixPath

from stairwright.errors import InputError

from .upload import Upload
from .xml import parse

_MULTIPLIES = ("replicate", "composite", "flexcomp", "flex", "attach", "model")
_REFUSED = (*_MULTIPLIES, "plugin", "extension")
_KEPT = (
    "compiler", "default", "asset", "worldbody", "actuator", "equality", "keyframe", "tendon",
    "option", "contact",
)  # fmt: skip
_ASSETS = ("mesh",)
_DEFAULTS = (
    "default", "joint", "geom", "mesh", "general", "motor", "position", "velocity", "intvelocity",
    "damper", "cylinder", "muscle", "adhesion", "tendon", "equality",
)  # fmt: skip
_BODY = ("body", "frame", "joint", "freejoint", "geom", "inertial", "site")
_DEEPEST_INCLUDE = 5


def clean(root: ET.Element, upload: Upload) -> str:
    """The file with its includes put in, bodies, joints, shapes and motors only.

    Raises:
        InputError: If it includes what was not sent, or uses what could take for ever.
    """
    _include(root, upload, {upload.name}, 0)
    for element in root.iter():
        if element.tag in _REFUSED:
            raise InputError(f"<{element.tag}> is not accepted in an upload", ("file",))
    for section in list(root):
        if section.tag not in _KEPT:
            root.remove(section)
        elif section.tag == "asset":
            _keep(section, _ASSETS)
        elif section.tag == "default":
            _clean_defaults(section)
        elif section.tag == "compiler":
            section.set("fusestatic", "false")
            for name in ("discardvisual", "savecompiled", "plugindir"):
                section.attrib.pop(name, None)
    for body in [*root.iter("worldbody"), *root.iter("body"), *root.iter("frame")]:
        _keep(body, _BODY)
    for geom in root.iter("geom"):
        for look in ("material",):
            geom.attrib.pop(look, None)
    return ET.tostring(root, encoding="unicode")


def _clean_defaults(element: ET.Element) -> None:
    _keep(element, _DEFAULTS)
    for inner in element.findall("default"):
        _clean_defaults(inner)
    for tendon in element.findall("tendon"):
        tendon.attrib.pop("material", None)


def _keep(element: ET.Element, tags: tuple[str, ...]) -> None:
    for part in list(element):
        if part.tag not in tags:
            element.remove(part)


def _include(element: ET.Element, upload: Upload, seen: set[str], depth: int) -> None:
    """Put the children of included files in the place of <include>, as MuJoCo does."""
    for k, part in reversed(list(enumerate(element))):
        if part.tag != "include":
            _include(part, upload, seen, depth)
            continue
        reference = part.get("file") or ""
        path = PurePosixPath(reference.replace("\\", "/"))
        name = None if path.is_absolute() or ".." in path.parts else upload.find(reference)
        if name is None or PurePosixPath(name).name.lower() != path.name.lower():
            raise InputError(f"<include file={reference!r}>: that file was not sent", ("file",))
        if name in seen or depth >= _DEEPEST_INCLUDE:
            raise InputError(f"<include file={reference!r}>: included again", ("file",))
        seen.add(name)
        root = parse(upload.files[name], name)
        _include(root, upload, seen, depth + 1)
        element.remove(part)
        for child in reversed(list(root)):
            element.insert(k, child)
