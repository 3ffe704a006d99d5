// What the module is made of: each function lies in a file of its own.
#pragma once

#include <nanobind/nanobind.h>

namespace stairwright::python {

void bind_robot(nanobind::module_& m);
void bind_terrain(nanobind::module_& m);
void bind_statics(nanobind::module_& m);
void bind_smoothing(nanobind::module_& m);
void bind_poses(nanobind::module_& m);
void bind_control(nanobind::module_& m);
void bind_estimation(nanobind::module_& m);
void bind_timing(nanobind::module_& m);
void bind_rollout(nanobind::module_& m);
void bind_player(nanobind::module_& m);
void bind_lattice(nanobind::module_& m);
void bind_lattice_sweeps(nanobind::module_& m);
void bind_lattice_tables(nanobind::module_& m);
void bind_certificate(nanobind::module_& m);

}  // namespace stairwright::python
