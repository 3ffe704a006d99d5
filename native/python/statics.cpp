#include "stairwright/statics.hpp"

#include <nanobind/stl/pair.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/resting_forces.hpp"
#include "stairwright/wheel_contacts.hpp"

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

std::array<Contact, 2> two_contacts(const Points& at, const Points& normals) {
    const std::vector<Contact> both = contacts(at, normals, 0.0);
    if (both.size() != 2) throw nb::value_error("two contacts, please");
    return {both[0], both[1]};
}

auto given(const std::array<ContactForce, 2>& forces) {
    return give(std::vector<double>{forces[0].tangential, forces[0].normal, forces[1].tangential, forces[1].normal}, {2, 2});
}

}  // namespace

void bind_statics(nb::module_& m) {
    m.def("com_interval", [](const Points& at, const Points& normals, double friction, double limit) {
        const Interval found = com_interval(contacts(at, normals, friction), limit);
        return std::pair(found.lower, found.upper);
    }, nb::arg("points"), nb::arg("normals"), nb::arg("friction"), nb::arg("limit") = kRayLimit);
    m.attr("GRAVITY") = kGravity;
    m.attr("RAY_LIMIT") = kRayLimit;
    m.attr("NOTHING_HOLDS") = kNothingHolds;
    m.def("com_margin", [](std::pair<double, double> interval, double com_x) {
        return com_margin({interval.first, interval.second}, com_x);
    }, nb::arg("interval"), nb::arg("com_x"));
    m.def("least_friction", [](const Points& at, const Points& normals, double com_x, double ample) {
        std::array<ContactForce, 2> forces;
        const double needed = least_friction(two_contacts(at, normals), com_x, ample, forces);
        return std::pair(needed, given(forces));
    }, nb::arg("points"), nb::arg("normals"), nb::arg("com_x"), nb::arg("ample") = 0.0,
       "Friction needed, and forces (2, 2): tangential and normal of either contact, in weights.");
    m.def("held_within", [](const Points& at, const Points& normals, double com_x, double ample) {
        std::array<ContactForce, 2> forces;
        const bool held = held_within(two_contacts(at, normals), com_x, ample, forces);
        return std::pair(held, given(forces));
    }, nb::arg("points"), nb::arg("normals"), nb::arg("com_x"), nb::arg("ample"),
       "Whether so much friction holds the CoM, and the forces (2, 2) of `least_friction` where it does.");
    m.def("friction_needed", [](const Points& at, const Points& normals, double com_x) {
        return friction_needed(contacts(at, normals, 0.0), com_x);
    });
    m.def("pair_interval", [](const WheelPath& path, double front, double rear, double friction, double ray_limit) {
        const Interval found = pair_interval(path, {front, rear}, friction, ray_limit);
        return std::pair(found.lower, found.upper);
    }, nb::arg("path"), nb::arg("front"), nb::arg("rear"), nb::arg("friction"), nb::arg("ray_limit") = kRayLimit);
    m.def("steady_interval", [](const WheelPath& path, double front, double rear, double friction) {
        const Interval found = steady_interval(path, {front, rear}, friction);
        return std::pair(found.lower, found.upper);
    }, nb::arg("path"), nb::arg("front"), nb::arg("rear"), nb::arg("friction"));
    m.def("com_intervals", [](const WheelPath& path, const In<double, nb::shape<-1, 2>>& s, double friction) {
        std::vector<double> out;
        for (std::size_t k = 0; k < s.shape(0); ++k) {
            const Interval found = stated_interval(path, {s(k, 0), s(k, 1)}, friction);
            out.insert(out.end(), {found.lower, found.upper});
        }
        return give(std::move(out), {s.shape(0), 2});
    }, nb::arg("path"), nb::arg("wheels"), nb::arg("friction"),
       "Least and largest x (n, 2) of the CoM with the wheels at arc lengths (n, 2) [m]; none where the first is larger.");
    m.def("resting_forces", [](const Vector& com_x, const In<double, nb::shape<-1, 2, 2>>& at, const In<double, nb::shape<-1, 2, 2>>& normals) {
        if (at.shape(0) != com_x.size() || normals.shape(0) != com_x.size()) throw nb::value_error("as many contacts as mass centres, please");
        std::vector<double> out;
        for (std::size_t k = 0; k < com_x.size(); ++k) {
            std::array<Contact, 2> pair;
            for (std::size_t w = 0; w < 2; ++w) pair[w] = {{at(k, w, 0), at(k, w, 1)}, {normals(k, w, 0), normals(k, w, 1)}, 0.0};
            for (const ContactForce& f : resting_forces(pair, com_x(k))) out.insert(out.end(), {f.tangential, f.normal});
        }
        return give(std::move(out), {com_x.size(), 2, 2});
    }, nb::arg("com_x"), nb::arg("contacts"), nb::arg("normals"),
       "Forces (n, 2, 2) in robot weights with the least friction need: wheel pair, then (tangential, normal).");
}

}  // namespace stairwright::python
