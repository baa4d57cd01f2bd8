// The measurements that the checks of one joint share (check_joint.cpp, check_far_end.cpp). The frame is that
// of the joint: origin in the middle of the hole on the face under the turned part, +Y along the bolt towards
// that part; metres.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

inline constexpr double offset_tolerance = 0.01 * mm;   // of a hexagon and a hole from the joint's axis
inline constexpr double contact_tolerance = 0.05 * mm;  // penetration or gap of two parts that should touch
inline constexpr double length_tolerance = 0.1 * mm;

// One joint, and what its checks need.
struct JointCheck {
    const content::AssemblyJoint& joint;
    std::size_t index;
    const JointParts& parts;
    const FlattenedModel& scene;
    const Bvh& everything;
    const Messages& messages;

    void error(std::string what, std::string expected) const {
        messages.error(joint_pointer(index), std::move(what), std::move(expected));
    }
    [[nodiscard]] const joint::FastenerSize& size() const { return joint.design.thread.size; }
    [[nodiscard]] const char* turned_name() const {
        return joint.design.turned == joint::TurnedPart::head ? "head" : "nut";
    }
    [[nodiscard]] double grip() const;  // m, of the members
    [[nodiscard]] std::string name_of(std::uint32_t part) const {
        return content::in_quotes(scene.parts[part].name);
    }
    // Casts a ray that ignores the joint's own fasteners.
    [[nodiscard]] std::optional<RayHit> ray(const Vec3& origin, const Vec3& direction, double reach) const;
    // Corners of the triangle that a ray has hit.
    [[nodiscard]] std::array<Vec3, 3> corners_of(const RayHit& hit) const;
    [[nodiscard]] std::uint32_t part_of(const RayHit& hit) const {
        return everything.triangles()[hit.triangle].part;
    }
};

// Reports a fastener that has no hexagon about the axis, or a hexagon of another width than `across_flats`.
// `noun`: "nut" or "head". Returns the measured width; nullopt without a hexagon.
std::optional<double> check_hexagon(const JointCheck& s, const Fastener& fastener, double across_flats,
                                    const char* noun);

// Reports a socket head whose model has another socket or another height than ISO 4762 states, because the
// lesson places the key by the standard. Implemented in check_socket.cpp.
void check_socket(const JointCheck& s, const joint::TurnedPartSize& size);

// Reports a gap or a penetration between the part `upper`, which begins at the height `bottom`, and the part
// `lower`, which ends at the height `level`.
void check_seat(const JointCheck& s, const std::string& upper, double bottom, const std::string& lower,
                double level);

struct FaceHit {
    double distance = 0.0;
    std::uint32_t part = 0;
};

// Casts rays from a ring about the axis at `height` and returns the hit at the median distance; nullopt if
// fewer than half of them hit. `direction`: +1 along +Y, −1 along −Y.
std::optional<FaceHit> find_face(const JointCheck& s, double radius, double height, double direction,
                                 double reach);

struct CircleFit {
    double x = 0.0, z = 0.0, radius = 0.0, residual = 0.0;  // residual: largest radial distance
};

// Least-squares circle (I. Kåsa, 1976): minimises the sum of (x² + z² + ax + bz + c)². Returns nullopt for
// fewer than six points or points on a line.
std::optional<CircleFit> fit_circle(const std::vector<Vec3>& points);

// Reports a hole that is beside the joint's axis. Returns true if it has reported the hole.
bool report_hole_off_axis(const JointCheck& s, std::uint32_t part, const CircleFit& hole, const char* noun);

// Checks the end of the bolt that is not turned: the head of a bolt, the nut of a bolt that is turned at its
// head, or the tapped hole of a screw or a stud. Returns the parts that the thread is screwed into.
// Implemented in check_far_end.cpp.
std::set<std::uint32_t> check_far_end(const JointCheck& s);

}  // namespace bolt::geometry
