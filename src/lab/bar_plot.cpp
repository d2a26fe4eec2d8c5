#include "lab/bar_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace alhazen {

namespace {

// In the plot's own units, which are pixels where the page is wide enough.
constexpr double width = 620, label_width = 150, right = 14, top = 16, bar_height = 7, row_gap = 6,
                 bottom = 40, key_height = 20;

/// The round step (1, 2 or 5 times a power of ten) that cuts 0 ... most into about seven.
double round_step(double most) {
    double raw = most / 7, power = std::pow(10, std::floor(std::log10(raw)));
    for (double factor : {1.0, 2.0, 5.0})
        if (raw <= factor * power) return factor * power;
    return 10 * power;
}

double largest_of(const BarPlot& plot) {
    double most = 0;
    for (const auto& row : plot.rows)
        for (const auto& bar : row.bars) most = std::max(most, bar.value);
    for (const auto& mark : plot.marks) most = std::max(most, mark.value);
    return most > 0 ? most : 1;
}

/// Places on the paper.
struct Layout {
    double most, row_height, height;

    explicit Layout(const BarPlot& plot) : most(largest_of(plot) * 1.04) {
        std::size_t bars = 1;
        for (const auto& row : plot.rows) bars = std::max(bars, row.bars.size());
        row_height = static_cast<double>(bars) * bar_height + row_gap;
        height = top + row_height * static_cast<double>(plot.rows.size()) + bottom +
                 (plot.keys.empty() ? 0 : key_height);
    }
    double x(double value) const { return label_width + value / most * (width - label_width - right); }
    double y(std::size_t row) const { return top + row_height * static_cast<double>(row); }
};

std::string scale_svg(const BarPlot& plot, const Layout& at) {
    std::string svg;
    double step = round_step(at.most), end = at.y(plot.rows.size());
    for (int i = 0; i * step <= at.most; ++i) {
        double x = at.x(i * step);
        svg +=
            fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>"
                        "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3:.1f}\">{4:g}</text>\n",
                        x, top, end, end + 13, i * step);
    }
    return svg + fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                             (label_width + width - right) / 2, end + 29, escape_html(plot.unit));
}

std::string row_svg(const BarPlot::Row& row, std::size_t index, const Layout& at) {
    double y = at.y(index) + row_gap / 2;
    std::string svg =
        fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", label_width - 8,
                    y + static_cast<double>(row.bars.size()) * bar_height / 2 + 4, escape_html(row.label));
    for (const BarPlot::Bar& bar : row.bars) {
        svg += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">"
                           "<title>{}</title></rect>",
                           bar.style, label_width, y, std::max(at.x(bar.value) - label_width, 0.5),
                           bar_height - 1, escape_html(bar.tip));
        y += bar_height;
    }
    return svg + "\n";
}

std::string keys_svg(const BarPlot& plot, const Layout& at) {
    std::string svg;
    double x = 10, y = at.height - key_height;
    for (const BarPlot::Key& key : plot.keys) {
        svg += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"8\"/>"
                           "<text class=\"key\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                           key.style, x, y, x + 17, y + 8, escape_html(key.label));
        x += 40 + 5.8 * static_cast<double>(key.label.size());
    }
    return svg;
}

// What a page's style would say.
constexpr const char* file_style = R"(<style>
text { fill: #1c2128; font: 11px system-ui, sans-serif; } .label { text-anchor: end; }
.tick { text-anchor: middle; fill: #5b6470; } .grid { stroke: #d5d8d8; } .title { font-weight: 600; font-size: 13px; }
.mark { stroke: #c2410c; stroke-width: 1.5; stroke-dasharray: 5 3; } .marklabel { fill: #c2410c; }
.first { fill: #2563a8; } .second { fill: #8db8e0; } .third { fill: #4d7c4a; } .paper { fill: #fdfdfb; }
@media (prefers-color-scheme: dark) { text { fill: #e6e8ea; } .tick { fill: #a0a8b2; } .grid { stroke: #39404a; }
.mark { stroke: #fb923c; } .marklabel { fill: #fb923c; } .first { fill: #6cb0f5; } .second { fill: #33608c; }
.third { fill: #84b880; } .paper { fill: #14171b; } }
</style>
)";

} // namespace

std::string escape_html(std::string_view text) {
    std::string out;
    for (char c : text) switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    return out;
}

std::string BarPlot::svg() const {
    Layout at(*this);
    std::string text = fmt::format("<svg viewBox=\"0 0 {} {:.0f}\" role=\"img\" aria-label=\"{}\">\n", width,
                                   at.height, escape_html(title));
    text += scale_svg(*this, at);
    for (std::size_t i = 0; i < rows.size(); ++i) text += row_svg(rows[i], i, at);
    for (const Mark& mark : marks) {
        double x = at.x(mark.value);
        text += fmt::format(
            "<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>"
            "<text class=\"marklabel\" x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"{5}\">{6}</text>\n",
            x, top - 3, at.y(rows.size()), x, top - 5, mark.value > at.most / 2 ? "end" : "start",
            escape_html(mark.label));
    }
    return text + keys_svg(*this, at) + "</svg>\n";
}

std::string BarPlot::svg_file() const {
    constexpr double margin = 12, title_height = 22;
    const double height = Layout(*this).height;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\">\n{2}"
        "<rect class=\"paper\" width=\"{0:.0f}\" height=\"{1:.0f}\"/>\n"
        "<text class=\"title\" x=\"{3:.0f}\" y=\"22\">{4}</text>\n"
        "<svg x=\"{3:.0f}\" y=\"{5:.0f}\" width=\"{6:.0f}\" height=\"{7:.0f}\">\n{8}</svg>\n</svg>\n",
        width + 2 * margin, height + title_height + 2 * margin, file_style, margin, escape_html(title),
        title_height + margin, width, height, svg());
}

} // namespace alhazen
