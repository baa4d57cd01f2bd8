// Bolts, screws, studs, nuts and washers as solids, and the joint that bolt, nut and washers form.
// Millimetres. Local +Z is the bolt axis, from head to nut. Threads are in phase: in each part's own frame a
// crest of the bolt, or a groove of the nut, passes z = 0 on the +X side.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"
#include "haptics/joint/design.hpp"
#include "tools/assets/models/document.hpp"

namespace bolt::models {

using joint::ThreadDirection;

enum class ThreadDetail { helical, cosmetic };  // cosmetic: a plain cylinder of the nominal diameter

// Hexagon bolt, ISO 4014 (length: l, thread_length: b). The origin is in the middle of the head's bearing
// face; the head lies at z < 0, the bolt's end at z = length.
struct BoltSpec {
    double d = 0.0;
    double pitch = 0.0;
    double length = 0.0;
    double thread_length = 0.0;
    double across_flats = 0.0;
    double head_height = 0.0;
    double head_bearing = 0.0;  // diameter of the washer face
    std::string grade;          // raised on the head, for example "8.8"; may be empty
    ThreadDirection direction = ThreadDirection::right;
};

// Hexagon nut, ISO 4032. The origin is in the middle of the bearing face; the nut lies at 0 < z < height.
struct NutSpec {
    double d = 0.0;
    double pitch = 0.0;
    double height = 0.0;
    double across_flats = 0.0;
    double bearing = 0.0;  // diameter where the chamfer meets the faces
    ThreadDirection direction = ThreadDirection::right;
};

// Plain washer, ISO 7089. The origin is in the middle of the lower face; the washer lies at 0 < z <
// thickness.
struct WasherSpec {
    double inner = 0.0;
    double outer = 0.0;
    double thickness = 0.0;
};

// Hexagon socket head cap screw, ISO 4762. The origin is under the head, as for bolts.
struct SocketScrewSpec {
    double d = 0.0;
    double pitch = 0.0;
    double length = 0.0;
    double thread_length = 0.0;
    double head_diameter = 0.0;  // d_k
    double head_height = 0.0;    // k
    double socket = 0.0;         // s, across flats of the socket
};

// Stud for a tapped hole, DIN 938 and others. The origin is in the face of the tapped part; the stud lies at
// -engagement < z < length.
struct StudSpec {
    double d = 0.0;
    double pitch = 0.0;
    double engagement = 0.0;
    double length = 0.0;
    double thread_length = 0.0;  // of the end on the nut's side
    ThreadDirection direction = ThreadDirection::right;
};

// Dimensions from the tables of haptics/joint. `size` is a thread such as "M16" or "M16x1.5".
Result<BoltSpec> iso_4014(std::string_view size, double length_mm);
Result<NutSpec> iso_4032(std::string_view size);
Result<WasherSpec> iso_7089(std::string_view size);
Result<SocketScrewSpec> iso_4762(std::string_view size, double length_mm);  // M5 to M24

// Each returns one closed, valid solid, or an error that names the part.
Result<TopoDS_Shape> hex_bolt(const BoltSpec& spec, ThreadDetail detail = ThreadDetail::helical);
Result<TopoDS_Shape> hex_nut(const NutSpec& spec, ThreadDetail detail = ThreadDetail::helical);
Result<TopoDS_Shape> washer(const WasherSpec& spec);
Result<TopoDS_Shape> stud(const StudSpec& spec);
Result<TopoDS_Shape> socket_screw(const SocketScrewSpec& spec);  // with a cosmetic thread

// Bolt, nut and washer as parts of a document. All joints of one type share them.
struct FastenerParts {
    CadPart bolt, nut, washer;
    BoltSpec bolt_spec;
    NutSpec nut_spec;
    WasherSpec washer_spec;
};

// Adds the parts bolt_M16x180, nut_M16 and washer_M16; with a left-hand thread bolt_M16-LHx180 and
// nut_M16-LH. With `shared`, a set of the same size, the washer is taken from that set, and the nut too
// unless its thread has the other direction.
Result<FastenerParts> add_fasteners(CadDocument& document, std::string_view size, double length_mm,
                                    Finish finish, const FastenerParts* shared = nullptr,
                                    std::string_view grade = {},
                                    ThreadDirection direction = ThreadDirection::right);

// Adds the group joint_ID with ID_bolt, ID_washer_head, ID_washer_nut and ID_nut, with the nut seated. The
// origin of `placement` is in the middle of the hole on the face under the nut's washer, its +Z points to the
// nut. grip_mm is the thickness of the clamped members without washers.
CadGroup add_joint(CadDocument& document, CadGroup parent, std::string_view id, const FastenerParts& parts,
                   double grip_mm, const gp_Trsf& placement);

// The angle (rad, about +Z) of a nut whose origin lies `dz` mm beyond the bolt's, so that the threads mesh.
double nut_phase(double dz, double pitch, ThreadDirection direction = ThreadDirection::right);

}  // namespace bolt::models
