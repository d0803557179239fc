#include "radiosity/exchange_reference_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/input_error.h"
#include "radiosity/face_pairs.h"
#include "radiosity/pair_rows.h"

namespace tyndall::radiosity {
namespace {

// A first look tells how much each integral may be off.
constexpr double first_tolerance = 1e-2;
constexpr int most_looks = 4;
constexpr std::size_t most_evaluations = 20'000'000;

class ReferencePairs {
  public:
    ReferencePairs(const Discretization& d, const ExchangeOptions& options)
        : d_(d), options_(options), pairs_(d) {}

    double area(ElementId i, ElementId j) const {
        const Shape& a = pairs_.shape(i);
        const Shape& b = pairs_.shape(j);
        const DepthKernel kernel = pairs_.kernel(a, b, options_.band);
        std::vector<Part> parts;
        double sum = 0.0;
        each_facing(a, b, [&](const FacingParts& facing) {
            Part part{facing, pairs_.blocked(facing), pairs_.extinction(facing, options_.band)};
            part.integral = integral(part, kernel, {first_tolerance, 0.0, most_evaluations});
            sum += facing.sign * part.integral.value;
            parts.push_back(std::move(part));
        });
        // Signs cancel, so that the first look may not even know the sum: closer, until it does.
        double result = sum, error = 0.0;
        for (int look = 0; look < most_looks; ++look) {
            const double goal =
                options_.settings.tolerance * std::abs(result) / static_cast<double>(parts.size());
            if (goal == 0.0) return 0.0;
            result = error = 0.0;
            for (Part& part : parts) {
                if (part.integral.error > goal)
                    part.integral = integral(part, kernel, {0.0, goal, most_evaluations});
                result += part.facing.sign * part.integral.value;
                error = std::hypot(error, part.integral.error);
            }
            if (error <= options_.settings.tolerance * std::abs(result)) return result;
        }
        fail(i, j, error / result);
    }

  private:
    struct Part {
        FacingParts facing;
        bool blocked;
        std::optional<double> extinction;
        Integral integral{};
    };

    Integral integral(const Part& part, DepthKernel kernel, const CubatureOptions& options) const {
        const PolygonPair pair{part.facing.p, part.facing.q, part.facing.p_normal,
                               part.facing.q_normal};
        if (part.extinction == 0.0 && kernel != DepthKernel::transmittance) return {};
        if (!part.blocked && part.extinction)
            return exchange_in_sight(pair, *part.extinction, kernel, options);
        return exchange_past(
            pair,
            {d_.enclosure, pairs_.occluders(), pairs_.depth(), options_.band, part.extinction},
            kernel, options);
    }

    [[noreturn]] void fail(ElementId i, ElementId j, double error) const {
        const auto name = [&](ElementId id) {
            return name_of(d_.enclosure, d_.forest, d_.elements, id);
        };
        throw mesh::InputError(fmt::format(
            "reference_pairs: {} and {} were computed to a relative error of {:.1g}, not {:.1g}. "
            "Ask for a looser tolerance (--tolerance, solve.exchange_tolerance).",
            name(i), name(j), std::abs(error), options_.settings.tolerance));
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    FacePairs pairs_;
};

}  // namespace

void exchange_reference_pairs(const Discretization& discretization, std::span<const ElementId> rows,
                              const ExchangeOptions& options, const RowSink& sink) {
    const ReferencePairs pairs(discretization, options);
    pair_rows(
        discretization, rows, options, false,
        [&](ElementId i, ElementId j) { return pairs.area(i, j); }, sink);
}

}  // namespace tyndall::radiosity
