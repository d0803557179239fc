// Gauss–Legendre nodes and weights on [a, b].
#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace tyndall::test {

inline std::vector<std::pair<double, double>> gauss(int n, double a, double b) {
    std::vector<std::pair<double, double>> rule;
    for (int k = 0; k < n; ++k) {
        double x = std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 20; ++step) {  // Newton on the Legendre polynomial
            double p = 1.0, q = 0.0;
            for (int j = 1; j <= n; ++j)
                q = std::exchange(p, ((2.0 * j - 1.0) * x * p - (j - 1.0) * q) / j);
            slope = n * (x * p - q) / (x * x - 1.0);
            x -= p / slope;
        }
        rule.emplace_back(0.5 * (a + b) + 0.5 * (b - a) * x,
                          (b - a) / ((1.0 - x * x) * slope * slope));
    }
    return rule;
}

}  // namespace tyndall::test
