"""XML from outside: read only if it is small, shallow and without entities."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from xml.parsers import expat

from stairwright.errors import InputError

from .upload import MOST_XML

_MOST_ELEMENTS = 20_000
_DEEPEST = 60
_LONGEST = 2**20  # characters of one attribute
# Blank lines before the declaration are no XML, but MuJoCo and ROS read them, and some files begin
# so. It only tells the encoding, which is known by then.
_LATE_DECLARATION = re.compile(rb"\A\s+<\?xml\s[^>]*\?>")


def parse(content: bytes, name: str, most: int = MOST_XML) -> ET.Element:
    """The root element of an XML file.

    Raises:
        InputError: If it is no XML, too large or too deep, or declares a document type.
    """
    if len(content) > most:
        raise InputError(f"{name} is larger than {most >> 20} MiB", ("file",))
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{name} is not UTF-8 text", ("file",)) from None
    content = _LATE_DECLARATION.sub(lambda found: b"\n" * found[0].count(b"\n"), content)
    _screen(content, name)
    return ET.fromstring(content)  # noqa: S314 - screened: it has no entities


def _screen(content: bytes, name: str) -> None:
    """Refuse before a tree is built what would make it large."""
    parser = expat.ParserCreate("utf-8")
    depth = count = 0

    def refuse(what: str) -> None:
        raise InputError(f"{name}, line {parser.CurrentLineNumber}: {what}", ("file",))

    def start(_: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > _DEEPEST:
            refuse(f"nested deeper than {_DEEPEST} levels")
        if count > _MOST_ELEMENTS:
            refuse(f"more than {_MOST_ELEMENTS:,} elements")
        if any(len(value) > _LONGEST for value in attributes.values()):
            refuse("an attribute is too long")

    def end(_: str) -> None:
        nonlocal depth
        depth -= 1

    def doctype(*_: object) -> None:
        refuse("document types and entities are not accepted")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = doctype
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        reason = expat.errors.messages[error.code]
        raise InputError(f"{name} is no XML: line {error.lineno}: {reason}", ("file",)) from None
