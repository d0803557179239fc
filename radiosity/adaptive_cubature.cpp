#include "radiosity/adaptive_cubature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace tyndall::radiosity {
namespace {

constexpr int rule_points = 7;

struct Rule {
    std::array<double, rule_points> node{}, weight{};   // on [0, 1]
    std::array<double, rule_points> fourth{}, sixth{};  // null rules, of the weights' norm
};

// P_n(x).
double legendre(int n, double x) {
    double previous = 1.0, value = x;
    if (n == 0) return 1.0;
    for (int k = 1; k < n; ++k) {
        const double next = ((2 * k + 1) * x * value - k * previous) / (k + 1);
        previous = value;
        value = next;
    }
    return value;
}

Rule gauss() {
    Rule rule;
    for (int k = 0; k < rule_points; ++k) {
        double x = std::cos(M_PI * (k + 0.75) / (rule_points + 0.5)), slope = 1.0;
        for (int step = 0; step < 50; ++step) {
            slope = rule_points * (x * legendre(rule_points, x) - legendre(rule_points - 1, x)) /
                    (x * x - 1.0);
            x -= legendre(rule_points, x) / slope;
        }
        slope = rule_points * (x * legendre(rule_points, x) - legendre(rule_points - 1, x)) /
                (x * x - 1.0);
        rule.node[k] = 0.5 * (1.0 + x);
        rule.weight[k] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
    double norm = 0.0;
    for (const double w : rule.weight) norm += w * w;
    // Legendre polynomials times the weights are orthogonal to all polynomials of lower degree.
    const auto null_rule = [&](int degree, std::array<double, rule_points>& null) {
        double square = 0.0;
        for (int k = 0; k < rule_points; ++k) {
            null[k] = rule.weight[k] * legendre(degree, 2.0 * rule.node[k] - 1.0);
            square += null[k] * null[k];
        }
        for (double& n : null) n *= std::sqrt(norm / square);
    };
    null_rule(4, rule.fourth);
    null_rule(6, rule.sixth);
    return rule;
}

const Rule rule = gauss();

struct Cell {
    double u, v, width, height;
    double value = 0.0, along_u = 0.0, along_v = 0.0;  // and what either direction leaves

    double error() const { return along_u + along_v; }
    bool operator<(const Cell& other) const { return error() < other.error(); }
};

// What the rule leaves, from the null rules' values: if they fall, the series goes on so up to the
// degree that the rule integrates.
double left(double fourth, double sixth) {
    if (!(sixth < 0.5 * fourth)) return sixth;
    const double fall = sixth / fourth;
    return std::min(sixth, 3.0 * sixth * fall);
}

void evaluate(Cell& cell, const std::function<double(double, double)>& f) {
    std::array<std::array<double, rule_points>, rule_points> values;
    for (int i = 0; i < rule_points; ++i)
        for (int j = 0; j < rule_points; ++j)
            values[i][j] =
                f(cell.u + cell.width * rule.node[i], cell.v + cell.height * rule.node[j]);
    const double area = cell.width * cell.height;
    double u4 = 0.0, u6 = 0.0, v4 = 0.0, v6 = 0.0, sum = 0.0;
    for (int j = 0; j < rule_points; ++j) {
        double row = 0.0, row4 = 0.0, row6 = 0.0, column4 = 0.0, column6 = 0.0;
        for (int i = 0; i < rule_points; ++i) {
            row += rule.weight[i] * values[i][j];
            row4 += rule.fourth[i] * values[i][j];
            row6 += rule.sixth[i] * values[i][j];
            column4 += rule.fourth[i] * values[j][i];
            column6 += rule.sixth[i] * values[j][i];
        }
        sum += rule.weight[j] * row;
        u4 += rule.weight[j] * std::abs(row4);
        u6 += rule.weight[j] * std::abs(row6);
        v4 += rule.weight[j] * std::abs(column4);
        v6 += rule.weight[j] * std::abs(column6);
    }
    cell.value = area * sum;
    cell.along_u = area * left(u4, u6);
    cell.along_v = area * left(v4, v6);
}

}  // namespace

Integral integrate_square(const std::function<double(double, double)>& f,
                          const CubatureOptions& options) {
    std::priority_queue<Cell> cells;
    Cell whole{0.0, 0.0, 1.0, 1.0};
    evaluate(whole, f);
    cells.push(whole);
    double value = whole.value, error = whole.error();
    std::size_t used = rule_points * rule_points;
    const auto goal = [&] {
        return std::max(options.absolute, options.relative * std::abs(value));
    };
    while (error > goal() && used + 2 * rule_points * rule_points <= options.evaluations) {
        const Cell cell = cells.top();
        cells.pop();
        std::array<Cell, 2> halves{cell, cell};
        if (cell.along_u >= cell.along_v) {
            for (Cell& half : halves) half.width *= 0.5;
            halves[1].u += halves[1].width;
        } else {
            for (Cell& half : halves) half.height *= 0.5;
            halves[1].v += halves[1].height;
        }
        value -= cell.value;
        error -= cell.error();
        for (Cell& half : halves) {
            evaluate(half, f);
            value += half.value;
            error += half.error();
            cells.push(half);
        }
        used += 2 * rule_points * rule_points;
        // Sums that grew and shrank many times are made anew when it is over.
    }
    Integral result;
    for (; !cells.empty(); cells.pop()) {
        result.value += cells.top().value;
        result.error += cells.top().error();
    }
    result.reached =
        result.error <= std::max(options.absolute, options.relative * std::abs(result.value));
    return result;
}

}  // namespace tyndall::radiosity
