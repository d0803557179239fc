// A product of all rows with a vector, which solvers spend their time on: window_shafts.toml,
// refined uniformly, elements that hold constants and linear ones. Time an entry.
#include <benchmark/benchmark.h>

#include "cli/scene_file.h"
#include "radiosity/element_mesh.h"
#include "radiosity/exchange_walked.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

void products(benchmark::State& state, Radiance radiance) {
    const cli::SceneFile file =
        cli::read_scene_file(TYNDALL_SOURCE_DIR "/examples/scenes/window_shafts.toml");
    const Enclosure enclosure = make_enclosure(file.scene);
    ElementMesh mesh(enclosure);
    const auto target = static_cast<std::size_t>(state.range(0));
    for (double size = 2.0; mesh.leaf_count() < target; size *= 0.97)
        mesh.refine_to({size, target, target});
    const Elements elements = elements_of_leaves(enclosure, mesh.forest());
    const ExchangeAreas areas = all_rows(exchange_walked, {enclosure, mesh.forest(), elements},
                                         {.rays = 128, .radiance = radiance});
    std::vector<double> x(elements.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.5 * double(i % 7);
    for (auto _ : state) benchmark::DoNotOptimize(multiply(areas, elements, x));
    state.counters["entries"] = double(areas.columns.size());
    state.counters["per_entry"] =
        benchmark::Counter(double(areas.columns.size()) * double(state.iterations()),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(products, constant, Radiance::constant)
    ->Arg(6000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(products, linear, Radiance::linear)
    ->Arg(6000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
