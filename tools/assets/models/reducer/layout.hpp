// All dimensions of the reducer. Millimetres, CAD frame: X along the reducer from the input to the output
// shaft, Y across, Z up, the origin on the input shaft in the parting plane at mid width.
//
// Sources:
// - teeth, modules, helix angle, centre distances: JZQ/ZQ series (85/14 m3, 83/16 m4, 8 deg 06' 35")
// - 12 bolts M16x180 and M16x75, members of 75 and 24: content/assemblies/zq350/assembly.json
// - bearings 6306, 6309, 6213: boundary dimensions of ISO 15
// - keys and keyways: ISO/R 773 (DIN 6885-1)
// - bolt holes of 17.5, washers, screws: ISO 273 medium, ISO 7089, ISO 4762
// - gear teeth: ISO 53 profile A, ISO 21771
//
// No public table gives the other dimensions. They follow rules of thumb for cast reducer casings: wall >= 8,
// flanges 2 to 2.5 walls, bolt axis >= 22 from the wall for M16, wheel to wall >= 5, wheel to floor >= 30.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "tools/assets/models/reducer/gear.hpp"

namespace bolt::models::reducer {

inline constexpr double helix_angle = (8.0 + 6.0 / 60.0 + 35.0 / 3600.0) * 0.017453292519943295;

struct ShaftLayout {
    double x = 0.0;
    double bearing_bore = 0.0, bearing_outer = 0.0, bearing_width = 0.0;  // ISO 15
    double boss_radius = 0.0;  // of the bearing boss; the end cap is 2 mm smaller
    int cap_screws = 0;        // M8
};

inline constexpr std::array<ShaftLayout, 3> shafts{{{0.0, 30.0, 72.0, 19.0, 58.0, 4},
                                                    {150.0, 45.0, 100.0, 25.0, 70.0, 4},
                                                    {350.0, 65.0, 120.0, 23.0, 82.0, 6}}};

// The first pair is on the +Y side, the second on the -Y side. Both gears on the intermediate shaft have the
// same hand, so that their axial forces, one driven and one driving, oppose each other.
inline constexpr double pair_1_y = 48.0, pair_2_y = -38.0;
inline constexpr GearSpec pinion_1{14, 3.0, helix_angle, HelixHand::left, 0.16, 65.0, 0.06};
inline constexpr GearSpec wheel_1{85, 3.0, helix_angle, HelixHand::right, -0.16, 60.0, 0.06};
inline constexpr GearSpec pinion_2{16, 4.0, helix_angle, HelixHand::right, 0.04, 85.0, 0.08};
inline constexpr GearSpec wheel_2{83, 4.0, helix_angle, HelixHand::left, -0.04, 80.0, 0.08};

// The casing.
inline constexpr double wall = 9.0;
inline constexpr double draft = 0.026179938779914945;  // 1.5 degrees
inline constexpr double half_width = 99.0;             // |y| of the wall's outside at the parting plane
inline constexpr double wall_left = -120.0, wall_right = 540.0;
inline constexpr double seat_inner = 91.0, seat_outer = 153.0;  // |y| between which the bearing seats lie
inline constexpr double bearing_inner = 100.0;                  // |y| of the bearings' inner side
inline constexpr double flange_thickness = 24.0, flange_half_width = 138.0;
inline constexpr double flange_left = -172.0, flange_right = 587.0, flange_corner = 45.0;
inline constexpr double boss_height = 75.0, boss_radius = 21.5;  // of the bolt bosses beside the bearings
inline constexpr double casting_overhang =
    0.8;  // overhang of the lower casting at the parting plane, all round
inline constexpr double sole_z = -225.0, floor_z = -213.0;
inline constexpr double oil_z = -118.0;
inline constexpr double bolt_hole = 17.5, spot_face = 34.0;
inline constexpr double spot_depth = 0.8;  // machining allowance of the cast bosses and flanges

struct ContourCircle {
    double x = 0.0, z = 0.0, r = 0.0;
};
// Seen from the side, the casing's outside is the hull of these circles. Upper half: input end, first and
// second wheel. Lower half, in a frame with Z down: the two rounded corners of the sump.
inline constexpr std::array<ContourCircle, 3> contour_upper{
    {{wall_left + 50.0, 58.0, 50.0}, {150.0, 0.0, 151.0}, {350.0, 0.0, wall_right - 350.0}}};
inline constexpr std::array<ContourCircle, 2> contour_lower{
    {{wall_left + 44.0, -floor_z - 40.0, 40.0}, {wall_right - 44.0, -floor_z - 40.0, 40.0}}};

inline constexpr std::array<double, 2> feet{0.0, 350.0};  // x, on both sides
inline constexpr double foot_half_length = 54.0, foot_thickness = 24.0, foot_outer = 168.0, foot_inner = 55.0;
inline constexpr double foot_hole = 22.0, foot_hole_offset = 33.0, foot_hole_y = 138.0, foot_spot_depth = 1.0;
inline constexpr std::array<std::pair<double, double>, 2> dowels{{{-146.0, 104.0}, {567.0, -104.0}}};

struct JointLayout {
    std::string_view id;
    double x = 0.0, y = 0.0;  // CAD frame: y is -z of the assembly file
    bool at_bearing = false;  // true: M16x180 through the bosses; false: M16x75 in the end flanges
};
inline constexpr std::array<JointLayout, 12> joints{{{"B1", -75.0, 125.0, true},
                                                     {"B2", 75.0, 125.0, true},
                                                     {"B3", 250.0, 125.0, true},
                                                     {"B4", 425.0, 125.0, true},
                                                     {"B5", 425.0, -125.0, true},
                                                     {"B6", 250.0, -125.0, true},
                                                     {"B7", 75.0, -125.0, true},
                                                     {"B8", -75.0, -125.0, true},
                                                     {"F1", -150.0, 70.0, false},
                                                     {"F2", 565.0, 70.0, false},
                                                     {"F3", 565.0, -70.0, false},
                                                     {"F4", -150.0, -70.0, false}}};

// The thickness of each of the joint's two members.
inline constexpr double thickness(const JointLayout& joint) {
    return joint.at_bearing ? boss_height : flange_thickness;
}

}  // namespace bolt::models::reducer
