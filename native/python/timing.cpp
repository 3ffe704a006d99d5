#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/timing/time_optimal.hpp"

namespace stairwright::python {

void bind_timing(nb::module_& m) {
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
