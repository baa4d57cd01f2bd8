#include "engine/program/program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

namespace bolt {

namespace {

// Escapes the characters that man(7) would interpret: backslashes, hyphens, and a dot or apostrophe at the
// beginning of a line.
std::string in_roff(std::string_view text) {
    std::string written;
    for (const char c : text) {
        const bool begins = written.empty() || written.back() == '\n';
        if (begins && (c == '.' || c == '\'')) written += "\\&";
        if (c == '\\')
            written += "\\e";
        else if (c == '-')
            written += "\\-";
        else
            written += c;
    }
    return written;
}

// Lets a long list of choices continue on the next line.
std::string breakable(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 3)
        text.insert(at + 1, "\\:");
    return text;
}

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

// Options first, then arguments; without hidden ones.
std::vector<const CLI::Option*> visible_options(const CLI::App& app) {
    std::vector<const CLI::Option*> options =
        app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
    std::stable_partition(options.begin(), options.end(),
                          [](const CLI::Option* option) { return option->nonpositional(); });
    return options;
}

// "--mode", "-h, --help".
std::string names(const CLI::Option& option) {
    std::vector<std::string> all;
    for (const std::string& name : option.get_snames()) all.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
    return all.empty() ? option.get_name(true) : fmt::format("{}", fmt::join(all, ", "));
}

// The accepted words of an option that takes one of a list; CLI11 describes its type as "TEXT:{one,two}".
std::vector<std::string> accepted_words(const CLI::Option& option) {
    std::vector<std::string> words;
    const std::string type = option.get_type_name();
    const std::size_t begin = type.find('{'), end = type.find('}');
    if (begin == std::string::npos || end == std::string::npos) return words;
    for (const std::string& word : CLI::detail::split(type.substr(begin + 1, end - begin - 1), ','))
        words.push_back(word);
    return words;
}

// The value that an option takes: empty for a flag, "one|two" for a list of words, else its type.
std::string value_of(const CLI::Option& option) {
    if (option.get_type_size() == 0) return {};
    const std::vector<std::string> words = accepted_words(option);
    return words.empty() ? option.get_type_name() : fmt::format("{}", fmt::join(words, "|"));
}

std::string describe_option(const CLI::Option& option) {
    const std::string value = value_of(option);
    std::string text = ".TP\n";
    if (option.nonpositional())
        text += fmt::format("\\fB{}\\fR{}\n", in_roff(names(option)),
                            value.empty() ? "" : fmt::format(" \\fI{}\\fR", breakable(in_roff(value))));
    else
        text += fmt::format("\\fI{}\\fR\n", in_roff(option.get_name(true)));
    text += in_roff(option.get_description());
    if (const std::string preset = option.get_default_str(); !preset.empty())
        text += fmt::format(" (default: {})", in_roff(preset));
    if (option.get_required()) text += " (required)";
    return text + "\n";
}

// Appends the section of a command to the page, then those of its subcommands.
void describe_command(const CLI::App& command, const std::string& path, std::string& page) {
    page += fmt::format(".SS {} {}\n", in_roff(path), in_roff(command.get_name()));
    page += in_roff(command.get_description()) + ".\n";
    for (const CLI::Option* option : visible_options(command))
        if (option != command.get_help_ptr()) page += describe_option(*option);
    for (const CLI::App* sub : subcommands(command))
        describe_command(*sub, path + " " + command.get_name(), page);
}

constexpr const char* closing = R"(.SH EXIT STATUS
.TP
0
Done.
.TP
1
The work itself failed: a full disk, a broken session file, an unfinished lesson.
.TP
2
The command line is wrong.
.TP
3
A content file is wrong; the message names file, line and column.
.TP
4
A requested device or GPU is missing.
.SH ENVIRONMENT
.TP
\fBBOLTWRIGHT_CONTENT\fR
Folder of assemblies, tools and words, in place of the installed one.
.TP
\fBBOLTWRIGHT_ARM_PLUGINS\fR
Folders of plug-ins for force-feedback arms, separated by colons.
.TP
\fBXDG_DATA_HOME\fR
Settings, glove calibrations and sessions are kept in \fIboltwright\fR below this folder (default: \fI~/.local/share\fR).
.TP
\fBXDG_DATA_DIRS\fR
Folders that are searched for \fIboltwright/content\fR.
)";

// The words that may follow a command, or an option of it.
struct Completion {
    std::string after;  // "boltwright train", "boltwright train --mode"
    std::vector<std::string> words;
};

struct Completions {
    std::vector<Completion> commands, options;
};

void add_completions(const CLI::App& command, const std::string& path, Completions& all) {
    Completion own{path, {}};
    for (const CLI::App* sub : subcommands(command)) own.words.push_back(sub->get_name());
    for (const CLI::Option* option : visible_options(command))
        for (const std::string& name : option->get_lnames()) {
            own.words.push_back("--" + name);
            if (std::vector<std::string> accepted = accepted_words(*option); !accepted.empty())
                all.options.push_back({path + " --" + name, std::move(accepted)});
        }
    all.commands.push_back(std::move(own));
    for (const CLI::App* sub : subcommands(command)) add_completions(*sub, path + " " + sub->get_name(), all);
}

std::string bash_cases(const std::vector<Completion>& completions) {
    std::string cases;
    for (const Completion& completion : completions)
        cases += fmt::format("        \"{}\") words=\"{}\" ;;\n", completion.after,
                             fmt::join(completion.words, " "));
    return cases;
}

}  // namespace

std::string man_page(const CLI::App& app) {
    const std::string name = app.get_name();
    std::string heading = name;
    std::transform(heading.begin(), heading.end(), heading.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    std::string page = fmt::format(".TH {} 1 \"\" \"Boltwright\" \"User Commands\"\n", in_roff(heading));
    page += fmt::format(".SH NAME\n{} \\- {}\n", in_roff(name), in_roff(app.get_description()));
    page += fmt::format(".SH SYNOPSIS\n.B {}\n[\\fICOMMAND\\fR] [\\fIOPTION\\fR]...\n", in_roff(name));
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : subcommands(app)) describe_command(*command, name, page);
    page += ".SH OPTIONS\n";
    for (const CLI::Option* option : visible_options(app)) page += describe_option(*option);
    return page + closing;
}

std::string bash_completion(const CLI::App& app) {
    const std::string name = app.get_name();
    std::string function = "_" + name;
    std::replace(function.begin(), function.end(), '-', '_');
    Completions all;
    add_completions(app, name, all);
    std::vector<std::string> paths;
    for (const Completion& command : all.commands) paths.push_back('"' + command.after + '"');
    return fmt::format(
        R"(# Completes the commands and options of {name} in bash. Made by {name} --bash-completion.
{function}() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} path={name} words= i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        case "$path ${{COMP_WORDS[i]}}" in
            {paths}) path+=" ${{COMP_WORDS[i]}}" ;;
        esac
    done
    case "$path ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{options}    esac
    [[ -n $words ]] || case $path in
{commands}    esac
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o default -F {function} {name}
)",
        fmt::arg("name", name), fmt::arg("function", function), fmt::arg("paths", fmt::join(paths, "|")),
        fmt::arg("options", bash_cases(all.options)), fmt::arg("commands", bash_cases(all.commands)));
}

int run_command_line(CLI::App& app, int argc, char** argv, const int& exit_code) {
    const std::string_view only = argc == 2 ? argv[1] : "";
    if (only == "--man-page") return std::fputs(man_page(app).c_str(), stdout) < 0 ? 1 : 0;
    if (only == "--bash-completion") return std::fputs(bash_completion(app).c_str(), stdout) < 0 ? 1 : 0;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {  // for example out of memory
        (void)std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
    return exit_code;
}

}  // namespace bolt
