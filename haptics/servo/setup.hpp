// The constants of the servo tick. A setup is built for each lesson, and built again when a device is opened,
// because the device's limits are part of the setup. Between two ticks change_tool() changes the tool in it.
#pragma once

#include <span>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/collision/tool_head.hpp"
#include "haptics/force/device_mapping.hpp"
#include "haptics/force/guide.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::servo {

// Geometry of a nut, or of a head that is turned, in the assembly's frame. All axes are unit vectors; `axis`
// points from the members (the parts that are clamped) to the nut. e1 lies across the bolt: it is angle 0
// about the bolt, and the direction of a corner of the nut at nut angle 0. e1 × e2 = axis.
//
// Angles about the bolt are positive in the direction that tightens, for both directions of thread. So the
// joint laws do not depend on the direction; only the functions below map these angles to rotations about
// `axis`.
struct NutGeometry {
    bool is_head = false;  // a head is turned, not a nut; its shank lies below the bearing face
    // +1: a right-hand thread, which a rotation about −axis tightens; −1: a left-hand thread, which a
    // rotation about +axis tightens.
    double sense = 1.0;
    Vec3 seat{0.0};  // m, centre of the seat
    Vec3 axis{0.0, 1.0, 0.0};
    Vec3 e1{1.0, 0.0, 0.0};
    Vec3 e2{0.0, 0.0, -1.0};
    double height = 0.0;            // m
    double across_flats = 0.0;      // m, of the hexagon (s in ISO 4032) or of the head's hexagonal socket
    double bearing_diameter = 0.0;  // m, of the bearing face inside the chamfer
    double socket_depth = 0.0;      // m, of the head's hexagonal socket; 0: the tool grips it from outside
    double head_diameter = 0.0;     // m, of a head with a socket
    std::size_t tool = 0;           // index in Setup::tools of the tool that turns it
    // m above the bearing face, at which the tool's origin, or the fingertips, are when they hold the nut.
    double grip_height = 0.0;
    double corner_pressure = 0.0;  // Pa at which the corners yield (haptics/joint/nut.hpp)
    double start_gap = 0.0;        // m from bearing face to seat at nut angle 0
    double lead = 0.0;             // m of advance per rad
    // Width across flats (m) of the held part of a through-bolt, which is the head if the nut is turned, and
    // the nut if the head is turned. 0 if the held part cannot turn (joint::CounterHold): its size is then
    // not used.
    double held_across_flats = 0.0;
    double held_distance = 0.0;  // m from the seat along −axis to the middle of the held part
};

// The ratchet between the handle and the head of a tool. In one direction the head turns with the handle. In
// the other direction a spring-loaded pawl climbs over the teeth: its drag rises over each tooth and then
// drops. A nut whose resistance is below this drag turns back with the handle.
struct Ratchet {
    double tooth_angle = 0.0;       // rad; 0: no ratchet
    double drag = 0.0;              // N·m, at the top of a tooth
    double least_drag_share = 0.4;  // of `drag`, at the foot of a tooth: the pawl's spring is preloaded
    bool loosens = false;           // position of the lever. True: it drives in the direction that loosens
};

// The unit vector about which a right-handed rotation loosens the nut.
inline Vec3 loosening_axis(const NutGeometry& nut) { return nut.sense * nut.axis; }

// The unit vector across the bolt at `angle` (rad, tightening positive) from e1.
Vec3 direction_at(const NutGeometry& nut, double angle);

// The angle, rad, −π … π, tightening positive, from e1 to the projection of `direction` onto the plane
// perpendicular to `axis`.
double angle_of(const NutGeometry& nut, const Vec3& direction);

// Pose of the nut's frame in the assembly: origin on the bearing face, +Z along the bolt away from the
// members, +X through a corner of the hexagon. `nut_angle` in rad, tightening positive.
// `common_turn`: rad by which nut and bolt have turned together (joint::JointState::common_turn).
Pose nut_pose(const NutGeometry& nut, double nut_angle, double common_turn = 0.0);

// The shape of a nut or head for contacts with the head of a tool.
collision::TurnedShape shape_of(const NutGeometry& nut);

struct Wrench {
    collision::ToolHead head;
    // rad, from the handle to the direction of the head. The direction of a jaw points to its throat; the
    // direction of any other head points to a corner of its hexagon. Turning an open-end wrench over negates
    // the angle.
    double head_angle = 0.0;
    double handle_length = 0.0;  // m
    double half_play = 0.0;      // rad of free rotation of the head on the hexagon, to either side
    Ratchet ratchet;
    double stiffness = 0.0;      // N·m/rad, wrench and hand in series
    double yield_torque = 0.0;   // N·m at which the tool bends for good; 0: never
    joint::Click click;          // without its set torque, which is an input
    double deviation = 0.0;      // relative deviation of the click torque from the set torque
    double adaptor_ratio = 1.0;  // torque at the nut / torque on the scale; above 1 with an adaptor
};

// Free rotation (rad, to either side) of a tool's head on a hexagon, or in a hexagonal socket, of the size
// `across_flats` (m), whose corners have lost `rounded` m along each flat (joint::CornerGrip::rounded).
// 30° if nothing is left to grip.
double half_play(const Wrench& wrench, double across_flats, double rounded);

// Returns true if the tool can be turned over on the hexagon: only an open end.
bool reversible(const Wrench& wrench);

// A tool of the lesson.
struct ToolSetup {
    Wrench wrench;
    std::vector<double> grip_heights;  // by joint, m: NutGeometry::grip_height with this tool
    force::TorqueRendering torque_rendering;
    double max_aligning_torque = 0.0;  // N·m, of the guiding force (GuidingParameters::max_torque)
};

// The constants of the tick. `wrench`, `tool` and the nuts' grip heights are those of the tool in use;
// change_tool() (tick.hpp) replaces them between two ticks.
struct Setup {
    double dt = 0.001;  // s, duration of a tick
    joint::GroupParameters group;
    std::vector<NutGeometry> nuts;  // by joint
    std::vector<ToolSetup> tools;
    std::size_t tool = 0;  // index in `tools`
    Wrench wrench;
    double finger_stiffness = 5.0;   // N·m/rad
    double finger_force = 65.0;      // N, sum of the tangential forces of all fingertips when they slip
    double hold_stiffness = 1000.0;  // N/m between an engaged tool and the nut's centre
    double hold_torsion = 5.0;       // N·m/rad that keeps an engaged wrench square to the bolt
    force::TorqueRendering torque_rendering;
    force::GuidingParameters guiding;
    force::OutputLimits limits;
    // A head that slips over the corners of a nut (at the corner torque, joint/nut.hpp) removes material from
    // the corners that bear: two with a jaw, six with any other head. False (sessions before format 10): two
    // with any head.
    bool rounds_all_loaded_corners = true;
    // A device without torque output renders torques as a force at the end of the handle. True: the force is
    // computed for the handle of the tool in use. False (sessions before format 11): for that of the first
    // tool.
    bool renders_tool_in_use = true;
    // The tool can move in a gap that is too narrow for the skin on both sides
    // (proxy::GodObjectParameters::skin). False (sessions before format 11): friction holds it there.
    bool allows_narrow_gaps = true;

    // N·m that fingertips can apply to the nut.
    [[nodiscard]] double finger_torque(const NutGeometry& nut) const {
        return 0.5 * finger_force * nut.across_flats;
    }
};

// The tool from which make_setup() makes a Wrench.
struct ToolDescription {
    collision::ToolHead head;
    double head_angle = 0.0;       // rad from the handle to the direction of the head (Wrench::head_angle)
    double twist_stiffness = 0.0;  // N·m/rad, of an extension bar; 0: none
    double yield_torque = 0.0;     // N·m at which the tool bends for good; 0: never
    double handle_length = 0.0;    // m
    double click_swing = 0.0;    // rad that a click-type torque wrench swings at its click; 0: a plain wrench
    double adaptor_ratio = 1.0;  // torque at the nut / torque on the scale
    double click_accuracy =
        0.0;  // bound of the relative deviation of the click torque, which is drawn from the seed
};

struct SetupDescription {
    std::span<const joint::JointDesign> joints;
    joint::Law law = joint::Law::mechanistic;
    std::vector<joint::PublishedParameters> published;  // law `published`: one set for each joint
    const joint::FlangePlate* flange = nullptr;  // plate through which joints interact; null: they do not
    ToolDescription tool;                        // in use at the beginning
    std::vector<ToolDescription> more_tools;
    std::vector<std::size_t> tool_of_joint;  // 0: `tool`, i + 1: more_tools[i]; empty: all 0
    double max_torque =
        0.0;  // N·m, the largest torque of the lesson; torques are scaled so that the device can render it
    force::OutputLimits limits;  // of the devices, converted by force::in_assembly()
    std::uint64_t seed = 0;      // of the scatter of joints and tools
    double dt = 0.001;           // s, duration of a tick
};

Setup make_setup(const SetupDescription& description);

// Makes a tool of the lesson the one in use. Does not allocate.
void use_tool(Setup& setup, std::size_t tool);

// Sets Wrench::yield_torque of all tools to 0.
void disable_tool_yield(Setup& setup);

// Sets the levers of all ratchets.
void set_ratchets(Setup& setup, bool loosen);

}  // namespace bolt::servo
