#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "content/format/json_document.hpp"
#include "content/format/read_assembly.hpp"

namespace bolt::content {

namespace {

std::vector<std::size_t> listed_order(std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
}

std::string missing_text(const std::vector<std::string>& ids) {
    std::vector<std::string> names;
    names.reserve(ids.size());
    for (const std::string& id : ids) names.push_back(in_quotes(id));
    return fmt::format("{} {} missing", fmt::join(names, ", "), names.size() == 1 ? "is" : "are");
}

// The joint ids that an order can refer to.
struct JointIds {
    std::vector<std::string> names;  // distinct ids
    std::vector<std::size_t> joint;  // index of the first joint with this id
    std::vector<int> uses;           // number of joints with this id
    std::size_t without_id = 0;      // joints whose id is invalid or missing
    std::string repeated;  // text that describes the first joint with a repeated id; empty if there is none
    std::size_t repeats = 0;          // number of joints with a repeated id
    const char* owner = "this file";  // "B1 is not a joint of <owner>"
};

// The joints that an order must contain.
enum class OrderRule : std::uint8_t { every_joint, some_joints };

JointIds read_ids(JsonReader& reader, const std::vector<AssemblyJoint>& joints) {
    JointIds ids;
    const std::vector<JsonNode> nodes = reader.items(reader.member(reader.root(), "joints"));
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::string& id = joints[i].design.id;
        const auto known =
            static_cast<std::size_t>(std::find(ids.names.begin(), ids.names.end(), id) - ids.names.begin());
        if (id.empty()) {
            ++ids.without_id;
        } else if (known == ids.names.size()) {
            ids.names.push_back(id);
            ids.joint.push_back(i);
            ids.uses.push_back(1);
        } else {
            ++ids.uses[known];
            ++ids.repeats;
            if (ids.repeated.empty())
                ids.repeated =
                    fmt::format("the joint in line {}, whose id is a repetition",
                                reader.line(reader.member(nodes[joints[i].index_in_file], "id").pointer));
        }
    }
    return ids;
}

std::string suggest_joint(std::string_view id, const std::vector<std::string>& missing,
                          const std::string& repeated) {
    if (repeated.empty())
        return missing.empty() ? "every joint once, and nothing else" : suggest(id, missing);
    return missing.empty()
               ? fmt::format("did you mean {}?", repeated)
               : fmt::format("did you mean {}? If not, {}{}", repeated,
                             nearest_name(id, missing).empty() ? "expected " : "", suggest(id, missing));
}

// Reads an order, which contains no joint twice. An unknown name probably stands for a joint that the order
// lacks, and then only the name is reported; or for a joint without a valid id, and then nothing is reported.
std::vector<std::size_t> read_order(JsonReader& reader, const JsonNode& node, const JointIds& ids,
                                    OrderRule rule = OrderRule::every_joint) {
    std::vector<std::size_t> order;
    std::vector<JsonNode> unknown;
    std::vector<int> named(ids.names.size());
    std::vector<std::string> first(ids.names.size());
    for (const JsonNode& item : reader.items(node)) {
        const auto id = reader.text(item);
        if (!id) return {};
        const auto index =
            static_cast<std::size_t>(std::find(ids.names.begin(), ids.names.end(), *id) - ids.names.begin());
        if (index == ids.names.size()) {
            unknown.push_back(item);
            continue;
        }
        if (named[index] == 0) first[index] = item.pointer;
        if (++named[index] > ids.uses[index])
            reader.report(
                item.pointer, fmt::format("{} appears twice in this order", in_quotes(*id)),
                fmt::format("every joint once; it appears first in line {}", reader.line(first[index])));
        else
            order.push_back(ids.joint[index]);
    }
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < ids.names.size(); ++i)
        if (named[i] == 0) missing.push_back(ids.names[i]);
    if (unknown.size() > ids.without_id || ids.repeats > 0)
        for (const JsonNode& item : unknown) {
            const std::string id = reader.text(item).value_or("");
            reader.report(item.pointer, fmt::format("{} is not a joint of {}", in_quotes(id), ids.owner),
                          suggest_joint(id, missing, ids.repeated));
        }
    if (rule == OrderRule::every_joint && !missing.empty() &&
        missing.size() + ids.without_id + ids.repeats > unknown.size())
        reader.report(node.pointer, missing_text(missing) + " in this order", "every joint once");
    return order;
}

// A pass as read from the file. Invalid members are absent.
struct ParsedPass {
    JsonNode node;
    std::optional<PassKind> kind;
    std::optional<double> percent;  // tighten and turn only
};

bool is_kind(const ParsedPass& parsed_pass, PassKind kind) { return parsed_pass.kind == kind; }

const ParsedPass* last_of_kind(const std::vector<ParsedPass>& parsed, PassKind kind) {
    const auto found =
        std::find_if(parsed.rbegin(), parsed.rend(), [&](const ParsedPass& p) { return is_kind(p, kind); });
    return found == parsed.rend() ? nullptr : &*found;
}

// "tightens", "turns" or "rechecks".
const char* verb(PassKind kind) {
    return kind == PassKind::turn ? "turns" : kind == PassKind::recheck ? "rechecks" : "tightens";
}

// Checks the shares of one target, of the torque in passes that tighten or of the angle in passes that turn:
// they must not decrease, and the last must be 100 if `reaches_target`.
void check_shares(JsonReader& reader, const std::vector<ParsedPass>& parsed, PassKind kind,
                  bool reaches_target) {
    double highest = 0.0;
    bool decreases = false, known = true;
    for (const ParsedPass& parsed_pass : parsed) {
        const JsonNode percent = reader.member(parsed_pass.node, "percent");
        known = known && parsed_pass.kind && reader.is_valid(percent.pointer);
        if (!is_kind(parsed_pass, kind)) continue;
        if (!percent) {
            if (reader.is_valid(percent.pointer))
                reader.report(parsed_pass.node.pointer,
                              fmt::format("a pass of kind \"{}\" without \"percent\"",
                                          kind == PassKind::turn ? "turn" : "tighten"),
                              fmt::format("a share of the target {}, 100 in the last pass",
                                          kind == PassKind::turn ? "angle" : "torque"));
            known = false;
            continue;
        }
        if (parsed_pass.percent < highest) {
            decreases = true;
            reader.report(percent.pointer,
                          fmt::format("{:g} percent after {:g} percent", *parsed_pass.percent, highest),
                          "shares that do not fall, and 100 in the last pass");
        }
        highest = std::max(highest, *parsed_pass.percent);
    }
    const ParsedPass* last = last_of_kind(parsed, kind);
    if (known && reaches_target && last != nullptr && last->percent < 100.0 && !decreases)
        reader.report(reader.member(last->node, "percent").pointer,
                      fmt::format("the last pass {} to {:g} percent only", verb(kind), *last->percent),
                      "100");
}

void check_percent(JsonReader& reader, const JsonNode& passes, const std::vector<ParsedPass>& parsed) {
    bool known = true;
    for (const ParsedPass& parsed_pass : parsed) {
        const JsonNode percent = reader.member(parsed_pass.node, "percent");
        const bool shares = is_kind(parsed_pass, PassKind::tighten) || is_kind(parsed_pass, PassKind::turn);
        known = known && parsed_pass.kind && reader.is_valid(percent.pointer);
        if (parsed_pass.kind && !shares && percent)
            reader.report(percent.pointer,
                          "only a pass of kind \"tighten\" or \"turn\" has a share of the target",
                          "no \"percent\" here");
    }
    const bool turns = last_of_kind(parsed, PassKind::turn) != nullptr;
    check_shares(reader, parsed, PassKind::tighten, !turns);
    check_shares(reader, parsed, PassKind::turn, true);
    if (known && !turns && last_of_kind(parsed, PassKind::tighten) == nullptr)
        reader.report(passes.pointer, "no pass tightens", "a pass of kind \"tighten\" with 100 percent");
}

// Checks that nuts are run down before a wrench tightens them, are snug before they are turned by an angle,
// and are rechecked after the last pass that tightens or turns.
void check_sequence(JsonReader& reader, const std::vector<ParsedPass>& parsed) {
    const auto kind_at = [&](std::size_t i) { return reader.member(parsed[i].node, "kind").pointer; };
    const auto uses_wrench = [](const ParsedPass& parsed_pass) {
        return parsed_pass.kind && parsed_pass.kind != PassKind::run_down;
    };
    const auto first =
        static_cast<std::size_t>(std::find_if(parsed.begin(), parsed.end(), uses_wrench) - parsed.begin());
    const bool run_down = first > 0;  // or a pass of unreadable kind comes first
    if (first < parsed.size() && !run_down)
        reader.report(kind_at(first),
                      fmt::format("this pass {} before the nuts are run down", verb(*parsed[first].kind)),
                      "a pass of kind \"run_down\" first");
    std::size_t last = 0;  // index of the last pass that tightens or turns
    for (std::size_t i = 0; i < parsed.size(); ++i)
        if (is_kind(parsed[i], PassKind::tighten) || is_kind(parsed[i], PassKind::turn)) last = i;
    for (std::size_t i = 0; i < last; ++i)
        if (is_kind(parsed[i], PassKind::recheck) && (run_down || i != first))
            reader.report(kind_at(i),
                          fmt::format("this pass rechecks before the last pass that {}, in line {}",
                                      verb(*parsed[last].kind), reader.line(parsed[last].node.pointer)),
                          "a recheck after that pass");
    const ParsedPass* turn = nullptr;  // the first one
    for (std::size_t i = 0; i < parsed.size(); ++i) {
        if (is_kind(parsed[i], PassKind::tighten) && turn != nullptr)
            reader.report(kind_at(i),
                          fmt::format("this pass tightens to a torque after the pass that turns by an angle, "
                                      "in line {}",
                                      reader.line(turn->node.pointer)),
                          "all passes of kind \"tighten\" before those of kind \"turn\"");
        if (is_kind(parsed[i], PassKind::turn) && turn == nullptr) turn = &parsed[i];
    }
    const bool all_kinds = std::all_of(parsed.begin(), parsed.end(), [](const auto& p) { return p.kind; });
    if (turn != nullptr && all_kinds && last_of_kind(parsed, PassKind::tighten) == nullptr)
        reader.report(reader.member(turn->node, "kind").pointer,
                      "this pass turns nuts that are not snug: no pass tightens them before",
                      "a pass of kind \"tighten\" to a small share of the target torque before it");
}

// Checks that every joint has a target angle if a pass turns it by an angle.
void check_angles_of_turn(JsonReader& reader, const std::vector<ParsedPass>& parsed,
                          const std::vector<AssemblyJoint>& joints) {
    const auto turn = std::find_if(parsed.begin(), parsed.end(),
                                   [](const ParsedPass& p) { return is_kind(p, PassKind::turn); });
    if (turn == parsed.end()) return;
    const JsonNode all = reader.member(reader.root(), "joint_types");
    std::vector<std::string> types;  // without a target angle
    for (const AssemblyJoint& joint : joints) {
        const JsonNode type = reader.member(all, joint.type);
        const bool readable = type && reader.is_valid(type.pointer);
        if (joint.spec.strategy != Strategy::torque_angle && readable &&
            std::find(types.begin(), types.end(), in_quotes(joint.type)) == types.end())
            types.push_back(in_quotes(joint.type));
    }
    if (!types.empty())
        reader.report(reader.member(turn->node, "kind").pointer,
                      fmt::format("this pass turns by an angle, but {} {} none", fmt::join(types, ", "),
                                  types.size() == 1 ? "has" : "have"),
                      "\"strategy\": \"torque_angle\" there, with min_angle_deg and max_angle_deg");
}

PassKind kind_named(std::string_view name) {
    return name == "run_down"  ? PassKind::run_down
           : name == "recheck" ? PassKind::recheck
           : name == "turn"    ? PassKind::turn
                               : PassKind::tighten;
}

std::vector<ParsedPass> parse_passes(JsonReader& reader, const JsonNode& passes) {
    std::vector<ParsedPass> parsed;
    for (const JsonNode& node : reader.items(passes)) {
        ParsedPass parsed_pass;
        parsed_pass.node = node;
        if (const auto kind = reader.text(reader.member(node, "kind"))) parsed_pass.kind = kind_named(*kind);
        parsed_pass.percent = reader.number(reader.member(node, "percent"));
        parsed.push_back(std::move(parsed_pass));
    }
    return parsed;
}

// A list of passes: the variant's own one, or the file's.
JsonNode passes_of(JsonReader& reader, const std::string& variant, const char* key) {
    const JsonNode variants = reader.member(reader.root(), "variants");
    const JsonNode own = reader.member(reader.member(variants, variant), key);
    return own ? own : reader.member(reader.root(), key);
}

// The passes of a loosening lesson turn each nut back by an angle, and the last one loosens it.
Pass read_loosening_pass(JsonReader& reader, const JsonNode& node, bool last) {
    const JsonNode kind_node = reader.member(node, "kind"), angle_node = reader.member(node, "angle_deg");
    const auto kind = reader.text(kind_node);
    const auto angle = reader.number(angle_node);
    Pass pass;
    pass.kind = PassKind::loosen;
    pass.turn_back = to_radians(angle.value_or(0.0));
    if (!kind) return pass;
    const bool turns_back = *kind == "turn_back";
    if (turns_back && !angle_node && reader.is_valid(angle_node.pointer))
        reader.report(node.pointer, "a pass of kind \"turn_back\" without \"angle_deg\"",
                      "the angle by which each nut is turned back");
    if (!turns_back && angle_node)
        reader.report(angle_node.pointer, "a pass of kind \"loosen\" turns each nut until it is free",
                      "no \"angle_deg\" here");
    if (turns_back == last)
        reader.report(
            kind_node.pointer,
            last ? "the last pass leaves the nuts tight" : "nothing is left to loosen after this pass",
            last ? "a pass of kind \"loosen\" at the end" : "a pass of kind \"loosen\" at the end only");
    return pass;
}

}  // namespace

double smallest_pass_fraction(JsonReader& reader, const std::string& variant) {
    double least = 1.0;
    for (const ParsedPass& parsed_pass : parse_passes(reader, passes_of(reader, variant, "passes")))
        if (parsed_pass.kind == PassKind::tighten && parsed_pass.percent)
            least = std::min(least, *parsed_pass.percent / 100.0);
    return least;
}

VariantJoints read_variant_joints(JsonReader& reader, const std::string& variant) {
    VariantJoints result;
    result.all = read_joints(reader, variant);
    const JsonNode selection = variant_joint_list(reader, variant);
    result.named_by_variant = static_cast<bool>(selection);
    if (!result.named_by_variant) {
        result.joints = result.all;
        return result;
    }
    if (result.all.empty()) return result;
    const std::vector<std::size_t> order =
        read_order(reader, selection, read_ids(reader, result.all), OrderRule::some_joints);
    std::vector<std::size_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (const std::size_t joint : sorted) result.joints.push_back(result.all[joint]);
    for (const std::size_t joint : order)
        result.order.push_back(
            static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), joint) - sorted.begin()));
    return result;
}

AssemblyPasses read_passes(JsonReader& reader, const PassReferences& context) {
    const std::vector<AssemblyJoint>& joints = context.joints.joints;
    JointIds ids = read_ids(reader, joints);
    const JsonNode common_node = reader.member(reader.root(), "order");
    std::vector<std::size_t> common = listed_order(joints.size());
    if (common_node && !context.joints.all.empty()) {
        // The file's order has all joints, also if this variant leaves some out.
        const std::vector<std::size_t> whole =
            read_order(reader, common_node, read_ids(reader, context.joints.all));
        if (!context.joints.named_by_variant) common = whole;
    }
    if (context.joints.named_by_variant) {
        common = context.joints.order;
        ids.owner = "this variant";
    }
    const auto order_of = [&](const JsonNode& pass, const std::vector<std::size_t>& usual) {
        const JsonNode order = reader.member(pass, "order");
        if (!order || joints.empty()) return usual;
        // A pass of the file has all its joints; those that this variant leaves out are skipped.
        const bool of_file = !pass.pointer.starts_with("/variants/");
        if (!of_file || !context.joints.named_by_variant) return read_order(reader, order, ids);
        std::vector<std::size_t> own;
        for (const std::size_t joint : read_order(reader, order, read_ids(reader, context.joints.all)))
            for (std::size_t i = 0; i < joints.size(); ++i)
                if (joints[i].index_in_file == joint) own.push_back(i);
        return own;
    };

    AssemblyPasses result;
    const JsonNode list = passes_of(reader, context.variant, "passes");
    const std::vector<ParsedPass> parsed = parse_passes(reader, list);
    for (const ParsedPass& parsed_pass : parsed) {
        Pass pass;
        pass.kind = parsed_pass.kind.value_or(PassKind::tighten);
        pass.fraction = parsed_pass.percent.value_or(100.0) / 100.0;
        pass.order = order_of(parsed_pass.node, common);
        pass.instruction = read_instruction(reader, parsed_pass.node, context);
        result.tightening.push_back(std::move(pass));
    }
    if (!parsed.empty()) {
        check_percent(reader, list, parsed);
        check_sequence(reader, parsed);
        check_angles_of_turn(reader, parsed, joints);
    }
    std::vector<std::size_t> reverse = result.tightening.empty() ? common : result.tightening.back().order;
    std::reverse(reverse.begin(), reverse.end());
    const std::vector<JsonNode> loosening = reader.items(passes_of(reader, context.variant, "loosening"));
    for (const JsonNode& node : loosening) {
        Pass pass = read_loosening_pass(reader, node, &node == &loosening.back());
        pass.order = order_of(node, reverse);
        pass.instruction = read_instruction(reader, node, context);
        result.loosening.push_back(std::move(pass));
    }
    return result;
}

}  // namespace bolt::content
