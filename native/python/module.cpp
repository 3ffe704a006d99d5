// The Python module stairwright._core: one bind_* function a family.
#include "bindings.hpp"

NB_MODULE(_core, m) {
    using namespace stairwright::python;
    m.doc() = "Stairwright's native core; see native/include/stairwright for what it is made of.";
    bind_robot(m);
    bind_terrain(m);
    bind_statics(m);
    bind_smoothing(m);
}
