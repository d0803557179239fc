// A small foggy box and its linear system, for tests of solvers.
#pragma once

#include "radiosity/exchange_walked.h"
#include "radiosity/solver.h"
#include "support/cube.h"

namespace tyndall::test {

using namespace radiosity;

enum class Rows { constant, linear, detail, smoothed };

// A cube of fog with a lit floor: 48 zones and 48 patches of 64 rays each.
struct FoggyBox {
    Enclosure enclosure;
    Forest forest;
    Elements elements;
    ExchangeAreas areas;

    explicit FoggyBox(double albedo, double reflectance, Rows rows = Rows::constant,
                      double extinction = 1.0)
        : enclosure(test::cube_enclosure({.extinction = extinction,
                                          .albedo = albedo,
                                          .reflectance = reflectance,
                                          .bottom_emission = 1.0,
                                          .size = {2, 2, 2}})),
          forest(enclosure.mesh),
          elements(elements_of_leaves(enclosure, forest)),
          areas(all_rows(exchange_walked, {enclosure, forest, elements}, options(rows))) {}

    static ExchangeOptions options(Rows rows) {
        ExchangeOptions options{.rays = 64, .progress = {}};
        if (rows == Rows::linear) options.radiance = Radiance::linear;
        if (rows == Rows::detail) options.detail = 4.0;
        if (rows == Rows::smoothed) options.settings.smoothing = Smoothing::least_squares;
        return options;
    }

    LinearProblem problem() const { return {elements, areas, 0, elements.emission}; }

    // The same, with rows made when they are asked for.
    LinearProblem on_the_fly() const {
        LinearProblem problem{elements, none_kept, 0, elements.emission};
        problem.rows = [this](std::span<const ElementId> rows, const RowSink& sink) {
            exchange_walked({enclosure, forest, elements}, rows, options(Rows::constant), sink);
        };
        return problem;
    }

    ExchangeAreas none_kept;
};

}  // namespace tyndall::test
