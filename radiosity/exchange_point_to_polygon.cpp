#include "radiosity/exchange_point_to_polygon.h"

#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/closed_forms.h"
#include "radiosity/cube_centres.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/face_pairs.h"
#include "radiosity/mean_transmittance.h"
#include "radiosity/pair_rows.h"

namespace tyndall::radiosity {
namespace {

constexpr double depth_step = 0.1;  // of the exponent, over which a transmittance is averaged

class PointsToPolygons {
  public:
    PointsToPolygons(const Discretization& d, const ExchangeOptions& options)
        : d_(d), options_(options), pairs_(d), centres_(d, options.settings, options.seed) {}

    // i ≤ j: a zone only comes second, or before outside.
    double area(ElementId i, ElementId j) const {
        const bool i_is_zone = pairs_.shape(i).zone, j_is_zone = pairs_.shape(j).zone;
        if (i_is_zone && j_is_zone)
            refuse_pair(d_, "point_to_polygon", i, j, "neither is a polygon",
                        &NamedExchangeMethod::zones);
        if (j.value == d_.elements.outside()) return seen(i, j);
        if (j_is_zone) return seen(j, i);
        return 0.5 * (seen(i, j) + seen(j, i));
    }

  private:
    // c of the receiver times the mean over its points of what they see of the source.
    double seen(ElementId receiver, ElementId source) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < centres_.count(); ++k) {
            const CubeCentre centre = centres_(receiver.value, k);
            const bool patch = d_.elements.is_patch(receiver.value);
            const Receiver point{centre.place, centre.at.tet,
                                 patch ? centre.axes[2] : Direction(0.0), patch};
            for (const ElementFace& face : pairs_.shape(source).faces)
                sum += seen_of(point, face.polygon);
        }
        return d_.elements.capacity[receiver.value * d_.elements.bands + options_.band] * sum /
               static_cast<double>(centres_.count());
    }

    double seen_of(const Receiver& point, const mesh::ConvexPolygon& polygon) const {
        if (glm::dot(polygon.normal, point.x - polygon.corners[0]) <= 0.0) return 0.0;
        std::vector<Point> corners, above;
        for (const Point& corner : polygon.corners) corners.push_back(corner - point.x);
        if (point.on_surface) {
            mesh::clip(corners, point.normal, 0.0, above);
            if (above.size() < 3) return 0.0;
            corners.swap(above);
        }
        mesh::VisibleScratch scratch;
        const auto seen = pairs_.occluders().look(
            point.x, {.corners = corners}, {.occluders = 1u << 20, .parts = 1u << 20}, scratch);
        if (seen == mesh::Visibility::none) return 0.0;
        double sum = 0.0;
        std::vector<double> mean(d_.enclosure.bands, 1.0);
        for (std::size_t k = 0; k < scratch.visible.size(); ++k) {
            const auto part = scratch.visible[k];
            if (!pairs_.depth().transparent())
                mean_transmittance(pairs_.depth(), point, part, nullptr, depth_step, mean);
            sum += mean[options_.band] *
                   (point.on_surface ? projected_solid_angle(part, point.normal) / std::numbers::pi
                                     : solid_angle(part) / (4.0 * std::numbers::pi));
        }
        return sum;
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    FacePairs pairs_;
    CubeCentres centres_;
};

}  // namespace

void exchange_point_to_polygon(const Discretization& discretization,
                               std::span<const ElementId> rows, const ExchangeOptions& options,
                               const RowSink& sink) {
    const PointsToPolygons points(discretization, options);
    pair_rows(
        discretization, rows, options, false,
        [&](ElementId i, ElementId j) { return points.area(i, j); }, sink);
}

}  // namespace tyndall::radiosity
