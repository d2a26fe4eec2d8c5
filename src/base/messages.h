/// What went wrong and where: messages with places in source files, collected while loading.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen {

/// A place in a text file. Lines and columns count from 1; line 0 means the file as a whole, no file means
/// none.
struct Place {
    std::shared_ptr<const std::string> file;
    std::uint32_t line = 0;
    std::uint32_t column = 0;

    static Place of_file(std::string path);
    /// "file:line:column", "file" or "".
    std::string text() const;
};

struct Message {
    enum class Kind { error, warning };
    Kind kind = Kind::error;
    Place place;
    std::string text;

    /// "file:line:column: error: text"
    std::string full_text() const;
};

/// Thrown once loading has collected every message it could. what() holds all of them, one a line.
class SceneError : public std::runtime_error {
  public:
    explicit SceneError(std::vector<Message> messages);
    SceneError(Place place, std::string text);
    const std::vector<Message>& messages() const { return messages_; }

  private:
    std::vector<Message> messages_;
};

/// Collects messages; may be called from several threads. After max_errors errors (20), add_error throws the
/// SceneError itself, so that a hopeless file does not print for ever.
class Messages {
  public:
    static constexpr std::size_t max_errors = 20;

    /// Lenient loading: errors that name a substitute become warnings.
    bool lenient = false;

    void add_error(Place place, std::string text);
    void add_warning(Place place, std::string text);
    /// An error; when lenient, a warning that ends in "; using " + substitute instead.
    void add_unsupported(Place place, std::string text, std::string_view substitute);

    std::size_t error_count() const;
    /// All messages so far, sorted by nothing: in the order in which they came.
    std::vector<Message> list() const;
    std::vector<Message> warnings() const;
    /// Throws SceneError when an error was added.
    void throw_if_errors() const;

  private:
    mutable std::mutex mutex_;
    std::vector<Message> list_;
    std::size_t errors_ = 0;
};

/// The candidate nearest to word by edit distance, or "" when none is near (at most a third of the word
/// wrong).
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);
/// " (did you mean \"x\"?)" for the nearest candidate; else "; known: a, b, c" cut to a sensible length.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

} // namespace alhazen
