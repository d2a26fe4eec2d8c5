/// Files without a name.
#include "base/temporary_file.h"

#include <array>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alhazen {
namespace {

template <class Use>
std::string error_of(Use use) {
    try {
        use();
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "";
}

TEST(TemporaryFile, GivesBackWhatWasWritten) {
    TemporaryFile file;
    EXPECT_EQ(file.size(), 0u);
    EXPECT_EQ(file.reserve(100), 0u);
    EXPECT_EQ(file.reserve(3), 100u);
    EXPECT_EQ(file.size(), 103u);
    const std::array written{std::byte{1}, std::byte{2}, std::byte{3}};
    file.write(100, written);
    std::array<std::byte, 3> read{};
    file.read(100, read);
    EXPECT_EQ(read, written);
    EXPECT_THAT(error_of([&] { file.read(101, read); }), testing::HasSubstr("it ends too early"));
}

TEST(TemporaryFile, RefusesWhatTheDiskHasNoRoomFor) {
    TemporaryFile file;
    const std::string error = error_of([&] { file.reserve(std::uint64_t{1} << 60); });
    EXPECT_THAT(error, testing::HasSubstr("MB more are needed in the temporary folder"));
    EXPECT_THAT(error, testing::HasSubstr("TMPDIR names another folder"));
    EXPECT_EQ(file.reserve(1), 0u) << "the file has not grown";
}

} // namespace
} // namespace alhazen
