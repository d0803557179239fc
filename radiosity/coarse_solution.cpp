#include "radiosity/coarse_solution.h"

#include <algorithm>
#include <limits>

#include "radiosity/exchange_methods.h"
#include "radiosity/solvers.h"

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
                               const SolveOptions& options, const ProgressCallback& progress,
                               const KeptRows* kept, std::shared_ptr<const RowSet> made)
    : enclosure_(enclosure),
      forest_(forest),
      options_(options),
      progress_(progress),
      elements_(std::move(elements)),
      settled_(enclosure, forest, elements_) {
    const NamedExchangeMethod& method = exchange_method(options.exchange);
    require_settings(method, options.exchange_settings);
    require_media(method, enclosure);
    require_mirrors(method, enclosure);
    check_solver(options);
    check_solver_size(solver_named(options.solver), elements_.size());
    if (on_the_fly()) at_first_ = forest;
    if (kept) guess_.assign(kept->sent.begin(), kept->sent.end());
    std::vector<std::size_t> distinct;  // bands that have rows of their own
    for (std::size_t band = 0; band < enclosure.bands; ++band) {
        const std::size_t same = first_of_extinction(enclosure, band);
        matrix_.push_back(same < band ? matrix_[same] : distinct.size());
        if (same == band) distinct.push_back(band);
    }
    auto rows = std::make_shared<RowSet>();
    rows_ = made ? std::move(made) : rows;
    lost_rays_ = rows_->lost_rays;
    if (on_the_fly()) {
        rows->areas.resize(distinct.size());
        closure_.resize(distinct.size(), 0.0);
        for (const std::size_t band : distinct) find_outside(band);
    } else if (rows_ == rows) {
        make_areas(distinct, kept, *rows);
    }
    if (enclosure.has_mirrors() && rows_ == rows) make_in_mirrors(distinct, *rows);
    rows->lost_rays = lost_rays_;
    for (const ExchangeAreas& areas : rows_->areas) {
        if (on_the_fly()) break;  // find_outside
        auto& outside = outside_.emplace_back();
        for (std::size_t i = 0; i < elements_.size(); ++i)
            outside.push_back(radiosity::to_outside(areas, elements_, i));
    }
}

double CoarseSolution::to_outside(std::size_t element, std::size_t band) const {
    const auto& outside = outside_[matrix_[band]];
    return outside.empty() ? 0.0 : outside[element];
}

double CoarseSolution::closure_error(std::size_t band) const {
    return on_the_fly() ? closure_[matrix_[band]]
                        : radiosity::closure_error(areas(band), elements_, band);
}

double CoarseSolution::reciprocity_error(std::size_t band) const {
    return on_the_fly() ? std::numeric_limits<double>::quiet_NaN()
                        : radiosity::reciprocity_error(areas(band), elements_);
}

SolverResult CoarseSolution::solve_band(std::size_t band, std::span<const double> source,
                                        const NamedSolver& solver,
                                        const SolverOptions& options) const {
    LinearProblem problem{elements_, areas(band), band, source};
    problem.outside = outside_[matrix_[band]];
    if (on_the_fly()) {
        problem.rows = [this, band](std::span<const ElementId> rows, const RowSink& sink) {
            make_rows(band, rows, sink);
        };
    }
    SolverOptions chosen = options;
    // On kept rows a solver is done before a stop is worth what it costs the solution.
    chosen.progress = [this](const Progress& now) {
        return radiosity::report(progress_, now) || !on_the_fly();
    };
    return solver.solver(problem, chosen);
}

// The worst of bands.
void CoarseSolution::add_to_report(const SolverResult& result, SolverReport& report) {
    report.iterations = std::max(report.iterations, result.iterations);
    report.shots += result.shots;
    report.residual = std::max(report.residual, result.residual);
    report.converged = report.converged && result.converged;
    if (!result.history.empty()) report.unshot_power += result.history.back().unshot_power;
    report.history.insert(report.history.end(), result.history.begin(), result.history.end());
}

std::vector<Affine> CoarseSolution::linear_indirect() const {
    const std::size_t bands = elements_.bands, n = elements_.size();
    std::vector<Affine> result(n * bands);
    for (std::size_t k = 0; k < result.size(); ++k) result[k].constant = solved_.indirect[k];
    if (options_.radiance == Radiance::constant || !elements_.member_starts.empty()) return result;
    const auto& of_rows = rows_->areas[0].gradients;
    const auto gradients =
        of_rows ? of_rows
                : std::make_shared<const ElementGradients>(enclosure_, forest_, elements_);
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
    std::size_t bytes = elements_.capacity.size() * 3 * sizeof(double) + at_first_.memory();
    for (const auto& outside : outside_) bytes += outside.size() * sizeof(double);
    return bytes + rows_->memory();
}

double CoarseSolution::mean_square() const {
    double square = 0.0, capacity = 0.0;
    for (std::size_t k = 0; k < elements_.capacity.size(); ++k) {
        const double x = solved_.reflected[k];
        square += elements_.capacity[k] * x * x;
        capacity += elements_.capacity[k];
    }
    return capacity > 0.0 ? square / capacity : 0.0;
}

double CoarseSolution::split_emission(std::size_t element, std::size_t band) const {
    if (!elements_.is_patch(element) || options_.direct_light != DirectLightMode::closed_form)
        return 0.0;
    const auto side = side_of(enclosure_, forest_, elements_.patches[element]);
    return shines(enclosure_.sides[side]) ? elements_.emission[element * elements_.bands + band]
                                          : 0.0;
}

// H of every element by way of mirrors, from what patches send [W/m^2/sr].
std::vector<double> CoarseSolution::in_mirrors(std::span<const double> sent,
                                               std::size_t band) const {
    std::vector<double> incident = multiply(rows_->in_mirrors[matrix_[band]], elements_, sent);
    for (std::size_t i = 0; i < incident.size(); ++i)
        if (const double c = elements_.capacity[i * elements_.bands + band]; c > 0.0)
            incident[i] /= c;
    return incident;
}

// The factor that makes what arrives from lit patches as much as they send to elements, which their
// rows know well: few points an element miss some of it in corners. `in_mirrors`: so, if any does.
double CoarseSolution::lit_scale(const std::vector<double>& incident_direct,
                                 const std::vector<double>& incident_lit,
                                 std::span<const double> in_mirrors, std::size_t band) const {
    double sent = 0.0, arrived = 0.0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        const std::size_t k = i * elements_.bands + band;
        arrived += elements_.capacity[k] * incident_lit[k];
        if (!in_mirrors.empty()) sent -= elements_.capacity[k] * in_mirrors[i];
        if (elements_.is_patch(i))
            sent += elements_.scatter[k] * incident_direct[k] *
                    (elements_.capacity[k] - to_outside(i, band));
    }
    return arrived > 0.0 ? sent / arrived : 1.0;
}

// H of every element from what is not left to the rows: lit patches, if they are looked at apart,
// and by way of mirrors they and emitters that direct light counts.
std::vector<double> CoarseSolution::arrived_apart(std::size_t b,
                                                  const std::vector<double>& incident_direct,
                                                  const std::vector<double>& incident_lit) const {
    const bool apart = !incident_lit.empty();
    const std::size_t bands = elements_.bands, n = elements_.size();
    std::vector<double> arrived(n, 0.0), sent(n, 0.0), mirrored;
    if (!rows_->in_mirrors.empty() && apart) {
        for (std::size_t i = 0; i < elements_.patches.size(); ++i)
            sent[i] = elements_.scatter[i * bands + b] * incident_direct[i * bands + b];
        mirrored = in_mirrors(sent, b);
    }
    if (apart) {
        const double scale = lit_scale(incident_direct, incident_lit, mirrored, b);
        for (std::size_t i = 0; i < n; ++i) arrived[i] = scale * incident_lit[i * bands + b];
    }
    if (rows_->in_mirrors.empty()) return arrived;
    for (std::size_t i = 0; i < n; ++i) sent[i] += split_emission(i, b);
    mirrored = in_mirrors(sent, b);
    for (std::size_t i = 0; i < n; ++i) arrived[i] += mirrored[i];
    return arrived;
}

void CoarseSolution::solve(const std::vector<double>& incident_direct,
                           const std::vector<double>& incident_lit) {
    if (settled_.empty()) return solve_bands(incident_direct, incident_lit);
    const auto incident = [&] {
        solve_bands(incident_direct, incident_lit);
        std::vector<double> result = incident_direct;
        for (std::size_t k = 0; k < result.size(); ++k) result[k] += solved_.indirect[k];
        return result;
    };
    // What a band's solve leaves is no less than its own tolerance.
    const SettleResult settled =
        settled_.settle(incident, {3.0 * options_.solver_tolerance, options_.solver_iterations});
    SolverReport& report = solved_.report;
    report.residual = std::max(report.residual, settled.residual);
    report.converged = report.converged && settled.converged;
    report.iterations = std::max(report.iterations, settled.iterations);
}

void CoarseSolution::solve_bands(const std::vector<double>& incident_direct,
                                 const std::vector<double>& incident_lit) {
    Solved solved;
    for (auto* values : {&solved.indirect, &solved.reflected, &solved.by_rows})
        values->assign(elements_.size() * elements_.bands, 0.0);
    solved.report.method = solver_named(options_.solver).name;
    solved.report.converged = true;
    bool stopped = false;
    for (std::size_t b = 0; b < elements_.bands; ++b)
        stopped = !add_band(b, incident_direct, incident_lit, solved) || stopped;
    if (stopped && !solved_.indirect.empty()) return;
    solved_ = std::move(solved);
}

// False if it was stopped.
bool CoarseSolution::add_band(std::size_t b, const std::vector<double>& incident_direct,
                              const std::vector<double>& incident_lit, Solved& solved) const {
    const bool apart = !incident_lit.empty();
    const std::size_t bands = elements_.bands, n = elements_.size();
    std::vector<double> source(n), from_outside(n, 0.0);
    const std::vector<double> arrived = arrived_apart(b, incident_direct, incident_lit);
    for (std::size_t i = 0; i < n; ++i) {
        const double capacity = elements_.capacity[i * bands + b];
        if (capacity > 0.0)
            from_outside[i] = to_outside(i, b) / capacity * enclosure_.environment[b];
        const double sent = apart && elements_.is_patch(i) ? 0.0 : incident_direct[i * bands + b];
        source[i] = emission(i, b) - split_emission(i, b) +
                    elements_.scatter[i * bands + b] * (sent + arrived[i] + from_outside[i]);
    }
    std::vector<double> guess;
    for (std::size_t i = 0; i < n && !guess_.empty(); ++i) guess.push_back(guess_[i * bands + b]);
    const SolverResult result = solve_band(b, source, solver_named(options_.solver),
                                           {.tolerance = options_.solver_tolerance,
                                            .iterations = options_.solver_iterations,
                                            .over_relaxation = options_.over_relaxation,
                                            .overshooting = options_.overshooting,
                                            .ambient = options_.ambient,
                                            .balance = guess_.empty() || options_.solver != "gmres",
                                            .guess = guess});
    add_to_report(result, solved.report);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = i * bands + b;
        const double c = elements_.capacity[k];
        if (c > 0.0) solved.by_rows[k] = result.received[i] / c + from_outside[i];
        if (c > 0.0) solved.indirect[k] = solved.by_rows[k] + arrived[i];
        solved.reflected[k] = result.radiance[i];
        if (apart && elements_.is_patch(i))
            solved.reflected[k] += elements_.scatter[k] * incident_direct[k];
    }
    return !result.stopped;
}

std::vector<double> CoarseSolution::carried(const std::vector<double>& departure) const {
    const std::size_t bands = elements_.bands, n = elements_.size();
    std::vector<double> result(n * bands, 0.0), source(n);
    for (std::size_t b = 0; b < bands; ++b) {
        for (std::size_t i = 0; i < n; ++i)
            source[i] = elements_.scatter[i * bands + b] * departure[i * bands + b];
        // An error of the error of 1 % is enough. By GMRES, whatever solves for the light: the same
        // residual of another solver may be another error.
        const SolverResult solved =
            solve_band(b, source, solver_named(on_the_fly() ? options_.solver : "gmres"),
                       {.tolerance = 0.01,
                        .iterations = options_.solver_iterations,
                        .overshooting = on_the_fly() && options_.overshooting,
                        .ambient = on_the_fly(),
                        .balance = false});
        for (std::size_t i = 0; i < n; ++i)
            if (const double c = elements_.capacity[i * bands + b]; c > 0.0)
                result[i * bands + b] = solved.received[i] / c;
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
            values.elements.emission[k] = emission(i, b);
            values.radiance.push_back(solved_.reflected[k] + split_emission(i, b));
            values.incident.push_back(incident_direct[k] + solved_.indirect[k]);
        }
    return values;
}

}  // namespace tyndall::radiosity
