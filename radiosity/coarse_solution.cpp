#include "radiosity/coarse_solution.h"

#include <algorithm>

#include "radiosity/exchange_methods.h"

namespace tyndall::radiosity {
namespace {

// The function with that gradient and with its mean at the node's centre, whose gradient is
// shortened until no corner is below 0.
template <class Node>
Affine affine_not_below_0(const Enclosure& enclosure, const Forest& forest, Node node, double mean,
                          Direction gradient) {
    const auto& corners = forest[node].corners;
    const Point centre = centre_of(enclosure, forest, node);
    double lowest = 0.0;
    for (const VertexId corner : corners)
        lowest = std::min(lowest, glm::dot(gradient, forest.point(corner) - centre));
    if (mean + lowest < 0.0) gradient *= std::max(0.0, mean) / -lowest;
    return {gradient, mean - glm::dot(gradient, centre)};
}

}  // namespace

CoarseSolution::CoarseSolution(const Enclosure& enclosure, const Forest& forest,
                               const SolveOptions& options, const ProgressCallback& progress)
    : CoarseSolution(enclosure, forest, elements_of_leaves(enclosure, forest), options, progress) {}

CoarseSolution::CoarseSolution(const Enclosure& enclosure, const Forest& forest, Elements elements,
                               const SolveOptions& options, const ProgressCallback& progress)
    : enclosure_(enclosure), forest_(forest), options_(options), elements_(std::move(elements)) {
    const NamedExchangeMethod& method = exchange_method(options.exchange);
    require_settings(method, options.exchange_settings);
    require_media(method, enclosure);
    for (std::size_t band = 0; band < enclosure.bands; ++band) {
        const std::size_t same = first_of_extinction(enclosure, band);
        if (same < band) {
            matrix_.push_back(matrix_[same]);
            continue;
        }
        matrix_.push_back(areas_.size());
        areas_.push_back(
            all_rows(method.method, {enclosure, forest, elements_},
                     {.band = band,
                      .rays = options.rays,
                      .seed = options.seed,
                      .settings = options.exchange_settings,
                      .detail = options.row_detail,
                      .radiance = method.moments ? options.radiance : Radiance::constant,
                      .progress = progress,
                      .lost_rays = &lost_rays_}));
        rays_ += elements_.size() * options.rays;
    }
}

std::vector<Affine> CoarseSolution::linear_indirect() const {
    const std::size_t bands = elements_.bands, n = elements_.size();
    std::vector<Affine> result(n * bands);
    for (std::size_t k = 0; k < result.size(); ++k) result[k].constant = indirect_[k];
    if (options_.radiance == Radiance::constant || !elements_.member_starts.empty()) return result;
    const auto gradients = areas_[0].gradients ? areas_[0].gradients
                                               : std::make_shared<const ElementGradients>(
                                                     enclosure_, forest_, elements_);
    std::vector<double> means(n);
    for (std::size_t b = 0; b < bands; ++b) {
        for (std::size_t i = 0; i < n; ++i) means[i] = indirect(i, b);
        const std::vector<glm::vec3> of_means = gradients->of(means);
        for (std::size_t i = 0; i < n; ++i)
            result[i * bands + b] =
                elements_.is_patch(i)
                    ? affine_not_below_0(enclosure_, forest_, elements_.patches[i], means[i],
                                         Direction(of_means[i]))
                    : affine_not_below_0(enclosure_, forest_, elements_.zone(i), means[i],
                                         Direction(of_means[i]));
    }
    return result;
}

std::size_t CoarseSolution::memory() const {
    std::size_t bytes = elements_.capacity.size() * 3 * sizeof(double);
    for (const auto& areas : areas_) bytes += areas.memory();
    return bytes;
}

double CoarseSolution::split_emission(std::size_t element, std::size_t band) const {
    const bool split =
        elements_.is_patch(element) && options_.direct_light == DirectLightMode::closed_form;
    return split ? elements_.emission[element * elements_.bands + band] : 0.0;
}

// The factor that makes what arrives from lit patches as much as they send to elements, which their
// rows know well: few points an element miss some of it in corners.
double CoarseSolution::lit_scale(const std::vector<double>& incident_direct,
                                 const std::vector<double>& incident_lit, std::size_t band) const {
    double sent = 0.0, arrived = 0.0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        const std::size_t k = i * elements_.bands + band;
        arrived += elements_.capacity[k] * incident_lit[k];
        if (elements_.is_patch(i))
            sent += elements_.scatter[k] * incident_direct[k] *
                    (elements_.capacity[k] - to_outside(areas(band), elements_, i));
    }
    return arrived > 0.0 ? sent / arrived : 1.0;
}

void CoarseSolution::solve(const std::vector<double>& incident_direct,
                           const std::vector<double>& incident_lit) {
    const bool apart = !incident_lit.empty();
    const std::size_t bands = elements_.bands, n = elements_.size();
    indirect_.assign(n * bands, 0.0);
    reflected_.assign(n * bands, 0.0);
    report_ = {"gmres", 0, 0.0, true};
    std::vector<double> source(n);
    for (std::size_t b = 0; b < bands; ++b) {
        const ExchangeAreas& rows = areas(b);
        std::vector<double> from_outside(n, 0.0), arrived(n, 0.0);
        const double scale = apart ? lit_scale(incident_direct, incident_lit, b) : 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const double capacity = elements_.capacity[i * bands + b];
            if (capacity > 0.0)
                from_outside[i] =
                    to_outside(rows, elements_, i) / capacity * enclosure_.environment[b];
            const double sent =
                apart && elements_.is_patch(i) ? 0.0 : incident_direct[i * bands + b];
            if (apart) arrived[i] = scale * incident_lit[i * bands + b];
            source[i] = elements_.emission[i * bands + b] - split_emission(i, b) +
                        elements_.scatter[i * bands + b] * (sent + arrived[i] + from_outside[i]);
        }
        const LinearProblem problem{elements_, rows, b, source};
        const SolverResult result =
            solve_gmres(problem, {options_.solver_tolerance, options_.solver_iterations});
        report_.iterations = std::max(report_.iterations, result.iterations);
        report_.residual = std::max(report_.residual, result.residual);
        report_.converged = report_.converged && result.converged;
        const std::vector<double> received = multiply(rows, elements_, result.radiance);
        for (std::size_t i = 0; i < n; ++i) {
            const double capacity = elements_.capacity[i * bands + b];
            indirect_[i * bands + b] =
                capacity > 0.0 ? received[i] / capacity + from_outside[i] + arrived[i] : 0.0;
            reflected_[i * bands + b] = result.radiance[i];
            if (apart && elements_.is_patch(i))
                reflected_[i * bands + b] +=
                    elements_.scatter[i * bands + b] * incident_direct[i * bands + b];
        }
    }
}

std::vector<double> CoarseSolution::carried(const std::vector<double>& departure) const {
    const std::size_t bands = elements_.bands, n = elements_.size();
    std::vector<double> result(n * bands, 0.0), source(n);
    for (std::size_t b = 0; b < bands; ++b) {
        const ExchangeAreas& rows = areas(b);
        for (std::size_t i = 0; i < n; ++i)
            source[i] = elements_.scatter[i * bands + b] * departure[i * bands + b];
        // An error of the error of 1 % is enough.
        const SolverResult solved =
            solve_gmres({elements_, rows, b, source}, {0.01, options_.solver_iterations});
        const std::vector<double> received = multiply(rows, elements_, solved.radiance);
        for (std::size_t i = 0; i < n; ++i)
            if (const double c = elements_.capacity[i * bands + b]; c > 0.0)
                result[i * bands + b] = received[i] / c;
    }
    return result;
}

ElementValues CoarseSolution::values(const std::vector<double>& incident_direct) const {
    ElementValues values;
    values.elements = elements_;
    values.incident_direct = incident_direct;
    for (std::size_t i = 0; i < elements_.size(); ++i)
        for (std::size_t b = 0; b < elements_.bands; ++b) {
            const std::size_t k = i * elements_.bands + b;
            values.radiance.push_back(reflected_[k] + split_emission(i, b));
            values.incident.push_back(incident_direct[k] + indirect_[k]);
        }
    return values;
}

}  // namespace tyndall::radiosity
