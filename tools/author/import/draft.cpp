#include "tools/author/import/draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "haptics/joint/design.hpp"
#include "haptics/joint/fastener.hpp"
#include "tools/author/import/draft_order.hpp"
#include "tools/author/import/draft_tools.hpp"

namespace bolt::step_import {

namespace {

constexpr double friction = 0.12;     // oiled, middle of VDI 2230 class B
constexpr double utilisation = 0.9;   // of yield
constexpr double torque_share = 0.8;  // of the torque at that utilisation, so that target + 10 % is below it
constexpr std::array built_in = {"aluminium",    "bronze",          "cast_iron",
                                 "ductile_iron", "stainless_steel", "steel"};

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

double rounded(double value, double step) {
    const double result = std::round(value / step) * step;
    return result == 0.0 ? 0.0 : result;  // no −0
}

// Millimetres in decimal notation without trailing zeros.
std::string in_mm(double metres, double step = 1e-4) {
    std::string text = fmt::format("{:.4f}", rounded(metres / mm, step));
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string point_mm(const Vec3& p, double step = 1e-4) {
    return fmt::format("[{}, {}, {}]", in_mm(p.x, step), in_mm(p.y, step), in_mm(p.z, step));
}

std::string axis_text(const Vec3& a) {
    const auto part = [](double x) { return fmt::format("{:.10g}", rounded(x, 1e-10)); };
    return fmt::format("[{}, {}, {}]", part(a.x), part(a.y), part(a.z));
}

// Joints with equal keys have the same joint type.
struct JointTypeKey {
    std::string size, property_class;
    joint::ThreadDirection thread_direction = joint::ThreadDirection::right;
    joint::HeadShape head = joint::HeadShape::hexagon;
    bool turns_head = false;
    double length = 0.0;  // mm
    bool washer_head = false, washer_nut = false;
    std::vector<std::pair<double, std::string>> members;  // mm, material
    std::string tapped;  // material of the tapped part; empty: a through-bolt
    bool is_stud = false;
    double engagement = 0.0;  // mm; 0: all of the screw beyond members and washer
    friend bool operator==(const JointTypeKey&, const JointTypeKey&) = default;
};

struct DraftJointType {
    std::string name;
    JointTypeKey type;
    double torque = 0.0;              // N·m
    std::size_t tool = 0;             // index into the tools of the draft
    std::vector<std::string> joints;  // ids
};

const joint::SocketHead* socket_of(const JointTypeKey& type, const joint::ThreadSize& size) {
    return type.head == joint::HeadShape::socket ? joint::socket_head(size.size.name) : nullptr;
}

// The tapped material for a material of members.
std::string_view tapped_material_of(std::string_view member) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> materials = {
        {{"aluminium", "AlSi9Cu3"},
         {"cast_iron", "GJL-250"},
         {"ductile_iron", "GJS-400"},
         {"stainless_steel", "A2"}}};
    for (const auto& [name, tapped] : materials)
        if (name == member) return tapped;
    return "S235";
}

// Torque that a tapped thread bears without stripping, N·m: half of the torque at which it strips.
double tapped_limit(const JointTypeKey& type, const joint::ThreadSize& size, const joint::PropertyClass& bolt,
                    double bearing) {
    const auto part = joint::tapped_material(type.tapped);
    if (!part) return 0.0;
    double engagement = type.engagement;
    if (!type.is_stud) {
        double beyond = type.length - (type.washer_head ? size.size.washer_thickness / mm : 0.0);
        for (const auto& [thickness, material] : type.members) beyond -= thickness;
        engagement = engagement > 0.0 ? std::min(beyond, engagement) : beyond;
    }
    engagement *= mm;
    return 0.5 * joint::stripping_forces(size.thread, bolt, *part, engagement).least() *
           joint::torque_levers(size.thread, friction, friction, bearing).tightening_lever();
}

double target_torque(const JointTypeKey& type) {
    const auto thread = joint::parse_thread(type.size);
    if (!thread) return 0.0;
    const auto bolt = joint::property_class(type.property_class, thread->size.d);
    if (!bolt) return 0.0;
    const joint::SocketHead* const socket = socket_of(type, *thread);
    const double face = socket            ? socket->bearing
                        : type.turns_head ? thread->size.head_bearing
                                          : thread->size.nut_bearing;
    const double bearing = joint::bearing_mean_diameter(face, thread->size.hole);
    double torque =
        torque_share *
        joint::assembly_preload(thread->thread, *bolt, friction, friction, bearing, utilisation).torque;
    if (!type.tapped.empty()) torque = std::min(torque, tapped_limit(type, *thread, *bolt, bearing));
    if (torque <= 0.0) return 0.0;
    const double step = std::pow(10.0, std::floor(std::log10(torque)) - 1.0);  // two significant digits
    return std::floor(torque / step) * step;
}

class DraftWriter {
  public:
    explicit DraftWriter(const DraftInput& input) : in_(input) {}

    Draft run() {
        choose_joints();
        if (joints_.empty()) return std::move(draft_);
        for (const JointCandidate* joint : joints_) type_of_.push_back(type_index(*joint));
        draft_.joints = joints_.size();
        describe();
        write();
        return std::move(draft_);
    }

  private:
    const DraftInput& in_;
    Draft draft_;
    std::vector<const JointCandidate*> joints_;
    std::vector<std::size_t> type_of_;
    std::vector<DraftJointType> types_;
    std::vector<DraftTool> tools_;
    bool gasket_ = false;
    std::size_t unknown_members_ = 0;

    static ToolNeed need_of(const JointCandidate& joint) {
        const auto thread = joint::parse_thread(joint.size);
        if (!thread) return {};
        const joint::SocketHead* const socket =
            joint.head == joint::HeadShape::socket ? joint::socket_head(thread->size.name) : nullptr;
        if (socket) return {joint.head, socket->across_flats, thread->size.d};
        // An open end fits all threads with heads of this width.
        return {joint::HeadShape::hexagon, thread->size.across_flats, 0.0};
    }

    // Index into tools_; tools_.size() if draft_tools() has left out the tool of this joint.
    std::size_t tool_index(const JointCandidate& joint) const {
        const auto found = std::find_if(tools_.begin(), tools_.end(),
                                        [&](const DraftTool& tool) { return tool.need == need_of(joint); });
        return static_cast<std::size_t>(found - tools_.begin());
    }

    void choose_joints() {
        std::vector<ToolNeed> needs;
        for (const JointCandidate& joint : in_.search->joints) needs.push_back(need_of(joint));
        tools_ = draft_tools(needs);
        std::map<std::string, std::size_t> left_out;
        for (const JointCandidate& joint : in_.search->joints) {
            if (tool_index(joint) < tools_.size())
                joints_.push_back(&joint);
            else
                ++left_out[joint.size];
        }
        for (const auto& [size, count] : left_out)
            draft_.remarks.push_back(
                fmt::format("{} joints {} are not in the draft: an assembly has at most {} tools", count,
                            size, tools_.size()));
    }

    std::string member_material(const ClampedMember& member) {
        std::string material =
            member.node >= 0 ? in_.member_materials[static_cast<std::size_t>(member.node)] : std::string();
        if (material == "gasket") {
            gasket_ = true;
            return material;
        }
        if (std::find(built_in.begin(), built_in.end(), material) != built_in.end()) return material;
        ++unknown_members_;
        return "steel";
    }

    std::size_t type_index(const JointCandidate& joint) {
        JointTypeKey type;
        type.size = joint.size;
        type.thread_direction = joint.thread_direction;
        type.head = joint.head;
        type.turns_head = joint.turns_head();
        type.property_class = in_.stainless[static_cast<std::size_t>(joint.bolt)] ? "A2-70" : "8.8";
        type.length = rounded(joint.bolt_length / mm, 0.1);
        type.washer_head = !joint.head_washers.empty();
        type.washer_nut = !joint.nut_washers.empty();
        for (const ClampedMember& member : joint.members)
            type.members.emplace_back(rounded(member.thickness / mm, 0.01), member_material(member));
        type.is_stud = joint.is_stud();
        if (joint.tapped >= 0) {
            const std::string material = member_material({joint.tapped, 0.0});
            type.tapped = tapped_material_of(material);
            if (material == "bronze" || material == "gasket")
                draft_.remarks.push_back(fmt::format(
                    "{}: the strength of a thread in {} is not built in; S235 is written, replace it",
                    joint.id, material));
            type.engagement = std::floor(joint.engagement / mm * 10.0) / 10.0;
        }
        for (std::size_t i = 0; i < types_.size(); ++i)
            if (types_[i].type == type) {
                types_[i].joints.push_back(joint.id);
                return i;
            }
        std::string name = fmt::format("{}x{}{}{}", type.size, in_mm(type.length * mm),
                                       joint::size_suffix(type.thread_direction),
                                       type.is_stud                             ? " stud"
                                       : type.head == joint::HeadShape::socket  ? " socket head"
                                       : type.tapped.empty() && type.turns_head ? " turned at head"
                                                                                : "");
        const auto same = std::count_if(types_.begin(), types_.end(), [&](const DraftJointType& one) {
            return one.type.size == type.size && one.type.length == type.length &&
                   one.type.head == type.head && one.type.turns_head == type.turns_head &&
                   one.type.is_stud == type.is_stud && one.type.thread_direction == type.thread_direction;
        });
        if (same > 0) name += fmt::format(" ({})", same + 1);
        types_.push_back({name, type, target_torque(type), tool_index(joint), {joint.id}});
        return types_.size() - 1;
    }

    // One tool after the other, so that a pass changes tools as rarely as possible.
    std::vector<std::size_t> order() const {
        std::vector<std::size_t> order;
        for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
            std::vector<std::size_t> turned;
            std::vector<Vec3> seats;
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                if (types_[type_of_[i]].tool != tool) continue;
                turned.push_back(i);
                seats.push_back(joints_[i]->seat);
            }
            for (const std::size_t i : tightening_order(seats)) order.push_back(turned[i]);
        }
        return order;
    }

    // A bolt whose standard thread would end in the grip is threaded up to its head, as ISO 4017 and short
    // screws of ISO 4762 are.
    static std::string thread_text(const JointTypeKey& type) {
        const auto thread = joint::parse_thread(type.size);
        if (!thread) return {};
        double grip = 0.0;
        for (const auto& [thickness, material] : type.members) grip += thickness * mm;
        const double length = type.length * mm;
        const double threaded = type.head == joint::HeadShape::socket
                                    ? joint::socket_screw_thread_length(thread->size.d, length)
                                    : joint::thread_length(thread->size.d, length);
        if (length - threaded <= grip) return {};
        return fmt::format("\n      \"bolt_thread_length_mm\": {},", in_mm(length));
    }

    std::string type_text(const DraftJointType& named) const {
        const JointTypeKey& type = named.type;
        std::vector<std::string> members;
        for (const auto& [thickness, material] : type.members)
            members.push_back(fmt::format(R"(        {{ "thickness_mm": {}, "material": {} }})",
                                          in_mm(thickness * mm), quoted(material)));
        std::string form;
        if (const std::string& tool = tools_[named.tool].name; !tool.empty())
            form = fmt::format("\n      \"tool\": {},", quoted(tool));
        if (type.thread_direction == joint::ThreadDirection::left)
            form += "\n      \"thread_direction\": \"left\",";
        if (type.head == joint::HeadShape::socket) form += "\n      \"head\": \"socket\",";
        if (type.tapped.empty() && type.turns_head) form += "\n      \"turned\": \"head\",";
        if (!type.tapped.empty()) {
            const std::string engagement =
                type.engagement > 0.0 ? fmt::format(", \"engagement_mm\": {}", in_mm(type.engagement * mm))
                                      : std::string();
            form += fmt::format("\n      \"form\": \"{}\",\n      \"tapped_hole\": {{ \"material\": {}{} }},",
                                name(type.is_stud ? joint::JointForm::stud : joint::JointForm::tapped_hole),
                                quoted(type.tapped), engagement);
        }
        return fmt::format(R"(    {}: {{{}
      "size": {},
      "class": {},
      "bolt_length_mm": {},{}
      "members": [
{}
      ],
{}      "washer_under_nut": {},
      "friction_thread": {:g},
      "friction_bearing": {:g},
      "lubrication": "oiled",
      "spec": {{ "strategy": "torque", "target_torque_Nm": {:g}, "torque_tolerance_percent": 10, "risk_class": "C" }}
    }})",
                           quoted(named.name), form, quoted(type.size), quoted(type.property_class),
                           in_mm(type.length * mm), thread_text(type), fmt::join(members, ",\n"),
                           type.is_stud ? std::string()
                                        : fmt::format("      \"washer_under_head\": {},\n", type.washer_head),
                           type.washer_nut, friction, friction, named.torque);
    }

    std::string joint_text(std::size_t i) const {
        const JointCandidate& joint = *joints_[i];
        const bool upright = joint.axis.y > 1.0 - 1e-12;
        return fmt::format(R"(    {{ "id": {}, "type": {}, "node": {}, "position_mm": {}{} }})",
                           quoted(joint.id), quoted(types_[type_of_[i]].name), quoted("joint_" + joint.id),
                           point_mm(joint.seat),
                           upright ? "" : fmt::format(R"(, "axis": {})", axis_text(joint.axis)));
    }

    std::string more_tools() const {
        std::vector<std::string> lines;
        for (const DraftTool& tool : tools_)
            if (!tool.name.empty()) lines.push_back(fmt::format("    {}: {}", quoted(tool.name), tool.json));
        return fmt::format("{}", fmt::join(lines, ",\n"));
    }

    // Puts tools and joint types in words, with what the geometry does not contain.
    void describe() {
        for (const DraftTool& tool : tools_)
            draft_.tools.push_back(fmt::format("{}{}, generated from these numbers",
                                               tool.name.empty() ? "" : tool.name + ", ", tool.description));
        for (const DraftJointType& named : types_) {
            const JointTypeKey& type = named.type;
            const bool cap = type.head == joint::HeadShape::socket;
            const std::string& tool = tools_[named.tool].name;
            draft_.joint_types.push_back(fmt::format(
                "{}: {}, {}, turned with {}; assumed: class {}, friction {:g}, target {:g} N·m{}", named.name,
                named.joints.size() == 1 ? "joint " + named.joints.front()
                                         : fmt::format("{} joints", named.joints.size()),
                type.is_stud          ? "stud with a nut"
                : type.tapped.empty() ? (cap ? "cap screw with a nut" : "bolt with a nut")
                                      : (cap ? "cap screw in a tapped hole" : "screw in a tapped hole"),
                tool.empty() ? "the first tool" : tool, type.property_class, friction, named.torque,
                type.tapped.empty() ? "" : ", thread in " + type.tapped));
        }
    }

    bool has_tapped_parts() const {
        return std::any_of(joints_.begin(), joints_.end(),
                           [](const JointCandidate* joint) { return joint->tapped >= 0; });
    }

    const char* turned_parts() const {
        const auto screws = static_cast<std::size_t>(std::count_if(
            joints_.begin(), joints_.end(), [](const JointCandidate* joint) { return joint->turns_head(); }));
        return screws == 0 ? "nuts" : screws == joints_.size() ? "screws" : "nuts and screws";
    }

    std::string views() const {
        const Vec3 middle = 0.5 * (in_.low + in_.high);
        const double r = std::max(0.5 * glm::length(in_.high - in_.low), 0.02);
        const Vec3 eye = middle + 3.1 * r * glm::normalize(Vec3{0.55, 0.65, 0.85});
        const Vec3 above = middle + Vec3{0.0, 3.1 * r, 0.01 * r};
        const auto fits = [](const Vec3& p) {
            return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 10.0;
        };
        if (!fits(eye) || !fits(above)) return {};
        return fmt::format(R"(,
  "views": [
    {{ "name": "overview", "eye_mm": {}, "target_mm": {} }},
    {{ "name": "top", "eye_mm": {}, "target_mm": {} }}
  ])",
                           point_mm(eye, 1.0), point_mm(middle, 1.0), point_mm(above, 1.0),
                           point_mm(middle, 1.0));
    }

    std::string sources() const {
        std::string text = fmt::format(
            "Drafted from {} by bolt-author import-step. Read from the geometry: sizes, bolt lengths, "
            "members and their thickness, washers, positions and axes; the material of members by their "
            "colour or name{}. Defaults, to be replaced by what your drawing says: property class 8.8 "
            "(A2-70 where the bolt is stainless), right-hand threads, coarse unless the nut's hole shows a "
            "fine one, friction {:g} (oiled, VDI 2230 class B), strategy torque with {:g} % of the torque "
            "at {:g} % of yield, tolerance 10 %, risk class C, the tools, the order and the passes{}.",
            in_.source,
            unknown_members_ > 0 ? fmt::format(" (unknown for {}: steel is assumed)", unknown_members_) : "",
            friction, 100.0 * torque_share, 100.0 * utilisation,
            has_tapped_parts() ? "; for screws and studs the grade of the tapped part, and at most half of "
                                 "the torque at which its thread strips"
                               : "");
        if (gasket_) text += " The gasket's Young's modulus is a guess.";
        return text;
    }

    void write() {
        std::string& out = draft_.text;
        out = fmt::format("{{\n  \"$schema\": {},\n  \"title\": {{ \"en\": {} }},\n", quoted(in_.schema),
                          quoted(in_.title));
        out += fmt::format(
            "  \"lesson\": {{ \"en\": {} }},\n",
            quoted(
                joints_.size() == 1
                    ? fmt::format("Assemble {}: run the {} down by hand, then tighten it in rounds to 30, 70 "
                                  "and 100 % of the target torque, and check it again.",
                                  in_.title, joints_.front()->turns_head() ? "screw" : "nut")
                    : fmt::format(
                          "Assemble {}: run all {} {} down by hand, then tighten them in rounds to 30, "
                          "70 and 100 % of the target torque, and check every one again.",
                          in_.title, joints_.size(), turned_parts())));
        out += fmt::format("  \"sources\": {},\n", quoted(sources()));
        for (const auto& [key, file] : {std::pair{"model", &in_.model}, std::pair{"model_far", &in_.far},
                                        std::pair{"contact_model", &in_.contact}})
            if (!file->empty()) out += fmt::format("  \"{}\": {},\n", key, quoted(*file));
        out += fmt::format("  \"tool\": {},\n", tools_.front().json);
        if (tools_.size() > 1) out += fmt::format("  \"more_tools\": {{\n{}\n  }},\n", more_tools());
        if (gasket_) out += "  \"materials\": { \"gasket\": { \"E_GPa\": 1 } },\n";
        std::vector<std::string> types, joints, ids;
        for (const DraftJointType& type : types_) types.push_back(type_text(type));
        for (std::size_t i = 0; i < joints_.size(); ++i) joints.push_back(joint_text(i));
        for (const std::size_t i : order()) ids.push_back(quoted(joints_[i]->id));
        out += fmt::format("  \"joint_types\": {{\n{}\n  }},\n", fmt::join(types, ",\n"));
        out += fmt::format("  \"joints\": [\n{}\n  ],\n", fmt::join(joints, ",\n"));
        out += fmt::format("  \"order\": [{}],\n", fmt::join(ids, ", "));
        out += R"(  "passes": [
    { "kind": "run_down" },
    { "kind": "tighten", "percent": 30 },
    { "kind": "tighten", "percent": 70 },
    { "kind": "tighten", "percent": 100 },
    { "kind": "recheck" }
  ])" + views() +
               "\n}\n";
    }
};

}  // namespace

Draft make_draft(const DraftInput& input) { return DraftWriter(input).run(); }

}  // namespace bolt::step_import
