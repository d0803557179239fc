#include "mesh/tetrahedralize.h"

#include "mesh/catch.h"
#include "mesh/geometry.h"

using namespace geometry;

TEST_CASE("a room with openings, a box and a lamp outside becomes tets", "[tetrahedralize]") {
    const auto scene = lit_room();
    const auto complex = conform(scene);
    const auto mesh = tetrahedralize(complex, scene);
    WARN("facets " << complex.facets.size() << " tets " << mesh.tets.size() << " regions "
                   << mesh.region_count);
    // Inside and outside of the room meet through the windows only as interfaces: three regions.
    CHECK(mesh.region_count == 3);
}
