// Values at places, found again by the bits of the place: what has been computed in one scene and
// still holds in another.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

// A place is a point, and the normal of the side of a surface it lies on (0: in a medium). Of a
// place that is kept with different values the least are found, in lexicographic order, so that it
// does not matter who keeps it first.
class PlaceMemory {
  public:
    // `values`: a place.
    explicit PlaceMemory(std::size_t values) : count_(values) {}

    // Thread-safe. Is not found before `settle`.
    void keep(mesh::Point x, mesh::Direction normal, std::span<const double> values);
    // Makes all that has been kept ready to be found. Cost: O(places).
    void settle();
    // Null where there is none. Thread-safe.
    const double* find(mesh::Point x, mesh::Direction normal) const;

    std::size_t places() const { return count_ == 0 ? 0 : entries_.size() / (6 + count_); }
    std::size_t memory() const {
        return entries_.size() * sizeof(double) + table_.size() * sizeof(std::uint32_t);
    }

  private:
    using Entries = std::vector<double>;  // x, normal, values; one after the other

    std::size_t count_;
    tbb::enumerable_thread_specific<Entries> kept_;
    Entries entries_;
    std::vector<std::uint32_t> table_;  // of entries, by hash; open addressing
};

}  // namespace tyndall::radiosity
