// One mistake is reported once: its consequences are not reported as mistakes of their own.
#include <doctest/doctest.h>

#include <algorithm>

#include "support.hpp"

namespace content_consequences_test {

using namespace content_test;

TEST_CASE("Errors: a duplicate id hides no mistake of an order") {
    const std::string good = edited(cover(), "\"id\": \"B2\"", "\"id\": \"B1\"");
    const std::string twice =
        "47:13: /joints/1/id: \"B1\" is the \"id\" of another joint too; expected a name of its own; it is "
        "used first in line 46";
    const auto given = [&](const char* order) {
        auto all = messages(edited(good, "[\"B1\", \"B3\", \"B2\", \"B4\"]", order));
        REQUIRE(!all.empty());
        CHECK(all[0] == twice);
        all.erase(all.begin());
        return all;
    };
    using Messages = std::vector<std::string>;
    CHECK(given("[\"B1\", \"B3\", \"B1\", \"B4\"]").empty());
    CHECK(given("[\"B1\", \"B3\", \"B4\"]").empty());
    CHECK(given("[\"B1\", \"Q99\", \"B2\", \"B4\"]") ==
          Messages{"51:19: /order/1: \"Q99\" is not a joint of this file; did you mean the joint in line 47, "
                   "whose id is a repetition? If not, expected \"B3\"",
                   "51:26: /order/2: \"B2\" is not a joint of this file; did you mean the joint in line 47, "
                   "whose id is a repetition? If not, did you mean \"B3\"?"});
    CHECK(given("[\"B1\", \"B1\", \"B3\"]") ==
          Messages{"51:12: /order: \"B4\" is missing in this order; expected every joint once"});
    CHECK(given("[\"B1\", \"B3\", \"B4\", \"B4\"]") ==
          Messages{"51:31: /order/3: \"B4\" appears twice in this order; expected every joint once; it "
                   "appears first in line 51"});
}

TEST_CASE("Errors: a joint without a usable id explains one unknown name of an order, not two") {
    const std::string good = edited(cover(), "\"id\": \"B2\"", "\"id\": 2");
    CHECK(messages(good).size() == 1);
    const auto all = messages(edited(good, "\"B1\", \"B3\",", "\"B1\", \"Q99\","));
    REQUIRE(all.size() == 3);
    CHECK(all[1] == "51:19: /order/1: \"Q99\" is not a joint of this file; expected \"B3\"");
}

TEST_CASE("Errors: a rejected value skips only the checks that need it") {
    const auto with = [](const char* from, const char* to) {
        const std::string text = edited(cover(), from, to);
        return messages(edited(edited(text, "\"bolt_length_mm\": 30", "\"bolt_length_mm\": 20"),
                               "\"snug_torque_Nm\": 5", "\"snug_torque_Nm\": 19"));
    };
    // Three errors: the edit, the short bolt and the snug torque.
    CHECK(with("\"class\": \"8.8\"", "\"class\": \"88\"").size() == 3);
    CHECK(with("\"class\": \"8.8\"", "\"clas\": \"8.8\"").size() == 3);
    CHECK(with("\"class\": \"8.8\"", "\"class\": 8.8").size() == 3);
    CHECK(with("\"risk_class\": \"C\"", "\"risk_class\": \"D\"").size() == 3);
    CHECK(with("\"lubrication\": \"oiled\"", "\"lubrication\": \"wet\"").size() == 3);
    // The bolt length cannot be checked without the size, nor the torques without the target.
    CHECK(with("\"size\": \"M8\"", "\"size\": \"M9\"").size() == 2);
    CHECK(with("\"target_torque_Nm\": 20", "\"target_torqe_Nm\": 20").size() == 2);
    CHECK(with("\"spec\": {", "\"specs\": {").size() == 2);
}

TEST_CASE("Errors: a thread in another notation gives the correct spelling, never another diameter") {
    const auto expected = [](const std::string& size) {
        const auto loaded =
            bolt::content::parse_assembly(edited(cover(), "\"M8\",", "\"" + size + "\","), "f");
        CAPTURE(size);
        REQUIRE(loaded.errors.size() >= 1);
        return loaded.errors.front().pointer.ends_with("/size") ? loaded.errors.front().expected
                                                                : "elsewhere";
    };
    CHECK(expected("M8 x 1.25") == "did you mean \"M8x1.25\"?");
    CHECK(expected("M12 x 1.75") == "did you mean \"M12x1.75\"?");
    CHECK(expected("M16 x 2") == "did you mean \"M16x2\"?");
    CHECK(expected("M16X1,5") == "did you mean \"M16x1.5\"?");
    CHECK(expected("m 16 × 1,5") == "did you mean \"M16x1.5\"?");
    CHECK(expected("M16*2") == "did you mean \"M16x2\"?");
    CHECK(expected("M16 2") == "did you mean \"M16x2\"?");
    CHECK(expected(" M8") == "did you mean \"M8\"?");
    CHECK(expected("N8") == "did you mean \"M8\"?");
    CHECK(expected("M 8 x 1.2") == "M8 with a pitch of 1.25, 1 or 0.75 mm");
    CHECK(expected("M12x1.57") == "M12 with a pitch of 1.75, 1.5, 1.25 or 1 mm");
    for (const char* unknown :
         {"M9", "M7x1", "M1 6", "M13 x 1.75", "M88", "M1O", "M", "", "x", "M12.5", "16M"}) {
        CAPTURE(unknown);
        CHECK(expected(unknown) ==
              "one of M4, M5, M6, M8, M10, M12, M14, M16, M18, M20, M22, M24, M27, M30, M33, M36, M39, or "
              "a fine thread such as \"M16x1.5\"");
    }
}

TEST_CASE("Errors: a mistake of a variant is reported once, however many variants share it") {
    std::string text = shipped("zq350");
    text = edited(std::move(text), "\"class\": \"A2-70\"", "\"class\": \"A2-71\"");
    REQUIRE(messages(text).size() == 1);
    CHECK(
        messages(text)[0].ends_with(": /variants/stainless/every_joint_type/class: \"A2-71\" is not a known "
                                    "property class; did you mean \"A2-70\"?"));
    text = edited(shipped("zq350"), "\"bolt_length_mm\": 180", "\"bolt_length_mm\": 160");
    CHECK(messages(text).size() == 1);
}

TEST_CASE("Errors: the list of errors is limited to 200") {
    std::string joints;
    for (int i = 0; i < 400; ++i) joints += "{\"id\": 1},\n";
    const auto all = messages(edited(cover(), "\"joints\": [", "\"joints\": [" + joints));
    CHECK(all.size() == 201);
    CHECK(all.back().find("are not shown: fix those above first") != std::string::npos);
}

}  // namespace content_consequences_test
