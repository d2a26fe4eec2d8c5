/// Bar plots as SVG to stand in a page: rows of bars from left to right, with a scale below. The page's style
/// gives the classes their colours.
#pragma once

#include <string>
#include <vector>

namespace alhazen {

struct BarPlot {
    struct Bar {
        double value = 0;
        std::string style; ///< CSS class
        std::string tip;   ///< shown under the mouse
    };
    struct Row {
        std::string label;
        std::vector<Bar> bars;
    };
    /// A line across all rows.
    struct Mark {
        double value = 0;
        std::string label;
    };
    /// What bars of a style are, told below the scale.
    struct Key {
        std::string style, label;
    };
    std::string title; ///< read out to those who do not see the plot
    std::string unit;  ///< below the scale
    std::vector<Row> rows;
    std::vector<Mark> marks;
    std::vector<Key> keys;

    /// To stand in a page.
    std::string svg() const;
    /// A file of its own, readable by day and by night. Styles of bars: first, second, third.
    std::string svg_file() const;
};

/// The text with what HTML would take for its own replaced.
std::string escape_html(std::string_view text);

} // namespace alhazen
