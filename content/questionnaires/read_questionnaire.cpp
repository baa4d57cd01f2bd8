#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "content/format/reader.hpp"
#include "content/questionnaires/questionnaire.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_questionnaire_size = 1U << 20U;  // bytes

// An id names a column of exported tables.
std::string read_id(JsonReader& reader, const JsonNode& object) {
    const JsonNode node = reader.member(object, "id");
    std::string id = reader.text(node).value_or("");
    const auto allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
               c == '_';
    };
    if (!std::all_of(id.begin(), id.end(), allowed))
        reader.report(node.pointer,
                      fmt::format("the id {} has characters that are not allowed", in_quotes(id)),
                      "letters a to z and A to Z, digits, - and _");
    return id;
}

// The ids of a list of objects.
struct KnownIds {
    std::vector<std::string> ids;  // empty texts stand for unusable ids
    bool complete = true;          // false: an id has a mistake, so an unknown id may be a consequence
};

// `kind` is "item" or "scale", for messages.
KnownIds read_ids(JsonReader& reader, const JsonNode& list, std::string_view kind) {
    KnownIds known;
    known.complete = bool{list};
    std::map<std::string, int> lines;
    for (const JsonNode& node : reader.items(list)) {
        const std::string& id = known.ids.emplace_back(read_id(reader, node));
        if (id.empty()) {
            known.complete = false;
            continue;
        }
        const std::string pointer = node.pointer + "/id";
        const auto [first, is_new] = lines.emplace(id, reader.line(pointer));
        if (is_new) continue;
        known.complete = false;
        reader.report(pointer, fmt::format("there is another {} {}", kind, in_quotes(id)),
                      fmt::format("an id of its own; the first is in line {}", first->second));
    }
    return known;
}

// The indices in `known` of the ids that `list` names. Reports repeated ids, and unknown ones if `known` is
// complete: "there is no <kind> <id><where>".
std::vector<std::size_t> read_references(JsonReader& reader, const JsonNode& list, const KnownIds& known,
                                         std::string_view kind, std::string_view where) {
    std::vector<std::size_t> indices;
    for (const JsonNode& node : reader.items(list)) {
        const auto id = reader.text(node);
        if (!id) continue;
        const auto it = std::find(known.ids.begin(), known.ids.end(), *id);
        const auto index = static_cast<std::size_t>(it - known.ids.begin());
        if (it == known.ids.end()) {
            if (known.complete)
                reader.report(
                    node.pointer, fmt::format("there is no {} {}{}", kind, in_quotes(*id), where),
                    known.ids.empty() ? fmt::format("a {}{}", kind, where) : suggest(*id, known.ids));
        } else if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
            reader.report(node.pointer, fmt::format("{} is listed twice", in_quotes(*id)), "each id once");
        } else {
            indices.push_back(index);
        }
    }
    return indices;
}

// `count`: of the answers; none if it is unknown because of a mistake.
AnswerLabels read_labels(JsonReader& reader, const JsonNode& object, std::optional<std::size_t> count) {
    AnswerLabels labels;
    for (const JsonNode& list : reader.items(reader.member(object, "labels"))) {
        std::vector<std::string>& texts = labels[last_token(list.pointer)];
        for (const JsonNode& text : reader.items(list)) texts.push_back(reader.text(text).value_or(""));
        if (count && list && texts.size() != 2 && texts.size() != *count)
            reader.report(
                list.pointer, fmt::format("{} labels", texts.size()),
                *count == 2
                    ? "2 labels, one for each answer"
                    : fmt::format(
                          "2 labels, for the lowest and the highest answer, or {}, one for each answer",
                          *count));
    }
    return labels;
}

// Returns the number of answers; none if there is a mistake.
std::optional<std::size_t> read_range(JsonReader& reader, const JsonNode& node, AnswerScale& scale) {
    const JsonNode low = reader.member(node, "low"), high = reader.member(node, "high"),
                   step = reader.member(node, "step");
    if (!low || !high || !step) return std::nullopt;
    scale.low = reader.number(low).value_or(scale.low);
    scale.high = reader.number(high).value_or(scale.high);
    scale.step = reader.number(step).value_or(scale.step);
    if (scale.high <= scale.low) {
        reader.report(high.pointer, fmt::format("the highest answer {} is not above the lowest", scale.high),
                      fmt::format("a number above {}", scale.low));
        return std::nullopt;
    }
    if (!is_answer(scale, scale.high) || answer_count(scale) < 2) {
        reader.report(step.pointer,
                      fmt::format("steps of {} do not lead from {} to {}", scale.step, scale.low, scale.high),
                      fmt::format("a number that divides {}", scale.high - scale.low));
        return std::nullopt;
    }
    return answer_count(scale);
}

// Reports a scale that has both, or neither, and members that a scale of scales cannot have.
void check_members(JsonReader& reader, const JsonNode& node) {
    const auto given = [&](const char* key) {
        const JsonNode member = reader.member(node, key);
        return member || !reader.is_valid(member.pointer);
    };
    const bool items = given("items"), scales = given("scales");
    if (node && items == scales)
        reader.report(node.pointer,
                      items ? "the scale has both \"items\" and \"scales\""
                            : "the scale has neither \"items\" nor \"scales\"",
                      "one of them");
    if (!scales || items) return;
    for (const char* key : {"reversed", "from_zero"})
        if (given(key))
            reader.report(node.pointer + "/" + key,
                          fmt::format("\"{}\" has no meaning without \"items\"", key),
                          "a scale with \"items\", or no such member", JsonPart::key);
}

// `above`: the scales that the file lists before this one.
QuestionnaireScale read_scale(JsonReader& reader, const JsonNode& node, const KnownIds& items,
                              const KnownIds& above) {
    QuestionnaireScale scale;
    scale.titles = reader.texts(reader.member(node, "title"));
    check_members(reader, node);
    const JsonNode list = reader.member(node, "items");
    KnownIds own;
    for (const std::size_t index : read_references(reader, list, items, "item", "")) {
        scale.items.push_back({index, false});
        own.ids.push_back(items.ids[index]);
    }
    own.complete = own.ids.size() == reader.items(list).size() && !own.ids.empty();
    for (const std::size_t index :
         read_references(reader, reader.member(node, "reversed"), own, "item", " in this scale"))
        scale.items[index].reversed = true;
    scale.scales = read_references(reader, reader.member(node, "scales"), above, "scale", " above this one");
    scale.from_zero = reader.boolean(reader.member(node, "from_zero")).value_or(scale.from_zero);
    if (reader.text(reader.member(node, "combine")) == "mean") scale.combination = Combination::mean;
    scale.weight = reader.number(reader.member(node, "weight")).value_or(scale.weight);
    return scale;
}

void read_items_and_scales(JsonReader& reader, std::optional<std::size_t> answers, Questionnaire& to) {
    const JsonNode items = reader.member(reader.root(), "items"),
                   scales = reader.member(reader.root(), "scales");
    const KnownIds item_ids = read_ids(reader, items, "item"), scale_ids = read_ids(reader, scales, "scale");
    for (const JsonNode& node : reader.items(items)) {
        QuestionnaireItem item{item_ids.ids[to.items.size()], {}, {}, {}};
        item.texts = reader.texts(reader.member(node, "text"));
        std::optional<std::size_t> count = answers;
        if (const JsonNode own = reader.member(node, "answers")) {
            item.answer_scale.emplace();
            count = read_range(reader, own, *item.answer_scale);
        }
        item.labels = read_labels(reader, node, count);
        to.items.push_back(std::move(item));
    }
    KnownIds above{{}, scale_ids.complete};
    for (const JsonNode& node : reader.items(scales)) {
        QuestionnaireScale scale = read_scale(reader, node, item_ids, above);
        scale.id = scale_ids.ids[to.scales.size()];
        above.ids.push_back(scale.id);
        to.scales.push_back(std::move(scale));
    }
}

const JsonSchema& questionnaire_schema() {
    static const JsonSchema schema(questionnaire_schema_text());
    return schema;
}

}  // namespace

LoadedQuestionnaire parse_questionnaire(std::string_view text, const std::string& file) {
    LoadedQuestionnaire loaded;
    const auto document = JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    JsonReader reader(*document, questionnaire_schema());
    const JsonNode root = reader.root();
    Questionnaire& questionnaire = loaded.questionnaire;
    questionnaire.id = read_id(reader, root);
    questionnaire.titles = reader.texts(reader.member(root, "title"));
    questionnaire.source = reader.text(reader.member(root, "source")).value_or("");
    questionnaire.licence = reader.text(reader.member(root, "licence")).value_or("");
    questionnaire.texts_may_be_shipped =
        reader.boolean(reader.member(root, "texts_may_be_shipped")).value_or(false);
    const JsonNode answers = reader.member(root, "answers");
    const std::optional<std::size_t> count = read_range(reader, answers, questionnaire.answer_scale);
    questionnaire.answer_scale.labels = read_labels(reader, answers, count);
    read_items_and_scales(reader, count, questionnaire);
    for (Error& error : reader.take_errors()) loaded.errors.push_back(std::move(error));
    sort_by_position(loaded.errors);
    return loaded;
}

LoadedQuestionnaire load_questionnaire(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path, max_questionnaire_size, ErrorCode::bad_content);
    if (text) return parse_questionnaire(*text, path.string());
    LoadedQuestionnaire loaded;
    loaded.errors.push_back(text.error());
    return loaded;
}

}  // namespace bolt::content
