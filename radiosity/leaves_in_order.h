// The leaves of a forest in the order of elements_of_leaves, for files.
#pragma once

#include "radiosity/elements.h"

namespace tyndall::radiosity {

// Purpose: those elements without what bodies take of them: capacities are those of whole leaves.
//   What a body covers of an element costs 256 points near it, and a file of fields does not ask.
// Cost: that of elements_of_leaves where no body is.
Elements leaves_in_order(const Enclosure& enclosure, const Forest& forest);

}  // namespace tyndall::radiosity
