/// A pbrt-v4 scene file's directives, read one after the other and handed to the builder.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "formats/pbrt/builder.h"
#include "formats/pbrt/tokenizer.h"

namespace alhazen {

class PbrtParser {
  public:
    static constexpr std::size_t deepest_includes = 64;
    /// Files may include one file often, but twice at each of 64 levels would never end.
    static constexpr std::size_t most_includes = 100000;

    PbrtParser(PbrtBuilder& builder, std::filesystem::path base_folder)
        : builder_(builder), base_folder_(std::move(base_folder)) {}

    /// Reads all of text. path is the file's for the check of files that include themselves, or empty.
    /// Returns the place where the text ends.
    Place parse(std::string_view text, std::shared_ptr<const std::string> file_name,
                const std::filesystem::path& path);

  private:
    struct OpenFile {
        PbrtTokenizer* tokens;
        std::filesystem::path path;
    };
    friend struct DirectiveTable;

    void read_directive(const PbrtToken& word);
    void skip_to_directive();
    void resolve_and_parse(const std::string& name, const Place& place);
    void import(const std::string& name, Place place);

    PbrtTokenizer& tokens() { return *open_.back().tokens; }
    /// Throws SyntaxError at the token, which stays the next: it may be the directive to go on at.
    [[noreturn]] void fail_at(const PbrtToken& token, const std::string& text);
    /// A string in quotes; what it is says the message when there is something else.
    std::string string(std::string_view what);
    template <std::size_t n>
    std::array<double, n> numbers(std::string_view directive);
    std::array<double, 16> matrix(std::string_view directive);
    /// A type in quotes and parameters.
    Node node(const Place& place, bool rgb_lists = false);
    void medium_interface(Place place);
    void texture(Place place);
    void sdf(Place place);
    void option(Place place);

    PbrtBuilder& builder_;
    std::filesystem::path base_folder_;
    std::vector<OpenFile> open_;
    std::size_t includes_ = 0;
};

} // namespace alhazen
