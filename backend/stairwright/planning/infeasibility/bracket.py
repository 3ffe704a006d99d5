"""A step that works between one that does not and another that does, found with few questions."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass
class Bracket:
    """What is known of steps 0, which does not work, to `most`.

    More need not be better. What is looked for is a step that works as the next one does, while the
    one before does not.
    """

    most: int
    known: dict[int, bool] = field(default_factory=lambda: {0: False})

    @property
    def high(self) -> int | None:
        """The least step that works while nothing is known against the next one."""
        good = (one for one, works in self.known.items() if works and self.known.get(one + 1, True))
        return min(good, default=None)

    @property
    def low(self) -> int:
        """The largest step below that that does not work."""
        bound = self.most + 1 if self.high is None else self.high
        return max(one for one, works in self.known.items() if one < bound and not works)

    def next_steps(self) -> tuple[int, ...]:
        """Steps to ask about next; of two the second matters only if the first does not work.

        Returns:
            Nothing once the step is found, or where none up to `most` works.
        """
        high, low = self.high, self.low
        if high is None:
            return (min(2 * low - self._first + 1, self.most),) if low < self.most else ()
        if high == low + 1:
            return () if self._told(high + 1) else (high + 1,)
        if low > 0:  # what does not work takes long to tell: rather one that works
            step = high - (high - low + 2) // 3
        elif high == self._first:
            step = high - 1
        else:  # in strides that double, but not past half of the way
            step = max(2 * high - self._first, high // 2)
        step = min(max(step, low + 1), high - 1)
        return (step,) if step < high - 1 or self._told(high + 1) else (step, high + 1)

    @property
    def _first(self) -> int:
        """The step that was asked about first: thought to be the one that is looked for."""
        return next(one for one in self.known if one > 0)

    def _told(self, step: int) -> bool:
        return step > self.most or step in self.known
