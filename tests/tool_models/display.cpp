// The display of an electronic torque wrench.
#include <doctest/doctest.h>

#include <set>
#include <string>

#include "game/tool_models/display.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::tool_models::display_test {

namespace {

// The digits as they are drawn: three rows of three characters each, as text.
std::string drawn_digit(int digit, double value) {
    const auto on = [&](int segment) {
        return is_on({DisplayElement::Kind::segment, digit, segment}, {value});
    };
    std::string text;
    text += on(0) ? " _ " : "   ";
    text += on(5) ? "|" : " ";
    text += on(6) ? "_" : " ";
    text += on(1) ? "|" : " ";
    text += on(4) ? "|" : " ";
    text += on(3) ? "_" : " ";
    text += on(2) ? "|" : " ";
    return text;
}

constexpr const char* digits[] = {" _ | ||_|", "     |  |", " _  _||_ ", " _  _| _|", "   |_|  |",
                                  " _ |_  _|", " _ |_ |_|", " _   |  |", " _ |_||_|", " _ |_| _|"};
constexpr const char* blank = "         ";

}  // namespace

TEST_CASE("Tool display: it shows a number with one decimal place and no leading zeros") {
    const auto shows = [](double value, const char* a, const char* b, const char* c, const char* d) {
        CAPTURE(value);
        CHECK(drawn_digit(0, value) == a);
        CHECK(drawn_digit(1, value) == b);
        CHECK(drawn_digit(2, value) == c);
        CHECK(drawn_digit(3, value) == d);
    };
    shows(0.0, blank, blank, digits[0], digits[0]);
    shows(0.26, blank, blank, digits[0], digits[3]);
    shows(9.97, blank, digits[1], digits[0], digits[0]);
    shows(78.4, blank, digits[7], digits[8], digits[4]);
    shows(205.8, digits[2], digits[0], digits[5], digits[8]);
    shows(-136.9, digits[1], digits[3], digits[6], digits[9]);
    shows(2500.0, digits[9], digits[9], digits[9], digits[9]);
}

TEST_CASE("Tool display: the drawn wrench has all its nodes, and other tools have none") {
    for (const ModelKind kind : {ModelKind::electronic_torque_wrench, ModelKind::click_torque_wrench}) {
        ToolParameters p;
        p.kind = kind;
        p.size = 24.0 * mm;
        std::set<std::string> found;
        for (const assets::Node& node : drawn_model(*completed(p)).nodes)
            if (display_element(node.name)) found.insert(node.name);
        CHECK(found.size() == (kind == ModelKind::electronic_torque_wrench ? 4 * 7 + 3 : 0));
    }
    CHECK_FALSE(display_element("segment_4_0"));
    CHECK_FALSE(display_element("segment_0_7"));
    CHECK_FALSE(display_element("segment_00"));
    CHECK_FALSE(display_element("segment_0x5"));
    CHECK_FALSE(display_element("lights"));
}

TEST_CASE("Tool display: each ring of light follows its own state, and the point is always on") {
    using Kind = DisplayElement::Kind;
    CHECK_FALSE(is_on({Kind::reached}, {}));
    CHECK_FALSE(is_on({Kind::exceeded}, {}));
    CHECK(is_on({Kind::reached}, {.reached = true}));
    CHECK_FALSE(is_on({Kind::exceeded}, {.reached = true}));
    CHECK(is_on({Kind::exceeded}, {.exceeded = true}));
    CHECK_FALSE(is_on({Kind::reached}, {.exceeded = true}));
    CHECK(is_on({Kind::point}, {}));
}

}  // namespace bolt::tool_models::display_test
