/// The manual's examples are written in the language that scenes are read in.
#include <gtest/gtest.h>

#include "formats/format.h"
#include "render/manual.h"

namespace alhazen::testing {
namespace {

std::vector<std::string> examples_of(const std::string& page) {
    constexpr std::string_view fence = "```\n";
    std::vector<std::string> examples;
    for (std::size_t at = page.find(fence); at != page.npos; at = page.find(fence, at)) {
        at += fence.size();
        const std::size_t end = page.find(fence, at);
        examples.push_back(page.substr(at, end - at));
        at = end + fence.size();
    }
    return examples;
}

TEST(Manual, ExamplesCanBeRead) {
    std::size_t count = 0;
    for (const FamilyInfo& family : families()) {
        const std::vector<std::string> examples = examples_of(family_markdown(family));
        count += examples.size();
        const std::vector<std::string_view> options{"integrator", "camera",  "film",
                                                    "filter",     "sampler", "accelerator"};
        const bool is_option = std::find(options.begin(), options.end(), family.name) != options.end();
        for (const std::string& example : examples) {
            SCOPED_TRACE(example);
            Messages messages;
            try {
                read_pbrt_string(is_option ? example + "WorldBegin\n" : "WorldBegin\n" + example, ".",
                                 messages);
            } catch (const SceneError& e) {
                ADD_FAILURE() << e.what();
            }
        }
    }
    EXPECT_GT(count, 100u);
}

} // namespace
} // namespace alhazen::testing
