#include <doctest/doctest.h>

#include <algorithm>

#include "support.hpp"

namespace content_mistakes_test {

using namespace content_test;

namespace {

// One edit of a correct file, and the complete list of messages that it causes.
struct FileMistake {
    const char* from;
    const char* to;
    std::vector<std::string> messages;
};

// clang-format off
const FileMistake mistakes[] = {
    {R"("size": "M8")", R"("size": "M9")",
     {R"(22:15: /joint_types/M8x30/size: "M9" is not a known thread size; expected one of M4 to M39, a fine pitch as in "M16x1.5")"}},
    {R"("size": "M8")", R"("size": "M8x1.2")",
     {R"(22:15: /joint_types/M8x30/size: "M8x1.2" is not a known thread; expected M8 with a pitch of 1.25, 1 or 0.75 mm)"}},
    {R"("size": "M8")", R"("size": 8)",
     {R"(22:15: /joint_types/M8x30/size: the number 8 is not allowed here; expected a text in double quotes)"}},
    {R"("size": "M8")", R"("sise": "M8")",
     {R"(22:7: /joint_types/M8x30/sise: unknown property "sise"; did you mean "size"?)"}},
    {R"("size": "M8",)", R"()",
     {R"(21:14: /joint_types/M8x30: required property "size" is missing; expected a text in double quotes: ISO metric thread: M16 (coarse) or M16x1.5 (fine).)"}},
    {R"("class": "8.8")", R"("class": "8,8")",
     {R"(23:16: /joint_types/M8x30/class: "8,8" is not a known property class; did you mean "8.8"?)"}},
    {R"("class": "8.8")", R"("class": "hard")",
     {R"(23:16: /joint_types/M8x30/class: "hard" is not a known property class; expected one of 4.6, 4.8, 5.6, 5.8, 6.8, 8.8, 10.9, 12.9, A2-50, A2-70, A2-80, A4-50, A4-70, A4-80)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": 25)",
     {R"(24:25: /joint_types/M8x30/bolt_length_mm: a bolt of 25 mm is too short for a grip of 19.2 mm and a nut of 6.8 mm; expected at least 27.25 mm)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": 60)",
     {R"(24:25: /joint_types/M8x30/bolt_length_mm: the nut cannot reach its seat: the thread ends 38 mm under the head, the grip is 19.2 mm; expected a shorter bolt, or bolt_thread_length_mm of at least 40.8)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": 30, "bolt_thread_length_mm": 5)",
     {R"(24:54: /joint_types/M8x30/bolt_thread_length_mm: the nut cannot reach its seat: the thread ends 25 mm under the head, the grip is 19.2 mm; expected a shorter bolt, or bolt_thread_length_mm of at least 10.8)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": 30, "bolt_thread_length_mm": 31)",
     {R"(24:54: /joint_types/M8x30/bolt_thread_length_mm: a thread of 31 mm is longer than its bolt; expected at most 30 mm)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": 30, "start_gap_mm": 12)",
     {R"(24:45: /joint_types/M8x30/start_gap_mm: a gap of 12 mm is beyond the bolt's end; expected less than 10.8 mm)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length": 30)",
     {R"(24:7: /joint_types/M8x30/bolt_length: unknown property "bolt_length"; did you mean "bolt_length_mm"?)"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": "30 mm")",
     {R"(24:25: /joint_types/M8x30/bolt_length_mm: the text "30 mm" is not allowed here; expected a number >= 3 and <= 3000 (mm))"}},
    {R"("bolt_length_mm": 30)", R"("bolt_length_mm": 0.03)",
     {R"(24:25: /joint_types/M8x30/bolt_length_mm: 0.03 is too small; expected a number >= 3 and <= 3000 (mm))"}},
    {R"("thickness_mm": 6)", R"("thickness_mm": 0.006)",
     {R"(26:27: /joint_types/M8x30/members/0/thickness_mm: 0.006 is too small; expected a number >= 0.5 and <= 1000 (mm))"}},
    {R"("thickness_mm": 6)", R"("thickness_mm": 6000)",
     {R"(26:27: /joint_types/M8x30/members/0/thickness_mm: 6000 is too large; expected a number >= 0.5 and <= 1000 (mm))"}},
    {R"("thickness_mm": 6)", R"("thickness_cm": 0.6)",
     {R"(26:11: /joint_types/M8x30/members/0/thickness_cm: unknown property "thickness_cm"; did you mean "thickness_mm"?)"}},
    {R"("material": "aluminium")", R"("material": "aluminum")",
     {R"(26:42: /joint_types/M8x30/members/0/material: "aluminum" is not a material of this file; did you mean "aluminium"?)"}},
    {R"("material": "aluminium")", R"("material": "wood")",
     {R"(26:42: /joint_types/M8x30/members/0/material: "wood" is not a material of this file; expected one of aluminium, bronze, cast_iron, ductile_iron, stainless_steel, steel, or add it to "materials")"}},
    {R"("member_diameter_mm": 30)", R"("member_diameter_mm": 10)",
     {R"(29:29: /joint_types/M8x30/member_diameter_mm: members of 10 mm diameter are smaller than the nut's bearing face; expected at least 11.6 mm)"}},
    {R"("washer_under_nut": true)", R"("washer_under_nut": "yes")",
     {R"(31:27: /joint_types/M8x30/washer_under_nut: the text "yes" is not allowed here; expected true or false)"}},
    {R"("friction_thread": 0.12)", R"("friction_thread": 12)",
     {R"(32:26: /joint_types/M8x30/friction_thread: 12 is too large; expected a number >= 0.02 and <= 0.6)"}},
    {R"("friction_thread": 0.12)", R"("friction_thread": -0.12)",
     {R"(32:26: /joint_types/M8x30/friction_thread: -0.12 is too small; expected a number >= 0.02 and <= 0.6)"}},
    {R"("friction_thread": 0.12)", R"("friction_tread": 0.12)",
     {R"(32:7: /joint_types/M8x30/friction_tread: unknown property "friction_tread"; did you mean "friction_thread"?)"}},
    {R"("lubrication": "oiled")", R"("lubrication": "oil")",
     {R"(35:22: /joint_types/M8x30/lubrication: "oil" is not known here; expected one of as_received, dry, oiled, mos2)"}},
    {R"("lubrication": "oiled")", R"("lubrication": "water")",
     {R"(35:22: /joint_types/M8x30/lubrication: "water" is not known here; expected one of as_received, dry, oiled, mos2)"}},
    {R"("strategy": "torque")", R"("strategy": "torqe")",
     {R"(37:21: /joint_types/M8x30/spec/strategy: "torqe" is not known here; did you mean "torque"?)"}},
    {R"("strategy": "torque")", R"("strategy": "torque_angle")",
     {R"(37:21: /joint_types/M8x30/spec/strategy: the strategy torque_angle needs an angle; expected min_angle_deg and max_angle_deg, and target_angle_deg where it is not their middle)"}},
    {R"("target_torque_Nm": 20)", R"("target_torque_Nm": 200)",
     {R"(38:29: /joint_types/M8x30/spec/target_torque_Nm: 200 N·m is too much for M8 of class 8.8 with friction 0.12 and 0.12: it yields near 27.2 N·m; expected at most 27.2 N·m with its tolerance)"}},
    {R"("target_torque_Nm": 20)", R"("target_torque_Nm": 26)",
     {R"(38:29: /joint_types/M8x30/spec/target_torque_Nm: 28.6 N·m (the target with its tolerance) is too much for M8 of class 8.8 with friction 0.12 and 0.12: it yields near 27.2 N·m; expected at most 27.2 N·m with its tolerance)"}},
    {R"("torque_tolerance_percent": 10)", R"("min_torque_Nm": 18, "max_torque_Nm": 30)",
     {R"(39:47: /joint_types/M8x30/spec/max_torque_Nm: 30 N·m is too much for M8 of class 8.8 with friction 0.12 and 0.12: it yields near 27.2 N·m; expected at most 27.2 N·m)"}},
    {R"("torque_tolerance_percent": 10)", R"("min_torque_Nm": 18, "max_torque_Nm": 27.2)", {}},
    {R"("strategy": "torque",
        "target_torque_Nm": 20)", R"("strategy": "yield",
        "target_torque_Nm": 31)", {}},
    {R"("strategy": "torque",
        "target_torque_Nm": 20)", R"("strategy": "yield",
        "target_torque_Nm": 33)",
     {R"(38:29: /joint_types/M8x30/spec/target_torque_Nm: 33 N·m is too much for M8 of class 8.8 with friction 0.12 and 0.12: it yields near 27.2 N·m; expected at most 31.9 N·m)"}},
    {R"("lubrication": "oiled")", R"("prevailing_torque_Nm": 10)",
     {R"(35:31: /joint_types/M8x30/prevailing_torque_Nm: a nut that takes 10 N·m to turn never loads its bolt in a pass that tightens to 10 N·m (50 percent of 20); expected at most 9 N·m)"}},
    {R"("lubrication": "oiled")", R"("prevailing_torque_Nm": 9.5)",
     {R"(35:31: /joint_types/M8x30/prevailing_torque_Nm: 9.5 N·m is too much for a locking nut M8: ISO 2320 allows 6 N·m (class 8, first assembly); expected at most 9 N·m)"}},
    {R"("lubrication": "oiled")", R"("prevailing_torque_Nm": 9)", {}},
    {R"("lubrication": "oiled",
      "spec": {
        "strategy": "torque",
        "target_torque_Nm": 20)", R"("prevailing_torque_Nm": 6,
      "spec": {
        "strategy": "torque",
        "target_torque_Nm": 12)",
     {R"(35:31: /joint_types/M8x30/prevailing_torque_Nm: a nut that takes 6 N·m to turn never loads its bolt in a pass that tightens to 6 N·m (50 percent of 12); expected less than 6 N·m, or a higher percentage)"}},
    {R"("target_torque_Nm": 20)", R"("target_torque_Nm": 0)",
     {R"(38:29: /joint_types/M8x30/spec/target_torque_Nm: 0 is too small; expected a number > 0 and <= 20000 (N·m))"}},
    {R"("target_torque_Nm": 20)", R"("target_torque_Ncm": 2000)",
     {R"(38:9: /joint_types/M8x30/spec/target_torque_Ncm: unknown property "target_torque_Ncm"; did you mean "target_torque_Nm"?)"}},
    {R"("torque_tolerance_percent": 10)", R"("torque_tolerance_percent": 10, "min_torque_Nm": 18)",
     {R"(39:9: /joint_types/M8x30/spec/torque_tolerance_percent: both a tolerance and limits of the torque; expected one or the other)",
      R"(39:41: /joint_types/M8x30/spec/min_torque_Nm: "min_torque_Nm" without "max_torque_Nm"; expected both or neither)"}},
    {R"("torque_tolerance_percent": 10)", R"("min_torque_Nm": 21, "max_torque_Nm": 22)",
     {R"(39:26: /joint_types/M8x30/spec/min_torque_Nm: 21 N·m is above the target; expected at most 20 N·m)"}},
    {R"("torque_tolerance_percent": 10)", R"("min_torque_Nm": 18, "max_torque_Nm": 19)",
     {R"(39:47: /joint_types/M8x30/spec/max_torque_Nm: 19 N·m is below the target; expected at least 20 N·m)"}},
    {R"("torque_tolerance_percent": 10)", R"("min_angle_deg": 40, "max_angle_deg": 20)",
     {R"(39:26: /joint_types/M8x30/spec/min_angle_deg: 40 degrees is above the largest angle; expected at most 20)"}},
    {R"("torque_tolerance_percent": 10)", R"("min_angle_deg": 10, "max_angle_deg": 20, "target_angle_deg": 30)",
     {R"(39:71: /joint_types/M8x30/spec/target_angle_deg: 30 degrees is outside its window; expected 10 to 20)"}},
    {R"("torque_tolerance_percent": 10)", R"("target_angle_deg": 30)",
     {R"(39:29: /joint_types/M8x30/spec/target_angle_deg: a target angle without a window; expected min_angle_deg and max_angle_deg too)"}},
    {R"("torque_tolerance_percent": 10)", R"("max_angle_deg": 30)",
     {R"(39:9: /joint_types/M8x30/spec/max_angle_deg: "max_angle_deg" without "min_angle_deg"; expected both or neither)"}},
    {R"("torque_tolerance_percent": 10)", R"("target_clamp_kN": 40)",
     {R"(39:28: /joint_types/M8x30/spec/target_clamp_kN: 40 kN breaks M8 of class 8.8; expected less than 29.3 kN)"}},
    {R"("snug_torque_Nm": 5)", R"("snug_torque_Nm": 19)",
     {R"(40:27: /joint_types/M8x30/spec/snug_torque_Nm: a snug torque of 19 N·m is not below the lowest torque that is judged OK; expected less than 18 N·m)"}},
    {R"("risk_class": "C")", R"("risk_class": "D")",
     {R"(41:23: /joint_types/M8x30/spec/risk_class: "D" is not known here; expected one of A, B, C)"}},
    {R"("jaw_mm": 13.2)", R"("jaw_mm": 12.9)",
     {R"(16:15: /tool/jaw_mm: a jaw of 12.9 mm does not fit M8, 13 mm across flats; expected 13 to 13.6 mm)"}},
    {R"("jaw_mm": 13.2)", R"("jaw_mm": 17)",
     {R"(16:15: /tool/jaw_mm: a jaw of 17 mm does not fit M8, 13 mm across flats; expected 13 to 13.6 mm)"}},
    {R"("kind": "open_end_wrench")", R"("kind": "ring_wrench")",
     {R"(15:13: /tool/kind: "ring_wrench" is not known here; expected one of open_end_wrench, click_torque_wrench)"}},
    {R"("handle_length_mm": 140)", R"("handle_length_mm": 0.14)",
     {R"(18:25: /tool/handle_length_mm: 0.14 is too small; expected a number >= 30 and <= 2000 (mm))"}},
    {R"("id": "B2")", R"("id": "B1")",
     {R"(47:13: /joints/1/id: "B1" is the "id" of another joint too; expected a name of its own; it is used first in line 46)",
      R"(51:25: /order/2: "B2" is not a joint of this file; did you mean the joint in line 47, whose id is a repetition?)"}},
    {R"("id": "B2")", R"("id": "")",
     {R"(47:13: /joints/1/id: this text is empty; expected at least one letter)"}},
    {R"("node": "joint_B2")", R"("node": "joint_B1")",
     {R"(47:44: /joints/1/node: "joint_B1" is the "node" of another joint too; expected a name of its own; it is used first in line 46)"}},
    {R"({ "id": "B2", "type": "M8x30")", R"({ "id": "B2", "type": "M8x33")",
     {R"(47:27: /joints/1/type: "M8x33" is not a joint type of this file; did you mean "M8x30"?)"}},
    {R"([50, 10, -40])", R"([50, 10])",
     {R"(47:71: /joints/1/position_mm: 2 values; expected 3)"}},
    {R"([50, 10, -40])", R"([50000, 10, -40])",
     {R"(47:72: /joints/1/position_mm/0: 50000 is too large; expected a number >= -10000 and <= 10000 (mm))"}},
    {R"([50, 10, -40])", R"([50, 10, "-40"])",
     {R"(47:80: /joints/1/position_mm/2: the text "-40" is not allowed here; expected a number >= -10000 and <= 10000 (mm))"}},
    {R"([50, 10, -40])", R"([-50, 10, -38])",
     {R"(47:71: /joints/1/position_mm: this joint is 2 mm from "B1": their nuts overlap; expected 13 mm or more)"}},
    {R"([50, 10, -40])", R"([50, 10, -40], "axis": [0, 0, 0])",
     {R"(47:94: /joints/1/axis: the axis has no length; expected a unit vector, as in [0, 1, 0])"}},
    {R"([50, 10, -40])", R"([50, 10, -40], "axis": [0, 1, 1])",
     {R"(47:94: /joints/1/axis: the axis has the length 1.414; expected a unit vector, as in [0, 1, 0])"}},
    {R"([50, 10, -40])", R"([50, 10, -40], "axis": [0, 2, 0])",
     {R"(47:98: /joints/1/axis/1: 2 is too large; expected a number >= -1 and <= 1)"}},
    {R"([50, 10, -40])", R"([50, 10, -40], "override": {"class": "10.8", "bolt_length_mm": 20})",
     {R"(47:108: /joints/1/override/class: "10.8" is not a known property class; did you mean "10.9"?)",
      R"(47:134: /joints/1/override/bolt_length_mm: a bolt of 20 mm is too short for a grip of 19.2 mm and a nut of 6.8 mm; expected at least 27.25 mm)"}},
    {R"("order": ["B1", "B3", "B2", "B4"])", R"("order": ["B1", "B3", "b5", "B4"])",
     {R"(51:25: /order/2: "b5" is not a joint of this file; did you mean "B2"?)"}},
    {R"("order": ["B1", "B3", "B2", "B4"])", R"("order": ["B1", "B3", "B1", "B4"])",
     {R"(51:12: /order: "B2" is missing in this order; expected every joint once)",
      R"(51:25: /order/2: "B1" appears twice in this order; expected every joint once; it appears first in line 51)"}},
    {R"("order": ["B1", "B3", "B2", "B4"])", R"("order": ["B1", "B3"])",
     {R"(51:12: /order: "B2", "B4" are missing in this order; expected every joint once)"}},
    {R"("order": ["B1", "B3", "B2", "B4"])", R"("order": [])",
     {R"(51:12: /order: this is empty; expected at least 1)"}},
    {R"({ "kind": "tighten", "percent": 50 })", R"({ "kind": "tighten" })",
     {R"(54:5: /passes/1: a pass of kind "tighten" without "percent"; expected a share of the target torque, 100 in the last pass)"}},
    {R"({ "kind": "tighten", "percent": 50 })", R"({ "kind": "tighten", "percent": 0.5, "order": ["B1", "B2", "B3"] })",
     {R"(54:51: /passes/1/order: "B4" is missing in this order; expected every joint once)"}},
    {R"({ "kind": "tighten", "percent": 50 })", R"({ "kind": "run_down", "percent": 50 })",
     {R"(54:38: /passes/1/percent: only a pass of kind "tighten" has a share of the target; expected no "percent" here)"}},
    {R"({ "kind": "tighten", "percent": 100 })", R"({ "kind": "tighten", "percent": 40 })",
     {R"(55:37: /passes/2/percent: 40 percent after 50 percent; expected shares that do not fall, and 100 in the last pass)"}},
    {R"({ "kind": "tighten", "percent": 100 })", R"({ "kind": "tighten", "percent": 90 })",
     {R"(55:37: /passes/2/percent: the last pass tightens to 90 percent only; expected 100)"}},
    {R"({ "kind": "tighten", "percent": 100 })", R"({ "kind": "tighten", "percent": 110 })",
     {R"(55:37: /passes/2/percent: 110 is too large; expected a number > 0 and <= 100)"}},
    {R"({ "kind": "run_down" },)", R"()",
     {R"(54:15: /passes/0/kind: this pass tightens before the nuts are run down; expected a pass of kind "run_down" first)"}},
    {R"({ "kind": "run_down" },)", R"({ "kind": "recheck" }, { "kind": "run_down" },)",
     {R"(53:15: /passes/0/kind: this pass rechecks before the nuts are run down; expected a pass of kind "run_down" first)"}},
    {R"({ "kind": "tighten", "percent": 50 },)", R"({ "kind": "tighten", "percent": 50 }, { "kind": "recheck" },)",
     {R"(54:53: /passes/2/kind: this pass rechecks before the last pass that tightens, in line 55; expected a recheck after that pass)"}},
    {R"({ "kind": "tighten", "percent": 50 },
    { "kind": "tighten", "percent": 100 },)", R"()",
     {R"(52:13: /passes: no pass tightens; expected a pass of kind "tighten" with 100 percent)"}},
    {R"({ "kind": "tighten", "percent": 50 },)", R"({ "kind": "run_down" }, { "kind": "tighten", "percent": 50 },)", {}},
    {R"("kind": "recheck")", R"("kind": "check")",
     {R"(56:15: /passes/3/kind: "check" is not known here; did you mean "recheck"?)"}},
    {R"("views": [)", R"("view": [)",
     {R"(58:3: /view: unknown property "view"; did you mean "views"?)"}},
    {R"("name": "top")", R"("name": "front")",
     {R"(60:15: /views/1/name: there are two views "front"; expected a name of its own)"}},
    {R"("eye_mm": [0, 500, 1])", R"("eye_mm": [0, 10, 0])",
     {R"(60:57: /views/1/target_mm: the target of the view is its eye point; expected another point)"}},
    {R"("tool": {)", R"("law": "published", "published": {"theta_max_turns": 0.3}, "tool": {)",
     {R"(14:36: /published: the nut would be on its seat 16 degrees before it is started; expected a larger theta_max_turns or narrower stages)"}},
    {R"("tool": {)", R"("law": "published", "published": {"D1_mm": 10}, "tool": {)",
     {R"(14:36: /published: D1 of 10 mm is no larger than D2; expected more than 14.7 mm)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 72.1}, "tool": {)", {}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 78}, "tool": {)",
     {R"(14:37: /published/target_torque_Nm: 78 N·m is never reached: the published law ends at a T_max of 72.126 N·m; expected at most 72.126 N·m)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 78, "T_max_Nm": 80}, "tool": {)", {}},
    {R"("tool": {)", R"("published": {"snug_torque_Nm": 20}, "tool": {)",
     {R"(14:17: /published/snug_torque_Nm: "snug_torque_Nm" without "target_torque_Nm"; expected the target too, or neither)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 72, "snug_torque_Nm": 70}, "tool": {)",
     {R"(14:59: /published/snug_torque_Nm: a snug torque of 70 N·m is not below the lowest torque that is judged OK; expected less than 64.8 N·m)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 72, "min_torque_Nm": 70}, "tool": {)",
     {R"(14:41: /published/min_torque_Nm: "min_torque_Nm" without "max_torque_Nm"; expected both or neither)"}},
    {R"("tool": {)", R"("published": {"target_torque": 72}, "tool": {)",
     {R"(14:17: /published/target_torque: unknown property "target_torque"; did you mean "target_torque_Nm"?)"}},
    {R"("tool": {)", R"("published": {"kappa1_Nm_per_deg2": 0.1}, "tool": {)",
     {R"(14:16: /published: the torque would be -737.9 N·m where yield begins; expected a smaller kappa1_Nm_per_deg2 or yield_width_deg, or a larger T_max_Nm)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 72, "min_angle_deg": 40}, "tool": {)",
     {R"(14:41: /published/min_angle_deg: "min_angle_deg" without "max_angle_deg"; expected both or neither)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 72, "target_angle_deg": 90}, "tool": {)",
     {R"(14:61: /published/target_angle_deg: a target angle without a window; expected min_angle_deg and max_angle_deg too)"}},
    {R"("tool": {)", R"("published": {"target_torque_Nm": 72, "target_angle_deg": 130, "min_angle_deg": 40, "max_angle_deg": 120}, "tool": {)",
     {R"(14:61: /published/target_angle_deg: 130 degrees is outside its window; expected 40 to 120)"}},
    {R"("tool": {)", R"("published": {"min_angle_deg": 40, "max_angle_deg": 120}, "tool": {)",
     {R"(14:17: /published/min_angle_deg: "min_angle_deg" without "target_torque_Nm"; expected the target too, or neither)",
      R"(14:38: /published/max_angle_deg: "max_angle_deg" without "target_torque_Nm"; expected the target too, or neither)"}},
    {R"("lubrication": "oiled")", R"("lubrication": "oiled", "published": {"T_max_Nm": 70})", {}},
    {R"("lubrication": "oiled")", R"("lubrication": "oiled", "published": {"T_max_Nm": 70, "target_torque_Nm": 71})",
     {R"(35:81: /joint_types/M8x30/published/target_torque_Nm: 71 N·m is never reached: the published law ends at a T_max of 70 N·m; expected at most 70 N·m)"}},
    {R"("lubrication": "oiled")", R"("lubrication": "oiled", "published": {"spring_rates_MN_per_mm": [1, 2, 3]})",
     {R"(35:71: /joint_types/M8x30/published/spring_rates_MN_per_mm: 3 values; expected 7)"}},
    {R"("lubrication": "oiled")", R"("lubrication": "oiled", "published": {"kapa": 3})",
     {R"(35:45: /joint_types/M8x30/published/kapa: unknown property "kapa"; did you mean "kappa"?)"}},
    {R"("lubrication": "oiled")", R"("lubrication": "oiled", "published": {"theta_max_turns": 0.2})",
     {R"(35:44: /joint_types/M8x30/published: the nut would be on its seat 52 degrees before it is started; expected a larger theta_max_turns or narrower stages)"}},
    {R"("tool": {)", R"("flange": {"thickness_mm": 20, "E_GPa": 110, "poisson": 0.5}, "tool": {)",
     {R"(14:13: /flange: required property "interface_stiffness_GPa_per_m" is missing; expected a number > 0 and <= 100000: GPa per metre of approach: machined faces 1000 and more, with sealant or a gasket less.)",
      R"(14:59: /flange/poisson: 0.5 is too large; expected a number >= 0 and <= 0.49)"}},
    {R"("tool": {)", R"("default_variant": "steel", "tool": {)",
     {R"(14:22: /default_variant: "steel" is not a variant of this file; expected none: the file has no variants)"}},
    {R"("tool": {)", R"("variants": {"hot": {"joint_types": {"M8x40": {}}}}, "default_variant": "hut", "tool": {)",
     {R"(14:40: /variants/hot/joint_types/M8x40: "M8x40" is not a joint type of this file; did you mean "M8x30"?)",
      R"(14:75: /default_variant: "hut" is not a variant of this file; did you mean "hot"?)"}},
    {R"("tool": {)", R"("variants": {"hot": {"every_joint_type": {"class": "4.6"}}}, "tool": {)",
     {R"(38:29: /joint_types/M8x30/spec/target_torque_Nm: 20 N·m is too much for M8 of class 4.6 with friction 0.12 and 0.12: it yields near 10.2 N·m; expected at most 10.2 N·m with its tolerance)"}},
    {R"("tool": {)", R"("tool": {}, "tool": {)",
     {R"(14:11: /tool: required property "handle_length_mm" is missing; expected a number >= 30 and <= 2000: mm, from the middle of the jaw to the middle of the grip.)",
      R"(14:11: /tool: required property "jaw_mm" is missing; expected a number >= 3 and <= 150: mm; the width across flats of the nuts and up to 0.6 mm more.)",
      R"(14:11: /tool: required property "kind" is missing; expected one of open_end_wrench, click_torque_wrench: Kind of wrench.)",
      R"(14:15: /tool: "tool" is given twice; expected one value; the first is in line 14)"}},
    {R"("tool": {)", R"("law": 1, "title": [], "tool": {)",
     {R"(14:10: /law: the number 1 is not allowed here; expected one of mechanistic, published)",
      R"(14:13: /title: "title" is given twice; expected one value; the first is in line 3)"}},
    {R"("en": "Cover with four M8 bolts",)", R"()",
     {R"(3:12: /title: required property "en" is missing; expected a text in double quotes: English text, shown where a language is missing.)"}},
    {R"("en": "Cover with four M8 bolts",)", R"("en": "",)",
     {R"(4:11: /title/en: this text is empty; expected at least one letter)"}},
    {R"("joints": [)", R"("joints": [], "joint": [)",
     {R"(45:13: /joints: this is empty; expected at least 1)",
      R"(45:17: /joint: unknown property "joint"; did you mean "joints"?)"}},
    {R"("joint_types": {)", R"("joint_types": {}, "other": {)",
     {R"(20:18: /joint_types: this is empty; expected at least 1)",
      R"(20:22: /other: unknown property "other"; did you mean "order"?)"}},
    {R"("lubrication": "oiled")", R"("lubricant": "oiled")",
     {R"(35:7: /joint_types/M8x30/lubricant: unknown property "lubricant"; expected one of bolt_thread_length_mm, embedding_time_s, friction_static_ratio, lubrication, misfit_um, nut_mass_g, nut_proof_stress_MPa, prevailing_torque_Nm, published, roughness_Rz_um, running_torque_Nm, start_gap_mm)"}},
    {R"("risk_class": "C")", R"("risk_class": "c")",
     {R"(41:23: /joint_types/M8x30/spec/risk_class: "c" is not known here; did you mean "C"?)"}},
    {R"({ "id": "B2", "type": "M8x30")", R"({ "id": "B2", "Type": "M8x30")",
     {R"(47:19: /joints/1/Type: unknown property "Type"; did you mean "type"?)"}},
    {R"("order": ["B1", "B3", "B2", "B4"])", R"("order": ["B1", "B3", "B2", "B4", "B5"])",
     {R"(51:37: /order/4: "B5" is not a joint of this file; expected every joint once, and nothing else)"}},
    {R"("order": ["B1", "B3", "B2", "B4"])", R"("order": ["B1", "B3", "b2", "B4"])",
     {R"(51:25: /order/2: "b2" is not a joint of this file; did you mean "B2"?)"}},
    {R"("joints": [)", R"("joints": 4, "joint": [)",
     {R"(45:13: /joints: the number 4 is not allowed here; expected a list of 1 to 500 values)",
      R"(45:16: /joint: unknown property "joint"; did you mean "joints"?)"}},
    {R"("spec": {)", R"("specs": {)",
     {R"(36:7: /joint_types/M8x30/specs: unknown property "specs"; did you mean "spec"?)"}},
    {R"("joint_types": {)", R"("joint_types": {"x~/y": {"spec": 3}, )",
     {R"(20:27: /joint_types/x~0~1y: required property "bolt_length_mm" is missing; expected a number >= 3 and <= 3000: mm, under the head.)",
      R"(20:27: /joint_types/x~0~1y: required property "class" is missing; expected a text in double quotes: Of the bolt: ISO 898-1 (4.6 to 12.9) or ISO 3506-1 (A2-70, ...).)",
      R"(20:27: /joint_types/x~0~1y: required property "friction_bearing" is missing; expected a number >= 0.02 and <= 0.6: Running coefficient µ_K under the turned nut.)",
      R"(20:27: /joint_types/x~0~1y: required property "friction_thread" is missing; expected a number >= 0.02 and <= 0.6: Running coefficient µ_G (VDI 2230 class B, oiled: 0.08 to 0.16).)",
      R"(20:27: /joint_types/x~0~1y: required property "members" is missing; expected a list of 1 to 20 values: The clamped parts from head to nut, without washers.)",
      R"(20:27: /joint_types/x~0~1y: required property "size" is missing; expected a text in double quotes: ISO metric thread: M16 (coarse) or M16x1.5 (fine).)",
      R"(20:36: /joint_types/x~0~1y/spec: the number 3 is not allowed here; expected an object {...})"}},
};
// clang-format on

}  // namespace

TEST_CASE("Errors: every mistake is reported at its position with an expectation") {
    const std::string good = cover();
    for (const FileMistake& c : mistakes) {
        CAPTURE(std::string(c.from));
        CAPTURE(std::string(c.to));
        const std::vector<std::string> given = messages(edited(good, c.from, c.to));
        CHECK(given.size() == c.messages.size());
        for (std::size_t i = 0; i < std::min(given.size(), c.messages.size()); ++i)
            CHECK(given[i] == c.messages[i]);
    }
}

TEST_CASE("Errors: all mistakes of a file are reported in one run, in the order of the file") {
    std::string text = cover();
    const auto edit = [&](const char* from, const char* to) { text = edited(std::move(text), from, to); };
    edit("\"jaw_mm\": 13.2", "\"jaw_mm\": 17");
    edit("\"class\": \"8.8\"", "\"class\": \"8.9\"");
    edit("\"bolt_length_mm\": 30", "\"bolt_length_mm\": 20");
    edit("\"member_diameter_mm\": 30", "\"member_diameter_mm\": 10");
    edit("\"snug_torque_Nm\": 5", "\"snug_torque_Nm\": 19");
    edit("\"material\": \"aluminium\"", "\"material\": \"aluminum\"");
    edit("\"friction_thread\": 0.12", "\"friction_thread\": true");
    edit("\"strategy\": \"torque\"", "\"strategy\": \"torqe\"");
    edit("\"type\": \"M8x30\", \"node\": \"joint_B2\"", "\"type\": \"M8x31\", \"node\": \"joint_B1\"");
    edit("[50, 10, 40]", "[50, 10]");
    edit("\"B1\", \"B3\", \"B2\", \"B4\"]", "\"B1\", \"B3\", \"B4\"]");
    edit("\"percent\": 50", "\"percents\": 50");
    edit("\"name\": \"top\"", "\"name\": \"front\"");
    const std::vector<std::string> expected = {
        "16:15: /tool/jaw_mm: a jaw of 17 mm does not fit M8, 13 mm across flats; expected 13 to 13.6 mm",
        "23:16: /joint_types/M8x30/class: \"8.9\" is not a known property class; did you mean \"8.8\"?",
        "24:25: /joint_types/M8x30/bolt_length_mm: a bolt of 20 mm is too short for a grip of 19.2 mm and a "
        "nut of 6.8 mm; expected at least 27.25 mm",
        "26:42: /joint_types/M8x30/members/0/material: \"aluminum\" is not a material of this file; did you "
        "mean "
        "\"aluminium\"?",
        "29:29: /joint_types/M8x30/member_diameter_mm: members of 10 mm diameter are smaller than the nut's "
        "bearing face; expected at least 11.6 mm",
        "32:26: /joint_types/M8x30/friction_thread: true is not allowed here; expected a number >= 0.02 and "
        "<= "
        "0.6",
        "37:21: /joint_types/M8x30/spec/strategy: \"torqe\" is not known here; did you mean \"torque\"?",
        "40:27: /joint_types/M8x30/spec/snug_torque_Nm: a snug torque of 19 N·m is not below the lowest "
        "torque that is judged OK; expected less than 18 N·m",
        "47:27: /joints/1/type: \"M8x31\" is not a joint type of this file; did you mean \"M8x30\"?",
        "47:44: /joints/1/node: \"joint_B1\" is the \"node\" of another joint too; expected a name of its "
        "own; it is "
        "used first in line 46",
        "48:71: /joints/2/position_mm: 2 values; expected 3",
        "51:12: /order: \"B2\" is missing in this order; expected every joint once",
        "54:26: /passes/1/percents: unknown property \"percents\"; did you mean \"percent\"?",
        "60:15: /views/1/name: there are two views \"front\"; expected a name of its own",
    };
    CHECK(messages(text) == expected);
}

TEST_CASE("Errors: a duplicate id hides no mistake of an order") {
    const std::string good = edited(cover(), "\"id\": \"B2\"", "\"id\": \"B1\"");
    const std::string twice =
        "47:13: /joints/1/id: \"B1\" is the \"id\" of another joint too; expected a name of its own; it is "
        "used "
        "first in line 46";
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
    CHECK(
        given("[\"B1\", \"Q99\", \"B2\", \"B4\"]") ==
        Messages{
            "51:19: /order/1: \"Q99\" is not a joint of this file; did you mean the joint in line 47, whose "
            "id is a repetition? If not, expected \"B3\"",
            "51:26: /order/2: \"B2\" is not a joint of this file; did you mean the joint in line 47, whose "
            "id is a repetition? If not, did you mean \"B3\"?"});
    CHECK(given("[\"B1\", \"B1\", \"B3\"]") ==
          Messages{"51:12: /order: \"B4\" is missing in this order; expected every joint once"});
    CHECK(
        given("[\"B1\", \"B3\", \"B4\", \"B4\"]") ==
        Messages{"51:31: /order/3: \"B4\" appears twice in this order; expected every joint once; it appears "
                 "first in line 51"});
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
        CHECK(expected(unknown) == "one of M4 to M39, a fine pitch as in \"M16x1.5\"");
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

}  // namespace content_mistakes_test
