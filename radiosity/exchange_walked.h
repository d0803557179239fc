// Exchange areas by walking rays: the default method.
#pragma once

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Purpose: row i from `rays` walks that start at points and directions of element i
// (cosine-weighted
//   from a patch, uniform from a zone). Each deposits what it loses in every zone it crosses, and
//   the rest in the patch it ends on, or outside:
//     S_ij = c_i/D Σ_rays T (1 − e^{−κΔs})     j a zone crossed over Δs, T the transmittance so far
//     S_ij = c_i/D Σ_rays T                     j the patch the ray ends on              (8)–(10)
//   At mirrors (SurfaceSide::mirror) rays go on: the patch keeps 1 − rho_m of what is left, T goes
//   on with rho_m (64). Less than 1e-4 is not followed; a row is then scaled so that it closes.
//   Moments, if asked for, are the same sums with the mean place of each deposit, from the
//   centroid.
// Valid for: any mesh, any occlusion, homogeneous base tets. Rows close by construction, entries
// are
//   ≥ 0, self terms included. Reciprocity holds at the rate of the point set only.
// Settings: `interaction_radius` R ends every ray at that distance; a row's deposits are then
// scaled
//   so that it closes: what is farther, outside too, is taken to shine as what is nearer does in
//   the mean. The error of H is the share of the rays that got so far, times how far these means
//   differ: at most e^{−κR} in a medium that fills the scene.
// Cost: rays × tets crossed a row. Error: about 1/D^0.75 with the Sobol' set for smooth rows;
//   settings.point_set has others (point_set.h).
// Source: zonal method of Hottel & Sarofim (1967), Rushmeier & Torrance (1987); Sobol' points after
// Owen (1995).
void exchange_walked(const Discretization& discretization, std::span<const ElementId> rows,
                     const ExchangeOptions& options, const RowSink& sink);

// The same rows of several bands from one walk, sinks[k] those of bands[k]; `options.band` is not
// read. Each band's are those that exchange_walked makes, to the bit, where no medium of it is
// transparent in one band and not in another. Cost: a walk for all, a deposit in every band.
void exchange_walked_bands(const Discretization& discretization, std::span<const ElementId> rows,
                           const ExchangeOptions& options, std::span<const std::size_t> bands,
                           std::span<const RowSink> sinks);

}  // namespace tyndall::radiosity
