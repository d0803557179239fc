// Two unit squares that look at each other from one metre: how much of what one sends out reaches
// the other?
//
//   Run:       build/release/bin/01_two_squares
//   Shows:     scene -> enclosure -> elements -> exchange areas; what closure and reciprocity mean
//   Builds on: nothing
#include <cstdio>

#include "mesh/shapes.h"
#include "radiosity/exchange_walked.h"
#include "radiosity/scene_builder.h"

using namespace tyndall;

int main() {
    // Lengths are in metres. The front of a rectangle is the side that u x v looks to: these two
    // fronts face each other.
    radiosity::Scene scene;
    const radiosity::Material black{.reflectance = {0.0}};
    add_surface(scene, "low", mesh::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), black);
    add_surface(scene, "high", mesh::rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}), black);

    // The enclosure is the scene ready to be computed with: tetrahedra between and around the
    // squares, and the optics of every side. Light that leaves its hull is "outside".
    const auto enclosure = radiosity::make_enclosure(scene);

    // Elements are what exchanges light: here the triangles that the squares are meshed with.
    const mesh::Forest forest(enclosure.mesh);
    const auto elements = radiosity::elements_of_leaves(enclosure, forest);

    // Row i says what reaches each element of all that i sends out, as areas S_ij [m^2].
    const auto areas = radiosity::all_rows(radiosity::exchange_walked,
                                           {enclosure, forest, elements}, {.rays = 4096});

    // "low+" is the front of low, "low-" its back. Columns that are no element stand for outside.
    const auto lies_on = [&](const char* name, std::size_t element) {
        return element < elements.patches.size() &&
               enclosure.sides[side_of(enclosure, forest, elements.patches[element])].name == name;
    };
    const auto exchanged = [&](const char* from, const char* to) {
        double sum = 0.0;
        for (std::size_t i = 0; i < areas.rows(); ++i)
            for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k)
                if (lies_on(from, i) && lies_on(to, areas.columns[k])) sum += areas.values[k];
        return sum;
    };
    std::printf("%zu elements\n", elements.size());
    std::printf("exchange area low -> high %.5f m^2; the closed form is 0.19982\n",
                exchanged("low+", "high+"));

    // Closure: a row sums to the element's own area, since light ends somewhere (outside counts).
    // Walked rows close to rounding, however few rays.
    std::printf("closure error             %.0e\n", closure_error(areas, elements, 0));

    // Reciprocity: S_ij = S_ji. The two are walked apart, from i and from j, so what they differ by
    // tells what the rays are worth: little between squares, more between two small triangles.
    std::printf("exchange area high -> low %.5f m^2\n", exchanged("high+", "low+"));
    std::printf("reciprocity error         %.0e\n", reciprocity_error(areas, elements));
}
