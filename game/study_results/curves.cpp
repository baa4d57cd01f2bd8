#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "game/study_results/parts.hpp"

namespace bolt::study {

namespace {

constexpr std::array<std::string_view, 3> line_styles{"ln p2", "ln p1", "ln p0"};
constexpr double label_height = 10.5;    // px between two labels
constexpr std::size_t most_labels = 24;  // of one plot; more do not fit beside it
constexpr double label_room = 34.0;      // px, to the right of the plot

// The number of a lesson on the axis: 1, 2, ... in the conditions, 0, −1, ... backwards through the training,
// and the retention test last.
struct LessonAxis {
    std::size_t per_part = 0, training = 0, parts = 0;  // of all participants
    bool retention = false;

    [[nodiscard]] double last() const { return static_cast<double>(parts * per_part + (retention ? 1 : 0)); }
    [[nodiscard]] double number(const Observation& o, std::size_t trained) const {
        if (o.time == ObservationTime::training)
            return static_cast<double>(o.lesson) + 1.0 - static_cast<double>(trained);
        if (o.time == ObservationTime::retention) return last();
        return static_cast<double>(o.part * per_part + o.lesson + 1);
    }
};

bool is_lesson(const Observation& o, const std::string& measure) {
    if (o.measure != measure) return false;
    if (o.time == ObservationTime::retention) return true;
    return o.lesson != no_index &&
           (o.time == ObservationTime::condition || o.time == ObservationTime::training);
}

struct PersonLine {
    std::size_t participant = 0;
    std::vector<plot::SvgPoint> points;
};

// The lines of a measure, by participant; the axis counts all of them.
std::vector<PersonLine> person_lines(const StudyData& data, const MeasureInfo& info, LessonAxis& axis) {
    std::vector<std::size_t> trained(data.participants.size(), 0);
    for (const Observation& o : data.observations) {
        if (!is_lesson(o, info.id)) continue;
        if (o.time == ObservationTime::training)
            trained[o.participant] = std::max(trained[o.participant], o.lesson + 1);
        else if (o.time == ObservationTime::retention)
            axis.retention = true;
        else {
            axis.per_part = std::max(axis.per_part, o.lesson + 1);
            axis.parts = std::max(axis.parts, o.part + 1);
        }
    }
    for (const std::size_t n : trained) axis.training = std::max(axis.training, n);
    std::vector<PersonLine> lines;
    for (std::size_t i = 0; i < data.participants.size(); ++i) {
        PersonLine line{i, {}};
        for (const Observation& o : data.observations)
            if (o.participant == i && is_lesson(o, info.id))
                line.points.push_back({axis.number(o, trained[i]), o.value * info.scale});
        std::sort(line.points.begin(), line.points.end(),
                  [](const plot::SvgPoint& a, const plot::SvgPoint& b) { return a.x < b.x; });
        if (!line.points.empty()) lines.push_back(std::move(line));
    }
    return lines;
}

// Writes the participant beside the end of each line; the labels keep a distance.
void put_labels(plot::Svg& svg, const plot::Plot& plot, const std::vector<PersonLine>& lines,
                const StudyData& data) {
    const plot::SvgBox area = plot::plot_area(plot);
    const plot::AxisScale x{plot.x.ticks.range, area.width, false}, y{plot.y.ticks.range, area.height, true};
    struct Label {
        plot::SvgPoint end;
        double y = 0.0;
        const std::string* text = nullptr;
    };
    std::vector<Label> labels;
    for (const PersonLine& line : lines) {
        const plot::SvgPoint end{area.x + x(line.points.back().x), area.y + y(line.points.back().y)};
        labels.push_back({end, end.y, &data.participants[line.participant].participant});
    }
    std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
    for (std::size_t i = 1; i < labels.size(); ++i)
        labels[i].y = std::max(labels[i].y, labels[i - 1].y + label_height);
    const double over = labels.back().y - (area.y + area.height);
    if (over > 0.0) labels.back().y -= over;
    for (std::size_t i = labels.size() - 1; i-- > 0;)
        labels[i].y = std::min(labels[i].y, labels[i + 1].y - label_height);
    const double left = area.x + area.width + 10.0;
    for (const Label& label : labels) {
        svg.line(label.end, {left - 2.0, label.y}, "ld");
        svg.text({left, label.y + 3.5}, "sm", *label.text);
    }
}

std::string learning_curve(const StudyData& data, const MeasureInfo& info) {
    LessonAxis axis;
    const std::vector<PersonLine> lines = person_lines(data, info, axis);
    std::size_t longest = 0;
    for (const PersonLine& line : lines) longest = std::max(longest, line.points.size());
    if (longest < 2) return {};
    double low = 0.0, high = 0.0;
    plot::Plot plot;
    plot.title = info.title + " over the lessons";
    for (std::size_t i = 0; i < lines.size(); ++i) {
        for (const plot::SvgPoint& point : lines[i].points) {
            low = std::min(low, point.y);
            high = std::max(high, point.y);
            plot.markers.push_back({point, plot::MarkerShape::dot, "mpeak", {}, false, false});
        }
        plot.lines.push_back({lines[i].points, line_styles.at(i % line_styles.size()), false});
    }
    const int first = axis.training > 0 ? 1 - static_cast<int>(axis.training) : 1;
    plot.x = {plot::count_ticks(first, static_cast<int>(axis.last()), 10), "lesson of the participant"};
    plot.y = {plot::covering_ticks(low, high > low ? high : low + 1.0, 5), info.unit};
    if (axis.training > 0)
        plot.bands.push_back({{plot.x.ticks.range.low, 0.5}, "s1", "training", false, true});
    if (axis.retention)
        plot.bands.push_back({{axis.last() - 0.5, plot.x.ticks.range.high}, "s3", "retention", false, true});
    const bool labelled = lines.size() <= most_labels;
    plot::Svg svg(plot.width + (labelled ? label_room : 0.0), plot.height, plot.title);
    plot::draw_into(svg, plot);
    if (labelled) put_labels(svg, plot, lines, data);
    return plot::figure("<h3>" + plot::escape(info.title) + "</h3>", svg.finish(), "");
}

}  // namespace

std::string learning_curves(const StudyData& data) {
    std::string figures;
    for (const char* id : {"score", "duration_s", "torque_error", "bumps"})
        for (const MeasureInfo& info : objective_measure_infos())
            if (info.id == id) figures += learning_curve(data, info);
    if (figures.empty()) return {};
    return "<h2>Over the lessons</h2>\n<div class=\"grid\">\n" + figures +
           "</div>\n<p class=\"note\">A line is a participant. Lesson 1 is the first one in a condition; 0 "
           "and negative numbers are lessons of the training, and the last lesson of a study with a "
           "retention test is that test. Within subjects the condition changes along the line, so practice "
           "and condition are seen together; the balanced order separates them only on average.</p>\n";
}

}  // namespace bolt::study
