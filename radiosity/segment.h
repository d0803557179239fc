// What a ray gains on its way through one zone: the integral of (4) in closed form.
#pragma once

#include <cmath>

namespace tyndall::radiosity {

// Weights of the source radiance at the entry and the exit of a segment of optical length `tau`
// [-], for J linear between them, and the segment's transmittance:
//   ∫₀^τ e^{−t} J(t) dt = front J_in + back J_out,  seen from the entry.
struct SegmentWeights {
    double front, back, transmittance;
};

inline SegmentWeights segment_weights(double tau) {
    double opacity, back;
    if (tau < 0.05) {
        // The closed form loses digits; the series is good to 1e-10 here.
        opacity = tau * (1.0 - tau * (1.0 / 2 - tau * (1.0 / 6 - tau * (1.0 / 24 - tau / 120))));
        back = tau * (1.0 / 2 - tau * (1.0 / 3 - tau * (1.0 / 8 - tau * (1.0 / 30 - tau / 144))));
    } else {
        opacity = -std::expm1(-tau);
        back = (opacity - tau * (1.0 - opacity)) / tau;
    }
    return {opacity - back, back, 1.0 - opacity};
}

}  // namespace tyndall::radiosity
