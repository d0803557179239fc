// Colours for numbers.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace tyndall::render {

using Colour = std::array<double, 3>;  // sRGB codes, 0 to 255

// Dark blue (0) over green to yellow (1); beyond, the ends' colours.
// Source: a polynomial through matplotlib's map "viridis" (M. Zucker, 2019, public domain).
Colour map_colour(double t);

// From numbers to colours, by their logarithm or as they are.
struct ColourScale {
    double low = 0.0, high = 1.0;
    bool logarithmic = false;

    Colour operator()(double value) const;
};

// Purpose: a scale that shows the values well: the 0.5th to the 99.5th percentile. By the
//   logarithm of what is above 0, at most three decades: light is many times brighter near a lamp
//   than far from it.
ColourScale scale_for(std::vector<double> values, bool logarithmic);

}  // namespace tyndall::render
