// What rows cost with and without level of detail, and what level of detail changes.
//
//   hierarchical_rows [--scene S.toml] [--rays D] [--theta T] [--compare] [--solve] [leaves …]
//
// For every number of leaves (default 1e4, 4e4, 1.6e5, 6.4e5, 1e6) the scene is refined uniformly
// and its rows are made. Prints CPU seconds of the process, entries a row, memory of the rows, peak
// memory of the process, and the growth from size to size: the exponent of time, and the entries a
// row that each fourfold of leaves adds.
// --solve: solves as well. --compare: also without level of detail, and with another seed; prints
// the RMS difference of the solutions that the level of detail makes, and their sampling error,
// which is the RMS difference between two seeds over sqrt 2.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "cli/scene_file.h"
#include "radiosity/coarse_solution.h"
#include "radiosity/direct_light.h"
#include "radiosity/element_mesh.h"
#include "radiosity/exchange_walked.h"
#include "radiosity/resources.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

struct Arguments {
    std::string scene = TYNDALL_SOURCE_DIR "/examples/scenes/window_shafts.toml";
    std::size_t rays = 64;
    double theta = 5.0;
    std::size_t repeats = 1;
    bool compare = false, solve = false;
    std::vector<std::size_t> leaves;
};

Arguments read(int count, char** words) {
    Arguments a;
    for (int k = 1; k < count; ++k) {
        const std::string word = words[k];
        const auto value = [&] { return std::string(k + 1 < count ? words[++k] : "0"); };
        if (word == "--scene")
            a.scene = value();
        else if (word == "--rays")
            a.rays = std::stoul(value());
        else if (word == "--theta")
            a.theta = std::stod(value());
        else if (word == "--repeats")
            a.repeats = std::stoul(value());
        else if (word == "--compare")
            a.compare = true;
        else if (word == "--solve")
            a.solve = true;
        else
            a.leaves.push_back(static_cast<std::size_t>(std::stod(word)));
    }
    if (a.leaves.empty()) a.leaves = {10000, 40000, 160000, 640000, 1000000};
    return a;
}

// H^A of every element, at its centroid.
std::vector<double> direct_at_centroids(const Enclosure& enclosure, const Forest& forest,
                                        const Elements& e) {
    const DirectLight light(enclosure);
    std::vector<double> incident(e.size() * e.bands);
    tbb::parallel_for(std::size_t(0), e.size(), [&](std::size_t i) {
        const std::span<double> out(incident.data() + i * e.bands, e.bands);
        if (e.is_patch(i)) {
            const PatchId p = e.patches[i];
            const auto side = forest.base_facet_side(p);
            const auto start = mesh::start_on(enclosure.mesh, FacetId(side / 2),
                                              side % 2 ? Side::back : Side::front);
            light.at_patch(forest.centroid(p), normal_of(forest, p), start.tet, out);
        } else {
            light.at_zone(forest.centroid(e.zone(i)), forest.base_tet(e.zone(i)), out);
        }
    });
    return incident;
}

// RMS of a − b over the RMS of a, weighed by capacity, band 0.
double difference(const CoarseSolution& a, const CoarseSolution& b) {
    const Elements& e = a.elements();
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < e.size(); ++i) {
        const double capacity = e.capacity[i * e.bands], r = a.reflected(i, 0);
        above += capacity * std::pow(r - b.reflected(i, 0), 2);
        below += capacity * r * r;
    }
    return std::sqrt(above / below);
}

struct Growth {
    double leaves = 0.0, seconds = 0.0, entries = 0.0;
};

class Runner {
  public:
    explicit Runner(const Arguments& arguments)
        : a_(arguments),
          enclosure_(make_enclosure(cli::read_scene_file(a_.scene).scene)),
          mesh_(enclosure_) {}

    void run() {
        std::printf("%zu rays, theta = %g\n", a_.rays, a_.theta);
        std::printf("%9s %9s %9s %9s %11s %9s %9s %9s %9s\n", "leaves", "patches", "zones", "cpu s",
                    "entries/row", "rows MB", "peak MB", "exponent", "per x4");
        double size = 2.0 * glm::distance(enclosure_.mesh.hull_min, enclosure_.mesh.hull_max);
        for (const std::size_t target : a_.leaves) {
            for (; mesh_.leaf_count() < target; size *= 0.99)
                mesh_.refine_to({size, target, target});
            if (a_.compare)
                compare();
            else
                measure();
        }
    }

  private:
    SolveOptions options(double theta, std::uint64_t seed) const {
        return {.rays = a_.rays, .row_detail = theta, .seed = seed};
    }

    void measure() {
        const Elements e = elements_of_leaves(enclosure_, mesh_.forest());
        Growth now{static_cast<double>(e.size()), 1e300, 0.0};
        double bytes = 0.0;
        for (std::size_t k = 0; k < a_.repeats; ++k) {
            const double began = cpu_seconds();
            const auto rows = all_rows(exchange_walked, {enclosure_, mesh_.forest(), e},
                                       {.rays = a_.rays, .detail = a_.theta, .progress = {}});
            now.seconds = std::min(now.seconds, cpu_seconds() - began);
            now.entries = static_cast<double>(rows.columns.size()) / now.leaves;
            bytes = static_cast<double>(rows.memory());
        }
        std::printf("%9zu %9zu %9zu %9.2f %11.1f %9.0f %9.0f", e.size(), e.patches.size(),
                    e.zones.size(), now.seconds, now.entries, bytes * 1e-6,
                    static_cast<double>(peak_memory_bytes()) * 1e-6);
        if (last_.leaves > 0.0) {
            const double grown = std::log(now.leaves / last_.leaves);
            std::printf(" %9.3f %9.1f", std::log(now.seconds / last_.seconds) / grown,
                        (now.entries - last_.entries) / (grown / std::log(4.0)));
        }
        std::printf("\n");
        last_ = now;
        if (a_.solve) {
            const double began = cpu_seconds();
            const auto coarse = solved(a_.theta, 1);
            std::printf(
                "  solved: %zu iterations, residual %.1e, %.1f cpu s with rows and direct "
                "light, peak %.0f MB\n",
                coarse->report().iterations, coarse->report().residual, cpu_seconds() - began,
                static_cast<double>(peak_memory_bytes()) * 1e-6);
        }
        std::fflush(stdout);
    }

    std::unique_ptr<CoarseSolution> solved(double theta, std::uint64_t seed) const {
        auto coarse = std::make_unique<CoarseSolution>(enclosure_, mesh_.forest(),
                                                       options(theta, seed), ProgressCallback());
        coarse->solve(direct_at_centroids(enclosure_, mesh_.forest(), coarse->elements()));
        return coarse;
    }

    void compare() const {
        const auto with = solved(a_.theta, 1), without = solved(0.0, 1), other = solved(0.0, 2);
        const double detail = difference(*without, *with);
        const double noise = difference(*without, *other) / std::sqrt(2.0);
        std::printf(
            "%9zu leaves: level of detail changes the solution by %.3e, its sampling error "
            "is %.3e: ratio %.2f\n",
            with->elements().size(), detail, noise, detail / noise);
        std::fflush(stdout);
    }

    Arguments a_;
    Enclosure enclosure_;
    ElementMesh mesh_;
    Growth last_;
};

}  // namespace

int main(int count, char** words) {
    try {
        Runner(read(count, words)).run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
