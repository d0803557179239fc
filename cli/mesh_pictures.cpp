#include "cli/mesh_pictures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/walk.h"

namespace tyndall::cli {
namespace {

using mesh::Direction;
using mesh::Point;
using mesh::TetId;
using radiosity::none;
using radiosity::Solution;
using Colour = std::array<double, 3>;  // sRGB codes, 0 to 255

constexpr std::size_t overlay_width = 640, slice_length = 960;
constexpr Colour edge_colour{255, 120, 0}, empty_colour{235, 235, 235};
constexpr double edge_share = 0.65, slice_edge_share = 0.3;

void blend(render::DisplayImage& image, std::size_t pixel, const Colour& colour, double share) {
    for (std::size_t c = 0; c < 3; ++c) {
        auto& value = image.values[3 * pixel + c];
        value = static_cast<std::uint8_t>(std::lround((1.0 - share) * value + share * colour[c]));
    }
}

// Blends the colour that `colour` chooses for a pixel in, where its id differs from that of its
// right or lower neighbour.
template <class ColourFor>
void draw_edges(render::DisplayImage& image, const std::vector<std::uint32_t>& ids, double share,
                ColourFor&& colour) {
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x) {
            const std::size_t pixel = y * image.width + x;
            const bool right = x + 1 < image.width && ids[pixel] != ids[pixel + 1];
            const bool below = y + 1 < image.height && ids[pixel] != ids[pixel + image.width];
            if (right || below) blend(image, pixel, colour(&image.values[3 * pixel]), share);
        }
}

render::DisplayImage enlarged(const render::DisplayImage& picture, std::size_t factor) {
    render::DisplayImage large{picture.width * factor, picture.height * factor, 3, {}};
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

std::uint32_t patch_seen(const Solution& s, const mesh::Ray& ray, TetId eye) {
    if (!eye.valid() || s.enclosure->solid(eye)) return none;
    const auto end =
        mesh::walk(s.enclosure->mesh, ray, {eye}, [](TetId, double, double) { return true; });
    if (end.arrival != mesh::Arrival::struck) return none;
    const Point x = ray.origin + end.distance * ray.direction;
    return s.forest.leaf_at(mesh::root_patch(end.facet, end.side), x).value;
}

// The ray from where it enters the hull, for eyes outside.
mesh::Ray moved_into(const mesh::BaseMesh& mesh, mesh::Ray ray) {
    double in = 0.0, out = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        double a = (mesh.hull_min[k] - ray.origin[k]) / ray.direction[k];
        double b = (mesh.hull_max[k] - ray.origin[k]) / ray.direction[k];
        if (a > b) std::swap(a, b);
        in = std::max(in, a);
        out = std::min(out, b);
    }
    if (in < out) ray.origin += (in + 1e-9 * (out - in)) * ray.direction;
    return ray;
}

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

// Source: a polynomial through matplotlib's map "viridis" (M. Zucker, 2019, public domain).
Colour heat_colour(double t) {
    constexpr double c[7][3] = {
        {0.2777273, 0.0054073, 0.3340998},   {0.1050930, 1.4046135, 1.3845902},
        {-0.3308618, 0.2148476, 0.0950952},  {-4.6342305, -5.7991010, -19.3324410},
        {6.2282699, 14.1799334, 56.6905526}, {4.7763850, -13.7451454, -65.3530326},
        {-5.4354559, 4.6458526, 26.3124352}};
    t = std::clamp(t, 0.0, 1.0);
    Colour colour;
    for (std::size_t k = 0; k < 3; ++k) {
        double value = 0.0;
        for (int power = 6; power >= 0; --power) value = value * t + c[power][k];
        colour[k] = 255.0 * std::clamp(value, 0.0, 1.0);
    }
    return colour;
}

// Colours by the logarithm: shafts are many times brighter near their lamp than far from it.
struct ColourScale {
    double low, high;

    Colour operator()(double value) const {
        if (!(value > low)) return heat_colour(0.0);
        return heat_colour(std::log(value / low) / std::log(high / low));
    }
};

double percentile(std::vector<double>& values, double share) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

ColourScale scale_for(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !(v > 0.0); });
    if (values.empty()) return {0.1, 1.0};
    const double high = percentile(values, 0.995), low = percentile(values, 0.005);
    return {std::clamp(low, 1e-3 * high, 0.5 * high), high};
}

double mean_source(const Solution& s, mesh::ZoneId zone, Point x) {
    double sum = 0.0;
    for (std::size_t b = 0; b < s.enclosure->bands; ++b)
        sum += radiosity::emission_of(s, zone, b) +
               radiosity::scatter_of(s, zone, b) *
                   (s.direct.at(zone, b).at(x) + s.indirect.at(zone, b).at(x));
    return sum / static_cast<double>(s.enclosure->bands);
}

}  // namespace

render::DisplayImage mesh_overlay(const Solution& solution, const render::Camera& camera,
                                  const render::DisplayImage& picture) {
    const std::size_t factor = std::max<std::size_t>(
        1, (overlay_width + picture.width - 1) / std::max<std::size_t>(1, picture.width));
    auto image = enlarged(picture, factor);
    const auto& base = solution.enclosure->mesh;
    const TetId eye = mesh::locate(base, camera.eye);
    std::vector<std::uint32_t> ids(image.width * image.height);
    const render::CameraRays camera_ray(camera);
    tbb::parallel_for(std::size_t(0), image.height, [&](std::size_t y) {
        for (std::size_t x = 0; x < image.width; ++x) {
            auto ray =
                camera_ray((double(x) + 0.5) / double(factor), (double(y) + 0.5) / double(factor));
            if (!eye.valid()) ray = moved_into(base, ray);
            ids[y * image.width + x] =
                patch_seen(solution, ray, eye.valid() ? eye : mesh::locate(base, ray.origin));
        }
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

render::DisplayImage mesh_slice(const Solution& solution, const Plane& plane) {
    const auto& e = *solution.enclosure;
    const Window window = window_of(e, plane);
    render::DisplayImage image{window.width, window.height, 3, {}};
    const std::size_t count = image.width * image.height;
    image.values.assign(3 * count, static_cast<std::uint8_t>(empty_colour[0]));
    std::vector<std::uint32_t> ids(count, none);
    std::vector<double> sources(count, 0.0);
    tbb::parallel_for(std::size_t(0), image.height, [&](std::size_t y) {
        TetId near(0);
        for (std::size_t x = 0; x < image.width; ++x) {
            const Point p =
                window.corner + (double(x) + 0.5) * window.right + (double(y) + 0.5) * window.down;
            const TetId tet = mesh::locate(e.mesh, p, near);
            if (!tet.valid()) continue;
            near = tet;
            if (e.solid(tet) || e.medium_of(tet) == none) continue;
            const auto zone = solution.forest.leaf_at(mesh::root_zone(tet), p);
            ids[y * image.width + x] = zone.value;
            sources[y * image.width + x] = mean_source(solution, zone, p);
        }
    });
    const ColourScale colour = scale_for(sources);
    for (std::size_t k = 0; k < count; ++k)
        if (ids[k] != none) blend(image, k, colour(sources[k]), 1.0);
    draw_edges(image, ids, slice_edge_share, [](const std::uint8_t* rgb) {
        return rgb[1] > 110 ? Colour{0, 0, 0} : Colour{255, 255, 255};
    });
    return image;
}

}  // namespace tyndall::cli
