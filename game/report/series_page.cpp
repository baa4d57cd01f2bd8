#include <algorithm>

#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "game/report/report.hpp"

namespace bolt::report {

namespace {

std::string series_plot(const SeriesPage& page, const SeriesPlot& series) {
    plot::Plot plot;
    plot.title = series.name;
    double low = 0.0, high = 0.0, most_x = 0.0;
    for (const std::vector<double>* values : {&series.measured, &series.law})
        for (const double value : *values) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    for (const double x : series.x) most_x = std::max(most_x, x);
    plot.x = {plot::covering_ticks(0.0, most_x, 6), page.x_label};
    plot.y = {plot::covering_ticks(low, high, 5), page.y_label};
    const auto add = [&](const std::vector<double>& values, std::string_view line, plot::MarkerShape shape,
                         std::string_view dots) {
        plot::PlotLine drawn{{}, line, false};
        for (std::size_t i = 0; i < std::min(values.size(), series.x.size()); ++i) {
            drawn.points.push_back({series.x[i], values[i]});
            plot.markers.push_back({drawn.points.back(), shape, dots, {}, false, false});
        }
        if (page.is_sequence) plot.lines.push_back(std::move(drawn));
    };
    add(series.measured, "ln me1", plot::MarkerShape::ring, "mbreak");
    add(series.law, "ln p2", plot::MarkerShape::dot, "mpeak");
    return plot::figure("<h3>" + plot::escape(series.name) + "</h3>", plot::draw(plot), "");
}

}  // namespace

std::string series_page(const SeriesPage& page) {
    std::string body;
    plot::put(body, "<p class=\"over\">The law against published values</p>\n<h1>{}</h1>\n<p>{}</p>\n",
              plot::escape(page.title), plot::escape(page.source));
    body += "<div class=\"grid\">\n";
    for (const SeriesPlot& series : page.plots) body += series_plot(page, series);
    plot::put(body, "</div>\n<p class=\"note\">{}</p>\n<p>Verdict: {}</p>\n", plot::escape(page.caption),
              plot::escape(page.verdict));
    return plot::page(page.title, body);
}

}  // namespace bolt::report
