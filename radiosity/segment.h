// What a ray gains on its way through one zone: the integral of (4) in closed form.
#pragma once

#include <algorithm>
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

// The same for the part of a quadratic J that is not linear: what it gains, where it is 1 in the
// middle and 0 at both ends, 4 ∫₀^τ e^{−t} (t/τ) (1 − t/τ) dt. Where κ varies, so of the optical
// length: what a bend is worth there is little.
inline double bend_weight(const SegmentWeights& w) {
    // Of a segment that nothing comes through w.back is 1/τ.
    const double tau = w.transmittance > 1e-12 ? -std::log(w.transmittance) : 1.0 / w.back;
    // The closed form loses digits; the series is good to 1e-9 here.
    if (tau < 0.1)
        return 4.0 * tau *
               (1.0 / 6 - tau * (1.0 / 12 - tau * (1.0 / 40 - tau * (1.0 / 180 - tau / 1008))));
    return 4.0 * (tau - 2.0 + (tau + 2.0) * std::exp(-tau)) / (tau * tau);
}

// The same where κ varies along the segment: `first` and `second` are the optical lengths of its
// halves, J is linear in the distance. By parts, ∫ κ T s/Δ ds = ⟨T⟩ − T(Δ), ⟨T⟩ the mean of the
// transmittance T over the segment; Simpson's rule is applied to what T differs by from that of a
// uniform segment, which is 0 at both ends (45). Exact where the halves are alike, and for κ linear
// in s where the segment is thin.
inline SegmentWeights segment_weights(double first, double second) {
    const double tau = first + second;
    SegmentWeights w = segment_weights(tau);
    const double excess = 2.0 / 3.0 * std::exp(-0.5 * tau) * std::expm1(0.5 * (second - first));
    const double moved = std::clamp(excess, -w.back, w.front);
    return {w.front - moved, w.back + moved, w.transmittance};
}

}  // namespace tyndall::radiosity
