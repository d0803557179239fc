// Media as they are solved: reduced coefficients, and extinction that varies in space.
#pragma once

#include <span>

#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// A medium of the enclosure with its reduced coefficients, absorption and scattering κ_s (1 − g);
// of one that varies, with its shape left out.
MediumOptics medium_optics(const Medium& medium, const Enclosure& enclosure);

// Gives `enclosure.media` their `varying` extinction and its mean, or, where all samples are alike,
// the one extinction they have. Functions are sampled over the bounding box of the medium's
// regions; `claimed`: the medium of every region.
// Errors: mesh::InputError, see make_enclosure. Cost: sample_function, and a mean over every tet.
void bind_varying(const Scene& scene, std::span<const std::size_t> claimed,
                  const SampleOptions& options, Enclosure& enclosure);

}  // namespace tyndall::radiosity
