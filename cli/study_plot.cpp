#include "cli/study_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "view/markup.h"
#include "view/plot_axis.h"

namespace tyndall::cli {
namespace {

using view::escaped;
using view::linear_axis;
using view::log_axis;
using view::PlotAxis;
using view::tick_text;
using view::ticks_of;

constexpr double left = 78, top = 46, plot_width = 520, plot_height = 380, bottom = 62;
constexpr double legend_gap = 20, letter = 6.6, line_height = 20;

// Told apart with every kind of colour vision. Source: Okabe & Ito (2008), Color universal design.
constexpr std::array<const char*, 8> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#000000", "#8B6F00"};

class Drawing {
  public:
    explicit Drawing(double width, double height) {
        fmt::format_to(out(),
                       "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                       "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
                       "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
                       width, height);
    }
    void line(double x1, double y1, double x2, double y2, const char* style) {
        fmt::format_to(out(),
                       "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1,
                       y1, x2, y2, style);
    }
    void text(double x, double y, const std::string& words, const char* style) {
        fmt::format_to(out(), "<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, style,
                       escaped(words));
    }
    void polyline(const std::vector<std::array<double, 2>>& points, const char* colour) {
        std::string path;
        for (const auto& [x, y] : points)
            fmt::format_to(std::back_inserter(path), "{}{:.1f},{:.1f}", path.empty() ? "" : " ", x,
                           y);
        fmt::format_to(out(),
                       "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" "
                       "stroke-linejoin=\"round\"/>\n",
                       path, colour);
    }
    // Each curve has a shape of its own, so that colours are not needed to tell them apart.
    void mark(double x, double y, std::size_t curve) {
        const char* colour = colours[curve % colours.size()];
        const char* fill = curve % colours.size() < 4 ? colour : "white";
        const double r = 4.5;
        const auto shape = [&](const char* points) {
            fmt::format_to(out(),
                           "<polygon transform=\"translate({:.1f} {:.1f})\" points=\"{}\" "
                           "fill=\"{}\" stroke=\"{}\" stroke-width=\"1.5\"/>\n",
                           x, y, points, fill, colour);
        };
        switch (curve % 4) {
            case 0:
                fmt::format_to(out(),
                               "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" "
                               "stroke=\"{}\" stroke-width=\"1.5\"/>\n",
                               x, y, r, fill, colour);
                break;
            case 1:
                shape("-4,-4 4,-4 4,4 -4,4");
                break;
            case 2:
                shape("0,-5.5 5,3.5 -5,3.5");
                break;
            default:
                shape("0,-5.5 5.5,0 0,5.5 -5.5,0");
        }
    }
    std::string finish() { return svg_ + "</svg>\n"; }

  private:
    std::back_insert_iterator<std::string> out() { return std::back_inserter(svg_); }
    std::string svg_;
};

constexpr const char* grid = "stroke=\"#d0d0d0\" stroke-width=\"1\"";
constexpr const char* fine_grid = "stroke=\"#eeeeee\" stroke-width=\"1\"";
constexpr const char* frame = "stroke=\"#333333\" stroke-width=\"1\"";
constexpr const char* dashed = "stroke=\"#777777\" stroke-width=\"1\" stroke-dasharray=\"5 4\"";

// Lines at 2, 3, … 9 of every decade.
std::vector<double> between(const PlotAxis& axis) {
    std::vector<double> values;
    if (axis.linear || axis.high / axis.low > 1e5) return values;
    for (int decade = static_cast<int>(std::floor(std::log10(axis.low)));
         std::pow(10.0, decade) < axis.high; ++decade)
        for (int k = 2; k < 10; ++k)
            if (const double v = k * std::pow(10.0, decade); axis.holds(v)) values.push_back(v);
    return values;
}

void draw_axes(Drawing& d, const Plot& plot, const PlotAxis& x, const PlotAxis& y) {
    for (const double v : between(x)) d.line(x.at(v), y.begin, x.at(v), y.end, fine_grid);
    for (const double v : between(y)) d.line(x.begin, y.at(v), x.end, y.at(v), fine_grid);
    for (const double v : ticks_of(x)) {
        d.line(x.at(v), y.begin, x.at(v), y.end, grid);
        d.text(x.at(v), y.begin + 18, x.linear ? fmt::format("{:g}", v) : tick_text(v),
               "text-anchor=\"middle\"");
    }
    for (const double v : ticks_of(y)) {
        d.line(x.begin, y.at(v), x.end, y.at(v), grid);
        d.text(x.begin - 8, y.at(v) + 4, tick_text(v), "text-anchor=\"end\"");
    }
    d.line(x.begin, y.begin, x.end, y.begin, frame);
    d.line(x.begin, y.begin, x.begin, y.end, frame);
    d.text(0.5 * (x.begin + x.end), y.begin + 44, plot.x_label, "text-anchor=\"middle\"");
    const double middle = 0.5 * (y.begin + y.end);
    const auto turned =
        fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 18 {:.1f})\"", middle);
    d.text(18, middle, plot.y_label, turned.c_str());
    d.text(x.begin, 26, plot.title, "font-size=\"15\" font-weight=\"bold\"");
}

std::string legend_text(const Plot& plot, const Curve& curve) {
    const auto slope = fitted_slope(curve);
    if (!slope || !plot.slopes) return curve.name;
    return fmt::format("{}: slope {}{:.2f}", curve.name, *slope < 0.0 ? "−" : "", std::abs(*slope));
}

}  // namespace

std::string svg_of(const Plot& plot) {
    std::vector<double> costs, errors;
    std::size_t longest = 0;
    for (const auto& curve : plot.curves) {
        longest = std::max(longest, legend_text(plot, curve).size());
        for (const auto& point : curve.points) {
            costs.push_back(point.cost);
            errors.push_back(plot.times * point.error);
        }
    }
    const double legend = legend_gap + 30 + letter * static_cast<double>(longest);
    const double height = std::max(top + plot_height + bottom,
                                   top + line_height * static_cast<double>(plot.curves.size() + 1));
    Drawing d(std::ceil(left + plot_width + legend), std::ceil(height));
    const PlotAxis x = plot.linear_x ? linear_axis(costs, left, left + plot_width)
                                     : log_axis(costs, left, left + plot_width);
    const PlotAxis y = log_axis(errors, top + plot_height, top);
    draw_axes(d, plot, x, y);
    if (costs.empty())
        d.text(left + 0.5 * plot_width, top + 0.5 * plot_height, "no run to show",
               "text-anchor=\"middle\"");
    for (const double level : plot.levels)
        if (y.holds(plot.times * level))
            d.line(x.begin, y.at(plot.times * level), x.end, y.at(plot.times * level), dashed);
    for (std::size_t c = 0; c < plot.curves.size(); ++c) {
        std::vector<std::array<double, 2>> points;
        for (const auto& p : plot.curves[c].points)
            points.push_back({x.at(p.cost), y.at(plot.times * p.error)});
        d.polyline(points, colours[c % colours.size()]);
        const std::size_t apart =
            plot.marks > 0 ? (points.size() + plot.marks - 1) / plot.marks : 1;
        for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(1, apart))
            d.mark(points[k][0], points[k][1], c);
        const double at = top + 12 + line_height * static_cast<double>(c);
        const double from = left + plot_width + legend_gap;
        d.polyline({{from, at}, {from + 22, at}}, colours[c % colours.size()]);
        d.mark(from + 11, at, c);
        d.text(from + 30, at + 4, legend_text(plot, plot.curves[c]), "");
    }
    return d.finish();
}

}  // namespace tyndall::cli
