// ISO metric threads and fasteners: thread geometry (ISO 68-1 basic profile, ISO 724 basic dimensions), the
// sizes M4 to M39 of bolts, nuts, washers and holes, socket heads and locking nuts, and the strength of
// property classes and stainless grades.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::joint {

// All lengths in metres, symbols as the standards write them.
struct ScrewThread {
    double d = 0.0;      // nominal (major) diameter
    double pitch = 0.0;  // P
    double d2 = 0.0;     // pitch diameter, d − 0.64952 P
    double d3 = 0.0;     // minor diameter of the bolt, d − 1.22687 P
    double A_s = 0.0;    // tensile stress area, π/4 ((d2 + d3)/2)², m² (ISO 898-1)

    [[nodiscard]] double d0() const { return 0.5 * (d2 + d3); }        // diameter of the stress area
    [[nodiscard]] double A_d3() const { return 0.25 * pi * d3 * d3; }  // core section
    [[nodiscard]] double A_N() const { return 0.25 * pi * d * d; }     // nominal section
};

inline constexpr double thread_half_angle = pi / 6.0;  // β, flank angle of the ISO profile

// Needs 0 < pitch and d − 1.22687 pitch > 0.
inline ScrewThread metric_thread(double d, double pitch) {
    ScrewThread t;
    t.d = d;
    t.pitch = pitch;
    t.d2 = d - 0.64952 * pitch;
    t.d3 = d - 1.22687 * pitch;
    t.A_s = 0.25 * pi * square(0.5 * (t.d2 + t.d3));
    return t;
}

// Metres. Bolt ISO 4014/4017, nut ISO 4032 (style 1), washer ISO 7089, hole ISO 273 medium, thread ISO 261.
struct FastenerSize {
    std::string_view name;  // "M16"
    double d = 0.0;         // nominal diameter
    double coarse_pitch = 0.0;
    double fine_pitches[3] = {};  // 0 where there is none
    double across_flats = 0.0;    // s of head and nut (M10, M12, M14, M22: ISO 272, not the old DIN 934)
    double head_height = 0.0;     // k
    double head_bearing = 0.0;    // d_w min of the bolt head
    double nut_height = 0.0;      // m max
    double nut_bearing = 0.0;     // d_w min of the nut
    double washer_inner = 0.0;
    double washer_outer = 0.0;
    double washer_thickness = 0.0;
    double hole = 0.0;  // d_h, medium series
};

// All sizes, the smallest first.
std::span<const FastenerSize> fastener_sizes();

// The head of a hexagon socket head cap screw, ISO 4762 (= DIN 912). Metres, symbols as the standard writes
// them.
struct SocketHead {
    std::string_view size;      // "M16"
    double diameter = 0.0;      // d_k max, without knurling
    double height = 0.0;        // k max
    double across_flats = 0.0;  // s of the socket
    double depth = 0.0;         // t min, of the socket
    double bearing = 0.0;       // d_w min
};

// Null if the table lacks the size.
const SocketHead* socket_head(std::string_view size);

// A prevailing-torque nut of class 8 with a non-metallic insert: height of ISO 7040, torques of ISO 2320.
struct LockingNut {
    std::string_view size;
    double height = 0.0;         // h max, m
    double most_on = 0.0;        // N·m, at most while it is screwed on for the first time
    double least_off = 0.0;      // N·m, at least while it is unscrewed for the first time
    double least_off_5th = 0.0;  // N·m, at least while it is unscrewed for the fifth time
};

// Null if the table lacks the size.
const LockingNut* locking_nut(std::string_view size);

struct ThreadSize {
    FastenerSize size;
    ScrewThread thread;
};

// "M16" (coarse) or "M16x1.5" (a pitch of ISO 261 for that size). The error for an unknown pitch lists the
// pitches of the size; the error for an unknown size names the nearest valid name.
Result<ThreadSize> parse_thread(std::string_view text);

// The name that parse_thread() reads.
std::string name(const ThreadSize& thread);

// One name for each thread that parse_thread accepts, coarse threads first.
std::vector<std::string> thread_names();

// The threads that parse_thread accepts, for Error::expected: "one of M4, M5, ...".
std::string describe_threads();

// Strength of the bolt material (ISO 898-1; stainless ISO 3506-1). Pascals.
struct PropertyClass {
    std::string name;          // "8.8", "A2-70"
    double R_p02 = 0.0;        // proof strength at 0.2 % plastic strain (or lower yield strength)
    double R_m = 0.0;          // tensile strength
    double proof_ratio = 0.0;  // elastic limit / R_p0.2: S_p/R_p0.2 of ISO 898-1; for stainless our estimate
    double fracture_strain = 0;  // elongation after fracture A
    double E = 0.0;              // Young's modulus
    // Factor of the torsion in the equivalent stress: 3/2 if the section yields fully (VDI 2230), 2 if it is
    // elastic (published stainless tables).
    double kappa = 0.0;
};

// The class at nominal diameter `d`, m; the strengths of 8.8 change above M16. The error names the nearest
// valid name.
Result<PropertyClass> property_class(std::string_view name, double d);

std::vector<std::string> property_class_names();

// Length of thread b, m, of an ISO 4014 bolt of length l: 2d + 6 mm up to l = 125 mm, 2d + 12 mm up to
// 200 mm, 2d + 25 mm above; never more than l.
double thread_length(double d, double l);

// Length of thread b of an ISO 4762 screw of length l: 2d + 12 mm; never more than l.
inline double socket_screw_thread_length(double d, double l) { return std::min(2.0 * d + 12e-3, l); }

}  // namespace bolt::joint
