"""Errors that a user can cause. Everything else that escapes is a bug."""

from __future__ import annotations


class StairwrightError(Exception):
    """Base of every error raised on purpose."""


class InputError(StairwrightError, ValueError):
    """Bad input: says what is wrong, where, and what would be right.

    Args:
        message: One sentence for the person who wrote the input.
        field: Path to the offending value, e.g. ``("points", 3)``.
    """

    def __init__(self, message: str, field: tuple[str | int, ...] = ()) -> None:
        super().__init__(message)
        self.message = message
        self.field = field

    @property
    def path(self) -> str:
        """The field path as one dotted string, e.g. ``points.3``."""
        return ".".join(str(part) for part in self.field)

    def within(self, *prefix: str | int) -> InputError:
        """The same error, seen from a document that contains this one under `prefix`."""
        return InputError(self.message, (*prefix, *self.field))

    def __str__(self) -> str:
        return f"{self.path}: {self.message}" if self.field else self.message


class Cancelled(StairwrightError):
    """Work was stopped because its caller asked for it."""
