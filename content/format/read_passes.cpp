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
    std::size_t repeats = 0;  // number of joints with a repeated id
};

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
                ids.repeated = fmt::format("the joint in line {}, whose id is a repetition",
                                           reader.line(reader.member(nodes[i], "id").pointer));
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

// Reads an order, which must contain every joint once. An unknown name probably stands for a missing joint
// (only the name is then reported), or for a joint without a valid id (the name is then not reported).
std::vector<std::size_t> read_order(JsonReader& reader, const JsonNode& node, const JointIds& ids) {
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
            reader.report(item.pointer, fmt::format("{} is not a joint of this file", in_quotes(id)),
                          suggest_joint(id, missing, ids.repeated));
        }
    if (!missing.empty() && missing.size() + ids.without_id + ids.repeats > unknown.size())
        reader.report(node.pointer, missing_text(missing) + " in this order", "every joint once");
    return order;
}

// A pass as read from the file. Invalid members are absent.
struct ParsedPass {
    JsonNode node;
    std::optional<PassKind> kind;
    std::optional<double> percent;  // tighten only
};

// Checks the percentages of the target torque: they must not decrease, and the last must be 100.
void check_percent(JsonReader& reader, const std::vector<ParsedPass>& parsed) {
    double highest = 0.0;
    bool decreases = false, known = true;
    const ParsedPass* last = nullptr;
    for (const ParsedPass& parsed_pass : parsed) {
        const JsonNode percent = reader.member(parsed_pass.node, "percent");
        known = known && parsed_pass.kind && reader.is_valid(percent.pointer);
        if (parsed_pass.kind && parsed_pass.kind != PassKind::tighten && percent)
            reader.report(percent.pointer, "only a pass of kind \"tighten\" has a share of the target",
                          "no \"percent\" here");
        if (parsed_pass.kind != PassKind::tighten) continue;
        last = &parsed_pass;
        if (!percent) {
            if (reader.is_valid(percent.pointer))
                reader.report(parsed_pass.node.pointer, "a pass of kind \"tighten\" without \"percent\"",
                              "a share of the target torque, 100 in the last pass");
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
    if (!known) return;
    if (last == nullptr)
        reader.report(reader.member(reader.root(), "passes").pointer, "no pass tightens",
                      "a pass of kind \"tighten\" with 100 percent");
    else if (last->percent < 100.0 && !decreases)
        reader.report(reader.member(last->node, "percent").pointer,
                      fmt::format("the last pass tightens to {:g} percent only", *last->percent), "100");
}

// Checks that nuts are run down before a wrench tightens them, and rechecked after the last tightening.
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
                      fmt::format("this pass {} before the nuts are run down",
                                  parsed[first].kind == PassKind::recheck ? "rechecks" : "tightens"),
                      "a pass of kind \"run_down\" first");
    std::size_t last = 0;  // index of the last pass that tightens
    for (std::size_t i = 0; i < parsed.size(); ++i)
        if (parsed[i].kind == PassKind::tighten) last = i;
    for (std::size_t i = 0; i < last; ++i)
        if (parsed[i].kind == PassKind::recheck && (run_down || i != first))
            reader.report(kind_at(i),
                          fmt::format("this pass rechecks before the last pass that tightens, in line {}",
                                      reader.line(parsed[last].node.pointer)),
                          "a recheck after that pass");
}

std::vector<ParsedPass> parse_passes(JsonReader& reader) {
    std::vector<ParsedPass> parsed;
    for (const JsonNode& node : reader.items(reader.member(reader.root(), "passes"))) {
        ParsedPass parsed_pass;
        parsed_pass.node = node;
        const auto kind = reader.text(reader.member(node, "kind"));
        if (kind)
            parsed_pass.kind = kind == "run_down"  ? PassKind::run_down
                               : kind == "recheck" ? PassKind::recheck
                                                   : PassKind::tighten;
        parsed_pass.percent = reader.number(reader.member(node, "percent"));
        parsed.push_back(std::move(parsed_pass));
    }
    return parsed;
}

}  // namespace

double smallest_pass_fraction(JsonReader& reader) {
    double least = 1.0;
    for (const ParsedPass& parsed_pass : parse_passes(reader))
        if (parsed_pass.kind == PassKind::tighten && parsed_pass.percent)
            least = std::min(least, *parsed_pass.percent / 100.0);
    return least;
}

std::vector<Pass> read_passes(JsonReader& reader, const std::vector<AssemblyJoint>& joints) {
    const JointIds ids = read_ids(reader, joints);
    const JsonNode common_node = reader.member(reader.root(), "order");
    std::vector<std::size_t> common = listed_order(joints.size());
    if (common_node && !joints.empty()) common = read_order(reader, common_node, ids);

    const std::vector<ParsedPass> parsed = parse_passes(reader);
    std::vector<Pass> passes;
    for (const ParsedPass& parsed_pass : parsed) {
        Pass pass;
        pass.kind = parsed_pass.kind.value_or(PassKind::tighten);
        pass.fraction = parsed_pass.percent.value_or(100.0) / 100.0;
        const JsonNode order = reader.member(parsed_pass.node, "order");
        pass.order = order && !joints.empty() ? read_order(reader, order, ids) : common;
        passes.push_back(std::move(pass));
    }
    if (!parsed.empty()) {
        check_percent(reader, parsed);
        check_sequence(reader, parsed);
    }
    return passes;
}

}  // namespace bolt::content
