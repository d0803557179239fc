#include "radiosity/settled_emission.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;
constexpr std::size_t mixed_steps = 10;

double volume_of(const Forest& forest, const Elements& e, std::size_t element) {
    double volume = 0.0;
    for (const auto member : e.members_of(element)) volume += forest.volume(ZoneId(member));
    return volume;
}

// Anderson's mixing: the next point from the last ones and what the map made of them.
class Mixing {
  public:
    Eigen::VectorXd next(const Eigen::VectorXd& at, const Eigen::VectorXd& image) {
        const Eigen::VectorXd residual = image - at;
        if (images_.size() > 0) {
            image_steps_.push_back(image - images_);
            residual_steps_.push_back(residual - residuals_);
        }
        if (image_steps_.size() > mixed_steps) {
            image_steps_.pop_front();
            residual_steps_.pop_front();
        }
        images_ = image;
        residuals_ = residual;
        if (image_steps_.empty()) return image;
        const auto steps = static_cast<Eigen::Index>(image_steps_.size());
        Eigen::MatrixXd matrix(residual.size(), steps);
        for (Eigen::Index k = 0; k < steps; ++k)
            matrix.col(k) = residual_steps_[static_cast<std::size_t>(k)];
        const Eigen::VectorXd share = matrix.colPivHouseholderQr().solve(residual);
        Eigen::VectorXd result = image;
        for (Eigen::Index k = 0; k < steps; ++k)
            result -= share[k] * image_steps_[static_cast<std::size_t>(k)];
        return result;
    }

  private:
    Eigen::VectorXd images_, residuals_;
    std::deque<Eigen::VectorXd> image_steps_, residual_steps_;
};

}  // namespace

SettledEmission::SettledEmission(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& elements)
    : model_(enclosure.spectral), bands_(enclosure.bands) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (elements.is_patch(i)) {
            const auto& side = enclosure.sides[side_of(enclosure, forest, elements.patches[i])];
            if (!side.settled_flux) continue;
            absorbs_.insert(absorbs_.end(), side.emissivity.begin(), side.emissivity.end());
            per_.insert(per_.end(), bands_, 1.0);
            source_.push_back(*side.settled_flux / pi);
            weights_.push_back(elements.capacity[i * bands_]);
        } else {
            const auto& medium = enclosure.media[medium_of(enclosure, forest, elements.zone(i))];
            if (!medium.settled_heat) continue;
            absorbs_.insert(absorbs_.end(), medium.absorption.begin(), medium.absorption.end());
            per_.insert(per_.end(), medium.extinction.begin(), medium.extinction.end());
            source_.push_back(*medium.settled_heat / (4.0 * pi));
            weights_.push_back(4.0 * volume_of(forest, elements, i));
        }
        elements_.push_back(i);
    }
    if (elements_.empty()) return;
    taken_ = source_;
    emission_.assign(elements.size() * bands_, 0.0);
    heat_.assign(elements.size(), 0.0);
    for (std::size_t k = 0; k < elements_.size(); ++k)
        heat_[elements_[k]] = pi * weights_[k] * source_[k];
}

void SettledEmission::emit(const std::vector<double>& taken) {
    for (std::size_t k = 0; k < elements_.size(); ++k) {
        const std::span absorbs(&absorbs_[k * bands_], bands_);
        double* emission = &emission_[elements_[k] * bands_];
        std::fill(emission, emission + bands_, 0.0);
        const double t = temperature_of(model_, absorbs, std::max(0.0, taken[k]));
        if (!(t > 0.0)) continue;
        const double all = stefan_boltzmann * std::pow(t, 4) / pi;
        for (std::size_t b = 0; b < bands_; ++b)
            if (absorbs[b] > 0.0)
                emission[b] = absorbs[b] * black_share(model_, b, t) * all / per_[k * bands_ + b];
    }
}

std::vector<double> SettledEmission::taken(const std::vector<double>& incident) const {
    std::vector<double> result = source_;
    for (std::size_t k = 0; k < elements_.size(); ++k)
        for (std::size_t b = 0; b < bands_; ++b)
            result[k] += absorbs_[k * bands_ + b] * incident[elements_[k] * bands_ + b];
    return result;
}

SettleResult SettledEmission::settle(const Incident& incident, const SettleOptions& options) {
    const auto n = static_cast<Eigen::Index>(elements_.size());
    Eigen::VectorXd scale(n);
    for (Eigen::Index k = 0; k < n; ++k)
        scale[k] = std::sqrt(weights_[static_cast<std::size_t>(k)]);
    const auto scaled = [&](const std::vector<double>& values) {
        return Eigen::VectorXd(
            Eigen::Map<const Eigen::VectorXd>(values.data(), n).cwiseProduct(scale));
    };
    Mixing mixing;
    SettleResult result;
    for (;;) {
        emit(taken_);
        const std::vector<double> image = taken(incident());
        ++result.iterations;
        const Eigen::VectorXd at = scaled(taken_), to = scaled(image);
        const double size = to.norm();
        result.residual = size > 0.0 ? (to - at).norm() / size : 0.0;
        result.converged = result.residual <= options.tolerance;
        if (result.converged || result.iterations >= options.iterations) return result;
        const Eigen::VectorXd next = mixing.next(at, to).cwiseQuotient(scale);
        std::copy(next.begin(), next.end(), taken_.begin());
    }
}

}  // namespace tyndall::radiosity
