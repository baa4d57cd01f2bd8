#include "game/plot/plot.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"
#include "tests/report/well_formed.hpp"

using namespace bolt::plot;
using namespace bolt::report;

namespace {

Plot example() {
    Plot plot;
    plot.title = "torque <&> \"angle\"";
    plot.x = {covering_ticks(0.0, 100.0, 6), "angle, °"};
    plot.x.ticks.range = {0.0, 100.0};
    plot.y = {covering_ticks(0.0, 200.0), "torque"};
    plot.y2 = PlotAxis{covering_ticks(0.0, 90.0), "clamp"};
    plot.bands.push_back({{10.0, 60.0}, "s1", "<band>", false});
    plot.bands.push_back({{180.0, 190.0}, "win", "", true});
    plot.reference_lines.push_back({185.0, "tgt", "a & b", true});
    PlotLine line;
    line.style = "ln p2";
    for (int i = 0; i <= 1000; ++i) line.points.push_back({0.1 * i, i == 500 ? 199.0 : 0.1 * i});
    plot.lines.push_back(line);
    for (const MarkerShape shape :
         {MarkerShape::dot, MarkerShape::ring, MarkerShape::square, MarkerShape::triangle})
        plot.markers.push_back({{50.0, 100.0}, shape, "mpeak", "'x'", false});
    return plot;
}

}  // namespace

TEST_CASE("Plot: is well-formed and escapes all text") {
    const std::string svg = draw(example());
    CHECK(markup_fault(svg) == "");
    CHECK(svg.find("&lt;band&gt;") != std::string::npos);
    CHECK(svg.find("torque &lt;&amp;&gt; &quot;angle&quot;") != std::string::npos);
    CHECK(svg.find("<band>") == std::string::npos);
    CHECK(markup_fault(standalone(svg, style_sheet())) == "");
}

TEST_CASE("Markup checker: finds faults") {
    CHECK(markup_fault("<p>a</p>") == "");
    CHECK(markup_fault("<p>a") != "");
    CHECK(markup_fault("<p>a</div>") != "");
    CHECK(markup_fault("<p>a & b</p>") != "");
    CHECK(markup_fault("<p class=x>a</p>") != "");
    CHECK(markup_fault("<p class=\"a<b\">a</p>") != "");
    CHECK(markup_fault("<br/><p>5 > 3</p>") != "");
    CHECK(markup_fault("</p>") != "");
}

TEST_CASE("Plot: a line keeps its peak at the right pixel") {
    const Plot plot = example();
    const SvgBox area = plot_area(plot);
    const AxisScale x{plot.x.ticks.range, area.width, false}, y{plot.y.ticks.range, area.height, true};
    Svg expected(1, 1, "");
    const SvgPoint peak[] = {{x(50.0), y(199.0)}};
    expected.path(peak, "");
    const std::string text = expected.finish();
    const std::size_t from = text.find("d=\"M") + 4;
    CHECK(draw(plot).find(text.substr(from, text.find('"', from) - from)) != std::string::npos);
}

TEST_CASE("Plot: values that are not finite are not drawn") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Plot plot = example();
    plot.lines.push_back({{{nan, nan}, {1.0, nan}, {HUGE_VAL, 3.0}}, "ln", false});
    plot.markers.push_back({{nan, 1.0}, MarkerShape::dot, "mpeak", "never", false});
    plot.reference_lines.push_back({nan, "tgt", "never", false});
    const std::string svg = draw(plot);
    CHECK(markup_fault(svg) == "");
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
    CHECK(svg.find("never") == std::string::npos);
}

TEST_CASE("Plot: every band has a label, narrow ones in a second row, without overlap") {
    for (const double narrow : {0.5, 3.0, 10.0}) {
        Plot plot = example();
        plot.bands.clear();
        double at = 0.0;
        for (const char* name : {"navigation", "transition", "linearity", "yield"}) {
            const double end = std::string(name) == "yield" ? 100.0 : at + narrow;
            plot.bands.push_back({{at, end}, "s1", name});
            at = end;
        }
        const std::string svg = draw(plot);
        std::vector<SvgBox> boxes;
        for (const char* name : {"navigation", "transition", "linearity", "yield"}) {
            const std::size_t end = svg.find(">" + std::string(name) + "</text>");
            REQUIRE_MESSAGE(end != std::string::npos, name);
            CHECK(svg.find(">" + std::string(name) + "</text>", end + 1) == std::string::npos);
            const std::size_t tag = svg.rfind("<text x=\"", end) + 9;
            const std::size_t y = svg.find("y=\"", tag) + 3;
            const SvgBox box = text_box({{std::stod(svg.substr(tag)), std::stod(svg.substr(y))}}, name, 12.0);
            for (const SvgBox& other : boxes)
                CHECK((box.x >= other.x + other.width || other.x >= box.x + box.width ||
                       box.y >= other.y + other.height || other.y >= box.y + box.height));
            boxes.push_back(box);
        }
    }
}

TEST_CASE("Label layout: labels avoid occupied boxes and the edge") {
    LabelLayout labels({0.0, 0.0, 200.0, 100.0});
    labels.occupy({100.0, 40.0, 40.0, 20.0});
    const LabelPosition spots[] = {{{110.0, 55.0}}, {{190.0, 20.0}}, {{20.0, 80.0}}};
    CHECK(labels.place(spots, "words", 12.0).baseline.x == 20.0);
    CHECK(labels.place(spots, "words", 12.0).baseline.x == 190.0);  // all positions overlap; this one least
    CHECK(text_width("Maß", 10.0) == text_width("Mass", 10.0) * 0.75);
}
