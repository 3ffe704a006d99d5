#include <algorithm>
#include <bit>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/timing/dynamic_limits.hpp"
#include "stairwright/timing/time_optimal.hpp"

namespace stairwright::python {

namespace {

using PlannedRows = In<double, nb::shape<-1, static_cast<nb::ssize_t>(control::kPlannedWidth)>>;

control::Planned planned(const PlannedRows& rows, std::size_t k) {
    std::array<double, control::kPlannedWidth> numbers;
    std::copy_n(rows.data() + k * control::kPlannedWidth, control::kPlannedWidth, numbers.begin());
    return std::bit_cast<control::Planned>(numbers);
}

// Rows (n, k, 3), as many limits at each place as at the one with most: (0, 0, 1) fills up.
nb::ndarray<nb::numpy, double> table(const std::vector<std::vector<timing::Limit>>& limits) {
    std::size_t most = 0;
    for (const auto& each : limits) most = std::max(most, each.size());
    std::vector<double> out;
    out.reserve(limits.size() * most * 3);
    for (const auto& each : limits)
        for (std::size_t j = 0; j < most; ++j) {
            const timing::Limit limit = j < each.size() ? each[j] : timing::Limit{0.0, 0.0, 1.0};
            out.insert(out.end(), {limit.a, limit.b, limit.c});
        }
    return give(std::move(out), {limits.size(), most, 3});
}

std::pair<nb::ndarray<nb::numpy, double>, nb::ndarray<nb::numpy, double>> dynamic_limits_along(const Robot& robot, const WheelPath& path, double friction, const PlannedRows& values,
                               const PlannedRows& first, const PlannedRows& second, const timing::Reserve& reserve) {
    const std::size_t n = values.shape(0);
    if (first.shape(0) != n || second.shape(0) != n) throw nb::value_error("values and derivatives need as many rows");
    std::vector<std::vector<timing::Limit>> balance(n), torque(n);
    {
        nb::gil_scoped_release release;
        for (std::size_t k = 0; k < n; ++k) {
            const timing::PathPoint point = {planned(values, k), planned(first, k), planned(second, k)};
            timing::DynamicLimits limits = timing::dynamic_limits(robot, path, friction, point, reserve);
            balance[k] = std::move(limits.balance), torque[k] = std::move(limits.torque);
        }
    }
    return {table(balance), table(torque)};
}

}  // namespace

void bind_timing(nb::module_& m) {
    m.def("dynamic_limits", [](const Robot& robot, const WheelPath& path, double friction, const PlannedRows& values,
                               const PlannedRows& first, const PlannedRows& second, double friction_share, double torque_share,
                               double sway, double com) {
        return dynamic_limits_along(robot, path, friction, values, first, second, {friction_share, torque_share, sway, com});
    }, nb::arg("robot"), nb::arg("path"), nb::arg("friction"), nb::arg("values"), nb::arg("first"), nb::arg("second"),
       nb::arg("friction_share"), nb::arg("torque_share"), nb::arg("sway"), nb::arg("com"),
       "Rows (n, k, 3) of balance and of motor torques for planned values (n, 11) and derivatives by the way: "
       "a x + b u + c >= 0.");
    m.def("fastest_squares", [](const In<double, nb::shape<-1, -1, 3>>& limits, const Vector& caps, double step) {
        if (limits.shape(0) != caps.size()) throw nb::value_error("as many rows of limits as caps, please");
        std::vector<timing::Limit> given(limits.shape(0) * limits.shape(1));
        for (std::size_t i = 0; i < given.size(); ++i) given[i] = {limits.data()[3 * i], limits.data()[3 * i + 1], limits.data()[3 * i + 2]};
        std::vector<double> squares;
        {
            nb::gil_scoped_release release;
            squares = timing::fastest_squares(given, view(caps), step);
        }
        return give(std::move(squares));
    }, nb::arg("limits"), nb::arg("caps"), nb::arg("step"),
       "Largest squared speeds (n,) from rest to rest under limits (n, k, 3): a x + b u + c >= 0, and caps (n,) of x.");
}

}  // namespace stairwright::python
