#include "stairwright/statics.hpp"

#include <nanobind/stl/pair.h>

#include "arrays.hpp"
#include "bindings.hpp"

namespace stairwright::python {

namespace {

std::vector<Contact> contacts(const Points& at, const Points& normals, double friction) {
    if (at.shape(0) != normals.shape(0) || at.shape(0) > kMostContacts)
        throw nb::value_error("points and normals must be as many, and at most six");
    std::vector<Contact> out(at.shape(0));
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = {{at(i, 0), at(i, 1)}, {normals(i, 0), normals(i, 1)}, friction};
    return out;
}

}  // namespace

void bind_statics(nb::module_& m) {
    m.def("com_interval", [](const Points& at, const Points& normals, double friction, double limit) {
        const Interval found = com_interval(contacts(at, normals, friction), limit);
        return std::pair(found.lower, found.upper);
    }, nb::arg("points"), nb::arg("normals"), nb::arg("friction"), nb::arg("limit") = kRayLimit);
    m.def("friction_needed", [](const Points& at, const Points& normals, double com_x) {
        return friction_needed(contacts(at, normals, 0.0), com_x);
    });
}

}  // namespace stairwright::python
