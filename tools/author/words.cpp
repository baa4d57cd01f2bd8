#include "content/words/words.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/base/console.hpp"
#include "engine/text/fonts.hpp"
#include "engine/text/utf8.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

namespace {

// What no font has would be a box in the window.
std::vector<Error> missing_letters(const words::Loaded& loaded, const std::string& file,
                                   const text::Fonts& fonts) {
    std::vector<Error> errors;
    for (std::size_t i = 0; i < words::key_count; ++i)
        for (const char32_t point : text::decode(loaded.words.texts[i])) {
            if (text::find_glyph(fonts, point).glyph != 0) continue;
            Error error;
            error.code = ErrorCode::bad_content;
            error.file = file;
            error.line = loaded.lines[i];
            error.pointer = fmt::format("/words/{}", words::key_rows[i].name);
            error.what = fmt::format("no font has the letter \"{}\"", text::encode({&point, 1}));
            errors.push_back(std::move(error));
            break;
        }
    return errors;
}

int run_words(std::vector<std::string> files) {
    if (files.empty())
        for (const std::string& language : words::languages(words::words_folder()))
            files.push_back((words::words_folder() / (language + ".json")).string());
    const Result<text::Fonts> fonts = text::load_fonts();
    if (!fonts) return print_error(fonts.error());
    int worst = 0;
    for (const std::string& file : files) {
        const words::Loaded loaded = words::read_words(file);
        std::vector<Error> errors = loaded.errors;
        if (errors.empty()) errors = missing_letters(loaded, file, *fonts);
        if (!errors.empty()) {
            worst = std::max(worst, print_error(errors));
            continue;
        }
        const Status said =
            print(fmt::format("{}: {}, {} texts\n", file, loaded.words.name, words::key_count));
        if (!said) return print_error(said.error());
    }
    return worst;
}

}  // namespace

void add_words(CLI::App& app, int& exit_code) {
    auto files = std::make_shared<std::vector<std::string>>();
    CLI::App* command = app.add_subcommand(
        "words", "Check what the program says in a language: every text there, with its places and letters");
    command->add_option("files", *files, "Files LANGUAGE.json; those of content/words if not given");
    command->callback([files, &exit_code] { exit_code = run_words(*files); });
}

}  // namespace bolt::author
