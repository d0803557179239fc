// Rows of walked exchange areas after bodies have moved: rays that meet them neither before nor now
// are kept.
#pragma once

#include <atomic>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Rows as they were before, and what they were made of.
struct RowsBefore {
    Discretization discretization;
    const ExchangeAreas& areas;
    std::span<const glm::vec3> directions;  // ray_directions, by the same options
};

// Purpose: the directions of the rays that exchange_walked makes rows of, unit vectors in single
//   precision ([element * rays + ray]) [-], which tell of most that they meet no body.
// Cost: the start of every ray; 12 bytes each.
std::vector<glm::vec3> ray_directions(const Discretization& discretization,
                                      const ExchangeOptions& options);

// Purpose: the rows that exchange_walked makes of `now`. Every ray has its own number in its row's
//   point set, so that it is the same ray before and now unless its element has moved:
//     S_ij = S_ij⁰ + c_i/D Σ_{rays that meet a body's sphere before or now} (w_j − w_j⁰) (48)
//   with w of (21): "negative energy" takes away what such a ray left behind the body, and all of
//   its new way is added. Rows of bodies, and of elements that one covers in part, are walked anew.
// Valid for: enclosures that differ in the places of their bodies alone; elements the same, of the
//   forest's leaves; the same rays, seed, point set and radiance; no level of detail, no
//   interaction radius, no smoothing.
// Error: that of the single precision in which rows are kept: 1e-7 of a row, each time from the
//   same rows before, so that nothing adds up.
// Cost: a look at the direction of every ray (in zones of media that vary, its start), the start of
//   those that may meet a sphere, and two walks for those that do; `walked` counts these. Memory:
//   the rows, and 36 bytes an entry that changes.
// Source: Chen (1990), Incremental Radiosity, whose negative shots are of surfaces.
ExchangeAreas moved_rows(const Discretization& now, const RowsBefore& before,
                         const ExchangeOptions& options, std::atomic<std::size_t>& walked);

}  // namespace tyndall::radiosity
