#include "radiosity/place_memory.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tyndall::radiosity {
namespace {

constexpr std::uint32_t empty = 0xffffffffu;

using Place = std::array<double, 6>;

std::uint64_t hash(const double* place) {
    std::uint64_t h = 0;
    for (int k = 0; k < 6; ++k) {
        h = (h ^ std::bit_cast<std::uint64_t>(place[k])) * 0x9e3779b97f4a7c15ull;
        h ^= h >> 29;
    }
    return h;
}

bool same(const double* a, const double* b) {
    return std::memcmp(a, b, 6 * sizeof(double)) == 0;
}

}  // namespace

void PlaceMemory::keep(mesh::Point x, mesh::Direction normal, std::span<const double> values) {
    Entries& entries = kept_.local();
    entries.insert(entries.end(), {x.x, x.y, x.z, normal.x, normal.y, normal.z});
    entries.insert(entries.end(), values.begin(), values.end());
}

void PlaceMemory::settle() {
    for (Entries& entries : kept_) {
        entries_.insert(entries_.end(), entries.begin(), entries.end());
        entries = {};
    }
    const std::size_t stride = 6 + count_, n = entries_.size() / stride;
    const auto less = [stride](const double* a, const double* b) {
        return std::lexicographical_compare(a + 6, a + stride, b + 6, b + stride);
    };
    table_.assign(std::bit_ceil(2 * n + 1), empty);
    for (std::size_t e = 0; e < n; ++e) {
        std::size_t k = hash(&entries_[e * stride]) & (table_.size() - 1);
        while (table_[k] != empty && !same(&entries_[table_[k] * stride], &entries_[e * stride]))
            k = (k + 1) & (table_.size() - 1);
        // Two samples may have been moved to one place, the nearest of a body's surface, and hold
        // what different rays found: whichever thread came first, the lesser is kept.
        if (table_[k] == empty || less(&entries_[e * stride], &entries_[table_[k] * stride]))
            table_[k] = static_cast<std::uint32_t>(e);
    }
}

const double* PlaceMemory::find(mesh::Point x, mesh::Direction normal) const {
    if (table_.empty()) return nullptr;
    const Place place{x.x, x.y, x.z, normal.x, normal.y, normal.z};
    const std::size_t stride = 6 + count_;
    for (std::size_t k = hash(place.data()) & (table_.size() - 1); table_[k] != empty;
         k = (k + 1) & (table_.size() - 1))
        if (const double* entry = &entries_[table_[k] * stride]; same(entry, place.data()))
            return entry + 6;
    return nullptr;
}

}  // namespace tyndall::radiosity
