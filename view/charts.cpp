#include "view/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "view/markup.h"
#include "view/plot_axis.h"

namespace tyndall::view {
namespace {

constexpr double width = 480, left = 70, right = 464, top = 16, base = 232, legend_line = 18;
constexpr double bar_height = 20, bar_names = 150, bar_figures = 70;
constexpr double letter = 6.2;  // of text in small print, on average [pixel]

// Beyond these kinds of strokes and marks, they come again.
constexpr std::size_t styles = 6;

class Svg {
  public:
    Svg(const ChartWords& words, double height) {
        fmt::format_to(out(), "<svg class=\"chart\" viewBox=\"0 0 {} {:.0f}\" role=\"img\">\n",
                       width, height);
        fmt::format_to(out(), "<title>{}</title><desc>{}</desc>\n", escaped(words.title),
                       escaped(words.description));
    }
    void line(const char* kind, double x1, double y1, double x2, double y2) {
        fmt::format_to(
            out(), "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
            kind, x1, y1, x2, y2);
    }
    void text(double x, double y, const char* anchor, const std::string& words,
              const std::string& more = "") {
        fmt::format_to(out(), "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x,
                       y, anchor, more, escaped(words));
    }
    // A rectangle with what it says when it is pointed at.
    void box(const std::string& kind, double x, double y, double w, double h,
             const std::string& says) {
        fmt::format_to(out(),
                       "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.2f}\" "
                       "height=\"{:.2f}\"><title>{}</title></rect>\n",
                       kind, x, y, w, h, escaped(says));
    }
    void polyline(std::size_t style, const std::vector<std::array<double, 2>>& points) {
        std::string path;
        for (const auto& [x, y] : points)
            fmt::format_to(std::back_inserter(path), "{}{:.1f},{:.1f}", path.empty() ? "" : " ", x,
                           y);
        fmt::format_to(out(), "<polyline class=\"curve style{}\" points=\"{}\"/>\n", style % styles,
                       path);
    }
    // Each curve has a shape of its own, so that colours are not needed to tell them apart.
    void mark(std::size_t style, double x, double y, const std::string& says) {
        static constexpr std::array<const char*, 4> shapes{
            "-3.4,-3.4 3.4,-3.4 3.4,3.4 -3.4,3.4", "0,-4.6 4.2,3 -4.2,3",
            "0,-4.6 4.6,0 0,4.6 -4.6,0", "0,4.6 4.2,-3 -4.2,-3"};
        if (style % styles == 0)
            fmt::format_to(out(),
                           "<circle class=\"mark style0\" cx=\"{:.1f}\" cy=\"{:.1f}\" "
                           "r=\"3.6\">",
                           x, y);
        else
            fmt::format_to(out(),
                           "<polygon class=\"mark style{}\" transform=\"translate({:.1f} "
                           "{:.1f})\" points=\"{}\">",
                           style % styles, x, y, shapes[(style - 1) % shapes.size()]);
        fmt::format_to(out(), "<title>{}</title></{}>\n", escaped(says),
                       style % styles == 0 ? "circle" : "polygon");
    }
    std::string finish() { return svg_ + "</svg>\n"; }

  private:
    std::back_insert_iterator<std::string> out() { return std::back_inserter(svg_); }
    std::string svg_;
};

void draw_axes(Svg& svg, const ChartWords& words, const PlotAxis& x, const PlotAxis& y) {
    const auto text = [](const PlotAxis& axis, double v) {
        return axis.linear ? fmt::format("{:g}", v) : tick_text(v);
    };
    for (const double v : ticks_of(x)) {
        svg.line("grid", x.at(v), base, x.at(v), top);
        svg.text(x.at(v), base + 15, "middle", text(x, v));
    }
    for (const double v : ticks_of(y)) {
        svg.line("grid", x.begin, y.at(v), x.end, y.at(v));
        svg.text(x.begin - 6, y.at(v) + 4, "end", text(y, v));
    }
    svg.line("axis", x.begin, base, x.end, base);
    svg.line("axis", x.begin, base, x.begin, top);
    svg.text(0.5 * (x.begin + x.end), base + 34, "middle", words.x_label);
    svg.text(13, 0.5 * (top + base), "middle", words.y_label,
             fmt::format(" transform=\"rotate(-90 13 {:.1f})\"", 0.5 * (top + base)));
}

// The names of curves or kinds, below the axis; how many lines they take.
double draw_legend(Svg& svg, const std::vector<std::string>& names, bool boxes) {
    double x = left, y = base + 56;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const double needed = 22 + letter * static_cast<double>(names[k].size());
        if (x > left && x + needed > right) x = left, y += legend_line;
        if (boxes)
            svg.box(fmt::format("bar style{}", k % styles), x, y - 9, 12, 10, names[k]);
        else
            svg.mark(k, x + 6, y - 4, names[k]);
        svg.text(x + 18, y, "start", names[k]);
        x += needed + 14;
    }
    return y;
}

double legend_height(const std::vector<std::string>& names) {
    double x = left, y = 0;
    for (const auto& name : names) {
        const double needed = 22 + letter * static_cast<double>(name.size());
        if (x > left && x + needed > right) x = left, y += legend_line;
        x += needed + 14;
    }
    return y;
}

bool shown(const std::array<double, 2>& point, AxisScale x_scale) {
    const bool x_fits = x_scale == AxisScale::linear ? point[0] >= 0.0 : point[0] > 0.0;
    return x_fits && point[1] > 0.0 && std::isfinite(point[0]) && std::isfinite(point[1]);
}

std::size_t bin_of(const Histogram& h, double value) {
    const auto above = std::upper_bound(h.edges.begin(), h.edges.end(), value);
    const auto index = std::distance(h.edges.begin(), above) - 1;
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(index, 0, static_cast<std::ptrdiff_t>(h.edges.size()) - 2));
}

Histogram counted(Histogram h, std::vector<std::string> kinds,
                  const std::vector<std::vector<double>>& values) {
    h.kinds = std::move(kinds);
    h.counts.assign(values.size(), {});
    h.zeros.assign(values.size(), 0);
    for (std::size_t k = 0; k < values.size(); ++k) {
        h.counts[k].assign(h.edges.size() - 1, 0);
        for (const double value : values[k])
            if (h.scale == AxisScale::logarithmic && value <= 0.0)
                ++h.zeros[k];
            else if (std::isfinite(value))
                ++h.counts[k][bin_of(h, value)];
    }
    return h;
}

}  // namespace

std::string curve_chart(const ChartWords& words, const std::vector<ChartCurve>& curves,
                        AxisScale x_scale, const ChartLevel& level) {
    std::vector<double> xs, ys;
    std::vector<std::string> names;
    std::vector<std::vector<std::array<double, 2>>> kept(curves.size());
    std::size_t longest = 0;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        for (const auto& point : curves[c].points)
            if (shown(point, x_scale)) kept[c].push_back(point);
        for (const auto& point : kept[c]) xs.push_back(point[0]), ys.push_back(point[1]);
        names.push_back(curves[c].name);
        longest = std::max(longest, kept[c].size());
    }
    if (longest < 2) return "";
    if (level.value > 0.0) ys.push_back(level.value);
    const bool named = curves.size() > 1;
    Svg svg(words, base + 44 + (named ? 22 + legend_height(names) : 0));
    const PlotAxis x =
        x_scale == AxisScale::linear ? linear_axis(xs, left, right) : log_axis(xs, left, right);
    const PlotAxis y = log_axis(ys, base, top);
    draw_axes(svg, words, x, y);
    if (level.value > 0.0) {
        svg.line("level", x.begin, y.at(level.value), x.end, y.at(level.value));
        svg.text(x.end, y.at(level.value) - 4, "end", level.name);
    }
    for (std::size_t c = 0; c < curves.size(); ++c) {
        std::vector<std::array<double, 2>> points;
        for (const auto& p : kept[c]) points.push_back({x.at(p[0]), y.at(p[1])});
        svg.polyline(c, points);
        // As many marks as can be told apart.
        const std::size_t apart = (points.size() + 39) / 40;
        for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(1, apart))
            svg.mark(c, points[k][0], points[k][1],
                     fmt::format("{}{}, {}", named ? names[c] + ": " : "", figure(kept[c][k][0]),
                                 figure(kept[c][k][1])));
    }
    if (named) draw_legend(svg, names, false);
    return svg.finish();
}

std::string bar_chart(const ChartWords& words, const std::vector<ChartBar>& bars) {
    if (bars.empty()) return "";
    double low = 0.0, high = 0.0;
    for (const auto& bar : bars)
        if (std::isfinite(bar.value))
            low = std::min(low, bar.value), high = std::max(high, bar.value);
    if (!(high > low)) high = 1.0;
    // Figures stand beyond the ends of bars, on either side.
    const double begin = bar_names + (low < 0.0 ? bar_figures : 6), end = width - bar_figures;
    const double scale = (end - begin) / (high - low), zero = begin - low * scale;
    const double bottom = 8 + bar_height * static_cast<double>(bars.size());
    Svg svg(words, bottom + 26);
    for (std::size_t k = 0; k < bars.size(); ++k) {
        const double y = 8 + bar_height * static_cast<double>(k);
        const double value = std::isfinite(bars[k].value) ? bars[k].value : 0.0;
        const double length = std::abs(value) * scale;
        std::string name = bars[k].name;
        constexpr std::size_t most = 24;
        if (name.size() > most) {
            std::size_t cut = most - 1;  // never within a letter of several bytes
            while (cut > 0 && (static_cast<unsigned char>(name[cut]) & 0xc0) == 0x80) --cut;
            name = name.substr(0, cut) + "…";
        }
        svg.text(bar_names - 6, y + 13, "end", name);
        svg.box(value < 0.0 ? "bar style1" : "bar style0", value < 0.0 ? zero - length : zero,
                y + 3, length, bar_height - 6,
                fmt::format("{}: {}", bars[k].name, figure(bars[k].value)));
        svg.text(value < 0.0 ? zero - length - 4 : zero + length + 4, y + 13,
                 value < 0.0 ? "end" : "start", figure(bars[k].value));
    }
    svg.line("axis", zero, 4, zero, bottom);
    svg.text(0.5 * (begin + end), bottom + 18, "middle", words.x_label);
    return svg.finish();
}

Histogram log_histogram(std::vector<std::string> kinds,
                        const std::vector<std::vector<double>>& values) {
    Histogram h;
    double least = 0.0, most = 0.0;
    for (const auto& list : values)
        for (const double value : list)
            if (value > 0.0 && std::isfinite(value)) {
                least = least > 0.0 ? std::min(least, value) : value;
                most = std::max(most, value);
            }
    if (!(least > 0.0)) least = most = 1.0;
    // Bins of a quarter, a half, a whole decade, or of several.
    constexpr std::array<double, 6> steps{0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
    for (const double step : steps) {
        const double first = std::floor(std::log10(least) / step + 1e-9);
        const double last = std::max(first + 1.0, std::ceil(std::log10(most) / step - 1e-9));
        if (last - first > 24.0 && step < steps.back()) continue;
        for (double k = first; k <= last; k += 1.0) h.edges.push_back(std::pow(10.0, k * step));
        break;
    }
    return counted(std::move(h), std::move(kinds), values);
}

Histogram share_histogram(std::vector<std::string> kinds,
                          const std::vector<std::vector<double>>& values) {
    Histogram h;
    h.scale = AxisScale::linear;
    for (int k = 0; k <= 20; ++k) h.edges.push_back(0.05 * k);
    return counted(std::move(h), std::move(kinds), values);
}

Histogram whole_histogram(std::vector<std::string> kinds,
                          const std::vector<std::vector<double>>& values) {
    Histogram h;
    h.scale = AxisScale::linear;
    double most = 0.0;
    for (const auto& list : values)
        for (const double value : list) most = std::max(most, value);
    const double step = std::max(1.0, std::ceil((most + 1.0) / 24.0));
    for (double edge = 0.0; edge < most + 1.0 + step; edge += step) h.edges.push_back(edge);
    while (h.edges.size() > 2 && h.edges[h.edges.size() - 2] > most) h.edges.pop_back();
    return counted(std::move(h), std::move(kinds), values);
}

std::string histogram_chart(const ChartWords& words, const Histogram& h) {
    std::vector<double> counts;
    for (const auto& list : h.counts)
        for (const std::size_t count : list) counts.push_back(static_cast<double>(count));
    if (std::none_of(counts.begin(), counts.end(), [](double c) { return c > 0.0; })) return "";
    const bool named = h.kinds.size() > 1;
    Svg svg(words, base + 44 + (named ? 22 + legend_height(h.kinds) : 0));
    const PlotAxis x{h.edges.front(), h.edges.back(), left, right, h.scale == AxisScale::linear};
    const PlotAxis y = linear_axis(counts, base, top);
    draw_axes(svg, words, x, y);
    for (std::size_t k = 0; k < h.kinds.size(); ++k)
        for (std::size_t b = 0; b + 1 < h.edges.size(); ++b) {
            if (h.counts[k][b] == 0) continue;
            const double from = x.at(h.edges[b]), room = x.at(h.edges[b + 1]) - from - 2.0;
            const double part = room / static_cast<double>(h.kinds.size());
            const double up = y.at(static_cast<double>(h.counts[k][b]));
            svg.box(fmt::format("bar style{}", k % styles),
                    from + 1.0 + part * static_cast<double>(k), up, part, base - up,
                    fmt::format("{} {} from {} to {}", h.counts[k][b], h.kinds[k],
                                figure(h.edges[b]), figure(h.edges[b + 1])));
        }
    if (named) draw_legend(svg, h.kinds, true);
    return svg.finish();
}

}  // namespace tyndall::view
