#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "content/format/read_assembly.hpp"
#include "content/format/wording.hpp"

namespace bolt::content {

namespace {

std::vector<std::size_t> as_listed(std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
}

std::string listed(const std::vector<std::string>& ids) {
    std::vector<std::string> names;
    for (const std::string& id : ids) names.push_back(in_quotes(id));
    return fmt::format("{} {} missing", fmt::join(names, ", "), names.size() == 1 ? "is" : "are");
}

// Every joint once. A name that is no joint most likely stands for one that is missing: then both are one
// mistake.
std::vector<std::size_t> read_order(Reader& reader, const Node& node, const std::vector<std::string>& ids) {
    std::vector<std::size_t> order;
    std::vector<Node> unknown;
    std::vector<std::string> first(ids.size());
    for (const Node& item : reader.items(node)) {
        const auto id = reader.text(item);
        if (!id) return {};
        const auto index = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), *id) - ids.begin());
        if (index == ids.size()) {
            unknown.push_back(item);
        } else if (!first[index].empty()) {
            reader.report(item.pointer, fmt::format("{} comes twice in this order", in_quotes(*id)),
                          fmt::format("expected every joint once; it comes first in line {}",
                                      reader.line(first[index])));
        } else {
            first[index] = item.pointer;
            order.push_back(index);
        }
    }
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (first[i].empty()) missing.push_back(ids[i]);
    for (const Node& item : unknown) {
        const std::string id = reader.text(item).value_or("");
        reader.report(item.pointer, fmt::format("{} is no joint of this file", in_quotes(id)),
                      missing.empty() ? "expected every joint once, and nothing else" : suggest(id, missing));
    }
    if (missing.size() > unknown.size())
        reader.report(node.pointer, listed(missing) + " in this order", "expected every joint once");
    return order;
}

void check_percent(Reader& reader, const std::vector<Node>& nodes, const std::vector<Pass>& passes) {
    double highest = 0.0;
    bool falls = false;
    std::size_t last = nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node percent = reader.member(nodes[i], "percent");
        if (!reader.sound(nodes[i].pointer)) return;
        if (passes[i].kind != StepKind::tighten) {
            if (percent)
                reader.report(percent.pointer, "only a pass of kind \"tighten\" has a share of the target",
                              "remove it");
            continue;
        }
        if (!percent) {
            reader.report(nodes[i].pointer, "a pass of kind \"tighten\" without \"percent\"",
                          "expected a share of the target torque, 100 in the last pass");
            return;
        }
        if (passes[i].fraction < highest) {
            falls = true;
            reader.report(
                percent.pointer,
                fmt::format("{:g} percent after {:g} percent", passes[i].fraction * 100.0, highest * 100.0),
                "expected shares that do not fall");
        }
        highest = std::max(highest, passes[i].fraction);
        last = i;
    }
    const Node list = reader.member(reader.root(), "passes");
    if (last == nodes.size())
        reader.report(list.pointer, "no pass tightens",
                      "expected a pass of kind \"tighten\" with 100 percent");
    else if (passes[last].fraction < 1.0 && !falls)
        reader.report(
            reader.member(nodes[last], "percent").pointer,
            fmt::format("the last pass tightens to {:g} percent only", passes[last].fraction * 100.0),
            "expected 100");
}

}  // namespace

std::vector<Pass> read_passes(Reader& reader, const std::vector<AssemblyJoint>& joints) {
    std::vector<std::string> ids;
    for (const AssemblyJoint& joint : joints) ids.push_back(joint.design.id);
    // Where ids are missing or repeated, that is the mistake, and not what it makes of every order.
    const std::set<std::string> different(ids.begin(), ids.end());
    const bool ids_known = !ids.empty() && different.size() == ids.size() && !different.contains("");

    const Node common_node = reader.member(reader.root(), "order");
    std::vector<std::size_t> common = as_listed(joints.size());
    if (common_node && ids_known) common = read_order(reader, common_node, ids);

    const Node list = reader.member(reader.root(), "passes");
    const std::vector<Node> nodes = reader.items(list);
    std::vector<Pass> passes;
    for (const Node& node : nodes) {
        Pass pass;
        const std::string kind = reader.text(reader.member(node, "kind")).value_or("tighten");
        pass.kind = kind == "run_down"  ? StepKind::run_down
                    : kind == "recheck" ? StepKind::recheck
                                        : StepKind::tighten;
        pass.fraction = reader.number(reader.member(node, "percent")).value_or(100.0) / 100.0;
        const Node order = reader.member(node, "order");
        pass.order = order && ids_known ? read_order(reader, order, ids) : common;
        passes.push_back(std::move(pass));
    }
    if (!nodes.empty()) check_percent(reader, nodes, passes);
    return passes;
}

}  // namespace bolt::content
