// The Python module stairwright._core: one bind_* function a family.
#include "bindings.hpp"

namespace nb = nanobind;

NB_MODULE(_core, m) {
    using namespace stairwright::python;
    // Objects that live as long as the process (caches) are no leaks.
    nb::set_leak_warnings(false);
    m.doc() = "Stairwright's native core; see native/include/stairwright for what it is made of.";
    bind_robot(m);
    bind_terrain(m);
    bind_statics(m);
    bind_smoothing(m);
    bind_poses(m);
    bind_control(m);
    bind_estimation(m);
    bind_timing(m);
    bind_rollout(m);
    bind_player(m);
    bind_lattice(m);
    bind_lattice_sweeps(m);
    bind_lattice_tables(m);
    bind_certificate(m);
}
