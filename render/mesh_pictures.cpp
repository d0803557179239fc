#include "render/mesh_pictures.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "mesh/entry.h"
#include "mesh/input_error.h"
#include "mesh/walk.h"
#include "radiosity/open_places.h"
#include "render/element_fields.h"

namespace tyndall::render {
namespace {

using mesh::Direction;
using mesh::Point;
using mesh::TetId;
using radiosity::none;
using radiosity::Solution;

constexpr std::size_t overlay_width = 640, slice_length = 960;
constexpr Colour edge_colour{255, 120, 0}, empty_colour{235, 235, 235};
constexpr double edge_share = 0.65, slice_edge_share = 0.3;

void blend(DisplayImage& image, std::size_t pixel, const Colour& colour, double share) {
    for (std::size_t c = 0; c < 3; ++c) {
        auto& value = image.values[3 * pixel + c];
        value = static_cast<std::uint8_t>(std::lround((1.0 - share) * value + share * colour[c]));
    }
}

// Blends the colour that `colour` chooses for a pixel in, where its id differs from that of its
// right or lower neighbour.
template <class ColourFor>
void draw_edges(DisplayImage& image, const std::vector<std::uint32_t>& ids, double share,
                ColourFor&& colour) {
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x) {
            const std::size_t pixel = y * image.width + x;
            const bool right = x + 1 < image.width && ids[pixel] != ids[pixel + 1];
            const bool below = y + 1 < image.height && ids[pixel] != ids[pixel + image.width];
            if (right || below) blend(image, pixel, colour(&image.values[3 * pixel]), share);
        }
}

DisplayImage enlarged(const DisplayImage& picture, std::size_t factor) {
    DisplayImage large{picture.width * factor, picture.height * factor, 3, {}};
    large.values.reserve(3 * large.width * large.height);
    for (std::size_t y = 0; y < large.height; ++y)
        for (std::size_t x = 0; x < large.width; ++x) {
            const std::size_t from = y / factor * picture.width + x / factor;
            for (std::size_t c = 0; c < 3; ++c)
                large.values.push_back(
                    picture.values[from * picture.channels + (picture.channels == 3 ? c : 0)]);
        }
    return large;
}

// The leaf that a ray of the camera ends on, and where; none: nothing that has a side.
struct SeenLeaf {
    mesh::PatchId leaf;
    Point x{0.0};
};

class Eye {
  public:
    Eye(const Solution& s, const Camera& camera)
        : s_(s), mesh_(s.enclosure->mesh), ray_(camera), eye_(camera.eye) {
        tet_ = mesh::locate(mesh_, eye_);
    }

    // Through the point (x, y) of the picture.
    SeenLeaf operator()(double x, double y) const {
        mesh::Ray ray = ray_(x, y);
        const mesh::Entry entry = mesh::entry_near(mesh_, ray, eye_, tet_);
        if (!entry.tet.valid() || s_.enclosure->solid(entry.tet)) return {};
        ray.origin += entry.distance * ray.direction;
        const auto end =
            mesh::walk(mesh_, ray, {entry.tet}, [](TetId, double, double) { return true; });
        if (end.arrival != mesh::Arrival::struck) return {};
        const Point at = ray.origin + end.distance * ray.direction;
        return {s_.forest.leaf_at(mesh::root_patch(end.facet, end.side), at), at};
    }

  private:
    const Solution& s_;
    const mesh::BaseMesh& mesh_;
    CameraRays ray_;
    Point eye_;
    TetId tet_;
};

struct Box {
    Point low{std::numeric_limits<double>::infinity()};
    Point high{-std::numeric_limits<double>::infinity()};
};

Box box_of_media(const radiosity::Enclosure& e) {
    Box box;
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) {
        if (e.solid(TetId(t)) || e.medium_of(TetId(t)) == none) continue;
        for (const auto corner : e.mesh.tets[t]) {
            box.low = glm::min(box.low, e.mesh.points[corner.value]);
            box.high = glm::max(box.high, e.mesh.points[corner.value]);
        }
    }
    if (!(box.low.x <= box.high.x)) box = {e.mesh.hull_min, e.mesh.hull_max};
    return box;
}

// What a plane's pixels see: the media's box projected onto it.
struct Window {
    Point corner;           // of the top left pixel
    Direction right, down;  // of one pixel [m]
    std::size_t width, height;
};

Window window_of(const radiosity::Enclosure& e, const Plane& plane) {
    const Direction n = glm::normalize(plane.normal);
    const Direction above = std::abs(n.z) < 0.99 ? Direction(0, 0, 1) : Direction(0, 1, 0);
    const Direction up = glm::normalize(above - glm::dot(above, n) * n);
    Direction right = glm::cross(up, n);
    // The larger coordinates to the right, whichever way the normal was written.
    if (right.x + right.y < -1e-9) right = -right;
    const Box box = box_of_media(e);
    double low[2]{1e300, 1e300}, high[2]{-1e300, -1e300};
    for (int k = 0; k < 8; ++k) {
        const Point corner((k & 1 ? box.high : box.low).x, (k & 2 ? box.high : box.low).y,
                           (k & 4 ? box.high : box.low).z);
        const Direction d = corner - plane.point;
        for (const int i : {0, 1}) {
            const double s = glm::dot(d, i == 0 ? right : up);
            low[i] = std::min(low[i], s);
            high[i] = std::max(high[i], s);
        }
    }
    const double pixel =
        std::max({high[0] - low[0], high[1] - low[1], 1e-12}) / double(slice_length);
    const auto count = [&](int i) {
        return std::max<std::size_t>(1, static_cast<std::size_t>((high[i] - low[i]) / pixel));
    };
    return {plane.point + low[0] * right + high[1] * up, pixel * right, -pixel * up, count(0),
            count(1)};
}

}  // namespace

DisplayImage mesh_overlay(const Solution& solution, const Camera& camera,
                          const DisplayImage& picture) {
    const std::size_t factor = std::max<std::size_t>(
        1, (overlay_width + picture.width - 1) / std::max<std::size_t>(1, picture.width));
    auto image = enlarged(picture, factor);
    std::vector<std::uint32_t> ids(image.width * image.height);
    const Eye eye(solution, camera);
    tbb::parallel_for(std::size_t(0), image.height, [&](std::size_t y) {
        for (std::size_t x = 0; x < image.width; ++x)
            ids[y * image.width + x] =
                eye((double(x) + 0.5) / double(factor), (double(y) + 0.5) / double(factor))
                    .leaf.value;
    });
    draw_edges(image, ids, edge_share, [](const std::uint8_t*) { return edge_colour; });
    return image;
}

Plane default_plane(const radiosity::Enclosure& enclosure) {
    const Box box = box_of_media(enclosure);
    const bool along_x = box.high.x - box.low.x >= box.high.y - box.low.y;
    // Off the middle by a little: scenes like to have walls right there.
    const Point middle = box.low + 0.5003 * (box.high - box.low);
    return {middle, along_x ? Direction(0, 1, 0) : Direction(1, 0, 0)};
}

namespace {

// Colours for a value a pixel, and the edges of what the ids stand for.
// Values that are none, of elements that have no temperature, are left grey.
FieldPicture coloured(std::size_t width, std::size_t height, std::vector<std::uint32_t> ids,
                      const std::vector<double>& values, const FieldOptions& options,
                      bool logarithmic) {
    std::vector<double> shown;
    bool any = false;
    for (std::size_t k = 0; k < ids.size(); ++k) {
        any = any || ids[k] != none;
        if (std::isnan(values[k])) ids[k] = none;
        if (ids[k] != none) shown.push_back(values[k]);
    }
    if (any && shown.empty())
        throw mesh::InputError(fmt::format(
            "nothing that is shown has a {}. Show another field, or solve a scene with heat.",
            options.field));
    FieldPicture result{{width, height, 3, {}}, scale_for(std::move(shown), logarithmic)};
    if (options.low) result.scale.low = *options.low;
    if (options.high) result.scale.high = *options.high;
    if (!(result.scale.low < result.scale.high) || (logarithmic && !(result.scale.low > 0.0)))
        throw mesh::InputError(
            fmt::format("colours from {} to {} show nothing of {}. Give {} below the upper end.",
                        result.scale.low, result.scale.high, options.field,
                        logarithmic ? "a lower end above 0 and" : "a lower end"));
    result.image.values.assign(3 * ids.size(), static_cast<std::uint8_t>(empty_colour[0]));
    for (std::size_t k = 0; k < ids.size(); ++k)
        if (ids[k] != none) blend(result.image, k, result.scale(values[k]), 1.0);
    if (options.edges)
        draw_edges(result.image, ids, slice_edge_share, [](const std::uint8_t* rgb) {
            return rgb[1] > 110 ? Colour{0, 0, 0} : Colour{255, 255, 255};
        });
    return result;
}

}  // namespace

FieldPicture field_slice(const Solution& solution, const Plane& plane,
                         const FieldOptions& options) {
    const auto& e = *solution.enclosure;
    const Window window = window_of(e, plane);
    const NamedField& field = field_named(options.field);
    std::vector<std::uint32_t> ids(window.width * window.height, none);
    std::vector<double> values(ids.size(), 0.0);
    tbb::parallel_for(std::size_t(0), window.height, [&](std::size_t y) {
        TetId near(0);
        for (std::size_t x = 0; x < window.width; ++x) {
            const Point p =
                window.corner + (double(x) + 0.5) * window.right + (double(y) + 0.5) * window.down;
            const TetId tet = mesh::locate(e.mesh, p, near);
            if (!tet.valid()) continue;
            near = tet;
            if (e.solid(tet) || e.medium_of(tet) == none || radiosity::covered(e, p)) continue;
            const auto zone = solution.forest.leaf_at(mesh::root_zone(tet), p);
            ids[y * window.width + x] = zone.value;
            values[y * window.width + x] = field.of_zone(solution, zone, p);
        }
    });
    return coloured(window.width, window.height, std::move(ids), values, options,
                    field.logarithmic);
}

FieldPicture field_picture(const Solution& solution, const Camera& camera,
                           const FieldOptions& options) {
    const NamedField& field = field_named(options.field);
    std::vector<std::uint32_t> ids(camera.width * camera.height, none);
    std::vector<double> values(ids.size(), 0.0);
    const Eye eye(solution, camera);
    tbb::parallel_for(std::size_t(0), camera.height, [&](std::size_t y) {
        for (std::size_t x = 0; x < camera.width; ++x) {
            const SeenLeaf seen = eye(double(x) + 0.5, double(y) + 0.5);
            if (!seen.leaf.valid() ||
                radiosity::side_of(*solution.enclosure, solution.forest, seen.leaf) == none)
                continue;
            ids[y * camera.width + x] = seen.leaf.value;
            values[y * camera.width + x] = field.of_patch(solution, seen.leaf, seen.x);
        }
    });
    return coloured(camera.width, camera.height, std::move(ids), values, options,
                    field.logarithmic);
}

}  // namespace tyndall::render
