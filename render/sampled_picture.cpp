#include "render/sampled_picture.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>

#include "render/eye.h"

namespace tyndall::render {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_batches = std::size_t{1} << 20;
constexpr std::size_t first_batches = 8;  // of a picture with a goal

// Sums over the batches of every pixel.
class Rounds {
  public:
    Rounds(const Camera& camera, std::size_t bands, const RenderOptions& options,
           const SampledPictureOptions& how, const Sampler& sampler,
           const radiosity::ProgressCallback& progress)
        : camera_(camera),
          rays_(camera),
          bands_(bands),
          options_(options),
          how_(how),
          sampler_(sampler),
          points_(how.batch),
          progress_(progress),
          began_(Clock::now()),
          batches_(camera.height, 0) {
        const std::size_t pixels = camera.width * camera.height;
        parts_.resize(pixels * (part_count + 1) * bands);
        squares_.resize(pixels * bands);
        depth_.resize(pixels, std::numeric_limits<float>::infinity());
    }

    void run() {
        if (!(options_.error > 0.0) && !(options_.time > 0.0)) {
            const std::size_t samples = std::max<std::size_t>(options_.samples, 1);
            round(std::max<std::size_t>((samples + how_.batch - 1) / how_.batch, 2));
            return;
        }
        round(first_batches);
        while (!stopped_ && !out_of_time() && done_ < most_batches) {
            const double now = last_error_ = block4();
            if (options_.error > 0.0 && now <= options_.error) return;
            const double wanted = options_.error > 0.0
                                      ? double(done_) * std::pow(now / options_.error, 2) * 1.02
                                      : 2.0 * double(done_);
            // At most three times as many again: the estimate of few samples is no good.
            const double more = std::clamp(wanted - double(done_), 1.0, 3.0 * double(done_));
            round(std::size_t(std::ceil(std::min(more, double(most_batches - done_)))));
        }
    }

    Image image() const {
        Image image;
        image.width = camera_.width;
        image.height = camera_.height;
        image.samples = done_ * how_.batch;
        image.estimated_block4 = block4();
        const auto add = [&](const char* name, std::size_t channels) {
            image.layers.push_back(
                {name, channels, std::vector<float>(image.width * image.height * channels)});
            return image.layers.size() - 1;
        };
        const std::size_t beauty = add("beauty", bands_);
        std::vector<std::size_t> layer(part_count + 1, beauty);
        for (std::size_t p = 0; p < part_count; ++p)
            if (p != specular_reflection || how_.specular) layer[p] = add(part_names[p], bands_);
        layer[part_count] = add("transmittance", bands_);
        const std::size_t depth = add("depth", 1), error = add("error", bands_);
        for (std::size_t pixel = 0; pixel < depth_.size(); ++pixel) {
            const double n = double(batches_of(pixel) * how_.batch);
            for (std::size_t b = 0; b < bands_; ++b) {
                const std::size_t value = pixel * bands_ + b;
                double sum = 0.0;
                for (std::size_t p = 0; p <= part_count; ++p) {
                    double mean = part(pixel, p, b) / n;
                    // What corrects a solution may take more than there is, by its noise.
                    if (p == single_scattering) mean = std::max(0.0, mean);
                    if (p < part_count) sum += mean;
                    if (layer[p] != beauty) image.layers[layer[p]].values[value] = float(mean);
                }
                image.layers[beauty].values[value] = float(sum);
                image.layers[error].values[value] = float(std::sqrt(variance(pixel, b)));
            }
            image.layers[depth].values[pixel] = depth_[pixel];
        }
        return image;
    }

  private:
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
    bool out_of_time() const { return options_.time > 0.0 && elapsed() >= options_.time; }

    std::size_t batches_of(std::size_t pixel) const {
        return std::max<std::size_t>(batches_[pixel / camera_.width], 1);
    }
    double part(std::size_t pixel, std::size_t p, std::size_t band) const {
        return parts_[(pixel * (part_count + 1) + p) * bands_ + band];
    }
    double sum_of(std::size_t pixel, std::size_t band) const {
        double sum = 0.0;
        for (std::size_t p = 0; p < part_count; ++p) sum += part(pixel, p, band);
        return sum;
    }
    // Of a pixel's mean: that of the means of its batches, over their number.
    double variance(std::size_t pixel, std::size_t band) const {
        const double n = double(batches_of(pixel));
        if (n < 2.0) return 0.0;
        const double mean = sum_of(pixel, band) / double(how_.batch) / n;
        const double square = squares_[pixel * bands_ + band] / n;
        return std::max(0.0, square - mean * mean) / (n - 1.0);
    }

    double block4() const {
        double error = 0.0, sum = 0.0;
        for (std::size_t pixel = 0; pixel < depth_.size(); ++pixel)
            for (std::size_t b = 0; b < bands_; ++b) {
                error += variance(pixel, b);
                sum += sum_of(pixel, b) / double(batches_of(pixel) * how_.batch);
            }
        const double count = double(depth_.size() * bands_);
        return sum > 0.0 ? std::sqrt(error / count / 16.0) / (sum / count) : 0.0;  // (55)
    }

    // So many batches more in every row, but for those that the time does not suffice for.
    void round(std::size_t batches) {
        const std::size_t first = done_;
        std::atomic<std::size_t> rows_done = 0;
        std::atomic<bool> stop = false;
        tbb::parallel_for(std::size_t(0), camera_.height, [&](std::size_t y) {
            if (stop || (first > 0 && out_of_time())) return;
            for (std::size_t x = 0; x < camera_.width; ++x) add(x, y, first, batches);
            batches_[y] += batches;
            const std::size_t rows = ++rows_done;
            if (!tell(double(rows) / double(camera_.height))) stop = true;
        });
        done_ += batches;
        stopped_ = stop;
    }

    void add(std::size_t x, std::size_t y, std::size_t first, std::size_t batches) {
        const std::size_t pixel = y * camera_.width + x;
        const std::uint64_t own = radiosity::hash_seed(options_.seed, pixel);
        thread_local Seen seen;
        thread_local std::vector<double> sums, mean;
        sums.assign((part_count + 1) * bands_, 0.0);
        for (std::size_t k = first; k < first + batches; ++k) {
            const std::uint64_t seed = radiosity::hash_seed(own, k);
            mean.assign(bands_, 0.0);
            for (std::size_t n = 0; n < how_.batch; ++n) {
                RandomNumbers random(seed, n);
                const auto u = points_(n, seed);
                seen.clear(bands_);
                glm::dvec2 lens(0.5);
                if (camera_.lens) lens = {random(), random()};
                sampler_(rays_(double(x) + u[0], double(y) + u[1], lens), {seed, n}, random, seen);
                for (std::size_t i = 0; i < part_count * bands_; ++i) {
                    sums[i] += seen.radiance[i];
                    mean[i % bands_] += seen.radiance[i];
                }
                for (std::size_t b = 0; b < bands_; ++b)
                    sums[part_count * bands_ + b] += seen.transmittance[b];
                depth_[pixel] = std::min(depth_[pixel], float(seen.depth));
            }
            for (std::size_t b = 0; b < bands_; ++b) {
                const double m = mean[b] / double(how_.batch);
                squares_[pixel * bands_ + b] += m * m;
            }
        }
        double* to = &parts_[pixel * (part_count + 1) * bands_];
        for (std::size_t i = 0; i < sums.size(); ++i) to[i] += sums[i];
    }

    // How far it is: by the goal that is nearest.
    bool tell(double of_round) {
        if (!progress_) return true;
        const std::lock_guard lock(mutex_);
        double fraction = of_round;
        if (options_.error > 0.0 || options_.time > 0.0) {
            fraction = options_.time > 0.0 ? elapsed() / options_.time : 0.0;
            if (last_error_ > 0.0)
                fraction = std::max(fraction, std::pow(options_.error / last_error_, 2));
        }
        return progress_({"picture", std::min(1.0, fraction), 0, 0.0});
    }

    const Camera& camera_;
    CameraRays rays_;
    std::size_t bands_;
    const RenderOptions& options_;
    const SampledPictureOptions& how_;
    const Sampler& sampler_;
    radiosity::PointSet points_;
    const radiosity::ProgressCallback& progress_;
    Clock::time_point began_;
    std::vector<std::size_t> batches_;  // of each row
    std::vector<double> parts_;         // sums: [(pixel * (parts + transmittance)) * bands + band]
    std::vector<double> squares_;       // of the means of batches: [pixel * bands + band]
    std::vector<float> depth_;
    std::size_t done_ = 0;
    double last_error_ = 0.0;  // before this round
    bool stopped_ = false;
    std::mutex mutex_;
};

}  // namespace

Image sampled_picture(const radiosity::Enclosure& enclosure, const Camera& camera,
                      const RenderOptions& options, const SampledPictureOptions& how,
                      const Sampler& sampler, const radiosity::ProgressCallback& progress) {
    tet_of_eye(enclosure, camera);  // refuses solids
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    Rounds rounds(camera, enclosure.bands, options, how, sampler, progress);
    rounds.run();
    return rounds.image();
}

}  // namespace tyndall::render
