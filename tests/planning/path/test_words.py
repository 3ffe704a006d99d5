"""Rows of the lattice as words."""

import numpy as np

from stairwright.planning.path.tables import INF, bits
from stairwright.planning.path.words import WORD, between, lowest, shifted


def test_words_tell_what_is_possible():
    rng = np.random.default_rng(5)
    row = np.where(rng.uniform(size=WORD) < 0.5, INF, 0.25).astype(np.float32)
    word = np.uint64(bits(row))
    for by in (-200, -64, -63, -5, 0, 1, 40, 63, 64, 1000):
        moved = int(shifted(word, by))
        for k in range(WORD):
            inside = 0 <= k + by < WORD
            assert bool(moved >> k & 1) == (inside and row[k + by] < INF)


def test_the_bits_between_two_places_one_after_the_other():
    for low, high in ((0, 0), (0, 1), (3, 9), (0, WORD - 1), (62, 63)):
        word, found = between(low, high), []
        while word != 0:
            found.append(int(lowest(word)))
            word = np.uint64(int(word) & (int(word) - 1))
        assert found == list(range(low, high))
    assert lowest(np.uint64(1 << 63)) == 63
