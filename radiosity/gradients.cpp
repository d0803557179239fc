#include "radiosity/gradients.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <unordered_map>

#include "mesh/fans.h"

namespace tyndall::radiosity {
namespace {

// Of the largest, below which an eigenvalue of the normal matrix says that the neighbours do not
// tell the gradient in its direction.
constexpr double least_eigenvalue = 0.03;

// Elements by the corners they share.
class ElementsAtCorners {
  public:
    ElementsAtCorners(const Enclosure& enclosure, const Forest& forest, const Elements& elements)
        : forest_(forest), fans_(enclosure.mesh) {
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (elements.is_patch(i)) {
                const PatchId patch = elements.patches[i];
                tags_.push_back(side_of(enclosure, forest, patch));
                add(i, forest[patch].corners, [&](VertexId vertex) {
                    return fans_.of_facet_side(forest_.carrier(vertex),
                                               forest_.base_facet_side(patch)) |
                           0x80000000u;
                });
            } else {
                const ZoneId zone = elements.zone(i);
                tags_.push_back(medium_of(enclosure, forest, zone));
                add(i, forest[zone].corners, [&](VertexId vertex) {
                    return fans_.of_tet(forest_.carrier(vertex), forest_.base_tet(zone)).value;
                });
            }
        }
    }

    // The elements that share a corner and a tag with i, without i, ascending.
    void around(std::size_t i, std::vector<std::uint32_t>& neighbours) const {
        neighbours.clear();
        for (std::size_t k = starts_[i]; k < starts_[i + 1]; ++k)
            for (const std::uint32_t n : elements_[corner_[k]])
                if (n != i && tags_[n] == tags_[i]) neighbours.push_back(n);
        std::sort(neighbours.begin(), neighbours.end());
        neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    }

  private:
    template <class Vertices, class Fan>
    void add(std::size_t element, const Vertices& vertices, Fan&& fan) {
        for (const VertexId vertex : vertices) {
            const auto key = std::uint64_t(vertex.value) << 32 | fan(vertex);
            const auto corner =
                ids_.try_emplace(key, static_cast<std::uint32_t>(elements_.size())).first->second;
            if (corner == elements_.size()) elements_.emplace_back();
            elements_[corner].push_back(static_cast<std::uint32_t>(element));
            corner_.push_back(corner);
        }
        starts_.push_back(corner_.size());
    }

    const Forest& forest_;
    mesh::Fans fans_;
    std::unordered_map<std::uint64_t, std::uint32_t> ids_;
    std::vector<std::vector<std::uint32_t>> elements_;  // of a corner
    std::vector<std::size_t> starts_{0};                // of an element, into corner_
    std::vector<std::uint32_t> corner_, tags_;
};

Eigen::Vector3d to_eigen(const Point& p) {
    return {p.x, p.y, p.z};
}

// The inverse of the normal matrix Σ d dᵀ/d², on what its eigenvectors tell.
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& normal) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal);
    const double largest = eigen.eigenvalues()[2];
    Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
        if (eigen.eigenvalues()[k] > least_eigenvalue * largest)
            inverse[k] = 1.0 / eigen.eigenvalues()[k];
    return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

ElementGradients::ElementGradients(const Enclosure& enclosure, const Forest& forest,
                                   const Elements& elements) {
    const ElementsAtCorners corners(enclosure, forest, elements);
    std::vector<Point> centres;
    for (const PatchId patch : elements.patches)
        centres.push_back(centre_of(enclosure, forest, patch));
    for (const ZoneId zone : elements.zones) centres.push_back(centre_of(enclosure, forest, zone));
    starts_.push_back(0);
    std::vector<std::uint32_t> neighbours;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        corners.around(i, neighbours);
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        for (const std::uint32_t n : neighbours) {
            const Eigen::Vector3d d = to_eigen(centres[n] - centres[i]);
            normal += d * d.transpose() / d.squaredNorm();
        }
        const Eigen::Matrix3d inverse = pseudo_inverse(normal);
        for (const std::uint32_t n : neighbours) {
            const Eigen::Vector3d d = to_eigen(centres[n] - centres[i]);
            const Eigen::Vector3d w = inverse * d / d.squaredNorm();
            neighbours_.push_back(n);
            weights_.emplace_back(w.x(), w.y(), w.z());
        }
        starts_.push_back(neighbours_.size());
    }
}

std::size_t ElementGradients::memory() const {
    return starts_.size() * sizeof(std::size_t) +
           neighbours_.size() * (sizeof(std::uint32_t) + sizeof(glm::vec3));
}

std::vector<glm::vec3> ElementGradients::of(std::span<const double> x) const {
    return gradients<glm::vec3>(x);
}

std::vector<Direction> ElementGradients::unrounded(std::span<const double> x) const {
    return gradients<Direction>(x);
}

template <class Vector>
std::vector<Vector> ElementGradients::gradients(std::span<const double> x) const {
    std::vector<Vector> result(x.size());
    tbb::parallel_for(std::size_t(0), x.size(), [&](std::size_t i) {
        Direction sum(0.0);
        for (std::size_t k = starts_[i]; k < starts_[i + 1]; ++k)
            sum += (x[neighbours_[k]] - x[i]) * Direction(weights_[k]);
        result[i] = sum;
    });
    return result;
}

}  // namespace tyndall::radiosity
