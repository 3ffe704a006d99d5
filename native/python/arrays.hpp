// NumPy arrays at the border between Python and the core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <span>
#include <vector>

#include "stairwright/vec2.hpp"

namespace stairwright::python {

namespace nb = nanobind;

template <typename T, typename... Shape>
using In = nb::ndarray<const T, nb::c_contig, nb::device::cpu, Shape...>;
template <typename T, typename... Shape>
using InOut = nb::ndarray<T, nb::c_contig, nb::device::cpu, Shape...>;
using Vector = In<double, nb::ndim<1>>;
using Points = In<double, nb::shape<-1, 2>>;

template <typename T>
std::span<const T> view(const nb::ndarray<const T, nb::c_contig, nb::device::cpu, nb::ndim<1>>& a) {
    return {a.data(), a.size()};
}

inline std::vector<Vec2> points(const Points& a) {
    std::vector<Vec2> out(a.shape(0));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {a(i, 0), a(i, 1)};
    return out;
}

// An array that owns what a vector held: no copy.
template <typename T>
nb::ndarray<nb::numpy, T> give(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
    auto owned = std::make_unique<std::vector<T>>(std::move(values));
    T* data = owned->data();
    nb::capsule owner(owned.release(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return {data, shape, owner};
}

template <typename T>
nb::ndarray<nb::numpy, T> give(std::vector<T>&& values) {
    const std::size_t n = values.size();
    return give(std::move(values), {n});
}

}  // namespace stairwright::python
