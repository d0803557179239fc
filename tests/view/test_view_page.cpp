// The page as a file, and the pieces that it draws direct light with.
#include <zlib.h>

#include <bit>

#include "radiosity/adaptive.h"
#include "radiosity/direct_light.h"
#include "support/catch.h"
#include "support/occurrences.h"
#include "support/path_scenes.h"
#include "support/random_rays.h"
#include "view/packed_arrays.h"
#include "view/view_page.h"
#include "view/viewer_arrays.h"

using namespace tyndall;

namespace {

const radiosity::Solution& slit_solution() {
    static const radiosity::Solution solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(test::slit_room())),
        {.error = 0.1,
         .start = radiosity::Start::base,
         .max_elements = 2000,
         .rays = 16,
         .gather_rays = 16});
    return solution;
}

std::string from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(group >> bits & 255u);
    }
    return bytes;
}

std::string gunzip(std::string bytes, std::size_t size) {
    std::string result(size + 1, '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, 15 + 16) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    REQUIRE(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    inflateEnd(&stream);
    result.resize(stream.total_out);
    return result;
}

// Mean error of direct light on patches, over its mean, at random points of the leaves.
double direct_error(const radiosity::Solution& s, const radiosity::Forest& forest,
                    const radiosity::Fields& direct) {
    const radiosity::DirectLight light(*s.enclosure);
    test::Random random(11);
    double error = 0.0, total = 0.0;
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p) {
        const mesh::PatchId patch(p);
        if (!s.forest.is_leaf(patch) ||
            radiosity::side_of(*s.enclosure, s.forest, patch) == radiosity::none)
            continue;
        for (int n = 0; n < 4; ++n) {
            const auto w = test::random_weights<3>(random);
            mesh::Point x(0.0);
            for (int c = 0; c < 3; ++c) x += w[c] * s.forest.point(s.forest[patch].corners[c]);
            double exact = 0.0;
            const auto side = s.forest.base_facet_side(patch);
            light.at_patch(x, radiosity::normal_of(s.forest, patch),
                           s.enclosure->mesh.facets[side / 2].tets[side % 2], {&exact, 1});
            const double area = s.forest.area(patch);
            error += area * std::abs(direct.at(forest.leaf_at(patch, x), 0).at(x) - exact);
            total += area * exact;
        }
    }
    return error / total;
}

}  // namespace

TEST_CASE("Packed arrays come back to the last bit", "[view]") {
    const std::vector<float> floats{0.0f, -1.5f, 3e-39f, 1e30f, 0.1f};
    const std::vector<std::int32_t> integers{-2, -1, 0, 7, 1 << 30};
    view::PackedArrays packed;
    packed.add("floats", floats);
    packed.add("integers", integers);
    packed.add("nothing", std::vector<float>{});
    REQUIRE(packed.entries().size() == 3);
    CHECK(packed.entries()[1].name == "integers");
    CHECK(packed.entries()[1].type == 'i');
    const std::string bytes = gunzip(from_base64(packed.text()), 40);
    REQUIRE(bytes.size() == 40);
    for (std::size_t i = 0; i < 5; ++i) {
        std::uint32_t bits[2] = {0, 0};
        for (std::size_t array = 0; array < 2; ++array)
            for (std::size_t k = 0; k < 4; ++k)
                bits[array] |= std::uint32_t(std::uint8_t(bytes[20 * array + 5 * k + i])) << 8 * k;
        CHECK(std::bit_cast<float>(bits[0]) == floats[i]);
        CHECK(static_cast<std::int32_t>(bits[1]) == integers[i]);
    }
}

TEST_CASE("Sharpened patches hold direct light that pictures would compute anew", "[view]") {
    const auto& s = slit_solution();
    const auto sharpened = view::sharpen_patches(s);
    const double before = direct_error(s, s.forest, s.direct);
    const double after = direct_error(s, sharpened.forest, sharpened.direct);
    CAPTURE(before, after, sharpened.made, sharpened.left);
    // Pieces are bisected until they are off by 0.4 % of the mean in the middles of their edges;
    // inside, and where the same curvature goes on, by no more in the mean.
    CHECK(after < 0.004);
    CHECK(before > 3.0 * after);
    // Only patches are bisected, and where there is no light none.
    CHECK(sharpened.forest.zone_count() == s.forest.zone_count());
    CHECK(sharpened.forest.patch_count() == s.forest.patch_count() + 2 * sharpened.made);
    const auto few = view::sharpen_patches(s, {.most_pieces = 40});
    CHECK(few.made == 40);
    CHECK(few.left > 0);
}

TEST_CASE("A page is one file with all in it, the same at any thread count", "[view]") {
    view::PageOptions options;
    options.title = "A </script> & <b>";
    auto camera = test::camera_at({0.4, 0.3, 1.2}, {3.0, 1.6, 1.4}, 1.3, 32, 24);
    options.cameras = {camera};
    options.sharpen.most_pieces = 500;
    options.threads = 2;
    const std::string page = view::view_page(slit_solution(), options);
    options.threads = 1;
    CHECK(view::view_page(slit_solution(), options) == page);
    CHECK(test::occurrences(page, "{{") == 0);
    CHECK(test::occurrences(page, "<h1>A &lt;/script&gt; &amp; &lt;b&gt;</h1>") == 1);
    CHECK(test::occurrences(page, "<script") == test::occurrences(page, "</script>"));
    // Nothing is fetched: the one address is the name of a format.
    CHECK(test::occurrences(page, "http") == test::occurrences(page, "http://www.w3.org/2000/svg"));
    CHECK(test::occurrences(page, " src=") == 0);
    options.cameras.clear();
    CHECK(test::occurrences(view::view_page(slit_solution(), options), "\"name\":\"somewhere\"") ==
          1);
}
