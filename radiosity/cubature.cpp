#include "radiosity/cubature.h"

#include <vector>

namespace tyndall::radiosity {
namespace {

using Nodes = std::vector<CubatureNode>;

// The three corners' turns of a node (a, b, b), b = (1 − a)/2.
void add_turns(Nodes& nodes, double a, double weight) {
    for (int k = 0; k < 3; ++k) {
        CubatureNode node{{}, weight};
        for (int c = 0; c < 3; ++c) node.at[c] = c == k ? a : 0.5 * (1.0 - a);
        nodes.push_back(node);
    }
}

// The four corners' turns of a node (1 − 3 b, b, b, b).
void add_corners(Nodes& nodes, double b, double weight) {
    for (int k = 0; k < 4; ++k) {
        CubatureNode node{{b, b, b, b}, weight};
        node.at[k] = 1.0 - 3.0 * b;
        nodes.push_back(node);
    }
}

// The six edges' turns of a node (b, b, ½ − b, ½ − b).
void add_edges(Nodes& nodes, double b, double weight) {
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
            CubatureNode node{{0.5 - b, 0.5 - b, 0.5 - b, 0.5 - b}, weight};
            node.at[i] = node.at[j] = b;
            nodes.push_back(node);
        }
}

std::array<Nodes, 3> triangle_rules() {
    constexpr double third = 1.0 / 3.0, root15 = 3.872983346207417;
    std::array<Nodes, 3> rules;
    rules[0] = {{{third, third, third, 0.0}, 1.0}};
    add_turns(rules[1], 2.0 / 3.0, third);
    rules[2] = {{{third, third, third, 0.0}, 9.0 / 40.0}};
    add_turns(rules[2], (9.0 + 2.0 * root15) / 21.0, (155.0 - root15) / 1200.0);
    add_turns(rules[2], (9.0 - 2.0 * root15) / 21.0, (155.0 + root15) / 1200.0);
    return rules;
}

std::array<Nodes, 3> tet_rules() {
    std::array<Nodes, 3> rules;
    rules[0] = {{{0.25, 0.25, 0.25, 0.25}, 1.0}};
    add_corners(rules[1], 0.1381966011250105, 0.25);  // (5 − √5)/20
    add_corners(rules[2], 0.3108859192633006, 0.1126879257180159);
    add_corners(rules[2], 0.0927352503108912, 0.0734930431163620);
    add_edges(rules[2], 0.0455037041256497, 0.0425460207770815);
    return rules;
}

}  // namespace

std::span<const CubatureNode> triangle_rule(Degree degree) {
    static const auto rules = triangle_rules();
    return rules[static_cast<std::size_t>(degree)];
}

std::span<const CubatureNode> tet_rule(Degree degree) {
    static const auto rules = tet_rules();
    return rules[static_cast<std::size_t>(degree)];
}

}  // namespace tyndall::radiosity
