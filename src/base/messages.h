/// What went wrong and where: messages with places in source files, collected while loading.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
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

/// Thrown once loading has collected every message it could. what() holds all of them, one a line: those of
/// one file by line and column, and otherwise as they came.
class SceneError : public std::runtime_error {
  public:
    explicit SceneError(std::vector<Message> messages);
    SceneError(Place place, std::string text);
    const std::vector<Message>& messages() const { return messages_; }

  private:
    std::vector<Message> messages_;
};

/// What lenient loading does where strict loading stops.
struct Remedy {
    std::string would; ///< follows "--lenient would ": "leave it out"
    std::string doing; ///< "leaving it out"

    static Remedy leave_out() { return {"leave it out", "leaving it out"}; }
    static Remedy ignore() { return {"ignore it", "ignoring it"}; }
    /// "use SUBSTITUTE instead", and what else is to be said of that.
    static Remedy use(std::string_view substitute, std::string_view note = "");
};

/// Collects messages; may be called from several threads. After max_errors errors (20), add_error throws the
/// SceneError itself, so that a hopeless file does not print for ever.
class Messages {
  public:
    static constexpr std::size_t max_errors = 20;

    /// Lenient loading: errors that name a substitute become warnings.
    bool lenient = false;

    void add_error(Place place, std::string text);
    /// Warnings of the same text are kept once, at the first place in their file, and counted.
    void add_warning(Place place, std::string text);
    /// An error that ends in what --lenient would do about it; when lenient, a warning that this is done.
    void add_unsupported(Place place, std::string text, const Remedy& remedy);
    void add_unsupported(Place place, std::string text, std::string_view substitute) {
        add_unsupported(std::move(place), std::move(text), Remedy::use(substitute));
    }

    std::size_t error_count() const;
    /// All messages so far: those of one file by line and column, and otherwise as they came.
    std::vector<Message> list() const;
    std::vector<Message> warnings() const;
    /// Throws SceneError when an error was added.
    void throw_if_errors() const;

  private:
    std::vector<Message> counted_list() const;

    mutable std::mutex mutex_;
    std::vector<Message> list_;
    struct Repeated {
        std::size_t index; ///< of the message kept
        std::size_t more = 0;
    };
    std::unordered_map<std::string, Repeated> warnings_; ///< by text
    std::size_t errors_ = 0;
};

/// "1st", "2nd", "11th": says in messages which value is meant, counting from 1.
std::string ordinal(std::size_t n);

/// The candidate nearest to word by edit distance, or "" when none is near (at most a third of the word
/// wrong).
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);
/// " (did you mean \"x\"?)" for the nearest candidate; else "; known: a, b, c" cut to a sensible length.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

} // namespace alhazen
