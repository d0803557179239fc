#include "radiosity/exchange_contour_integration.h"

#include <cmath>

#include "radiosity/contour.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/face_pairs.h"
#include "radiosity/pair_rows.h"

namespace tyndall::radiosity {
namespace {

constexpr std::string_view name = "contour_integration";

Point middle(const std::vector<Point>& polygon) {
    Point sum(0.0);
    for (const Point& corner : polygon) sum += corner;
    return sum / static_cast<double>(polygon.size());
}

class Contours {
  public:
    Contours(const Discretization& d, const ExchangeOptions& options)
        : d_(d), options_(options), pairs_(d) {}

    double area(ElementId i, ElementId j) const {
        for (const ElementId element : {i, j})
            if (pairs_.shape(element).zone)
                refuse_pair(d_, name, i, j, "a zone has no contour", &NamedExchangeMethod::zones);
        double sum = 0.0;
        each_facing(pairs_.shape(i), pairs_.shape(j), [&](const FacingParts& parts) {
            if (pairs_.blocked(parts))
                refuse_pair(d_, name, i, j, "something is in the way",
                            &NamedExchangeMethod::occlusion);
            sum += contour_integral(parts.p, parts.q) * transmittance(i, j, parts);
        });
        return sum;
    }

  private:
    double transmittance(ElementId i, ElementId j, const FacingParts& parts) const {
        if (pairs_.extinction(parts, options_.band) == 0.0) return 1.0;
        if (!options_.settings.uniform_transmittance)
            refuse_pair(d_, name, i, j,
                        "there is a medium between them (solve.uniform_transmittance takes one "
                        "transmittance for all paths)",
                        &NamedExchangeMethod::media);
        std::vector<double> depth(d_.enclosure.bands);
        const Point from = middle(parts.p);
        pairs_.depth()(from, parts.tet, middle(parts.q) - from, depth);
        return std::exp(-depth[options_.band]);
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    FacePairs pairs_;
};

}  // namespace

void exchange_contour_integration(const Discretization& discretization,
                                  std::span<const ElementId> rows, const ExchangeOptions& options,
                                  const RowSink& sink) {
    const Contours contours(discretization, options);
    pair_rows(
        discretization, rows, options, true,
        [&](ElementId i, ElementId j) { return contours.area(i, j); }, sink);
}

}  // namespace tyndall::radiosity
