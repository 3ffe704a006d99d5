"""A step that works between one that does not and another that does, found with few questions."""

from __future__ import annotations

from dataclasses import dataclass, field

_DECEPTIONS = 3  # doubts that may turn out wrong


@dataclass
class Bracket:
    """What is known of steps 0, which does not work, to `most`.

    More need not be better. What is looked for is a step that works as the next one does, while the
    one before does not.

    Attributes:
        most: The largest step.
        known: Whether steps work.
        doubted: Steps that seem not to work, but have not been asked about thoroughly.
        misled: How many of them did work; after some all are asked about thoroughly.
        stride: How far down the next step is while none below is known or thought not to work.
    """

    most: int
    known: dict[int, bool] = field(default_factory=lambda: {0: False})
    doubted: set[int] = field(default_factory=set)
    misled: int = 0
    stride: int = 0

    @property
    def high(self) -> int | None:
        """The least step that works while nothing is known against the next one."""
        good = (one for one, works in self.known.items() if works and self.known.get(one + 1, True))
        return min(good, default=None)

    @property
    def low(self) -> int:
        """The largest step below that that does not work, or is doubted."""
        bound = self.most + 1 if self.high is None else self.high
        bad = {one for one, works in self.known.items() if not works} | self.doubted
        return max(one for one in bad if one < bound)

    def tell(self, step: int, works: bool, settled: bool = True) -> None:
        """Learn of a step; what does not work is doubted unless that is `settled`."""
        if not (works or settled):
            self.doubted.add(step)
            return
        if works:
            high = self.high
            if high is None:
                self.stride = max(2, step // 4)
            elif step < high and step in self.doubted:
                self.misled += 1
                self.doubted.clear()
                self.stride = 2  # what is looked for is seldom far below
            elif step < high:
                self.stride *= 2
        self.known[step] = works
        self.doubted.discard(step)

    def settles(self, step: int) -> bool:
        """Whether to ask about a step thoroughly."""
        trusting = self.high is not None and self.misled < _DECEPTIONS
        return not trusting or step in self.doubted

    def next_steps(self) -> tuple[int, ...]:
        """Steps to ask about next; of two the second matters only if the first does not work.

        Returns:
            Nothing once the step is found, or where none up to `most` works.
        """
        high, low = self.high, self.low
        if high is None:
            return (min(2 * low - self._first + 1, self.most),) if low < self.most else ()
        if high == low + 1:
            untold = () if high == self.most or high + 1 in self.known else (high + 1,)
            return (low, *untold) if low in self.doubted else untold
        # Down in strides until one does not work; then rather steps that do: they are told sooner.
        stride = min(self.stride, (high - low + 2) // 3 if low > 0 else high - 1)
        return (high - stride,)

    @property
    def _first(self) -> int:
        """The step that was asked about first: thought to be the one that is looked for."""
        return next(one for one in self.known if one > 0)
