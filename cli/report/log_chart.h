#pragma once

#include <string>
#include <vector>

namespace prt::cli {

struct ChartPoint {
    double x = 0, y = 0; ///< points that are not above zero are left out
    std::string label;   ///< shown when pointed at
};

struct ChartSeries {
    std::string name;
    std::vector<ChartPoint> points; ///< in the order of the curve
    bool strong = false;            ///< a thicker line
};

/// A chart with logarithmic axes, one curve per series, as SVG.
std::string log_chart(const std::vector<ChartSeries>& series, const std::string& x_title,
                      const std::string& y_title);

} // namespace prt::cli
