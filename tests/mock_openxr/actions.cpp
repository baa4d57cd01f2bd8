// Action sets, actions and suggested bindings of the mock runtime.
#include <fmt/format.h>

#include <algorithm>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

// Names consist of small letters, digits, "-", "_" and ".".
bool is_name(const char* text) {
    const std::string_view name(text);
    return !name.empty() &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_.") == std::string_view::npos;
}

XrResult XRAPI_CALL create_set(XrInstance, const XrActionSetCreateInfo* info, XrActionSet* set) {
    constexpr const char* name = "xrCreateActionSet";
    return call(name, Level::instance, [&](State& s, auto&) {
        if (!is_name(info->actionSetName))
            return refuse(s, name, XR_ERROR_PATH_FORMAT_INVALID, "is given a name that is no path");
        if (info->localizedActionSetName[0] == '\0')
            return refuse(s, name, XR_ERROR_LOCALIZED_NAME_INVALID, "is given no name for the user");
        s.instance->sets[++s.last_id] = {info->actionSetName, false};
        *set = handle_of<XrActionSet>(s.last_id);
        return XR_SUCCESS;
    });
}

void end_actions_of(State& s, std::uint64_t set) {
    std::map<std::uint64_t, Action>& actions = s.instance->actions;
    for (auto action = actions.begin(); action != actions.end();) {
        if (action->second.set != set) {
            ++action;
            continue;
        }
        s.ended[action->first] = Kind::action;
        action = actions.erase(action);
    }
}

XrResult XRAPI_CALL destroy_set(XrActionSet handle) {
    constexpr const char* name = "xrDestroyActionSet";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    end_actions_of(s, id_of(handle));
    return remove(s, name, s.instance->sets, handle, Kind::action_set) ? success : XR_ERROR_HANDLE_INVALID;
}

// A role of a Vive tracker that this runtime does not know, such as an older one the wrists.
bool has_unknown_role(const Config& config, const std::string& path) {
    return std::any_of(config.unknown_roles.begin(), config.unknown_roles.end(),
                       [&](const std::string& role) {
                           return path == role_folder + role || path.rfind(role_folder + role + "/", 0) == 0;
                       });
}

XrResult XRAPI_CALL create_action(XrActionSet handle, const XrActionCreateInfo* info, XrAction* action) {
    constexpr const char* name = "xrCreateAction";
    return call(name, Level::instance, [&](State& s, auto&) {
        const ActionSet* set = find(s, name, s.instance->sets, handle);
        if (set == nullptr) return XR_ERROR_HANDLE_INVALID;
        if (set->attached)
            return refuse(s, name, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "is called after attaching");
        if (!is_name(info->actionName))
            return refuse(s, name, XR_ERROR_PATH_FORMAT_INVALID, "is given a name that is no path");
        if (info->localizedActionName[0] == '\0')
            return refuse(s, name, XR_ERROR_LOCALIZED_NAME_INVALID, "is given no name for the user");
        for (const auto& [id, other] : s.instance->actions)
            if (other.set == id_of(handle) && other.name == info->actionName)
                return refuse(s, name, XR_ERROR_NAME_DUPLICATED, "is given a name that another action has");
        const Config& config = s.instance->config;
        for (std::uint32_t i = 0; config.refuses_unknown_roles && i < info->countSubactionPaths; ++i)
            if (has_unknown_role(config, s.instance->paths[info->subactionPaths[i] - 1]))
                return XR_ERROR_PATH_UNSUPPORTED;
        Action created;
        created.set = id_of(handle);
        created.name = info->actionName;
        created.type = info->actionType;
        created.sides.assign(info->subactionPaths, info->subactionPaths + info->countSubactionPaths);
        s.instance->actions[++s.last_id] = std::move(created);
        *action = handle_of<XrAction>(s.last_id);
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL destroy_action(XrAction handle) {
    constexpr const char* name = "xrDestroyAction";
    State& s = state();
    const std::unique_lock lock(s.mutex);
    const XrResult success = enter_destroying(s, name);
    if (!s.instance) return refuse(s, name, XR_ERROR_HANDLE_INVALID, "is called without an instance");
    return remove(s, name, s.instance->actions, handle, Kind::action) ? success : XR_ERROR_HANDLE_INVALID;
}

const std::string* text_of(const State& s, XrPath path) {
    if (path == XR_NULL_PATH || path > s.instance->paths.size()) return nullptr;
    return &s.instance->paths[path - 1];
}

// The profiles that this runtime knows: those of the specification, of enabled extensions, and not excluded.
bool knows(const State& s, const std::string& profile) {
    const std::vector<std::string>& unknown = s.instance->config.unknown_profiles;
    const bool excluded = std::find(unknown.begin(), unknown.end(), profile) != unknown.end();
    const auto enabled = [&](const char* extension) { return s.instance->extensions.count(extension) != 0; };
    const bool known =
        profile == "/interaction_profiles/ext/hand_interaction_ext" ? enabled("XR_EXT_hand_interaction")
        : profile == "/interaction_profiles/htc/vive_tracker_htcx"  ? enabled(vive_tracker_extension)
                                                                    : is_known_profile(profile);
    return known && !excluded;
}

// The components that an action of this type can be bound to.
bool fits(XrActionType type, const std::string& path) {
    const auto ends = [&](std::string_view end) {
        return path.size() >= end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
    };
    const bool is_pose = ends("/pose"), is_output = path.find("/output/") != std::string::npos;
    if (type == XR_ACTION_TYPE_POSE_INPUT) return is_pose;
    if (type == XR_ACTION_TYPE_VIBRATION_OUTPUT) return is_output;
    if (type == XR_ACTION_TYPE_VECTOR2F_INPUT) return ends("/thumbstick") || ends("/trackpad");
    return !is_pose && !is_output;
}

XrResult suggest_one(State& s, const std::string& profile, const XrActionSuggestedBinding& binding,
                     std::vector<Binding>& accepted) {
    constexpr const char* name = "xrSuggestInteractionProfileBindings";
    const Action* action = find(s, name, s.instance->actions, binding.action);
    if (action == nullptr) return XR_ERROR_HANDLE_INVALID;
    const std::string* path = text_of(s, binding.binding);
    if (path == nullptr) return refuse(s, name, XR_ERROR_PATH_INVALID, "is given a path that does not exist");
    if (has_unknown_role(s.instance->config, *path)) return XR_ERROR_PATH_UNSUPPORTED;  // a client may try
    if (!has_input(profile, *path))
        return refuse(s, name, XR_ERROR_PATH_UNSUPPORTED,
                      fmt::format("binds {}, which {} lacks", *path, profile));
    if (!fits(action->type, *path))
        return refuse(s, name, XR_ERROR_PATH_UNSUPPORTED,
                      fmt::format("binds {} to \"{}\", an action of another type", *path, action->name));
    accepted.push_back({profile, *path, id_of(binding.action)});
    return XR_SUCCESS;
}

XrResult XRAPI_CALL suggest(XrInstance, const XrInteractionProfileSuggestedBinding* info) {
    constexpr const char* name = "xrSuggestInteractionProfileBindings";
    return call(name, Level::instance, [&](State& s, auto&) {
        for (const auto& [id, set] : s.instance->sets)
            if (set.attached)
                return refuse(s, name, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "is called after attaching");
        const std::string* profile = text_of(s, info->interactionProfile);
        if (profile == nullptr)
            return refuse(s, name, XR_ERROR_PATH_INVALID, "is given a profile that does not exist");
        if (!knows(s, *profile)) return XR_ERROR_PATH_UNSUPPORTED;  // a client may try
        std::vector<Binding> accepted;
        for (std::uint32_t i = 0; i < info->countSuggestedBindings; ++i)
            if (const XrResult result = suggest_one(s, *profile, info->suggestedBindings[i], accepted);
                XR_FAILED(result))
                return result;
        std::vector<Binding>& bindings = s.instance->bindings;
        bindings.erase(std::remove_if(bindings.begin(), bindings.end(),
                                      [&](const Binding& old) { return old.profile == *profile; }),
                       bindings.end());
        bindings.insert(bindings.end(), accepted.begin(), accepted.end());
        return XR_SUCCESS;
    });
}

XrResult XRAPI_CALL attach(XrSession, const XrSessionActionSetsAttachInfo* info) {
    constexpr const char* name = "xrAttachSessionActionSets";
    return call(name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        if (session.attached)
            return refuse(s, name, XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "is called twice for a session");
        for (std::uint32_t i = 0; i < info->countActionSets; ++i)
            if (find(s, name, s.instance->sets, info->actionSets[i]) == nullptr)
                return XR_ERROR_HANDLE_INVALID;
        for (std::uint32_t i = 0; i < info->countActionSets; ++i)
            s.instance->sets[id_of(info->actionSets[i])].attached = true;
        session.attached = true;
        return XR_SUCCESS;
    });
}

}  // namespace

void add_action_functions(FunctionTable& table) {
    add(table, "xrCreateActionSet", &create_set);
    add(table, "xrDestroyActionSet", &destroy_set);
    add(table, "xrCreateAction", &create_action);
    add(table, "xrDestroyAction", &destroy_action);
    add(table, "xrSuggestInteractionProfileBindings", &suggest);
    add(table, "xrAttachSessionActionSets", &attach);
}

}  // namespace bolt::mock
