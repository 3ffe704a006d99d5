// A row of the lattice as a bitset: a bit tells whether its column is possible.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace stairwright::lattice {

using Bits = std::uint64_t;

inline constexpr int kWord = 64;  // columns of one bitset

// A bitset whose bit k is bit k + by of `bits`, 0 where that has none.
constexpr Bits shifted(Bits bits, int by) {
    if (by >= kWord || by <= -kWord) return 0;
    return by >= 0 ? bits >> by : bits << -by;
}

// A bitset with bits `low` to `high` (excluded, less than kWord) set.
constexpr Bits between(int low, int high) { return (Bits{1} << high) - (Bits{1} << low); }

// A bitset of the columns x < `columns` with flag(x), tested in groups of eight: up to seven more are asked for.
template <typename Flag>
Bits packed(int columns, Flag flag) {
    static_assert(std::endian::native == std::endian::little);
    std::array<std::uint8_t, kWord> flags;
    const int groups = (columns + 7) / 8;
    for (int x = 0; x < 8 * groups; ++x) flags[x] = flag(x);
    Bits out = 0;
    for (int g = 0; g < groups; ++g) {
        std::uint64_t eight;
        std::memcpy(&eight, flags.data() + 8 * g, 8);
        // Byte k, 0 or 1, times 2^(56 - 7 k) comes to lie in bit k of the highest byte.
        out |= ((eight * 0x0102040810204080ULL) >> 56) << (8 * g);
    }
    return out;
}

// Calls visit(k) for every bit k that is set, lowest first.
template <typename Visit>
constexpr void for_each_bit(Bits bits, Visit visit) {
    for (; bits != 0; bits &= bits - 1) visit(std::countr_zero(bits));
}

}  // namespace stairwright::lattice
