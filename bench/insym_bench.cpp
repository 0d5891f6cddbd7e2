// Times of the stages of a detection on one thread, for each input:
//
//   insym_bench --benchmark_filter=cycles --benchmark_repetitions=5
//
// Inputs: connectors of growing size made here, and the models of ../shared where it exists.
#include "insym/detect.hpp"
#include "insym/read_points.hpp"

#include "cycles/detect_cycles.hpp"
#include "points/diameter.hpp"
#include "points/distances.hpp"
#include "points/merge.hpp"
#include "ranking/measure.hpp"
#include "run_monitor.hpp"
#include "scene.hpp"
#include "symmetries/detect_symmetries.hpp"
#ifdef INSYM_WITH_BREP
#include "insym/read_model.hpp"
#endif

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

namespace insym {
namespace {

/// One input, equal points merged, and the tolerance it is searched at.
struct BenchCase {
    std::string name;
    PointSet points;
    double max_tolerance = 1e-4;  ///< share of the diameter
};

PointSet merged(const PointSet& points) {
    return merge_equal_points(points, DetectOptions{}.resolution * diameter(points.positions));
}

/// A scene with all that its stages need, built once for each benchmark.
class Stages {
public:
    explicit Stages(const BenchCase& bench)
        : points_(bench.points),
          distances_(points_.positions),
          scene_(scene(bench)),
          significance_(scene_),
          monitor_(context_) {}

    CycleSearchResult cycles() { return detect_cycles(scene_, {}, monitor_); }
    std::vector<Symmetry> symmetries(const std::vector<Cycle>& cycles) {
        return detect_symmetries(scene_, cycles, TypeSet::all(), 0, monitor_).symmetries;
    }
    Measure measure() const { return {scene_, significance_}; }

private:
    Scene scene(const BenchCase& bench) const {
        const double unit = diameter(points_.positions);
        return {{points_, unit, DetectOptions{}.resolution * unit, bench.max_tolerance * unit}, distances_};
    }

    PointSet points_;
    Distances distances_;
    Scene scene_;
    Significance significance_;
    RunContext context_;
    RunMonitor monitor_;
};

template <class Work>
void on_one_thread(Work&& work) {
    tbb::task_arena arena(1);
    arena.execute(std::forward<Work>(work));
}

void bench_distances(benchmark::State& state, const BenchCase& bench) {
    for (auto _ : state) benchmark::DoNotOptimize(Distances(bench.points.positions));
}

void bench_cycles(benchmark::State& state, const BenchCase& bench) {
    Stages stages(bench);
    CycleSearchResult found;
    on_one_thread([&] {
        for (auto _ : state) found = stages.cycles();
    });
    state.counters["seeds"] = static_cast<double>(found.seeds);
    state.counters["cycles"] = static_cast<double>(found.cycles.size());
}

void bench_symmetries(benchmark::State& state, const BenchCase& bench) {
    Stages stages(bench);
    std::vector<Symmetry> found;
    on_one_thread([&] {
        const std::vector<Cycle> cycles = stages.cycles().cycles;
        for (auto _ : state) found = stages.symmetries(cycles);
    });
    state.counters["symmetries"] = static_cast<double>(found.size());
}

void bench_measure(benchmark::State& state, const BenchCase& bench) {
    Stages stages(bench);
    std::vector<Symmetry> symmetries;
    on_one_thread([&] {
        symmetries = stages.symmetries(stages.cycles().cycles);
        for (auto _ : state) {
            const Measure measure = stages.measure();
            for (Symmetry& symmetry : symmetries) measure.complete(symmetry);
        }
    });
    state.counters["symmetries"] = static_cast<double>(symmetries.size());
}

void bench_detect(benchmark::State& state, const BenchCase& bench, Method method) {
    DetectOptions options;
    options.method = method;
    if (method == Method::paper) options.max_tolerance = bench.max_tolerance;
    RunContext context;
    context.threads = 1;
    for (auto _ : state) benchmark::DoNotOptimize(detect(bench.points, options, context));
}

void bench_paper(benchmark::State& state, const BenchCase& bench) {
    bench_detect(state, bench, Method::paper);
}

void bench_robust(benchmark::State& state, const BenchCase& bench) {
    bench_detect(state, bench, Method::robust);
}

/// Two staggered rows of pins of four corners each: points 8 * pins.
PointSet connector(int pins) {
    PointSet points;
    for (int row = 0; row < 2; ++row)
        for (int pin = 0; pin < pins; ++pin)
            for (int corner = 0; corner < 4; ++corner)
                points.positions.push_back({2.77 * pin + (row == 0 ? 0 : 1.385) + (corner % 2 == 0 ? 0 : 0.9),
                                            2.84 * row + (corner / 2 == 0 ? 0 : 0.6), 0.2 * row});
    return points;
}

std::vector<BenchCase> bench_cases() {
    std::vector<BenchCase> cases;
    for (int pins : {5, 10, 20, 40})
        cases.push_back({"connector" + std::to_string(8 * pins), connector(pins), 1e-4});
    const std::filesystem::path data = std::filesystem::path(INSYM_SHARED_DIR) / "data";
    const auto spinner = data / "spinner4_vertices.xyz";
    if (std::filesystem::exists(spinner)) {
        const PointSet points = merged(read_points_file(spinner.string()).points);
        cases.push_back({"spinner84", points, 1e-4});
        cases.push_back({"spinner84_paper", points, 0.05});
    }
#ifdef INSYM_WITH_BREP
    for (const char* name : {"as1-oc-214.stp", "dsub37.step", "Ventilator.stp"})
        if (std::filesystem::exists(data / name)) {
            const PointSet points = merged(read_model_file((data / name).string()).points);
            cases.push_back(
                {std::filesystem::path(name).stem().string() + std::to_string(points.size()), points, 1e-4});
        }
#endif
    return cases;
}

void register_stages(const BenchCase& bench) {
    const auto add = [&bench](const char* stage, void (*run)(benchmark::State&, const BenchCase&)) {
        benchmark::RegisterBenchmark((std::string(stage) + "/" + bench.name).c_str(), run, bench)
            ->Unit(benchmark::kMillisecond);
    };
    add("distances", bench_distances);
    add("cycles", bench_cycles);
    add("symmetries", bench_symmetries);
    add("measure", bench_measure);
    add("paper", bench_paper);
    add("robust", bench_robust);
}

}  // namespace
}  // namespace insym

int main(int argc, char** argv) {
    for (const insym::BenchCase& bench : insym::bench_cases()) insym::register_stages(bench);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
